//! Coordinates that fulfil the constraints on positions, and keeping them fulfilled.

use guen::prelude::*;
use guen::{Positions, PositionsError, project, projected};

use crate::balls::{BeltBall, belt_ball};
use crate::linkages::{FourBar, WireBead, four_bar, wire_bead};

fn linkage() -> four_bar::Prepared {
    FourBar { a: 0.4, b: 1.1, c: 0.8, d: 1.0, rho: 2.0, k: 0.0, g: 9.81 }.prepare().unwrap()
}

/// The gradients are the derivatives of the left sides.
#[test]
fn gradients_are_those_of_the_left_sides() {
    let bead = WireBead { m: 1.2, nu: 0.7, c: 0.2, g: 9.81 }.prepare().unwrap();
    let varied = bead.lift::<guen::Dual<f64, 3>>();
    let x = [0.3, -0.4, 0.9];
    let seeds = std::array::from_fn(|i| guen::Dual::variable(x[i], i));
    let expected = varied.gaps(guen::Dual::constant(0.6), &seeds).map(|f| f.tangent);
    for (found, expected) in bead.linearized(0.6, &x).1.iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-14);
    }
}

#[test]
fn a_linkage_is_closed_for_a_given_crank() {
    let linkage = linkage();
    let guess = four_bar::Coordinates { q1: 0.8, q2: 0.5, q3: 1.5 };
    let found = linkage.consistent(0.0, &guess, &["q1"]).unwrap();
    assert_eq!(found.q1, 0.8);
    let gaps = linkage.gaps(0.0, &found.into());
    assert!(gaps.iter().all(|gap| gap.abs() < 1e-15), "{gaps:?}");
    // The other assembly, from a guess with the joint below.
    let below = four_bar::Coordinates { q2: -1.0, q3: -1.5, ..guess };
    let other = linkage.consistent(0.0, &below, &["q1"]).unwrap();
    assert!(other.q3 < 0.0 && found.q3 > 0.0 && other.q1 == 0.8);
    // Nothing given: a point near the guess.
    let near = linkage.consistent(0.0, &guess, &[]).unwrap();
    assert!((near.q1 - guess.q1).abs() > 1e-6 && linkage.gaps(0.0, &near.into())[0].abs() < 1e-15);
}

#[test]
fn what_cannot_be_found_is_said() {
    // The crank is too long to turn fully: at this angle the rest does not reach.
    let short = FourBar { a: 1.0, b: 0.6, c: 0.5, d: 1.0, rho: 2.0, k: 0.0, g: 9.81 }.prepare().unwrap();
    let guess = four_bar::Coordinates { q1: 2.5, q2: 0.5, q3: 1.5 };
    let error = short.consistent(0.0, &guess, &["q1"]).unwrap_err();
    assert!(
        matches!(error, PositionsError::NotFound { residual } | PositionsError::Singular { residual } if residual > 0.1),
        "{error}"
    );
    assert_eq!(
        short.consistent(0.0, &guess, &["q4"]).unwrap_err(),
        PositionsError::UnknownCoordinate { name: "q4" }
    );
    let error = short.consistent(0.0, &guess, &["q1", "q2"]).unwrap_err();
    assert_eq!(error, PositionsError::TooManyGiven { left: 1, constraints: 2 });
    assert_eq!(error.to_string(), "1 coordinates are left to fulfil 2 constraints on positions");
    let lost = four_bar::Coordinates { q1: f64::NAN, ..guess };
    assert_eq!(short.consistent(0.0, &lost, &["q2"]).unwrap_err(), PositionsError::NotFinite);
}

