//! The battery of extremes: every answer is right to what is printed, or a typed error, or the program fails.
//!
//! ```text
//! cargo run --release --example extremes                     # everything, a few minutes
//! cargo run --release --example extremes -- --quick          # the shortened battery, which the tests run too
//! cargo run --release --example extremes -- --system sled    # one system alone
//! cargo run --release --example extremes -- --bounds         # the errors of right-hand sides alone
//! cargo run --release --example extremes -- --docs           # everything, and the tables of docs/extremes.md anew
//! ```
//!
//! Ends with 0 if all is in order, 1 if a failure was silent or an answer that is due did not come, 2 for arguments that it
//! does not know.

mod battery;
mod bounds;

use std::process::ExitCode;

use battery::{Task, run, table, tasks};

const HELP: &str = "\
The battery of extremes.

    --quick          the shortened battery
    --system NAME    one system alone
    --bounds         the errors of right-hand sides at 10,000 states of each system, and nothing else
    --docs           all of it, and write the tables into docs/extremes.md
    --help           this text
";

/// Random states of each system.
const STATES: usize = 10_000;

#[derive(Default)]
struct Arguments {
    quick: bool,
    docs: bool,
    bounds: bool,
    system: Option<String>,
}

fn arguments(mut given: impl Iterator<Item = String>) -> Result<Option<Arguments>, String> {
    let mut arguments = Arguments::default();
    while let Some(word) = given.next() {
        match word.as_str() {
            "--quick" => arguments.quick = true,
            "--docs" => arguments.docs = true,
            "--bounds" => arguments.bounds = true,
            "--system" => arguments.system = Some(given.next().ok_or("--system wants a name")?),
            "--help" | "-h" => return Ok(None),
            word => return Err(format!("unknown argument `{word}`")),
        }
    }
    if arguments.docs && (arguments.quick || arguments.system.is_some()) {
        return Err("--docs is about the whole battery".to_owned());
    }
    Ok(Some(arguments))
}

fn main() -> ExitCode {
    let arguments = match arguments(std::env::args().skip(1)) {
        Ok(Some(arguments)) => arguments,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(fault) => {
            eprintln!("{fault}\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    if arguments.bounds {
        return errors(None);
    }
    let all = tasks();
    let mut systems: Vec<&str> = all.iter().map(|task| task.system).collect();
    systems.dedup();
    if let Some(name) = &arguments.system
        && !systems.contains(&name.as_str())
    {
        eprintln!("no system `{name}`; there are {}", systems.join(", "));
        return ExitCode::from(2);
    }
    let wanted = |task: &Task| {
        (task.quick || !arguments.quick) && arguments.system.as_ref().is_none_or(|name| name == task.system)
    };
    let chosen: Vec<Task> = all.into_iter().filter(wanted).collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let lines = run(chosen, threads, |done, of, line, seconds| {
        eprintln!("{done} of {of}, {seconds:.1} s: {}: {}", line.system, line.asked);
    });
    for line in &lines {
        println!("{}", table::paragraph(line));
    }
    let (right, refused, failures) = table::count(&lines);
    println!("{right} answers right to what is printed, {refused} typed errors, {failures} failures");
    let battery = if failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    if !arguments.docs {
        return battery;
    }
    let errors = errors(Some(&table::markdown(&lines)));
    if failures == 0 { errors } else { battery }
}

/// The errors of right-hand sides; with the table of the battery, both go into the page.
fn errors(battery: Option<&str>) -> ExitCode {
    let found = bounds::all(STATES);
    let table: String = found.iter().map(ToString::to_string).collect();
    let table = format!("{}{table}", bounds::HEAD);
    println!("{table}");
    if let Some(battery) = battery
        && let Err(error) = write_docs(&[("battery", battery), ("errors", &table)])
    {
        eprintln!("docs/extremes.md: {error}");
        return ExitCode::FAILURE;
    }
    for found in found.iter().filter(|found| !found.holds()) {
        println!("{}: beyond the bound of {} u (cond + kappa)", found.system, bounds::FACTOR);
    }
    if found.iter().all(bounds::Found::holds) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Puts tables into the page, each between its marks.
fn write_docs(tables: &[(&str, &str)]) -> Result<(), Box<dyn std::error::Error>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/extremes.md");
    let mut page = std::fs::read_to_string(path)?;
    for (name, table) in tables {
        let marks = [format!("<!-- {name} begins -->"), format!("<!-- {name} ends -->")];
        let (before, rest) = page.split_once(&marks[0]).ok_or("a mark is gone")?;
        let (_, after) = rest.split_once(&marks[1]).ok_or("a mark is gone")?;
        page = format!("{before}{}\n\n{table}\n{}{after}", marks[0], marks[1]);
    }
    std::fs::write(path, page)?;
    Ok(())
}
