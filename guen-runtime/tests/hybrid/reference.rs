//! The reference scenes: every transition of the right kind in the right order, times and states to their accuracy.

use core::ops::ControlFlow;

use guen_runtime::hybrid::{Hybrid, HybridCause, HybridError, HybridSystem, InMode, Mode, TransitionKind};
use guen_runtime::steppers::{Dop853, Method, Taylor, Tsit5};

use crate::json::Json;
use crate::systems::{
    BouncingBall, BowlingBall, KaneImpact, PainleveRod, PendulumStop, PuckIncline, StickSlipBelt, ThrownBall,
    TwoBalls,
};

/// A scene by the name of its file.
fn scene(name: &str) -> Json {
    let path = format!("{}/../tests/data/hybrid/{name}.json", env!("CARGO_MANIFEST_DIR"));
    Json::read(&std::fs::read_to_string(path).unwrap())
}

/// A transition: its time, kind, mode after it and state after it.
type Told<const N: usize, const C: usize> = (f64, TransitionKind, Mode<C>, [f64; N]);

fn state<const N: usize>(place: &Json, velocities: &str) -> [f64; N] {
    let mut all = place.get("coordinates").numbers();
    all.extend(place.get(velocities).numbers());
    all.try_into().unwrap()
}

/// The transitions of a scene, and its samples.
#[allow(clippy::type_complexity)]
fn run<H, M, const N: usize, const W: usize, const C: usize, const S: usize>(
    system: &H,
    method: &M,
    scene: &Json,
) -> (Result<f64, HybridError<N, C>>, Vec<Told<N, C>>, Vec<([f64; N], Mode<C>)>)
where
    H: HybridSystem<N, W, C, S, Mode = Mode<C>> + Clone,
    M: Method<f64, InMode<H, N, W, C, S>, N>,
{
    let start: [f64; N] = state(scene.get("initial"), "velocities");
    let times: Vec<f64> = scene.get("samples").list().iter().map(|sample| sample.get("t").number()).collect();
    let (mut told, mut samples) = (Vec::new(), Vec::new());
    let end = times.last().copied().unwrap_or(0.0);
    let done = Hybrid::new(system, 0.0, &start)
        .sample(&times, &mut |_, _, x, mode: &Mode<C>| samples.push((*x, *mode)))
        .transitions(&mut |tr| {
            told.push((tr.t, tr.kind, tr.after, tr.state_after));
            ControlFlow::Continue(())
        })
        .run(method, end);
    (done.map(|done| done.t), told, samples)
}

/// Whether a kind of ours is one of the reference's.
fn agrees(kind: TransitionKind, reference: &str) -> bool {
    match reference {
        "impact" => kind == TransitionKind::Impact,
        "zeno" => matches!(kind, TransitionKind::Rest { .. }),
        "cone+" | "cone-" => kind == TransitionKind::Slips,
        "slip" => matches!(kind, TransitionKind::Sticks | TransitionKind::Reversed),
        "reaction" => kind == TransitionKind::Lifted,
        "switch" => kind == TransitionKind::Switched,
        "lock" => kind == TransitionKind::Locked,
        "release" => kind == TransitionKind::Released,
        "grazing" => kind == TransitionKind::Touch,
        _ => false,
    }
}

