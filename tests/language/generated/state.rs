//! The state: its fields in order, its conversions, and the way from velocities.

use guen::prelude::*;
use nalgebra::SVector;

hoop!(guen::mechanical_system);
particle_pendulum!(guen::mechanical_system);
turntable!(guen::mechanical_system);

fn tilted() -> hoop::State {
    hoop::State {
        theta: 1.2,
        psi: 0.3,
        phi: 0.1,
        xi: 2.0,
        eta: -1.0,
        zeta: 0.9,
        eta1: 0.1,
        eta2: 0.4,
        eta3: 5.0,
    }
}

const ENTRIES: [f64; 9] = [1.2, 0.3, 0.1, 2.0, -1.0, 0.9, 0.1, 0.4, 5.0];

#[test]
fn converts_from_and_to_arrays_and_vectors() {
    let state = tilted();
    assert_eq!(<[f64; 9]>::from(state), ENTRIES);
    assert_eq!(hoop::State::from(ENTRIES), state);
    let vector: SVector<f64, 9> = state.into();
    assert_eq!(vector, SVector::from(ENTRIES));
    assert_eq!(hoop::State::from(vector), state);
    assert_eq!(hoop::State::NAMES, ["theta", "psi", "phi", "xi", "eta", "zeta", "eta1", "eta2", "eta3"]);
    assert_eq!(<[f64; 6]>::from(state.coordinates())[..], ENTRIES[..6]);
    assert_eq!(hoop::State::default(), hoop::State::from([0.0; 9]));
}

#[test]
fn velocities_go_there_and_back() {
    let system = Hoop::new(0.8, 0.5, 1.0).prepare().unwrap();
    let state = tilted();
    let velocities = system.velocities(0.0, &state);
    assert_eq!(velocities.theta, state.eta1);
    let (found, residuals) = hoop::State::from_velocities(&system, 0.0, &state.coordinates(), &velocities);
    let found: [f64; 9] = found.into();
    for (x, y) in found.iter().zip(&ENTRIES) {
        assert!((x - y).abs() < 1e-14, "{x} and {y}");
    }
    assert!(residuals.iter().all(|r| r.abs() < 1e-14), "{residuals:?}");
}

/// A velocity that the constraints forbid shows in the residual of its constraint, and only there.
#[test]
fn impossible_velocities_leave_residuals() {
    let system = Hoop::new(0.8, 0.5, 1.0).prepare().unwrap();
    let state = tilted();
    let mut velocities = system.velocities(0.0, &state);
    velocities.zeta += 0.25;
    let (found, [eta4, eta5, eta6]) =
        hoop::State::from_velocities(&system, 0.0, &state.coordinates(), &velocities);
    assert!((found.eta3 - state.eta3).abs() < 1e-14);
    assert!(eta4.abs() < 1e-14 && eta5.abs() < 1e-14 && (eta6 - 0.25).abs() < 1e-14);
}

/// With terms without velocity, (1.1): the table's speed enters the residuals.
#[test]
fn moving_constraints_have_residuals_at_rest() {
    let system = Turntable::new(0.7, 0.25, 1.5, 0.8, 1.3).prepare().unwrap();
    let t = 0.4;
    let place = turntable::Coordinates { x: 0.4, y: -0.2, psi: 0.3, theta: 1.2, phi: -0.5 };
    let (state, [east, north]) = turntable::State::from_velocities(&system, t, &place, &Default::default());
    let speed = 1.5 + 0.8 * (1.3 * t).sin();
    assert_eq!((state.eta1, state.eta2, state.eta3), (0.0, 0.0, 0.0));
    assert!((east + 0.2 * speed).abs() < 1e-15 && (north + 0.4 * speed).abs() < 1e-15);
}

/// Residuals of a state: velocity constraints hold by construction, positions may not.
#[test]
fn residuals_are_positions_where_constraints_are_holonomic() {
    let system = ParticlePendulum::new(1.0, 2.0).prepare().unwrap();
    let on = particle_pendulum::State { x: 1.2, y: -1.6, omega: 3.0 };
    let off = particle_pendulum::State { y: -1.7, ..on };
    assert!(system.residuals(0.0, &on).rod.abs() < 1e-15);
    assert!((system.residuals(0.0, &off).rod - (1.44 + 2.89 - 4.0)).abs() < 1e-15);
    assert!((Monitored::residual(&system, 0.0, &off.into()) - 0.33).abs() < 1e-15);
    let hoop = Hoop::new(0.8, 0.5, 1.0).prepare().unwrap();
    let residuals = <[f64; 3]>::from(hoop.residuals(0.0, &tilted()));
    assert!(residuals.iter().all(|r| r.abs() < 1e-14), "{residuals:?}");
    assert_eq!(Monitored::residual(&hoop, 0.0, &ENTRIES), 0.0);
}
