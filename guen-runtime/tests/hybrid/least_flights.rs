//! Starts on a floor whose speeds or heights are next to nothing: such a body rests, after the few impacts that numbers can tell.

use core::ops::ControlFlow;

use guen_runtime::hybrid::{
    ElementState, Hybrid, HybridCause, HybridSystem, Mode, Transition, TransitionKind,
};
use guen_runtime::steppers::Dop853;
use guen_runtime::{Cause, Setting};

use crate::systems::BouncingBall;

#[test]
fn a_body_that_hardly_leaves_its_floor_rests_on_it() {
    let starts = [
        [0.0, 1e-18],
        [0.0, -1e-18],
        [0.0, 6e-19],
        [0.0, 1e-20],
        [0.0, 1e-100],
        [0.0, 1e-160],
        [0.0, -1e-160],
        [0.0, 5e-324],
        [1e-300, 0.0],
        [1e-300, 1e-18],
        [1e-300, -1e-300],
        [5e-324, 0.0],
    ];
    let powers =
        (12..30).step_by(2).flat_map(|k| [1.0, 2.7, 6.3].map(|digits| [0.0, digits * 10.0_f64.powi(-k)]));
    let starts: Vec<[f64; 2]> = starts.into_iter().chain(powers).collect();
    for e in [0.0, 0.5, 0.8, 0.99] {
        for g in [9.81, 1e-3, 1e6] {
            let ball = BouncingBall { g, e };
            let times = [0.0, 1e3, -1.0, 1e-3, 1.0, 1e9];
            for (start, t) in starts.iter().flat_map(|start| times.map(|t| (start, t))) {
                let motion = ball.simulate(start, t..t + 1.0);
                let motion =
                    motion.unwrap_or_else(|error| panic!("{start:?} at {t}, {e}, {g}: {}", error.error));
                let [z, v] = motion.end();
                assert!(z.abs() < 1e-12 && v.abs() < 1e-12, "{start:?} at {t}, {e}, {g}: {z} {v}");
                assert_eq!(motion.mode_at(t + 1.0).0, [ElementState::Closed], "{start:?} at {t}, {e}, {g}");
            }
        }
    }
}

/// Many impacts are none too many before the time zero.
#[test]
fn a_body_bounces_at_times_below_zero() {
    let ball = BouncingBall { g: 9.81, e: 0.999 };
    for t in [-100.0, 0.0, 100.0] {
        let motion = ball.simulate(&[1.0, 0.0], t..t + 60.0).unwrap();
        let count = motion.transitions().len();
        assert!((65..=70).contains(&count), "{t}: {count}");
    }
}

/// A run that is to end far away, and stops at its hundredth impact.
#[test]
fn the_end_of_a_run_says_nothing_of_its_pace() {
    for end in [1e3, 1e10, 1e300] {
        for e in [0.99, 1.0] {
            let mut impacts = 0;
            let ball = BouncingBall { g: 9.81, e };
            let mut receive = |_: &Transition<Mode<1>, 2, 1, 1>| {
                impacts += 1;
                if impacts < 100 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            };
            let run = Hybrid::new(&ball, 0.0, &[0.01, 0.0]).transitions(&mut receive);
            let done = run.run(&Dop853::new(1e-9, 1e-9), end);
            let done = done.unwrap_or_else(|error| panic!("{end:e}, {e}: {error}"));
            assert!(done.stopped && done.t < 10.0);
        }
    }
}

/// Nothing is taken from an elastic body.
#[test]
fn an_elastic_body_does_not_rest() {
    for t in [0.0, 1e6] {
        let motion = BouncingBall { g: 9.81, e: 1.0 }.simulate(&[1e-6, 0.0], t..t + 0.02).unwrap();
        assert!(motion.transitions().iter().all(|at| at.kind == TransitionKind::Impact), "{t}");
        assert!(motion.transitions().len() > 20);
    }
}

/// Settings that make no sense are refused before anything is done.
#[test]
fn samples_after_the_end_and_accuracies_that_are_none_are_refused() {
    let ball = BouncingBall { g: 9.81, e: 0.5 };
    let refused = |run: Hybrid<'_, BouncingBall, 2, 1, 1, 0>| {
        let error = run.run(&Dop853::new(1e-9, 1e-9), 2.0).unwrap_err();
        assert_eq!((error.t, error.state), (0.0, [1.0, 0.0]));
        error.cause
    };
    let begin = || Hybrid::new(&ball, 0.0, &[1.0, 0.0]);
    let mut visit = |_: usize, _: f64, _: &[f64; 2], _: &Mode<1>| panic!();
    let late = refused(begin().sample(&[0.0, 2.5], &mut visit));
    assert_eq!(late, HybridCause::Integration(Cause::Setting(Setting::Samples)));
    for accuracy in [f64::NAN, -1.0, f64::INFINITY] {
        let cause = refused(begin().resting_accuracy(accuracy));
        assert_eq!(cause, HybridCause::Integration(Cause::Setting(Setting::Accuracy)));
    }
    assert!(begin().resting_accuracy(0.0).run(&Dop853::new(1e-9, 1e-9), 2.0).is_ok());
}
