//! A block on a belt, held by a spring: it sticks, is torn loose, slides back and sticks again, as a violin's string does under the bow.
//!
//! ```text
//! cargo run --release --example stick_slip -- --open
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
use std::f64::consts::PI;
use std::process::ExitCode;

use guen::hybrid::TransitionKind;
use guen_study::{ContactFrame, ExportModes, Plot, Pose, Shape};

guen::mechanical_system! {
    /// A block on a belt that runs along `x`. At rest the belt holds more than in motion.
    pub system Bow {
        constants   { m > 0 = 1, k > 0 = 10, g = 9.81, belt_speed = 3/10, rest = 6/10, moving = 4/10 }
        coordinates { x, z }
        parameters  { u = dot(x); w = dot(z); }
        bodies      { block { mass: m, center: vec(x, 0, z) } }
        gravity     = vec(0, 0, -g);
        forces      { -k*x along u; }
        contacts    { belt: gap = z, slip = u - belt_speed, friction = moving, stiction = rest; }
    }
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let open = match arguments::read_page("A block on a belt: stick, slip, and the work of the belt.") {
        Ok(open) => open,
        Err(status) => return Ok(status),
    };
    let bow = Bow::default().prepare()?;
    let Bow { m, k, g, belt_speed, rest, moving } = bow.constants();
    let start = bow::State { u: belt_speed, ..Default::default() };
    let motion = bow.simulation(&start).tolerance(1e-12).run(0.0..12.0)?;
    println!("A belt runs with {belt_speed} m/s below a block on a spring.");
    checks::tell(&motion);

    // 1. By hand: it sticks until the spring pulls with the friction at rest, and swings about where it pulls with that in motion.
    let mut checks = checks::Checks::default();
    println!("by hand:");
    let omega = (k / m).sqrt();
    let [loose, middle] = [rest, moving].map(|mu| mu * m * g / k);
    let angle = (belt_speed / (omega * (loose - middle))).atan();
    let (sliding, sticking) = ((PI + 2.0 * angle) / omega, 2.0 * (loose - middle) / belt_speed);
    let of = |kind: TransitionKind| motion.transitions().iter().filter(move |at| at.kind == kind);
    let slips: Vec<f64> = of(TransitionKind::Slips).map(|at| at.t).collect();
    let sticks: Vec<f64> = of(TransitionKind::Sticks).map(|at| at.t).collect();
    checks.near("the block is torn loose first at", slips[0], loose / belt_speed, 1e-10);
    checks.near("it slides for", sticks[0] - slips[0], sliding, 1e-9);
    checks.near("the period", slips[slips.len() - 1] - slips[slips.len() - 2], sliding + sticking, 1e-9);
    // In a period the belt puts in as much as the sliding wears away: the friction times the ways of the belt and of the block over it.
    let energy = |t: f64| m / 2.0 * motion.at(t).u.powi(2) + k / 2.0 * motion.at(t).x.powi(2);
    let gained = energy(sticks[0]) - energy(slips[0]);
    let way = motion.at(sticks[0]).x - motion.at(slips[0]).x;
    checks.near("energy of spring and block while it slides", gained, moving * m * g * way, 1e-9);

    // 2. Pictures and a page.
    let folder = folder::folder("stick_slip");
    let picture = folder.join("phase.svg");
    let phase = motion.sample(0.004).map(|(_, s)| (s.x, s.u));
    Plot::new("A block on a belt: stick and slip")
        .axes("x in m", "velocity in m/s")
        .line("block", phase)
        .save(&picture)?;
    motion.plot("Stick and slip over time", &["x", "u"])?.save(folder.join("time.svg"))?;
    let page = folder.join("belt.html");
    let played = motion.played();
    const SIDE: f64 = 0.24;
    motion
        .viewer(&bow, "Stick and slip on a belt", &played)
        .drawn("block", [Shape::cuboid([SIDE; 3]).at([0.0, 0.0, SIDE / 2.0])])
        .body("wall", [Shape::cuboid([0.04, 0.5, 0.4])], |_, _| Pose::at([-1.0, 0.0, 0.2]))
        .rod("spring", 0.015, |_, &[x, ..]| [[-0.98, 0.0, SIDE / 2.0], [x - SIDE / 2.0, 0.0, SIDE / 2.0]])
        // A cleat shows how the belt runs; it comes again every two metres.
        .body("belt", [Shape::cuboid([0.03, 0.5, 0.02]).coloured(0x636363)], move |t, _| {
            Pose::at([(belt_speed * t).rem_euclid(2.0) - 0.9, 0.0, -0.005])
        })
        .contact(&motion, "belt", |_, &[x, z, ..]| {
            ContactFrame::at([x, 0.0, z]).normal([0.0, 0.0, 1.0]).along([1.0, 0.0, 0.0])
        })
        .seen_from([0.3, -1.0, 0.45])
        .write(&page)?;
    println!("picture: {}\nto play: {}", picture.display(), page.display());
    if open {
        open::open(&page);
    }
    Ok(checks.status())
}
