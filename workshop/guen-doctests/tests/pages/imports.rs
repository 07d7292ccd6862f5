//! Imports of the libraries run one way: no files of a crate import from each other in a circle.
//!
//! A folder's `mod.rs` and the files of the folder may import from each other: a file works on the types of its folder.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The libraries that have more than a few files.
const CRATES: [&str; 4] = ["guen-runtime", "guen-symbolic", "guen-language", "guen-study"];

/// Imports that close a circle with a reason.
const ALLOWED: [(&str, &str, &str); 10] = [
    // Provided methods of a trait that begin a simulation: the simulation is one of anything that has the trait.
    ("guen-runtime", "system::simulate", "simulation"),
    ("guen-runtime", "system::simulate", "simulation::error"),
    ("guen-runtime", "system::simulate", "simulation::trajectory"),
    ("guen-runtime", "system::inputs::actuated", "simulation::without_inputs"),
    ("guen-runtime", "hybrid::interface::system", "hybrid::simulations::simulation"),
    ("guen-runtime", "hybrid::interface::system", "hybrid::simulations::trajectory"),
    // Types that hold each other: indices are expressions of names with indices; components and modes hold entries of sections.
    ("guen-language", "syntax::name", "syntax::index"),
    ("guen-language", "syntax::section", "syntax::component"),
    ("guen-language", "syntax::section", "syntax::contact"),
    // Grammar that is recursive: a component is written as a declaration is, and stands in one.
    ("guen-language", "parse::declaration", "parse::components"),
];

/// The most times that a name is passed on between its use and its definition.
const PASSED_ON: u32 = 5;

type Name = Vec<String>;

#[derive(Default)]
struct Module {
    /// The names that are defined in the file.
    defined: BTreeSet<String>,
    /// The paths that are imported, each with the name that it has here.
    imported: Vec<(Name, String)>,
    /// The paths that are used: imports for the file itself, and paths from the root of the crate.
    used: Vec<Name>,
}

/// The text without comments, and without the tests at its end.
fn code(text: &str) -> String {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    text.lines().map(|line| line.split("//").next().unwrap_or("")).collect::<Vec<_>>().join(" ")
}

