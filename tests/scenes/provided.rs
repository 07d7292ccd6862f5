//! What scenes provide is that of the whole system: energy, reactions, outputs, operators, linearisations.

use guen::prelude::*;
use guen::{Guarded, Linearizable, RunningError};

use crate::compare::{assert_agree, states};
use crate::kinds::{PAIR, TIED, pair, tied};
use crate::models::{HOOP, Hoop, hoop};

const NEAR: f64 = 1e-12;

/// The part of a square matrix that belongs to some variables.
fn part<const N: usize, const FULL: usize>(a: &[[f64; FULL]; FULL], places: [usize; N]) -> [[f64; N]; N] {
    places.map(|i| places.map(|j| a[i][j]))
}

#[test]
fn all_of_the_hoop() {
    let (whole, told) = (HOOP.prepare().unwrap(), hoop::Told::from(HOOP).prepare().unwrap());
    let places: [usize; 7] = <hoop::told::Prepared as Level<f64, 7, 9>>::PLACES;
    for state in states::<9>(51, 500, 0.3, 1.4) {
        let full = hoop::State::from(state);
        let small = hoop::told::State::from(full);
        assert_agree(&[told.energy(0.0, &small)], &[whole.energy(0.0, &full)], NEAR, "energy");
        let (found, expected) = (told.reactions(0.0, &small), whole.reactions(0.0, &full));
        let (found, expected) = (<[f64; 3]>::from(found), <[f64; 3]>::from(expected));
        assert_agree(&found, &expected, NEAR, "reactions");
        let (found, expected) = (told.outputs(0.0, &small), whole.outputs(0.0, &full));
        assert_agree(&[found.height, found.nodding], &[expected.height, expected.nodding], NEAR, "scalars");
        assert_agree(&found.trace, &expected.trace, NEAR, "vector");
        let (found, expected) = (told.linearize(0.0, &small), whole.linearize(0.0, &full));
        assert_agree(found.a.as_flattened(), part(&expected.a, places).as_flattened(), NEAR, "rates");
        let (found, expected) = (told.linearize_outputs(0.0, &small), whole.linearize_outputs(0.0, &full));
        let expected = expected.c.map(|row| places.map(|j| row[j]));
        assert_agree(found.c.as_flattened(), expected.as_flattened(), NEAR, "outputs");
    }
}

/// One reaction, computed without what left: from the scene's own state.
#[test]
fn some_reactions() {
    let (whole, contact) = (HOOP.prepare().unwrap(), hoop::Contact::from(HOOP).prepare().unwrap());
    assert_eq!(hoop::contact::Reactions::NAMES, ["eta4"]);
    for state in states::<9>(52, 500, 0.3, 1.4) {
        let full = hoop::State::from(state);
        let found = contact.reactions(0.0, &full.into());
        assert_agree(&[found.eta4], &[whole.reactions(0.0, &full).eta4], NEAR, "reaction");
    }
}

#[test]
fn an_output_with_an_acceleration() {
    let (whole, nodding) = (HOOP.prepare().unwrap(), hoop::Nodding::from(HOOP).prepare().unwrap());
    for state in states::<9>(53, 100, 0.3, 1.4) {
        let full = hoop::State::from(state);
        let found = nodding.outputs(0.0, &full.into()).nodding;
        assert_agree(&[found], &[nodding.rhs(0.0, &full.into()).eta1], NEAR, "rate");
        assert_agree(&[found], &[whole.outputs(0.0, &full).nodding], NEAR, "output");
    }
}

/// An acceleration that is provided brings in what it depends on, inputs too.
#[test]
fn what_an_acceleration_needs() {
    assert_eq!(pair::jolt::State::NAMES, ["x", "y", "u", "v"]);
    assert_eq!(pair::jolt::Inputs::NAMES, ["one", "two", "both"]);
    let (whole, jolt) = (PAIR.prepare().unwrap(), pair::Jolt::from(PAIR).prepare().unwrap());
    let inputs = pair::Inputs { one: 0.3, two: -0.7, both: 0.4 };
    for state in states::<4>(57, 100, -2.0, 2.0) {
        let found = jolt.outputs(0.0, &state.into(), &inputs.into()).jolt;
        assert_agree(&[found], &[whole.outputs(0.0, &state.into(), &inputs).jolt], NEAR, "output");
        assert_agree(&[found], &[whole.rhs(0.0, &state.into(), &inputs).u], NEAR, "rate");
    }
}

/// Reactions have accelerations, of variables that nobody tracks or that are held.
#[test]
fn reactions_with_accelerations() {
    assert_eq!(tied::cord::State::NAMES, ["w", "x", "y", "s", "u", "v"]);
    assert_eq!(tied::gear::State::NAMES, ["w", "s"]);
    let (whole, cord) = (TIED.prepare().unwrap(), tied::Cord::from(TIED).prepare().unwrap());
    for state in states::<10>(58, 100, -2.0, 2.0) {
        let full = tied::State::from(state);
        let expected = whole.reactions(0.0, &full);
        // m z'' = cord, with 2 m x'' = -k y; m d'' = 0 = gear - k.
        assert_agree(&[expected.cord, expected.gear], &[-TIED.k * full.y / 2.0, TIED.k], NEAR, "by hand");
        assert_agree(&[cord.reactions(0.0, &full.into()).cord], &[expected.cord], NEAR, "cord");
        let gear = tied::Gear::of(&TIED, &full).unwrap().prepare().unwrap();
        assert_agree(&[gear.reactions(0.0, &full.into()).gear], &[expected.gear], NEAR, "gear");
    }
}

