//! The declarations of the reference scenes, run through their modes.

use core::ops::ControlFlow;

use guen::hybrid::{
    Hybrid, HybridCause, HybridError, HybridSystem, InMode, Mode, Transition, TransitionKind,
};
use guen::steppers::{Dop853, Method};

use crate::declared::*;
use crate::json::Json;

fn scene(name: &str) -> Json {
    let path = format!("{}/data/hybrid/{name}.json", env!("CARGO_MANIFEST_DIR"));
    Json::read(&std::fs::read_to_string(path).unwrap())
}

fn state<const N: usize>(place: &Json) -> [f64; N] {
    let mut all = place.get("coordinates").numbers();
    all.extend(place.get("velocities").numbers());
    all.try_into().unwrap()
}

fn words<M, const C: usize>(mode: M) -> Vec<&'static str>
where
    Mode<C>: From<M>,
{
    Mode::from(mode).0.iter().map(|state| state.word()).collect()
}

/// Whether a kind of ours is one of the reference's.
fn agrees(kind: TransitionKind, reference: &str) -> bool {
    match reference {
        "impact" => kind == TransitionKind::Impact,
        "zeno" => matches!(kind, TransitionKind::Rest { .. }),
        "cone+" | "cone-" => kind == TransitionKind::Slips,
        "slip" => matches!(kind, TransitionKind::Sticks | TransitionKind::Reversed),
        "switch" => kind == TransitionKind::Switched,
        _ => false,
    }
}

/// Runs a scene, and compares its transitions up to the first rest and the states at all samples outside of what a rest leaves out;
/// returns the largest errors of times and states.
fn compared<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    system: &H,
    name: &str,
) -> (f64, f64)
where
    H: HybridSystem<N, W, C, S> + Clone,
    Mode<C>: From<H::Mode>,
    Dop853: Method<f64, InMode<H, N, W, C, S>, N>,
{
    let scene = scene(name);
    let samples = scene.get("samples").list();
    let times: Vec<f64> = samples.iter().map(|sample| sample.get("t").number()).collect();
    let (mut told, mut found) = (Vec::new(), Vec::new());
    Hybrid::new(system, 0.0, &state(scene.get("initial")))
        .sample(&times, &mut |_, _, x: &[f64; N], mode: &H::Mode| found.push((*x, words(*mode))))
        .transitions(&mut |tr: &Transition<H::Mode, N, W, C>| {
            told.push((tr.t, tr.kind, words(tr.after)));
            ControlFlow::Continue(())
        })
        .run(&Dop853::new(1e-11, 1e-11), *times.last().unwrap())
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    let (mut worst_time, mut worst_state) = (0.0_f64, 0.0_f64);
    let mut rest = None;
    let mut expected = scene.get("events").list().iter();
    for (t, kind, mode) in &told {
        let mut event = expected.next().unwrap_or_else(|| panic!("{name}: {kind:?} at {t}"));
        let mut time = *t;
        if let TransitionKind::Rest { until, .. } = kind {
            (rest, time) = (Some((*t, *until)), *until);
            while event.get("kind").text() == "impact" {
                event = expected.next().unwrap();
            }
        }
        assert!(agrees(*kind, event.get("kind").text()), "{name}: {kind:?} at {t} instead of {event:?}");
        assert_eq!(*mode, event.get("mode_after").texts(), "{name} at {t}");
        worst_time = worst_time.max((time - event.get("t").number()).abs());
    }
    for ((x, mode), sample) in found.iter().zip(samples) {
        let t = sample.get("t").number();
        if rest.is_some_and(|(from, until)| (from..until).contains(&t)) {
            continue;
        }
        assert_eq!(*mode, sample.get("mode").texts(), "{name} at {t}");
        for (found, expected) in x.iter().zip(state::<N>(sample)) {
            worst_state = worst_state.max((found - expected).abs() / expected.abs().max(1.0));
        }
    }
    println!("{name}: times {worst_time:e}, states {worst_state:e}");
    (worst_time, worst_state)
}

/// The accuracy of the runs: that of DOP853 at a tolerance of 1e-11, with the promise of the design for times.
macro_rules! scenes {
    ($($name:ident $System:ident;)*) => {
        $(
            #[test]
            fn $name() {
                let system = $System::default().prepare().unwrap();
                let (times, states) = compared(&system, stringify!($name));
                assert!(times < 1e-9 && states < 1e-8, "{times:e} {states:e}");
            }
        )*
    };
}

scenes! {
    bouncing_ball BouncingBall;
    bowling_ball BowlingBall;
    pendulum_stop PendulumStop;
    puck_incline PuckIncline;
    stick_slip_belt StickSlip;
    thrown_ball ThrownBall;
    two_balls_wall TwoBalls;
}

/// The rod ends where its reaction becomes infinite: the accuracy is the promise of the design.
#[test]
fn painleve_rod() {
    let scene = scene("painleve_rod");
    let rod = PainleveRod::default().prepare().unwrap();
    let event = scene.get("events").list()[0].get("t").number();
    let error: HybridError<6, 1> = Hybrid::new(&rod, 0.0, &state(scene.get("initial")))
        .run(&Dop853::new(1e-12, 1e-12), 2.0)
        .unwrap_err();
    assert!(matches!(error.cause, HybridCause::Painleve { .. }), "{error}");
    assert!((error.t - event).abs() < 1e-8, "{} and {event}", error.t);
    // Where the modes of a scene have programs of their own, too.
    let sliding = painleve_rod::Sliding::from(PainleveRod::default()).prepare().unwrap();
    let start = painleve_rod::State::from(state(scene.get("initial")));
    let error: HybridError<3, 1> =
        Hybrid::new(&sliding, 0.0, &painleve_rod::sliding::State::from(&start).into())
            .run(&Dop853::new(1e-12, 1e-12), 2.0)
            .unwrap_err();
    assert!(matches!(error.cause, HybridCause::Painleve { .. }), "{error}");
    assert!((error.t - event).abs() < 1e-8, "{} and {event}", error.t);
}

/// The wheel loses its grip where the ice begins, and finds it again behind its end.
#[test]
fn the_wheel_on_ice() {
    let wheel = Wheel { c: 0.0, ..Wheel::default() };
    let wheel = wheel.prepare().unwrap().driven(wheel::Inputs { torque: 20.0 });
    let start = wheel::State { z: 0.3, ..Default::default() };
    let mut told = Vec::new();
    Hybrid::new(&wheel, 0.0, &start.into())
        .transitions(&mut |tr: &Transition<wheel::Mode, 6, 2, 1>| {
            told.push((tr.t, tr.kind, tr.state_after[0], tr.after.tyre));
            ControlFlow::Continue(())
        })
        .run(&Dop853::new(1e-10, 1e-10), 6.0)
        .unwrap();
    // x = a t^2/2 with a = T/(m r + J/r) while it rolls.
    let acceleration = 20.0 / (20.0 * 0.3 + 1.0 / 0.3);
    assert!((told[0].0 - f64::sqrt(10.0 / acceleration)).abs() < 1e-9);
    let kinds: Vec<_> = told.iter().map(|(_, kind, _, tyre)| (*kind, *tyre)).collect();
    let slips = wheel::Tyre::SlipBackward;
    let sticks = wheel::Tyre::Stick;
    use TransitionKind::{Slips, Sticks, Switched};
    assert_eq!(kinds, [(Slips, slips), (Switched, slips), (Sticks, sticks)]);
    assert!((told[0].2 - 5.0).abs() < 1e-12 && (told[1].2 - 9.0).abs() < 1e-12);
}
