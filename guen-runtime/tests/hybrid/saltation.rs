//! Derivatives through transitions: beside differences of runs, and closed forms.

use guen_runtime::hybrid::{HybridSystem, Mode, NoSaltation, SensitivityError, TransitionKind};
use guen_runtime::steppers::Dop853;

use crate::friction::Pulled;
use crate::scenarios::{Door, GrippedCart, Shaft, Thrown};
use crate::systems::{
    BouncingBall, BowlingBall, KaneImpact, PendulumStop, PuckIncline, StickSlipBelt, ThrownBall, TwoBalls,
};

const TOLERANCE: f64 = 1e-13;

/// Compares the derivatives of a motion along directions with differences of runs; returns the kinds of its transitions.
pub fn compared<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    system: &H,
    start: [f64; N],
    directions: &[[f64; N]],
    until: f64,
    accuracy: f64,
) -> Vec<TransitionKind>
where
    H: HybridSystem<N, W, C, S, Mode = Mode<C>> + Clone,
{
    let step = 1e-5;
    let motion = system.simulation(&start).tolerance(TOLERANCE).run(0.0..until).unwrap();
    let matrix = motion.sensitivity(&dop853()).unwrap();
    for direction in directions {
        let along = |size: f64| {
            let moved = core::array::from_fn(|i| start[i] + size * direction[i]);
            system.simulation(&moved).tolerance(TOLERANCE).run(0.0..until).unwrap().end()
        };
        // Differences of fourth order.
        let [a, b, c, d] = [2.0, 1.0, -1.0, -2.0].map(|k| along(k * step));
        let size = matrix.iter().flatten().fold(1.0, |most: f64, entry| most.max(entry.abs()));
        for i in 0..N {
            let difference = (8.0 * (b[i] - c[i]) - (a[i] - d[i])) / (12.0 * step);
            let derivative: f64 = (0..N).map(|j| matrix[i][j] * direction[j]).sum();
            let off = (derivative - difference).abs() / size;
            assert!(off < accuracy, "{i} along {direction:?}: {derivative} {difference}, off by {off:e}");
        }
    }
    motion.transitions().iter().map(|tr| tr.kind).collect()
}

fn dop853<const N: usize>() -> Dop853<guen_runtime::Dual<f64, N>> {
    Dop853::new(TOLERANCE, TOLERANCE)
}

/// The unit vectors of these entries.
fn units<const N: usize>(entries: &[usize]) -> Vec<[f64; N]> {
    entries.iter().map(|&k| core::array::from_fn(|i| if i == k { 1.0 } else { 0.0 })).collect()
}

#[test]
fn impacts_of_the_reference_scenes() {
    let kinds = compared(&BouncingBall { g: 9.81, e: 0.8 }, [1.0, 0.0], &units(&[0, 1]), 2.0, 1e-8);
    assert_eq!(kinds, [TransitionKind::Impact; 3]);
    let kinds = compared(&PendulumStop, [1.0, 0.0], &units(&[0, 1]), 4.0, 1e-8);
    assert_eq!(kinds, [TransitionKind::Impact; 3]);
    // The balls at the wall one after the other.
    let kinds = compared(&TwoBalls { e: 0.5 }, [2.5, 1.0, -3.0, -1.0], &units(&[0, 1, 2, 3]), 1.5, 1e-8);
    assert!(kinds.len() >= 2, "{kinds:?}");
    let h = f64::cos(0.3) + f64::cos(-0.5) + 0.005;
    let kinds = compared(&KaneImpact { h }, [0.3, -0.5, -0.6, 0.4], &units(&[0, 1, 2, 3]), 0.3, 1e-6);
    assert!(kinds.contains(&TransitionKind::Impact), "{kinds:?}");
}

#[test]
fn a_thrown_ball_slides_rolls_and_rests() {
    // Through impacts that slip and that stick.
    let start = [0.0, 1.1, 0.0, 3.0, 0.0, -40.0];
    let kinds = compared(&ThrownBall, start, &units(&[0, 1, 2, 3, 4, 5]), 1.2, 1e-7);
    assert!(kinds.len() >= 2, "{kinds:?}");
    // To the end of the bounces, which is not differentiated impact by impact.
    let kinds = compared(&ThrownBall, start, &units(&[0, 3, 5]), 2.0, 1e-6);
    assert!(kinds.iter().any(|kind| matches!(kind, TransitionKind::Rest { .. })), "{kinds:?}");
}

