//! What the pages say of the code: files that they name are there, and those of `docs/theory.md` name the equation in turn.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use guen_doctests::{files, packages, pages, root};

/// The files of the repository, from its root.
fn repository() -> Vec<String> {
    let mut found = Vec::new();
    for folder in [".ci", "docs", "examples", "src", "tests", "workshop"] {
        files(&root().join(folder), &mut found);
    }
    packages().iter().for_each(|package| files(package, &mut found));
    let top = std::fs::read_dir(root()).expect("the root").map(|entry| entry.expect("an entry").path());
    found.extend(top.filter(|path| path.is_file()));
    let path = |path: PathBuf| {
        path.strip_prefix(root()).expect("below the root").to_string_lossy().replace('\\', "/")
    };
    found.into_iter().map(path).filter(|path| !path.contains("/target/")).collect()
}

/// The paths in backticks of a text: with a folder and an extension.
fn paths(text: &str) -> Vec<&str> {
    let is_path = |code: &&str| {
        code.contains('/') && Path::new(code).extension().is_some() && !code.starts_with("target/")
    };
    plain(text).filter(is_path).collect()
}

/// The file names in backticks of a text: without a folder, and with an extension that files of the repository have.
fn names(text: &str) -> Vec<&str> {
    /// Names that files of every package have, whichever is meant.
    const EVERYWHERE: [&str; 5] = ["Cargo.toml", "build.rs", "lib.rs", "main.rs", "mod.rs"];
    let is_name = |code: &&str| {
        let extension = Path::new(code).extension().and_then(|extension| extension.to_str());
        matches!(extension, Some("rs" | "py" | "md" | "toml"))
            && !code.contains('/')
            && !EVERYWHERE.contains(code)
    };
    plain(text).filter(is_name).collect()
}

/// What stands in backticks and has only letters that a path has.
fn plain(text: &str) -> impl Iterator<Item = &str> {
    let is_plain = |code: &&str| code.chars().all(|c| c.is_ascii_alphanumeric() || "/._-".contains(c));
    text.split('`').skip(1).step_by(2).filter(is_plain)
}

/// The names of files without a folder that are wrong: none has that name, or several have it and neither the section nor the
/// beginning of the page has said before in which folder.
fn misnamed(text: &[(usize, &str)], repository: &[String]) -> Vec<String> {
    let (mut folders, mut found): (Vec<&str>, Vec<String>) = (Vec::new(), Vec::new());
    let mut opening = None;
    for (line, text) in text {
        if text.starts_with("## ") {
            folders.truncate(*opening.get_or_insert(folders.len()));
        }
        folders.extend(plain(text).map(|code| code.trim_end_matches('/')));
        for name in names(text) {
            let files: Vec<&String> =
                repository.iter().filter(|file| file.rsplit('/').next() == Some(name)).collect();
            let is_in = |folder: &&str| {
                let folder = format!("/{folder}/");
                files.iter().filter(|file| format!("/{file}").contains(&folder)).count() == 1
            };
            match files.len() {
                0 => found.push(format!("{line}: there is no `{name}`")),
                1 => {}
                _ if folders.iter().any(is_in) => {}
                _ => found.push(format!("{line}: which `{name}`? {files:?}")),
            }
        }
    }
    found
}

#[test]
fn named_files_are_there() {
    let repository = repository();
    let mut count = 0;
    for page in pages() {
        for (line, text) in page.prose() {
            for path in paths(text) {
                count += 1;
                let there = repository.iter().any(|file| file == path || file.ends_with(&format!("/{path}")));
                assert!(there, "{}:{line}: there is no `{path}`", page.path);
            }
        }
    }
    assert!(count > 40, "only {count} paths were found");
}

