//! What guards say of fixed steps that are too long: within a run, at its end however short it is, and next to a pole.

use core::ops::ControlFlow;

use guen_runtime::prelude::*;
use guen_runtime::steppers::Method;
use guen_runtime::{Equations, Generic, Guarded, RunningError, generic};

fn go_on<const N: usize>(_: f64, _: &[f64; N]) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// `x'' = -x`
struct Oscillator;

impl Equations<2> for Oscillator {
    fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, -x]
    }
}

/// A velocity that is damped at a rate of a million towards `cos t`, and a position that follows it.
struct Damped;

impl Equations<2> for Damped {
    fn rates<R: Real>(&self, t: R, &[_, v]: &[R; 2]) -> [R; 2] {
        let (sin, cos) = t.sin_cos();
        [v, -R::from_ratio(1_000_000, 1) * (v - cos) - sin]
    }
}

/// Whether a run passes with this limit of the steps, the error of its end relative to the amplitude, and the cause.
fn run<E: Equations<2>, M: Method<f64, Generic<E>, 2>>(
    of: E,
    method: &M,
    start: [f64; 2],
    span: f64,
    step: f64,
) -> Result<[f64; 2], Cause> {
    // Often: it is the estimates that are looked at, and not how well a few of them stand for all steps.
    let guard = Guard { step, every: Some(10), ..Guard::default() };
    let run = Integration::new(&generic(of), 0.0, &start).guard(guard).run(method, span);
    run.map(|done| done.state).map_err(|error| error.cause)
}

/// The estimates, summed up, against the error of a hundred radians: between the factors given.
#[test]
fn estimates_follow_the_errors_of_every_method() {
    fn check<M: Method<f64, Generic<Oscillator>, 2>>(name: &str, method: &M, least: f64, most: f64) {
        let span = 100.0;
        let end = run(Oscillator, method, [1.0, 0.3], span, f64::INFINITY).unwrap();
        let (sin, cos) = span.sin_cos();
        let off = (end[0] - cos - 0.3 * sin).abs().max((end[1] + sin - 0.3 * cos).abs());
        let passes = |limit: f64| run(Oscillator, method, [1.0, 0.3], span, limit).is_ok();
        assert!(passes(most * off), "{name}: the estimate is above {most} times the error {off:.1e}");
        assert!(!passes(least * off), "{name}: the estimate is below {least} times the error {off:.1e}");
    }
    check("Euler", &Euler::new(0.003), 0.2, 3.0);
    check("RK4", &Rk4::new(0.4), 0.3, 3.0);
    check("RK4 compensated", &Rk4::new(0.4).compensated(), 0.3, 3.0);
    check("RK8", &Rk8::new(2.0), 0.5, 5.0);
    check("Gauss 4", &Gauss4::new(0.7), 0.2, 3.0);
    // The formulas below order six are taken to that order by their ratio, which is too careful in smooth motions.
    check("Gauss 6", &Gauss6::new(1.5), 1.0, 50.0);
}

#[test]
fn gauss_is_judged_by_the_transient_that_it_does_not_damp() {
    for step in [1e-3, 1e-2, 1e-1] {
        for kick in [0.0, 1.0] {
            let four = run(Damped, &Gauss4::new(step), [0.0, 1.0 + kick], 0.1, 0.05);
            let six = run(Damped, &Gauss6::new(step), [0.0, 1.0 + kick], 0.1, 0.05);
            for (name, end) in [("Gauss 4", four), ("Gauss 6", six)] {
                match end {
                    // On the slow motion: right, in steps of up to 1e5 times the time of the damping.
                    Ok([x, v]) if kick == 0.0 => {
                        let off = (x - 0.1_f64.sin()).abs().max((v - 0.1_f64.cos()).abs());
                        assert!(off < 1e-3, "{name} {step}: {off:e}");
                    }
                    Err(Cause::Step { entry: 1, defect, limit, .. }) if kick != 0.0 => {
                        assert!(defect > 0.4 && limit == 0.05, "{name} {step}: {defect}");
                    }
                    other => panic!("{name} {step}, kick {kick}: {other:?}"),
                }
            }
        }
    }
}

#[test]
fn the_end_of_the_shortest_run_is_looked_at() {
    let system = generic(Damped);
    for steps in [1, 2, 5] {
        let span = 1e-3 * f64::from(steps);
        let four = Rk4::new(1e-3).integrate(&system, 0.0, &[0.0, 2.0], span, go_on).unwrap_err();
        let eight = Rk8::new(1e-3).integrate(&system, 0.0, &[0.0, 2.0], span, go_on).unwrap_err();
        let short = Rk8::new(1e-3).sample(&system, 0.0, &[0.0, 2.0], &[span], |_, _, _| ()).unwrap_err();
        for error in [four, eight, short] {
            assert!(matches!(error.cause, Cause::Step { .. }), "{error}");
            assert_eq!((error.time, error.state), (0.0, [0.0, 2.0]));
        }
    }
    // An entry that begins at zero has no size in the first steps: what is small beside the others is no fault.
    let fall = from_fn(|_t: f64, &[_, v]: &[f64; 2]| [v, -9.81]);
    let done = Euler::new(0.01).integrate(&fall, 0.0, &[0.0, 1.0], 0.01, go_on).unwrap();
    assert_eq!(done.statistics.accepted, 1);
}

