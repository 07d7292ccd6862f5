//! Inputs in simulations: laws over every real, and controllers that look at equal intervals.

use guen::control::poles;
use guen::prelude::*;
use guen::steppers::Guard;
use guen::{Differentiable, Linearizable, Setting};

use crate::simulation::{Lift, lift};

const START: lift::State = lift::State { z: 1.0, w: 0.5 };

fn prepared() -> lift::Prepared {
    Lift::new(2.0).prepare().unwrap()
}

/// Carries the weight, and pulls towards the ground like a pendulum.
#[derive(Clone, Copy)]
struct Pull;

impl InputLaw<lift::Prepared> for Pull {
    fn at<R: Real>(&self, t: R, state: &lift::State<R>) -> lift::Inputs<R> {
        let weight = R::from_f64(2.0 * 9.81);
        lift::Inputs { force: weight - R::from_f64(3.0) * state.z.sin() - state.w + t.cos() }
    }
}

#[test]
fn a_law_serves_as_its_closure_does() {
    let lift = prepared();
    let law = |t: f64, state: &lift::State| Pull.at(t, state);
    let closure = lift.simulation(&START).inputs(law).run(0.0..3.0).unwrap();
    let smooth = lift.simulation(&START).law(Pull).run(0.0..3.0).unwrap();
    let wrapped = lift.with_law(Pull).simulate(&START, 0.0..3.0).unwrap();
    assert!(closure.iter().eq(smooth.iter()) && smooth.iter().eq(wrapped.iter()));
}

#[test]
fn methods_that_need_derivatives_see_through_a_law() {
    let pulled = prepared().with_law(Pull);
    let exact = pulled.simulation(&START).tolerance(1e-12).run(0.0..3.0).unwrap();
    let radau = pulled.simulation(&START).method(Radau5::new(1e-10, 1e-10)).run(0.0..3.0).unwrap();
    let gauss = pulled.simulation(&START).method(Gauss6::new(0.02)).run(0.0..3.0).unwrap();
    let taylor = pulled.simulation(&START).method(Taylor::new(1e-14, 1e-14)).run(0.0..3.0).unwrap();
    for t in [0.7, 1.9, 3.0] {
        assert!((exact.at(t).z - radau.at(t).z).abs() < 1e-7, "{t}");
        assert!((exact.at(t).z - gauss.at(t).z).abs() < 1e-7, "{t}");
        assert!((exact.at(t).z - taylor.at(t).z).abs() < 1e-11, "{t}");
    }
    // z'' = (cos t - w - 3 sin z)/2
    let (t, state) = (0.4, [0.8, -0.3]);
    assert_eq!(pulled.jacobian(t, &state), [[0.0, 1.0], [-1.5 * 0.8_f64.cos(), -0.5]]);
    let [slope, bend] = pulled.along(t, &state, 1.0, &pulled.rhs(t, &state));
    let [_, fall] = pulled.rhs(t, &state);
    assert_eq!(slope, fall);
    assert!((bend - (-t.sin() - fall - 3.0 * 0.8_f64.cos() * -0.3) / 2.0).abs() < 1e-15);
    let closed = pulled.linearization(0.0, &[0.0, 0.0], &[]);
    let found = poles(&closed.a).unwrap();
    // s^2 + s/2 + 3/2
    assert!(found.iter().all(|pole| (pole.re + 0.25).abs() < 1e-14), "{found:?}");
}

/// A controller with a memory.
fn servo() -> impl FnMut(f64, &lift::State) -> lift::Inputs {
    let mut sum = 0.0;
    move |t, state| {
        sum += 0.5 * (2.0 + t - state.z);
        lift::Inputs { force: 2.0 * 9.81 + 6.0 * (2.0 + t - state.z) - 5.0 * state.w + sum }
    }
}

#[test]
fn holding_inputs_gives_the_bits_of_a_separate_run_for_every_period() {
    let lift = prepared();
    // The end is no multiple of the period.
    let (period, end) = (0.1, 0.95);
    macro_rules! check {
        ($($method:expr;)*) => {$(
            let motion =
                lift.simulation(&START).hold(period, servo()).method($method).run(0.0..end).unwrap();
            let (mut controller, mut state, mut steps) = (servo(), START, 0);
            for k in 0..10 {
                let (from, to) = (f64::from(k) * period, f64::min(f64::from(k + 1) * period, end));
                let inputs = controller(from, &state);
                let part = lift.driven(inputs).simulation(&state).method($method).run(from..to).unwrap();
                let name = stringify!($method);
                assert_eq!(motion.system().inputs(from, &state), inputs, "{name} at {from}");
                let middle = (from + to) / 2.0;
                assert_eq!(motion.at(middle), part.at(middle), "{name} at {middle}");
                state = part.end();
                steps += part.statistics().work.accepted;
                assert_eq!(motion.at(to), state, "{name} at {to}");
                assert!(motion.times().any(|t| t == to), "{name}: no step ends at {to}");
            }
            assert_eq!((motion.end(), motion.system().law().as_slice().len()), (state, 10));
            assert_eq!(motion.statistics().work.accepted, steps, "{}", stringify!($method));
        )*};
    }
    check! {
        Dop853::new(1e-9, 1e-9); Tsit5::new(1e-7, 1e-7); Rk4::new(0.03); Rk8::new(0.03); Euler::new(0.01);
        Gauss4::new(0.05); Gauss6::new(0.05); Radau5::new(1e-8, 1e-8); Taylor::new(1e-12, 1e-12);
    }
}