/// The correction is the shortest: along the gradients.
#[test]
fn a_state_is_moved_the_shortest_way() {
    let ball = BeltBall { m: 1.0, a: 0.8, A: 0.5, B: 0.4, C: 0.3, u: 0.0, nu: 0.0 }.prepare().unwrap();
    let mut state = [1.2, 0.4, -0.9, 0.3, 5.0, 6.0, 7.0, 8.0, 9.0];
    let before = state;
    let length = before[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
    let moved = project(&ball, 0.0, &mut state).unwrap();
    assert!((moved - (length - 1.0)).abs() < 1e-14);
    for i in 0..4 {
        assert!((state[i] - before[i] / length).abs() < 1e-14);
    }
    assert_eq!(state[4..], before[4..]);
    let kept = belt_ball::State::from(state);
    let residuals: [f64; 3] = ball.residuals(0.0, &kept).into();
    assert!(residuals.iter().all(|r| r.abs() < 1e-14), "{residuals:?}");
}

/// With long steps the linkage opens; restored after every step it stays closed to rounding, with both methods, and
/// while the constraints move.
#[test]
fn drift_does_not_accumulate() {
    let linkage = linkage();
    let coordinates =
        linkage.consistent(0.0, &four_bar::Coordinates { q1: 0.8, q2: 0.5, q3: 1.5 }, &["q1"]).unwrap();
    let start: [f64; 4] =
        four_bar::State { q1: coordinates.q1, q2: coordinates.q2, q3: coordinates.q3, turn: 3.0 }.into();
    let driven = linkage.driven(four_bar::Inputs { motor: 0.0 });
    let worst = |restored: bool| {
        let mut most = 0.0_f64;
        let watch = |t: f64, x: &[f64; 4]| {
            most = most.max(driven.residual(t, x));
            ControlFlow::Continue(())
        };
        let method = Rk4::new(0.02);
        if restored {
            method.integrate(&projected(&driven), 0.0, &start, 20.0, watch).unwrap();
        } else {
            method.integrate(&driven, 0.0, &start, 20.0, watch).unwrap();
        }
        most
    };
    let (free, kept) = (worst(false), worst(true));
    assert!(free > 1e-7 && kept < 1e-14, "{free:e} {kept:e}");

    let bead = WireBead { m: 1.2, nu: 0.7, c: 0.2, g: 9.81 }.prepare().unwrap();
    let begin = wire_bead::State { x: 0.5, y: 0.0, z: 0.25, out: 0.1 };
    let mut most = 0.0_f64;
    let restored = projected(&bead);
    Dop853::new(1e-6, 1e-6)
        .integrate(&restored, 0.0, &begin.into(), 5.0, |t, x| {
            most = most.max(restored.residual(t, x));
            ControlFlow::Continue(())
        })
        .unwrap();
    assert!(most < 1e-14, "{most:e}");
}

guen::mechanical_system! {
    /// A crank with its slider, and a wheel that has turned many times.
    pub system DeadPoint {
        constants { r = 1, l = 2 }
        coordinates { turned, crank, rod, slider }
        holonomic { across: r*sin(crank) = l*sin(rod); ahead: r*cos(crank) + l*cos(rod) = slider; }
        kinetic_energy = dot(turned)^2 + dot(crank)^2 + dot(slider)^2;
    }
}

/// At a dead point a step of Newton's method has no end; and a large angle says nothing of the accuracy of a small one.
#[test]
fn guesses_near_dead_points_and_beside_large_angles_are_followed() {
    let system = DeadPoint::default().prepare().unwrap();
    let dead = core::f64::consts::FRAC_PI_2;
    let all = ["crank", "turned"];
    for (turned, rod, given) in [
        (0.0, dead, 1),
        (0.0, dead - 1e-11, 1),
        (0.0, dead - 1e-7, 2),
        (1e9, 0.7, 1),
        (-1e11, -0.3, 1),
        (1e9, 0.7, 2),
        (1e9, dead, 2),
    ] {
        let guess = dead_point::Coordinates { turned, crank: 0.3, rod, slider: 2.0 };
        let found = system.consistent(0.0, &guess, &all[..given]).unwrap();
        let near = f64::asin(f64::sin(0.3) / 2.0);
        let slider = f64::cos(0.3) + 2.0 * near.cos();
        assert!(
            (found.rod - near).abs() < 1e-14 && (found.slider - slider).abs() < 1e-14,
            "{guess:?} {found:?}"
        );
        assert_eq!((found.turned, found.crank), (turned, 0.3));
    }
}