/// Operators act on functions of all coordinates, whatever the state of the scene is: here at fixed constants.
#[test]
fn operators_and_brackets() {
    use hoop::numbers as scene;
    let constants: Hoop = hoop::Numbers::default().system();
    let (whole, numbers) = (constants.prepare().unwrap(), hoop::Numbers::default().prepare().unwrap());
    for x in states::<6>(54, 50, 0.3, 1.4) {
        macro_rules! same {
            ($($X:ident)*) => { $(
                let found = scene::$X::coefficients::<f64>(&numbers, 0.0, &x);
                let expected = hoop::$X::coefficients::<f64>(&whole, 0.0, &x);
                assert_agree(&found, &expected, NEAR, stringify!($X));
            )* };
        }
        same!(X0 X1 X2 X3 X4 X5 X6);
        let found = scene::Bracket::<2, 3>::coefficients::<f64, f64>(&numbers, 0.0, &x);
        let expected = hoop::Bracket::<2, 3>::coefficients::<f64, f64>(&whole, 0.0, &x);
        assert_agree(&found, &expected, NEAR, "bracket");
        // A derivative in a direction, to the coordinate `xi` that the scene's state does not have.
        let (xi, along) = (Coordinate::<3>, 0.5 * x[0].sin() * x[1].sin());
        assert_agree(&[scene::X1.apply(&numbers, &xi, 0.0, &x)], &[along], NEAR, "derivative");
    }
    // Pairs beyond `l` too: the scene asks for all.
    let zero = scene::Bracket::<5, 6>::COEFFICIENTS;
    assert_eq!(zero, [guen::Coefficient::Zero; 6]);
}

#[test]
fn with_inputs() {
    let (whole, told) = (PAIR.prepare().unwrap(), pair::Told::from(PAIR).prepare().unwrap());
    let right = pair::Right::from(PAIR).prepare().unwrap();
    for state in states::<4>(55, 200, -2.0, 2.0) {
        let full = pair::State::from(state);
        let inputs = pair::Inputs { one: state[0], two: state[1] - 0.3, both: 0.4 };
        let (small, fewer) = (pair::told::State::from(full), inputs.into());
        let (found, expected) = (told.outputs(0.0, &small, &fewer), whole.outputs(0.0, &full, &inputs));
        assert_agree(&[found.effort], &[expected.effort], NEAR, "effort");
        assert_agree(&found.pull, &expected.pull, NEAR, "pull");
        let (found, expected) = (told.linearize(0.0, &small, &fewer), whole.linearize(0.0, &full, &inputs));
        assert_agree(found.a.as_flattened(), part(&expected.a, [0, 2]).as_flattened(), NEAR, "by state");
        assert_agree(&found.b[1], &expected.b[2], NEAR, "by input");
        let small = pair::right::State::from(full);
        // `two` and `both`, as steppers and analyses take them.
        let found = right.linearization(0.0, &small.into(), &[inputs.two, inputs.both]);
        assert_agree(found.a.as_flattened(), part(&expected.a, [1, 3]).as_flattened(), NEAR, "by state");
        assert_agree(&found.b[1], &expected.b[3][1..], NEAR, "by input");
    }
    assert_eq!(pair::right::Inputs::NAMES, ["two", "both"]);
}

/// The energy of a scene is watched as that of a system.
#[test]
fn energy_to_watch() {
    fn watched<const N: usize>(system: &impl Monitored<f64, N>, state: &[f64; N]) -> f64 {
        system.energy(0.0, state)
    }
    let unit = hoop::Unit { A: 0.3, C: 0.45 };
    let (whole, unit) = (unit.system().prepare().unwrap(), unit.prepare().unwrap());
    for state in states::<9>(56, 100, 0.3, 1.4) {
        let small = unit.project(&state);
        assert_agree(&[watched(&unit, &small)], &[watched(&whole, &state)], NEAR, "energy");
        // The edge of the chart is the same one.
        let (mut found, mut expected) = ([RunningError::exact(0.0); 1], [RunningError::exact(0.0); 1]);
        let now = RunningError::exact(0.0);
        assert_eq!(unit.singularities(now, &small.map(RunningError::once), &mut found), 1);
        assert_eq!(whole.singularities(now, &state.map(RunningError::once), &mut expected), 1);
        assert_agree(&[found[0].value], &[expected[0].value], NEAR, "edges");
    }
    let start = [1.1, 0.2, 0.4, 2.0];
    let end = Integration::new(&unit, 0.0, &start).run(&Dop853::new(1e-11, 1e-11), 10.0).unwrap();
    assert_agree(&[watched(&unit, &end.state)], &[watched(&unit, &start)], 1e-9, "energy at the end");
}
