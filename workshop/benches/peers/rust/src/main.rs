//! DOP853 of guen next to that of other Rust crates: the paper's hoop, the same right-hand side, the same initial states,
//! the error of the end state against 25 digits. Three motions, each over five, ten and twenty seconds.
//!
//! ```text
//! cd workshop/benches/peers/rust && RUSTFLAGS="-C target-cpu=native" cargo run --release
//! ```
//!
//! For each accuracy and motion every crate runs at the loosest of its tolerances 1e-2, 10^-2.125, .. 1e-14 that reaches
//! it; motions that some crate does not reach it on are left out. What is compared is the time of all runs together, so that
//! one lucky tolerance decides little. The crates take turns; times are medians of 201, ratios medians of the ratios within a
//! turn, with their quartiles. Nobody
//! is asked for dense output: guen keeps no steps; `ode_solvers` is told to keep the accepted ones only (`Sparse`) and
//! `differential-equations` keeps those by default, for neither can keep less. Below that, what an evaluation of ours takes
//! beyond the right-hand side.
//!
//! Ends with a nonzero status if ours is not at least 1.3 times as fast as the best peer at 1e-6 and 1e-9.

use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

use differential_equations::prelude::{ExplicitRungeKutta, IVP, ODE};
use guen::mechanical_system;
use guen::prelude::*;
use ode_solvers::dop_shared::OutputType;

mechanical_system! {
    /// A hoop of radius `a` that rolls without slipping on a horizontal plane.
    pub system Hoop {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = dot(psi)*cos(theta) + dot(phi);
        }
        constraints {
            eta4: dot(xi)   = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta)  + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);
    }
}

type State = [f64; 9];
const SPANS: [&str; 3] = ["5", "10", "20"];

/// The same right-hand side for everybody.
#[derive(Clone, Copy)]
struct Shared(hoop::Prepared);

impl ODE<f64, State> for Shared {
    #[inline]
    fn diff(&self, t: f64, y: &State, dydt: &mut State) {
        *dydt = guen::System::rhs(&self.0, t, y);
    }
}

type Vector = ode_solvers::SVector<f64, 9>;

impl ode_solvers::System<f64, Vector> for Shared {
    #[inline]
    fn system(&self, t: f64, y: &Vector, dy: &mut Vector) {
        *dy = Vector::from(guen::System::rhs(&self.0, t, &(*y).into()));
    }
}

const PEERS: [&str; 3] = ["guen", "ode_solvers", "differential-equations"];

/// A motion, and where it ends.
struct Motion {
    hoop: hoop::Prepared,
    start: State,
    span: f64,
    end: State,
}

impl Motion {
    /// The largest error of an end state in any entry.
    fn error(&self, state: &State) -> f64 {
        (0..9).map(|i| (state[i] - self.end[i]).abs()).fold(0.0, f64::max)
    }

    /// The loosest tolerance with which one of the crates reaches an accuracy.
    fn tolerance(&self, who: usize, accuracy: f64) -> Option<f64> {
        let tolerances = (16..=112).map(|k| 10.0_f64.powf(-0.125 * f64::from(k)));
        tolerances
            .into_iter()
            .find(|&tolerance| run(who, self, tolerance).is_some_and(|state| self.error(&state) <= accuracy))
    }
}

/// The end state by one of the crates at a tolerance.
fn run(who: usize, Motion { hoop, start, span, .. }: &Motion, tolerance: f64) -> Option<State> {
    let (start, span) = (black_box(start), *span);
    match who {
        0 => {
            let method = Dop853::new(tolerance, tolerance);
            Some(Integration::new(hoop, 0.0, start).run(&method, span).ok()?.state)
        }
        1 => {
            let mut stepper = ode_solvers::Dop853::from_param(
                Shared(*hoop),
                0.0,
                span,
                span,
                Vector::from(*start),
                tolerance,
                tolerance,
                0.9,
                0.0,
                0.333,
                6.0,
                span,
                0.0,
                100_000,
                u32::MAX,
                OutputType::Sparse,
            );
            stepper.integrate().ok()?;
            Some((*stepper.y_out().last()?).into())
        }
        _ => {
            let problem = Shared(*hoop);
            let method = ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance);
            let solution = IVP::ode(&problem, 0.0, span, *start).method(method).solve().ok()?;
            solution.y.last().copied()
        }
    }
}

