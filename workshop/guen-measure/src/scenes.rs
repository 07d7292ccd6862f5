//! What scenes save, and what each is for: the hoop, Chaplygin's sled, and a car with a trailer on rolling wheels.
//!
//! ```text
//! cargo run --release -p guen-measure --bin scenes
//! ```
//!
//! For every scene its variables, the bytes of its state, the operations of its right-hand side, and the times of the
//! right-hand sides of the system and of the scene at the same states, in turn: the shortest time of each in
//! nanoseconds, and the median of the ratios with its 95 percent interval. Then three runs of scenes, each with the
//! picture that it is for, compared with runs of the whole systems.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

use guen::prelude::*;
use guen::{Level, mechanical_system};
use guen_benchmarks::Random;
use guen_benchmarks::timing::{STATES, Throughput, compare, conditions};
use guen_study::{Nodes, Plot, Recovered, recover};

#[path = "../../../examples/common/folder.rs"]
mod folder;

guen_benchmarks::hoop! { guen::mechanical_system;
    // The point of the plane that the hoop touches.
    outputs { contact_x = xi + a*cos(theta)*sin(psi); contact_y = eta - a*cos(theta)*cos(psi); }

    scene Tilt     { track theta; }
    scene UnitHoop { track theta; fix a = 1, g = 9.81; provide energy; }
    scene Pressed  { track theta; provide reactions; }
}

guen_benchmarks::sled! { guen::mechanical_system;
    scene Heading    { track phi; }
    scene Balanced   { track phi; fix alpha = 0; }
    scene Horizontal { fix incline = 0; }
    scene Narrow     { fix beta = 0; }
}

mechanical_system! {
    /// A car with a trailer on five rolling wheels: ten coordinates and eight constraints.
    pub system Rig {
        constants {
            m > 0, I > 0,
            /// A wheel: its mass, its inertia about the axle, its radius.
            w > 0, J > 0, r > 0,
            /// The wheelbase, half of the track, from the rear axle to that of the trailer.
            l > 0, b > 0, d > 0,
        }
        inputs      { push, handle }
        coordinates { x, y, yaw, steer, trailing, left, right, front, near, off }
        let up = vec(0, 0, r);
        let C = rot_z(yaw);
        let F = C*rot_z(steer);
        let T = C*rot_z(trailing);
        let rear = vec(x, y, r);
        let nose = rear + l*C.x;
        let axle = rear - d*T.x;
        bodies {
            car     { mass: m, inertia: diag(0, 0, I), center: rear + l/2*C.x, orientation: C }
            trailer { mass: m/2, inertia: diag(0, 0, I/2), center: axle, orientation: T }
            one     { mass: w, inertia: diag(J/2, J, J/2), center: rear + b*C.y, orientation: C*rot_y(left) }
            two     { mass: w, inertia: diag(J/2, J, J/2), center: rear - b*C.y, orientation: C*rot_y(right) }
            three   { mass: w, inertia: diag(J/2, J, J/2), center: nose, orientation: F*rot_y(front) }
            four    { mass: w, inertia: diag(J/2, J, J/2), center: axle + b*T.y, orientation: T*rot_y(near) }
            five    { mass: w, inertia: diag(J/2, J, J/2), center: axle - b*T.y, orientation: T*rot_y(off) }
        }
        parameters  { speed = inner(C.x, dot(rear)); steering = dot(steer); }
        constraints {
            rear_axle:    inner(C.y, dot(rear)) = 0;
            front_axle:   inner(F.y, dot(nose)) = 0;
            trailer_axle: inner(T.y, dot(axle)) = 0;
            roll_one:     inner(C.x, one.velocity_at(rear + b*C.y - up)) = 0;
            roll_two:     inner(C.x, two.velocity_at(rear - b*C.y - up)) = 0;
            roll_three:   inner(F.x, three.velocity_at(nose - up)) = 0;
            roll_four:    inner(T.x, four.velocity_at(axle + b*T.y - up)) = 0;
            roll_five:    inner(T.x, five.velocity_at(axle - b*T.y - up)) = 0;
        }
        forces { push along speed; handle along steering; }

        scene Towing { track yaw, steer, trailing; }
        scene Fold   { track trailing; fix b = 0.8, d = 3, l = 2.5, r = 0.3; }
    }
}

