//! Tests that are written are run: every file below a folder of tests is a module of its executable.

use std::fs;
use std::path::{Path, PathBuf};

use guen_doctests::{packages, root};

fn entries(folder: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()).collect();
    found.sort();
    found
}

fn is_rust(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "rs")
}

fn stem(path: &Path) -> String {
    path.file_stem().expect("a file has a name").to_string_lossy().into_owned()
}

/// The files below a folder that neither its `main.rs` nor a `mod.rs` names; all texts of the folder count, as a module may
/// be named by `#[path]`.
fn forgotten(folder: &Path, named: &mut String, found: &mut Vec<PathBuf>) {
    let own: Vec<PathBuf> = entries(folder).into_iter().filter(|path| is_rust(path)).collect();
    for path in &own {
        *named += &fs::read_to_string(path).expect("a file of tests is text");
    }
    for path in own.iter().filter(|path| !["main", "mod"].contains(&stem(path).as_str())) {
        if !named.contains(&format!("mod {};", stem(path))) {
            found.push(path.clone());
        }
    }
    for inner in entries(folder).into_iter().filter(|path| path.is_dir()) {
        if inner.join("mod.rs").exists() && !named.contains(&format!("mod {};", stem(&inner))) {
            found.push(inner.clone());
        }
        forgotten(&inner, named, found);
    }
}

#[test]
fn every_test_belongs_to_an_executable() {
    let tests = root().join("tests");
    let manifest = fs::read_to_string(tests.join("Cargo.toml")).expect("the manifest of the tests");
    let mut found: Vec<PathBuf> = entries(&tests).into_iter().filter(|path| is_rust(path)).collect();
    let mut executables = 0;
    for folder in entries(&tests).into_iter().filter(|path| path.join("main.rs").exists()) {
        executables += 1;
        if !manifest.contains(&format!("path = \"{}/main.rs\"", stem(&folder))) {
            found.push(folder.join("main.rs"));
        }
        forgotten(&folder, &mut String::new(), &mut found);
    }
    assert!(executables > 5, "only {executables} executables were found");
    // Cargo itself finds the executables of the other packages.
    for package in packages() {
        let tests = package.join("tests");
        if tests.is_dir() {
            for folder in entries(&tests).into_iter().filter(|path| path.join("main.rs").exists()) {
                forgotten(&folder, &mut String::new(), &mut found);
            }
        }
    }
    assert!(found.is_empty(), "no executable has these: {found:?}");
}
