//! A passive walker: two straight legs walk down a gentle slope without motors. Its gait is a fixed point of the map from one step to the
//! next, found by Newton's method; the eigenvalues of the map say whether the gait is stable.
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
use nalgebra::{Matrix3, Vector3};

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

/// The section after one step, in which the right leg comes to the front, and the time of the step.
fn step(walker: &walker::Prepared, section: &Section) -> Result<(Section, f64), Box<dyn Error>> {
    let begin = start(walker, section);
    let mut strike = None;
    walker
        .simulation(&begin)
        .method(Dop853::new(1e-13, 1e-13))
        .observe_transitions(|transition| {
            if transition.kind == TransitionKind::Impact && transition.t > 0.0 {
                strike = Some((transition.t, walker::State::from(transition.state_after)));
                return ControlFlow::Break(());
            }
            ControlFlow::Continue(())
        })
        .run(0.0..3.0)?;
    let (time, after) = strike.ok_or("the walker falls")?;
    Ok((Section::new(after.right, after.right_rate, after.left_rate), time))
}

/// The derivatives of the map of one step, by central differences.
fn derivative(walker: &walker::Prepared, section: &Section) -> Result<Matrix3<f64>, Box<dyn Error>> {
    const DISTANCE: f64 = 1e-5;
    let mut derivative = Matrix3::zeros();
    for k in 0..3 {
        let aside = DISTANCE * Vector3::ith(k, 1.0);
        let difference = step(walker, &(section + aside))?.0 - step(walker, &(section - aside))?.0;
        derivative.set_column(k, &(difference / (2.0 * DISTANCE)));
    }
    Ok(derivative)
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
        let next = step(&walker, &gait)?.0;
        left = (next - gait).norm();
        println!("round {round}: off by {left:.1e}");
        if left < 1e-11 {
            break;
        }
        let matrix = derivative(&walker, &gait)? - Matrix3::identity();
        gait += matrix.lu().solve(&(gait - next)).ok_or("the map has no isolated fixed point")?;
    }
    let (_, time) = step(&walker, &gait)?;
    println!("half of the angle between the legs {:.6} rad, a step in {time:.6} s", gait[0]);

    // 2. Its stability: what becomes of a small deviation in one step.
    let multipliers = derivative(&walker, &gait)?.complex_eigenvalues();
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
