//! The drivers: accuracy on known motions, landing, statistics, and every way to fail.

use core::cell::Cell;
use core::ops::ControlFlow;

use guen_runtime::prelude::*;
use guen_runtime::{Setting, System};

fn go_on<R, const N: usize>(_: R, _: &[R; N]) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

fn growth() -> impl System<f64, 1> {
    from_fn(|_t: f64, &[x]: &[f64; 1]| [x])
}

fn oscillator() -> impl System<f64, 2> {
    from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x])
}

/// `x' = x^2` from 1: `x = 1 / (1 - t)`, with a pole at 1.
fn pole() -> impl System<f64, 1> {
    from_fn(|_t: f64, &[x]: &[f64; 1]| [x * x])
}

#[test]
fn growth_and_oscillation_are_followed_to_tolerance() {
    let tight = Dop853::new(1e-13, 1e-13);
    let done = tight.integrate(&growth(), 0.0, &[1.0], 5.0, go_on).unwrap();
    assert!((done.state[0] / 5.0_f64.exp() - 1.0).abs() < 1e-12);
    let done = tight.integrate(&oscillator(), 0.0, &[0.0, 1.0], 100.0, go_on).unwrap();
    assert!((done.state[0] - 100.0_f64.sin()).abs() < 1e-11);
    let done = Rk4::new(1e-3).integrate(&oscillator(), 0.0, &[0.0, 1.0], 10.0, go_on).unwrap();
    assert!((done.state[0] - 10.0_f64.sin()).abs() < 1e-12);
}

#[test]
fn a_comet_returns() {
    // Kepler's problem with eccentricity 0.9, started at the perihelion, over one period 2 pi.
    let e: f64 = 0.9;
    let kepler = from_fn(|_t: f64, &[x, y, u, v]: &[f64; 4]| {
        let r = (x * x + y * y).sqrt();
        [u, v, -x / (r * r * r), -y / (r * r * r)]
    });
    let start = [1.0 - e, 0.0, 0.0, ((1.0 + e) / (1.0 - e)).sqrt()];
    let energy = |&[x, y, u, v]: &[f64; 4]| 0.5 * (u * u + v * v) - 1.0 / (x * x + y * y).sqrt();
    let mut drift = 0.0_f64;
    let done = Dop853::new(1e-13, 1e-13)
        .integrate(&kepler, 0.0, &start, std::f64::consts::TAU, |_t, x| {
            drift = drift.max((energy(x) - energy(&start)).abs());
            ControlFlow::Continue(())
        })
        .unwrap();
    // scipy's DOP853 is off by 7.6e-10 with the same tolerances.
    let errors: [f64; 4] = core::array::from_fn(|i| (done.state[i] - start[i]).abs());
    assert!(errors.into_iter().all(|error| error < 1e-9), "{errors:?}");
    assert!(drift < 1e-11, "{drift:e}");
}

#[test]
fn the_error_follows_the_tolerance() {
    let error = |tolerance: f64| {
        let method = Dop853::new(tolerance, tolerance);
        let done = method.integrate(&oscillator(), 0.0, &[0.0, 1.0], 20.0, go_on).unwrap();
        (done.state[0] - 20.0_f64.sin()).abs()
    };
    for tolerance in [1e-5, 1e-7, 1e-9, 1e-11] {
        assert!(error(tolerance) < 100.0 * tolerance, "{tolerance:e}: {:e}", error(tolerance));
    }
}

#[test]
fn counted_evaluations_are_those_made() {
    let count = Cell::new(0);
    let counting = from_fn(|t: f64, &[x]: &[f64; 1]| {
        count.set(count.get() + 1);
        [(50.0 * t).sin() - x]
    });
    let done = Dop853::new(1e-9, 1e-9).with_first_step(1.0).integrate(&counting, 0.0, &[0.0], 3.0, go_on);
    let statistics = done.unwrap().statistics;
    assert_eq!(statistics.evaluations, count.get());
    assert!(statistics.rejected > 0);
    assert_eq!(statistics.evaluations, 1 + 12 * statistics.accepted + 11 * statistics.rejected);
    count.set(0);
    // What a guard evaluates to judge a step is its own, and it would not be content with this one.
    let run = Integration::new(&counting, 0.0, &[0.0]).guard(Guard::FINITE);
    let done = run.run(&Rk4::new(0.1), 1.0).unwrap();
    assert_eq!((done.statistics.evaluations, done.statistics.accepted), (count.get(), 10));
}

