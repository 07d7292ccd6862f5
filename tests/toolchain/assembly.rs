//! The machine code of the right-hand sides of hoop and sled, in an optimised build: no branch, no call but the elementary
//! functions, no bounds check, no panic, no allocation. On x86-64; elsewhere the test says that it did not run.
//!
//! One kind of branch is licensed: an elementary function that is inlined may ask whether its argument is in its range,
//! once for each call, and jump to a slow path. It is recognised by what it leads to: a call of an elementary function.
//! `cargo test -p guen-tests --test toolchain assembly -- --nocapture` lists all calls and branches that were found.

use crate::commands;

mod counted {
    hoop!(guen::mechanical_system);
    sled!(guen::mechanical_system);
}

/// Where elementary functions live: parts of the names of symbols, whichever way they are mangled.
const ELEMENTARY: [&str; 2] = ["4libm", "12guen_runtime7numbers10elementary"];

/// A line of a function that does not simply go on to the next one.
#[derive(Debug, PartialEq)]
enum Turn {
    /// A call of an elementary function.
    Elementary(String),
    /// A range check: a branch to a call of an elementary function.
    RangeCheck(String),
    /// The way back from what a range check leads to.
    Return(String),
    /// Anything else.
    Unlicensed(String),
}

/// The assembly of the library in `tests/assembly`.
fn assembly() -> String {
    let file = commands::scratch("assembly").join("assembly.s");
    // Calls by name, not through a register that was loaded from a table.
    let emit = format!("--emit=asm={}", file.display());
    let mut flags = vec!["-Crelocation-model=static", &emit];
    // Cargo knows nothing of this file. Where it has gone, other flags have the library built again.
    if !file.exists() {
        flags.push("--cfg=written_anew");
    }
    commands::optimised("guen-assembly", commands::host(), "lib", &flags);
    std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// The lines of a function: instructions and labels.
fn function<'a>(assembly: &'a str, name: &str) -> Vec<&'a str> {
    let label = format!("{name}:");
    let lines: Vec<&str> = assembly
        .lines()
        .skip_while(|line| *line != label)
        .skip(1)
        .take_while(|line| !line.trim_start().starts_with(".size") && !line.starts_with(".Lfunc_end"))
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .filter(|line| !line.starts_with('.') || line.ends_with(':'))
        .collect();
    assert!(lines.len() > 1, "{name} is in the assembly");
    lines
}

fn is_elementary(line: &str) -> bool {
    ELEMENTARY.iter().any(|place| line.contains(place))
}

/// Calls and branches of a function.
fn turns(lines: &[&str]) -> Vec<Turn> {
    let mnemonic = |line: &str| line.split_whitespace().next().unwrap_or_default().to_owned();
    // From a label on, up to where control leaves: is an elementary function called there?
    let leads_to_elementary = |target: &str| {
        let label = format!("{target}:");
        let start = lines.iter().position(|line| *line == label);
        start.is_some_and(|start| {
            let block =
                lines[start..].iter().take_while(|line| !["jmp", "ret", "retq"].contains(&&*mnemonic(line)));
            block.into_iter().any(|line| mnemonic(line).starts_with("call") && is_elementary(line))
        })
    };
    let mut found: Vec<Turn> = Vec::new();
    for (place, line) in lines.iter().enumerate() {
        let line = line.to_string();
        let target = line.split_whitespace().nth(1).unwrap_or_default().to_owned();
        let local = target.starts_with(".L");
        match &*mnemonic(&line) {
            call if call.starts_with("call") => {
                found.push(if is_elementary(&line) {
                    Turn::Elementary(line)
                } else {
                    Turn::Unlicensed(line)
                });
            }
            "jmp" if local => {
                // Behind the end of the straight line, and behind a call: the way back.
                let behind = lines[..place].iter().any(|line| mnemonic(line).starts_with("ret"));
                found.push(if behind { Turn::Return(line) } else { Turn::Unlicensed(line) });
            }
            "jmp" => {
                found.push(if is_elementary(&line) { Turn::Elementary(line) } else { Turn::Unlicensed(line) })
            }
            jump if jump.starts_with('j') || jump.starts_with("loop") => {
                let licensed = local && leads_to_elementary(&target);
                found.push(if licensed { Turn::RangeCheck(line) } else { Turn::Unlicensed(line) });
            }
            "ud2" => found.push(Turn::Unlicensed(line)),
            _ => {}
        }
    }
    found
}

#[test]
#[ignore = "optimised builds: `.ci/run` asks for it"]
fn right_hand_sides_are_straight_lines() {
    if !cfg!(target_arch = "x86_64") {
        println!("not checked: this test reads the assembly of x86-64 alone");
        return;
    }
    let assembly = assembly();
    for (name, cost) in [("hoop_rates", counted::hoop::COST), ("sled_rates", counted::sled::COST)] {
        let lines = function(&assembly, name);
        let turns = turns(&lines);
        println!("{name}: {} lines, {cost}", lines.len());
        turns.iter().for_each(|turn| println!("  {turn:?}"));
        let unlicensed: Vec<&Turn> =
            turns.iter().filter(|turn| matches!(turn, Turn::Unlicensed(_))).collect();
        assert!(unlicensed.is_empty(), "{name}: {unlicensed:?}");
        let checks = turns.iter().filter(|turn| matches!(turn, Turn::RangeCheck(_))).count();
        let calls = turns.iter().filter(|turn| matches!(turn, Turn::Elementary(_))).count();
        assert!(
            checks <= cost.calls as usize,
            "{name}: at most one range check for each of {} calls",
            cost.calls
        );
        assert!(calls <= cost.calls as usize, "{name}: {calls} calls");
    }
    // And this is what the check is able to see.
    for (name, trace) in [
        ("spoiled_by_an_index", "panic_bounds_check"),
        ("spoiled_by_a_branch", "Unlicensed(\"j"),
        ("spoiled_by_an_allocation", "alloc"),
    ] {
        let turns = turns(&function(&assembly, name));
        let unlicensed: Vec<Turn> =
            turns.into_iter().filter(|turn| matches!(turn, Turn::Unlicensed(_))).collect();
        assert!(format!("{unlicensed:?}").contains(trace), "{name}: {unlicensed:?}");
    }
}

#[test]
#[ignore = "optimised builds: `.ci/run` asks for it"]
fn a_range_check_is_what_leads_to_an_elementary_function() {
    let inlined = [
        "ucomisd %xmm1, %xmm0",
        "jae .L1",
        ".L2:",
        "mulsd %xmm0, %xmm0",
        "retq",
        ".L1:",
        "callq _ZN12guen_runtime7numbers10elementary5large4slow17h0E",
        "jmp .L2",
    ];
    let expected = [
        Turn::RangeCheck("jae .L1".into()),
        Turn::Elementary("callq _ZN12guen_runtime7numbers10elementary5large4slow17h0E".into()),
        Turn::Return("jmp .L2".into()),
    ];
    assert_eq!(turns(&inlined), expected);
    // The same branch to anything else is none.
    let other: Vec<&str> =
        inlined.iter().map(|line| if line.starts_with("callq") { "callq memcpy" } else { line }).collect();
    assert!(matches!(turns(&other)[..], [Turn::Unlicensed(_), Turn::Unlicensed(_), Turn::Return(_)]));
}
