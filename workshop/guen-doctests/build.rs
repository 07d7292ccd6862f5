//! Writes every Rust block of `docs/`, the README and CONTRIBUTING as a test into one file, which `tests/blocks.rs` compiles. No page
//! can be forgotten: a file that is there is tested.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let root = Path::new(&env::var("CARGO_MANIFEST_DIR").expect("cargo sets it")).join("../..");
    let root = root.canonicalize().expect("the repository is there");
    let mut pages = vec![root.join("README.md"), root.join("CONTRIBUTING.md")];
    collect(&root.join("docs"), &mut pages);
    pages.sort();
    let mut tests = String::new();
    for page in &pages {
        println!("cargo::rerun-if-changed={}", page.display());
        let path = page.strip_prefix(&root).expect("below the root");
        let name = path.with_extension("").to_string_lossy().to_lowercase();
        let name = name.replace(|c: char| !c.is_ascii_alphanumeric(), "_");
        let text = fs::read_to_string(page).expect("a page is text");
        let blocks: String = blocks(&text).iter().map(|(line, block)| test(*line, block)).collect();
        let _ = write!(tests, "// {}\nmod {name} {{\n{blocks}}}\n", path.display());
    }
    println!("cargo::rerun-if-changed={}", root.join("docs").display());
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets it"));
    fs::write(out.join("blocks.rs"), tests).expect("the output folder can be written");
}

/// The blocks of Rust of a page, each with the number of its first line.
fn blocks(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let Some(language) = line.trim_start().strip_prefix("```") else { continue };
        let inside =
            lines.by_ref().map(|(_, line)| line).take_while(|line| !line.trim_start().starts_with("```"));
        let block: String = inside.map(compiled).collect();
        if language == "rust" {
            found.push((number + 2, block));
        }
    }
    found
}

/// A line of a block as it is compiled: the mark of those that are not shown is taken off.
fn compiled(line: &str) -> String {
    let start = line.trim_start();
    match start.strip_prefix("# ") {
        Some(rest) => format!("{rest}\n"),
        None if start == "#" => "\n".to_owned(),
        None => format!("{line}\n"),
    }
}

/// A block as a test: one with a `main` is a module, others are the statements of a function, whose last value may be a result,
/// as in documentation tests.
fn test(line: usize, block: &str) -> String {
    let body = match block {
        program if program.contains("fn main()") => {
            format!(
                "{program}#[test] fn runs() -> impl std::process::Termination {{ crate::elsewhere(); main() }}\n"
            )
        }
        falling if falling.trim_end().ends_with("(())") => {
            format!(
                "#[test] fn runs() -> Result<(), impl core::fmt::Debug> {{ crate::elsewhere();\n{falling}}}\n"
            )
        }
        statements => format!("#[test] fn runs() {{ crate::elsewhere();\n{statements}}}\n"),
    };
    format!("mod line_{line} {{\n{body}}}\n")
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
