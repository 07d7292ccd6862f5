//! A tilted block falls back, rocks from edge to edge and comes to rest: every impact takes away the same part of its rate.
//!
//! ```text
//! cargo run --release --example rocking_block -- --open
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

guen::mechanical_system! {
    /// A homogeneous block of width `2*b` and height `2*h` in its plane, `x` to the right and `y` up, on its two lower edges.
    pub system Block {
        constants   { m > 0 = 1, b > 0 = 1/2, h > 0 = 1, g = 9.81, mu >= 0 = 1 }
        coordinates { x, y, tilt }
        let R = rot_z(tilt);
        let center = vec(x, y);
        let left_edge  = center - b*R.x - h*R.y;
        let right_edge = center + b*R.x - h*R.y;
        bodies      { block { mass: m, center: center, inertia: diag(0, 0, m*(b^2 + h^2)/3), orientation: R } }
        gravity     = vec(0, -g);
        parameters  { u = dot(x); v = dot(y); rate = dot(tilt); }
        contacts {
            left:  gap = left_edge.y,  slip = block.velocity_at(left_edge).x,  friction = mu;
            right: gap = right_edge.y, slip = block.velocity_at(right_edge).x, friction = mu;
        }
    }
}

/// The time in which a block falls from rest at a tilt: Simpson's rule over its rate by the energy, with `tilt - s^2` in place of the tilt.
fn falling(tilt: f64, slenderness: f64, p: f64) -> f64 {
    const PARTS: u32 = 2000;
    let end = tilt.sqrt();
    let value = |s: f64| {
        let half = s * s / 2.0;
        let root = if half > 0.0 { half.sin() / half } else { 1.0 };
        2.0 / (p * ((slenderness - tilt + half).sin() * root).sqrt() * 2.0f64.sqrt())
    };
    let step = end / f64::from(PARTS);
    let weight = |k: u32| if k == 0 || k == PARTS { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
    (0..=PARTS).map(|k| weight(k) * value(f64::from(k) * step)).sum::<f64>() * step / 3.0
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "A block rocks on its edges: the ratio of its impacts and the time until it rests.";
    let open = match arguments::read_page(about) {
        Ok(open) => open,
        Err(status) => return Ok(status),
    };
    let block = Block::default().prepare()?;
    let Block { b, h, g, .. } = block.constants();
    // It stands on its left edge, tilted to the left.
    let tilt = 0.3f64;
    let center = |tilt: f64| [b * tilt.cos() - h * tilt.sin() - b, b * tilt.sin() + h * tilt.cos()];
    let [x, y] = center(tilt);
    let start = block::State { x, y, tilt, ..Default::default() };
    let motion = block.simulation(&start).tolerance(1e-12).run(0.0..5.0)?;
    println!("A block of {} m by {} m falls back from {:.1} degrees.", 2.0 * b, 2.0 * h, tilt.to_degrees());
    checks::tell(&motion);

    // 1. By hand: the moment of momentum about the edge that is hit is kept (Housner).
    let mut checks = checks::Checks::default();
    println!("by hand:");
    let (slenderness, p) = (f64::atan2(b, h), f64::sqrt(3.0 * g / (4.0 * b.hypot(h))));
    let ratio = 1.0 - 1.5 * slenderness.sin().powi(2);
    let impacts: Vec<_> =
        motion.transitions().iter().filter(|at| at.kind == TransitionKind::Impact).collect();
    checks.near("the time of the first impact", impacts[0].t, falling(tilt, slenderness, p), 1e-9);
    let rates = impacts.iter().map(|at| [at.state_before[5], at.state_after[5]]);
    let worst = rates.map(|[before, after]| (after / before - ratio).abs()).fold(0.0, f64::max);
    checks.near("the ratio of the rates of every impact, largest error", worst, 0.0, 1e-8);
    // Between impacts the energy is kept: the next tilt has the energy that is left.
    let lost = impacts[0].energy;
    let kinetic = 2.0 / 3.0 * (b * b + h * h) * impacts[0].state_before[5].powi(2);
    checks.near("the energy of the first impact", lost, (ratio * ratio - 1.0) * kinetic, 1e-9);
    let (mut expected, mut next) = (falling(tilt, slenderness, p), tilt);
    while next > 1e-25 {
        // `cos(slenderness - next) - cos(slenderness)` is what is left of the energy.
        let left = ratio * ratio * (slenderness - next / 2.0).sin() * (next / 2.0).sin();
        next = (0..60).fold(0.0, |next: f64, _| 2.0 * (left / (slenderness - next / 2.0).sin()).asin());
        expected += 2.0 * falling(next, slenderness, p);
    }
    let until = motion.transitions().iter().find_map(|at| match at.kind {
        TransitionKind::Rest { until, .. } => Some(until),
        _ => None,
    });
    checks.near("it rests from", until.ok_or("it never rests")?, expected, 1e-9);
    let mode = motion.mode_at(5.0);
    checks.holds("both edges stand", mode.left == block::Left::Stick && mode.right == block::Right::Stick);
    println!("  after {} impacts, with the ratio {ratio:.6}", impacts.len());

    // 2. A picture and a page.
    let folder = folder::folder("rocking_block");
    let picture = folder.join("tilt.svg");
    Plot::new("A rocking block comes to rest")
        .axes("t in s", "tilt in degrees")
        .moments("transition", motion.transitions().iter().map(|at| at.t))
        .line("tilt", motion.sample(0.005).map(|(t, s)| (t, s.tilt.to_degrees())))
        .save(&picture)?;
    let page = folder.join("block.html");
    let played = motion.played();
    let edge = move |&[x, y, tilt, ..]: &[f64; 6], side: f64| {
        let (sine, cosine) = tilt.sin_cos();
        ContactFrame::at([x + side * b * cosine + h * sine, y + side * b * sine - h * cosine, 0.26])
            .normal([0.0, 1.0, 0.0])
            .along([1.0, 0.0, 0.0])
    };
    motion
        .viewer(&block, "A rocking block", &played)
        .drawn("block", [Shape::cuboid([2.0 * b, 2.0 * h, 0.5])])
        .contact(&motion, "left", move |_, state| edge(state, -1.0))
        .contact(&motion, "right", move |_, state| edge(state, 1.0))
        .upward([0.0, 1.0, 0.0])
        .seen_from([0.3, 0.15, 1.0])
        .write(&page)?;
    println!("picture: {}\nto play: {}", picture.display(), page.display());
    if open {
        open::open(&page);
    }
    Ok(checks.status())
}
