//! The declarations that stand in the repository: those of tests, examples, benchmarks and pages.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use guen_language::parse;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use crate::random_declarations::scenes::Names;

/// Every declaration once, with the file where it stands, but for those with components that are imported: they are not known here.
pub fn all() -> Vec<(String, PathBuf)> {
    found().into_iter().filter(|(text, _)| !imports(text)).collect()
}

/// Every declaration with components that are imported.
pub fn with_imports() -> Vec<(String, PathBuf)> {
    found().into_iter().filter(|(text, _)| imports(text)).collect()
}

/// Whether a declaration uses a component that it does not declare.
fn imports(text: &str) -> bool {
    let name = |text: &str| text.split_whitespace().next().unwrap_or_default().to_owned();
    let declared: Vec<String> = text.split(" component ").skip(1).map(name).collect();
    text.split(" use ").skip(1).any(|used| !declared.contains(&name(used)))
}

fn found() -> Vec<(String, PathBuf)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    for entry in std::fs::read_dir(&root).expect("the root of the repository") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        // `CHANGELOG.md` shows what declarations were once.
        if !name.starts_with('.') && !["target", "CHANGELOG.md"].contains(&name.as_str()) {
            collect(&path, &mut files);
        }
    }
    files.sort();
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file).expect("a file of the repository");
        let is_page = file.extension().is_some_and(|extension| extension == "md");
        let blocks = if is_page { blocks(&text) } else { vec![text] };
        for tokens in blocks.iter().filter_map(|block| block.parse::<TokenStream>().ok()) {
            declarations(tokens, &mut |declaration| {
                let text = declaration.to_string();
                if seen.insert(text.clone()) {
                    found.push((text, file.clone()));
                }
            });
        }
    }
    found
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = std::fs::read_dir(path).expect("a folder of the repository");
        for entry in entries {
            let path = entry.expect("an entry").path();
            if path.file_name().is_none_or(|name| name != "target") {
                collect(&path, files);
            }
        }
    } else if path.extension().is_some_and(|extension| extension == "rs" || extension == "md") {
        files.push(path.to_owned());
    }
}

/// The blocks of Rust of a page, with the lines that are not shown.
fn blocks(page: &str) -> Vec<String> {
    let parts = page.split("```");
    let blocks = parts.skip(1).step_by(2).map(|block| block.split_once('\n').map_or("", |(_, text)| text));
    let shown = |line: &str| line.strip_prefix("# ").unwrap_or(line).to_owned();
    blocks.map(|block| block.lines().map(shown).collect::<Vec<_>>().join("\n")).collect()
}

/// `system Name { .. }`, wherever it stands.
fn declarations(tokens: TokenStream, found: &mut dyn FnMut(TokenStream)) {
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    for (place, tree) in trees.iter().enumerate() {
        match (tree, trees.get(place + 1), trees.get(place + 2)) {
            (TokenTree::Ident(word), Some(TokenTree::Ident(name)), Some(TokenTree::Group(body)))
                if word == "system" && name != "else" && body.delimiter() == Delimiter::Brace =>
            {
                let body = Group::new(Delimiter::Brace, without_repetitions(body.stream()));
                found(trees[place..place + 2].iter().cloned().chain([body.into()]).collect());
            }
            (TokenTree::Group(group), ..) => declarations(group.stream(), found),
            _ => {}
        }
    }
}

/// What a declaration inside of a `macro_rules!` is where nothing is repeated: without `$( .. )*`.
fn without_repetitions(tokens: TokenStream) -> TokenStream {
    let mut kept: Vec<TokenTree> = Vec::new();
    let mut trees = tokens.into_iter().peekable();
    while let Some(tree) = trees.next() {
        let is_repeated = |next: Option<&TokenTree>| matches!(next, Some(TokenTree::Group(_)));
        match &tree {
            TokenTree::Punct(mark) if mark.as_char() == '$' && is_repeated(trees.peek()) => {
                trees.nth(1);
            }
            _ => kept.push(tree),
        }
    }
    kept.into_iter().collect()
}

/// How many coordinates a declaration has.
pub fn coordinates(text: &str) -> usize {
    let tokens: TokenStream = text.parse().expect("tokens");
    let (declaration, _) = parse::parse(tokens);
    declaration.map_or(0, |declaration| Names::of(&declaration).coordinates.len())
}

/// Whether faults are what a file is about: the compiler's message lies beside it, or it is a page or built from faults.
pub fn may_be_wrong(file: &Path) -> bool {
    let text = file.to_string_lossy();
    file.with_extension("stderr").exists()
        || ["docs/", "/generated/"].iter().any(|folder| text.contains(folder))
}
