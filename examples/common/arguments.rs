//! What an example understands of its arguments: one that may be left out, and `--help`.
//!
//! A wrong argument ends the program with status 2 and says what would be right. Status 1 is for examples that find
//! their motion, or a promise of theirs, broken.

use std::process::ExitCode;

/// The argument that was given, or the default; or the status to end with, everything having been said.
///
/// `meaning` says what `name` is and what it is by default; `read` takes a word for a value, or refuses it.
pub fn read<T>(
    about: &str,
    name: &str,
    meaning: &str,
    default: T,
    read: impl Fn(&str) -> Option<T>,
) -> Result<T, ExitCode> {
    let program = env!("CARGO_CRATE_NAME");
    let usage =
        format!("usage: {program} [{name}]\n\n  {name:<10} {meaning}\n  {:<10} print this text", "--help");
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words.iter().any(|word| word == "--help" || word == "-h") {
        println!("{about}\n\n{usage}");
        return Err(ExitCode::SUCCESS);
    }
    let wrong = match words.as_slice() {
        [] => return Ok(default),
        [word] => match read(word) {
            Some(value) => return Ok(value),
            None => word,
        },
        [_, second, ..] => second,
    };
    eprintln!("{program} does not understand `{wrong}`\n\n{usage}");
    Err(ExitCode::from(2))
}
