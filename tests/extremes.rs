//! The shortened battery of extremes, the errors of right-hand sides, and runs there and back: see `docs/extremes.md`.
//!
//! Builds without optimisation take the reference in 71 digits slowly: they ask less. All of it is in
//! `cargo run --release --example extremes`.

#![allow(clippy::result_large_err, reason = "an error keeps the state that was reached")]

use guen::Dual;
use guen::prelude::*;
use guen::steppers::{Method, reversible};
use guen_benchmarks::systems::{EulerTop, Hoop, Sled, hoop, sled};

#[path = "../examples/extremes/battery/mod.rs"]
#[allow(dead_code, reason = "the tables are for the program")]
mod battery;
#[path = "../examples/extremes/bounds.rs"]
#[allow(dead_code, reason = "the head of the table is for the program")]
mod bounds;

use battery::systems::Damped;

/// Systems whose lines are quick without optimisation too.
const CHEAP: [&str; 5] = ["constants", "lanes", "single", "units", "starts"];

#[test]
fn no_failure_is_silent() {
    let wanted =
        |task: &battery::Task| task.quick && (!cfg!(debug_assertions) || CHEAP.contains(&task.system));
    let tasks: Vec<battery::Task> = battery::tasks().into_iter().filter(wanted).collect();
    let asked = tasks.len();
    let lines = battery::run(tasks, 2, |_, _, line, seconds| println!("{seconds:.1} s: {}", line.asked));
    lines.iter().for_each(|line| println!("{}", battery::table::paragraph(line)));
    let (right, refused, failures) = battery::table::count(&lines);
    assert_eq!((lines.len(), failures), (asked, 0));
    assert!(right > 40 && refused > 40, "{right} right, {refused} refused");
}

/// What was silent once, each by itself: steps that are too long where nobody looked.
#[test]
fn what_was_silent_is_refused() {
    fn cause<M, S, const N: usize>(method: &M, system: &S, start: &[f64; N], span: f64) -> Cause
    where
        M: Method<f64, S, N>,
        S: System<f64, N>,
    {
        let error = Integration::new(system, 0.0, start).run(method, span).unwrap_err();
        assert_eq!((error.time, error.state), (0.0, *start), "nothing but the start is in order");
        error.cause
    }
    // A pole of 1/sin(theta) that the first step jumps over.
    let top = EulerTop { I1: 1.0, I2: 2.0, I3: 3.0 }.prepare().unwrap();
    let start = [0.0, 1e-9, 0.0, 0.2, 0.3, 1.0];
    let causes = [
        cause(&Euler { step: 1e-4 }, &top, &start, 1.0),
        cause(&Rk4 { step: 1e-3 }, &top, &start, 1.0),
        cause(&Rk8::new(4e-3), &top, &start, 1.0),
    ];
    for cause in causes {
        assert!(matches!(cause, Cause::Approach { .. } | Cause::Step { .. }), "{cause}");
    }
    // A tilt next to pi, of which rounding leaves nothing, in a run of a few steps.
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
    let theta = std::f64::consts::PI - 1e-9;
    let flat = hoop::State { theta, zeta: theta.sin(), eta2: theta.sin(), eta3: -1.0, ..Default::default() };
    let edge = cause(&Dop853::new(1e-12, 1e-12), &hoop, &flat.into(), 0.01);
    assert!(matches!(edge, Cause::Edge { .. }), "{edge}");
    // Damping of 1e6/s in ten steps: explicit methods blow up, Gauss's keep the velocity.
    let damped = Damped { m: 1.0, k: 1.0, c: 1e6 }.prepare().unwrap();
    let (start, step) = ([1.0, -1.0], 1e-3);
    let causes = [
        cause(&Rk4 { step }, &damped, &start, 0.01),
        cause(&Rk8::new(step), &damped, &start, 0.01),
        cause(&Gauss4::new(step), &damped, &start, 0.01),
        cause(&Gauss6::new(step), &damped, &start, 0.01),
    ];
    for cause in causes {
        assert!(matches!(cause, Cause::Step { entry: 1, .. }), "{cause}");
    }
    // The same methods where they are right: the velocity creeps.
    let slow = [1.0, -1e-6];
    for end in [
        Integration::new(&damped, 0.0, &slow).run(&Gauss4::new(step), 0.01).unwrap().state,
        Integration::new(&damped, 0.0, &slow).run(&Gauss6::new(step), 0.01).unwrap().state,
    ] {
        assert!((end[1] + 1e-6).abs() < 1e-12, "{end:?}");
    }
}

