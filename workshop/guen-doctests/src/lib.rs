//! The pages of the book, the README and CONTRIBUTING: `cargo test -p guen-doctests --test blocks` compiles and runs every Rust
//! block of theirs, and the other tests of this package hold their links, pictures, tables and pointers to what is there.
//!
//! The blocks are written as tests by `build.rs`. A block is Rust if it says so, every block says what it is, and there is no
//! way around its test, as `ignore` and `no_run` would be: `tests/pages/blocks.rs` sees to that.
#![forbid(unsafe_code)]

/// A page or another text of the repository.
pub struct Page {
    /// The path from the root of the repository, with `/`.
    pub path: String,
    /// What is in it.
    pub text: String,
}

/// The root of the repository.
pub fn root() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The folders of the packages: those that are published, at the root, and those of the workshop.
pub fn packages() -> Vec<std::path::PathBuf> {
    let mut found = Vec::new();
    for folder in [root(), root().join("workshop")] {
        let entries = std::fs::read_dir(folder).expect("a folder of the repository");
        found.extend(entries.map(|entry| entry.expect("an entry").path()));
    }
    found.retain(|path| path.join("Cargo.toml").exists() && path.join("src").exists());
    found.sort();
    found
}

/// All pages of `docs/`, and the README and CONTRIBUTING.
pub fn pages() -> Vec<Page> {
    let mut paths = vec![root().join("README.md"), root().join("CONTRIBUTING.md")];
    files(&root().join("docs"), &mut paths);
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    paths.sort();
    let page = |path: std::path::PathBuf| Page {
        text: std::fs::read_to_string(&path).expect("a page is text"),
        path: path.strip_prefix(root()).expect("below the root").to_string_lossy().replace('\\', "/"),
    };
    paths.into_iter().map(page).collect()
}

/// The files below a folder.
pub fn files(folder: &std::path::Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, found);
        } else {
            found.push(path);
        }
    }
}

impl Page {
    /// The lines outside of fenced blocks, with their numbers from 1.
    pub fn prose(&self) -> impl Iterator<Item = (usize, &str)> {
        let mut fence = false;
        self.text.lines().enumerate().filter_map(move |(k, line)| {
            if line.trim_start().starts_with("```") {
                fence = !fence;
                return None;
            }
            (!fence).then_some((k + 1, line))
        })
    }

    /// The words after the opening fence of every block, with the number of its line.
    pub fn fences(&self) -> Vec<(usize, &str)> {
        let mut open = false;
        let mut found = Vec::new();
        for (k, line) in self.text.lines().enumerate() {
            if let Some(words) = line.trim_start().strip_prefix("```") {
                open = !open;
                if open {
                    found.push((k + 1, words));
                }
            }
        }
        found
    }

    /// Targets of links and pictures outside of code, with the number of their line.
    pub fn links(&self) -> Vec<(usize, String)> {
        let mut found = Vec::new();
        for (number, line) in self.prose() {
            // Code between backticks is no link.
            let prose: String = line.split('`').step_by(2).collect::<Vec<_>>().join("`");
            for (before, after) in [("](", ')'), ("src=\"", '"')] {
                let mut rest = prose.as_str();
                while let Some(at) = rest.find(before) {
                    rest = &rest[at + before.len()..];
                    let end = rest.find(after).unwrap_or(rest.len());
                    found.push((number, rest[..end].to_owned()));
                }
            }
        }
        found
    }

    /// The anchors of the headings, as mdBook and code hosts make them.
    pub fn anchors(&self) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        for (_, line) in self.prose() {
            let heading = line.trim_start_matches('#');
            if heading.len() == line.len() || !heading.starts_with(' ') {
                continue;
            }
            let anchor: String = heading
                .trim()
                .to_lowercase()
                .chars()
                .filter_map(|c| match c {
                    ' ' => Some('-'),
                    c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
                    _ => None,
                })
                .collect();
            let same = found.iter().filter(|known| **known == anchor).count();
            found.push(if same == 0 { anchor } else { format!("{anchor}-{same}") });
        }
        found
    }
}
