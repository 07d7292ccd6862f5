//! Sweeps: the same bits however they are run, what they cost beside a bare loop, and their memory.
//!
//! ```text
//! cargo run --release -p guen-measure --bin sweeps -- bits 1000000     # threads, lanes, parts, kills: one digest for each system
//! cargo run --release -p guen-measure --bin sweeps -- cost 60000        # time beside a loop over ensembles
//! cargo run --release -p guen-measure --bin sweeps -- memory 10000000  # the most memory of a run
//! cargo run --release -p guen-measure --bin sweeps -- quick            # both, small: what CI runs
//! sweeps part SYSTEM MOTIONS FOLDER PART PARTS                         # one part, as a job on a cluster runs it
//! sweeps merge SYSTEM MOTIONS FOLDER                                   # all parts put together
//! ```
//!
//! Ends with a nonzero status where a digest differs. Times are printed and judged by the reader.

mod bits;
mod cost;
mod systems;

use std::error::Error;
use std::process::ExitCode;

use systems::sweep;

/// The cause of a failure, in words.
type Failure = Box<dyn Error>;

fn run() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["bits", motions] => bits::compare(motions.parse()?, 20),
        ["cost", motions] => cost::compare(motions.parse()?, 9),
        ["memory", motions] => cost::memory(motions.parse()?),
        ["quick"] => {
            bits::compare(6_000, 4)?;
            cost::compare(2_000, 5)
        }
        ["part", system, motions, folder, part, parts] => {
            let part =
                sweep(system, motions.parse()?)?.part(part.parse()?, parts.parse()?)?.run_in(folder)?;
            println!("{part:?}");
            Ok(())
        }
        ["merge", system, motions, folder] => {
            println!("{}", sweep(system, motions.parse()?)?.merge([folder], folder)?.digest());
            Ok(())
        }
        _ => Err("see the head of main.rs for the arguments".into()),
    }
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