fn words(path: &str) -> Name {
    path.split("::").map(str::trim).filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// The paths of a tree of imports, each with the name that it has here.
fn leaves(tree: &str, before: &[String], found: &mut Vec<(Name, String)>) {
    let Some((path, rest)) = tree.split_once('{') else {
        let (path, name) = tree.split_once(" as ").unwrap_or((tree, ""));
        let mut path = [before, &words(path)].concat();
        path.pop_if(|last| last == "self");
        if let Some(last) = path.last().cloned() {
            found.push((path, if name.is_empty() { last } else { name.trim().to_owned() }));
        }
        return;
    };
    let before = [before, &words(path)].concat();
    let (mut depth, mut part) = (0, String::new());
    for letter in rest.trim_end().trim_end_matches('}').chars().chain([',']) {
        match letter {
            ',' if depth == 0 => leaves(&std::mem::take(&mut part), &before, found),
            _ => {
                depth += i32::from(letter == '{') - i32::from(letter == '}');
                part.push(letter);
            }
        }
    }
}

fn is_word(letter: char) -> bool {
    letter.is_alphanumeric() || letter == '_'
}

fn module(text: &str) -> Module {
    let (text, mut module) = (code(text), Module::default());
    for keyword in ["fn ", "struct ", "enum ", "trait ", "type ", "const ", "static ", "macro_rules! "] {
        let names = text.split(keyword).skip(1).map(|rest| rest.split(|letter| !is_word(letter)).next());
        module.defined.extend(names.flatten().map(str::to_owned));
    }
    let mut rest = String::new();
    for statement in text.split(';') {
        let is_import = |at: &usize| !statement[..*at].ends_with(is_word);
        let Some(at) = statement.rfind("use ").filter(is_import).filter(|at| {
            let tree = &statement[at + 4..];
            tree.chars().all(|letter| is_word(letter) || " :{},*".contains(letter))
        }) else {
            rest += statement;
            continue;
        };
        let mut found = Vec::new();
        leaves(&statement[at + 4..], &[], &mut found);
        let is_passed_on = statement[..at].trim_end().ends_with(")") && statement[..at].contains("pub(")
            || statement[..at].trim_end().ends_with("pub");
        if !is_passed_on {
            module.used.extend(found.iter().map(|(path, _)| path.clone()));
        }
        module.imported.extend(found);
        rest += &statement[..at];
    }
    for start in ["crate::", "super::"] {
        let ends = |letter: char| !is_word(letter) && letter != ':';
        let paths = rest.split(start).skip(1).filter_map(|rest| rest.split(ends).next());
        module
            .used
            .extend(paths.map(|path| [vec![start.trim_end_matches(':').to_owned()], words(path)].concat()));
    }
    module
}

/// The file in which a path ends: that of the definition, behind whatever passes it on.
fn home(modules: &BTreeMap<Name, Module>, from: &[String], path: &[String], steps: u32) -> Option<Name> {
    if steps == 0 {
        return None;
    }
    let mut place = from.to_vec();
    let mut path = path;
    while let [first, rest @ ..] = path {
        match first.as_str() {
            "crate" => place.clear(),
            "self" => {}
            "super" => drop(place.pop()),
            _ => break,
        }
        path = rest;
    }
    while let [first, rest @ ..] = path
        && modules.contains_key(&[&place[..], std::slice::from_ref(first)].concat())
    {
        place.push(first.clone());
        path = rest;
    }
    let module = modules.get(&place)?;
    let (name, behind) = path.split_first()?;
    if module.defined.contains(name) {
        return Some(place);
    }
    module.imported.iter().filter(|(_, known)| known == name || known == "*").find_map(|(path, known)| {
        let (last, folder) = path.split_last()?;
        let path = if known == "*" {
            [folder, std::slice::from_ref(name)].concat()
        } else {
            [folder, std::slice::from_ref(last)].concat()
        };
        home(modules, &place, &[&path[..], behind].concat(), steps - 1)
    })
}

fn modules(folder: &Path, name: &[String], found: &mut BTreeMap<Name, Module>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let stem = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let own = match stem.as_str() {
            "tests" => continue,
            "mod" | "lib" => name.to_vec(),
            _ => [name, &[stem]].concat(),
        };
        if path.is_dir() {
            modules(&path, &own, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.insert(own, module(&std::fs::read_to_string(&path).unwrap()));
        }
    }
}

/// The imports of each file from others, those between a folder and its files left out.
fn arrows(modules: &BTreeMap<Name, Module>) -> BTreeSet<(String, String)> {
    let is_folder =
        |folder: &Name, file: &Name| file.split_last().is_some_and(|(_, before)| before == folder);
    let mut arrows = BTreeSet::new();
    for (name, module) in modules {
        for path in &module.used {
            if let Some(other) = home(modules, name, path, PASSED_ON)
                && other != *name
                && !is_folder(&other, name)
                && !is_folder(name, &other)
            {
                arrows.insert((name.join("::"), other.join("::")));
            }
        }
    }
    arrows
}

/// The arrows that are left when those are removed, again and again, that come from nowhere or lead to an end.
fn circles(mut arrows: BTreeSet<(String, String)>) -> BTreeSet<(String, String)> {
    loop {
        let [from, to]: [BTreeSet<String>; 2] = [
            arrows.iter().map(|(from, _)| from.clone()).collect(),
            arrows.iter().map(|(_, to)| to.clone()).collect(),
        ];
        let before = arrows.len();
        arrows.retain(|arrow| to.contains(&arrow.0) && from.contains(&arrow.1));
        if arrows.len() == before {
            return arrows;
        }
    }
}

#[test]
fn imports_run_one_way() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut closing = Vec::new();
    for name in CRATES {
        let mut found = BTreeMap::new();
        modules(&root.join(name).join("src"), &[], &mut found);
        let mut arrows = arrows(&found);
        assert!(arrows.len() > 100, "only {} imports were found in {name}", arrows.len());
        for (_, from, to) in ALLOWED.iter().filter(|allowed| allowed.0 == name) {
            assert!(
                arrows.remove(&((*from).to_owned(), (*to).to_owned())),
                "{from} does not import from {to}"
            );
        }
        closing.extend(circles(arrows).into_iter().map(|(from, to)| format!("{name}: {from} -> {to}")));
    }
    assert!(closing.is_empty(), "these imports close circles:\n{}", closing.join("\n"));
}
