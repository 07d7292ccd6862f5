//! Scenes in a single mode of contacts: plain systems, with their rows as constraints.

use guen::Level;

use crate::declared::*;
use crate::drawn::drawn;

#[test]
fn the_rolling_wheel_is_that_of_a_user_to_the_operation() {
    assert_eq!(wheel::rolling::COST, rolling_wheel::rolling::COST);
    let rolling = wheel::Rolling::default().prepare().unwrap();
    let by_hand = RollingWheel::default().prepare().unwrap();
    let state = wheel::rolling::State { speed_ahead: 3.0 };
    let rate = rolling.rhs(0.0, &state, &wheel::rolling::Inputs { torque: 7.0 });
    // (m + J/a^2) v' = torque/a - c v.
    let expected = (7.0 / 0.3 - 0.5 * 3.0) / (20.0 + 1.0 / 0.09);
    assert!((rate.speed_ahead - expected).abs() < 1e-15);
    let whole = rolling_wheel::State { speed_ahead: 3.0, z: 0.3, ..Default::default() };
    assert_eq!(
        by_hand.rhs(0.0, &whole, &rolling_wheel::Inputs { torque: 7.0 }).speed_ahead,
        rate.speed_ahead
    );
}

/// What a scene leaves out follows from what it keeps, and reactions are those of the mode of the whole system.
#[test]
fn what_follows_and_what_presses() {
    let wheel = Wheel::default().prepare().unwrap();
    let turning = wheel::Turning::default().prepare().unwrap();
    let inputs = wheel::turning::Inputs { torque: 7.0 };
    let state = wheel::turning::State { phi: 2.0, spin: 4.0 };
    let mut full = [9.0; 6];
    turning.determine(0.0, &state.into(), &mut full);
    // Without slip the speed is `a` times the spin, and nothing rises.
    assert!((full[3] - 0.3 * 4.0).abs() < 1e-15 && full[4] == 0.0, "{full:?}");
    let whole = state.within(wheel::State { x: 1.0, z: 0.3, speed_ahead: 1.2, ..Default::default() });
    let driven = wheel.driven(wheel::Inputs { torque: 7.0 });
    let sticking = wheel::Mode { tyre: wheel::Tyre::Stick };
    let rate = guen::System::rhs(&driven.in_mode(sticking, [false]), 0.0, &whole.into());
    let own = turning.rhs(0.0, &state, &inputs);
    assert!((own.spin - rate[5]).abs() < 1e-14 && own.phi == rate[2]);
    let outputs = driven.outputs_in_mode(sticking, 0.0, &whole);
    let force = turning.outputs(0.0, &state, &inputs).force;
    let reactions = turning.reactions(0.0, &state, &inputs);
    for (own, whole) in force.into_iter().zip(outputs.force) {
        assert!((own - whole).abs() < 1e-11, "{own} {whole}");
    }
    // The floor carries the weight, and the road drives: m v' = F - c v.
    assert!((force[0] - 20.0 * 9.81).abs() < 1e-11);
    assert!((force[1] - 20.0 * 0.3 * own.spin - 0.5 * 1.2).abs() < 1e-12);
    assert!((reactions.tyre_n - force[0]).abs() < 1e-12 && (reactions.tyre_t - force[1]).abs() < 1e-13);
    let flying = wheel::Flying::default().prepare().unwrap();
    let free = wheel::flying::State { speed_ahead: 1.0, up: 2.0, spin: 3.0 };
    let inputs = wheel::flying::Inputs { torque: 7.0 };
    assert_eq!(flying.rhs(0.0, &free, &inputs).up, -9.81);
    assert_eq!(flying.outputs(0.0, &free, &inputs).force, [0.0; 3]);
}

/// The hoop that sticks to its floor is the hoop of the paper: its rates, its reactions, its operations.
#[test]
fn a_hoop_that_sticks_is_that_of_the_paper() {
    let whole = hoop_on_floor::Whole::default().prepare().unwrap();
    let hoop = Hoop::default().prepare().unwrap();
    let mut seed = 11;
    for _ in 0..50 {
        let state: [f64; 9] = core::array::from_fn(|_| 0.2 + drawn(&mut seed));
        let mut rolling = hoop::State::from(state);
        rolling.zeta = 2.0 * rolling.theta.sin();
        let hoop::State { theta, psi, phi, xi, eta, zeta, eta1, eta2, eta3 } = rolling;
        let own = hoop_on_floor::whole::State { theta, psi, phi, xi, eta, zeta, eta1, eta2, eta3 };
        let (found, expected) = (whole.rhs(0.0, &own), hoop.rhs(0.0, &rolling));
        let (found, expected): ([f64; 9], [f64; 9]) = (found.into(), expected.into());
        for i in 0..9 {
            assert!(
                (found[i] - expected[i]).abs() < 1e-13 * (1.0 + expected[i].abs()),
                "{i}: {found:?} {expected:?}"
            );
        }
    }
    assert_eq!(hoop_on_floor::whole::COST, hoop::COST);
}

/// Rows of contacts that are entries of arrays and belong to instances.
#[test]
fn reactions_of_arrays_and_of_instances() {
    let held = row::Held::default().prepare().unwrap();
    let state = row::held::State { x: 1.0, u: 2.0, ..Default::default() };
    let reactions = held.reactions(0.0, &state);
    assert_eq!((reactions.floor_n_0, reactions.a.c_n), (3.0, 5.0));
}
