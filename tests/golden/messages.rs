//! What a user sees after a mistake: every file under `tests/ui` is a declaration with a fault, and the file beside
//! it what the compiler shows.
//!
//! The cases run in this process, through the library behind the macro, and are drawn as the compiler draws them;
//! `tests/toolchain/messages.rs` sends a few through the compiler itself, to prove that the drawing is true. See
//! `tests/ui/README.md` for how to add one. `GUEN_BLESS=1` writes the files instead of comparing them.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use guen_language::diagnostics::{FaultReport, POINTER, collect};
use guen_language::{derive, emit, expand, expand_outline, model, names, parse, with_further_faults};
use proc_macro2::{Span, TokenStream, TokenTree};

/// A file with a faulty declaration.
struct Case {
    path: String,
    theme: String,
    text: String,
    /// What the fault is, from the first comment.
    law: String,
    /// Replacements that make the declaration sound; none where the comment says so.
    repairs: Vec<(String, String)>,
    /// How many errors there are.
    errors: usize,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("tests/ is in the repository")
}

fn overwrite() -> bool {
    std::env::var_os("GUEN_BLESS").is_some()
}

fn files(extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root().join("tests/ui")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

fn cases() -> Vec<Case> {
    files("rs").into_iter().map(|path| case(&path)).collect()
}

fn case(path: &Path) -> Case {
    let text = fs::read_to_string(path).unwrap();
    let comments: Vec<&str> =
        text.lines().map_while(|line| line.strip_prefix("//!")).map(str::trim).collect();
    let path = path.strip_prefix(root()).unwrap().display().to_string();
    let law: Vec<&str> = comments.iter().copied().take_while(|line| !line.is_empty()).collect();
    let mut case = Case {
        theme: path.split('/').nth(2).unwrap().to_owned(),
        law: law.join(" "),
        repairs: Vec::new(),
        errors: 1,
        text: text.clone(),
        path,
    };
    let mut says = false;
    for line in comments {
        if let Some(repair) = line.strip_prefix("repair: ") {
            says = true;
            if repair != "none" {
                let (wrong, right) =
                    repair.split_once("` => `").unwrap_or_else(|| panic!("{}: {line}", case.path));
                let strip = |s: &str| s.trim_start_matches('`').trim_end_matches('`').replace("\\n", "\n");
                case.repairs.push((strip(wrong), strip(right)));
            }
        } else if let Some(count) = line.strip_prefix("errors: ") {
            case.errors = count.parse().unwrap();
        }
    }
    assert!(says, "{}: a line `repair:` is missing", case.path);
    case
}

/// The tokens of every invocation of the macro in a file.
fn invocations(text: &str) -> Vec<TokenStream> {
    let mut found = Vec::new();
    let mut streams = vec![text.parse::<TokenStream>().unwrap()];
    while let Some(stream) = streams.pop() {
        let tokens: Vec<TokenTree> = stream.into_iter().collect();
        for (i, token) in tokens.iter().enumerate() {
            let TokenTree::Group(group) = token else { continue };
            let is_call = i > 1
                && tokens[i - 1].to_string() == "!"
                && matches!(&tokens[i - 2], TokenTree::Ident(name) if name == "mechanical_system");
            if is_call {
                found.push(group.stream());
            } else {
                streams.push(group.stream());
            }
        }
    }
    found
}

/// What the stages report of one invocation.
fn reports(tokens: TokenStream) -> Vec<FaultReport> {
    let (declaration, report) = parse::parse(tokens.clone());
    let Some(declaration) = declaration else { return vec![report] };
    if !report.is_empty() {
        let items = expand(tokens.clone()).to_string();
        // No case imports a component, so that none is looked for as a macro.
        assert!(items.contains("compile_error") && !items.contains("mechanical_system_with"), "{items}");
        return vec![with_further_faults(&tokens, &declaration, report)];
    }
    let mut reports = vec![report];
    let (derived, report) = collect(|faults| {
        let model = model::resolve(&declaration, faults)?;
        derive::derive(model, faults)
    });
    let fine = report.is_empty();
    reports.push(report);
    match derived {
        Some(derived) if fine => assert!(!emit::emit(derived).is_empty()),
        other => {
            assert!(!fine, "a stage failed without a message: {}", other.is_none());
            let name = &declaration.name.text;
            let is_taken = names::is_generated_item(name) || name == "Carried";
            // Nothing is derived of such a system, its outline neither.
            let is_large = reports
                .iter()
                .flat_map(|report| report.faults())
                .any(|fault| fault.message().contains("is not sparse"));
            assert_eq!(
                expand_outline(&declaration).is_empty(),
                is_taken || is_large,
                "the outline of {name}"
            );
        }
    }
    reports
}

/// An error as the compiler draws it.
fn draw(span: Span, message: &str, case: &Case) -> String {
    let (start, end) = (span.start(), span.end());
    let source = case.text.lines().nth(start.line - 1).unwrap_or_default();
    let number = start.line.to_string();
    let margin = " ".repeat(number.len());
    // On one line; a place of several lines is drawn to the end of its first one.
    let last = if end.line == start.line { end.column } else { source.chars().count() };
    let mut text = String::new();
    let mut lines = message.lines();
    let _ = writeln!(text, "error: {}", lines.next().unwrap_or_default());
    for line in lines {
        let _ = writeln!(text, "       {line}");
    }
    let _ = writeln!(text, "{margin}--> {}:{}:{}", case.path, start.line, start.column + 1);
    let _ = writeln!(text, "{margin} |");
    let _ = writeln!(text, "{number} | {source}");
    let marks = "^".repeat(last.saturating_sub(start.column).max(1));
    let _ = writeln!(text, "{margin} | {}{marks}", " ".repeat(start.column));
    text
}

fn shown(case: &Case) -> (usize, String) {
    let drawn: Vec<String> = invocations(&case.text)
        .into_iter()
        .flat_map(reports)
        .flat_map(|report| report.errors().collect::<Vec<_>>())
        .map(|(span, message)| draw(span, &message, case))
        .collect();
    (drawn.len(), drawn.join("\n"))
}

#[test]
fn every_case_is_reported_as_written() {
    let mut wrong = Vec::new();
    for case in cases() {
        let (count, drawn) = shown(&case);
        let golden = root().join(&case.path).with_extension("stderr");
        if overwrite() {
            guen_study::replace_file(&golden, |out| out.write_all(drawn.as_bytes())).unwrap();
        }
        let expected = fs::read_to_string(&golden).unwrap_or_default();
        if count != case.errors {
            wrong.push(format!("{}: {} errors, not {}\n{drawn}", case.path, count, case.errors));
        } else if expected != drawn {
            wrong.push(format!("{}: expected\n{expected}\nfound\n{drawn}", case.path));
        }
    }
    assert!(wrong.is_empty(), "{} cases differ\n\n{}", wrong.len(), wrong.join("\n\n"));
}

#[test]
fn every_repair_repairs() {
    let mut wrong = Vec::new();
    for case in cases().iter().filter(|case| !case.repairs.is_empty()) {
        let start = case.text.find("mechanical_system!").unwrap();
        let (head, body) = case.text.split_at(start);
        let mut body = body.to_owned();
        for (from, to) in &case.repairs {
            assert!(body.contains(from.as_str()), "{}: nothing to repair: `{from}`", case.path);
            body = body.replacen(from.as_str(), to, 1);
        }
        let repaired = Case { text: format!("{head}{body}"), ..self::case(&root().join(&case.path)) };
        let (count, drawn) = shown(&repaired);
        if count != 0 {
            wrong.push(format!("{}:\n{drawn}", case.path));
        }
    }
    assert!(wrong.is_empty(), "{} repairs do not repair\n\n{}", wrong.len(), wrong.join("\n\n"));
}

/// Units for names that often stand for them.
const USUAL_UNITS: [(&str, &[&str]); 5] = [
    ("kg", &["m", "M"]),
    ("m", &["l", "a", "R", "r", "x", "y", "z"]),
    ("rad", &["phi", "theta", "psi", "q", "alpha"]),
    ("m/s^2", &["g"]),
    ("kg*m^2", &["J", "I"]),
];

/// A text with units behind the names of constants and coordinates.
fn with_units(text: &str) -> String {
    let mut written = String::new();
    let mut rest = text;
    while let Some(start) = ["constants", "coordinates"].iter().filter_map(|word| rest.find(word)).min() {
        let end = rest[start..].find('}').map_or(rest.len(), |end| start + end);
        written += &rest[..start];
        for entry in rest[start..end].split_inclusive([',', '{']) {
            let name = entry.trim_start();
            let name = &name[..name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len())];
            let unit = USUAL_UNITS.iter().find(|(_, names)| names.contains(&name));
            match unit.filter(|_| !name.is_empty() && !entry.contains([':', '['])) {
                Some((unit, _)) => written += &entry.replacen(name, &format!("{name}: {unit}"), 1),
                None => written += entry,
            }
        }
        rest = &rest[end..];
    }
    written + rest
}

