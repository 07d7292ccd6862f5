//! The battery of extremes: every answer is right to what is printed, or a typed error, or the program fails.
//!
//! ```text
//! cargo run --release -p guen-measure --bin extremes                     # everything, some ten minutes
//! cargo run --release -p guen-measure --bin extremes -- --quick          # the shortened battery, few states for the errors
//! cargo run --release -p guen-measure --bin extremes -- --system sled    # one system alone
//! cargo run --release -p guen-measure --bin extremes -- --battery        # the battery alone
//! cargo run --release -p guen-measure --bin extremes -- --bounds         # the errors of right-hand sides alone
//! cargo run --release -p guen-measure --bin extremes -- --docs           # everything, and the tables of docs/design anew
//! ```
//!
//! With `--battery` or `--bounds`, `--docs` writes that table alone.
//!
//! Ends with 0 if all is in order, 1 if a failure was silent or an answer that is due did not come, 2 for arguments that it
//! does not know.

#![allow(clippy::result_large_err, reason = "an error keeps the state that was reached")]

mod battery;
mod bounds;
mod threads;

use std::process::ExitCode;

use battery::{Task, run, table, tasks};

const HELP: &str = "\
The battery of extremes, and the errors of right-hand sides.

    --quick          the shortened battery, and the errors at 200 states
    --system NAME    the battery of one system alone; with --bounds the systems whose names have this in them
    --battery        the battery alone
    --bounds         the errors of right-hand sides, at 10,000 states of each system, alone
    --docs           write the tables of what was asked into docs/design
    --help           this text
";

/// Random states of each system, and with `--quick`.
const STATES: [usize; 2] = [10_000, 200];
/// Fewer right answers or fewer typed errors would show a battery that asks little.
const ASKED: usize = 40;
/// The sled whose mass matrix has less left than single precision has is refused there, and no other system.
const REFUSED: usize = 1;
/// The largest errors are this part of what is allowed, or the bound would be idle.
const NEAR: f64 = 0.02;

#[derive(Default)]
struct Arguments {
    quick: bool,
    docs: bool,
    battery: bool,
    bounds: bool,
    system: Option<String>,
}

fn arguments(mut given: impl Iterator<Item = String>) -> Result<Option<Arguments>, String> {
    let mut arguments = Arguments::default();
    while let Some(word) = given.next() {
        match word.as_str() {
            "--quick" => arguments.quick = true,
            "--docs" => arguments.docs = true,
            "--battery" => arguments.battery = true,
            "--bounds" => arguments.bounds = true,
            "--system" => arguments.system = Some(given.next().ok_or("--system wants a name")?),
            "--help" | "-h" => return Ok(None),
            word => return Err(format!("unknown argument `{word}`")),
        }
    }
    let part = arguments.quick || arguments.system.is_some();
    if arguments.docs && part {
        return Err("--docs is about the whole battery".to_owned());
    }
    // What is not asked for by name is asked all the same, unless something else is.
    if !arguments.battery && !arguments.bounds {
        (arguments.battery, arguments.bounds) = (true, arguments.system.is_none());
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
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut tables = Vec::new();
    let mut in_order = true;
    if arguments.battery {
        match battery(&arguments, threads) {
            Ok((table, none_failed)) => {
                tables.push(("battery", table));
                in_order &= none_failed;
            }
            Err(fault) => {
                eprintln!("{fault}");
                return ExitCode::from(2);
            }
        }
    }
    if arguments.bounds {
        let (table, all_hold) = errors(&arguments, threads);
        tables.push(("rounding", table));
        in_order &= all_hold;
    }
    if arguments.docs
        && let Err(error) = write_docs(&tables)
    {
        eprintln!("docs/design: {error}");
        return ExitCode::FAILURE;
    }
    if in_order { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The battery: its table, and whether nothing failed.
fn battery(arguments: &Arguments, threads: usize) -> Result<(String, bool), String> {
    let all = tasks();
    let mut systems: Vec<&str> = all.iter().map(|task| task.system).collect();
    systems.dedup();
    if let Some(name) = &arguments.system
        && !systems.contains(&name.as_str())
    {
        return Err(format!("no system `{name}`; there are {}", systems.join(", ")));
    }
    let wanted = |task: &Task| {
        (task.quick || !arguments.quick) && arguments.system.as_ref().is_none_or(|name| name == task.system)
    };
    let chosen: Vec<Task> = all.into_iter().filter(wanted).collect();
    let lines = run(chosen, threads, |done, of, line, seconds| {
        eprintln!("{done} of {of}, {seconds:.1} s: {}: {}", line.system, line.asked);
    });
    for line in &lines {
        println!("{}", table::paragraph(line));
    }
    let (right, refused, failures) = table::count(&lines);
    println!("{right} answers right to what is printed, {refused} typed errors, {failures} failures");
    let idle = arguments.system.is_none() && right.min(refused) <= ASKED;
    if idle {
        println!("too little was asked");
    }
    Ok((table::markdown(&lines), failures == 0 && !idle))
}

/// The errors of right-hand sides: their table, and whether all are within the bound.
fn errors(arguments: &Arguments, threads: usize) -> (String, bool) {
    let (named, states) = (arguments.system.as_deref(), STATES[usize::from(arguments.quick)]);
    let found = bounds::all(states, threads, named, |found| {
        eprintln!("{:.1} s: right-hand side of {}", found.seconds, found.system);
    });
    let table: String = found.iter().map(ToString::to_string).collect();
    let table = format!("{}{table}", bounds::HEAD);
    println!("{table}");
    for found in found.iter().filter(|found| !found.holds()) {
        println!("{}: beyond {} u (cond + kappa); {}", found.system, bounds::FACTOR, found.worst);
    }
    let refused = found.iter().filter(|found| found.refused.is_some()).count();
    let tightest = found.iter().fold(0.0_f64, |most, found| most.max(found.whole[0][0].largest()));
    let as_expected = named.is_some() || (refused == REFUSED && tightest > NEAR * bounds::FACTOR);
    if !as_expected {
        println!("{refused} refused in single precision, largest error {tightest} u (cond + kappa)");
    }
    (table, found.iter().all(bounds::Found::holds) && as_expected)
}

/// Puts each table into its page of `docs/design`, between its marks.
fn write_docs(tables: &[(&str, String)]) -> Result<(), Box<dyn std::error::Error>> {
    for (name, table) in tables {
        let path = format!("{}/../../docs/design/{name}.md", env!("CARGO_MANIFEST_DIR"));
        let page = std::fs::read_to_string(&path)?;
        let marks = [format!("<!-- {name} begins -->"), format!("<!-- {name} ends -->")];
        let (before, rest) = page.split_once(&marks[0]).ok_or("a mark is gone")?;
        let (_, after) = rest.split_once(&marks[1]).ok_or("a mark is gone")?;
        let page = format!("{before}{}\n\n{table}\n{}{after}", marks[0], marks[1]);
        guen_study::replace_file(&path, |out| out.write_all(page.as_bytes()))?;
    }
    Ok(())
}
