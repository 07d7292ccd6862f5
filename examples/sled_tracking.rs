//! A sled that follows a path: feed-forward from inverse dynamics, and feedback for what is left.
//!
//! ```text
//! cargo run --release --example sled_tracking
//! ```
//!
//! The sled cannot move sideways, so it cannot follow a path by pushing towards it: it has to be steered. The path gives
//! a speed and a turning at every time; errors of place change them a little; and the inverse dynamics of the declared
//! sled turn the accelerations that this takes into a thrust and a torque.

use std::error::Error;
use std::process::ExitCode;

use guen::mechanical_system;
use guen::prelude::*;
use guen_study::{Plot, Table};

#[path = "common/folder.rs"]
mod folder;

mechanical_system! {
    /// A sled on a blade, driven by a propeller and a rudder.
    pub system Sled {
        constants {
            m > 0,
            /// The mass centre ahead of the blade, and the radius of inertia about it.
            ahead, k > 0,
            /// Drag along the blade and against turning.
            drag >= 0, swirl >= 0,
            thrust_max > 0, torque_max > 0,
        }
        inputs {
            thrust in -thrust_max..thrust_max,
            torque in -torque_max..torque_max,
            /// Wind from the side, at the mass centre: unknown to the controller.
            wind,
        }
        coordinates { heading, x, y }
        let forward = vec(cos(heading), sin(heading));
        let across = vec(-sin(heading), cos(heading));
        let blade = vec(x, y);
        let center = blade + ahead*forward;
        parameters { turning = dot(heading); speed = inner(dot(blade), forward); }
        constraints { grip: inner(dot(blade), across) = 0; }
        particles { m at center; }
        kinetic_energy = m/2*k^2*turning^2;
        forces {
            thrust - drag*speed along speed;
            torque - swirl*turning along turning;
            wind*across along dot(center);
        }
        outputs {
            /// The sideways force of the ice: beyond some limit a real blade slips.
            ice = reaction(grip);
            felt = inner(dot(dot(center)), across);
        }
    }
}

const PERIOD: f64 = 0.01;
const UNTIL: f64 = 40.0;
/// Feedback: of the distance ahead, of the distance to the side and of the direction; of the velocities.
const AHEAD: f64 = 1.5;
const SIDE: f64 = 4.0;
const DIRECTION: f64 = 3.0;
const VELOCITY: f64 = 8.0;

/// What has to come out: the distance from the path after ten seconds, and the force of the ice.
const LARGEST_DISTANCE: f64 = 0.02;
const SETTLED: f64 = 10.0;
const LARGEST_ICE: f64 = 60.0;

/// A place on the path, with its first three derivatives by time: a figure of eight.
fn path<R: Real>(t: R) -> [R; 2] {
    let (slow, fast) = (R::from_ratio(3, 10), R::from_ratio(6, 10));
    [R::from_ratio(4, 1) * (slow * t).sin(), R::from_ratio(2, 1) * (fast * t).sin()]
}

/// What the path asks of the sled at a time.
struct Demand {
    place: [f64; 2],
    heading: f64,
    speed: f64,
    turning: f64,
    speed_rate: f64,
    turning_rate: f64,
}

/// Speed and turning with their rates, from three derivatives of the path by nested duals.
fn demand(t: f64) -> Demand {
    type D1 = Dual<f64, 1>;
    type D2 = Dual<D1, 1>;
    type D3 = Dual<D2, 1>;
    let seeded = D1::variable(t, 0);
    let seeded = D2 { value: seeded, tangent: [D1::one()] };
    let seeded = D3 { value: seeded, tangent: [D2::one()] };
    let [x, y] = path(seeded);
    let derivatives = |p: D3| {
        [
            p.value.value.value,
            p.value.value.tangent[0],
            p.value.tangent[0].tangent[0],
            p.tangent[0].tangent[0].tangent[0],
        ]
    };
    let ([x, dx, ddx, dddx], [y, dy, ddy, dddy]) = (derivatives(x), derivatives(y));
    let speed = dx.hypot(dy);
    let speed_rate = (dx * ddx + dy * ddy) / speed;
    let turning = (dx * ddy - dy * ddx) / (speed * speed);
    let turning_rate = (dx * dddy - dy * dddx) / (speed * speed) - 2.0 * turning * speed_rate / speed;
    Demand { place: [x, y], heading: dy.atan2(dx), speed, turning, speed_rate, turning_rate }
}