#[test]
fn fixed_steps_do_not_drift() {
    let mut times = Vec::new();
    let done = Rk4::new(0.1)
        .integrate(&growth(), 1.0, &[1.0], 2.05, |t, _| {
            times.push(t);
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(times.len(), 11);
    for (k, time) in times[..10].iter().enumerate() {
        assert_eq!(*time, 1.0 + 0.1 * (k + 1) as f64);
    }
    assert_eq!((times[10], done.time), (2.05, 2.05));
    // A third of a span is three steps, though three thirds exceed or miss one by a rounding.
    for span in [1.0, 0.7, 0.1, 1e9, 3e-7] {
        let done = Rk4::new(span / 3.0).integrate(&oscillator(), 0.0, &[0.0, 0.0], span, go_on).unwrap();
        assert_eq!(done.statistics.accepted, 3);
    }
}

#[test]
fn a_run_backwards_returns() {
    let method = Dop853::new(1e-13, 1e-13);
    let there = method.integrate(&oscillator(), 0.0, &[0.3, 0.8], 7.0, go_on).unwrap();
    let back = method.integrate(&oscillator(), 7.0, &there.state, 0.0, go_on).unwrap();
    assert_eq!(back.time, 0.0);
    assert!((back.state[0] - 0.3).abs() < 1e-11 && (back.state[1] - 0.8).abs() < 1e-11);
    let back = Rk4::new(0.001).integrate(&oscillator(), 7.0, &there.state, 0.0, go_on).unwrap();
    assert!((back.state[0] - 0.3).abs() < 1e-11);
}

#[test]
fn a_span_of_zero_is_no_step() {
    let watch = |_: f64, _: &[f64; 1]| -> ControlFlow<()> { unreachable!("no step, no call") };
    let done = Dop853::new(1e-9, 1e-9).integrate(&growth(), 2.0, &[1.5], 2.0, watch).unwrap();
    assert_eq!((done.time, done.state, done.outcome), (2.0, [1.5], Outcome::Arrived));
    assert_eq!(done.statistics, Statistics::default());
    let done = Rk4::new(0.1).integrate(&growth(), 2.0, &[1.5], 2.0, watch).unwrap();
    assert_eq!((done.time, done.state), (2.0, [1.5]));
}

#[test]
fn samples_are_taken_at_the_times_given() {
    let times = [0.0, 0.5, 0.5, 0.73, 2.0, 1.0, -1.0];
    let mut visited = Vec::new();
    let done = Dop853::new(1e-12, 1e-12)
        .sample(&growth(), 0.0, &[1.0], &times, |index, t, x| {
            visited.push((index, t));
            assert!((x[0] - t.exp()).abs() < 1e-10, "{t}");
        })
        .unwrap();
    assert_eq!(visited, times.into_iter().enumerate().collect::<Vec<_>>());
    assert_eq!(done.time, -1.0);
    let mut visited = 0;
    let done = Rk4::new(0.001)
        .sample(&growth(), 0.0, &[1.0], &times, |index, t, x| {
            assert_eq!((index, t), (visited, times[visited]));
            assert!((x[0] - t.exp()).abs() < 1e-11, "{t}");
            visited += 1;
        })
        .unwrap();
    assert_eq!((visited, done.time), (7, -1.0));
}

#[test]
fn landing_often_does_not_shorten_the_steps_between() {
    // Pairs of times close to each other, far from the next pair: after the short step the long one is taken up.
    let method = Dop853::new(1e-9, 1e-9);
    let steps = |times: &[f64]| {
        method.sample(&oscillator(), 0.0, &[0.0, 1.0], times, |_, _, _| {}).unwrap().statistics.accepted
    };
    let (single, paired) = (steps(&[10.0, 20.0, 30.0]), steps(&[10.0, 10.0 + 1e-9, 20.0, 20.0 + 1e-9, 30.0]));
    assert!(paired <= single + 4, "{single} {paired}");
}

#[test]
fn the_observer_can_stop() {
    let falling = from_fn(|_t: f64, &[_, v]: &[f64; 2]| [v, -9.81]);
    let stop =
        |_: f64, x: &[f64; 2]| if x[0] < 0.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let done = Rk4::new(0.01).integrate(&falling, 0.0, &[1.0, 0.0], 10.0, stop).unwrap();
    assert_eq!(done.outcome, Outcome::Stopped);
    assert!(done.state[0] < 0.0 && (done.time - (2.0_f64 / 9.81).sqrt()).abs() < 0.011);
}

#[test]
fn a_pole_is_an_underflow_with_the_last_good_state() {
    let error = Dop853::new(1e-10, 1e-10).integrate(&pole(), 0.0, &[1.0], 2.0, go_on).unwrap_err();
    assert_eq!(error.cause, Cause::StepUnderflow);
    assert!((error.time - 1.0).abs() < 1e-9 && error.state[0].is_finite() && error.state[0] > 1e9);
    assert!(error.statistics.accepted > 10);
    assert!(error.to_string().starts_with("integration stopped at t = "), "{error}");
}

#[test]
fn a_jump_that_no_step_in_doubles_goes_over_is_an_underflow_soon() {
    // Heights at which the error of the shortest steps is about the tolerance are among them: a step of a few spacings of
    // numbers was tried again and again, as its end was rounded to where it had ended before.
    for height in 1..200 {
        let jumping =
            from_fn(|t: f64, _: &[f64; 1]| [if t < 33.29925 { 1.0 } else { 50.0 * f64::from(height) }]);
        let end = Dop853::new(1e-13, 1e-13).integrate(&jumping, 33.2, &[0.0], 33.4, go_on);
        let Err(error) = end else { continue };
        assert_eq!(error.cause, Cause::StepUnderflow, "{height}");
        assert!(error.statistics.rejected < 200, "{height}: {}", error.statistics.rejected);
    }
}

#[test]
fn the_end_of_a_domain_is_not_finite() {
    // x' = -1 / (2 sqrt x): x = 1 - t until the root has no argument.
    let sinking = from_fn(|_t: f64, &[x]: &[f64; 1]| [-x.sqrt() / x.sqrt()]);
    let error = Dop853::new(1e-10, 1e-10).integrate(&sinking, 0.0, &[1.0], 2.0, go_on).unwrap_err();
    assert_eq!(error.cause, Cause::NotFinite);
    assert!((error.time - 1.0).abs() < 1e-12 && error.state[0] >= 0.0);
    let error = Rk4::new(0.3).integrate(&sinking, 0.0, &[1.0], 2.0, go_on).unwrap_err();
    assert_eq!((error.cause, error.time), (Cause::NotFinite, 0.3 * 3.0));
    assert!((error.state[0] - 0.1).abs() < 1e-14);
}

#[test]
fn a_rate_without_value_is_reported_at_once() {
    let broken = from_fn(|_t: f64, _: &[f64; 1]| [f64::NAN]);
    let error = Dop853::new(1e-9, 1e-9).integrate(&broken, 3.0, &[1.0], 4.0, go_on).unwrap_err();
    assert_eq!((error.cause, error.time, error.state), (Cause::NotFinite, 3.0, [1.0]));
    assert_eq!(error.statistics.evaluations, 1);
    let error = Rk4::new(0.1).integrate(&broken, 3.0, &[1.0], 4.0, go_on).unwrap_err();
    assert_eq!((error.cause, error.time, error.state), (Cause::NotFinite, 3.0, [1.0]));
    let error = Dop853::new(1e-9, 1e-9).integrate(&growth(), 0.0, &[f64::INFINITY], 1.0, go_on).unwrap_err();
    assert_eq!(error.cause, Cause::NotFinite);
}

#[test]
fn steps_are_limited() {
    let method = Dop853::new(1e-12, 1e-12).with_max_steps(7);
    let error = method.integrate(&oscillator(), 0.0, &[0.0, 1.0], 100.0, go_on).unwrap_err();
    assert_eq!(error.cause, Cause::TooManySteps { limit: 7 });
    assert_eq!(error.statistics.accepted + error.statistics.rejected, 7);
    assert!((error.state[0] - error.time.sin()).abs() < 1e-10);
}

#[test]
fn senseless_settings_are_refused() {
    for (rtol, atol) in [(1e-9, 0.0), (-1e-9, 1e-9), (f64::NAN, 1e-9), (1e-9, f64::INFINITY)] {
        let error = Dop853::new(rtol, atol).integrate(&growth(), 0.0, &[1.0], 1.0, go_on).unwrap_err();
        assert_eq!(error.cause, Cause::Setting(Setting::Tolerance));
    }
    for step in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        let error = Rk4::new(step).integrate(&growth(), 0.0, &[1.0], 1.0, go_on).unwrap_err();
        assert_eq!(error.cause, Cause::Setting(Setting::Step));
        let method = Dop853::new(1e-9, 1e-9).with_first_step(step);
        let error = method.integrate(&growth(), 0.0, &[1.0], 1.0, go_on).unwrap_err();
        assert_eq!(error.cause, Cause::Setting(Setting::Step));
    }
    let error = Rk4::new(0.1).integrate(&growth(), 0.0, &[1.0], f64::NAN, go_on).unwrap_err();
    assert_eq!(error.cause, Cause::Setting(Setting::Time));
    // Steps that do not move time, and steps without number.
    let error = Rk4::new(1e-10).integrate(&growth(), 1e12, &[1.0], 1e12 + 1.0, go_on).unwrap_err();
    assert_eq!(error.cause, Cause::StepUnderflow);
    let error = Rk4::new(1e-300).integrate(&growth(), 0.0, &[1.0], 1.0, go_on).unwrap_err();
    assert_eq!(error.cause, Cause::StepUnderflow);
}

#[test]
fn single_precision_is_integrated_to_its_own_accuracy() {
    let oscillator = from_fn(|_t: f32, &[x, v]: &[f32; 2]| [v, -x]);
    let done = Dop853::new(1e-6, 1e-6).integrate(&oscillator, 0.0, &[0.0, 1.0], 10.0, go_on).unwrap();
    assert!((done.state[0] - 10.0_f32.sin()).abs() < 1e-4);
    let done = Rk4::new(0.01_f32).integrate(&oscillator, 0.0, &[0.0, 1.0], 10.0, go_on).unwrap();
    assert_eq!(done.statistics.accepted, 1000);
    assert!((done.state[0] - 10.0_f32.sin()).abs() < 1e-4);
}

#[test]
fn duals_carry_the_derivative_by_the_initial_state() {
    // x' = -x^3: x = x0 / sqrt(1 + 2 t x0^2), dx/dx0 = (1 + 2 t x0^2)^(-3/2)
    type D = Dual<f64, 1>;
    let damped = from_fn(|_t: D, &[x]: &[D; 1]| [-x.powi(3)]);
    let (x0, t) = (0.8_f64, 2.0_f64);
    let square = 1.0 + 2.0 * t * x0 * x0;
    let method = Dop853::new(1e-12, 1e-12);
    let done = method.integrate(&damped, D::zero(), &[D::variable(x0, 0)], D::constant(t), go_on).unwrap();
    assert!((done.state[0].value - x0 / square.sqrt()).abs() < 1e-11);
    assert!((done.state[0].tangent[0] - square.powf(-1.5)).abs() < 1e-9);
    // The tangents do not change the steps.
    let plain = from_fn(|_t: f64, &[x]: &[f64; 1]| [-Real::powi(x, 3)]);
    let values = Dop853::new(1e-12, 1e-12).integrate(&plain, 0.0, &[x0], t, go_on).unwrap();
    assert_eq!((values.statistics, values.state[0]), (done.statistics, done.state[0].value));
}

/// A compensated sum follows the exact one: the same formula with 53 bits, against itself with what rounding takes given back,
/// and against twice the digits by halves of steps that are powers of two.
#[test]
fn compensated_steps_keep_what_rounding_takes() {
    // x' = 2^-60 + 2^-9: the first part is lost in every plain sum.
    let drip = from_fn(|_t: f64, _: &[f64; 2]| [(-60.0_f64).exp2(), (-9.0_f64).exp2()]);
    let steps = 1 << 16;
    let span = f64::from(steps);
    let method = Rk4::new(1.0);
    let plain = Integration::new(&drip, 0.0, &[1.0, 0.0]).run(&method, span).unwrap();
    let done = Integration::new(&drip, 0.0, &[1.0, 0.0]).run(&method.compensated(), span).unwrap();
    assert_eq!((plain.state[0], done.state[0] - 1.0), (1.0, (-44.0_f64).exp2()));
    let eighth = Integration::new(&drip, 0.0, &[1.0, 0.0]).run(&Rk8::new(1.0).compensated(), span).unwrap();
    assert!((eighth.state[0] - done.state[0]).abs() <= f64::EPSILON);
    assert_eq!(done.statistics, plain.statistics);
    // On a turning system: the radius drifts by roundings without, and stays with it. Backwards as forwards.
    for end in [100.0, -100.0] {
        let radius = |state: [f64; 2]| (state[0].hypot(state[1]) - 1.0).abs();
        let (coarse, start) = (Rk8::new(0.01), [0.0, 1.0]);
        let plain = Integration::new(&oscillator(), 0.0, &start).run(&coarse, end).unwrap();
        let done = Integration::new(&oscillator(), 0.0, &start).run(&coarse.compensated(), end).unwrap();
        assert!(radius(done.state) < 1e-15 && radius(plain.state) > 2e-15, "{:?}", plain.state);
        // Samples and events are those of the method.
        let mut between = 0.0;
        Integration::new(&oscillator(), 0.0, &start)
            .sample(&[end / 2.0], &mut |_, t, x: &[f64; 2]| between = (x[0] - t.sin()).abs())
            .run(&coarse.compensated(), end)
            .unwrap();
        assert!(between < 1e-13);
    }
}

/// Landing on given times is a way to run like any other: events, samples, an observer and a guard go on working.
#[test]
fn a_run_lands_on_given_times_with_everything_that_is_watched() {
    let (fall, stops) = (from_fn(|_t: f64, &[_, v]: &[f64; 2]| [v, -10.0]), [0.25, 0.75, 3.0]);
    let height = |_t: f64, x: &[f64; 2]| x[0];
    let (mut landed, mut sampled, mut shown) = (vec![], vec![], vec![]);
    let done = Integration::new(&fall, 0.0, &[5.0, 0.0])
        .sample(&[0.1, 0.8, 2.0], &mut |_, t, _| sampled.push(t))
        .events([Event::new(&height).terminal()], &mut |_| ControlFlow::Continue(()))
        .observe(&mut |t, _| {
            shown.push(t);
            ControlFlow::Continue(())
        })
        .run_through(&Rk4::new(0.5), &stops, |index, t, _| landed.push((index, t)))
        .unwrap();
    // The stone arrives at one second, so that the last time is not reached.
    assert_eq!((done.outcome, landed), (Outcome::Event(0), vec![(0, 0.25), (1, 0.75)]));
    assert!((done.time - 1.0).abs() < 1e-12 && sampled == [0.1, 0.8]);
    assert_eq!(shown, [0.25, 0.75, done.time]);
    let strict = Guard { step: 1e-12, ..Guard::default() };
    let run = |guard| {
        Integration::new(&oscillator(), 0.0, &[0.0, 1.0]).guard(guard).run_through(
            &Rk4::new(0.1),
            &[1.0, 0.5],
            |_, _, _| (),
        )
    };
    assert!(run(Guard::default()).is_ok() && matches!(run(strict).unwrap_err().cause, Cause::Step { .. }));
    // Samples need an order, so these times may not turn back.
    let back = Integration::new(&fall, 0.0, &[5.0, 0.0]).sample(&[0.5], &mut |_, _, _| ()).run_through(
        &Rk4::new(0.5),
        &[1.0, 0.5],
        |_, _, _| (),
    );
    assert_eq!(back.unwrap_err().cause, Cause::Setting(Setting::Samples));
}
