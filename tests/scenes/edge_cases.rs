//! Scenes at the edges: several of one system, without `track`, over other reals, without constants, with everything.

use guen::prelude::*;

use crate::compare::{assert_agree, assert_same_rates, states};
use crate::kinds::{KEPLER, Kepler, PAIR, Pair, kepler, pair};
use crate::models::{HOOP, Hoop, hoop};

guen::mechanical_system! {
    /// Names that need care, in a scene too; `Σ` and the keyword are names of scenes.
    pub system Raw {
        constants { r#struct > 0, r#match = 2 }
        inputs { r#move }
        coordinates { r#type, r#fn }
        parameters { r#loop = dot(r#type); r#if = dot(r#fn)*r#match; }
        kinetic_energy = r#struct/2*(r#loop^2 + r#if^2);
        potential_energy = r#struct*(r#type^2 + r#fn^4);
        forces { r#move along r#if; }
        outputs { r#where = r#type + r#fn; }
        scene Σ { track r#type; fix r#struct = 1, r#match = 3; }
        scene Loop { track r#if; provide r#where; }
        scene state1 { track r#fn; }
    }
}

guen::mechanical_system! {
    /// Scenes that differ by nothing, and one for a system without constants.
    system Bare {
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = 1/2*(u^2 + v^2);
        force_function = -x^4 - y^2;
        scene One { track x; }
        scene Other { track x; provide energy, operators, linearization; }
    }
}

guen::mechanical_system! {
    /// The pivots of the mass matrix are `m`, which is constant already, and what becomes constant in the scenes.
    system Settled {
        constants { m > 0, k > 0 }
        coordinates { q, r, x, y }
        parameters { v = dot(q); u = dot(x); w = dot(r) + r*u; z = k*dot(y); }
        kinetic_energy = m*u^2 + v^2 + (v - dot(r))^2 + m*z^2;
        scene Only { track v; }
        scene Two { track v, z; }
        scene Fixed { track v; fix k = 2; }
    }
}

guen::mechanical_system! {
    /// The same without a pivot that is constant in the system.
    system Unsettled {
        constants { m > 0 }
        coordinates { q, r, x }
        parameters { v = dot(q); u = dot(x); w = dot(r) + r*u; }
        kinetic_energy = m*u^2 + v^2 + (v - dot(r))^2;
        scene Only { track v; }
    }
}

guen::mechanical_system! {
    /// Entries that are left of arrays, beside values that have the names of their fields.
    pub system Alone {
        constants { m[2] > 0 = 2, m_1 > 0 = 3 }
        inputs { u[2], u_0 }
        coordinates { q[2], q_0 }
        parameters { v[0] = dot(q[0]); v[1] = dot(q[1]); v_0 = dot(q_0); }
        kinetic_energy = m[0]/2*v[0]^2 + m[1]/2*v[1]^2 + m_1/2*v_0^2;
        potential_energy = q[0]^2/2 + q[1]^2/2;
        forces { u[0] along v[0]; u[1] along v[1]; u_0 along v_0; }
        scene First { track q[0], q_0; fix m[0] = 5; }
        scene Second { track q[1], q_0; fix m[0] = 5; }
    }
}

/// A field of an entry that stands alone is longer by `_` where another value has its name.
#[test]
fn entries_alone_beside_values_with_the_names_of_their_fields() {
    let first = alone::First { m_1: 3.0, ..Default::default() }.prepare().unwrap();
    let state = alone::first::State { q_0_: 1.0, v_0_: 0.5, q_0: 2.0, v_0: 0.25 };
    let rate = first.rhs(0.0, &state, &alone::first::Inputs { u_0_: 10.0, u_0: 6.0 });
    assert_eq!((rate.q_0_, rate.q_0), (0.5, 0.25));
    assert_eq!((rate.v_0_, rate.v_0), ((10.0 - 1.0) / 5.0, 2.0));
    assert_eq!(alone::first::State::NAMES, ["q[0]", "q_0", "v[0]", "v_0"]);
    let second = alone::Second { m_1_: 4.0, ..Default::default() }.prepare().unwrap();
    let state = alone::second::State { q_1: 1.0, ..Default::default() };
    let rate = second.rhs(0.0, &state, &alone::second::Inputs { u_1: 9.0, u_0: 0.0 });
    assert_eq!(rate.v_1, (9.0 - 1.0) / 4.0);
}

/// What must not vanish and is constant in a scene alone is one of its pivots.
#[test]
fn what_becomes_constant_in_a_scene_is_checked_when_it_is_prepared() {
    let only = unsettled::Only { m: 1.5 }.prepare().unwrap();
    let rates = System::rhs(&only, 0.0, &[0.3]);
    let whole = Unsettled { m: 1.5 }.prepare().unwrap();
    let full = unsettled::State { q: 0.1, r: 0.2, x: -0.3, v: 0.3, u: 0.4, w: -0.5 };
    assert_agree(&rates, &[whole.rhs(0.0, &full).v], 1e-15, "rates");
    let settled_only = settled::Only::from(Settled { m: 1.5, k: 0.5 }).prepare().unwrap();
    assert_agree(&System::rhs(&settled_only, 0.0, &[0.3]), &rates, 1e-15, "rates");
    let two = settled::Two { m: 1.5, k: 0.5 }.prepare().unwrap();
    assert_agree(&System::rhs(&two, 0.0, &[0.3, 0.7]), &[rates[0], 0.0], 1e-15, "rates");
    assert!(settled::Two { m: 0.0, k: 0.5 }.prepare().is_err());
    assert!(settled::Fixed { m: 1.5 }.prepare().is_ok());
}

#[test]
fn names_that_need_care() {
    let system = Raw::new(1.5).prepare().unwrap();
    let full = raw::State { r#type: 0.3, r#fn: -0.4, r#loop: 1.0, r#if: 3.0 };
    let inputs = raw::Inputs { r#move: 0.7 };
    let scene = raw::Loop::from(Raw::new(1.5)).prepare().unwrap();
    let small = raw::r#loop::State::from(full);
    let found = scene.rhs(0.0, &small, &inputs.into());
    assert_eq!(found.r#if, system.rhs(0.0, &full, &inputs).r#if);
    assert_agree(&[scene.outputs(0.0, &small, &inputs.into()).r#where], &[-0.1], 1e-15, "where");
}

/// Over single precision and over duals.
#[test]
fn other_reals() {
    let single = hoop::Tilt::<f32> { a: 0.5, A: 0.125, C: 0.25, g: 9.81 }.prepare().unwrap();
    let double = hoop::Tilt::from(HOOP).prepare().unwrap();
    for state in states::<4>(71, 100, 0.4, 1.3) {
        let found = System::rhs(&single, 0.0, &state.map(|x| x as f32)).map(f64::from);
        assert_agree(&found, &System::rhs(&double, 0.0, &state), 3e-6, "single precision");
        let lifted: hoop::tilt::Prepared<Dual<f64, 1>> = double.lift();
        let along = [0.3, -0.2, 0.5, 0.7];
        let moved = std::array::from_fn(|i| Dual { value: state[i], tangent: [along[i]] });
        let found = System::rhs(&lifted, Dual::constant(0.0), &moved).map(|rate| rate.tangent[0]);
        const H: f64 = 1e-6;
        let at = |h: f64| System::rhs(&double, 0.0, &std::array::from_fn(|i| state[i] + h * along[i]));
        let (ahead, behind) = (at(H), at(-H));
        let expected: [f64; 4] = std::array::from_fn(|i| (ahead[i] - behind[i]) / (2.0 * H));
        assert_agree(&found, &expected, 1e-8, "derivative");
    }
    let single = hoop::Numbers::with_defaults::<f32>();
    assert_eq!(single.system(), Hoop::<f32> { a: 0.5, A: 0.125, C: 0.25, g: 9.81 });
}

/// A level over single precision: between it and the system no number is computed.
#[test]
fn levels_over_other_reals() {
    let tilt = hoop::Tilt::<f32> { a: 0.5, A: 0.125, C: 0.25, g: 9.81 }.prepare().unwrap();
    let full: [f32; 9] = std::array::from_fn(|i| i as f32 + 0.1);
    assert_eq!(tilt.embed(&tilt.project(&full), &full), full);
}

#[test]
fn without_constants() {
    let scene = hoop::Numbers::<f64>::default().prepare().unwrap();
    assert_eq!(scene.constants(), hoop::Numbers::new());
    let one = bare::One::<f64>::default().prepare().unwrap();
    let other = bare::Other::from(Bare::<f64>::default()).prepare().unwrap();
    let rates = System::rhs(&one, 0.0, &[0.7, -0.3]);
    assert_agree(&rates, &[-0.3, -4.0 * 0.7_f64.powi(3)], 1e-15, "rates");
    assert_eq!(other.rhs(0.0, &[0.7, 9.0, -0.3, 9.0].into()).u, rates[1]);
    assert_eq!(other.constants().system(), Bare::<f64>::default());
}

/// `provide energy` keeps what the energy needs: here everything.
#[test]
fn what_is_provided_is_kept() {
    assert_eq!(bare::one::State::NAMES, ["x", "u"]);
    assert_eq!(bare::other::State::NAMES, ["x", "y", "u", "v"]);
}

#[test]
fn held_and_fixed_at_once() {
    let full = kepler::State { r: 0.9, phi: 0.4, radial: 0.2, areal: 1.1 };
    let scene = kepler::Orbit::of(&Kepler { mu: 1.0 }, &full).unwrap();
    assert_eq!(scene, kepler::Orbit { areal: 1.1 });
    assert!(kepler::Orbit::of(&KEPLER, &full).is_err());
    let (whole, scene) = (scene.system().prepare().unwrap(), scene.prepare().unwrap());
    assert_eq!(kepler::orbit::State::NAMES, ["r", "phi", "radial"]);
    assert_same_rates(&whole, &scene, &states(72, 100, 0.5, 1.5), 1e-13);
}

/// Limits of inputs are those of the system, with fixed constants at their values.
#[test]
fn limits_of_inputs() {
    let left = pair::Left::from(PAIR).prepare().unwrap();
    let inputs = pair::left::Inputs { one: 9.0, both: 9.0 };
    assert_eq!(left.clamped(&inputs), pair::left::Inputs { one: 2.0, both: 9.0 });
    let limited = pair::Limited { m: 1.3 };
    assert_eq!(limited.system(), Pair { m: 1.3, k: 0.75, limit: 1.5 });
    let limited = limited.prepare().unwrap();
    let inputs = pair::limited::Inputs { one: -9.0, both: 9.0 };
    assert_eq!(limited.clamped(&inputs), pair::limited::Inputs { one: -1.5, both: 9.0 });
}

/// Everything is tracked: the scene is the system again.
#[test]
fn a_scene_of_everything() {
    let whole = HOOP.prepare().unwrap();
    let scene = hoop::Everything::from(HOOP).prepare().unwrap();
    for state in states::<9>(73, 100, 0.4, 1.3) {
        assert_eq!(System::rhs(&whole, 0.0, &state), System::rhs(&scene, 0.0, &state));
    }
}