/// The inputs: feedback changes what the path demands, inverse dynamics finds what it takes.
fn control(sled: &sled::Prepared, t: f64, state: &sled::State) -> Result<sled::Inputs, Box<dyn Error>> {
    let aim = demand(t);
    let (sin, cos) = state.heading.sin_cos();
    let gap = [aim.place[0] - state.x, aim.place[1] - state.y];
    let (ahead, side) = (cos * gap[0] + sin * gap[1], -sin * gap[0] + cos * gap[1]);
    let direction = (aim.heading - state.heading).sin();
    let speed = aim.speed * (aim.heading - state.heading).cos() + AHEAD * ahead;
    let turning = aim.turning + aim.speed * (SIDE * side + DIRECTION * direction);
    let wanted = sled::State {
        speed: aim.speed_rate + VELOCITY * (speed - state.speed),
        turning: aim.turning_rate + VELOCITY * (turning - state.turning),
        ..Default::default()
    };
    // The wind is an input too, but nobody commands it: what it takes of the inputs is put on the rudder.
    let free = sled.inverse_dynamics(t, state, &wanted)?;
    let form = sled.mass_form(t, state, &free);
    let torque = free.torque + form.input[0][2] / form.input[0][1] * free.wind;
    Ok(sled.clamped(&sled::Inputs { torque, wind: 0.0, ..free }))
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let sled =
        Sled { m: 8.0, ahead: 0.15, k: 0.3, drag: 2.0, swirl: 0.4, thrust_max: 40.0, torque_max: 12.0 }
            .prepare()?;
    println!("{}", sled::REPORT.lines("Equations of motion (2.7)").join("\n"));
    // Off the path, and across it.
    let mut state = sled::State { x: 0.4, y: -0.5, heading: 1.4, speed: 0.5, ..Default::default() };
    let mut record = Vec::new();
    for k in 0..(UNTIL / PERIOD) as usize {
        let t = k as f64 * PERIOD;
        let command = control(&sled, t, &state)?;
        let inputs = sled::Inputs { wind: 1.5 * (0.7 * t).sin(), ..command };
        let outputs = sled.outputs(t, &state, &inputs);
        let aim = demand(t).place;
        record.push((t, state, inputs, outputs, (state.x - aim[0]).hypot(state.y - aim[1])));
        let driven = sled.driven(inputs);
        let end = Integration::new(&driven, t, &state.into()).run(&Rk4::new(PERIOD / 4.0), t + PERIOD)?;
        state = end.state.into();
    }

    let mut table =
        Table::new(&["t", "x", "y", "distance", "speed", "turning", "thrust", "torque", "ice"]).digits(4);
    for (t, s, u, outputs, distance) in record.iter().step_by(record.len() / 10) {
        table.row(&[*t, s.x, s.y, *distance, s.speed, s.turning, u.thrust, u.torque, outputs.ice]);
    }
    println!("\n{table}\n");
    let pictures = folder::folder("sled_tracking");
    Plot::new("The path, and the sled on it")
        .size(900, 560)
        .axes("x in m", "y in m")
        .equal_scale(true)
        .line("path", (0..2100).map(|k| path(f64::from(k) * 0.01)).map(|[x, y]| (x, y)))
        .line("sled", record.iter().map(|(_, s, ..)| (s.x, s.y)))
        .save(pictures.join("path.svg"))?;
    Plot::new("Distance from where it should be")
        .axes("t in s", "distance in m")
        .line("", record.iter().map(|(t, _, _, _, distance)| (*t, *distance)))
        .save(pictures.join("distance.svg"))?;
    Plot::new("What it takes")
        .axes("t in s", "")
        .line("thrust, in N", record.iter().map(|(t, _, u, ..)| (*t, u.thrust)))
        .line("torque, in N m", record.iter().map(|(t, _, u, ..)| (*t, u.torque)))
        .line("force of the ice, in N", record.iter().map(|(t, _, _, outputs, _)| (*t, outputs.ice)))
        .save(pictures.join("forces.svg"))?;
    println!("pictures: path.svg, distance.svg and forces.svg in {}", pictures.display());

    let distance = record.iter().filter(|row| row.0 > SETTLED).map(|row| row.4).fold(0.0, f64::max);
    let ice = record.iter().map(|row| row.3.ice.abs()).fold(0.0, f64::max);
    println!("largest distance after {SETTLED} s {distance:.4} m, largest force of the ice {ice:.1} N");
    let works = distance < LARGEST_DISTANCE && ice < LARGEST_ICE;
    Ok(if works { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
