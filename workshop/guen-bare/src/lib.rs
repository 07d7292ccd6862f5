//! A balancing robot's controller and its plant behind a C header, `include/guen_robot.h`, for a machine without an
//! operating system.
//!
//! ```text
//! cargo rustc -p guen-bare --profile bare --crate-type staticlib
//! ```
//!
//! makes a static library that needs nothing but `memcpy` and its kin. `tests/toolchain/bare.rs` at the repository's root builds
//! it, links it to the C program in `tests/bare`, and compares its run with that of the same code in Rust, bit for bit.
#![no_std]

pub mod controller;
pub mod plant;

use controller::{Gain, OPERATIONS_PER_PERIOD, Reference};
use plant::Robot;
use plant::robot::{Inputs, Prepared, State};

/// The prepared plant, as C keeps it: see `GUEN_ROBOT_WORDS` in the header.
#[repr(transparent)]
pub struct Plant(Prepared<f64>);

/// The doubles that the header reserves for a plant.
const WORDS: usize = 128;
const _: () = assert!(size_of::<Plant>() <= 8 * WORDS && align_of::<Plant>() == 8);

/// The constants, in the order of the declaration.
#[repr(C)]
pub struct Constants {
    values: [f64; 13],
}

/// A state, in the order of the declaration.
#[repr(C)]
pub struct Values {
    values: [f64; 9],
}

/// The torques of the left and of the right motor, and a push.
#[repr(C)]
pub struct Torques {
    values: [f64; 3],
}

/// The feedback, a row for each motor.
#[repr(C)]
pub struct Gains {
    values: Gain,
}

// SAFETY of the names below: each is exported once, and begins with the name of this library.

/// Prepares a plant; returns whether the constants were accepted. A plant that was not prepared stays as it was.
#[allow(unsafe_code, reason = "a name for C")]
#[unsafe(no_mangle)]
pub extern "C" fn guen_robot_prepare(constants: &Constants, plant: &mut Plant) -> bool {
    #[allow(non_snake_case, reason = "the constants have their names from the declaration")]
    let [m, mw, h, b, r, A, B, C, I, J, c, torque_max, g] = constants.values;
    match (Robot { m, mw, h, b, r, A, B, C, I, J, c, torque_max, g }).prepare() {
        Ok(prepared) => {
            *plant = Plant(prepared);
            true
        }
        Err(_) => false,
    }
}

/// One period of the controller: the torques, and the state after `step` seconds in place of the state.
#[allow(unsafe_code, reason = "a name for C")]
#[unsafe(no_mangle)]
pub extern "C" fn guen_robot_period(
    plant: &Plant,
    gain: &Gains,
    reference: &Reference,
    step: f64,
    state: &mut Values,
    torques: &mut Torques,
) {
    let (inputs, next): (Inputs, State) =
        controller::period(&plant.0, &gain.values, reference, &State::from(state.values), step);
    state.values = next.into();
    torques.values = inputs.into();
}

/// The rates of a state under given torques.
#[allow(unsafe_code, reason = "a name for C")]
#[unsafe(no_mangle)]
pub extern "C" fn guen_robot_rates(plant: &Plant, state: &Values, torques: &Torques, rates: &mut Values) {
    rates.values = plant.0.rhs(0.0, &State::from(state.values), &Inputs::from(torques.values)).into();
}

/// The operations of one period.
#[allow(unsafe_code, reason = "a name for C")]
#[unsafe(no_mangle)]
pub extern "C" fn guen_robot_operations() -> u32 {
    OPERATIONS_PER_PERIOD.total()
}

/// What the machine does if the impossible happens. Only where panics abort: elsewhere `std` brings its own.
#[cfg(panic = "abort")]
#[panic_handler]
fn handler(_: &core::panic::PanicInfo<'_>) -> ! {
    halted()
}

/// Out of line, so that whoever looks at the program's symbols sees whether anything in it can panic.
#[cfg(panic = "abort")]
#[inline(never)]
fn halted() -> ! {
    loop {
        core::hint::spin_loop();
    }
}