/// Units let nothing follow from another fault: where they fit what is right, what is wrong has its own errors alone.
#[test]
fn units_add_nothing_to_other_faults() {
    let (mut tried, mut wrong) = (0, Vec::new());
    let cases = cases();
    let repaired = cases.iter().filter(|case| !case.repairs.is_empty() && case.theme != "dimensions");
    // Every third one: each is derived twice, unoptimised.
    for case in repaired.step_by(3) {
        let annotated = with_units(&case.text);
        let start = annotated.find("mechanical_system!").unwrap();
        let mut repaired = annotated[start..].to_owned();
        for (from, to) in &case.repairs {
            repaired = repaired.replacen(from.as_str(), to, 1);
        }
        let of = |text: String| Case { text, ..self::case(&root().join(&case.path)) };
        if annotated == case.text || shown(&of(repaired)).0 > 0 {
            continue;
        }
        tried += 1;
        let (count, drawn) = shown(&of(annotated));
        if count != case.errors {
            wrong.push(format!("{}: {count} errors, not {}\n{drawn}", case.path, case.errors));
        }
    }
    assert!(tried > 45, "{tried}");
    assert!(wrong.is_empty(), "{} of {tried}\n\n{}", wrong.len(), wrong.join("\n\n"));
}

#[test]
fn every_expectation_has_a_case() {
    for golden in files("stderr") {
        assert!(golden.with_extension("rs").exists(), "{} belongs to no case", golden.display());
    }
    assert!(cases().len() >= 60);
}

