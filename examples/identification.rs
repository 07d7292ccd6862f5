//! Which constants does this sled have? Least squares on a measured run, with derivatives by the constants.
//!
//! ```text
//! cargo run --release --example identification
//! ```
//!
//! A system is generic over its real, and its constants are fields of that real. With dual numbers for the constants that
//! are sought, one run yields the motion and its exact derivatives by them: what Gauss and Newton's method needs.

use std::error::Error;
use std::process::ExitCode;

use guen::mechanical_system;
use guen::prelude::*;
use guen_study::{Plot, Table};
use nalgebra::{SMatrix, SVector};

#[path = "common/folder.rs"]
mod folder;

mechanical_system! {
    /// A sled on a blade with a mass centre ahead of it, slowed down by drag.
    pub system Sled {
        constants { m > 0, ahead, k > 0, drag >= 0, swirl >= 0 }
        coordinates { heading, x, y }
        let forward = vec(cos(heading), sin(heading));
        parameters { turning = dot(heading); speed = inner(dot(vec(x, y)), forward); }
        constraints { grip: cross(forward, dot(vec(x, y))).z = 0; }
        particles { m at vec(x, y) + ahead*forward; }
        kinetic_energy = m/2*k^2*turning^2;
        forces { -drag*speed along speed; -swirl*turning along turning; }
    }
}

/// What is sought: `ahead`, `k`, `drag` and `swirl`. The mass is known: the others count per mass.
const SOUGHT: usize = 4;
const NAMES: [&str; SOUGHT] = ["ahead", "k", "drag", "swirl"];
const TRUE: [f64; SOUGHT] = [0.15, 0.4, 0.9, 0.05];
const GUESS: [f64; SOUGHT] = [0.08, 0.5, 0.5, 0.1];
const MASS: f64 = 3.0;

/// A place is measured every fortieth of a second, to so many metres.
const SAMPLES: usize = 160;
const BETWEEN: f64 = 0.025;
const NOISE: f64 = 2e-3;

/// The result has to be as near to the truth as its own standard deviations say, up to this factor.
const DEVIATIONS: f64 = 4.0;

/// The places of a run with these constants, in any real.
fn run<R: Ordered>(constants: [R; SOUGHT]) -> Result<Vec<[R; 2]>, Box<dyn Error>> {
    let [ahead, k, drag, swirl] = constants;
    let sled = Sled { m: R::from_f64(MASS), ahead, k, drag, swirl }.prepare()?;
    let mut state: [R; 5] =
        sled::State { turning: R::from_f64(2.5), speed: R::from_f64(1.5), ..Default::default() }.into();
    let h = R::from_f64(BETWEEN / 4.0);
    let places = (0..SAMPLES).map(|_| {
        for _ in 0..4 {
            state = guen::steppers::rk4::step(&sled, R::zero(), &state, h);
        }
        let s = sled::State::from(state);
        [s.x, s.y]
    });
    Ok(places.collect())
}

/// Pseudo-random deviates, the sums of twelve uniform ones, the same every time.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 7_u64;
    move || {
        let mut sum = -6.0;
        for _ in 0..12 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            sum += (state >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum
    }
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut deviate = noise();
    let measured: Vec<[f64; 2]> =
        run(TRUE)?.into_iter().map(|place| place.map(|x| x + NOISE * deviate())).collect();

    let mut constants = GUESS;
    let mut table = Table::new(&["ahead", "k", "drag", "swirl", "error in m"]).digits(6);
    let mut spread = SVector::<f64, SOUGHT>::zeros();
    let mut damping = 1e-2;
    for _ in 0..40 {
        let motion = run::<Dual<f64, SOUGHT>>(std::array::from_fn(|i| Dual::variable(constants[i], i)))?;
        // J^T J d = -J^T r over all coordinates of all places.
        let (mut normal, mut right) =
            (SMatrix::<f64, SOUGHT, SOUGHT>::zeros(), SVector::<f64, SOUGHT>::zeros());
        let mut sum = 0.0;
        for (found, seen) in motion.iter().flatten().zip(measured.iter().flatten()) {
            let slope = SVector::from(found.tangent);
            let gap = found.value - seen;
            normal += slope * slope.transpose();
            right -= slope * gap;
            sum += gap * gap;
        }
        let error = (sum / (2 * SAMPLES) as f64).sqrt();
        table.row(&[constants[0], constants[1], constants[2], constants[3], error]);
        let inverse = normal.try_inverse().ok_or("these measurements do not determine the constants")?;
        spread = inverse.diagonal().map(|variance| NOISE * variance.sqrt());
        // Far from the truth a full step may go too far, and out of the bounds that `prepare` checks: Levenberg and
        // Marquardt's damping shortens it until it is better than nothing.
        let better = |constants: [f64; SOUGHT]| {
            let motion = run(constants).ok()?;
            let gaps = motion.iter().flatten().zip(measured.iter().flatten()).map(|(a, b)| (a - b) * (a - b));
            Some(constants).filter(|_| gaps.sum::<f64>() < sum * (1.0 - 1e-9))
        };
        let next = (0..12).find_map(|_| {
            let damped = normal + SMatrix::from_diagonal(&(normal.diagonal() * damping));
            let change = damped.try_inverse()? * right;
            let found = better(std::array::from_fn(|i| constants[i] + change[i]));
            damping *= if found.is_some() { 0.1 } else { 10.0 };
            found
        });
        let Some(next) = next else { break };
        constants = next;
    }
    println!("{table}\n");
    let mut works = true;
    for (i, name) in NAMES.iter().enumerate() {
        let deviations = (constants[i] - TRUE[i]).abs() / spread[i];
        println!("{name:6} {:.5} +- {:.5}, in truth {}", constants[i], spread[i], TRUE[i]);
        works &= deviations < DEVIATIONS;
    }

    let pictures = folder::folder("identification");
    let track = |places: Vec<[f64; 2]>| places.into_iter().map(|[x, y]| (x, y));
    Plot::new("The measured track, the guess, and what was found")
        .equal_scale(true)
        .axes("x in m", "y in m")
        .line("guess", track(run(GUESS)?))
        .line("measured", track(measured))
        .line("found", track(run(constants)?))
        .save(pictures.join("track.svg"))?;
    println!("picture: track.svg in {}", pictures.display());
    Ok(if works { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
