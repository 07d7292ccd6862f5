//! A sleigh whose blade holds only so much: turning presses it aside until it breaks loose, and it grips again when it has slid long enough.
//!
//! ```text
//! cargo run --release --example breaking_loose -- --open
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
    /// Chaplygin's sleigh: its centre of mass lies `c` ahead of the blade, which holds it from the side with at most `limit`.
    pub system Sleigh {
        constants   { m > 0 = 2, c > 0 = 3/10, J > 0 = 1/10, limit > 0 = 4 }
        coordinates { x, y, heading }
        let R = rot_z(heading);
        let blade_point = vec(x, y);
        bodies      { sleigh { mass: m, inertia: diag(0, 0, J), center: blade_point + c*R.x, orientation: R } }
        parameters  { ahead = inner(R.x, dot(blade_point)); side = inner(R.y, dot(blade_point)); turn = dot(heading); }
        contacts    { blade: grip = side, limit = limit; }
    }
}

/// While the blade holds, `ahead^2 + k^2 turn^2` is `V^2`, and the angle between both obeys `angle' = c V/k^2 cos(angle)`.
struct Held {
    speed: f64,
    k: f64,
    c: f64,
}

impl Held {
    fn of(sleigh: &Sleigh, state: &sleigh::State) -> Self {
        let k = (sleigh.J / sleigh.m + sleigh.c * sleigh.c).sqrt();
        Self { speed: state.ahead.hypot(k * state.turn), k, c: sleigh.c }
    }

    /// The time from one angle to another: the inverse of Gudermann's function.
    fn time(&self, from: f64, to: f64) -> f64 {
        let inverse = |angle: f64| angle.sin().atanh();
        (inverse(to) - inverse(from)) * self.k * self.k / (self.c * self.speed)
    }

    /// The angle at which the blade carries a force: `m J V^2/(2 k (J + m c^2)) sin(2 angle)`.
    fn angle(&self, sleigh: &Sleigh, force: f64) -> f64 {
        let most = sleigh.J * self.speed * self.speed / (2.0 * self.k.powi(3));
        (force / most).asin() / 2.0
    }
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "A sleigh whose blade breaks loose: when, what it costs, and how it goes on.";
    let open = match arguments::read_page(about) {
        Ok(open) => open,
        Err(status) => return Ok(status),
    };
    let sleigh = Sleigh::default().prepare()?;
    let constants = sleigh.constants();
    let start = sleigh::State { turn: 9.0, ..Default::default() };
    const END: f64 = 2.0;
    let motion = sleigh.simulation(&start).tolerance(1e-12).run(0.0..END)?;
    println!("A sleigh turns about its blade, which holds {} N.", constants.limit);
    checks::tell(&motion);

    // 1. By hand, while the blade holds: before it breaks loose and after it grips again.
    let mut checks = checks::Checks::default();
    println!("by hand:");
    let first = |kind: TransitionKind| motion.transitions().iter().find(|at| at.kind == kind);
    let loose = first(TransitionKind::Slips).ok_or("the blade never breaks loose")?.t;
    let grips = first(TransitionKind::Sticks).ok_or("the blade never grips again")?.t;
    let held = Held::of(&constants, &start);
    checks.near("it breaks loose at", loose, held.time(0.0, held.angle(&constants, constants.limit)), 1e-9);
    let again = motion.at(grips);
    let held = Held::of(&constants, &again);
    let angle = |state: &sleigh::State| state.ahead.atan2(held.k * state.turn);
    let later = motion.at(END);
    checks.near(
        "the time from gripping to the end",
        END - grips,
        held.time(angle(&again), angle(&later)),
        1e-7,
    );
    // While it slides, friction takes away the force times the way to the side: by Simpson's rule.
    let parts = 2000;
    let step = (grips - loose) / f64::from(parts);
    let weight = |k: u32| if k == 0 || k == parts { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
    let sides = (0..=parts).map(|k| weight(k) * motion.at(loose + step * f64::from(k)).side.abs());
    let worn = constants.limit * sides.sum::<f64>() * step / 3.0;
    let energy = |t: f64| guen::Monitored::energy(&sleigh, t, &motion.at(t).into());
    checks.near("the energy that sliding wears away", energy(loose) - energy(grips), worn, 1e-7);
    checks.near("the energy that holding wears away", energy(0.0) - energy(loose), 0.0, 1e-9);

    // 2. A picture and a page.
    let folder = folder::folder("breaking_loose");
    let picture = folder.join("track.svg");
    let track = |slides: bool| {
        let motion = &motion;
        let here = move |t| (motion.mode_at(t).blade != sleigh::Blade::Stick) == slides;
        motion.sample(0.002).map(move |(t, s)| (s.x, if here(t) { s.y } else { f64::NAN }))
    };
    Plot::new("The track of a blade that breaks loose")
        .axes("x in m", "y in m")
        .equal_scale(true)
        .line("holds", track(false))
        .line("slides", track(true))
        .save(&picture)?;
    let page = folder.join("sleigh.html");
    let played = motion.played();
    motion
        .viewer(&sleigh, "A sleigh whose blade breaks loose", &played)
        .drawn(
            "sleigh",
            [
                Shape::cuboid([0.5, 0.22, 0.06]).at([-0.05, 0.0, 0.12]),
                Shape::cuboid([0.2, 0.015, 0.1]).at([-0.3, 0.0, 0.05]).coloured(0x37474f),
                Shape::sphere(0.05).at([0.0, 0.0, 0.18]),
            ],
        )
        .contact(&motion, "blade", |_, &[x, y, heading, ..]| {
            ContactFrame::at([x, y, 0.03]).along([-heading.sin(), heading.cos(), 0.0])
        })
        .force_length(0.15)
        .seen_from([-0.4, -1.0, 1.1])
        .write(&page)?;
    println!("picture: {}\nto play: {}", picture.display(), page.display());
    if open {
        open::open(&page);
    }
    Ok(checks.status())
}
