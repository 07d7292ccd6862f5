//! `unsafe` is forbidden in every crate, but where instructions are chosen at run time, where kernels are launched and where C wants a name.

use std::fs;
use std::path::{Path, PathBuf};

use guen_doctests::{packages, root};

/// The files of the published crates with unsafe code, and the roots that cannot forbid it, or not with every feature.
const REGISTERS: &str = "guen-runtime/src/numbers/lanes/x86.rs";
const LAUNCHES: &str = "guen-study/src/ensemble/device/cuda.rs";
const DENIED_ONLY: [&str; 3] =
    ["guen-runtime/src/lib.rs", "guen-study/src/lib.rs", "workshop/guen-bare/src/lib.rs"];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            sources(&entry, found);
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            found.push(entry);
        }
    }
}

/// The path from the repository's root, with `/`.
fn name(path: &Path) -> String {
    let parts = path.strip_prefix(root()).unwrap().components();
    parts.map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

#[test]
fn every_crate_forbids_unsafe_code() {
    let mut roots = vec![root().join("src/lib.rs")];
    roots.extend(packages().iter().map(|package| package.join("src/lib.rs")));
    assert!(roots.len() > 8, "{roots:?}");
    for path in roots.iter().filter(|path| path.exists()) {
        let text = fs::read_to_string(path).unwrap();
        let forbids = text.contains("#![forbid(unsafe_code)]");
        assert_eq!(forbids, !DENIED_ONLY.contains(&name(path).as_str()), "{}", path.display());
    }
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    assert!(manifest.contains("unsafe_code = \"deny\""), "the workspace denies what a crate does not forbid");
}

#[test]
fn two_files_may_be_unsafe() {
    let mut files = Vec::new();
    ["src", "examples", "workshop/benches"]
        .iter()
        .for_each(|folder| sources(&root().join(folder), &mut files));
    packages().iter().for_each(|package| sources(package, &mut files));
    // What lets code be unsafe in spite of the lint.
    let words = ["allow(unsafe_code", "expect(unsafe_code"];
    let allows = |path: &PathBuf| words.iter().any(|word| fs::read_to_string(path).unwrap().contains(word));
    let mut found: Vec<String> = files.iter().filter(|path| allows(path)).map(|path| name(path)).collect();
    found.retain(|path| !path.starts_with("workshop/guen-doctests/tests/"));
    found.sort();
    assert_eq!(found, [REGISTERS, LAUNCHES, "workshop/guen-bare/src/lib.rs"]);
}
