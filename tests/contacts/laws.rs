//! Inputs that are functions of time and state, and inputs of controllers, in runs through modes.

use core::ops::ControlFlow;

use guen::hybrid::{Hybrid, HybridCause, SensitivityError, Transition, TransitionKind};
use guen::prelude::*;
use guen::{Cause, InputLaw, Setting};

mechanical_system! {
    /// A carriage that is pushed against a wall, with a brake; behind a line the floor is rough. Each time it leaves the wall behind, a
    /// counter takes what pushes it.
    pub system Pushed {
        constants { m = 1.3, e in 0..1 = 0.4, F = 2, l = 3/5 }
        inputs { push }
        coordinates { x }
        parameters { u = dot(x); }
        states { dot(counted) = 0; }
        switches { rough: x + 1/4; }
        kinetic_energy = m/2*u^2;
        forces { push - max(0, push - 3)/2 along u; -1/5*rough*u along u; }
        contacts {
            wall: gap = l - x, restitution = e;
            brake: grip = u, limit = F*(1 + rough/4);
        }
        resets { back: x + 1/2 falls, counted = counted + push; }
    }
}

mechanical_system! {
    /// A carriage with the law of its controller written into its forces: it moves as the first one does under that law.
    pub system Steered {
        constants { m = 1.3, e in 0..1 = 0.4, F = 2, l = 3/5, k = 4, c = 1/3, w = 1.7 }
        coordinates { x }
        parameters { u = dot(x); }
        states { dot(counted) = 0; }
        switches { rough: x + 1/4; }
        kinetic_energy = m/2*u^2;
        let push = k*(sin(w*t) - x) - c*u;
        forces { push - max(0, push - 3)/2 along u; -1/5*rough*u along u; }
        contacts {
            wall: gap = l - x, restitution = e;
            brake: grip = u, limit = F*(1 + rough/4);
        }
        resets { back: x + 1/2 falls, counted = counted + push; }
    }
}

/// A servo after a point that swings.
#[derive(Clone, Copy)]
struct Servo {
    k: f64,
    c: f64,
    w: f64,
}

const SERVO: Servo = Servo { k: 4.0, c: 1.0 / 3.0, w: 1.7 };

impl InputLaw<pushed::Prepared> for Servo {
    fn at<R: Real>(&self, t: R, state: &pushed::State<R>) -> pushed::Inputs<R> {
        let [k, c, w] = [self.k, self.c, self.w].map(R::from_f64);
        pushed::Inputs { push: k * ((w * t).sin() - state.x) - c * state.u }
    }
}

/// Times and kinds, states and modes are those of the system whose declaration has the law.
#[test]
fn a_law_is_as_good_as_forces() {
    let by_law = Pushed::default().prepare().unwrap().with_law(SERVO);
    let steered = Steered::default().prepare().unwrap();
    let start = pushed::State { x: 0.2, u: 0.9, counted: 0.0 };
    let end = 40.0;
    let motion = by_law.simulation(&start).tolerance(1e-11).run(0.0..end).unwrap();
    let same = steered.simulation(&steered::State { x: 0.2, u: 0.9, counted: 0.0 });
    let same = same.tolerance(1e-11).run(0.0..end).unwrap();
    assert_eq!(motion.transitions().len(), same.transitions().len());
    let mut kinds = Vec::new();
    for (a, b) in motion.transitions().iter().zip(same.transitions()) {
        assert!((a.t - b.t).abs() < 1e-9, "{} {}", a.t, b.t);
        assert_eq!(a.kind, b.kind);
        assert_eq!(a.after.to_string(), b.after.to_string());
        kinds.push(a.kind);
    }
    for kind in [
        TransitionKind::Impact,
        TransitionKind::Sticks,
        TransitionKind::Slips,
        TransitionKind::Switched,
        TransitionKind::Reset,
    ] {
        assert!(kinds.contains(&kind), "{kind:?} is missing among {kinds:?}");
    }
    for (t, state) in motion.sample(0.37) {
        let other: [f64; 3] = same.at(t).into();
        let state: [f64; 3] = state.into();
        for (a, b) in state.iter().zip(other) {
            assert!((a - b).abs() < 1e-8, "at {t}: {a} {b}");
        }
        // The forces of the wall and of the brake are the same.
        for (a, b) in motion.reactions_at(t).iter().zip(same.reactions_at(t)) {
            assert!((a - b).abs() < 1e-7, "at {t}: {a} {b}");
        }
    }
}

