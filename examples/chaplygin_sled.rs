//! Chaplygin's sled on an inclined plane: an incomplete Lie group, and a sled that drifts across instead of down.
//!
//! ```text
//! cargo run --release --example chaplygin_sled
//! ```
//!
//! Declared as an engineer would: the velocity of the centre of mass by `dot`, and not the finished formulas (3.15).
//! The derivation finds the paper's operators (3.13), brackets (3.14) and equations (3.16) from it.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use guen::mechanical_system;
use guen::prelude::*;
use guen_study::{Monitor, Plot, Progress, Recording, Table};

mechanical_system! {
    /// A sled on a plane inclined by `incline`, on a blade that does not slip sideways.
    pub system Sled {
        constants {
            m > 0,
            /// The centre of mass in the sled's axes: ahead of the blade, and to its left.
            alpha, beta,
            /// The radius of inertia about the centre of mass.
            k > 0,
            incline,
            g = 9.81,
        }
        coordinates {
            /// The direction of the blade, from the line of steepest descent.
            phi,
            /// The blade's place: downhill, and across.
            xi, eta,
        }
        parameters {
            eta1 = dot(phi);
            eta2 = dot(xi)*cos(phi) + dot(eta)*sin(phi);
        }
        constraints {
            /// The blade does not slip; its reaction is the sideways force of the snow.
            eta3: dot(xi)*sin(phi) - dot(eta)*cos(phi) = 0;
        }
        let x = xi  + alpha*cos(phi) - beta*sin(phi);
        let y = eta + alpha*sin(phi) + beta*cos(phi);
        kinetic_energy = m/2*(dot(x)^2 + dot(y)^2) + m/2*k^2*dot(phi)^2;
        force_function = m*g*sin(incline)*x;
    }
}

/// The time of the run in seconds, and the largest errors that it may leave.
const UNTIL: f64 = 60.0;
/// Relative to the kinetic energy of the start: the energy itself passes zero on the way.
const ENERGY_ERROR: f64 = 1e-9;
const RESIDUAL: f64 = 1e-13;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    println!("{}", sled::REPORT);
    const { assert!(!sled::CLASS.is_holonomic() && sled::CLASS.has_constant_coefficients()) }

    let sled = Sled { m: 1.0, alpha: 0.02, beta: 0.1, k: 0.5, incline: 0.1, g: 9.81 }.prepare()?;
    let start = sled::State { eta1: 3.0, eta2: 1.0, ..Default::default() };

    let begin = start.into();
    let energy_scale = sled.kinetic_energy(0.0, &start);
    let energy_start = sled.energy(0.0, &start);
    let error_of =
        |t: f64, state: &[f64; 5]| (sled.energy(t, &sled::State::from(*state)) - energy_start) / energy_scale;
    let residual_of = |t: f64, state: &[f64; 5]| sled.residuals(t, &sled::State::from(*state)).eta3.abs();
    let mut residual = 0.0_f64;
    let mut monitor = Monitor::new(&sled, 0.0, &begin).with_scale(energy_scale);
    let mut recording = Recording::new(&sled::State::NAMES);
    recording.record(0.0, &begin);
    let mut progress = Progress::new(0.0, UNTIL);
    Dop853::new(1e-12, 1e-12).integrate(&sled, 0.0, &begin, UNTIL, |t, state| {
        progress.at(t);
        monitor.at(t, state);
        residual = residual.max(residual_of(t, state));
        recording.record(t, state);
        ControlFlow::Continue(())
    })?;
    progress.finish();

    let mut table =
        Table::new(&["t", "phi", "xi", "eta", "eta1", "eta2", "reaction", "energy error", "residual"])
            .digits(5)
            .column_digits(7, 2)
            .column_digits(8, 2);
    for (t, state) in recording.spread(13) {
        let (energy_error, residual) = (error_of(t, state), residual_of(t, state));
        let state = sled::State::from(*state);
        let sled::State { phi, xi, eta, eta1, eta2 } = state;
        let reaction = sled.reactions(t, &state).eta3;
        table.row(&[t, phi, xi, eta, eta1, eta2, reaction, energy_error, residual]);
    }
    println!("{table}\n");

    let pictures = Path::new("target/guen/chaplygin_sled");
    Plot::new("The track of the blade: across the slope, and not down")
        .size(960, 420)
        .axes("across, in m", "uphill, in m")
        .equal_scale(true)
        .line("", recording.track(2, 1).map(|(across, downhill)| (across, -downhill)))
        .mark_ends(true)
        .save(pictures.join("track.svg"))?;
    Plot::new("The velocities of the sled")
        .axes("t in s", "")
        .line("turning, in rad/s", recording.curve(3))
        .line("along the blade, in m/s", recording.curve(4))
        .save(pictures.join("velocities.svg"))?;
    Plot::new("What the integration gets wrong")
        .axes("t in s", "error of the energy over T(0)")
        .line("", recording.iter().map(|(t, state)| (t, error_of(t, state))))
        .save(pictures.join("drift.svg"))?;
    println!("pictures: track.svg, velocities.svg and drift.svg in {}", pictures.display());

    let invariants = monitor.invariants();
    println!("largest errors: energy {:.1e} (of T(0)), constraint {residual:.1e}", invariants.energy_error);
    if invariants.within(ENERGY_ERROR, 0.0) && residual <= RESIDUAL {
        Ok(ExitCode::SUCCESS)
    } else {
        eprintln!("an invariant of the motion is broken");
        Ok(ExitCode::FAILURE)
    }
}