/// Compares a run with its scene; returns the largest errors of event times and of states at samples.
fn compared<H, M, const N: usize, const W: usize, const C: usize, const S: usize>(
    system: &H,
    method: &M,
    name: &str,
) -> (f64, f64)
where
    H: HybridSystem<N, W, C, S, Mode = Mode<C>> + Clone,
    M: Method<f64, InMode<H, N, W, C, S>, N>,
{
    let scene = scene(name);
    let (done, told, samples) = run::<H, M, N, W, C, S>(system, method, &scene);
    done.unwrap_or_else(|error| panic!("{name}: {error}\n{told:#?}"));
    let end = scene.get("samples").list().last().unwrap().get("t").number();
    let mut events: Vec<&Json> = scene.get("events").list().iter().collect();
    events.retain(|event| event.get("t").number() <= end);
    let (mut worst_time, mut worst_state) = (0.0_f64, 0.0_f64);
    let mut expected = events.into_iter();
    let mut rests = Vec::new();
    // Of impacts that accumulate, those later than so long before their end are not listed.
    let unlisted = 1e-4;
    let zenos: Vec<f64> = scene
        .get("events")
        .list()
        .iter()
        .filter(|event| event.get("kind").text() == "zeno")
        .map(|event| event.get("t").number())
        .collect();
    for (t, kind, mode, _) in &told {
        let is_unlisted = |zeno: &f64| (zeno - unlisted..*zeno).contains(t);
        if *kind == TransitionKind::Impact && zenos.iter().any(is_unlisted) {
            continue;
        }
        let mut event = expected.next().unwrap_or_else(|| panic!("{name}: nothing happens at {t}: {kind:?}"));
        let mut time = *t;
        if let TransitionKind::Rest { until, .. } = kind {
            rests.push((*t, *until));
            time = *until;
            // The impacts that were left out.
            while event.get("kind").text() == "impact" {
                event = expected.next().unwrap();
            }
        }
        assert!(agrees(*kind, event.get("kind").text()), "{name}: {kind:?} at {t} instead of {event:?}");
        let modes: Vec<&str> = mode.0.iter().map(|state| state.word()).collect();
        assert_eq!(modes, event.get("mode_after").texts(), "{name} at {t}");
        worst_time = worst_time.max((time - event.get("t").number()).abs());
    }
    assert!(expected.next().is_none(), "{name}: not all has happened, {told:?}");
    for ((x, mode), sample) in samples.iter().zip(scene.get("samples").list()) {
        let t = sample.get("t").number();
        if rests.iter().any(|(from, until)| (*from..*until).contains(&t)) {
            continue;
        }
        let modes: Vec<&str> = mode.0.iter().map(|state| state.word()).collect();
        assert_eq!(modes, sample.get("mode").texts(), "{name} at {t}");
        let expected: [f64; N] = state(sample, "velocities");
        for (found, expected) in x.iter().zip(expected) {
            worst_state = worst_state.max((found - expected).abs() / expected.abs().max(1.0));
        }
    }
    assert_eq!(samples.len(), scene.get("samples").list().len());
    (worst_time, worst_state)
}

/// Compares a scene with both methods.
macro_rules! scene_test {
    ($name:ident, $system:expr, $states:literal) => {
        #[test]
        fn $name() {
            let name = stringify!($name);
            let (times, states) = compared(&$system, &Dop853::new(1e-11, 1e-11), name);
            println!("{name}: times {times:e}, states {states:e} with DOP853");
            assert!(times < 1e-9 && states < $states, "{times:e} {states:e}");
            let (times, states) = compared(&$system, &Taylor::new(1e-14, 1e-14), name);
            println!("{name}: times {times:e}, states {states:e} with Taylor");
            assert!(times < 1e-12 && states < 1e-11, "{times:e} {states:e}");
        }
    };
}

scene_test!(bouncing_ball, BouncingBall { g: 9.81, e: 0.8 }, 1e-9);
scene_test!(pendulum_stop, PendulumStop, 1e-9);
scene_test!(thrown_ball, ThrownBall, 1e-9);
scene_test!(bowling_ball, BowlingBall, 1e-9);
scene_test!(stick_slip_belt, StickSlipBelt, 1e-9);
scene_test!(puck_incline, PuckIncline, 1e-9);
scene_test!(two_balls_wall, TwoBalls { e: 0.5 }, 1e-9);

