//! What an accuracy costs with each method, on every system that has a reference of 25 digits.
//!
//! ```text
//! cargo run --release -p guen-measure --bin work_precision                      # the first case of each system
//! RUSTFLAGS="-C target-cpu=native" cargo run --release -p guen-measure --bin work_precision
//! cargo run --release -p guen-measure --bin work_precision -- --system hoop --all
//! cargo run --release -p guen-measure --bin work_precision -- --help
//! ```
//!
//! The error is the largest difference between the end state and the reference, in any entry, in the units of the
//! declaration. Each method has the cheapest setting that holds an accuracy, found by the same search for all (`search.rs`). Those
//! are then timed in turn; a ratio is the median, with its quartiles, over the rounds. The tables at the end are Markdown, for
//! `docs/design/work-precision.md`. Ends with a nonzero status if a method does not reach an accuracy that it should.

mod methods;
mod references;
mod search;
mod systems;
mod tables;
mod timing;

use std::error::Error;
use std::process::ExitCode;

use methods::reach;
use search::Search;
use systems::{Problem, SYSTEMS};
use tables::{Choice, Findings};
use timing::Times;

/// Accuracies to choose settings for, from coarse to fine.
const ACCURACIES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];
/// An accuracy is asked for where it is so many times what the roundings of the initial state come to: those of all steps
/// are beside them.
const ABOVE_ROUNDING: f64 = 100.0;
const ROUNDS: usize = 61;
const ROUNDS_IF_QUICK: usize = 5;

const HELP: &str = "\
What an accuracy costs with each method, against references of 25 digits.

usage: work_precision [--system NAME] [--all] [--quick] [--settings]

  --system NAME  hoop, appell, sled, turntable, varying or top alone
  --all          every case of the references, not only the first of each system
  --quick        few timings: right for accuracies and evaluations, rough for times
  --settings     print every setting that was tried

Ends with 0; with 1 if a method misses an accuracy that it should reach; with 2 if it was called wrongly.";

/// What the command line says.
#[derive(Default)]
struct Arguments {
    system: Option<String>,
    all: bool,
    quick: bool,
    settings: bool,
}

/// None if help was asked for.
fn arguments() -> Result<Option<Arguments>, String> {
    let mut found = Arguments::default();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--help" | "-h" => return Ok(None),
            "--all" => found.all = true,
            "--quick" => found.quick = true,
            "--settings" => found.settings = true,
            "--system" => {
                let name = words.next().ok_or("`--system` needs a name")?;
                if !SYSTEMS.iter().any(|(known, _)| *known == name) {
                    let known = SYSTEMS.map(|(known, _)| known).join(", ");
                    return Err(format!("no system `{name}`: there are {known}"));
                }
                found.system = Some(name);
            }
            other => return Err(format!("no argument `{other}`")),
        }
    }
    Ok(Some(found))
}

/// Finds the settings of all methods on a problem and times them; adds accuracies that were missed.
fn measure(problem: &Problem, arguments: &Arguments, missed: &mut Vec<String>) -> Findings {
    let (mut choices, mut runs) = (Vec::new(), Vec::new());
    for candidate in &problem.candidates {
        let (method, knob) = (candidate.method, candidate.knob);
        let mut search = Search::new(knob, &candidate.judge);
        let found = search.cheapest(ACCURACIES, candidate.most);
        for (accuracy, setting) in found.into_iter().enumerate() {
            let limit = ACCURACIES[accuracy];
            let Some((setting, run)) = setting.and_then(|setting| Some((setting, search.at(setting)?)))
            else {
                if limit >= reach(method) && limit >= ABOVE_ROUNDING * problem.rounding {
                    missed.push(format!(
                        "{}, {}: {method} did not reach {limit:e}",
                        problem.system, problem.case
                    ));
                }
                continue;
            };
            let value = knob.value(setting, problem.span);
            choices.push(Choice { method, accuracy, value, evaluations: run.evaluations, error: run.error });
            runs.push((candidate.made)(setting));
        }
        if arguments.settings {
            let tried = search
                .tried()
                .map(|(setting, run)| (knob.value(setting, problem.span), run.evaluations, run.error));
            tables::print_tried(problem, method, tried);
        }
    }
    let runs: Vec<&dyn Fn()> = runs.iter().map(|run| &**run).collect();
    let rounds = if arguments.quick { ROUNDS_IF_QUICK } else { ROUNDS };
    let times = Times::take(&runs, rounds);
    Findings { problem: problem.system, case: problem.case.clone(), span: problem.span, choices, times }
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments = match arguments() {
        Ok(Some(arguments)) => arguments,
        Ok(None) => {
            println!("{HELP}");
            return Ok(ExitCode::SUCCESS);
        }
        Err(fault) => {
            eprintln!("{fault}\n\n{HELP}");
            return Ok(ExitCode::from(2));
        }
    };
    let wanted = |name: &str| arguments.system.as_deref().is_none_or(|system| system == name);
    let (mut all, mut missed) = (Vec::new(), Vec::new());
    for (_, problems) in SYSTEMS.into_iter().filter(|(name, _)| wanted(name)) {
        let cases = if arguments.all { usize::MAX } else { 1 };
        for problem in problems()?.iter().take(cases) {
            let findings = measure(problem, &arguments, &mut missed);
            findings.print(&ACCURACIES);
            println!("the roundings of the initial state come to {:.1e} at the end\n", problem.rounding);
            all.push(findings);
        }
    }
    tables::summary(&all, &ACCURACIES);
    for miss in &missed {
        eprintln!("{miss}");
    }
    Ok(if missed.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
