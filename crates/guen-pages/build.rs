//! Lists the pages of `docs/`, the README and CONTRIBUTING, and writes a module for each with the page as its
//! documentation. No page can be forgotten: a file that is there is tested.

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let root = Path::new(&env::var("CARGO_MANIFEST_DIR").expect("cargo sets it")).join("../..");
    let root = root.canonicalize().expect("the repository is there");
    let mut pages = vec![root.join("README.md"), root.join("CONTRIBUTING.md")];
    collect(&root.join("docs"), &mut pages);
    pages.sort();
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets it"));
    let mut modules = String::new();
    for page in &pages {
        println!("cargo::rerun-if-changed={}", page.display());
        let name = page.strip_prefix(&root).expect("below the root").with_extension("");
        let name = name.to_string_lossy().to_lowercase().replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        let copy = out.join(&name).with_extension("md");
        fs::write(&copy, elsewhere(page, &out)).expect("the output folder can be written");
        modules += &format!("#[doc = include_str!({copy:?})]\npub mod {name} {{}}\n");
    }
    println!("cargo::rerun-if-changed={}", root.join("docs").display());
    fs::write(out.join("pages.rs"), modules).expect("the output folder can be written");
}

/// A page whose programs run in the output folder: what they write, pictures for instance, stays out of the sources, which may
/// be read-only.
fn elsewhere(page: &Path, out: &Path) -> String {
    let text = fs::read_to_string(page).expect("a page is text");
    let moved = |line: &str| match line.starts_with("fn main()") && line.ends_with('{') {
        true => format!("{line} std::env::set_current_dir({out:?}).unwrap();\n"),
        false => format!("{line}\n"),
    };
    text.lines().map(moved).collect()
}

fn collect(folder: &Path, pages: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of pages") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, pages);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            pages.push(path);
        }
    }
}
