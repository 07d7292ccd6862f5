//! Motions to look at: a ball on a turntable and a car with a trailer, as pages that play in a browser without network.
//!
//! ```text
//! cargo run --release --example viewer             # both, to target/guen/viewer
//! cargo run --release --example viewer -- --help
//! ```
//!
//! The ball draws itself by its inertia; what a car looks like has to be said. `docs/viewing.md` explains the calls.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use guen::mechanical_system;
use guen::prelude::*;
use guen_study::{Pose, Recording, Shape, Viewer};

#[path = "common/folder.rs"]
mod folder;

mechanical_system! {
    /// A ball that rolls on a table which turns at a given rate.
    pub system Turntable {
        constants   { m > 0, a > 0, Omega, g = 9.81, I > 0 = 2/5*m*a^2 }
        coordinates { w, i, j, k, x, y }
        let R = quaternion(w, i, j, k);
        bodies { ball { mass: m, inertia: diag(I, I, I), center: vec(x, y, a), orientation: R } }
        gravity = vec(0, 0, -g);
        let contact = vec(x, y, 0);
        constraints { rolling: ball.velocity_at(contact) = cross(vec(0, 0, Omega), contact); }
        holonomic   { length: w^2 + i^2 + j^2 + k^2 = 1; }
        parameters  { omega = angular_velocity(R); }
        outputs     { on_table = rot_z(-Omega*t)*contact; }
    }
}

mechanical_system! {
    /// A car with a trailer, from above: its wheels do not slip sideways.
    pub system CarWithTrailer {
        constants   { m > 0, I > 0, l > 0, d > 0, k > 0 }
        inputs      { push, steering }
        coordinates { x, y, theta, beta, phi }
        let C = rot_z(theta);
        let T = rot_z(beta);
        let F = C*rot_z(phi);
        let rear = vec(x, y);
        let axle = rear - k*C.x - d*T.x;
        bodies {
            car     { mass: m, inertia: diag(0, 0, I), center: rear + l/2*C.x, orientation: C }
            wheels  { inertia: diag(0, 0, I/20), orientation: F }
            trailer { mass: m/2, inertia: diag(0, 0, I/2), center: axle, orientation: T }
        }
        parameters { speed = inner(C.x, dot(rear)); steer = dot(phi); }
        constraints {
            rear_axle:    inner(C.y, car.velocity_at(rear)) = 0;
            front_axle:   inner(F.y, car.velocity_at(rear + l*C.x)) = 0;
            trailer_axle: inner(T.y, trailer.velocity_at(axle)) = 0;
        }
        forces {
            push along speed;
            vec(0, 0, steering) along wheels.angular_velocity - car.angular_velocity;
        }
        outputs { hitch = beta - theta; }
    }
}

const HELP: &str = "\
Writes pages that play a motion in a browser.

usage: viewer [turntable | car] [--to FOLDER]

  turntable     a ball on a turning table
  car           a car with a trailer
  --to FOLDER   where to write, instead of target/guen/viewer
  --help        this text

Without a name both are written.";

/// Samples of a second.
const RATE: f64 = 60.0;

fn main() -> ExitCode {
    let mut names: Vec<String> = Vec::new();
    let mut folder = folder::folder("viewer");
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "-h" | "--help" => {
                println!("{HELP}");
                return ExitCode::SUCCESS;
            }
            "turntable" | "car" => names.push(argument),
            "--to" => match arguments.next() {
                Some(given) => folder = given.into(),
                None => return misused("`--to` needs a folder"),
            },
            other => return misused(&format!("`{other}` is none of the motions and options")),
        }
    }
    let wanted = |name: &str| names.is_empty() || names.iter().any(|known| known == name);
    let mut done = Ok(());
    if wanted("turntable") {
        done = done.and_then(|()| turntable(&folder.join("turntable.html")));
    }
    if wanted("car") {
        done = done.and_then(|()| car(&folder.join("car.html")));
    }
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn misused(what: &str) -> ExitCode {
    eprintln!("error: {what}\n\n{HELP}");
    ExitCode::from(2)
}

fn times(until: f64) -> Vec<f64> {
    (0..=(RATE * until) as usize).map(|k| k as f64 / RATE).collect()
}

