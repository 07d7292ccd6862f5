//! Messages as the compiler itself shows them: a few of the cases of `tests/ui`, whose drawing `tests/golden/messages.rs`
//! makes by itself, and what only the compiler can say, `tests/lints`.

use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use serde_json::Value;

use crate::commands;

/// What the compiler complains of a program, without its last words, which count the errors.
fn complaints(path: &str, format: &str) -> String {
    let mut compiler = commands::compiler(&commands::rustc(), "guen");
    let output = compiler.args(["--crate-type=bin", "--error-format", format]).arg(path).output().unwrap();
    assert!(!output.status.success(), "{path} compiles");
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// The complaints as a user sees them.
fn shown(path: &str) -> String {
    let text = complaints(path, "human");
    let end = text.find("error: aborting due to").unwrap_or(text.len());
    text[..end].trim_end().to_owned() + "\n"
}

fn wrong(cases: impl IntoIterator<Item = String>) -> Vec<String> {
    let mut wrong = Vec::new();
    for case in cases {
        let expected = fs::read_to_string(commands::root().join(&case).with_extension("stderr")).unwrap();
        let found = shown(&case);
        if found.trim() != expected.trim() {
            wrong.push(format!("{case}: expected\n{expected}\nfound\n{found}"));
        }
    }
    wrong
}

/// A case of every theme through the compiler, against the files that the drawing is compared with.
#[test]
fn the_compiler_shows_the_same() {
    const CHOSEN: [&str; 10] = [
        "energies/energy_cubic",
        "forms/constraint_is_the_rate_of_another",
        "kinds/input_through_a_let",
        "limits/tower_of_powers",
        "names/unknown_name_with_a_near_one",
        "scenes/fixes_a_mass_at_zero",
        "several/code_that_uses_a_faulty_system",
        "several/three_faults_in_three_sections",
        "singular/combination_without_inertia",
        "syntax/product_without_operator",
    ];
    let wrong = wrong(CHOSEN.map(|case| format!("tests/ui/{case}.rs")));
    assert!(wrong.is_empty(), "{} cases differ\n\n{}", wrong.len(), wrong.join("\n\n"));
}

/// The programs below a folder, by their paths from the root of the repository.
fn programs(folder: &str) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(commands::root().join(folder)).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        let path = format!("{folder}/{name}");
        if commands::root().join(&path).is_dir() {
            found.extend(programs(&path));
        } else if name.ends_with(".rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// All cases: a tenth of a second for each.
#[test]
#[ignore = "`.ci/run` asks for it"]
fn the_compiler_shows_the_same_in_all_cases() {
    let cases = programs("tests/ui");
    assert!(cases.len() >= 60);
    let wrong = wrong(cases);
    assert!(wrong.is_empty(), "{} cases differ\n\n{}", wrong.len(), wrong.join("\n\n"));
}

/// Messages that need the compiler: its lints, its checks of types, and faults behind macros of the program. Messages, places and labels are
/// compared. Places outside of the program are left out, as they change with the library.
#[test]
fn the_compiler_says_what_it_alone_can_say() {
    let mut wrong = Vec::new();
    let programs = programs("tests/lints");
    assert!(programs.len() >= 2);
    for path in programs {
        let mut text = String::new();
        for line in complaints(&path, "json").lines() {
            let message: Value = serde_json::from_str(line).unwrap();
            if !message["spans"].as_array().unwrap().is_empty() {
                let _ = writeln!(text, "{}", told(&message, &path, 0));
            }
        }
        let golden: PathBuf = commands::root().join(&path).with_extension("stderr");
        if std::env::var_os("GUEN_BLESS").is_some() {
            guen_study::replace_file(&golden, |out| out.write_all(text.as_bytes())).unwrap();
        }
        let expected = fs::read_to_string(&golden).unwrap_or_default();
        if expected != text {
            wrong.push(format!("{path}: expected\n{expected}\nfound\n{text}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// A message, its places in the program with their labels, and what is added to it, each on a line.
fn told(message: &Value, path: &str, depth: usize) -> String {
    let indent = "  ".repeat(depth);
    let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let code = match message["code"]["code"].as_str() {
        Some(code) => format!("[{code}]"),
        None => String::new(),
    };
    let mut text = format!("{indent}{}{code}: {}\n", word(&message["level"]), word(&message["message"]));
    for span in message["spans"].as_array().unwrap().iter().filter(|span| span["file_name"] == path) {
        let mark = if span["is_primary"] == true { "^" } else { "-" };
        let (from, to) = (&span["line_start"], &span["line_end"]);
        let (start, end) = (&span["column_start"], &span["column_end"]);
        let _ = write!(text, "{indent}  {mark} {from}:{start}..{to}:{end}");
        for key in ["label", "suggested_replacement"] {
            if let Some(label) = span[key].as_str() {
                let _ = write!(text, " {label}");
            }
        }
        text.push('\n');
    }
    // Where the compiler has put the whole name of a type is a place of this machine; which types implement a trait changes with
    // the library.
    let elsewhere = |text: &str| {
        text.contains("the full name for the type")
            || text.contains("`--verbose`")
            || text.starts_with("the following other types implement")
    };
    let children = message["children"].as_array().unwrap().iter();
    for child in children.filter(|child| !elsewhere(&word(&child["message"]))) {
        text += &told(child, path, depth + 1);
    }
    text
}
