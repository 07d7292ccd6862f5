//! `fix` against the whole system at the same values, and the conversions between the constants of both.

use guen::{ConstantsError, Level};

use crate::compare::{assert_agree, states};
use crate::models::{APPELL, HOOP, Hoop, SLED, Sled, appell, hoop, sled};

const NEAR: f64 = 1e-12;

/// The part of a square matrix that belongs to some variables, row by row.
fn part<const FULL: usize>(a: &[[f64; FULL]; FULL], places: &[usize]) -> Vec<f64> {
    places.iter().flat_map(|i| places.iter().map(|j| a[*i][*j])).collect()
}

#[test]
fn everything_of_the_flat_sled() {
    let scene = sled::Flat { m: 1.3, alpha: 0.4, k: 0.7, g: 9.81 };
    let constants = Sled { incline: 0.0, beta: 0.0, ..SLED };
    assert_eq!(scene.system(), constants);
    let (whole, scene) = (constants.prepare().unwrap(), scene.prepare().unwrap());
    for state in states::<5>(21, 300, -2.0, 2.0) {
        let full = sled::State::from(state);
        let small = sled::flat::State::from(full);
        assert_agree(&[scene.energy(0.0, &small)], &[whole.energy(0.0, &full)], NEAR, "energy");
        let found = scene.reactions(0.0, &small).eta3;
        assert_agree(&[found], &[whole.reactions(0.0, &full).eta3], NEAR, "reaction");
        let places: [usize; 2] = <sled::flat::Prepared as Level<f64, 2, 5>>::PLACES;
        let expected = part(&whole.linearize(0.0, &full).a, &places);
        assert_agree(scene.linearize(0.0, &small).a.as_flattened(), &expected, NEAR, "linearisation");
    }
}

/// A parameter that is held is a constant: it is in the energy, the reactions and the derivatives of all of them.
#[test]
fn everything_with_a_held_parameter() {
    let whole = APPELL.prepare().unwrap();
    for state in states::<9>(22, 300, 0.4, 1.3) {
        let full = appell::State::from(state);
        let scene = appell::Measured::of(&APPELL, &full).unwrap();
        assert_eq!(scene.eta3, full.eta3);
        assert_eq!(scene.system(), APPELL);
        let scene = scene.prepare().unwrap();
        let small = appell::measured::State::from(&full);
        assert_agree(&[scene.energy(0.0, &small)], &[whole.energy(0.0, &full)], NEAR, "energy");
        let found: [f64; 3] = scene.reactions(0.0, &small).into();
        let expected: [f64; 3] = whole.reactions(0.0, &full).into();
        assert_agree(&found, &expected, NEAR, "reactions");
        let (found, expected) = (scene.outputs(0.0, &small).axial, whole.outputs(0.0, &full).axial);
        assert_agree(&[found], &[expected], NEAR, "output");
        assert_agree(&[found], &[full.eta3 * full.theta.cos() * full.eta1], NEAR, "output by hand");
        let places: [usize; 3] = <appell::measured::Prepared as Level<f64, 3, 9>>::PLACES;
        let expected = part(&whole.linearize(0.0, &full).a, &places);
        assert_agree(scene.linearize(0.0, &small).a.as_flattened(), &expected, NEAR, "linearisation");
    }
}

/// At other values of what is held the scene is another one.
#[test]
fn what_is_held_matters() {
    let state = appell::rolling::State { theta: 0.8, eta1: 0.3, eta2: 0.6 };
    let rate = |eta3: f64| {
        let scene = appell::Rolling { a: 0.75, A: 0.6, C: 0.9, g: 9.81, eta3 }.prepare().unwrap();
        (scene.rhs(0.0, &state).eta1, scene.energy(0.0, &state))
    };
    let (slow, fast) = (rate(1.0), rate(2.0));
    // eta1' has -(C + a^2) eta2 eta3/(A + a^2), and the energy (C + a^2) eta3^2/2.
    let (axial, across) = (0.9 + 0.75 * 0.75, 0.6 + 0.75 * 0.75);
    assert_agree(&[fast.0 - slow.0], &[-axial * 0.6 / across], NEAR, "rate");
    assert_agree(&[fast.1 - slow.1], &[1.5 * axial], NEAR, "energy");
}

