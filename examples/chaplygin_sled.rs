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
use guen_study::{Monitor, Plot, Pose, Progress, Recording, Shape, Table, Viewer};

#[path = "common/folder.rs"]
mod folder;

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

    let pictures = folder::folder("chaplygin_sled");
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
    play(&sled, start, &pictures.join("sled.html"))?;

    let invariants = monitor.invariants();
    println!("largest errors: energy {:.1e} (of T(0)), constraint {residual:.1e}", invariants.energy_error);
    if invariants.within(ENERGY_ERROR, 0.0) && residual <= RESIDUAL {
        Ok(ExitCode::SUCCESS)
    } else {
        eprintln!("an invariant of the motion is broken");
        Ok(ExitCode::FAILURE)
    }
}

/// The first seconds as a page: the sled on its slope, with the sideways force at its blade.
fn play(sled: &sled::Prepared, start: sled::State, path: &Path) -> Result<(), Box<dyn Error>> {
    const SHOWN: usize = 30;
    const METRES_PER_NEWTON: f64 = 0.25;
    let Sled { alpha, beta, incline, .. } = sled.constants();
    let times: Vec<f64> = (0..=60 * SHOWN).map(|k| k as f64 / 60.0).collect();
    let mut recording = Recording::new(&sled::State::NAMES);
    Dop853::new(1e-12, 1e-12).sample(sled, 0.0, &start.into(), &times, recording.visit())?;
    let (s, c) = incline.sin_cos();
    // The plane's own axes, downhill and across, in space.
    let blade_at = |state: &[f64; 5]| [state[1] * c, state[2], -state[1] * s];
    let runner = |y: f64| Shape::cuboid([0.7, 0.025, 0.05]).at([alpha, beta + y, 0.04]);
    Viewer::new("Chaplygin's sled on a slope", &recording)
        .body(
            "sled",
            [
                Shape::cuboid([0.8, 0.44, 0.04]).at([alpha, beta, 0.12]),
                runner(0.2),
                runner(-0.2),
                Shape::cuboid([0.24, 0.012, 0.12]).at([0.0, 0.0, 0.06]).coloured(0xd55e00),
                Shape::sphere(0.03).at([alpha, beta, 0.16]).coloured(0xe69f00),
            ],
            |_, state| {
                Pose::at(blade_at(state)).turned([0.0, 1.0, 0.0], incline).turned([0.0, 0.0, 1.0], state[0])
            },
        )
        .path("blade", |_, state| blade_at(state))
        .arrow("force at the blade", 0.012, |t, state| {
            let state_then = sled::State::from(*state);
            // Along the form: sin(phi) downhill, -cos(phi) across.
            let force = METRES_PER_NEWTON * sled.reactions(t, &state_then).eta3;
            let (sin, cos) = state_then.phi.sin_cos();
            [blade_at(state), [force * sin * c, -force * cos, -force * sin * s]]
        })
        .panel("along the blade in m/s, turning in rad/s")
        .curve("eta2", |_, state| state[4])
        .curve("eta1", |_, state| state[3])
        .panel("force at the blade in N")
        .curve("reaction", |t, state| sled.reactions(t, &(*state).into()).eta3)
        .monitored(sled)
        .plane([0.0; 3], [s, 0.0, c])
        .follow("sled")
        .write(path)?;
    println!("to play: {}", path.display());
    Ok(())
}
