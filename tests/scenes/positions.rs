//! Scenes of systems with holonomic equations: kept whole, kept in part, eliminated, at fixed values.

use guen::prelude::*;
use guen::{Level, Positions, projected};

use crate::compare::{assert_agree, assert_same_rates, states};

guen::mechanical_system! {
    /// Crank, coupler and rocker, and a disc on the rocker's pivot that turns freely.
    pub system FourBar {
        constants { a > 0, b > 0, c > 0, d > 0, rho > 0, I > 0, g = 9.81 }
        inputs { motor, brake }
        coordinates { q1, q2, q3, q4 }
        let crank = a*rot_z(q1).x;
        let coupler = b*rot_z(q2).x;
        let rocker = c*rot_z(q3).x;
        bodies {
            one { mass: rho*a, inertia: diag(0, 0, rho*a^3/12), center: crank/2, orientation: rot_z(q1) }
            two { mass: rho*b, inertia: diag(0, 0, rho*b^3/12), center: crank + coupler/2, orientation: rot_z(q2) }
            three { mass: rho*c, inertia: diag(0, 0, rho*c^3/12), center: vec(d, 0) + rocker/2, orientation: rot_z(q3) }
            disc { mass: 0, inertia: diag(0, 0, I), center: vec(d, 0), orientation: rot_z(q4) }
        }
        gravity = vec(0, -g);
        parameters { turn = dot(q1); spin = dot(q4); }
        holonomic { closure: crank + coupler = vec(d, 0) + rocker; }
        forces { motor along turn; brake along spin; }
        scene Linkage { track q1; }
        scene Disc { track q4; }
        scene Weightless { track q1, q3; fix g = 0; provide energy, reactions; }
    }
}

guen::mechanical_system! {
    /// Masses on a rope over pulleys, in a field that is not uniform; `s` stays where it is put.
    pub system Ropes {
        constants { m > 0, k, l }
        coordinates { s, x, y, z, p, q }
        parameters { u = dot(x); w = dot(p); }
        constraints { still: dot(s) = 0; }
        holonomic {
            first: 2*y + x = s + l;
            second: z - y*3 = l;
            ring: p^2 + q^2 = 1;
        }
        kinetic_energy = m/2*(dot(s)^2 + dot(x)^2 + 2*dot(y)^2 + 3*dot(z)^2) + m/2*(dot(p)^2 + dot(q)^2);
        potential_energy = k/4*z^4 + k*sin(y)*(p^2 + q^2);
        scene Held { track x; fix s; }
        scene Free { track x; }
        scene End { track z; fix s, l = 2; }
        scene Both { track x, y, z; provide energy; }
        scene Ring { track p; }
    }
}

const BARS: FourBar = FourBar { a: 0.4, b: 1.1, c: 0.8, d: 1.0, rho: 1.3, I: 0.2, g: 9.81 };
const ROPES: Ropes = Ropes { m: 1.3, k: 0.7, l: 1.6 };

/// Crank angles all around, with the linkage closed.
fn closed_states() -> Vec<[f64; 6]> {
    let whole = BARS.prepare().unwrap();
    let mut coordinates = four_bar::Coordinates { q1: 0.0, q2: 0.7, q3: 1.5, q4: 0.3 };
    let mut found = Vec::new();
    for k in 0..40 {
        coordinates.q1 = 0.15 * f64::from(k);
        coordinates = whole.consistent(0.0, &coordinates, &["q1", "q4"]).unwrap();
        let four_bar::Coordinates { q1, q2, q3, q4 } = coordinates;
        found.push([q1, q2, q3, q4, 1.0 - 0.1 * f64::from(k), 0.4]);
    }
    found
}

/// A scene with every coordinate of an equation has the equation too.
#[test]
fn equations_that_are_kept() {
    assert_eq!(four_bar::linkage::State::NAMES, ["q1", "q2", "q3", "turn"]);
    assert_eq!(four_bar::linkage::Inputs::NAMES, ["motor"]);
    let whole = BARS.prepare().unwrap();
    let linkage = four_bar::Linkage::from(BARS).prepare().unwrap();
    let inputs = four_bar::Inputs { motor: 0.7, brake: 0.1 };
    let states = closed_states();
    let (driven, scene) = (whole.driven(inputs), linkage.driven(inputs.into()));
    assert_same_rates(&driven, &scene, &states, 1e-12);
    for state in &states {
        let mut open = *state;
        open[1] += 0.01;
        let small = scene.project(&open);
        let found: [f64; 2] = linkage.residuals(0.0, &small.into()).into();
        let all: [f64; 2] = whole.residuals(0.0, &open.into()).into();
        assert_agree(&found, &all, 1e-14, "residuals");
        assert!(found.iter().any(|gap| gap.abs() > 1e-3));
        let (gaps, slopes) = linkage.linearized(0.0, &[open[0], open[1], open[2]]);
        let expected = whole.linearized(0.0, &[open[0], open[1], open[2], open[3]]);
        assert_agree(&gaps, &expected.0, 1e-14, "gaps");
        let expected = expected.1.map(|[a, b, c, d]| {
            assert_eq!(d, 0.0);
            [a, b, c]
        });
        assert_agree(slopes.as_flattened(), expected.as_flattened(), 1e-14, "gradients");
        let guess = four_bar::linkage::Coordinates { q1: open[0], q2: open[1], q3: open[2] };
        let found = linkage.consistent(0.0, &guess, &["q1"]).unwrap();
        assert_agree(&[found.q1, found.q2, found.q3], &state[..3], 1e-9, "closed again");
    }
}

