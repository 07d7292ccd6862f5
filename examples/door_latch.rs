//! A door with a closer: it latches, is opened by its handle in a gust, hits its stop and latches again.
//!
//! ```text
//! cargo run --release --example door_latch -- --open
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
use guen_study::{ContactFrame, ExportModes, Plot, Pose, Shape};

guen::mechanical_system! {
    /// A door about its hinge, seen from above. Its closer is a spring with a damper, stretched by `closed` even when it is shut.
    pub system Door {
        constants   { m > 0 = 20, b > 0 = 0.9, k > 0 = 8, c > 0 = 9, closed > 0 = 5, wind = 22, e in 0..1 = 2/5, widest = 3/2,
                      handle = 5, calm = 8 }
        coordinates { angle }
        let R = rot_z(angle);
        bodies      { door { mass: m, inertia: diag(0, 0, m*b^2/12), center: b/2*R.x, orientation: R } }
        parameters  { rate = dot(angle); }
        switches    { gust: (t - handle)*(calm - t); }
        forces      { -k*angle - closed - c*rate + wind*gust along rate; }
        contacts {
            bolt: latch = angle, release = t - handle;
            stop: gap = widest - angle, restitution = e;
        }
    }
}

/// The closer in a part of the motion, `J q'' + c q' + k q = torque`: the state after a time, in closed form.
fn swing(door: &Door, [q, v]: [f64; 2], torque: f64, t: f64) -> [f64; 2] {
    let inertia = door.m * door.b * door.b / 3.0;
    let (decay, middle) = (door.c / (2.0 * inertia), torque / door.k);
    let omega = (door.k / inertia - decay * decay).sqrt();
    let (sine, cosine) = (omega * t).sin_cos();
    let (one, two) = (q - middle, (v + decay * (q - middle)) / omega);
    let factor = (-decay * t).exp();
    [
        middle + factor * (one * cosine + two * sine),
        factor * ((two * omega - decay * one) * cosine - (one * omega + decay * two) * sine),
    ]
}

/// The time at which a swing reaches an angle, by Newton's method from a guess.
fn reaches(door: &Door, from: [f64; 2], torque: f64, angle: f64, guess: f64) -> f64 {
    (0..50).fold(guess, |t, _| {
        let [q, v] = swing(door, from, torque, t);
        t - (q - angle) / v
    })
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "A door with a latch and a stop: when it locks, what the latch carries, how it bounces.";
    let open = match arguments::read_page(about) {
        Ok(open) => open,
        Err(status) => return Ok(status),
    };
    let door = Door::default().prepare()?;
    let constants = door.constants();
    let start = door::State { angle: 1.2, ..Default::default() };
    const END: f64 = 12.0;
    let motion = door.simulation(&start).tolerance(1e-12).run(0.0..END)?;
    println!("A door is let go at {} rad; its handle is pressed at {} s.", start.angle, constants.handle);
    checks::tell(&motion);

    // 1. By hand: between transitions the closer is a damped oscillator.
    let mut checks = checks::Checks::default();
    println!("by hand:");
    let times = |kind: TransitionKind| {
        motion.transitions().iter().filter(move |at| at.kind == kind).map(|at| at.t).collect::<Vec<f64>>()
    };
    let (locked, released, hits) =
        (times(TransitionKind::Locked), times(TransitionKind::Released), times(TransitionKind::Impact));
    let (shut, gust) = (-constants.closed, constants.wind - constants.closed);
    let first = reaches(&constants, [start.angle, 0.0], shut, 0.0, locked[0] + 0.01);
    checks.near("it latches first at", locked[0], first, 1e-9);
    let [force, ..] = motion.reaction_of("bolt", 4.0).ok_or("there is no bolt")?;
    checks.near("the latch carries against the closer, in N m", force, constants.closed, 1e-9);
    checks.near("the handle releases it at", released[0], constants.handle, 1e-12);
    let hit = reaches(&constants, [0.0, 0.0], gust, constants.widest, hits[0] - released[0] + 0.01);
    checks.near("the gust throws it onto its stop after", hits[0] - released[0], hit, 1e-9);
    let bounced = motion.at(hits[0]).rate / motion.before(hits[0]).rate;
    checks.near("the ratio of its rates there", bounced, -constants.e, 1e-12);
    checks.holds(
        "it is latched in the end",
        locked.len() == 2 && motion.mode_at(END).bolt == door::Bolt::Locked,
    );

    // 2. A picture and a page.
    let folder = folder::folder("door_latch");
    let picture = folder.join("angle.svg");
    Plot::new("A door latches, is thrown open by a gust, and latches again")
        .axes("t in s", "angle in rad")
        .moments("transition", motion.transitions().iter().map(|at| at.t))
        .line("angle", motion.sample(0.01).map(|(t, s)| (t, s.angle)))
        .save(&picture)?;
    let page = folder.join("door.html");
    let played = motion.played();
    let wall = [
        Shape::cuboid([1.0, 0.08, 2.1]).at([-0.54, 0.0, 0.0]),
        Shape::cuboid([0.6, 0.08, 2.1]).at([1.24, 0.0, 0.0]),
    ];
    let leaf = [
        Shape::cuboid([0.88, 0.04, 2.0]),
        Shape::sphere(0.04).at([0.38, -0.05, 0.0]),
        Shape::sphere(0.04).at([0.38, 0.05, 0.0]),
    ];
    motion
        .viewer(&door, "A door with a latch", &played)
        .drawn("door", leaf)
        .body("wall", wall.map(|part| part.coloured(0xb0a99f)), |_, _| Pose::at([0.0; 3]))
        .contact(&motion, "bolt", |_, &[angle, _]| {
            let (sine, cosine) = angle.sin_cos();
            ContactFrame::at([0.9 * cosine, 0.9 * sine, 0.0]).normal([-sine / 0.9, cosine / 0.9, 0.0])
        })
        .contact(&motion, "stop", |_, &[angle, _]| {
            let (sine, cosine) = angle.sin_cos();
            ContactFrame::at([0.7 * cosine, 0.7 * sine, 0.0]).normal([sine / 0.7, -cosine / 0.7, 0.0])
        })
        .plane([0.0, 0.0, -1.05], [0.0, 0.0, 1.0])
        .seen_from([0.5, 1.0, 0.9])
        .write(&page)?;
    println!("picture: {}\nto play: {}", picture.display(), page.display());
    if open {
        open::open(&page);
    }
    Ok(checks.status())
}