#[test]
fn slip_and_rolling() {
    // It slides, rolls, is braked by a switch, slips ..
    let a = 0.108;
    let start = [0.0, a, 0.0, 8.0, 0.0, 0.0];
    let kinds = compared(&BowlingBall, start, &units(&[0, 2, 3, 5]), 5.0, 1e-7);
    assert!(kinds.contains(&TransitionKind::Sticks) && kinds.contains(&TransitionKind::Switched));
    let kinds = compared(&StickSlipBelt, [0.0, 0.0, 0.0, 0.0], &units(&[0, 2]), 8.0, 1e-6);
    assert!(kinds.contains(&TransitionKind::Sticks) && kinds.contains(&TransitionKind::Slips));
    // With more friction at rest than in motion the force jumps where slip begins.
    let block = Pulled { friction: 0.3, stiction: 0.5, sticks_only: false };
    let kinds = compared(&block, [0.0; 4], &units(&[0]), 6.0, 1e-8);
    assert_eq!(kinds, [TransitionKind::Slips]);
    let motion = block.simulate(&[0.0; 4], 0.0..6.0).unwrap();
    assert!(motion.sensitivity(&dop853()).unwrap().iter().flatten().all(|entry| entry.is_finite()));
}

#[test]
fn floors_that_move_grips_latches_and_resets() {
    // The floor throws up what rests on it, and meets it again: a jump that depends on time.
    let shaken = Shaft { g: 10.0, height: 1e9, restitution: 0.3, shakes: (0.5, 6.0) };
    let kinds = compared(&shaken, [0.1, 3.0], &units(&[0, 1]), 1.0, 1e-6);
    assert!(kinds.len() >= 2, "{kinds:?}");
    let cart = GrippedCart { limit: 3.0, off: 5.0, push: 1.0 };
    let kinds = compared(&cart, [0.0, 1.0], &units(&[0, 1]), 6.0, 1e-8);
    assert!(
        kinds.contains(&TransitionKind::Sticks) && kinds.contains(&TransitionKind::Switched),
        "{kinds:?}"
    );
    let kinds = compared(&Door { armed: true }, [1.0, 0.0], &units(&[0, 1]), 2.5, 1e-8);
    assert!(
        kinds.contains(&TransitionKind::Locked) && kinds.contains(&TransitionKind::Released),
        "{kinds:?}"
    );
    // A throw by a reset: the height after it, by that before.
    let kinds = compared(&Thrown, [5.0, 0.0], &units(&[0, 1]), 3.5, 1e-8);
    assert_eq!(kinds, [TransitionKind::Reset; 3]);
    let impact = Thrown.simulate(&[5.0, 0.0], 0.0..1.5).unwrap().saltation(0).unwrap();
    // It falls with 10, and is thrown with 5: later by d/10, with 5 then.
    assert!((impact.time[0] - 0.1).abs() < 1e-9 && (impact.matrix[0][0] + 0.5).abs() < 1e-9);
    assert!(impact.at_transition()[1][0].abs() < 1e-12);
}

#[test]
fn inputs_that_change_at_given_times() {
    let cart = GrippedCart { limit: 3.0, off: 9.0, push: 1.0 };
    let end = |v: f64| {
        let run = cart.simulation(&[0.0, v]).tolerance(TOLERANCE).inputs(&[(1.0, -2.0)]).run(0.0..3.0);
        run.unwrap()
    };
    let matrix = end(2.0).sensitivity(&dop853()).unwrap();
    let difference = (end(2.0 + 1e-4).end()[0] - end(2.0 - 1e-4).end()[0]) / 2e-4;
    assert!((matrix[0][1] - difference).abs() < 1e-6, "{} {difference}", matrix[0][1]);
}

#[test]
fn what_has_no_derivative_says_why() {
    let refused = |why, at: usize, error| {
        assert!(
            matches!(error, SensitivityError::Transition { transition, why: found, .. } if found == why && transition == at),
            "{error:?} instead of {why:?}"
        );
    };
    // The ceiling is grazed.
    let still = Shaft { g: 10.0, height: 5.0, restitution: 0.5, shakes: (0.0, 0.0) };
    let motion = still.simulation(&[0.0, 10.0]).tolerance(1e-11).run(0.0..1.5).unwrap();
    refused(NoSaltation::Grazing, 0, motion.sensitivity(&dop853()).unwrap_err());
    // Two balls meet each other and a wall at once.
    let balls = TwoBalls { e: 0.5 };
    let motion = balls.simulation(&[3.0, 1.0, -3.0, -1.0]).tolerance(1e-11).run(0.0..1.5).unwrap();
    refused(NoSaltation::Simultaneous, 0, motion.sensitivity(&dop853()).unwrap_err());
    // A puck stops in its plane.
    let puck =
        PuckIncline.simulation(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]).tolerance(1e-11).run(0.0..3.0).unwrap();
    refused(NoSaltation::SpatialSlip, 0, puck.sensitivity(&dop853()).unwrap_err());
    // No such transition.
    let none = SensitivityError::NoTransition { transition: 7 };
    assert_eq!(motion.sensitivity_of_transition(7, &dop853()).unwrap_err(), none);
    assert_eq!(motion.saltation(7).unwrap_err(), NoSaltation::OtherModes);
}

