//! Right-hand sides, and runs with fixed steps, cannot panic and do not allocate: the library in `tests/panics` has each of
//! them as a symbol, and in what is linked of it there is no panic handler and no allocator.
//!
//! The proof is the compiler's: with optimisation and across all crates it removes every test for a bound that it can show
//! to hold. What is left of a panic is a call of the handler, which is a function by itself that cannot be inlined. A library
//! without `std` and `alloc` has no allocator to call.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use guen_benchmarks::chains::{Angles, declaration};

#[path = "bare/elf.rs"]
mod elf;

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

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The library beside the target directory, with the versions that the workspace is locked to.
fn copied() -> PathBuf {
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join("panics");
    fs::create_dir_all(place.join("src")).unwrap();
    let root_text = root().display().to_string();
    for file in ["Cargo.toml", "src/lib.rs", "src/paths.rs", "src/systems.rs"] {
        let text = fs::read_to_string(root().join("tests/panics").join(file)).unwrap();
        let text = text.replace("\"../..\"", &format!("{root_text:?}")).replace("../../..", &root_text);
        fs::write(place.join(file), text).unwrap();
    }
    let chain = declaration("Chain10", 10, Angles::Absolute);
    fs::write(place.join("src/chain.rs"), format!("guen::mechanical_system! {{ {chain} }}\n")).unwrap();
    fs::copy(root().join("Cargo.lock"), place.join("Cargo.lock")).unwrap();
    place
}

fn run(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// The program that calls these functions: its place.
fn linked(place: &Path, called: &[&str], name: &str) -> PathBuf {
    let program = place.join(name);
    let list: String = called.iter().map(|name| format!("F({name})")).collect();
    run(Command::new(env::var_os("CC").unwrap_or_else(|| "cc".into()))
        .args(["-std=c11", "-Wall", "-Werror", "-O1", "-Wl,--gc-sections"])
        .arg(format!("-DCALLED={list}"))
        .arg(root().join("tests/panics/main.c"))
        .arg(place.join("target/release/libpanics_check.a"))
        .arg("-o")
        .arg(&program));
    program
}

/// Whether there is a function in a program whose name has this in it; none if the file is not understood.
fn has(program: &Path, part: &str) -> Option<bool> {
    let symbols = elf::symbols(&fs::read(program).unwrap())?;
    Some(symbols.keys().any(|name| name.contains(part)))
}

#[test]
fn hot_paths_cannot_panic_and_have_no_allocator() {
    if cfg!(windows) {
        return;
    }
    let place = copied();
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    run(Command::new(cargo)
        .args(["build", "--release", "--offline"])
        .arg("--target-dir")
        .arg(place.join("target"))
        .current_dir(&place)
        .env_remove("RUSTFLAGS"));
    let names: Vec<String> =
        SYSTEMS.iter().flat_map(|system| PATHS.map(|path| format!("{system}_{path}"))).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).chain(FURTHER).collect();
    let program = linked(&place, &names, "all");
    let Some(panics) = has(&program, "halted") else {
        println!("the program is no 64-bit ELF file: its symbols are not checked");
        return;
    };
    for part in ["3std", "5alloc", "__rust_alloc", "malloc"] {
        assert_eq!(has(&program, part), Some(false), "{part}");
    }
    // That a handler is found where there is one.
    let probe = linked(&place, &["probe_panics"], "probe");
    assert_eq!(has(&probe, "halted"), Some(true));
    if panics {
        let guilty: Vec<&&str> = names
            .iter()
            .filter(|name| has(&linked(&place, &[name], "one"), "halted") == Some(true))
            .collect();
        panic!("these can panic: {guilty:?}");
    }
    // They are no shells: runs come to their ends.
    let done = Command::new(&program).status().unwrap().code().unwrap();
    println!("{done} of {} came to their end", names.len());
    assert!(2 * usize::try_from(done).unwrap() > names.len(), "{done} of {}", names.len());
}