#[test]
fn two_balls_have_three_answers() {
    let scene = scene("two_balls_wall");
    for variant in scene.get("variants").list() {
        let e = variant.get("restitution").number();
        let start: [f64; 4] = state(variant.get("initial"), "velocities");
        let mut told = Vec::new();
        let done = Hybrid::new(&TwoBalls { e }, 0.0, &start)
            .transitions(&mut |tr| {
                told.push((tr.t, tr.elements, tr.state_after));
                ControlFlow::Continue(())
            })
            .run(&Dop853::new(1e-11, 1e-11), 2.0)
            .unwrap();
        let events = variant.get("events").list();
        println!("{e} {}: {told:?}", variant.get("order").text());
        assert_eq!(told.len(), events.len());
        for ((t, elements, after), event) in told.iter().zip(events) {
            assert!((t - event.get("t").number()).abs() < 1e-12);
            let names = event.get("closed").texts();
            assert_eq!(*elements, [names.contains(&"wall"), names.contains(&"pair")]);
            let expected = event.get("velocities_after").numbers();
            for (found, expected) in after[2..].iter().zip(expected) {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        }
        let last = variant.get("final_velocities").numbers();
        assert!((done.state[2] - last[0]).abs() < 1e-12 && (done.state[3] - last[1]).abs() < 1e-12);
    }
}

#[test]
fn kanes_impact_follows_poissons_law() {
    let scene = scene("kane_impact");
    let coordinates = scene.get("initial").get("coordinates").numbers();
    let h = coordinates.iter().map(|angle| angle.cos()).sum();
    let start: [f64; 4] = state(scene.get("initial"), "velocities");
    let mut told = Vec::new();
    Hybrid::new(&KaneImpact { h }, 0.0, &start)
        .transitions(&mut |tr| {
            told.push(*tr);
            ControlFlow::Break(())
        })
        .run(&Dop853::new(1e-11, 1e-11), 1.0)
        .unwrap();
    let poisson =
        scene.get("events").list().iter().find(|event| event.get("law").text() == "poisson").unwrap();
    let [impact] = &told[..] else { panic!("{told:?}") };
    assert_eq!(impact.kind, TransitionKind::Impact);
    for (found, expected) in impact.impulses.iter().zip(poisson.get("impulses").numbers()) {
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
    for (found, expected) in impact.state_after[2..].iter().zip(poisson.get("velocities_after").numbers()) {
        assert!((found - expected).abs() < 1e-13, "{found} {expected}");
    }
    let change = poisson.get("energy_after").number() - scene.get("energy_before").number();
    assert!((impact.energy - change).abs() < 1e-14);
}

#[test]
fn painleves_rod_ends_in_a_typed_error_at_its_time() {
    let scene = scene("painleve_rod");
    let time = scene.get("events").list()[0].get("t").number();
    let start: [f64; 6] = state(scene.get("initial"), "velocities");
    let error = Hybrid::new(&PainleveRod, 0.0, &start).run(&Dop853::new(1e-11, 1e-11), 1.0).unwrap_err();
    println!("{error}: off by {:e}", error.t - time);
    assert!(matches!(error.cause, HybridCause::Painleve { contact: "end", .. }), "{error:?}");
    assert!((error.t - time).abs() < 1e-8);
    for (theta, omega, expected) in [(0.9, 0.0, "inconsistent"), (0.9, 4.0, "ambiguous")] {
        let (sin, cos) = f64::sin_cos(theta);
        // The tip slips with -20, and does not leave the floor.
        let start = [cos, sin, theta, -20.0 - sin * omega, cos * omega, omega];
        let error = Hybrid::new(&PainleveRod, 0.0, &start).run(&Dop853::new(1e-11, 1e-11), 1.0).unwrap_err();
        assert_eq!(error.t, 0.0);
        let found = match error.cause {
            HybridCause::Inconsistent => "inconsistent",
            HybridCause::Ambiguous { .. } => "ambiguous",
            cause => panic!("{cause:?}"),
        };
        assert_eq!(found, expected);
    }
}

/// The largest error of an event's time in each scene that has events after its start and accelerations.
fn errors_of_times<M>(method: &M) -> [f64; 6]
where
    M: Method<f64, InMode<BouncingBall, 2, 1, 1, 0>, 2>
        + Method<f64, InMode<BowlingBall, 6, 2, 1, 1>, 6>
        + Method<f64, InMode<PendulumStop, 2, 1, 1, 0>, 2>
        + Method<f64, InMode<PuckIncline, 6, 3, 1, 0>, 6>
        + Method<f64, InMode<StickSlipBelt, 4, 2, 1, 0>, 4>
        + Method<f64, InMode<ThrownBall, 6, 2, 1, 0>, 6>,
{
    [
        compared::<_, _, 2, 1, 1, 0>(&BouncingBall { g: 9.81, e: 0.8 }, method, "bouncing_ball").0,
        compared::<_, _, 6, 2, 1, 1>(&BowlingBall, method, "bowling_ball").0,
        compared::<_, _, 2, 1, 1, 0>(&PendulumStop, method, "pendulum_stop").0,
        compared::<_, _, 6, 3, 1, 0>(&PuckIncline, method, "puck_incline").0,
        compared::<_, _, 4, 2, 1, 0>(&StickSlipBelt, method, "stick_slip_belt").0,
        compared::<_, _, 6, 2, 1, 0>(&ThrownBall, method, "thrown_ball").0,
    ]
}

/// Prints the table of `docs/design/hybrid.md`.
#[test]
fn event_times_converge_with_the_tolerance() {
    println!("| method | tolerance | bouncing | bowling | pendulum | puck | belt | thrown |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for exponent in [5, 7, 9, 11, 13] {
        let tolerance = 10.0_f64.powi(-exponent);
        let runs = [
            ("DOP853", errors_of_times(&Dop853::new(tolerance, tolerance))),
            ("Tsit5", errors_of_times(&Tsit5::new(tolerance, tolerance))),
            ("Taylor", errors_of_times(&Taylor::new(tolerance, tolerance))),
        ];
        for (name, errors) in runs {
            let cells: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
            println!("| {name} | 1e-{exponent} | {} |", cells.join(" | "));
            // Where slip begins on the belt, errors grow: friction falls with the speed.
            for (scene, error) in errors.into_iter().enumerate() {
                let factor = if scene == 4 { 1000.0 } else { 300.0 };
                assert!(error < factor * tolerance, "{name}: {error:e} at {tolerance:e} in scene {scene}");
            }
        }
    }
}
