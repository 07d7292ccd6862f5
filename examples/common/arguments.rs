//! What an example understands of its arguments: one that may be left out, `--open` where it makes a page, and `--help`.
//!
//! A wrong argument ends the program with status 2 and says what would be right. Status 1 is for examples that find
//! their motion, or a promise of theirs, broken.

use std::process::ExitCode;

/// The argument that was given, or the default; or the status to end with, everything having been said.
///
/// `meaning` says what `name` is and what it is by default; `read` takes a word for a value, or refuses it.
#[allow(dead_code, reason = "some examples make a page, and the others none")]
pub fn read<T>(
    about: &str,
    name: &str,
    meaning: &str,
    default: T,
    read: impl Fn(&str) -> Option<T>,
) -> Result<T, ExitCode> {
    understood(about, [name, meaning], default, read, false).map(|(value, _)| value)
}

/// The same for an example that makes a page, and whether the page is to be opened.
#[allow(dead_code, reason = "some examples make a page, and the others none")]
pub fn read_with_page<T>(
    about: &str,
    name: &str,
    meaning: &str,
    default: T,
    read: impl Fn(&str) -> Option<T>,
) -> Result<(T, bool), ExitCode> {
    understood(about, [name, meaning], default, read, true)
}

/// Whether the page is to be opened, for an example that takes nothing else; or the status to end with.
#[allow(dead_code, reason = "most examples take an argument of their own")]
pub fn read_page(about: &str) -> Result<bool, ExitCode> {
    let program = env!("CARGO_CRATE_NAME");
    let usage = format!(
        "usage: {program} [--open]\n\n  --open   show the page in a browser\n  --help   print this text"
    );
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words.iter().any(|word| word == "--help" || word == "-h") {
        println!("{about}\n\n{usage}");
        return Err(ExitCode::SUCCESS);
    }
    match words.iter().find(|word| *word != "--open") {
        None => Ok(!words.is_empty()),
        Some(wrong) => {
            eprintln!("{program} does not understand `{wrong}`\n\n{usage}");
            Err(ExitCode::from(2))
        }
    }
}

fn understood<T>(
    about: &str,
    [name, meaning]: [&str; 2],
    default: T,
    read: impl Fn(&str) -> Option<T>,
    page: bool,
) -> Result<(T, bool), ExitCode> {
    let program = env!("CARGO_CRATE_NAME");
    let (option, open) =
        if page { (" [--open]", "  --open     show the page in a browser\n") } else { ("", "") };
    let usage = format!(
        "usage: {program} [{name}]{option}\n\n  {name:<10} {meaning}\n{open}  {:<10} print this text",
        "--help"
    );
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    if words.iter().any(|word| word == "--help" || word == "-h") {
        println!("{about}\n\n{usage}");
        return Err(ExitCode::SUCCESS);
    }
    let given = words.len();
    words.retain(|word| !page || word != "--open");
    let wrong = match words.as_slice() {
        [] => return Ok((default, given > 0)),
        [word] => match read(word) {
            Some(value) => return Ok((value, given > 1)),
            None => word,
        },
        [_, second, ..] => second,
    };
    eprintln!("{program} does not understand `{wrong}`\n\n{usage}");
    Err(ExitCode::from(2))
}