/// The motions of the references over each of the spans.
fn motions() -> Option<Vec<Motion>> {
    let file: serde_json::Value =
        serde_json::from_str(include_str!("../../../../../tests/data/01_hoop_rolling.json")).ok()?;
    let number = |value: &serde_json::Value| -> Option<f64> { value.as_str()?.parse().ok() };
    let mut motions = Vec::new();
    for case in file["cases"].as_array()? {
        let constant = |name: &str| number(&case["parameters"][name]);
        // The reference knows a mass, which divides out.
        let m = constant("m")?;
        let hoop =
            Hoop { a: constant("a")?, A: constant("A")? / m, C: constant("C")? / m, g: constant("g")? };
        let hoop = hoop.prepare().ok()?;
        let state = |k: usize| -> Option<State> {
            let entries = case["states"][k].as_array()?.iter();
            entries.map(number).collect::<Option<Vec<f64>>>()?.try_into().ok()
        };
        for span in SPANS {
            let at = case["times"].as_array()?.iter().position(|time| time == span)?;
            motions.push(Motion { hoop, start: state(0)?, span: span.parse().ok()?, end: state(at)? });
        }
    }
    Some(motions)
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Shared machines are noisy: many short runs.
const ROUNDS: usize = 201;

fn main() -> ExitCode {
    let motions = motions().expect("the references are in the repository");
    let mut enough = true;
    println!(
        "{} motions of the hoop with DOP853, microseconds; ratio: time of the crate to that of guen",
        motions.len()
    );
    for accuracy in [1e-3, 1e-6, 1e-9, 1e-12] {
        // The motions on which everybody is accurate enough, with the tolerances.
        let chosen: Vec<(&Motion, [f64; 3])> = motions
            .iter()
            .filter_map(|motion| {
                let tolerance = |who| motion.tolerance(who, accuracy);
                Some((motion, [tolerance(0)?, tolerance(1)?, tolerance(2)?]))
            })
            .collect();
        let mut times: [Vec<f64>; 3] = Default::default();
        for _ in 0..ROUNDS {
            for (who, times) in times.iter_mut().enumerate() {
                times.push(seconds(|| {
                    for (motion, tolerances) in &chosen {
                        black_box(run(who, motion, tolerances[who]));
                    }
                }));
            }
        }
        println!("\nerror at most {accuracy:e}, {} motions", chosen.len());
        let mut best = f64::INFINITY;
        for who in 0..PEERS.len() {
            let mut ratios: Vec<f64> =
                times[who].iter().zip(&times[0]).map(|(peer, own)| peer / own).collect();
            let ratio = median(&mut ratios);
            let (low, high) = (ratios[ratios.len() / 4], ratios[3 * ratios.len() / 4]);
            if who > 0 {
                best = best.min(ratio);
            }
            let microseconds = 1e6 * median(&mut times[who].clone());
            println!("  {:<24} {microseconds:8.1}  ratio {ratio:5.2} [{low:4.2}, {high:4.2}]", PEERS[who]);
        }
        let compared = !chosen.is_empty();
        if (accuracy == 1e-6 || accuracy == 1e-9) && !(compared && best >= 1.3) {
            enough = false;
        }
    }
    beyond(&motions[1]);
    if enough {
        ExitCode::SUCCESS
    } else {
        eprintln!("the best peer is less than 1.3 times as slow at 1e-6 or 1e-9");
        ExitCode::FAILURE
    }
}

/// What an evaluation takes within DOP853, and alone: each at a state that depends on the one before, as in a method, and
/// at states that do not depend on each other.
fn beyond(Motion { hoop, start, span, .. }: &Motion) {
    const CHAIN: u32 = 2000;
    let method = Dop853::new(1e-9, 1e-9);
    let run = || Integration::new(hoop, 0.0, black_box(start)).guard(Guard::FINITE).run(&method, *span);
    let evaluations = run().map_or(f64::NAN, |done| done.statistics.evaluations as f64);
    let apart: Vec<State> = (0..1024)
        .map(|k| std::array::from_fn(|i| start[i] + 1e-3 * f64::from(k % 32) * (i as f64 - 4.0)))
        .collect();
    let mut times: [Vec<f64>; 3] = Default::default();
    for _ in 0..ROUNDS {
        times[0].push(seconds(|| {
            black_box(run().is_ok());
        }));
        times[1].push(seconds(|| {
            let mut x = *black_box(start);
            for _ in 0..CHAIN {
                let rates = guen::System::rhs(hoop, 0.0, &x);
                x.iter_mut().zip(rates).for_each(|(x, rate)| *x += 1e-9 * rate);
            }
            black_box(x);
        }));
        times[2].push(seconds(|| {
            for x in black_box(&apart) {
                black_box(guen::System::rhs(hoop, 0.0, x));
            }
        }));
    }
    let each = 1e9 * median(&mut times[0]) / evaluations;
    let chain = 1e9 * median(&mut times[1]) / f64::from(CHAIN);
    let apart = 1e9 * median(&mut times[2]) / 1024.0;
    println!("\nguen's DOP853 at 1e-9: {each:.1} ns for each of {evaluations} evaluations");
    println!(
        "  right-hand side that waits for the one before  {chain:5.1} ns, beyond it {:5.1} ns",
        each - chain
    );
    println!(
        "  right-hand sides that do not wait              {apart:5.1} ns, beyond it {:5.1} ns",
        each - apart
    );
}
