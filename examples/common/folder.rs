//! Where a program of this repository leaves its pictures and pages.

use std::env;
use std::path::{Path, PathBuf};

/// The path `guen/NAME` in the target folder that this program was built in, wherever that is, as a whole path.
pub fn folder(name: &str) -> PathBuf {
    let program = env::current_exe().unwrap_or_default();
    // target/release/NAME, and for examples target/release/examples/NAME
    let depth = if program.parent().is_some_and(|parent| parent.ends_with("examples")) { 3 } else { 2 };
    program.ancestors().nth(depth).unwrap_or(Path::new("target")).join("guen").join(name)
}
