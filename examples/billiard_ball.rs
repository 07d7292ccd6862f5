//! A billiard ball with side spin slides on a curve, rolls, and banks off the cushions.
//!
//! ```text
//! cargo run --release --example billiard_ball -- --open
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
    /// A ball on a table with four smooth cushions. Its orientation is a quaternion.
    pub system Ball {
        constants   { m > 0 = 0.17, a > 0 = 0.0286, g = 9.81, mu >= 0 = 1/5, e in 0..1 = 4/5, length > 0 = 1, width > 0 = 1/2 }
        coordinates { x, y, z, w, i, j, k }
        let R = quaternion(w, i, j, k);
        bodies      { ball { mass: m, inertia: diag(2/5*m*a^2, 2/5*m*a^2, 2/5*m*a^2), center: vec(x, y, z), orientation: R } }
        gravity     = vec(0, 0, -g);
        parameters  { ahead = dot(x); aside = dot(y); up = dot(z); spin = ball.angular_velocity; }
        holonomic   { unit_length: w^2 + i^2 + j^2 + k^2 = 1; }
        let slip = ball.velocity_at(vec(x, y, z - a));
        contacts {
            cloth: gap = z - a, slip = vec(slip.x, slip.y, 0), friction = mu;
            east:  gap = length - a - x, restitution = e;
            west:  gap = x - a + length, restitution = e;
            north: gap = width - a - y,  restitution = e;
            south: gap = y - a + width,  restitution = e;
        }
    }
}

/// A transition of the ball by hand: its time, and whether it is a bank or the beginning of rolling.
type Event = (f64, TransitionKind);

