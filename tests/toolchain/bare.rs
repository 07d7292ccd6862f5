//! The controller of `workshop/guen-bare` on a machine without operating system: the static library is built, linked to a
//! C program, and its run compared with that of the same code here, bit for bit; what the program consists of is
//! listed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{commands, elf};

#[path = "../../workshop/guen-bare/src/controller.rs"]
mod controller;
#[path = "../../workshop/guen-bare/src/plant.rs"]
mod plant;

use controller::{Gain, OPERATIONS_PER_PERIOD, Reference};
use plant::Robot;
use plant::robot::{self, Prepared, State};

const PERIODS: usize = 2000;

/// Code and constants of the three functions of the library together; what is beyond it has crept in.
const LARGEST_CODE: u64 = 24_000;

/// Bytes of stack of one period: some dozens of doubles for the stages, and what the compiler keeps beside them.
const LARGEST_STACK: usize = 4_096;

/// The program in C, linked to the library.
fn program(library: &Path) -> PathBuf {
    let program = commands::scratch("bare").join("robot");
    let bare = commands::root().join("workshop/guen-bare/include");
    let main = commands::root().join("tests/bare/main.c");
    commands::run(
        commands::cc().args(["-pthread", "-I"]).arg(bare).arg(main).arg(library).arg("-o").arg(&program),
    );
    program
}

fn prepared() -> Prepared {
    Robot {
        m: 10.0,
        mw: 1.0,
        h: 0.5,
        b: 0.3,
        r: 0.1,
        A: 0.5,
        B: 0.4,
        C: 0.2,
        I: 0.003,
        J: 0.005,
        c: 0.01,
        torque_max: 1.5,
        g: 9.81,
    }
    .prepare()
    .unwrap()
}

const GAIN: Gain = [[-2.5, -21.0, -3.0, -1.05, -4.4], [2.5, -21.0, -3.0, 1.05, -4.4]];

/// What the program in C prints, from the same code in Rust.
fn expected() -> String {
    let bits = |values: &[f64]| values.iter().map(|x| format!("{:016x} ", x.to_bits())).collect::<String>();
    let robot = prepared();
    let reference = Reference { heading: 0.3, speed: 0.8, turn: 0.0, torque: 0.08 };
    let mut state = State { tilt: 0.1, speed: 0.2, turn: 0.1, fall: -0.3, ..Default::default() };
    let mut torques = robot::Inputs::default();
    let mut text = String::new();
    let mut at_limit = 0;
    for _ in 0..PERIODS {
        (torques, state) = controller::period(&robot, &GAIN, &reference, &state, 0.005);
        at_limit += usize::from(torques.left_torque.abs() == 1.5);
        text += &bits(&<[f64; 9]>::from(state));
        text += &bits(&<[f64; 3]>::from(torques));
        text += "\n";
    }
    // The run is one of a controller that works: it saturates, and then holds.
    assert!(at_limit > 0 && at_limit < PERIODS / 2, "{at_limit}");
    assert!(state.tilt.abs() < 0.05 && (state.speed - 0.8).abs() < 0.1, "{state:?}");
    text += &bits(&<[f64; 9]>::from(robot.rhs(0.0, &state, &torques)));
    text + "\n" + &OPERATIONS_PER_PERIOD.total().to_string() + "\n"
}

#[test]
#[ignore = "optimised builds: `.ci/run` asks for it"]
fn a_c_program_runs_the_bare_library_bit_for_bit() {
    if cfg!(windows) {
        return;
    }
    let library = commands::static_library("guen-bare");
    let program = program(&library);
    let found = commands::run(Command::new(&program).arg(PERIODS.to_string())).0;
    let expected = expected();
    for (k, (found, expected)) in found.lines().zip(expected.lines()).enumerate() {
        assert_eq!(found, expected, "period {k}");
    }
    assert_eq!(found.lines().count(), PERIODS + 2);

    let stack: usize = commands::run(Command::new(&program).arg("stack")).0.trim().parse().unwrap();
    println!("one period takes {stack} bytes of stack");
    assert!(stack > 0 && stack < LARGEST_STACK, "{stack}");

    let Some(symbols) = elf::symbols(&std::fs::read(&program).unwrap()) else {
        println!("the program is no 64-bit ELF file: its symbols are not checked");
        return;
    };
    check_symbols(&symbols);
}

/// Nothing of `std`, nothing that panics, and not more code than there was.
fn check_symbols(symbols: &BTreeMap<String, u64>) {
    let named = |part: &str| symbols.keys().filter(|name| name.contains(part)).collect::<Vec<_>>();
    let of_library: BTreeMap<_, _> = symbols.iter().filter(|(name, _)| is_rust(name)).collect();
    let size: u64 = of_library.values().copied().sum();
    println!("{size} bytes of code and constants from Rust:");
    of_library.iter().for_each(|(name, size)| println!("{size:8}  {name}"));
    for function in ["guen_robot_prepare", "guen_robot_period", "guen_robot_rates", "guen_robot_operations"] {
        assert!(symbols.contains_key(function), "{function}");
    }
    assert_eq!(named("3std"), Vec::<&String>::new());
    assert_eq!(named("alloc"), Vec::<&String>::new());
    assert_eq!(named("halted"), Vec::<&String>::new(), "something can panic");
    assert!(size < LARGEST_CODE, "{size}");
}

fn is_rust(name: &str) -> bool {
    ["guen", "_ZN", "_R", "rust_"].iter().any(|part| name.starts_with(part))
}

#[path = "counting.rs"]
mod counting;

/// The constant number of operations, counted one by one.
#[test]
#[allow(non_snake_case, reason = "the constants have their names from the declaration")]
fn the_operations_of_a_period() {
    use counting::{Counted, counted};
    let constants = prepared().constants();
    let given = [
        constants.m,
        constants.mw,
        constants.h,
        constants.b,
        constants.r,
        constants.A,
        constants.B,
        constants.C,
        constants.I,
        constants.J,
        constants.c,
        constants.torque_max,
        constants.g,
    ];
    let [m, mw, h, b, r, A, B, C, I, J, c, torque_max, g] = given.map(Counted);
    let robot = Robot { m, mw, h, b, r, A, B, C, I, J, c, torque_max, g }.prepare().unwrap();
    let gain = GAIN.map(|row| row.map(Counted));
    let reference =
        Reference { heading: Counted(0.3), speed: Counted(0.8), turn: Counted(0.0), torque: Counted(0.1) };
    for tilt in [0.0, 0.4, -1.2] {
        let state = State { tilt: Counted(tilt), turn: Counted(0.3), ..Default::default() };
        let (_, count) = counted(|| controller::period(&robot, &gain, &reference, &state, Counted(0.005)));
        assert_eq!(count, OPERATIONS_PER_PERIOD);
    }
}
