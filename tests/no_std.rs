//! Generated code and steppers do without `std`: the library in `tests/no_std` is built with a panic handler of its
//! own, which `std` anywhere below it would contradict, and for a bare target too where one is installed.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

#[path = "no_std/src/sled.rs"]
mod sled;

/// A target without operating system.
const BARE: &str = "thumbv7em-none-eabi";

/// The library beside the target directory, with the versions that the workspace is locked to.
fn copy() -> PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("no_std");
    fs::create_dir_all(place.join("src")).unwrap();
    for file in ["src/lib.rs", "src/sled.rs"] {
        fs::copy(root.join("tests/no_std").join(file), place.join(file)).unwrap();
    }
    let manifest = fs::read_to_string(root.join("tests/no_std/Cargo.toml")).unwrap();
    let local = manifest.replace("\"../..\"", &format!("{:?}", root.display().to_string()));
    assert_ne!(manifest, local, "the manifest names the root of the repository");
    fs::write(place.join("Cargo.toml"), local).unwrap();
    let lock = root.join("Cargo.lock");
    if lock.exists() {
        fs::copy(lock, place.join("Cargo.lock")).unwrap();
    }
    place
}

fn build(place: &Path, arguments: &[&str]) {
    let output = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["build", "--offline"])
        .args(arguments)
        // The target directory of the tests, where the macro's own dependencies are built already.
        .arg("--target-dir")
        .arg(Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap())
        .current_dir(place)
        .env_remove("RUSTFLAGS")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    assert!(!text.contains("warning:"), "{text}");
}

#[test]
fn builds_without_std() {
    let place = copy();
    build(&place, &[]);
    let libdir = Command::new("rustc").args(["--print", "target-libdir", "--target", BARE]).output().unwrap();
    if Path::new(String::from_utf8_lossy(&libdir.stdout).trim()).exists() {
        build(&place, &["--target", BARE]);
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
