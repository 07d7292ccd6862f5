//! Three systems: the paper's hoop, which falls over in some motions, Chaplygin's sled, and a car with a trailer.

use guen::prelude::*;
use guen_benchmarks::systems::car1::{self, Car1};
use guen_benchmarks::systems::hoop::{self, Hoop};
use guen_benchmarks::systems::sled::{self, Sled};
use guen_study::{Design, Motions, Rows, Sampling, Sweep};

use crate::Failure;

/// The names of the systems.
pub const SYSTEMS: [&str; 3] = ["hoop", "sled", "car"];
/// The steps of a motion.
pub const STEPS: u32 = 100;
/// The step.
pub const METHOD: Rk4 = Rk4::new(0.01);

/// The design of the hoops.
pub fn hoop_design(motions: u64) -> Sampling {
    Design::latin_hypercube(motions, 1)
        .uniform("a", 0.5, 1.5)
        .uniform("lean", 0.3, 1.5)
        .uniform("spin", 0.0, 4.0)
}

/// A hoop of a point of the design.
pub fn hoop_of(
    a: f64,
    lean: f64,
    spin: f64,
) -> Result<(hoop::Prepared<f64>, hoop::State<f64>), guen::ConstantsError> {
    let hoop = Hoop { a, A: 0.5, C: 1.0, g: 9.81 }.prepare()?;
    Ok((hoop, hoop::State { theta: lean, eta2: spin, eta3: 0.9, zeta: a * lean.sin(), ..Default::default() }))
}

/// The motions of the hoops.
pub fn hoops(motions: u64) -> Motions<'static, hoop::Prepared<f64>, 9> {
    Sweep::over(hoop_design(motions), |point| {
        let [a, lean, spin] = [point.get("a")?, point.get("lean")?, point.get("spin")?];
        Ok(hoop_of(a, lean, spin)?)
    })
}

fn sleds(motions: u64) -> Motions<'static, sled::Prepared<f64>, 5> {
    let design = Design::random(motions, 2).normal("alpha", 0.1, 0.05).log_uniform("k", 0.1, 1.0);
    Sweep::over(design, |point| {
        let constants = Sled {
            m: 1.0,
            alpha: point.get("alpha")?,
            beta: 0.05,
            k: point.get("k")?,
            incline: 0.2,
            g: 9.81,
        };
        Ok((constants.prepare()?, sled::State { eta1: 1.0, eta2: 0.5, ..Default::default() }))
    })
}

fn cars(motions: u64) -> Motions<'static, car1::Prepared<f64>, 7> {
    let design = Design::sobol(motions, 3).uniform("d", 1.0, 3.0).uniform("speed", -5.0, 5.0);
    Sweep::over(design, |point| {
        let constants = Car1 { m: 3.0, J: 2.0, I: 0.125, l: 2.0, M: 1.0, K: 0.5, d: point.get("d")? };
        Ok((
            constants.prepare()?,
            car1::State { steering: 0.3, speed: point.get("speed")?, ..Default::default() },
        ))
    })
}

/// The sweep of a system: end states of short motions, as Parquet.
pub fn sweep(system: &str, motions: u64) -> Result<Sweep<'static>, Failure> {
    let span = 0.0..0.01 * f64::from(STEPS);
    let sweep = match system {
        "hoop" => hoops(motions).end_states(METHOD, span),
        "sled" => sleds(motions).end_states(METHOD, span),
        "car" => cars(motions).end_states(METHOD, span),
        _ => return Err(format!("no system `{system}`, but {SYSTEMS:?}").into()),
    };
    Ok(sweep.named(system).with_rows(Rows::Parquet).silent())
}
