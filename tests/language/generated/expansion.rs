//! An expansion is a function of its tokens: the same twice, and the same in another process.

use std::env;
use std::process::Command;

const DECLARATIONS: [&str; 4] =
    [hoop!(stringify), turntable!(stringify), trailer!(stringify), cart!(stringify)];
/// Set for the process that prints what it expands.
const ASKED: &str = "GUEN_TEST_PRINT_EXPANSION";

fn expansions() -> Vec<String> {
    DECLARATIONS.iter().map(|d| guen_language::expand(d.parse().unwrap()).to_string()).collect()
}

#[test]
fn two_expansions_are_the_same() {
    let (one, other) = (expansions(), expansions());
    assert_eq!(one, other);
    for (text, name) in one.iter().zip(["Hoop", "Turntable", "Trailer", "Cart"]) {
        assert!(text.contains(&format!("pub struct {name} ")) && !text.contains("compile_error"), "{name}");
    }
}

#[test]
fn two_processes_expand_alike() {
    // FNV, so that a process need not print megabytes: any change shows.
    let digest = expansions().concat().bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    let line = format!("expansion digest {digest:016x}");
    if env::var_os(ASKED).is_some() {
        println!("{line}");
        return;
    }
    let output = Command::new(env::current_exe().unwrap())
        .args(["--exact", "generated::expansion::two_processes_expand_alike", "--nocapture"])
        .env(ASKED, "1")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("expansion digest "), "the other process printed nothing: {text}");
    assert!(text.contains(&line), "{line} is not in {text}");
}
