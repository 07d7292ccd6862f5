//! A user's crate that forgives nothing, with the facade under another name: it compiles without a warning.

use crate::commands;

/// Clippy's compiler, if it is installed beside the other one: the crate denies its pedantic group.
fn strictest() -> String {
    let mut rustc = std::process::Command::new(commands::rustc());
    let (sysroot, _) = commands::run(rustc.args(["--print", "sysroot"]));
    let driver = std::path::Path::new(sysroot.trim()).join("bin/clippy-driver");
    if driver.exists() { driver.display().to_string() } else { commands::rustc() }
}

#[test]
fn a_strict_crate_with_a_renamed_dependency() {
    let mut compiler = commands::compiler(&strictest(), "mechanics");
    let (_, text) = commands::run(compiler.args(["--crate-type=lib", "tests/hygiene/strict.rs"]));
    assert_eq!(text, "", "a strict crate compiles without a word");
}