/// A run of the scene stays on its equations when it is put back, as a run of the system.
#[test]
fn a_run_that_is_put_back() {
    let start = closed_states()[3];
    let linkage = four_bar::Linkage::from(BARS).prepare().unwrap();
    let scene = linkage.driven(four_bar::linkage::Inputs { motor: 0.5 });
    let end = Integration::new(&projected(scene), 0.0, &scene.project(&start))
        .run(&Dop853::new(1e-8, 1e-8), 5.0)
        .unwrap();
    let residuals: [f64; 2] = linkage.residuals(5.0, &end.state.into()).into();
    assert_agree(&residuals, &[0.0; 2], 1e-12, "residuals");
}

#[test]
fn equations_at_fixed_values() {
    // The disc's energy is the reason for `spin`.
    assert_eq!(four_bar::weightless::State::NAMES, ["q1", "q2", "q3", "turn", "spin"]);
    let FourBar { a, b, c, d, rho, I, .. } = BARS;
    let scene = four_bar::Weightless { a, b, c, d, rho, I };
    let (whole, scene) = (scene.system().prepare().unwrap(), scene.prepare().unwrap());
    let inputs = four_bar::Inputs { motor: 0.7, brake: 0.2 };
    for state in closed_states() {
        let full = four_bar::State::from(state);
        let small = four_bar::weightless::State::from(full);
        assert_agree(&[scene.energy(0.0, &small)], &[whole.energy(0.0, &full)], 1e-12, "energy");
        let found: [f64; 2] = scene.reactions(0.0, &small, &inputs.into()).into();
        let expected: [f64; 2] = whole.reactions(0.0, &full, &inputs).into();
        assert_agree(&found, &expected, 1e-11, "reactions");
    }
}

/// States of the ropes that fulfil their equations.
fn rope_states(l: f64) -> Vec<[f64; 8]> {
    let free = states::<5>(61, 100, -1.0, 1.0);
    let of = |[s, x, angle, u, w]: [f64; 5]| {
        let y = (s + l - x) / 2.0;
        [s, x, y, l + 3.0 * y, angle.cos() * 0.9, (1.0 - (angle.cos() * 0.9).powi(2)).sqrt(), u, w]
    };
    free.into_iter().map(of).collect()
}

/// What the equations say of what is kept is what it is in the state, wherever it was.
fn assert_determined<S: Level<f64, N, 8>, const N: usize>(scene: &S, state: &[f64; 8], expected: &[usize]) {
    assert_eq!(S::DETERMINED, expected);
    let mut full = *state;
    expected.iter().for_each(|place| full[*place] = f64::NAN);
    scene.determine(0.0, &scene.project(state), &mut full);
    assert_agree(&full, state, 1e-14, "coordinates");
}

/// Holonomic equations say what an eliminated coordinate would be, with what is held as a constant.
#[test]
fn coordinates_that_are_eliminated() {
    assert_eq!(ropes::held::State::NAMES, ["x", "u"]);
    // Either of two coordinates beside `x` would do; the first equations eliminate first.
    assert_eq!(ropes::free::State::NAMES, ["x", "z", "u"]);
    assert_eq!(ropes::end::State::NAMES, ["z", "u"]);
    let whole = ROPES.prepare().unwrap();
    let states = rope_states(ROPES.l);
    assert_same_rates(&whole, &ropes::Free::from(ROPES).prepare().unwrap(), &states, 1e-12);
    assert_same_rates(&whole, &ropes::Both::from(ROPES).prepare().unwrap(), &states, 1e-12);
    assert_same_rates(&whole, &ropes::Ring::from(ROPES).prepare().unwrap(), &states, 1e-12);
    for state in states {
        let scene = ropes::Held::of(&ROPES, &state.into()).unwrap().prepare().unwrap();
        assert_same_rates(&whole, &scene, &[state], 1e-12);
        assert_determined(&scene, &state, &[2, 3]);
        // `x` and `z` are kept: the second equation says `y`, and then the first one says `s`.
        assert_determined(&ropes::Free::from(ROPES).prepare().unwrap(), &state, &[2, 0]);
        assert_determined(&ropes::Both::from(ROPES).prepare().unwrap(), &state, &[0]);
    }
    let other = Ropes { l: 2.0, ..ROPES };
    let whole = other.prepare().unwrap();
    for state in rope_states(2.0) {
        let scene = ropes::End::of(&other, &state.into()).unwrap().prepare().unwrap();
        assert_same_rates(&whole, &scene, &[state], 1e-12);
    }
}
