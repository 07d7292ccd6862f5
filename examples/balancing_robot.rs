//! A robot that balances on two wheels: from the declaration to a controller that withstands a push.
//!
//! ```text
//! cargo run --release --example balancing_robot
//! ```
//!
//! The plant is declared once, in `workshop/guen-bare/src/plant.rs`, and serves three times: as the simulated robot, as the
//! model that the controller is designed with, and inside the bare static library that would run on the robot.

use std::error::Error;
use std::process::ExitCode;

use guen::Linearization;
use guen::control::{c2d, controllability, diagonal, dlqr, poles};
use guen::prelude::*;
use guen_study::{Plot, Recording, Shape, Table, Viewer};

#[path = "../workshop/guen-bare/src/controller.rs"]
mod controller;
#[path = "common/folder.rs"]
mod folder;
#[path = "../workshop/guen-bare/src/plant.rs"]
mod plant;

use controller::{Gain, OPERATIONS_PER_PERIOD, Reference};
use plant::Robot;
use plant::robot::{self, Inputs, State};

/// The controller's period, in seconds, and the steps in which the plant is simulated meanwhile.
const PERIOD: f64 = 0.005;
const STEPS: usize = 5;
const UNTIL: f64 = 12.0;

/// The speed that it is to drive with.
const CRUISE: f64 = 0.8;

/// Somebody pushes the chassis for a tenth of a second.
const PUSH: f64 = 150.0;
const PUSHED: std::ops::Range<f64> = 4.0..4.1;

