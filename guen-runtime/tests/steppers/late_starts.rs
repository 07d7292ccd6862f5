//! The error of a run does not depend on what the clock says when it begins: control programs count seconds since 1970.

use core::ops::ControlFlow;

use guen_runtime::lanes::{LaneTask, Lanes, Width, dispatch};
use guen_runtime::prelude::*;
use guen_runtime::steppers::{Bounded, Method};
use guen_runtime::{Cause, Generic, System, generic};

use super::motions::{Driven, Oscillator, Series};

/// Clocks at which runs begin. Elapsed times between them and the times of a run are exact in doubles.
const CLOCKS: [f64; 5] = [3.0, 86_400.25, 1e6, 1.7e9, -1.7e9];
const SPAN: f64 = 10.0;
const START: [f64; 2] = [0.0, 1.0];
/// What rounding leaves of a state of size one after thousands of steps.
const ROUNDINGS: f64 = 2e-13;

fn go_on<T>(_: T) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// How far a state is from the oscillator's motion at this time after the start.
fn off(elapsed: f64, state: &[f64; 2]) -> f64 {
    let exact = [elapsed.sin(), elapsed.cos()];
    (0..2).map(|i| (state[i] - exact[i]).abs()).fold(0.0, f64::max)
}

/// Collects what is more wrong than twice what it is from zero.
#[derive(Default)]
struct Verdict(Vec<String>);

impl Verdict {
    fn compare(&mut self, what: &str, clock: f64, here: f64, there: f64) {
        self.allow(what, clock, here, there, ROUNDINGS);
    }

    fn allow(&mut self, what: &str, clock: f64, here: f64, there: f64, further: f64) {
        if here.is_nan() || here > 2.0 * there + further {
            self.0.push(format!("{what} from {clock}: off by {here:.1e}, from 0 by {there:.1e}"));
        }
    }
}

impl Drop for Verdict {
    fn drop(&mut self) {
        assert!(
            std::thread::panicking() || self.0.is_empty(),
            "{} wrong:\n{}",
            self.0.len(),
            self.0.join("\n")
        );
    }
}

/// The largest errors of what a run from a clock shows: of its steps, its samples and its end.
fn run<M, S>(method: &M, system: &S, clock: f64, span: f64) -> Result<[f64; 3], IntegrationError<f64, 2>>
where
    M: Method<f64, S, 2>,
    S: System<f64, 2>,
{
    let times: Vec<f64> = (0..=27).map(|k| clock + span * f64::from(k) / 27.0).collect();
    let (mut steps, mut samples, mut seen) = (0.0_f64, 0.0_f64, 0);
    let done = Integration::new(system, clock, &START)
        .sample(&times, &mut |k, t, x| {
            assert_eq!((k, t), (seen, times[k]));
            seen += 1;
            samples = samples.max(off(t - clock, x));
        })
        .observe(&mut |t, x| {
            steps = steps.max(off(t - clock, x));
            ControlFlow::Continue(())
        })
        .run(method, clock + span)?;
    assert_eq!((done.time, seen), (clock + span, 28));
    Ok([steps, samples, off(span, &done.state)])
}

macro_rules! with_every_method {
    ($check:ident) => {
        $check!("Euler", Euler::new(1e-3));
        $check!("RK4", Rk4::new(0.01));
        $check!("RK4 in steps of 1 ms", Rk4::new(1e-3));
        $check!("RK8", Rk8::new(0.1));
        $check!("DOP853", Dop853::new(1e-12, 1e-12));
        $check!("DOP853 at 1e-6", Dop853::new(1e-6, 1e-6));
        $check!("Tsit5", Tsit5::new(1e-9, 1e-9));
        $check!("Gauss 4", Gauss4::new(0.02));
        $check!("Gauss 6", Gauss6::new(0.05));
        $check!("Radau 5", Radau5::new(1e-10, 1e-10));
        $check!("Taylor", Taylor::new(1e-15, 1e-15));
    };
}

#[test]
fn steps_samples_and_the_end_are_as_right_as_from_zero() {
    let mut verdict = Verdict::default();
    let system = Series::new();
    macro_rules! check {
        ($name:literal, $method:expr) => {
            for span in [SPAN, -SPAN] {
                let there = run(&$method, &system, 0.0, span).unwrap();
                for clock in CLOCKS {
                    let here = run(&$method, &system, clock, span).unwrap();
                    for (k, what) in ["steps", "samples", "end"].into_iter().enumerate() {
                        verdict.compare(
                            &format!("{}, {what} over {span} s", $name),
                            clock,
                            here[k],
                            there[k],
                        );
                    }
                }
            }
        };
    }
    with_every_method!(check);
    check!("RK8 compensated", Rk8::new(0.05).compensated());
}

