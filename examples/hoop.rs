//! A hoop that rolls on a horizontal plane: from the declaration to its motion.
//!
//! ```text
//! cargo run --release --example hoop              # one minute of motion
//! cargo run --release --example hoop -- 10000     # any other time, in seconds
//! cargo run --release --example hoop -- --open    # shows the page that it makes, where there is a desktop
//! ```
//!
//! Prints what was derived and a table of the motion, writes pictures and a page that plays the motion to
//! `target/guen/hoop`, and ends with a nonzero status if an invariant drifts.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use guen::mechanical_system;
use guen::prelude::*;
use guen_study::{Monitor, Plot, Pose, Progress, Recording, Shape, Table, Viewer, drift};

#[path = "common/arguments.rs"]
mod arguments;
#[path = "common/folder.rs"]
mod folder;
#[path = "common/open.rs"]
mod open;

mechanical_system! {
    /// A hoop of radius `a` and mass one that rolls without slipping on a horizontal plane.
    ///
    /// The forms are (3.1) and (3.2) of the paper, the kinetic energy is that of a rigid body. Nothing says which of
    /// the constraints are integrable: the derivation finds out.
    pub system Hoop {
        constants {
            /// The radius.
            a > 0,
            /// The moment of inertia about a diameter.
            A > 0,
            /// The moment of inertia about the axis.
            C > 0,
            /// The acceleration of free fall.
            g = 9.81,
        }
        coordinates {
            /// The angle between the hoop's plane and the horizontal one.
            theta,
            /// The direction in which the hoop rolls.
            psi,
            /// The hoop's own turn about its axis.
            phi,
            // The position of the centre.
            xi, eta, zeta,
        }

        let rolling = dot(psi)*cos(theta) + dot(phi);

        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = rolling;
        }
        constraints {
            eta4: dot(xi)   = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta)  + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2)
                       + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);

        outputs {
            /// The point where the hoop touches the plane.
            contact = vec(xi + a*cos(theta)*sin(psi), eta - a*cos(theta)*cos(psi));
            /// The integral that hides in the constraints: the height of the centre follows from the tilt.
            hidden = zeta - a*sin(theta);
        }
    }
}