#[test]
fn an_event_is_differentiated_where_it_happens() {
    // A pendulum meets its stop: the angle there is given, the time and the speed are not.
    let hit = |start: [f64; 2]| {
        let motion = PendulumStop.simulation(&start).tolerance(TOLERANCE).run(0.0..1.0).unwrap();
        let by_start = motion.sensitivity_of_transition(0, &dop853()).unwrap();
        (motion.transitions()[0].t, motion.transitions()[0].state_after[1], by_start)
    };
    let (.., by_start) = hit([1.0, 0.1]);
    assert!(by_start.state[0].iter().all(|entry| entry.abs() < 1e-11), "{by_start:?}");
    let step = 1e-5;
    for j in 0..2 {
        let moved = |size: f64| {
            let mut start = [1.0, 0.1];
            start[j] += size;
            hit(start)
        };
        let ((t, v, _), (s, w, _)) = (moved(step), moved(-step));
        assert!(((t - s) / (2.0 * step) - by_start.time[j]).abs() < 1e-8);
        assert!(((v - w) / (2.0 * step) - by_start.state[1][j]).abs() < 1e-8);
    }
}

/// An impact at the start: a start that is a little higher meets the floor a little later.
#[test]
fn a_motion_that_begins_with_an_impact_has_the_derivatives_of_its_open_side() {
    for e in [0.5, 0.0] {
        let ball = BouncingBall { g: 9.81, e };
        let run = |start: [f64; 2]| ball.simulation(&start).tolerance(TOLERANCE).run(0.0..0.05).unwrap();
        let at_start = run([0.0, -1.0]).sensitivity(&dop853()).unwrap();
        let later = run([1e-9, -1.0]).sensitivity(&dop853()).unwrap();
        for (a, b) in at_start.iter().flatten().zip(later.iter().flatten()) {
            assert!((a - b).abs() < 1e-6, "{e}: {at_start:?} {later:?}");
        }
    }
    // Later by a unit of height over the speed.
    let motion = BouncingBall { g: 9.81, e: 0.5 }.simulate(&[0.0, -2.0], 0.0..0.05).unwrap();
    let by_start = motion.sensitivity_of_transition(0, &dop853()).unwrap();
    assert_eq!(by_start.time, [0.5, 0.0]);
    // Two at once are separated by a deviation.
    let motion = TwoBalls { e: 0.5 }.simulate(&[0.0, 0.0, -3.0, -1.0], 0.0..0.5).unwrap();
    let error = motion.sensitivity(&dop853()).unwrap_err();
    let why = NoSaltation::Simultaneous;
    assert!(matches!(error, SensitivityError::Transition { transition: 0, why: found, .. } if found == why));
}

/// A start on a zero at which the sign of a deviation decides.
#[test]
fn a_start_between_two_cases_has_no_derivative() {
    // The brake holds a cart that rests, and yields to one that is pushed harder: backwards it would be braked by both.
    let cart = GrippedCart { limit: 3.0, off: 9.0, push: 1.0 };
    let from =
        |t: f64, start: [f64; 2]| cart.simulation(&start).run(t..t + 1.0).unwrap().sensitivity(&dop853());
    assert_eq!(from(4.0, [0.0, 0.0]).unwrap_err(), SensitivityError::Start { element: "brake" });
    assert!(from(4.0, [0.0, 0.1]).is_ok() && from(1.0, [0.0, 0.0]).is_ok());
    // A ball that is lifted from its floor with no speed: down it would be thrown back.
    let lifted = |speed: f64| {
        let ball = BouncingBall { g: -9.81, e: 0.5 };
        ball.simulate(&[0.0, speed], 0.0..0.5).unwrap().sensitivity(&dop853())
    };
    assert_eq!(lifted(0.0).unwrap_err(), SensitivityError::Start { element: "floor" });
    assert!((lifted(1.0).unwrap()[0][1] - 0.5).abs() < 1e-12);
}