#[test]
fn landing_on_times_is_as_right_as_from_zero() {
    let mut verdict = Verdict::default();
    macro_rules! check {
        ($name:literal, $method:expr) => {
            let run = |clock: f64| {
                let times: Vec<f64> = (0..40).map(|k| clock + 0.3 * f64::from(k % 27)).collect();
                let mut most = 0.0_f64;
                $method
                    .sample(&Series::new(), clock, &START, &times, |_, t, x| {
                        most = most.max(off(t - clock, x))
                    })
                    .unwrap();
                most
            };
            let there = run(0.0);
            for clock in CLOCKS {
                verdict.compare(concat!($name, " landing"), clock, run(clock), there);
            }
        };
    }
    with_every_method!(check);
}

/// Control periods of a hundredth of a second, one after the other, inputs held in each.
#[test]
fn control_periods_are_as_right_as_from_zero() {
    let mut verdict = Verdict::default();
    /// Goes over the periods by what makes one of them; the force in each is held.
    fn periods(clock: f64, advance: impl Fn(f64, f64, [f64; 2], f64) -> [f64; 2]) -> f64 {
        let (mut time, mut state, mut ideal, mut most) = (clock, START, START, 0.0_f64);
        for k in 1..=1000 {
            let next = clock + 0.01 * f64::from(k);
            let force = if k % 3 == 0 { 0.7 } else { -0.2 };
            state = advance(time, next, state, force);
            // The oscillator under a constant force turns about another point.
            let (sin, cos) = (next - time).sin_cos();
            let [x, v] = [ideal[0] - force, ideal[1]];
            ideal = [force + x * cos + v * sin, v * cos - x * sin];
            time = next;
            most = most.max((state[0] - ideal[0]).abs()).max((state[1] - ideal[1]).abs());
        }
        most
    }
    macro_rules! check {
        ($name:literal, $advance:expr) => {
            let there = periods(0.0, $advance);
            for clock in CLOCKS {
                verdict.compare(concat!($name, ", periods"), clock, periods(clock, $advance), there);
            }
        };
    }
    let forced = |force: f64| from_fn(move |_t: f64, &[x, v]: &[f64; 2]| [v, force - x]);
    macro_rules! integrate {
        ($method:expr) => {
            |t0: f64, t1: f64, x: [f64; 2], force: f64| {
                let run = Integration::new(&forced(force), t0, &x).run(&$method, t1);
                run.unwrap().state
            }
        };
    }
    check!("RK4", integrate!(Rk4::new(0.003)));
    check!("RK8", integrate!(Rk8::new(0.01)));
    check!("DOP853", integrate!(Dop853::new(1e-9, 1e-9)));
    check!("Tsit5", integrate!(Tsit5::new(1e-9, 1e-9)));
    check!("Bounded, order 8", |t0: f64, t1: f64, x: [f64; 2], force: f64| {
        Bounded::dop853(24).advance(&forced(force), t0, &x, t1).unwrap().state
    });
    check!("Bounded, order 5", |t0: f64, t1: f64, x: [f64; 2], force: f64| {
        Bounded::tsit5(25).advance(&forced(force), t0, &x, t1).unwrap().state
    });
}

/// All lanes from a clock: the largest error at samples, and in the end.
struct InLanesFrom<M>(M, f64);

impl<M: LaneMethod> LaneTask for InLanesFrom<M> {
    type Output = [f64; 2];

    fn run<L: Lanes>(self) -> [f64; 2] {
        let Self(method, clock) = self;
        let times: Vec<f64> = (0..=27).map(|k| clock + SPAN * f64::from(k) / 27.0).collect();
        let start = START.map(L::from_f64);
        let mut most = 0.0_f64;
        let ends =
            method.sample_in_lanes(&generic(Oscillator), clock, &start, &times, |_, t, x: &[L; 2], _| {
                for lane in 0..L::COUNT {
                    most = most.max(off(t - clock, &x.map(|x| x.lane(lane))));
                }
            });
        let last = ends.into_iter().map(|end| off(SPAN, &end.unwrap().state)).fold(0.0, f64::max);
        [most, last]
    }
}

#[test]
fn lanes_are_as_right_as_from_zero() {
    let mut verdict = Verdict::default();
    macro_rules! check {
        ($name:literal, $method:expr) => {
            let there = dispatch(Width::Four, InLanesFrom($method, 0.0));
            for clock in CLOCKS {
                let here = dispatch(Width::Four, InLanesFrom($method, clock));
                verdict.compare(concat!($name, " in lanes, samples"), clock, here[0], there[0]);
                verdict.compare(concat!($name, " in lanes, end"), clock, here[1], there[1]);
            }
        };
    }
    check!("RK4", Rk4::new(0.01));
    check!("RK8", Rk8::new(0.1));
}