/// In space the ball runs on a circle; on the table it draws a flower.
fn turntable(path: &Path) -> Result<(), Box<dyn Error>> {
    use turntable::State;
    let system = Turntable::new(0.2, 0.08, 1.8).prepare_physical()?;
    let start = State { w: 1.0, x: 0.55, omega_x: 9.0, omega_y: 1.0, ..Default::default() };
    let rate = system.constants().Omega;
    let mut recording = Recording::new(&State::NAMES);
    Dop853::new(1e-11, 1e-11).sample(&system, 0.0, &start.into(), &times(30.0), recording.visit())?;

    let table = [
        Shape::disc(0.8, 0.03).at([0.0, 0.0, -0.015]).coloured(0xb8a07a),
        Shape::cylinder(0.05, 0.4).at([0.0, 0.0, -0.23]).coloured(0x777777),
    ];
    Viewer::new("A ball on a turntable", &recording)
        .bodies(&system)
        .body("table", table, |t, _| Pose::at([0.0; 3]).turned([0.0, 0.0, 1.0], rate * t))
        .path("contact, in space", |_, state| [state[4], state[5], 0.002])
        .force("force at the contact in N", |t, state| {
            let state = State::from(*state);
            let force = system.reactions(t, &state);
            [[state.x, state.y, 0.004], [force.rolling_x, force.rolling_y, 0.0]]
        })
        .panel("place on the table in m")
        .curve("x", |t, state| system.outputs(t, &(*state).into()).on_table[0])
        .curve("y", |t, state| system.outputs(t, &(*state).into()).on_table[1])
        .panel("angular velocity in rad/s")
        .curve("x", |_, state| state[6])
        .curve("y", |_, state| state[7])
        .monitored(&system)
        .residuals(&turntable::Residuals::NAMES, |t, state| system.residuals(t, &(*state).into()).into())
        .plane([0.0, 0.0, -0.43], [0.0, 0.0, 1.0])
        .write(path)?;
    println!("to play: {}", path.display());
    Ok(())
}

/// It sets off, turns to the left, to the right, and goes straight on.
fn car(path: &Path) -> Result<(), Box<dyn Error>> {
    use car_with_trailer::{Inputs, State};
    let system = CarWithTrailer { m: 900.0, I: 1200.0, l: 2.5, d: 2.4, k: 0.9 }.prepare()?;
    let mut state = State::default();
    let mut recording = Recording::new(&State::NAMES);
    let times = times(22.0);
    recording.record(0.0, &state.into());
    for step in times.windows(2) {
        let [t, next] = [step[0], step[1]];
        // A driver: a speed to hold, and an angle of the wheels to reach by a spring and a damper.
        let aim = 0.42 * f64::sin(0.55 * t);
        let inputs = Inputs {
            push: 900.0 * (4.0 - state.speed),
            steering: 60.0 * (25.0 * (aim - state.phi) - 10.0 * state.steer),
        };
        let driven = system.driven(inputs);
        let end = Integration::new(&driven, t, &state.into()).run(&Rk4::new((next - t) / 4.0), next)?;
        state = end.state.into();
        recording.record(next, &state.into());
    }

    let constants = system.constants();
    let wheel =
        |x: f64, y: f64| Shape::disc(0.32, 0.2).about([0.0, 1.0, 0.0]).at([x, y, 0.32]).coloured(0x4a525b);
    let [from_rear, half_track] = [constants.l / 2.0, 0.75];
    let body = [
        Shape::cuboid([3.7, 1.6, 0.55]).at([0.05, 0.0, 0.6]),
        Shape::cuboid([1.8, 1.35, 0.5]).at([-0.25, 0.0, 1.12]).coloured(0x9fb4c6),
        wheel(-from_rear, half_track),
        wheel(-from_rear, -half_track),
        Shape::rod([-from_rear, 0.0, 0.42], [-from_rear - constants.k, 0.0, 0.42], 0.05).coloured(0x555c64),
    ];
    let trailer = [
        Shape::cuboid([2.6, 1.6, 0.9]).at([0.0, 0.0, 0.95]),
        wheel(0.0, half_track),
        wheel(0.0, -half_track),
        Shape::rod([1.3, 0.0, 0.55], [constants.d, 0.0, 0.42], 0.05).coloured(0x555c64),
    ];
    let axle_of_trailer = |state: &[f64; 7]| {
        let State { x, y, theta, beta, .. } = (*state).into();
        [
            x - constants.k * theta.cos() - constants.d * beta.cos(),
            y - constants.k * theta.sin() - constants.d * beta.sin(),
            0.01,
        ]
    };
    let front = |side: f64| {
        move |_: f64, state: &[f64; 7]| {
            let State { x, y, theta, phi, .. } = (*state).into();
            let [c, s] = [theta.cos(), theta.sin()];
            let place = [x + constants.l * c - side * s, y + constants.l * s + side * c, 0.0];
            Pose::at(place).turned([0.0, 0.0, 1.0], theta + phi)
        }
    };
    Viewer::new("A car with a trailer", &recording)
        .bodies(&system)
        .drawn("car", body)
        .drawn("trailer", trailer)
        .body("front wheel, left", [wheel(0.0, 0.0)], front(half_track))
        .body("front wheel, right", [wheel(0.0, 0.0)], front(-half_track))
        .path("rear axle", |_, state| [state[0], state[1], 0.01])
        .path("axle of the trailer", |_, state| axle_of_trailer(state))
        .panel("speed in m/s")
        .curve("speed", |_, state| state[5])
        .panel("angles in rad")
        .curve("wheels", |_, state| state[4])
        .curve("hitch", |_, state| state[3] - state[2])
        .follow("car")
        .write(path)?;
    println!("to play: {}", path.display());
    Ok(())
}
