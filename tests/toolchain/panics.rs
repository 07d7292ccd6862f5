//! Right-hand sides, and runs with fixed steps, cannot panic and do not allocate: the library in `tests/panics` has each of
//! them as a symbol, and in what is linked of it there is no panic handler and no allocator.
//!
//! The proof is the compiler's: with optimisation and across all crates it removes every test for a bound that it can show
//! to hold. What is left of a panic is a call of the handler, which is a function by itself that cannot be inlined. A library
//! without `std` and `alloc` has no allocator to call.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use crate::{commands, elf};

use guen_benchmarks::chains::{Angles, declaration};

/// The systems of the library. `tilt` is a scene, `carried` a carried form, `projected` one that is put back onto its constraints.
const SYSTEMS: [&str; 10] =
    ["hoop", "carried", "tilt", "sled", "chain", "robot", "train", "cart", "circle", "projected"];
/// What is done with each.
const PATHS: [&str; 12] = [
    "rhs",
    "jacobian",
    "euler",
    "rk4",
    "compensated",
    "rk8",
    "gauss4",
    "gauss6",
    "watched",
    "landing",
    "period5",
    "period8",
];
/// What is done with some.
const FURTHER: [&str; 6] =
    ["hoop_series", "sled_series", "hoop_dop853", "hoop_tsit5", "hoop_radau5", "hoop_taylor"];

/// The program that calls these functions: its place.
fn linked(library: &Path, called: &[&str], name: &str) -> PathBuf {
    let program = commands::scratch("panics").join(name);
    let list: String = called.iter().map(|name| format!("F({name})")).collect();
    let main = commands::root().join("tests/panics/main.c");
    commands::run(
        commands::cc().arg(format!("-DCALLED={list}")).arg(main).arg(library).arg("-o").arg(&program),
    );
    program
}

/// Whether there is a function in a program whose name has this in it; none if the file is not understood.
fn has(program: &Path, part: &str) -> Option<bool> {
    let symbols = elf::symbols(&fs::read(program).unwrap())?;
    Some(symbols.keys().any(|name| name.contains(part)))
}

#[test]
#[ignore = "optimised builds: `.ci/run` asks for it"]
fn hot_paths_cannot_panic_and_have_no_allocator() {
    if cfg!(windows) {
        return;
    }
    let library = commands::static_library("guen-panics");
    let names: Vec<String> =
        SYSTEMS.iter().flat_map(|system| PATHS.map(|path| format!("{system}_{path}"))).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).chain(FURTHER).collect();
    let program = linked(&library, &names, "all");
    let Some(panics) = has(&program, "halted") else {
        println!("the program is no 64-bit ELF file: its symbols are not checked");
        return;
    };
    for part in ["3std", "5alloc", "__rust_alloc", "malloc"] {
        assert_eq!(has(&program, part), Some(false), "{part}");
    }
    // That a handler is found where there is one.
    let probe = linked(&library, &["probe_panics"], "probe");
    assert_eq!(has(&probe, "halted"), Some(true));
    if panics {
        let guilty: Vec<&&str> = names
            .iter()
            .filter(|name| has(&linked(&library, &[name], "one"), "halted") == Some(true))
            .collect();
        panic!("these can panic: {guilty:?}");
    }
    // They are no shells: runs come to their ends.
    let done = Command::new(&program).status().unwrap().code().unwrap();
    println!("{done} of {} came to their end", names.len());
    assert!(2 * usize::try_from(done).unwrap() > names.len(), "{done} of {}", names.len());
}

/// The chain of ten links stands in a file of the library, which cannot ask the benchmarks for it.
#[test]
fn the_chain_is_that_of_the_benchmarks() {
    let file = commands::root().join("tests/panics/src/chain.rs");
    let text = format!("guen::mechanical_system! {{ {} }}\n", declaration("Chain10", 10, Angles::Absolute));
    if env::var_os("GUEN_BLESS").is_some() {
        fs::write(&file, &text).unwrap();
    }
    assert!(
        fs::read_to_string(&file).is_ok_and(|found| found == text),
        "write tests/panics/src/chain.rs anew with `GUEN_BLESS=1 cargo test -p guen-tests --test toolchain the_chain`"
    );
}
