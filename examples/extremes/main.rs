//! The battery of extremes: every answer is right to what is printed, or a typed error, or the program fails.
//!
//! ```text
//! cargo run --release --example extremes                     # everything, a few minutes
//! cargo run --release --example extremes -- --quick          # the shortened battery, which the tests run too
//! cargo run --release --example extremes -- --system sled    # one system alone
//! cargo run --release --example extremes -- --docs           # everything, and the table of docs/extremes.md anew
//! ```
//!
//! Ends with 0 if all is in order, 1 if a failure was silent or an answer that is due did not come, 2 for arguments that it
//! does not know.

mod battery;

use std::io::IsTerminal;
use std::process::ExitCode;

use battery::{Task, run, table, tasks};

const HELP: &str = "\
The battery of extremes.

    --quick          the shortened battery
    --system NAME    one system alone
    --docs           all of it, and write the table into docs/extremes.md
    --help           this text
";

/// Between these lines of the page is the table.
const MARKS: [&str; 2] = ["<!-- the table begins -->", "<!-- the table ends -->"];

#[derive(Default)]
struct Arguments {
    quick: bool,
    docs: bool,
    system: Option<String>,
}

fn arguments(mut given: impl Iterator<Item = String>) -> Result<Option<Arguments>, String> {
    let mut arguments = Arguments::default();
    while let Some(word) = given.next() {
        match word.as_str() {
            "--quick" => arguments.quick = true,
            "--docs" => arguments.docs = true,
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
    let shown = std::io::stderr().is_terminal();
    let lines = run(chosen, threads, |done, of| {
        if shown {
            eprint!("\r{done} of {of}");
        }
    });
    if shown {
        eprint!("\r               \r");
    }
    for line in &lines {
        println!("{}", table::paragraph(line));
    }
    let (right, refused, failures) = table::count(&lines);
    println!("{right} answers right to what is printed, {refused} typed errors, {failures} failures");
    if arguments.docs
        && let Err(error) = write_docs(&table::markdown(&lines))
    {
        eprintln!("docs/extremes.md: {error}");
        return ExitCode::FAILURE;
    }
    if failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Puts the table into the page.
fn write_docs(table: &str) -> Result<(), Box<dyn std::error::Error>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/extremes.md");
    let page = std::fs::read_to_string(path)?;
    let (before, rest) = page.split_once(MARKS[0]).ok_or("the mark before the table is gone")?;
    let (_, after) = rest.split_once(MARKS[1]).ok_or("the mark after the table is gone")?;
    std::fs::write(path, format!("{before}{}\n\n{table}\n{}{after}", MARKS[0], MARKS[1]))?;
    Ok(())
}
