//! A driven wheel rolls onto ice, spins there, and grips again behind it.
//!
//! ```text
//! cargo run --release --example spinning_wheel -- --open
//! ```

#[path = "common/arguments.rs"]
mod arguments;
#[path = "common/checks.rs"]
mod checks;
#[path = "common/folder.rs"]
mod folder;
#[path = "common/open.rs"]
mod open;

use std::error::Error;
use std::process::ExitCode;

use guen::hybrid::TransitionKind;
use guen_study::{ContactFrame, ExportModes, Plot, Shape};

const TORQUE: f64 = 60.0;
const ICE: [f64; 2] = [5.0, 9.0];

guen::mechanical_system! {
    /// A wheel with its share of a car, in the plane of the motion: `x` ahead, `z` up.
    pub system Wheel {
        constants   { m > 0 = 20, a > 0 = 3/10, J > 0 = 9/10, g = 9.81, road = 1, on_ice = 1/10, ice_from = 5, ice_to = 9 }
        inputs      { torque }
        coordinates { x, z, phi }
        bodies      { wheel { mass: m, center: vec(x, z), inertia: diag(0, 0, J), orientation: rot_z(-phi) } }
        gravity     = vec(0, -g);
        parameters  { ahead = dot(x); up = dot(z); spin = dot(phi); }
        forces      { torque along spin; }
        switches    { ice: (x - ice_from)*(ice_to - x); }
        let touching = vec(x, z - a);
        contacts    { tyre: gap = z - a, slip = wheel.velocity_at(touching).x, friction = road + (on_ice - road)*ice; }
    }
}

/// The later time at which something that moves with an acceleration reaches a distance.
fn reached(distance: f64, speed: f64, acceleration: f64) -> f64 {
    ((speed * speed + 2.0 * acceleration * distance).sqrt() - speed) / acceleration
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let open = match arguments::read_page(
        "A driven wheel on a road with ice: where it spins, and when it grips again.",
    ) {
        Ok(open) => open,
        Err(status) => return Ok(status),
    };
    let wheel = Wheel::default().prepare()?;
    let Wheel { m, a, J: inertia, g, road, on_ice, .. } = wheel.constants();
    let start = wheel::State { z: a, ahead: 2.0, spin: 2.0 / a, ..Default::default() };
    let driven = wheel.driven(wheel::Inputs { torque: TORQUE });
    let motion = driven.simulation(&start).tolerance(1e-12).run(0.0..3.0)?;
    println!("A wheel is driven with {TORQUE} N m; from {} m to {} m there is ice.", ICE[0], ICE[1]);
    checks::tell(&motion);

    // 1. The same by hand: every part of the way has constant accelerations.
    let mut checks = checks::Checks::default();
    println!("by hand:");
    let rolling = TORQUE / a / (m + inertia / (a * a));
    let onto_ice = reached(ICE[0], start.ahead, rolling);
    let speed = start.ahead + rolling * onto_ice;
    let across = reached(ICE[1] - ICE[0], speed, on_ice * g);
    let spun = speed + a * (TORQUE - on_ice * m * g * a) / inertia * across;
    let after = speed + on_ice * g * across;
    let approach = road * g - a * (TORQUE - road * m * g * a) / inertia;
    let grips = onto_ice + across + (spun - after) / approach;
    let times: Vec<f64> = motion.transitions().iter().map(|at| at.t).collect();
    checks.near("the time at which it begins to spin", times[0], onto_ice, 1e-9);
    checks.near("the time at which it leaves the ice", times[1], onto_ice + across, 1e-9);
    checks.near("the time at which it grips again", times[times.len() - 1], grips, 1e-9);
    checks.near(
        "the speed of the rim over the road behind the ice",
        -slip(&motion.at(times[1]), a),
        spun - after,
        1e-8,
    );
    let gripped = motion.transitions().last().is_some_and(|at| at.kind == TransitionKind::Sticks);
    checks.holds("it grips in the end", gripped && motion.mode_at(3.0).tyre == wheel::Tyre::Stick);

    // 2. A picture and a page.
    let folder = folder::folder("spinning_wheel");
    let picture = folder.join("speeds.svg");
    let curve =
        |value: fn(&wheel::State, f64) -> f64| motion.sample(0.005).map(move |(t, s)| (t, value(&s, a)));
    Plot::new("A wheel spins on ice and grips again")
        .axes("t in s", "speed in m/s")
        .moments("transition", times)
        .line("wheel ahead", curve(|s, _| s.ahead))
        .line("rim about the hub", curve(|s, a| a * s.spin))
        .save(&picture)?;
    let page = folder.join("wheel.html");
    let played = motion.played();
    motion
        .viewer(&driven, "A wheel on ice", &played)
        .drawn("wheel", [Shape::ring(0.26, 0.04), Shape::rod([-0.24, 0.0, 0.0], [0.24, 0.0, 0.0], 0.02)])
        .contact(&motion, "tyre", |_, &[x, z, ..]| {
            ContactFrame::at([x, z - 0.3, 0.0]).normal([0.0, 1.0, 0.0]).along([1.0, 0.0, 0.0])
        })
        .body("ice", [Shape::cuboid([ICE[1] - ICE[0], 0.02, 1.2]).coloured(0x9ecae1)], |_, _| {
            guen_study::Pose::at([(ICE[0] + ICE[1]) / 2.0, -0.015, 0.0])
        })
        .force_length(0.003)
        .plane([0.0; 3], [0.0, 1.0, 0.0])
        .upward([0.0, 1.0, 0.0])
        .seen_from([0.25, 0.35, 1.0])
        .follow("wheel")
        .write(&page)?;
    println!("picture: {}\nto play: {}", picture.display(), page.display());
    if open {
        open::open(&page);
    }
    Ok(checks.status())
}

/// The velocity of the tyre over the road: negative where it spins.
fn slip(state: &wheel::State, radius: f64) -> f64 {
    state.ahead - radius * state.spin
}
