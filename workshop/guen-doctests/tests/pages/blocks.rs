//! What may stand behind an opening fence. Rust is compiled and run, without a way around.

use guen_doctests::pages;

#[test]
fn all_rust_is_run() {
    let mut rust = 0;
    for page in pages() {
        for (line, words) in page.fences() {
            // An unnamed block is Rust to rustdoc, and no language to mdBook: say which.
            let known = ["rust", "text", "toml", "sh", "console", "c"].contains(&words);
            assert!(known, "{}:{line}: a block of `{words}`", page.path);
            rust += usize::from(words == "rust");
        }
    }
    assert!(rust > 20, "only {rust} blocks of Rust were found");
}