#[test]
fn right_hand_sides_are_as_accurate_as_their_condition_allows() {
    let states = if cfg!(debug_assertions) { 100 } else { 10_000 };
    let mut tightest = 0.0_f64;
    for found in bounds::all(states) {
        println!("{found}");
        assert!(found.holds(), "{}: beyond {} u (cond + kappa)", found.system, bounds::FACTOR);
        tightest = tightest.max(found.whole[0][0].largest());
    }
    // The bound is not idle: some errors come near it.
    assert!(tightest > 0.02 * bounds::FACTOR, "{tightest}");
}

/// Rounding errors of the states, relative to the largest of the start.
fn off<const N: usize>(found: &[f64; N], start: &[f64; N]) -> f64 {
    let size = start.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    (0..N).map(|i| (found[i] - start[i]).abs()).fold(0.0, f64::max) / size
}

const UNIT: f64 = f64::EPSILON / 2.0;
/// The largest growth of roundings for which the way back is asked for.
const LIMIT: f64 = 1e-8;
/// There and back is right to so many roundings of the growth.
const FACTOR: f64 = 100.0;

fn tight() -> Dop853<Dual<f64, 9>> {
    Dop853::new(1e-15, 1e-16).with_max_steps(1_000_000)
}

#[test]
fn there_and_back_returns_within_a_hundred_roundings_of_the_growth() {
    let system = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
    for (theta, span) in [(1.2_f64, 1.0), (1.2, 5.0), (0.6, 2.0), (1.2, -3.0)] {
        let start: [f64; 9] =
            hoop::State { theta, zeta: theta.sin(), eta1: 0.1, eta2: 1.5, eta3: 2.0, ..Default::default() }
                .into();
        let there = reversible(&system, &[], &tight(), 0.0, &start, span, LIMIT).unwrap();
        let back = Dop853::new(1e-15, 1e-16)
            .integrate(&system, span, &there.done.state, 0.0, |_, _| ControlFlow::Continue(()))
            .unwrap();
        let (found, allowed) = (off(&back.state, &start), FACTOR * UNIT * there.growth);
        println!("hoop, {span} s: off by {found:.1e}, {allowed:.1e} allowed; growth {:.1e}", there.growth);
        assert!(found <= allowed);
        // The matrix against a difference of runs.
        let moved: [f64; 9] = std::array::from_fn(|i| start[i] + if i == 0 { 1e-6 } else { 0.0 });
        let end = Dop853::new(1e-15, 1e-16)
            .integrate(&system, 0.0, &moved, span, |_, _| ControlFlow::Continue(()))
            .unwrap();
        for i in 0..9 {
            let slope = (end.state[i] - there.done.state[i]) / 1e-6;
            assert!((slope - there.matrix[i][0]).abs() < 1e-3 * there.growth, "entry {i}");
        }
    }
}

#[test]
fn the_sled_on_an_incline_says_when_it_cannot_be_undone() {
    let system = Sled { m: 1.0, alpha: 0.2, beta: 0.3, k: 0.4, incline: 0.3, g: 9.81 }.prepare().unwrap();
    let start: [f64; 5] = sled::State { phi: 0.3, eta1: 0.7, eta2: 0.5, ..Default::default() }.into();
    let method = Dop853::<Dual<f64, 5>>::new(1e-15, 1e-16).with_max_steps(1_000_000);
    let back = |from: f64, state: &[f64; 5]| {
        let run =
            Dop853::new(1e-15, 1e-16).integrate(&system, from, state, 0.0, |_, _| ControlFlow::Continue(()));
        run.map_or(f64::INFINITY, |done| off(&done.state, &start))
    };
    let mut refused = 0;
    for span in [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0] {
        match reversible(&system, &[], &method, 0.0, &start, span, LIMIT) {
            Ok(there) => {
                let (found, allowed) = (back(span, &there.done.state), FACTOR * UNIT * there.growth);
                println!("{span} s: off by {found:.1e}, {allowed:.1e} allowed");
                assert!(found <= allowed && UNIT * there.growth <= LIMIT);
            }
            Err(error) => {
                println!("{span} s: {error}");
                assert!(matches!(error.cause, Cause::Irreversible { .. }) && error.time < span);
                // What is returned can be undone.
                assert!(back(error.time, &error.state) < 100.0 * LIMIT);
                refused += 1;
            }
        }
    }
    assert!(refused >= 1, "after a minute the sled slides as if it had never turned");
}