#[test]
fn named_files_without_a_folder_are_there() {
    let repository = repository();
    let (mut faults, mut count) = (Vec::new(), 0);
    for page in pages() {
        let prose: Vec<(usize, &str)> = page.prose().collect();
        count += prose.iter().map(|(_, text)| names(text).len()).sum::<usize>();
        faults
            .extend(misnamed(&prose, &repository).into_iter().map(|fault| format!("{}:{fault}", page.path)));
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(count > 40, "only {count} names were found");
}

/// The names of constants in backticks of a text: capitals, digits and `_` alone, with four letters and more, so that the symbols
/// of a formula are none.
fn constants(text: &str) -> impl Iterator<Item = &str> {
    let is_constant = |code: &&str| {
        code.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_')
            && code.chars().filter(char::is_ascii_uppercase).count() > 3
    };
    plain(text).filter(is_constant)
}

/// The names of constants in the files that may define one.
fn defined(repository: &[String]) -> BTreeSet<String> {
    let may_define = |path: &&String| {
        let extension = Path::new(path).extension().and_then(|extension| extension.to_str());
        matches!(extension, None | Some("rs" | "py" | "toml"))
    };
    let is_capital = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
    let mut found = BTreeSet::new();
    for path in repository.iter().filter(may_define) {
        let text = std::fs::read_to_string(root().join(path)).unwrap_or_default();
        let names = text.split(|c| !is_capital(c)).filter(|name| name.len() > 3);
        found.extend(names.map(str::to_owned));
    }
    found
}

/// Constants that pages of the book name are there. CONTRIBUTING names some that are not, to say how not to name.
#[test]
fn named_constants_are_there() {
    let known = defined(&repository());
    let (mut faults, mut count) = (Vec::new(), 0);
    for page in pages().iter().filter(|page| page.path.starts_with("docs/")) {
        for (line, text) in page.prose() {
            for name in constants(text) {
                count += 1;
                if !known.contains(name) {
                    faults.push(format!("{}:{line}: there is no `{name}`", page.path));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(count > 40, "only {count} constants were found");
}

#[test]
fn names_of_constants_are_told_from_formulas() {
    let found: Vec<&str> =
        constants("`MAX_STEPS`, `M_11`, `M_SS`, `VITALS`, `DOP853`, `Guard`, `A-B`").collect();
    assert_eq!(found, ["MAX_STEPS", "VITALS"]);
}

#[test]
fn a_wrong_name_and_an_ambiguous_one_are_found() {
    let repository = ["a/one.rs", "b/one.rs", "b/two.rs"].map(str::to_owned);
    let faults = |text: &str| misnamed(&[(1, text)], &repository).len();
    assert_eq!(faults("`two.rs` and `main.rs`"), 0);
    assert_eq!(faults("`three.rs`"), 1);
    assert_eq!(faults("`one.rs`"), 1);
    assert_eq!(faults("in `b`: `one.rs`"), 0);
    let next = [(1, "## First"), (2, "`b`: `one.rs`"), (3, "## Next"), (4, "`one.rs`")];
    assert_eq!(misnamed(&next, &repository).len(), 1);
}

/// The numbers of equations in a text, `(1.9)-(1.11)` with those between.
fn equations(text: &str) -> Vec<(u32, u32)> {
    let mut found: Vec<(u32, u32)> = Vec::new();
    let mut range = false;
    for part in text.split('(').skip(1) {
        let number = part.split(')').next().and_then(|number| number.split_once('.'));
        if let Some((Ok(section), Ok(item))) = number.map(|(a, b)| (a.parse(), b.parse())) {
            match found.last().copied() {
                Some((same, from)) if range && same == section => {
                    found.extend((from + 1..=item).map(|item| (section, item)));
                }
                _ => found.push((section, item)),
            }
        }
        range = part.ends_with(")-");
    }
    found
}

#[test]
fn formulas_live_where_the_theory_says() {
    let pages = pages();
    let theory = pages.iter().find(|page| page.path == "docs/theory.md").expect("the page of formulas");
    let mut rows = 0;
    for (line, text) in theory.prose().filter(|(_, line)| line.starts_with("| (")) {
        let cells: Vec<&str> = text.split(" | ").collect();
        let numbers = equations(cells[0]);
        assert!(!numbers.is_empty(), "docs/theory.md:{line}: no number in {}", cells[0]);
        let mut named = Vec::new();
        for path in cells[2..].iter().flat_map(|cell| paths(cell)) {
            let near = root().join("guen-symbolic/src").join(path);
            let file = if near.is_file() { near } else { root().join(path) };
            let text =
                std::fs::read_to_string(&file).unwrap_or_else(|_| panic!("docs/theory.md:{line}: no {path}"));
            let known = equations(&text);
            assert!(
                numbers.iter().any(|n| known.contains(n)),
                "docs/theory.md:{line}: {path} names none of {numbers:?}"
            );
            named.extend(known);
            rows += 1;
        }
        // Numbers that stand alone are each named by a file, where there is one.
        if !named.is_empty() && !cells[0].contains(")-(") {
            assert!(
                numbers.iter().all(|n| named.contains(n)),
                "docs/theory.md:{line}: not all of {numbers:?} are named"
            );
        }
    }
    assert!(rows > 12, "only {rows} pointers were found");
}

#[test]
fn numbers_of_equations_are_read() {
    assert_eq!(equations("(1.9)-(1.11), (2.7)"), [(1, 9), (1, 10), (1, 11), (2, 7)]);
    assert_eq!(equations("f(x), (1.14)"), [(1, 14)]);
}

/// The pieces of declarations in the gallery stand in the tests that it names, line by line.
#[test]
fn the_gallery_shows_what_is_tested() {
    let pages = pages();
    let gallery = pages.iter().find(|page| page.path == "docs/start/gallery.md").expect("the gallery");
    let squeezed = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let shared: String = ["declarations.rs", "rolling.rs", "systems.rs"]
        .map(|file| root().join("workshop/guen-benchmarks/src").join(file))
        .map(|file| std::fs::read_to_string(file).expect("the declarations that programs share"))
        .concat();
    let mut lines = 0;
    for section in gallery.text.split("\n## ").skip(1) {
        let title = section.lines().next().unwrap_or_default();
        let prose: String = section.split("```").step_by(2).collect();
        let named = prose.split('`').skip(1).step_by(2).find(|code| code.ends_with(".rs"));
        let named = named.unwrap_or_else(|| panic!("{title}: no test is named"));
        let test = std::fs::read_to_string(root().join("tests/spatial").join(named))
            .expect("a test of tests/spatial");
        let test = squeezed(&(test + &shared));
        for line in section.split("```").skip(1).step_by(2).flat_map(|block| block.lines().skip(1)) {
            lines += 1;
            assert!(test.contains(&squeezed(line)), "{title}: this is not in {named}: {line}");
        }
    }
    assert!(lines > 30, "only {lines} lines were found");
}
