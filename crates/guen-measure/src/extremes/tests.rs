//! The shortened battery of extremes, and the errors of right-hand sides: see `docs/extremes.md`.
//!
//! Builds without optimisation take the reference in 71 digits slowly: they ask less. All of it is in
//! `cargo run --release -p guen-measure --bin extremes`.

use guen::prelude::*;
use guen::steppers::Method;
use guen_benchmarks::systems::{EulerTop, Hoop, hoop};

use super::{battery, bounds};
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
    let states = if cfg!(debug_assertions) { 20 } else { 10_000 };
    let (mut tightest, mut refused) = (0.0_f64, 0);
    for found in bounds::all(states, 2, None, |found| println!("{:.1} s: {}", found.seconds, found.system)) {
        println!("{found}");
        assert!(
            found.holds(),
            "{}: beyond {} u (cond + kappa); {}",
            found.system,
            bounds::FACTOR,
            found.worst
        );
        tightest = tightest.max(found.whole[0][0].largest());
        refused += usize::from(found.refused.is_some());
    }
    // The sled whose mass matrix has less left than single precision has.
    assert_eq!(refused, 1);
    // The bound is not idle: some errors come near it.
    assert!(tightest > 0.02 * bounds::FACTOR, "{tightest}");
}
