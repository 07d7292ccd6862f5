//! The driver: samples, events and observers in their order, backwards and over nothing, with every method.

use core::ops::ControlFlow;

use guen_runtime::prelude::*;
use guen_runtime::steppers::{Method, Occurrence};
use guen_runtime::{Equations, Generic, Setting, generic};

/// `x'' = -x`
struct Oscillator;

impl Equations<2> for Oscillator {
    fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, -x]
    }
}

type Turning = Generic<Oscillator>;

const START: [f64; 2] = [0.0, 1.0];

fn go_on<T>(_: T) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Runs a check with every method, each set so that its states are right to about 1e-6, dense output included.
macro_rules! with_every_method {
    ($check:ident) => {
        $check("Euler", &Euler::new(2e-5), 1e-4);
        $check("RK4", &Rk4::new(0.02), 1e-6);
        $check("RK8", &Rk8::new(0.1), 1e-6);
        $check("DOP853", &Dop853::new(1e-9, 1e-9), 1e-6);
        $check("Tsit5", &Tsit5::new(1e-9, 1e-9), 1e-6);
        $check("Gauss 4", &Gauss4::new(0.02), 1e-6);
        $check("Gauss 6", &Gauss6::new(0.05), 1e-6);
        $check("Radau 5", &Radau5::new(1e-9, 1e-9), 1e-6);
    };
}

#[test]
fn samples_lie_on_the_motion_and_do_not_change_the_steps() {
    fn check<M: Method<f64, Turning, 2>>(name: &str, method: &M, tolerance: f64) {
        let times: Vec<f64> = (0..=50).map(|k| 0.06 * f64::from(k)).collect();
        for sign in [1.0, -1.0] {
            let times: Vec<f64> = times.iter().map(|t| sign * t).collect();
            let mut seen = Vec::new();
            let sampled = Integration::new(&generic(Oscillator), 0.0, &START)
                .sample(&times, &mut |k, t, x| {
                    assert_eq!(times[k], t);
                    assert!((x[0] - t.sin()).abs() < tolerance, "{name} at {t}: {x:?}");
                    assert!((x[1] - t.cos()).abs() < tolerance, "{name} at {t}: {x:?}");
                    seen.push(k);
                })
                .run(method, sign * 3.0)
                .unwrap();
            assert_eq!(seen, (0..=50).collect::<Vec<_>>());
            let plain = Integration::new(&generic(Oscillator), 0.0, &START).run(method, sign * 3.0).unwrap();
            assert_eq!(plain.state, sampled.state, "{name}: samples change the motion");
        }
    }
    with_every_method!(check);
}

#[test]
fn events_are_found_in_the_order_of_time_by_every_method() {
    fn check<M: Method<f64, Turning, 2>>(name: &str, method: &M, tolerance: f64) {
        use std::f64::consts::PI;
        // x rises through zero at 2 pi, falls at pi; v crosses at pi/2 and 3 pi/2; x = 1/2 at pi/6 and 5 pi/6.
        let position = |_: f64, x: &[f64; 2]| x[0];
        let speed = |_: f64, x: &[f64; 2]| x[1];
        let half = |_: f64, x: &[f64; 2]| x[0] - 0.5;
        let events = [
            Event::new(&position).direction(Direction::Falling),
            Event::new(&speed),
            Event::new(&half).direction(Direction::Rising),
            Event::new(&position).direction(Direction::Rising).terminal(),
        ];
        let mut found: Vec<Occurrence<f64, 2>> = Vec::new();
        let mut last = (0.0, START);
        let done = Integration::new(&generic(Oscillator), 0.0, &START)
            .events(events, &mut |event| {
                found.push(*event);
                go_on(event)
            })
            .observe(&mut |t, x| {
                assert!(t > last.0, "{name}: time stands still at {t}");
                last = (t, *x);
                ControlFlow::Continue(())
            })
            .run(method, 100.0)
            .unwrap();
        let expected = [
            (2, PI / 6.0, true),
            (1, PI / 2.0, false),
            (0, PI, false),
            (1, 1.5 * PI, true),
            (3, 2.0 * PI, true),
        ];
        assert_eq!(found.len(), expected.len(), "{name}: {found:?}");
        for (event, (index, time, rising)) in found.iter().zip(expected) {
            assert_eq!((event.index, event.rising), (index, rising), "{name}");
            assert!((event.time - time).abs() < tolerance, "{name}: {} instead of {time}", event.time);
        }
        assert_eq!(done.outcome, Outcome::Event(3));
        assert_eq!((done.time, done.state), last, "{name}: the observer sees the end");
        assert!((done.time - 2.0 * PI).abs() < tolerance && done.state[0] >= 0.0);
    }
    with_every_method!(check);
}