#[test]
fn a_last_step_that_is_too_long_is_seen_with_an_observer_and_without() {
    let late = from_fn(|t: f64, &[v]: &[f64; 1]| [if t > 0.91 { -25.0 * v } else { 0.0 }]);
    let run = Integration::new(&late, 0.0, &[1.0]).run(&Rk4::new(0.1), 1.0).unwrap_err();
    let mut seen = 0;
    let mut count = |_: f64, _: &[f64; 1]| {
        seen += 1;
        ControlFlow::Continue(())
    };
    let observed = Integration::new(&late, 0.0, &[1.0]).observe(&mut count).run(&Rk4::new(0.1), 1.0);
    let observed = observed.unwrap_err();
    assert!(matches!(run.cause, Cause::Step { .. }), "{run}");
    assert_eq!((observed.cause, observed.time, observed.state), (run.cause, run.time, run.state));
    assert_eq!((seen, run.state), (10, [1.0]));
}

/// `x' = -v`, `y' = b v/x^2`: a function that must not vanish, `x`, and a pole of the rates there.
struct Pole {
    offset: f64,
}

impl System<f64, 2> for Pole {
    fn rhs(&self, t: f64, _: &[f64; 2]) -> [f64; 2] {
        let x = (self.offset.powi(2) + (t - 1.0).powi(2)).sqrt();
        [(t - 1.0) / x, self.offset / (x * x)]
    }

    fn guarded(&self) -> impl Guarded<f64, 2> {
        self
    }
}

impl Guarded<f64, 2> for Pole {
    fn singularities(
        &self,
        _t: RunningError<f64>,
        state: &[RunningError<f64>; 2],
        values: &mut [RunningError<f64>],
    ) -> usize {
        values[0] = state[0];
        1
    }
}

#[test]
fn passing_an_edge_between_two_looks_is_seen() {
    // From t = 0 to 2 past the smallest distance at t = 1; y makes a jump of pi.
    let angle = |offset: f64| 2.0 * (1.0 / offset).atan();
    let mut counts = (0, 0);
    for step in [0.01, 0.0099, 0.0101] {
        for offset in [1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 1e-5] {
            let start = [(1.0 + offset * offset).sqrt(), 0.0];
            // Of a guard that looks rarely: after the first step, and at the end.
            let guard = Guard { every: Some(1000), step: f64::INFINITY, ..Guard::default() };
            let pole = Pole { offset };
            let four = Integration::new(&pole, 0.0, &start).guard(guard).run(&Rk4::new(step), 2.0);
            let eight = Integration::new(&pole, 0.0, &start).guard(guard).run(&Rk8::new(step), 2.0);
            for run in [four, eight] {
                match run {
                    Ok(done) => {
                        let off = (done.state[1] - angle(offset)).abs();
                        assert!(off < 0.1, "step {step}, distance {offset}: off by {off}");
                        counts.0 += 1;
                    }
                    Err(error) => {
                        let Cause::ApproachingSingularity { found, ratio, function: 0, .. } = error.cause
                        else {
                            panic!("{error}")
                        };
                        assert!(ratio > 2.0 && (found - 1.0).abs() < 0.05, "{error}");
                        assert!(offset <= 1e-2, "a distance of {offset} is resolved by {step}");
                        counts.1 += 1;
                    }
                }
            }
        }
    }
    assert!(counts.0 >= 12 && counts.1 >= 18, "{counts:?}");
}

/// A system that keeps the bound of the time's rounding error with which its functions were asked.
struct Asked(core::cell::Cell<f64>);

impl System<f64, 1> for Asked {
    fn rhs(&self, _t: f64, _: &[f64; 1]) -> [f64; 1] {
        [0.0]
    }

    fn guarded(&self) -> impl Guarded<f64, 1> {
        self
    }
}

impl Guarded<f64, 1> for Asked {
    fn singularities(
        &self,
        t: RunningError<f64>,
        _: &[RunningError<f64>; 1],
        values: &mut [RunningError<f64>],
    ) -> usize {
        self.0.set(t.error / t.value);
        values[0] = RunningError::exact(1.0);
        1
    }
}

#[test]
fn a_time_is_known_to_one_rounding() {
    let system = Asked(core::cell::Cell::new(0.0));
    Rk4::new(0.5).integrate(&system, 1e6, &[0.0], 1e6 + 2.0, go_on).unwrap();
    // In units of the real's epsilon.
    assert_eq!(system.0.get(), 1.0);
}
