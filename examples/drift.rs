//! What restoring `f(t, x) = 0` after every step gains, and what it costs.
//!
//! ```text
//! cargo run --release --example drift              # a million steps of each
//! cargo run --release --example drift -- 20000     # fewer
//! ```
//!
//! Three systems with constraints on positions run with the classical method of order four, once as they are and once
//! `projected`. Prints a table of the largest residual of the constraints, the largest relative error of the energy
//! and the time of a step. A second table is of `simulate`, which restores by default. Ends with a nonzero status where a restored constraint does
//! not hold to rounding.

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use guen::prelude::*;
use guen::{mechanical_system, projected};

#[path = "common/arguments.rs"]
mod arguments;

mechanical_system! {
    /// A point on a circle, in Cartesian coordinates.
    pub system Pendulum {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { x, y }
        particles { m at vec(x, y); }
        gravity = vec(0, -g);
        parameters { omega = (x*dot(y) - y*dot(x))/l^2; }
        holonomic { rod: x^2 + y^2 = l^2; }
    }
}

mechanical_system! {
    /// A free body whose attitude is a quaternion.
    pub system Top {
        constants { A > 0, B > 0, C > 0 }
        coordinates { w, i, j, k }
        let R = quaternion(w, i, j, k);
        bodies { top { inertia: diag(A, B, C), orientation: R } }
        parameters { spin = angular_velocity_body(R); }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
    }
}

mechanical_system! {
    /// Crank, coupler and rocker of density `rho` between two fixed pivots.
    pub system FourBar {
        constants { a > 0, b > 0, c > 0, d > 0, rho > 0, g = 9.81 }
        coordinates { q1, q2, q3 }
        let crank = a*rot_z(q1).x;
        let coupler = b*rot_z(q2).x;
        let rocker = c*rot_z(q3).x;
        bodies {
            one { mass: rho*a, inertia: diag(0, 0, rho*a^3/12), center: crank/2, orientation: rot_z(q1) }
            two { mass: rho*b, inertia: diag(0, 0, rho*b^3/12), center: crank + coupler/2, orientation: rot_z(q2) }
            three { mass: rho*c, inertia: diag(0, 0, rho*c^3/12), center: vec(d, 0) + rocker/2, orientation: rot_z(q3) }
        }
        gravity = vec(0, -g);
        parameters { turn = dot(q1); }
        holonomic { closure: crank + coupler = vec(d, 0) + rocker; }
    }
}

/// Steps of each run unless another number is asked for.
const MILLION: u32 = 1_000_000;
/// The step of every run, in seconds.
const STEP: f64 = 0.005;
/// What a restored constraint may be off by: some roundings of numbers of the order of one.
const ROUNDING: f64 = 1e-14;

/// What a run shows: the largest residual, the largest relative error of the energy, nanoseconds for a step.
struct Run {
    residual: f64,
    energy: f64,
    time: f64,
}

fn run<S, const N: usize>(system: &S, begin: &[f64; N], steps: u32) -> Result<Run, IntegrationError<f64, N>>
where
    S: Monitored<f64, N>,
{
    // Looked at seldom enough for the looking to cost nothing.
    const EVERY: u32 = 100;
    let start = system.energy(0.0, begin);
    let (mut residual, mut energy, mut count) = (0.0_f64, 0.0_f64, 0);
    let clock = Instant::now();
    Rk4::new(STEP).integrate(system, 0.0, begin, STEP * f64::from(steps), |t, x| {
        count += 1;
        if count % EVERY == 0 {
            residual = residual.max(system.residual(t, x));
            energy = energy.max((system.energy(t, x) / start - 1.0).abs());
        }
        ControlFlow::Continue(())
    })?;
    let time = clock.elapsed().as_secs_f64() * 1e9 / f64::from(steps);
    Ok(Run { residual, energy, time })
}

/// Prints what ten minutes of a simulation with its defaults show, restored and not. Says whether the restored one holds its
/// constraints to rounding.
fn simulated<S, const N: usize>(name: &str, system: &S, begin: &[f64; N]) -> Result<bool, Box<dyn Error>>
where
    S: Monitored<f64, N> + Simulate<f64, N> + Clone,
{
    let mut last = f64::NAN;
    for how in ["", ", restored"] {
        let run = system.simulation(&(*begin).into());
        let run = if how.is_empty() { run.without_projection() } else { run };
        let clock = Instant::now();
        let motion = run.run(0.0..600.0).map_err(|error| error.to_string())?;
        let time = clock.elapsed().as_secs_f64() * 1e3;
        last = motion.map(|t, x| system.residual(t, &(*x).into())).fold(0.0, f64::max);
        let quality = motion.statistics();
        let energy = quality.energy.unwrap_or(f64::NAN);
        println!("| {name}{how} | {last:.1e} | {energy:.1e} | {} | {time:.1} |", quality.work.evaluations);
    }
    Ok(last <= ROUNDING)
}

fn show(name: &str, free: &Run, kept: &Run) -> bool {
    for (how, run) in [("", free), (", restored", kept)] {
        println!("| {name}{how} | {:.1e} | {:.1e} | {:.0} |", run.residual, run.energy, run.time);
    }
    kept.residual <= ROUNDING
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "What restoring `f(t, x) = 0` after every step gains, and what it costs.";
    let number = |word: &str| word.parse().ok().filter(|steps| *steps > 0);
    let steps = match arguments::read(about, "STEPS", "of each system; a million by default", MILLION, number)
    {
        Ok(steps) => steps,
        Err(status) => return Ok(status),
    };
    println!("| {steps} steps of {STEP} s | largest `f` | energy, relative | ns per step |");
    println!("| --- | --- | --- | --- |");

    let pendulum = Pendulum { m: 1.0, l: 1.0, g: 9.81 }.prepare()?;
    let swing: [f64; 3] = pendulum::State { x: 0.6, y: -0.8, omega: 0.0 }.into();
    let mut healthy =
        show("pendulum", &run(&pendulum, &swing, steps)?, &run(&projected(&pendulum), &swing, steps)?);

    let top = Top { A: 0.9, B: 0.7, C: 0.5 }.prepare()?;
    let turn: [f64; 7] =
        top::State { w: 1.0, spin_x: 1.2, spin_y: 2.0, spin_z: 0.8, ..Default::default() }.into();
    healthy &= show("top", &run(&top, &turn, steps)?, &run(&projected(&top), &turn, steps)?);

    let linkage = FourBar { a: 0.4, b: 1.1, c: 0.8, d: 1.0, rho: 2.0, g: 9.81 }.prepare()?;
    let guess = four_bar::Coordinates { q1: 0.8, q2: 0.5, q3: 1.5 };
    let four_bar::Coordinates { q1, q2, q3 } = linkage.consistent(0.0, &guess, &["q1"])?;
    let crank: [f64; 4] = four_bar::State { q1, q2, q3, turn: 4.0 }.into();
    healthy &= show("linkage", &run(&linkage, &crank, steps)?, &run(&projected(&linkage), &crank, steps)?);

    println!("\n| 600 s of `simulate` | largest `f` | energy, relative | evaluations | ms |");
    println!("| --- | --- | --- | --- | --- |");
    healthy &= simulated("pendulum", &pendulum, &swing)?;
    healthy &= simulated("top", &top, &turn)?;
    healthy &= simulated("linkage", &linkage, &crank)?;
    Ok(if healthy { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