/// A stone falls from 1 m; `t = sqrt(2 / g)` is known.
fn falling() -> impl System<f64, 2> {
    from_fn(|_t: f64, &[_, v]: &[f64; 2]| [v, -9.81])
}

#[test]
fn an_event_is_found_to_its_tolerance_and_past_the_crossing() {
    let height = |_: f64, x: &[f64; 2]| x[0];
    let exact = (2.0_f64 / 9.81).sqrt();
    for tolerance in [1e-3, 1e-6, 1e-9, 0.0] {
        let done = Integration::new(&falling(), 0.0, &[1.0, 0.0])
            .events([Event::new(&height).terminal().within(tolerance)], &mut |event| go_on(event))
            .run(&Rk4::new(0.1), 1.0)
            .unwrap();
        let late = done.time - exact;
        assert!(late >= -2e-16 && late <= tolerance.max(1e-15), "{tolerance:e}: {late:e}");
        assert!(done.state[0] <= 0.0);
    }
}

#[test]
fn a_run_that_continues_from_an_event_does_not_find_it_again() {
    // Ten bounces without loss: at odd multiples of sqrt(2/g).
    let height = |_: f64, x: &[f64; 2]| x[0];
    let exact = (2.0_f64 / 9.81).sqrt();
    let (mut time, mut state) = (0.0, [1.0, 0.0]);
    for bounce in 0..10 {
        let done = Integration::new(&falling(), time, &state)
            .events([Event::new(&height).terminal()], &mut |event| go_on(event))
            .run(&Dop853::new(1e-12, 1e-12), 100.0)
            .unwrap();
        let expected = exact * f64::from(2 * bounce + 1);
        assert!((done.time - expected).abs() < 1e-10, "bounce {bounce}: {} {expected}", done.time);
        (time, state) = (done.time, [done.state[0], -done.state[1]]);
    }
}

#[test]
fn samples_after_a_terminal_event_are_not_taken() {
    let height = |_: f64, x: &[f64; 2]| x[0];
    let times = [0.0, 0.2, 0.4, 0.5, 0.9];
    let mut seen = Vec::new();
    Integration::new(&falling(), 0.0, &[1.0, 0.0])
        .sample(&times, &mut |_, t, _| seen.push(t))
        .events([Event::new(&height).terminal()], &mut |event| go_on(event))
        .run(&Rk4::new(1.0), 1.0)
        .unwrap();
    assert_eq!(seen, [0.0, 0.2, 0.4]);
}

