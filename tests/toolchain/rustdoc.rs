//! What a reader of a system's documentation sees: the list of its items, as rustdoc makes it, beside the one that was agreed on. What
//! the expansion needs for itself stays hidden.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::commands;

/// All pages below a folder, by their paths.
fn pages(folder: &Path, below: &str, found: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            pages(&path, &format!("{below}{name}/"), found);
        } else if name.ends_with(".html") && name != "all.html" {
            found.insert(format!("{below}{name}"));
        }
    }
}

/// The names in a part of a page that follow a mark, up to the quote.
fn marked<'p>(page: &'p str, from: &str, to: &str, mark: &str) -> BTreeSet<&'p str> {
    let Some((_, part)) = page.split_once(from) else { return BTreeSet::new() };
    let part = part.split_once(to).map_or(part, |(part, _)| part);
    part.split(mark).skip(1).filter_map(|rest| rest.split_once('"')).map(|(name, _)| name).collect()
}

/// The items of a public system in the documentation of a library, a line for each; of the system itself its methods, too.
fn listed(package: &str, module: &str, system: &str) -> String {
    let mut command = commands::cargo("doc");
    command.args(["--no-deps", "--lib", "-p", package]);
    command.env("RUSTDOCFLAGS", "-Dwarnings");
    let target =
        Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("cargo makes it in the target folder");
    let doc = target.join("doc").join(package.replace('-', "_"));
    // Pages of items that are gone would stay.
    let _ = fs::remove_dir_all(&doc);
    commands::run(&mut command);
    let mut found = BTreeSet::new();
    pages(&doc.join(module), "", &mut found);
    let mut text = String::new();
    for page in &found {
        let _ = writeln!(text, "{page}");
        if page.ends_with(&format!("struct.{system}.html")) {
            let page = fs::read_to_string(doc.join(module).join(page)).unwrap();
            let (own, traits) = ("id=\"implementations\"", "id=\"trait-implementations\"");
            for kind in ["method", "associatedconstant", "associatedtype"] {
                for name in marked(&page, own, traits, &format!("<section id=\"{kind}.")) {
                    let _ = writeln!(text, "    {kind} {name}");
                }
            }
            for name in marked(&page, traits, "id=\"synthetic-implementations\"", "<section id=\"impl-") {
                let _ = writeln!(text, "    impl {name}");
            }
            // The equations are what a reader comes for.
            let headings = marked(&page, "<h2 id=\"equations-of-motion", "</body>", "<h2 id=\"");
            assert!(headings.iter().any(|name| name.starts_with("velocities")), "{headings:?}");
            let first = page.split("<h2 id=\"").nth(1).unwrap_or_default();
            assert!(
                first.starts_with("equations-of-motion"),
                "the page begins with {}",
                &first[..60.min(first.len())]
            );
        }
    }
    text
}

#[test]
#[ignore = "documents a library: `.ci/run` asks for it"]
fn readers_see_what_was_agreed_on() {
    let golden = commands::root().join("tests/rustdoc/hoop.txt");
    let found = listed("guen-benchmarks", "systems/hoop", "Hoop");
    if std::env::var_os("GUEN_BLESS").is_some() {
        fs::write(&golden, &found).unwrap();
    }
    let expected = fs::read_to_string(&golden).unwrap();
    let difference = |a: &str, b: &str| {
        let b: BTreeSet<&str> = b.lines().collect();
        a.lines().filter(|line| !b.contains(line)).collect::<Vec<_>>().join("\n")
    };
    let (new, gone) = (difference(&found, &expected), difference(&expected, &found));
    assert!(found == expected, "GUEN_BLESS=1 writes the list anew.\nnew:\n{new}\ngone:\n{gone}");
    assert!(!found.contains("__"), "{found}");
}