/// The time of the run unless another one is asked for, in seconds.
const MINUTE: f64 = 60.0;
/// The largest errors that one minute may leave.
const ENERGY_ERROR: f64 = 1e-10;
const HIDDEN_ERROR: f64 = 1e-10;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "A hoop that rolls on a horizontal plane: from the declaration to its motion.";
    let seconds = |word: &str| word.parse().ok().filter(|time: &f64| time.is_finite());
    let (until, open) = match arguments::read_with_page(
        about,
        "SECONDS",
        "the time of the run; one minute by default",
        MINUTE,
        seconds,
    ) {
        Ok(given) => given,
        Err(status) => return Ok(status),
    };

    // 1. What the macro found while this program was compiled.
    println!("{}", hoop::REPORT);
    // The compiler knows it too: this line would not compile for a holonomic system.
    const { assert!(!hoop::CLASS.is_holonomic() && hoop::INTEGRABLE == 1) }

    // 2. Numbers for the constants, checked once; then a state to begin with.
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare()?;
    let start = hoop::State {
        theta: 1.0,
        zeta: hoop.constants().a * f64::sin(1.0),
        eta2: 3.0,
        eta3: 0.9,
        ..Default::default()
    };

    // 3. The motion, by a method of order 8 with error control.
    let begin = start.into();
    let hidden = |t: f64, state: &[f64; 9]| hoop.outputs(t, &hoop::State::from(*state)).hidden;
    let hidden_start = hidden(0.0, &begin);
    let mut hidden_error = 0.0_f64;
    let mut monitor = Monitor::new(&hoop, 0.0, &begin);
    // Every step of the first minute, and as many of the whole run as fit into bounded memory.
    let mut minute = Recording::new(&hoop::State::NAMES);
    let mut recording = Recording::new(&hoop::State::NAMES).with_limit(10_000);
    minute.record(0.0, &begin);
    recording.record(0.0, &begin);
    let mut progress = Progress::new(0.0, until);
    let method = Dop853::new(1e-12, 1e-12).with_max_steps(u64::MAX);
    let done = method.integrate(&hoop, 0.0, &begin, until, |t, state| {
        progress.at(t);
        monitor.at(t, state);
        hidden_error = hidden_error.max((hidden(t, state) - hidden_start).abs());
        if t.abs() <= MINUTE {
            minute.record(t, state);
        }
        recording.record(t, state);
        ControlFlow::Continue(())
    })?;
    progress.finish();

    // 4. The motion in numbers.
    let energy_start = hoop.energy(0.0, &start);
    let mut table = Table::new(&[
        "t",
        "theta",
        "psi",
        "contact x",
        "contact y",
        "energy error",
        "constraint error",
        "height error",
    ])
    .digits(5);
    for column in 5..8 {
        table = table.column_digits(column, 2);
    }
    for (t, state) in recording.spread(13) {
        let state = hoop::State::from(*state);
        let outputs = hoop.outputs(t, &state);
        let residual =
            <[f64; 3]>::from(hoop.residuals(t, &state)).into_iter().fold(0.0, |m, r| r.abs().max(m));
        table.row(&[
            t,
            state.theta,
            state.psi,
            outputs.contact[0],
            outputs.contact[1],
            hoop.energy(t, &state) / energy_start - 1.0,
            residual,
            outputs.hidden - hidden_start,
        ]);
    }
    println!("{table}\n");
    println!("{} steps, {} right-hand sides", done.statistics.accepted, done.statistics.evaluations);

    // 5. The motion in pictures.
    let pictures = folder::folder("hoop");
    let contact = minute.iter().map(|(t, state)| {
        let [x, y, _] = hoop.outputs(t, &hoop::State::from(*state)).contact;
        (x, y)
    });
    Plot::new("The track of the contact point in the first minute")
        .size(640, 640)
        .axes("x in m", "y in m")
        .equal_scale(true)
        .line("", contact)
        .mark_ends(true)
        .save(pictures.join("track.svg"))?;
    Plot::new("The tilt of the hoop, in its first seconds")
        .axes("t in s", "theta in rad")
        .line("", minute.curve(0).take_while(|&(t, _)| t.abs() <= MINUTE / 4.0))
        .save(pictures.join("tilt.svg"))?;
    Plot::new("What the integration gets wrong")
        .axes("t in s", "error")
        .line("energy, relative", drift(&hoop, &recording))
        .line("zeta - a sin(theta), in m", recording.iter().map(|(t, x)| (t, hidden(t, x) - hidden_start)))
        .save(pictures.join("drift.svg"))?;
    println!("pictures: track.svg, tilt.svg and drift.svg in {}", pictures.display());
    let page = pictures.join("hoop.html");
    play(&hoop, start, until, &page)?;
    if open {
        open::open(&page);
    }

    // 6. What has to hold.
    let invariants = monitor.invariants();
    println!(
        "largest errors: energy {:.1e} (relative), zeta - a sin(theta) {hidden_error:.1e}",
        invariants.energy_error
    );
    let allowed = f64::max(1.0, until.abs() / MINUTE);
    if invariants.within(ENERGY_ERROR * allowed, 0.0) && hidden_error <= HIDDEN_ERROR * allowed {
        Ok(ExitCode::SUCCESS)
    } else {
        eprintln!("an invariant of the motion is broken");
        Ok(ExitCode::FAILURE)
    }
}

/// The first seconds as a page: the hoop on its plane, where it touches it, and its invariants.
fn play(hoop: &hoop::Prepared, start: hoop::State, until: f64, path: &Path) -> Result<(), Box<dyn Error>> {
    const PICTURES_PER_SECOND: f64 = 60.0;
    const THICKNESS: f64 = 0.1;
    let shown = until.clamp(-MINUTE / 2.0, MINUTE / 2.0);
    let count = (shown.abs() * PICTURES_PER_SECOND).ceil().max(1.0);
    let times: Vec<f64> = (0..=count as usize).map(|k| shown * k as f64 / count).collect();
    let mut recording = Recording::new(&hoop::State::NAMES);
    Dop853::new(1e-12, 1e-12).sample(hoop, 0.0, &start.into(), &times, recording.visit())?;
    let radius = hoop.constants().a;
    Viewer::new("A hoop rolls on a plane", &recording)
        .body("hoop", [Shape::ring(radius - THICKNESS / 2.0, THICKNESS)], |_, state| {
            let hoop::State { theta, psi, phi, xi, eta, zeta, .. } = (*state).into();
            Pose::at([xi, eta, zeta])
                .turned([0.0, 0.0, 1.0], psi)
                .turned([1.0, 0.0, 0.0], theta)
                .turned([0.0, 0.0, 1.0], phi)
        })
        .path("contact", |t, state| hoop.outputs(t, &(*state).into()).contact)
        .panel("tilt in rad")
        .curve("theta", |_, state| state[0])
        .monitored(hoop)
        .panel("zeta - a sin(theta), which no constraint says")
        .curve("hidden", |t, state| hoop.outputs(t, &(*state).into()).hidden)
        .write(path)?;
    println!("to play: {}", path.display());
    Ok(())
}