/// Where rates know the time they are off by what its rounding makes of them.
#[test]
fn rates_that_know_the_time_cost_its_rounding() {
    let mut verdict = Verdict::default();
    let driven = |since| generic(Driven { since });
    let reference = Integration::new(&driven(0.0), 0.0, &START).run(&Rk8::new(1e-3), SPAN);
    let reference = reference.unwrap().state;
    macro_rules! check {
        ($name:literal, $method:expr) => {
            let error = |clock: f64| {
                let system: Generic<Driven> = driven(clock);
                let run = Integration::new(&system, clock, &START).run(&$method, clock + SPAN).unwrap();
                (0..2).map(|i| (run.state[i] - reference[i]).abs()).fold(0.0, f64::max)
            };
            let there = error(0.0);
            for clock in CLOCKS {
                // Half a spacing of times, the rates' rate of change, ten seconds, and what a pendulum makes of it.
                let rounding = clock.abs() * f64::EPSILON / 2.0 * SPAN;
                verdict.allow(concat!($name, ", driven"), clock, error(clock), there, ROUNDINGS + rounding);
            }
        };
    }
    check!("Euler", Euler::new(1e-3));
    check!("RK4", Rk4::new(0.01));
    check!("RK8", Rk8::new(0.1));
    // Tolerances that are not below that: a step of a second errs by as much as rounding moves its rates.
    check!("DOP853", Dop853::new(1e-7, 1e-7));
    check!("Tsit5", Tsit5::new(1e-7, 1e-7));
    check!("Gauss 4", Gauss4::new(0.02));
    check!("Gauss 6", Gauss6::new(0.05));
    check!("Radau 5", Radau5::new(1e-7, 1e-7));
}

/// Where the spacing of times is an eighth of a second, runs are right or say that their steps do not move time.
#[test]
fn at_a_clock_of_1e15_runs_are_right_or_refused() {
    let mut verdict = Verdict::default();
    let system = Series::new();
    macro_rules! check {
        ($name:literal, $method:expr) => {
            for span in [SPAN, -SPAN] {
                let there = run(&$method, &system, 0.0, span).unwrap()[2];
                for clock in [1e15, -1e15] {
                    let done = Integration::new(&system, clock, &START).run(&$method, clock + span);
                    match done {
                        Ok(done) => verdict.compare($name, clock, off(span, &done.state), there),
                        Err(error) => assert_eq!(error.cause, Cause::StepUnderflow, "{}", $name),
                    }
                }
            }
        };
    }
    with_every_method!(check);
}

/// A run over a few spacings of times is one step.
#[test]
fn a_span_of_a_few_spacings_is_no_underflow() {
    let system = Series::new();
    for clock in [1.0_f64, -1e6, 1.7e9, 1e12] {
        let spacing = (f64::from_bits(clock.to_bits() + 1) - clock).abs();
        for spacings in 1..=12 {
            for end in [clock + f64::from(spacings) * spacing, clock - f64::from(spacings) * spacing] {
                let right = |name: &str, here: [f64; 2], there: [f64; 2]| {
                    let (here, there) = (off(end - clock, &here), off(end - clock, &there));
                    let span = end - clock;
                    assert!(
                        here <= 2.0 * there + 1e-15,
                        "{name} over {span} from {clock}: {here:e} {there:e}"
                    );
                };
                macro_rules! check {
                    ($name:literal, $method:expr) => {
                        let run = |from: f64, to: f64| {
                            $method.integrate(&system, from, &START, to, |t, _| go_on(t)).unwrap().state
                        };
                        right($name, run(clock, end), run(0.0, end - clock));
                    };
                }
                with_every_method!(check);
                check!("RK4, compensated", Rk4::new(0.01).compensated());
                for (name, work) in
                    [("bounded DOP853", Bounded::dop853(12)), ("bounded Tsit5", Bounded::tsit5(7))]
                {
                    let run = |from: f64, to: f64| work.advance(&system, from, &START, to).unwrap().state;
                    right(name, run(clock, end), run(0.0, end - clock));
                }
                let run = |from: f64, to: f64| dispatch(Width::Four, Ends(from, to));
                let (here, there) = (run(clock, end), run(0.0, end - clock));
                right("RK4 in lanes", here[0], there[0]);
                right("RK8 in lanes", here[1], there[1]);
            }
        }
    }
}

/// The ends of the first of all lanes, by both methods, over a span.
struct Ends(f64, f64);

impl LaneTask for Ends {
    type Output = [[f64; 2]; 2];

    fn run<L: Lanes>(self) -> Self::Output {
        let Self(from, to) = self;
        let start = START.map(L::from_f64);
        let four = Rk4::new(0.01).integrate_in_lanes(&generic(Oscillator), from, &start, to);
        let eight = Rk8::new(0.1).integrate_in_lanes(&generic(Oscillator), from, &start, to);
        [four, eight].map(|ends| ends.lane(0).unwrap().as_ref().unwrap().state)
    }
}