#[test]
fn constants_of_the_system_that_contradict() {
    let fits = Hoop { a: 1.0, ..HOOP };
    let scene = hoop::Unit::try_from(fits).unwrap();
    assert_eq!(scene, hoop::Unit { A: HOOP.A, C: HOOP.C });
    assert_eq!(scene.system(), fits);
    assert_eq!(hoop::Unit::of(&fits, &hoop::State::default()), Ok(scene));
    let refused = ConstantsError::Contradicted { name: "a", fixed: 1.0, value: 0.5 };
    assert_eq!(hoop::Unit::try_from(HOOP), Err(refused));
    assert_eq!(hoop::Unit::of(&HOOP, &hoop::State::default()), Err(refused));
    assert_eq!(refused.to_string(), "constant `a` is 0.5, but the scene fixes it at 1");
    // The first of two in the order of the scene; one that is made of another is compared with its value.
    let wrong = Hoop { C: 0.3, g: 1.6, ..HOOP };
    let refused = ConstantsError::Contradicted { name: "C", fixed: 0.25, value: 0.3 };
    assert_eq!(hoop::Numbers::try_from(wrong), Err(refused));
    let nan = Hoop { a: f64::NAN, ..HOOP };
    assert!(hoop::Numbers::try_from(nan).is_err());
    let all = hoop::Numbers::try_from(HOOP).unwrap();
    assert_eq!(all.system(), HOOP);
}

#[test]
fn what_is_not_fixed_is_checked_as_ever() {
    let refused = hoop::Unit { A: -1.0, C: 1.0 }.prepare().unwrap_err();
    assert_eq!(refused, ConstantsError::OutOfBound { name: "A", bound: "A > 0", value: -1.0 });
    let held = appell::Rolling { a: 0.75, A: 0.6, C: 0.9, g: 9.81, eta3: f64::INFINITY }.prepare();
    assert_eq!(held, Err(ConstantsError::NotFinite { name: "eta3", value: f64::INFINITY }));
    let contradicted = appell::Spinning::of(&appell_with(0.5), &appell::State::default());
    assert_eq!(contradicted, Err(ConstantsError::Contradicted { name: "a", fixed: 0.75, value: 0.5 }));
}

fn appell_with(a: f64) -> crate::models::Appell {
    crate::models::Appell { a, ..APPELL }
}

guen::mechanical_system! {
    /// Two carts on slopes.
    system Slopes {
        count n = 2;
        constants   { m: kg > 0, slope[n]: deg = 5, g: m/s^2 = 9.81 }
        coordinates { x[n]: m }
        parameters  { for i in 0..n { v[i] = dot(x[i]); } }
        particles   { for i in 0..n { m at x[i]*vec(cos(slope[i]), sin(slope[i])); } }
        gravity     = vec(0, -g);
        scene One   { track v[0]; fix slope[0] = 30; }
        scene Both  { for i in 0..n { track v[i]; fix slope[i] = 30*(i + 1); } }
    }
}

#[test]
fn entries_are_fixed_in_degrees() {
    use slopes::{Both, One};
    let system = Slopes { slope: [30.0, 60.0], ..Slopes::new(2.0) };
    let one = One::of(&system, &Default::default()).unwrap().prepare().unwrap();
    let rates = one.rhs(0.0, &slopes::one::State::default());
    assert!(f64::abs(rates.v_0 + 9.81 / 2.0) < 1e-14);
    let both = Both::of(&system, &Default::default()).unwrap().prepare().unwrap();
    let rates = both.rhs(0.0, &slopes::both::State::default());
    assert!(f64::abs(rates.v[0] + 9.81 / 2.0) < 1e-14);
    assert!(f64::abs(rates.v[1] + 9.81 * 0.75_f64.sqrt()) < 1e-14);
    // In the constants of the system, too, these are degrees.
    assert!(Both::of(&Slopes::new(2.0), &Default::default()).is_err());
    assert_eq!(both.constants().system().slope, [30.0, 60.0]);
}
