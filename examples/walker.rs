//! A passive walker: two straight legs walk down a gentle slope without motors. Its gait is a fixed point of the map from one step to the
//! next, found by Newton's method; the eigenvalues of the map say whether the gait is stable. Its derivatives go through the strike of the heel.
//!
//! ```text
//! cargo run --release --example walker -- --open
//! ```

#[path = "common/arguments.rs"]
mod arguments;
#[path = "common/folder.rs"]
mod folder;
#[path = "common/open.rs"]
mod open;

use std::error::Error;
use std::ops::ControlFlow;
use std::process::ExitCode;

use guen::hybrid::TransitionKind;
use guen::steppers::Dop853;
use guen_study::{ContactFrame, ExportModes, Shape};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

guen::mechanical_system! {
    /// The walker in axes along the slope and across it. A foot that swings forward passes through the ground and closes in front alone.
    pub system Walker {
        constants   { leg_mass > 0 = 5, hip_mass > 0 = 10, length > 0 = 1, above > 0 = 1/2, g = 9.81, slope = 0, mu >= 0 = 1 }
        coordinates { x, z, left, right }
        let hip = vec(x, z);
        let left_foot  = hip + length*vec(sin(left), -cos(left));
        let right_foot = hip + length*vec(sin(right), -cos(right));
        bodies {
            trunk     { mass: hip_mass, center: hip }
            left_leg  { mass: leg_mass, center: hip + above*vec(sin(left), -cos(left)) }
            right_leg { mass: leg_mass, center: hip + above*vec(sin(right), -cos(right)) }
        }
        gravity     = g*vec(sin(slope), -cos(slope));
        parameters  { u = dot(x); w = dot(z); left_rate = dot(left); right_rate = dot(right); }
        contacts {
            left_sole:  gap = left_foot.y,  slip = dot(left_foot).x,  friction = mu, when = left_foot.x - right_foot.x;
            right_sole: gap = right_foot.y, slip = dot(right_foot).x, friction = mu, when = right_foot.x - left_foot.x;
        }
    }
}

/// The state after a step: half of the angle between the legs, the rate of the leg that stands in front, and that of the other one.
type Section = Vector3<f64>;

/// The walker with its left foot in front, both feet on the ground.
fn start(walker: &walker::Prepared, section: &Section) -> walker::State {
    let (angle, front, rear) = (section[0], section[1], section[2]);
    let length = walker.constants().length;
    walker::State {
        x: 0.0,
        z: length * angle.cos(),
        left: angle,
        right: -angle,
        // The foot in front stands.
        u: -length * angle.cos() * front,
        w: -length * angle.sin() * front,
        left_rate: front,
        right_rate: rear,
    }
}

/// The derivatives of that start by the section.
fn start_by_section(walker: &walker::Prepared, section: &Section) -> SMatrix<f64, 8, 3> {
    let (angle, front) = (section[0], section[1]);
    let length = walker.constants().length;
    let (sin, cos) = angle.sin_cos();
    let by_angle = [0.0, -length * sin, 1.0, -1.0, length * sin * front, -length * cos * front, 0.0, 0.0];
    let by_front = [0.0, 0.0, 0.0, 0.0, -length * cos, -length * sin, 1.0, 0.0];
    let by_rear = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    SMatrix::from_columns(&[by_angle, by_front, by_rear].map(SVector::from))
}

/// One step, in which the right leg comes to the front.
struct Step {
    /// The section after it.
    section: Section,
    time: f64,
    /// The derivatives of the section after it by that before.
    derivative: Matrix3<f64>,
}