#[test]
fn the_receiver_of_events_can_stop_the_run() {
    let position = |_: f64, x: &[f64; 2]| x[0];
    let mut count = 0;
    let done = Integration::new(&generic(Oscillator), 0.0, &START)
        .events([Event::new(&position)], &mut |_| {
            count += 1;
            if count == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .run(&Dop853::new(1e-10, 1e-10), 100.0)
        .unwrap();
    assert_eq!(done.outcome, Outcome::Stopped);
    assert!((done.time - 3.0 * std::f64::consts::PI).abs() < 1e-8);
}

#[test]
fn an_observer_that_breaks_once_ends_the_run_and_is_not_asked_again() {
    fn check<M: Method<f64, Turning, 2>>(name: &str, method: &M, _: f64) {
        let mut seen = Vec::new();
        let done = Integration::new(&generic(Oscillator), 0.0, &START)
            .observe(&mut |t, x| {
                seen.push((t, *x));
                if seen.len() == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            })
            .run(method, 100.0)
            .unwrap();
        assert_eq!(done.outcome, Outcome::Stopped, "{name}");
        assert_eq!((seen.len(), seen[2]), (3, (done.time, done.state)), "{name}");
    }
    with_every_method!(check);
}

#[test]
fn crossings_within_a_step_are_seen_where_checks_are_asked_for() {
    // The clock's step is 10; its hand crosses zero eleven times in it: sin(pi (t + 1/2)) changes at every t = k + 1/2.
    let clock = from_fn(|_t: f64, _: &[f64; 1]| [1.0]);
    let hand = |_: f64, x: &[f64; 1]| (std::f64::consts::PI * (x[0] + 0.5)).sin();
    let count = |checks: u32| {
        let mut times = Vec::new();
        Integration::new(&clock, 0.0, &[0.0])
            .events([Event::new(&hand).with_checks(checks)], &mut |event| {
                times.push(event.time);
                go_on(event)
            })
            .run(&Rk4::new(10.0), 10.0)
            .unwrap();
        times
    };
    // An even number of crossings between two looks is none.
    assert_eq!(count(1).len(), 0);
    let all = count(37);
    assert_eq!(all.len(), 10);
    for (k, time) in all.iter().enumerate() {
        assert!((time - (k as f64 + 0.5)).abs() < 1e-13, "{time}");
    }
}

#[test]
fn touching_zero_is_no_event_unless_a_step_ends_there() {
    let clock = from_fn(|_t: f64, _: &[f64; 1]| [1.0]);
    let touch = |_: f64, x: &[f64; 1]| (x[0] - 1.0) * (x[0] - 1.0);
    let count = |step: f64| {
        let mut count = 0;
        Integration::new(&clock, 0.0, &[0.0])
            .events([Event::new(&touch)], &mut |event| {
                count += 1;
                go_on(event)
            })
            .run(&Rk4::new(step), 2.0)
            .unwrap();
        count
    };
    assert_eq!((count(0.3), count(0.5)), (0, 1));
}

#[test]
fn events_are_found_backwards() {
    let position = |_: f64, x: &[f64; 2]| x[0];
    let mut found = Vec::new();
    Integration::new(&generic(Oscillator), 0.0, &START)
        .events([Event::new(&position).direction(Direction::Rising)], &mut |event| {
            found.push(event.time);
            go_on(event)
        })
        .run(&Dop853::new(1e-11, 1e-11), -10.0)
        .unwrap();
    // Going backwards the sine rises where it falls forwards: at -pi, -3 pi.
    assert_eq!(found.len(), 2);
    let expected = [-std::f64::consts::PI, -3.0 * std::f64::consts::PI];
    assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
}

#[test]
fn a_span_of_zero_has_its_sample_and_no_event() {
    let position = |_: f64, x: &[f64; 2]| x[0];
    let mut seen = 0;
    let done = Integration::new(&generic(Oscillator), 1.0, &[0.0, 1.0])
        .sample(&[1.0, 1.0], &mut |_, _, _| seen += 1)
        .events([Event::new(&position)], &mut |_| unreachable!("no event"))
        .observe(&mut |_, _| unreachable!("no step"))
        .run(&Dop853::new(1e-9, 1e-9), 1.0)
        .unwrap();
    assert_eq!((seen, done.time, done.statistics), (2, 1.0, Statistics::default()));
}

#[test]
fn senseless_settings_are_refused_before_anything_is_done() {
    let system = from_fn(|_t: f64, _: &[f64; 1]| -> [f64; 1] { unreachable!("nothing is evaluated") });
    let method = Dop853::new(1e-9, 1e-9);
    let value = |_: f64, x: &[f64; 1]| x[0];
    let cause =
        |result: Result<IntegrationResult<f64, 1>, IntegrationError<f64, 1>>| result.unwrap_err().cause;
    for times in [[0.5, 0.4], [-0.1, 0.5], [0.5, 1.5], [0.5, f64::NAN]] {
        let run = Integration::new(&system, 0.0, &[1.0]).sample(&times, &mut |_, _, _| ()).run(&method, 1.0);
        assert_eq!(cause(run), Cause::Setting(Setting::Samples), "{times:?}");
    }
    let mut receive = |_: &Occurrence<f64, 1>| ControlFlow::Continue(());
    let run = Integration::new(&system, 0.0, &[1.0])
        .events([Event::new(&value).within(f64::NAN)], &mut receive)
        .run(&method, 1.0);
    assert_eq!(cause(run), Cause::Setting(Setting::Event));
    let run = Integration::new(&system, 0.0, &[1.0])
        .guard(Guard { energy: -1.0, ..Guard::default() })
        .run(&method, 1.0);
    assert_eq!(cause(run), Cause::Setting(Setting::Guard));
    assert_eq!(
        cause(Integration::new(&system, 0.0, &[1.0]).run(&method, f64::INFINITY)),
        Cause::Setting(Setting::Time)
    );
}

#[test]
fn evaluations_for_dense_output_are_counted() {
    fn check<M: Method<f64, Counting, 2>>(name: &str, method: &M, _: f64) {
        let system = Counting::default();
        let done = Integration::new(&system, 0.0, &START)
            .sample(&[0.31, 0.32, 0.77], &mut |_, _, _| ())
            // What a guard evaluates to judge a step is its own.
            .guard(Guard { step: f64::INFINITY, ..Guard::default() })
            .run(method, 1.0)
            .unwrap();
        assert_eq!(done.statistics.evaluations, system.0.get(), "{name}");
    }
    check("RK4", &Rk4::new(0.02), 0.0);
    check("RK8", &Rk8::new(0.1), 0.0);
    check("DOP853", &Dop853::new(1e-9, 1e-9), 0.0);
    check("Tsit5", &Tsit5::new(1e-9, 1e-9), 0.0);
    check("Gauss 4", &Gauss4::new(0.02), 0.0);
    check("Gauss 6", &Gauss6::new(0.05), 0.0);
    check("Radau 5", &Radau5::new(1e-9, 1e-9), 0.0);
}

#[test]
fn a_time_that_is_none_and_a_tolerance_that_cannot_be_met_are_called_that() {
    fn check<M: Method<f64, Turning, 2>>(name: &str, method: &M, _: f64) {
        for (t0, t1) in [(f64::NAN, 1.0), (f64::INFINITY, 1.0), (0.0, f64::NAN), (f64::NAN, f64::NAN)] {
            for times in [&[][..], &[0.5]] {
                let run = Integration::new(&generic(Oscillator), t0, &START)
                    .sample(times, &mut |_, _, _| ())
                    .run(method, t1);
                assert_eq!(run.unwrap_err().cause, Cause::Setting(Setting::Time), "{name}: {t0} {t1}");
            }
        }
    }
    with_every_method!(check);
    for t0 in [f64::NAN, f64::INFINITY] {
        let run = Rk4::new(0.1).sample(&generic(Oscillator), t0, &START, &[1.0], |_, _, _| ());
        assert_eq!(run.unwrap_err().cause, Cause::Setting(Setting::Time));
    }
    // In units of this tolerance an error is beyond the range of doubles, though everything is finite.
    let system = generic(Oscillator);
    for tolerance in [1e-300, 1e-200, 1e-160] {
        for t0 in [0.0, 1.0] {
            let run = |name: &str, method: &dyn Fn(Integration<'_, f64, Turning, 2>) -> Cause| {
                let cause = method(Integration::new(&system, t0, &START));
                let expected =
                    matches!(cause, Cause::StepUnderflow | Cause::TooManySteps { .. } | Cause::NoConvergence);
                assert!(expected, "{name}, {tolerance:e}, from {t0}: {cause:?}");
            };
            run("DOP853", &|run| run.run(&Dop853::new(tolerance, tolerance), 3.0).unwrap_err().cause);
            run("Tsit5", &|run| run.run(&Tsit5::new(tolerance, tolerance), 3.0).unwrap_err().cause);
            run("Radau 5", &|run| run.run(&Radau5::new(tolerance, tolerance), 3.0).unwrap_err().cause);
        }
    }
}

/// The oscillator, counting evaluations and derivatives along a direction.
#[derive(Default)]
struct Counting(core::cell::Cell<u64>);

impl System<f64, 2> for Counting {
    fn rhs(&self, _: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
        self.0.set(self.0.get() + 1);
        [v, -x]
    }
}

impl guen_runtime::Differentiable<f64, 2> for Counting {
    fn jacobian(&self, _: f64, _: &[f64; 2]) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [-1.0, 0.0]]
    }

    fn along(&self, _: f64, _: &[f64; 2], _: f64, &[dx, dv]: &[f64; 2]) -> [f64; 2] {
        self.0.set(self.0.get() + 1);
        [dv, -dx]
    }
}

