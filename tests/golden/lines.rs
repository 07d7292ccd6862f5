//! Lines of operation counts: what a declaration costs, and how the lines differ from those of a file.

use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

use guen_language::derive::DerivedSystem;
use guen_language::derive::function::{MASS_FORM, MOMENTA, REACTIONS, RHS};
use guen_symbolic::OperationCount;

/// Momenta, mass forms and reactions of more operations have a line.
const LARGE: u32 = 200;

/// What is derived from a declaration while the test runs.
pub fn derived<T>(name: &str, text: &str, look: impl FnOnce(&DerivedSystem<'_>) -> T) -> T {
    let (declaration, _) = guen_language::parse::parse(text.parse().unwrap());
    let declaration = declaration.unwrap();
    let (derived, report) = guen_language::diagnostics::collect(|faults| {
        let model = guen_language::model::resolve(&declaration, faults)?;
        guen_language::derive::derive(model, faults)
    });
    assert!(report.is_empty(), "{name}: {:?}", report.to_compile_errors().to_string());
    look(&derived.unwrap())
}

/// The lines of a declaration that is derived here: of its rates and their preparation, then of what is large beside them.
pub fn row(name: &str, text: &str) -> String {
    derived(name, text, |derived| {
        let program = |function: &str| derived.system.program(function).map(|program| program.cost);
        let [rates, preparation] =
            [program(RHS).unwrap(), derived.system.programs.prepare_cost].map(|count| counts(six(count)));
        let mut lines = format!("{name:11} {rates}  |{preparation}\n");
        for function in [MOMENTA, MASS_FORM, REACTIONS] {
            if let Some(count) = program(function).filter(|count| count.operations() > LARGE) {
                let _ = writeln!(lines, "{:21} {}  |", format!("{name}/{function}"), counts(six(count)));
            }
        }
        lines
    })
}

/// Additions, negations, multiplications, divisions, roots and calls.
pub fn six(count: OperationCount) -> [u32; 6] {
    let OperationCount { additions, negations, multiplications, divisions, roots, .. } = count;
    [additions, negations, multiplications, divisions, roots, count.sines + count.calls]
}

/// Six counts as they stand in a line.
pub fn counts(six: [u32; 6]) -> String {
    six.map(|count| format!(" {count:4}")).concat()
}

/// What the kinds of operations cost in units of a multiplication, as the optimiser weighs them.
const WEIGHTS: [u32; 6] = [1, 1, 1, 4, 6, 20];

/// The weighted cost of the right-hand side in a line, and with its preparation.
fn totals(line: &str) -> (u32, u32) {
    let (rates, preparation) = line.split_once('|').unwrap_or((line, ""));
    let numbers =
        |part: &str| -> Vec<u32> { part.split_whitespace().filter_map(|word| word.parse().ok()).collect() };
    let sum =
        |part: &str| numbers(part).iter().zip(WEIGHTS).map(|(count, weight)| count * weight).sum::<u32>();
    (sum(rates), sum(rates) + sum(preparation))
}

/// Compares lines with a file, or writes it anew if `GUEN_BLESS` is set for the command that runs the test.
pub fn compared(path: &Path, lines: &str, command: &str) {
    if env::var_os("GUEN_BLESS").is_some() {
        fs::write(path, lines).unwrap();
        return;
    }
    let changes = changes(&fs::read_to_string(path).unwrap(), lines);
    assert!(
        changes.is_empty(),
        "{changes}if this is meant, write {} anew with `GUEN_BLESS=1 {command}`",
        path.display()
    );
}

/// What differs, a line for each system; empty if nothing does.
pub fn changes(golden: &str, found: &str) -> String {
    let name = |line: &str| line.split_whitespace().next().unwrap_or_default().to_owned();
    let lines = |text: &str| -> Vec<String> {
        text.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
    };
    let (golden, found) = (lines(golden), lines(found));
    let mut changes = String::new();
    for line in &found {
        match golden.iter().find(|known| name(known) == name(line)) {
            Some(known) if known == line => {}
            Some(known) => {
                let verdict = if totals(line) > totals(known) { "REGRESSION" } else { "no dearer" };
                let _ = writeln!(changes, "{verdict}\n  was {known}\n  is  {line}");
            }
            None => {
                let _ = writeln!(changes, "a new system\n  is  {line}");
            }
        }
    }
    for line in golden.iter().filter(|line| found.iter().all(|new| name(new) != name(line))) {
        let _ = writeln!(changes, "a system that is gone\n  was {line}");
    }
    changes
}
