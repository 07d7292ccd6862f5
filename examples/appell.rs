//! Appell's holonomic system: the hoop's kinetic energy, other constraints, other equations.
//!
//! ```text
//! cargo run --release --example appell
//! ```
//!
//! All three constraints are integrable, so (2.7) are Poincaré's equations and the kinetic energy on the constraints
//! says everything. Compare what is printed with the example `hoop`: the operators (3.8) are closed under the
//! bracket, those of the hoop (3.3) are not, and the equations (3.11) lack the terms `a^2 eta1` of (3.6).

use std::error::Error;
use std::process::ExitCode;

use guen::mechanical_system;
use guen::prelude::*;
use guen_study::{Monitor, Plot, Progress, Recording, Table, drift};

#[path = "common/folder.rs"]
mod folder;

mechanical_system! {
    /// The system of Appell's Mécanique rationnelle, no. 469, as the paper declares it: (3.2), (3.7), (3.10).
    pub system Appell {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = dot(psi)*cos(theta) + dot(phi);
        }
        constraints {
            eta4: dot(xi)   + a*sin(theta)*dot(theta) = 0;
            eta5: dot(eta)  = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        // `T` on the constraints: no momentum of a constraint occurs in the equations of a holonomic system.
        kinetic_energy = 1/2*((A + a^2)*eta1^2 + A*eta2^2 + (C + a^2)*eta3^2);
        force_function = -a*g*sin(theta);

        outputs {
            /// The axis of figure.
            axis = vec(sin(theta)*sin(psi), -sin(theta)*cos(psi), cos(theta));
            /// The moment of momentum about the vertical: `psi` does not occur, so it is kept.
            moment = A*sin(theta)*eta2 + (C + a^2)*cos(theta)*eta3;
            /// The integrals of the constraints.
            shift = xi - a*cos(theta);
            height = zeta - a*sin(theta);
        }
    }
}

/// The time of the run in seconds, and the largest errors that it may leave.
const UNTIL: f64 = 20.0;
const ENERGY_ERROR: f64 = 1e-10;
const INTEGRAL_ERROR: f64 = 1e-10;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    println!("{}", appell::REPORT);
    const { assert!(appell::CLASS.is_holonomic() && appell::INTEGRABLE == 3) }

    let appell = Appell { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare()?;
    let start = appell::State {
        theta: 1.0,
        xi: f64::cos(1.0),
        zeta: f64::sin(1.0),
        eta2: 2.0,
        eta3: 3.0,
        ..Default::default()
    };

    let begin = start.into();
    let integrals = |t: f64, state: &[f64; 9]| {
        let outputs = appell.outputs(t, &appell::State::from(*state));
        [outputs.moment, outputs.shift, outputs.height]
    };
    let integrals_start = integrals(0.0, &begin);
    let error_of = |t: f64, state: &[f64; 9]| {
        let pairs = integrals(t, state).into_iter().zip(integrals_start);
        pairs.fold(0.0, |largest, (now, before)| f64::max(largest, (now - before).abs()))
    };
    let mut integral_error = 0.0_f64;
    let mut monitor = Monitor::new(&appell, 0.0, &begin);
    let mut recording = Recording::new(&appell::State::NAMES);
    recording.record(0.0, &begin);
    let mut progress = Progress::new(0.0, UNTIL);
    Dop853::new(1e-12, 1e-12).integrate(&appell, 0.0, &begin, UNTIL, |t, state| {
        progress.at(t);
        monitor.at(t, state);
        integral_error = integral_error.max(error_of(t, state));
        recording.record(t, state);
        ControlFlow::Continue(())
    })?;
    progress.finish();

    let energy_start = appell.energy(0.0, &start);
    let mut table = Table::new(&["t", "theta", "psi", "eta2", "eta3", "energy error", "integrals"])
        .digits(5)
        .column_digits(5, 2)
        .column_digits(6, 2);
    for (t, state) in recording.spread(11) {
        let error = error_of(t, state);
        let state = appell::State::from(*state);
        let energy_error = appell.energy(t, &state) / energy_start - 1.0;
        table.row(&[t, state.theta, state.psi, state.eta2, state.eta3, energy_error, error]);
    }
    println!("{table}\n");

    let pictures = folder::folder("appell");
    let axis = recording.iter().map(|(t, state)| {
        let [x, y, _] = appell.outputs(t, &appell::State::from(*state)).axis;
        (x, y)
    });
    Plot::new("The axis of figure, seen from above")
        .size(640, 640)
        .axes("x", "y")
        .equal_scale(true)
        .line("", axis)
        .mark_ends(true)
        .save(pictures.join("axis.svg"))?;
    Plot::new("The tilt")
        .axes("t in s", "theta in rad")
        .line("", recording.curve(0))
        .save(pictures.join("tilt.svg"))?;
    Plot::new("What the integration gets wrong")
        .axes("t in s", "relative error of the energy")
        .line("", drift(&appell, &recording))
        .save(pictures.join("drift.svg"))?;
    println!("pictures: axis.svg, tilt.svg and drift.svg in {}", pictures.display());

    let invariants = monitor.invariants();
    println!(
        "largest errors: energy {:.1e} (relative), integrals {integral_error:.1e}",
        invariants.energy_error
    );
    if invariants.within(ENERGY_ERROR, 0.0) && integral_error <= INTEGRAL_ERROR {
        Ok(ExitCode::SUCCESS)
    } else {
        eprintln!("an invariant of the motion is broken");
        Ok(ExitCode::FAILURE)
    }
}
