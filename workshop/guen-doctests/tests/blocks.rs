//! Every Rust block of the pages, compiled and run.
//!
//! A test of their own, and no documentation tests: those are compiled one after the other when all else is over, by one
//! compiler in one thread.

#![allow(
    unused,
    non_snake_case,
    reason = "as in documentation tests; constants are called as in the declarations"
)]
// The blocks are written for readers.
#![cfg(not(clippy))]

include!(concat!(env!("OUT_DIR"), "/blocks.rs"));

/// What the blocks write, pictures for instance, stays out of the sources, which may be read-only.
fn elsewhere() {
    let folder = concat!(env!("CARGO_TARGET_TMPDIR"), "/pages");
    std::fs::create_dir_all(folder).unwrap();
    std::env::set_current_dir(folder).unwrap();
}

#[test]
fn no_block_is_forgotten() {
    let tests = include_str!(concat!(env!("OUT_DIR"), "/blocks.rs"));
    let wanted = guen_doctests::pages()
        .iter()
        .flat_map(|page| page.fences())
        .filter(|(_, words)| *words == "rust")
        .count();
    assert_eq!(tests.matches("#[test] fn runs()").count(), wanted);
}