#[test]
fn events_guards_and_observers_go_through_samples() {
    let lift = prepared();
    let motion = lift
        .simulation(&START)
        .hold(0.25, servo())
        .events([
            Trigger::new(|_, state: &lift::State| state.z - 1.3),
            // At a sample, exactly: told once.
            Trigger::new(|t, _: &lift::State| t - 0.5),
            Trigger::new(|_, state: &lift::State| state.z - 1.8).terminal(),
        ])
        .run(0.0..20.0)
        .unwrap();
    assert_eq!(motion.events().iter().map(|event| event.index).collect::<Vec<_>>(), [0, 1, 2]);
    assert_eq!(motion.outcome(), Some(Outcome::Event(2)));
    assert!((motion.end().z - 1.8).abs() < 1e-12);
    // Nobody is asked for inputs after the end.
    let samples = motion.system().law().as_slice();
    assert!(samples.iter().all(|(t, _)| *t < motion.end_time()), "{samples:?}");
    let error = lift.simulation(&START).hold(0.25, servo()).memory(4000).run(0.0..20.0).unwrap_err();
    assert!(matches!(error.cause, Cause::Memory { limit: 4000 }), "{error}");
    let guard = Guard { condition: 0.5, ..Guard::default() };
    let error = lift.simulation(&START).hold(0.25, servo()).guard(guard).run(0.0..20.0).unwrap_err();
    assert!(matches!(error.cause, Cause::Condition { .. }), "{error}");
    let diverging = |_: f64, _: &lift::State| lift::Inputs { force: f64::NAN };
    let error = lift.simulation(&START).hold(0.25, diverging).run(0.0..20.0).unwrap_err();
    assert_eq!((error.cause, error.time), (Cause::NotFinite, 0.0));
}

#[test]
fn periods_that_make_no_sense_are_refused() {
    let lift = prepared();
    for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = lift.simulation(&START).hold(period, servo()).run(0.0..1.0).unwrap_err();
        assert_eq!(error.cause, Cause::Setting(Setting::Period), "{period}");
    }
    let error = lift.simulation(&START).hold(0.1, servo()).run(1.0..0.0).unwrap_err();
    assert_eq!(error.cause, Cause::Setting(Setting::Backwards));
    assert!(error.to_string().contains("backwards"), "{error}");
    let error = lift.simulation(&START).hold(1e-20, servo()).run(1.0..2.0).unwrap_err();
    assert_eq!(error.cause, Cause::StepUnderflow);
    // 3 * 0.3 is below 0.9.
    let motion = lift.simulation(&START).hold(0.3, servo()).run(0.0..0.9).unwrap();
    assert_eq!((motion.system().law().as_slice().len(), motion.end_time()), (3, 0.9));
    // 7 * 0.1 is not 0.7: no sample a rounding before the end, or after it.
    for k in 1..40 {
        let motion = lift.simulation(&START).hold(0.1, servo()).run(0.0..0.1 * f64::from(k)).unwrap();
        assert_eq!(motion.system().law().as_slice().len(), k as usize);
        let short = f64::from(k) / 10.0;
        let motion = lift.simulation(&START).hold(0.1, servo()).run(0.0..short).unwrap();
        assert_eq!((motion.system().law().as_slice().len(), motion.end_time()), (k as usize, short));
    }
}

#[test]
fn outputs_have_names() {
    let lift = prepared();
    let motion = lift.simulation(&START).hold(0.25, servo()).run(0.0..1.0).unwrap();
    let (at, inputs) = (motion.at(0.6), motion.system().inputs(0.6, &START));
    let outputs = motion.outputs_at(0.6);
    assert_eq!(outputs, lift.outputs(0.6, &at, &inputs));
    assert_eq!((outputs.power, outputs.place), (inputs.force * at.w, [0.0, 1.0, at.z]));
    let all: Vec<_> = motion.outputs().collect();
    assert_eq!((all.len(), all[0].1.place[2]), (motion.times().count(), 1.0));
    assert!(all.iter().zip(motion.times()).all(|((t, _), time)| *t == time));
}

#[test]
fn progress_runs_from_zero_to_one() {
    for (from, to) in [(0.0, 4.0), (4.0, 0.0)] {
        let mut shown = Vec::new();
        let run = prepared().simulation(&START).law(Pull).progress(|t, part| shown.push((t, part)));
        let motion = run.run(from..to).unwrap();
        assert!(shown.iter().is_sorted_by(|a, b| a.1 < b.1), "{shown:?}");
        assert_eq!((shown.len() + 1, shown.last()), (motion.times().count(), Some(&(to, 1.0))));
        assert!(shown.iter().all(|(t, part)| ((t - from) / (to - from) - part).abs() < 1e-15));
    }
}