/// Pairs of batches that a ratio is the median of.
const PAIRS: usize = 31;
/// What the motion of a scene may differ by from that of the system, both within tolerances of `1e-12`.
const AGREEMENT: f64 = 1e-8;
const FINE: f64 = 1e-12;
const CHECK: f64 = 1e-9;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 };
    let sled = Sled { m: 1.0, alpha: 0.0, beta: 0.1, k: 0.5, incline: 0.1, g: 9.81 };
    let rig = Rig { m: 900.0, I: 1200.0, w: 20.0, J: 1.0, r: 0.3, l: 2.5, b: 0.8, d: 3.0 };

    println!("{}\n{}\n{}\n", hoop::levels(), sled::levels(), rig::levels());
    print!("{}", conditions());
    println!("\nscene         system    scene   ratio, 95 %");
    {
        let full = hoop.prepare()?;
        timed(&full, &hoop::Tilt::from(hoop).prepare()?);
        timed(&full, &hoop::UnitHoop::try_from(hoop)?.prepare()?);
        timed(&full, &hoop::Pressed::from(hoop).prepare()?);
        let full = sled.prepare()?;
        timed(&full, &sled::Heading::from(sled).prepare()?);
        timed(&full, &sled::Balanced::try_from(sled)?.prepare()?);
        timed(
            &Sled { incline: 0.0, ..sled }.prepare()?,
            &sled::Horizontal { m: 1.0, alpha: 0.0, beta: 0.1, k: 0.5, g: 9.81 }.prepare()?,
        );
        timed(
            &Sled { beta: 0.0, ..sled }.prepare()?,
            &sled::Narrow { m: 1.0, alpha: 0.0, k: 0.5, incline: 0.1, g: 9.81 }.prepare()?,
        );
        let inputs = rig::Inputs { push: 300.0, handle: 0.5 };
        let full = rig.prepare()?.driven(inputs);
        timed(&full, &rig::Towing::from(rig).prepare()?.driven(inputs.into()));
        timed(&full, &rig::Fold::try_from(rig)?.prepare()?.driven(inputs.into()));
    }

    println!("\nmotion of scenes, against the whole systems");
    let pictures = &folder::folder("scenes");
    let healthy = [
        hoop_rolls(hoop, pictures)?,
        sled_turns(Sled { alpha: 0.02, ..sled }, pictures)?,
        rig_folds(rig, pictures)?,
    ];
    println!(
        "pictures: tilt.svg, contact.svg, heading.svg, place.svg, towing.svg and tracks.svg in {}",
        pictures.display()
    );
    if healthy.iter().all(|healthy| *healthy) {
        Ok(ExitCode::SUCCESS)
    } else {
        eprintln!("a scene and its system move apart");
        Ok(ExitCode::FAILURE)
    }
}

/// Prints the times of both right-hand sides at the same states.
fn timed<F, S, const N: usize, const FULL: usize>(full: &F, scene: &S)
where
    F: System<f64, FULL>,
    S: System<f64, N> + Level<f64, N, FULL>,
{
    let mut random = Random::new(8);
    let states: Vec<[f64; FULL]> =
        (0..STATES).map(|_| std::array::from_fn(|_| random.between(0.3, 1.2))).collect();
    let parts: Vec<[f64; N]> = states.iter().map(|state| scene.project(state)).collect();
    let comparison = compare(
        &mut Throughput { system: full, states: &states },
        &mut Throughput { system: scene, states: &parts },
        PAIRS,
    );
    println!("{:10} {comparison}", S::INFO.name);
}

fn sampled<S: System<f64, N>, const N: usize>(
    system: &S,
    start: [f64; N],
    times: &[f64],
    tolerance: f64,
) -> Result<Vec<[f64; N]>, Box<dyn Error>> {
    let mut states = Vec::new();
    Integration::new(system, times[0], &start)
        .sample(times, &mut |_k, _t, state| states.push(*state))
        .run(&Dop853::new(tolerance, tolerance), times[times.len() - 1])?;
    Ok(states)
}