/// The brake lets go where the law, and nothing else, reaches its limit: `push = t^2` from rest, so at `sqrt(F)`.
#[test]
fn the_rate_of_a_law_releases_a_brake() {
    #[derive(Clone, Copy)]
    struct Grows;
    impl InputLaw<pushed::Prepared> for Grows {
        fn at<R: Real>(&self, t: R, _: &pushed::State<R>) -> pushed::Inputs<R> {
            pushed::Inputs { push: t * t }
        }
    }
    let by_law = Pushed { l: 100.0, F: 0.7, ..Default::default() }.prepare().unwrap().with_law(Grows);
    let start = pushed::State { x: -0.3, ..Default::default() };
    let mut told = None;
    let end: [f64; 3] = start.into();
    Hybrid::new(&by_law, 0.0, &end)
        .transitions(&mut |transition: &Transition<pushed::Mode, 3, 2, _>| {
            told = Some((transition.kind, transition.t));
            ControlFlow::Break(())
        })
        .run(&Dop853::new(1e-12, 1e-12), 2.0)
        .unwrap();
    let (kind, t) = told.unwrap();
    assert_eq!(kind, TransitionKind::Slips);
    assert!((t - 0.7_f64.sqrt()).abs() < 1e-11, "{t}");
}

/// The derivatives of a motion under a law, the law's own among them, are those of differences.
#[test]
fn derivatives_go_through_a_law() {
    let by_law = Pushed { F: 0.0, ..Default::default() }.prepare().unwrap().with_law(SERVO);
    let run = |start: [f64; 3]| by_law.simulation(&start.into()).tolerance(1e-12).run(0.0..1.9).unwrap();
    let start = [0.2, 0.9, 0.0];
    let motion = run(start);
    assert!(motion.transitions().iter().any(|transition| transition.kind == TransitionKind::Impact));
    let found = motion.sensitivity(&Dop853::new(1e-12, 1e-12)).unwrap();
    for j in 0..2 {
        let h = 1e-5;
        let at = |h: f64| -> [f64; 3] {
            let mut start = start;
            start[j] += h;
            run(start).end().into()
        };
        let (above, below) = (at(h), at(-h));
        for i in 0..3 {
            let difference = (above[i] - below[i]) / (2.0 * h);
            assert!((found[i][j] - difference).abs() < 1e-6, "{i} {j}: {} {difference}", found[i][j]);
        }
    }
}

/// A controller that looks thirty times a second: the motion is that of its inputs, changed at these times, to the bit.
#[test]
fn a_controller_holds_its_inputs_through_modes() {
    let prepared = Pushed::default().prepare().unwrap();
    let start = pushed::State { x: 0.2, u: 0.9, counted: 0.0 };
    let mut samples = Vec::new();
    let mut sum = 0.0;
    let motion = prepared
        .simulation(&start)
        .hold(1.0 / 30.0, |t, state| {
            sum += 0.05 * ((1.7 * t).sin() - state.x);
            let inputs = pushed::Inputs { push: 4.0 * ((1.7 * t).sin() - state.x) - 0.3 * state.u + sum };
            samples.push((t, inputs));
            inputs
        })
        .run(0.0..12.0)
        .unwrap();
    assert!(matches!(motion.sensitivity(&Dop853::new(1e-9, 1e-9)), Err(SensitivityError::Sampled)));
    assert_eq!(samples.len(), 360);
    for (k, (t, _)) in samples.iter().enumerate() {
        assert_eq!(*t, k as f64 * (1.0 / 30.0));
    }
    let told = prepared.driven(samples[0].1).simulation(&start).inputs(&samples[1..]).run(0.0..12.0).unwrap();
    assert_eq!(motion.end(), told.end());
    assert_eq!(motion.transitions(), told.transitions());
    let kinds = [TransitionKind::Impact, TransitionKind::Slips, TransitionKind::Sticks];
    for kind in kinds {
        assert!(motion.transitions().iter().any(|transition| transition.kind == kind), "{kind:?}");
    }
    // The reactions are those of the inputs of their time.
    for k in [7, 100, 250] {
        let t = (k as f64 + 0.5) / 30.0;
        assert_eq!(motion.reactions_at(t), told.reactions_at(t));
    }
}

/// Periods that are not positive numbers are refused, and so are those that do not move time.
#[test]
fn periods_that_are_none_are_refused() {
    let prepared = Pushed::default().prepare().unwrap();
    let start = pushed::State::default();
    for (period, cause) in [
        (0.0, Cause::Setting(Setting::Period)),
        (-1.0, Cause::Setting(Setting::Period)),
        (f64::NAN, Cause::Setting(Setting::Period)),
        (1e-20, Cause::StepUnderflow),
    ] {
        let run = prepared.simulation(&start).hold(period, |_, _| pushed::Inputs { push: 0.0 }).run(1.0..2.0);
        assert_eq!(run.unwrap_err().error.cause, HybridCause::Integration(cause));
    }
}
