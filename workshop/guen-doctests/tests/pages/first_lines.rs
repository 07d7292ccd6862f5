//! First lines of doc comments say what an item is or does.

use std::path::{Path, PathBuf};

/// Words that begin a riddle: what the item is comes later, or not at all.
const WEAK: [&str; 19] = [
    "What ",
    "The same ",
    "That ",
    "Those ",
    "So ",
    "These ",
    "This ",
    "Who ",
    "It ",
    "Its ",
    "They ",
    "Their ",
    "How ",
    "Why ",
    "Where ",
    "Which ",
    "By ",
    "At ",
    "Also ",
];

/// The libraries.
const CRATES: [&str; 8] = [
    "guen-runtime",
    "guen-symbolic",
    "guen-language",
    "guen-macros",
    "guen-study",
    "guen-adapters",
    "guen-mpi",
    ".",
];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

#[test]
fn first_lines_name_the_item() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = Vec::new();
    CRATES.iter().for_each(|name| sources(&root.join(name).join("src"), &mut files));
    let (mut count, mut weak) = (0, Vec::new());
    for file in files {
        let mut before = "";
        for (number, line) in std::fs::read_to_string(&file).unwrap().lines().enumerate() {
            let line = line.trim_start();
            let mark = line.get(..3).filter(|mark| ["///", "//!"].contains(mark)).unwrap_or("");
            if !mark.is_empty() && mark != before {
                count += 1;
                let text = line[3..].trim_start();
                if WEAK.iter().any(|word| text.starts_with(word)) {
                    weak.push(format!("{}:{}: {text}", file.display(), number + 1));
                }
            }
            before = mark;
        }
    }
    assert!(weak.is_empty(), "say what the item is or does:\n{}", weak.join("\n"));
    assert!(count > 3_000, "only {count} comments were found");
}