/// Runs a scene, recovers what it left out, and compares with a run of the system; whether both agree.
fn recovered<S, F, const N: usize, const FULL: usize>(
    scene: &S,
    full: &F,
    start: [f64; FULL],
    (until, intervals): (f64, u32),
) -> Result<(Recovered<FULL>, bool), Box<dyn Error>>
where
    S: System<f64, N> + Level<f64, N, FULL>,
    F: System<f64, FULL>,
{
    let grid: Vec<f64> = (0..=intervals).map(|k| until * f64::from(k) / f64::from(intervals)).collect();
    let nodes = Nodes::new(&grid)?;
    let run = |tolerance| sampled(scene, scene.project(&start), nodes.times(), tolerance);
    let recovered = recover(scene, full, &nodes, &run(FINE)?, &run(CHECK)?, &start)?;
    let reference = sampled(full, start, &grid, FINE)?;
    let (mut kept, mut left, mut stated) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut healthy = true;
    for ((state, exact), errors) in recovered.states.iter().zip(&reference).zip(&recovered.errors) {
        for i in 0..FULL {
            let off = (state[i] - exact[i]).abs();
            healthy &= off <= AGREEMENT && off <= errors[i] + AGREEMENT / 100.0;
            if S::PLACES.contains(&i) {
                kept = kept.max(off);
            } else {
                left = left.max(off);
                stated = stated.max(errors[i]);
            }
        }
    }
    println!(
        "{:10} {N} of {FULL} variables over {until} s: kept differ by {kept:.1e}, recovered by {left:.1e} ({stated:.1e} stated)",
        S::INFO.name
    );
    Ok((recovered, healthy))
}

/// Tilt is all that a picture of a coin shows; the track of the contact point is recovered from the same run.
fn hoop_rolls(hoop: Hoop, pictures: &Path) -> Result<bool, Box<dyn Error>> {
    let start = hoop::State { theta: 1.0, zeta: 1.0_f64.sin(), eta2: 3.0, eta3: 0.9, ..Default::default() };
    let (full, tilt) = (hoop.prepare()?, hoop::Tilt::from(hoop).prepare()?);
    let (motion, healthy) = recovered(&tilt, &full, start.into(), (20.0, 2000))?;
    Plot::new("Tilt: theta, from four variables")
        .axes("t in s", "theta in rad")
        .line("", motion.curve(0))
        .save(pictures.join("tilt.svg"))?;
    let contact = |t: f64, state: &[f64; 9]| {
        let outputs = full.outputs(t, &hoop::State::from(*state));
        (outputs.contact_x, outputs.contact_y)
    };
    let track = motion.times.iter().zip(&motion.states).map(|(t, state)| contact(*t, state));
    Plot::new("Tilt: the track of the contact point, recovered from four variables")
        .size(640, 640)
        .axes("x in m", "y in m")
        .equal_scale(true)
        .line("", track)
        .mark_ends(true)
        .save(pictures.join("contact.svg"))?;
    Ok(healthy)
}

/// A compass on the sled, and its place from the compass.
fn sled_turns(sled: Sled, pictures: &Path) -> Result<bool, Box<dyn Error>> {
    let start = sled::State { eta1: 3.0, eta2: 1.0, ..Default::default() };
    let heading = sled::Heading::from(sled).prepare()?;
    let (motion, healthy) = recovered(&heading, &sled.prepare()?, start.into(), (20.0, 1000))?;
    Plot::new("Heading: the direction of the blade, from three variables")
        .axes("t in s", "phi in rad")
        .line("", motion.curve(0))
        .save(pictures.join("heading.svg"))?;
    Plot::new("Heading: the place of the blade, recovered from three variables")
        .axes("across, in m", "uphill, in m")
        .equal_scale(true)
        .line("", motion.track(2, 1).map(|(across, downhill)| (across, -downhill)))
        .mark_ends(true)
        .save(pictures.join("place.svg"))?;
    Ok(healthy)
}

/// The angles of a car that is steered while it is pushed, and the tracks of both axles.
fn rig_folds(rig: Rig, pictures: &Path) -> Result<bool, Box<dyn Error>> {
    let inputs = rig::Inputs { push: 300.0, handle: 0.0 };
    let start = rig::State { steer: 0.4, speed: 3.0, steering: -0.12, ..Default::default() };
    let full = rig.prepare()?.driven(inputs);
    let towing = rig::Towing::from(rig).prepare()?.driven(inputs.into());
    let (motion, healthy) = recovered(&towing, &full, start.into(), (8.0, 200))?;
    Plot::new("Towing: steering and the angle of the trailer, from five variables")
        .axes("t in s", "rad")
        .line("yaw", motion.curve(2))
        .line("steer", motion.curve(3))
        .line("trailing", motion.curve(4))
        .save(pictures.join("towing.svg"))?;
    let trailer = motion.states.iter().map(|state| {
        let angle = state[2] + state[4];
        (state[0] - rig.d * angle.cos(), state[1] - rig.d * angle.sin())
    });
    Plot::new("Towing: the tracks of the axles, recovered")
        .axes("x in m", "y in m")
        .equal_scale(true)
        .line("car", motion.track(0, 1))
        .line("trailer", trailer)
        .mark_ends(true)
        .save(pictures.join("tracks.svg"))?;
    Ok(healthy)
}