/// The same ball by hand. While it slides, friction has a constant direction: the ball is on a parabola, and its slip falls by `7/2 mu g`; then it
/// rolls on a line. A bank turns one velocity over and keeps the spin. Returns the events and where the ball is at the end.
fn by_hand(ball: &Ball, start: &ball::State, end: f64) -> (Vec<Event>, [f64; 2]) {
    let friction = ball.mu * ball.g;
    let walls = [ball.length - ball.a, ball.width - ball.a];
    let (mut t, mut place, mut speed) = (0.0, [start.x, start.y], [start.ahead, start.aside]);
    // The part of the slip that comes from the spin.
    let mut spin = [-ball.a * start.spin_y, ball.a * start.spin_x];
    let mut rolls = false;
    let mut events = Vec::new();
    loop {
        let slip = [speed[0] + spin[0], speed[1] + spin[1]];
        let size = slip[0].hypot(slip[1]);
        let slows = slip.map(|entry| if rolls { 0.0 } else { friction * entry / size });
        let to_roll = if rolls { f64::INFINITY } else { size / (3.5 * friction) };
        // The first time at which `place + speed t - slows t^2/2` reaches a wall.
        let mut bank = (f64::INFINITY, 0);
        for axis in 0..2 {
            for wall in [walls[axis], -walls[axis]] {
                let (away, v, s) = (wall - place[axis], speed[axis], slows[axis]);
                let root = (v * v - 2.0 * s * away).sqrt();
                for time in [2.0 * away / (v + root), 2.0 * away / (v - root)] {
                    let outward = (v - s * time) * wall > 0.0;
                    if time > 1e-9 && outward && time < bank.0 {
                        bank = (time, axis);
                    }
                }
            }
        }
        let time = to_roll.min(bank.0).min(end - t);
        for axis in 0..2 {
            place[axis] += (speed[axis] - slows[axis] * time / 2.0) * time;
            speed[axis] -= slows[axis] * time;
            spin[axis] -= 2.5 * slows[axis] * time;
        }
        t += time;
        if time == bank.0 {
            speed[bank.1] *= -ball.e;
            rolls = false;
            events.push((t, TransitionKind::Impact));
        } else if time == to_roll {
            rolls = true;
            events.push((t, TransitionKind::Sticks));
        } else {
            return (events, place);
        }
    }
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "A billiard ball with spin: where it slides and rolls, and how it banks.";
    let open = match arguments::read_page(about) {
        Ok(open) => open,
        Err(status) => return Ok(status),
    };
    let ball = Ball::default().prepare()?;
    let constants = ball.constants();
    let (a, [half_length, half_width]) = (constants.a, [constants.length, constants.width]);
    let struck = ball::State { ahead: 2.2, aside: -0.5, spin_x: -80.0, spin_y: -20.0, ..Default::default() };
    let start = ball::State { x: -0.7, y: 0.1, z: a, w: 1.0, ..struck };
    const END: f64 = 3.0;
    let motion = ball.simulation(&start).tolerance(1e-12).run(0.0..END)?;
    println!("A ball is struck with side spin.");
    checks::tell(&motion);

    // 1. The same by hand.
    let mut checks = checks::Checks::default();
    println!("by hand:");
    let (events, place) = by_hand(&constants, &start, END);
    let found: Vec<Event> = motion.transitions().iter().map(|at| (at.t, at.kind)).collect();
    checks.holds(
        "banks and rolling in this order",
        found.iter().map(|at| at.1).eq(events.iter().map(|at| at.1)),
    );
    let worst = found.iter().zip(&events).map(|(a, b)| (a.0 - b.0).abs()).fold(0.0, f64::max);
    checks.near("the times of all transitions, largest error", worst, 0.0, 1e-8);
    checks.near("the place at the end, x", motion.at(END).x, place[0], 1e-8);
    checks.near("the place at the end, y", motion.at(END).y, place[1], 1e-8);

    // 2. A picture and a page.
    let folder = folder::folder("billiard_ball");
    let picture = folder.join("track.svg");
    let track = |rolls: bool| {
        let motion = &motion;
        let here = move |t| (motion.mode_at(t).cloth == ball::Cloth::Stick) == rolls;
        motion.sample(0.002).map(move |(t, s)| (s.x, if here(t) { s.y } else { f64::NAN }))
    };
    Plot::new("A ball slides, rolls and banks")
        .axes("x in m", "y in m")
        .equal_scale(true)
        .band("cushions, as the centre meets them", {
            let (x, y) = (half_length - a, half_width - a);
            [(-x, -y), (x, -y), (x, y), (-x, y), (-x, -y)]
        })
        .line("slides", track(false))
        .line("rolls", track(true))
        .save(&picture)?;
    let page = folder.join("table.html");
    let played = motion.played();
    let table = [Shape::cuboid([2.0 * half_length, 2.0 * half_width, 0.02]).coloured(0x2e7d52)];
    let rail = |[x, y]: [f64; 2], size: [f64; 2]| {
        Shape::cuboid([size[0], size[1], 0.05]).at([x, y, 0.02]).coloured(0x6d4c33)
    };
    let [long, short] = [[2.0 * half_length + 0.1, 0.05], [0.05, 2.0 * half_width]];
    let [x, y] = [half_length + 0.025, half_width + 0.025];
    let rails = [rail([0.0, y], long), rail([0.0, -y], long), rail([x, 0.0], short), rail([-x, 0.0], short)];
    motion
        .viewer(&ball, "A billiard ball", &played)
        // A stripe shows how it turns.
        .drawn(
            "ball",
            [Shape::sphere(a).coloured(0xf4f1e8), Shape::ring(0.92 * a, 0.1 * a).coloured(0xc0392b)],
        )
        .body("cloth", table, |_, _| Pose::at([0.0, 0.0, -0.01]))
        .body("rails", rails, |_, _| Pose::at([0.0; 3]))
        .contact(&motion, "cloth", move |_, &[x, y, z, ..]| {
            ContactFrame::at([x, y, z - a])
                .normal([0.0, 0.0, 1.0])
                .along([1.0, 0.0, 0.0])
                .across([0.0, 1.0, 0.0])
        })
        .force_length(0.15)
        .without_ground()
        .seen_from([-0.2, -1.0, 0.9])
        .write(&page)?;
    println!("picture: {}\nto play: {}", picture.display(), page.display());
    if open {
        open::open(&page);
    }
    Ok(checks.status())
}