/// A function that ceases to be a number: its crossings before are told, and the run ends with what has been computed.
#[test]
fn an_event_whose_function_is_no_number_ends_the_run_with_its_motion() {
    let motion = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
    let method = Dop853::new(1e-9, 1e-9);
    let never = |_t: f64, _: &[f64; 2]| f64::NAN;
    let ends = |t: f64, _: &[f64; 2]| (0.5 - t).sqrt() - 0.1;
    let place = |_t: f64, x: &[f64; 2]| x[0] - 0.6;
    let run = |events: [Event<'_, f64, 2>; 2], end: f64| {
        let mut told = Vec::new();
        let done = Integration::new(&motion, 0.0, &START)
            .events(events, &mut |event| {
                told.push((event.index, event.time));
                go_on(())
            })
            .run(&method, end);
        (done, told)
    };
    // From the start.
    let (done, _) = run([Event::new(&place), Event::new(&never)], 5.0);
    let error = done.unwrap_err();
    assert_eq!((error.cause, error.time, error.state), (Cause::EventFunction { event: 1 }, 0.0, START));
    assert_eq!(
        error.to_string(),
        "integration stopped at t = 0: the function of event 1 is not a number here"
    );
    // From a time on: it crosses zero before, and the other one as well.
    for end in [5.0_f64, -5.0] {
        let mirrored = |t: f64, x: &[f64; 2]| ends(t * end.signum(), x);
        let (done, told) = run([Event::new(&mirrored), Event::new(&place)], end);
        let error = done.unwrap_err();
        assert_eq!(error.cause, Cause::EventFunction { event: 0 });
        assert!(error.time.abs() > 0.5 && (error.state[0] - error.time.sin()).abs() < 1e-7, "{error:?}");
        assert!(told[0].0 == 0 && (told[0].1.abs() - 0.49).abs() < 1e-9, "{told:?}");
    }
    // A run that ends before is none of its business, nor is one that it ends itself.
    let (done, told) = run([Event::new(&ends).terminal(), Event::new(&place)], 5.0);
    assert!(
        done.unwrap().outcome == Outcome::Event(0)
            && told == [(0, told[0].1)]
            && (told[0].1 - 0.49).abs() < 1e-12
    );
    let root = |t: f64, x: &[f64; 2]| x[0] - 0.45 * (1.0 + (0.5 - t).sqrt());
    let low = |_t: f64, x: &[f64; 2]| x[0] - 0.3;
    let (done, told) = run([Event::new(&root), Event::new(&low).terminal()], 5.0);
    assert!(done.unwrap().outcome == Outcome::Event(1) && told.len() == 1, "{told:?}");
}