/// Makes a step, and differentiates it: through the swing, and through the strike of the heel whose time depends on the section.
fn step(walker: &walker::Prepared, section: &Section) -> Result<Step, Box<dyn Error>> {
    const TOLERANCE: f64 = 1e-13;
    let is_strike = |kind: TransitionKind, t: f64| kind == TransitionKind::Impact && t > 0.0;
    let motion = walker
        .simulation(&start(walker, section))
        .tolerance(TOLERANCE)
        .observe_transitions(|transition| match is_strike(transition.kind, transition.t) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        })
        .run(0.0..3.0)?;
    let last = motion.transitions().len().saturating_sub(1);
    let strike = motion.transitions().last().filter(|strike| is_strike(strike.kind, strike.t));
    let strike = strike.ok_or("the walker falls")?;
    let by_start = motion.sensitivity_of_transition(last, &Dop853::new(TOLERANCE, TOLERANCE))?;
    // The section is made of the angle and the rate of the right leg and of the rate of the left one.
    let after = SMatrix::<f64, 8, 8>::from_fn(|i, j| by_start.state[i][j]);
    let rows = SMatrix::<f64, 3, 8>::from_rows(&[after.row(3), after.row(7), after.row(6)]);
    let state = walker::State::from(strike.state_after);
    Ok(Step {
        section: Section::new(state.right, state.right_rate, state.left_rate),
        time: strike.t,
        derivative: rows * start_by_section(walker, section),
    })
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "A passive walker: its gait down a slope, and whether it is stable.";
    let degrees = |word: &str| word.parse().ok().filter(|slope: &f64| (0.5..=4.0).contains(slope));
    let given = arguments::read_with_page(about, "SLOPE", "the slope in degrees; 3 by default", 3.0, degrees);
    let (slope, open) = match given {
        Ok(given) => given,
        Err(status) => return Ok(status),
    };
    let walker = Walker { slope: f64::to_radians(slope), ..Default::default() }.prepare()?;

    // 1. The gait: a section that one step leads to itself.
    let mut gait = Section::new(0.27, -1.1, -0.4);
    let mut left = f64::INFINITY;
    for round in 0..12 {
        let Step { section: next, derivative, .. } = step(&walker, &gait)?;
        left = (next - gait).norm();
        println!("round {round}: off by {left:.1e}");
        if left < 1e-11 {
            break;
        }
        let matrix = derivative - Matrix3::identity();
        gait += matrix.lu().solve(&(gait - next)).ok_or("the map has no isolated fixed point")?;
    }
    let Step { time, derivative, .. } = step(&walker, &gait)?;
    println!("half of the angle between the legs {:.6} rad, a step in {time:.6} s", gait[0]);

    // 2. Its stability: what becomes of a small deviation in one step.
    let multipliers = derivative.complex_eigenvalues();
    let largest = multipliers.iter().fold(0.0, |most: f64, value| most.max(value.norm()));
    for value in &multipliers {
        println!("multiplier {:+.6} {:+.6} i, of size {:.6}", value.re, value.im, value.norm());
    }
    println!("{}", if largest < 1.0 { "stable" } else { "not stable" });

    // 3. Ten steps from a start that is off.
    let pushed = gait + Vector3::new(0.0, 0.02, 0.0);
    let motion = walker.simulation(&start(&walker, &pushed)).tolerance(1e-11).run(0.0..10.0 * time)?;
    let strikes =
        motion.transitions().iter().filter(|transition| transition.kind == TransitionKind::Impact).count();
    println!("{strikes} strikes of the heels in ten steps");

    // 4. Pictures, a table and a page.
    let folder = folder::folder("walker");
    let picture = folder.join("legs.svg");
    motion.plot("The legs of a passive walker, pushed at the start", &["left", "right"])?.save(&picture)?;
    let forces = folder.join("forces.svg");
    motion.plot_reactions("Forces on its feet").save(&forces)?;
    motion.save_csv(0.01, folder.join("walker.csv"))?;
    let page = folder.join("walker.html");
    let length = walker.constants().length;
    let leg =
        |x: f64, z: f64, angle: f64| [[x, z, 0.0], [x + length * angle.sin(), z - length * angle.cos(), 0.0]];
    let sole = |x: f64, z: f64, angle: f64| {
        ContactFrame::at(leg(x, z, angle)[1]).normal([0.0, 1.0, 0.0]).along([1.0, 0.0, 0.0])
    };
    let played = motion.played();
    motion
        .viewer(&walker, "A passive walker", &played)
        .rod("left leg's line", 0.02, |_, &[x, z, left, ..]| leg(x, z, left))
        .rod("right leg's line", 0.02, |_, &[x, z, _, right, ..]| leg(x, z, right))
        .contact(&motion, "left_sole", |_, &[x, z, left, ..]| sole(x, z, left))
        .contact(&motion, "right_sole", |_, &[x, z, _, right, ..]| sole(x, z, right))
        // Its plane is x, y, and stands upright.
        .upward([0.0, 1.0, 0.0])
        .seen_from([0.3, 0.2, 1.0])
        .drawn("trunk", [Shape::sphere(0.09)])
        .drawn("left_leg", [Shape::sphere(0.06)])
        .drawn("right_leg", [Shape::sphere(0.06)])
        .write(&page)?;
    println!("pictures: {} and {}\nto play: {}", picture.display(), forces.display(), page.display());
    if open {
        open::open(&page);
    }
    let holds = left < 1e-9 && strikes >= 9;
    Ok(if holds { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
