//! Builds the book of guen into `target/book`, or `book` in the folder CARGO_TARGET_DIR, and checks what it built.
//!
//! ```text
//! cargo run --manifest-path workshop/book/Cargo.toml              # from anywhere in the repository
//! cargo run --manifest-path workshop/book/Cargo.toml -- --open    # and show it
//! ```
//!
//! mdBook's own program reads the same `book.toml`, `mdbook build book`; this one needs nothing but the Rust toolchain,
//! has its versions pinned by `workshop/book/Cargo.lock`, and ends with a nonzero status if a link of the book leads nowhere or
//! a page would load something from a network.

mod check;
mod formulas;
mod live;
#[path = "../../../examples/common/open.rs"]
mod open;

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use mdbook_driver::MDBook;

const USAGE: &str = "\
Builds the book of guen from docs/ into target/book and checks its links and formulas. CARGO_TARGET_DIR, if set, takes the place of target.

usage: cargo run --manifest-path workshop/book/Cargo.toml -- [--open]

  --open    show the book in a browser
  --help    print this text";

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut open = false;
    for argument in std::env::args().skip(1) {
        match argument.as_str() {
            "--open" => open = true,
            "--help" | "-h" => {
                println!("{USAGE}");
                return Ok(ExitCode::SUCCESS);
            }
            other => {
                eprintln!("unknown argument `{other}`\n\n{USAGE}");
                return Ok(ExitCode::from(2));
            }
        }
    }
    let begin = Instant::now();
    let mut book = MDBook::load(Path::new(env!("CARGO_MANIFEST_DIR")))?;
    // Relative to where the user is, as cargo takes it.
    if let Some(target) = std::env::var_os("CARGO_TARGET_DIR").filter(|target| !target.is_empty()) {
        book.config.build.build_dir = std::env::current_dir()?.join(target).join("book");
    }
    let mistaken = formulas::set(&mut book);
    // Beside the book in the target folder.
    let made = book.root.join(&book.config.build.build_dir).with_file_name("guen");
    let played = live::link(&mut book, &made);
    book.build()?;
    let folder = book.build_dir_for("html").canonicalize()?;
    live::copy(&played, &folder)?;
    println!(
        "{} motions to play: the examples hoop, balancing_robot and viewer make them, and `gallery` of guen-measure",
        played.len()
    );
    let found = check::check(&folder)?;
    for fault in mistaken.iter().chain(&found.faults) {
        eprintln!("{fault}");
    }
    println!(
        "{} pages with {} links in {:.1} s: {}",
        found.pages,
        found.links,
        begin.elapsed().as_secs_f64(),
        folder.join("index.html").display()
    );
    if !mistaken.is_empty() {
        eprintln!("{} formulas are none", mistaken.len());
        return Ok(ExitCode::FAILURE);
    }
    if !found.faults.is_empty() {
        eprintln!("{} of the links lead nowhere or out of the book", found.faults.len());
        return Ok(ExitCode::FAILURE);
    }
    if open {
        open::open(&folder.join("index.html"));
    }
    Ok(ExitCode::SUCCESS)
}