/// What the controller has to achieve.
const LARGEST_TILT: f64 = 0.5;
const SPEED_ERROR: f64 = 0.01;
const HEADING_ERROR: f64 = 0.01;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let robot = Robot {
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
        torque_max: 3.0,
        g: 9.81,
    }
    .prepare()?;

    // 1. Where to stand. Upright at rest is one of a family: any place, any heading. Newton's method confirms it.
    let places = ["x", "y", "heading", "left", "right", "push"];
    let guess = State { tilt: 0.1, ..Default::default() };
    let (upright, held) = robot.equilibrium(0.0, &guess, &Inputs::default(), &places)?;
    println!(
        "upright: tilt {:.1e}, torques {:.1e} and {:.1e}",
        upright.tilt, held.left_torque, held.right_torque
    );

    // 2. The linear model there, on the leaf: one wheel's angle follows from the other's and the heading.
    let leaf = robot.reduce(0.0, &upright, &held, &["x", "y", "heading", "tilt", "left"])?;
    println!("the brackets reach all of a leaf of dimension {}", robot::GROWTH.last().unwrap_or(&0));

    // 3. What can be controlled there. Not everything: no wheel moves the robot sideways while it stands.
    let all = controllability(&leaf.linear, 1e-9);
    match all.require() {
        Ok(_) => {
            return Err(
                "a robot on wheels that cannot slip is controllable at rest: something is wrong".into()
            );
        }
        Err(error) => println!("the whole leaf: {error}"),
    }
    // So the places and the wheels are left to whoever plans the path.
    let fed_back = ["heading", "tilt", "speed", "turn", "fall"];
    let rows = fed_back.map(|name| leaf.place(name).unwrap_or(0));
    let linear = Linearization {
        a: rows.map(|i| rows.map(|j| leaf.linear.a[i][j])),
        b: rows.map(|i| [leaf.linear.b[i][0], leaf.linear.b[i][1]]),
    };
    controllability(&linear, 1e-9).require()?;

    // 4. The gain: the discrete model over one period, and the Riccati equation for it.
    let model = c2d(&linear, PERIOD)?;
    let regulator = dlqr(&model, &diagonal([4.0, 20.0, 6.0, 0.5, 1.0]), &diagonal([0.3, 0.3]))?;
    let slowest = poles(&regulator.closed_loop(&model)).ok_or("no poles")?.map(|pole| pole.magnitude());
    let slowest = slowest.into_iter().fold(0.0, f64::max);
    let gain: Gain = regulator.gain;
    let mut table = Table::new(&fed_back).digits(4);
    for row in &gain {
        table.row(row);
    }
    println!("\ngains of the two motors, in newton metres per radian, metre per second, ..\n{table}");
    println!("the slowest mode keeps {slowest:.4} of its size in a period");
    println!("one period: {OPERATIONS_PER_PERIOD}\n");

    // Friction in the motors asks for a torque while it drives: that of the steady motion at this speed.
    let guess = State { speed: CRUISE, ..upright };
    let (_, cruising) = robot.steady_motion(
        0.0,
        &guess,
        &held,
        &["x", "y", "heading", "left", "right"],
        &["speed", "push", "turn"],
    )?;

    // 5. The run: start off balance, set off, turn, and be pushed. The motors are held during each period.
    let mut state = State { tilt: 0.1, ..Default::default() };
    let mut record: Vec<(f64, State, Inputs)> = Vec::new();
    let mut at_limit = 0;
    for k in 0..(UNTIL / PERIOD) as usize {
        let t = k as f64 * PERIOD;
        let reference = reference(t, cruising.left_torque);
        let (torques, _) = controller::period(&robot, &gain, &reference, &state, PERIOD);
        at_limit += usize::from(torques.left_torque.abs() == robot.constants().torque_max);
        let inputs = Inputs { push: if PUSHED.contains(&t) { PUSH } else { 0.0 }, ..torques };
        record.push((t, state, inputs));
        let plant = robot.driven(inputs);
        let end =
            Integration::new(&plant, t, &state.into()).run(&Rk4::new(PERIOD / STEPS as f64), t + PERIOD)?;
        state = end.state.into();
    }

    let mut table =
        Table::new(&["t", "x", "y", "heading", "tilt", "speed", "left torque", "right torque"]).digits(4);
    for (t, s, u) in record.iter().step_by(record.len() / 12) {
        table.row(&[*t, s.x, s.y, s.heading, s.tilt, s.speed, u.left_torque, u.right_torque]);
    }
    println!("{table}\n");
    draw(&record)?;
    play(&robot, &record)?;

    // 6. Did it work?
    let tilt = record.iter().map(|(_, s, _)| s.tilt.abs()).fold(0.0, f64::max);
    let aim = reference(UNTIL, 0.0);
    let (speed, heading) = ((state.speed - aim.speed).abs(), (state.heading - aim.heading).abs());
    println!("largest tilt {tilt:.3}; errors at the end: speed {speed:.1e}, heading {heading:.1e}");
    println!("the left motor was at its limit in {at_limit} of {} periods", record.len());
    let works = tilt < LARGEST_TILT && speed < SPEED_ERROR && heading < HEADING_ERROR && at_limit > 0;
    Ok(if works { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// What the robot is told: stand, drive, turn to the left while driving.
fn reference(t: f64, holding: f64) -> Reference {
    let speed = (0.8 * (t - 1.0)).clamp(0.0, CRUISE);
    let turning = t.clamp(6.0, 9.0);
    let turn = if turning == t { 0.5 } else { 0.0 };
    Reference { heading: 0.5 * (turning - 6.0), speed, turn, torque: holding * speed / CRUISE }
}

fn draw(record: &[(f64, State, Inputs)]) -> Result<(), Box<dyn Error>> {
    let pictures = folder::folder("balancing_robot");
    let curve = |f: fn(&State, &Inputs) -> f64| record.iter().map(move |(t, s, u)| (*t, f(s, u)));
    Plot::new("Balance: the push comes after four seconds")
        .axes("t in s", "")
        .line("tilt, in rad", curve(|s, _| s.tilt))
        .line("speed, in m/s", curve(|s, _| s.speed))
        .line("heading, in rad", curve(|s, _| s.heading))
        .save(pictures.join("balance.svg"))?;
    Plot::new("The path of the axle")
        .axes("x in m", "y in m")
        .equal_scale(true)
        .line("", record.iter().map(|(_, s, _)| (s.x, s.y)))
        .mark_ends(true)
        .save(pictures.join("path.svg"))?;
    Plot::new("The motors and their limits")
        .axes("t in s", "torque in N m")
        .line("left", curve(|_, u| u.left_torque))
        .line("right", curve(|_, u| u.right_torque))
        .save(pictures.join("torques.svg"))?;
    println!("pictures: balance.svg, path.svg and torques.svg in {}", pictures.display());
    Ok(())
}

/// The run as a page. The wheels draw themselves, by their mass and inertia; the chassis is told to have an axle.
fn play(robot: &robot::Prepared, record: &[(f64, State, Inputs)]) -> Result<(), Box<dyn Error>> {
    const METRES_PER_NEWTON: f64 = 0.004;
    let mut recording = Recording::new(&State::NAMES);
    for (t, state, _) in record {
        recording.record(*t, &(*state).into());
    }
    let inputs = |t: f64| record[((t / PERIOD).round() as usize).min(record.len() - 1)].2;
    let Robot { m, h, b, r, A, B, C, .. } = robot.constants();
    let height = r + h;
    // The box that has these moments of inertia, and below it an axle between two struts.
    let edges = [B + C - A, A + C - B, A + B - C].map(|moments| (6.0 * moments / m).sqrt());
    let strut = |y: f64| Shape::rod([0.0, y, -h], [0.0, y, -edges[2] / 2.0], 0.02).coloured(0x4a525b);
    let chassis = [
        Shape::cuboid(edges),
        strut(edges[1] / 3.0),
        strut(-edges[1] / 3.0),
        Shape::rod([0.0, -b, -h], [0.0, b, -h], 0.018).coloured(0x4a525b),
    ];
    let page = folder::folder("balancing_robot").join("robot.html");
    Viewer::new("A robot that balances on two wheels, drives, is pushed and turns", &recording)
        .bodies(robot)
        .drawn("chassis", chassis)
        .arrow("push", 0.012, |t, state| {
            let State { x, y, heading, .. } = (*state).into();
            let length = METRES_PER_NEWTON * inputs(t).push;
            let [c, s] = [heading.cos(), heading.sin()];
            let behind = 0.15 + length;
            [[x - behind * c, y - behind * s, height], [length * c, length * s, 0.0]]
        })
        .path("middle of the axle", |_, state| [state[0], state[1], 0.0])
        .panel("lean in rad")
        .curve("tilt", |_, state| State::from(*state).tilt)
        .panel("speed in m/s, turn in rad/s")
        .curve("speed", |_, state| State::from(*state).speed)
        .curve("turn", |_, state| State::from(*state).turn)
        .panel("torques in N m")
        .curve("left", |t, _| inputs(t).left_torque)
        .curve("right", |t, _| inputs(t).right_torque)
        .follow("chassis")
        .write(&page)?;
    println!("to play: {}", page.display());
    Ok(())
}
