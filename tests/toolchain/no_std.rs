//! Generated code and steppers do without `std`: the library in `tests/no_std` is built with a panic handler of its
//! own, which `std` anywhere below it would contradict, and for a bare target too where one is installed.

use std::path::Path;
use std::process::Command;

use crate::commands;

#[path = "../no_std/src/sled.rs"]
mod sled;

/// A target without operating system.
const BARE: &str = "thumbv7em-none-eabi";

fn build(target: &str) {
    let (_, text) = commands::optimised("guen-no-std", target, "staticlib", &[]);
    assert!(!text.contains("warning:"), "{text}");
}

#[test]
fn builds_without_std() {
    build(commands::host());
    let mut rustc = Command::new(commands::rustc());
    let (folder, _) = commands::run(rustc.args(["--print", "target-libdir", "--target", BARE]));
    if Path::new(folder.trim()).exists() {
        build(BARE);
    } else {
        println!("{BARE} is not installed: built for this machine alone");
    }
}

/// The same code, run here.
#[test]
fn runs() {
    let angle = sled::heading(2.0);
    assert!(angle > 0.1 && angle < 1.5, "{angle}");
}