/// What each theme is about, as its page says. A new folder under `tests/ui` needs a line here.
const THEMES: [(&str, &str); 16] = [
    ("components", "components, their arguments and their instances"),
    ("contacts", "contacts, grips, latches, switches and modes"),
    ("dimensions", "units and dimensions"),
    ("energies", "kinetic energy, force function, forces and gravity"),
    ("families", "counts, arrays, loops and sums"),
    ("forms", "parameters and constraints: linear, independent, as many as there are coordinates"),
    (
        "functions",
        "functions of the declaration, `fn name(x) = e;`, and of the program, `functions { name(x); }`",
    ),
    ("kinds", "scalars, vectors and rotations; what may depend on what"),
    ("limits", "bounds on the size of what is declared"),
    ("names", "unknown, reserved, declared twice"),
    ("scenes", "tracked, fixed and provided"),
    ("several", "several faults at once"),
    ("singular", "a direction without inertia"),
    ("spatial", "bodies, rotations, constraints on positions"),
    ("states", "first-order states beside the motion"),
    ("syntax", "punctuation, sections, habits from other languages"),
];

/// `docs/errors.md` and a page for every theme: all cases with one error.
#[test]
fn the_pages_of_errors_are_current() {
    let mut themes: BTreeMap<String, Vec<Case>> = BTreeMap::new();
    for case in cases().into_iter().filter(|case| case.errors == 1) {
        themes.entry(case.theme.clone()).or_default().push(case);
    }
    let mut index = String::from(
        "# Errors\n\nFor those whose declaration was refused: every mistake that the macro finds, with the line of a small example, the message and a repair. The pages are\nwritten by `GUEN_BLESS=1 cargo test -p guen-tests --test golden` from the cases under `tests/ui`, where each example is a whole\nfile, and the repairs are tried. `^` stands under the place that the compiler underlines.\n\nThe search of the book finds a message by any of its words.\n\n| page | about | errors |\n| --- | --- | --- |\n",
    );
    let mut written = Vec::new();
    for (theme, cases) in themes {
        let (_, about) =
            THEMES.iter().find(|(name, _)| *name == theme).expect("a theme has a line in THEMES");
        let _ = writeln!(index, "| [{theme}](errors/{theme}.md) | {about} | {} |", cases.len());
        let mut page = format!("# Errors: {theme}\n\nAbout {about}. [What this page is](../errors.md).\n");
        cases.iter().for_each(|case| page += &entry(case));
        written.push((format!("docs/errors/{theme}.md"), page));
    }
    written.push(("docs/errors.md".to_owned(), index));
    for (path, page) in written {
        let file = root().join(&path);
        if overwrite() {
            guen_study::replace_file(&file, |out| out.write_all(page.as_bytes())).unwrap();
        }
        let current = fs::read_to_string(&file).unwrap_or_default();
        assert!(
            current == page,
            "{path} is stale: run `GUEN_BLESS=1 cargo test -p guen-tests --test golden`"
        );
    }
}

/// The law of a case, its line, its message and its repairs.
fn entry(case: &Case) -> String {
    let (_, drawn) = shown(case);
    let message: Vec<&str> = drawn.lines().take_while(|line| !line.trim_start().starts_with("-->")).collect();
    let place: Vec<&str> = drawn.lines().skip(message.len() + 2).take(2).collect();
    // The page need not point to itself.
    let message: Vec<&str> = message.into_iter().filter(|line| line.trim() != POINTER).collect();
    let place: Vec<&str> =
        place.iter().map(|line| line.split_once(" |").map_or(*line, |(_, code)| code)).collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let least = place.iter().filter(|line| !line.is_empty()).map(|line| indent(line)).min().unwrap_or(0);
    let mut text = format!("\n## {}\n\n```text\n", case.law.trim_end_matches('.'));
    for line in place {
        let line = line.get(least..).unwrap_or_default();
        let line: String = if line.chars().count() > 160 {
            line.chars().take(160).chain(['…']).collect()
        } else {
            line.to_owned()
        };
        let _ = writeln!(text, "{}", line.trim_end());
    }
    let _ = writeln!(text, "```\n\n```text\n{}\n```", message.join("\n"));
    for (from, to) in &case.repairs {
        let repair = match (from.as_str(), to.as_str()) {
            (from, "") => format!("remove `{from}`"),
            (from, to) => format!("`{from}` becomes `{to}`"),
        };
        let _ = writeln!(text, "\nRepair: {repair}.");
    }
    text
}
