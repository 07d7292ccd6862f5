//! Code that is generic over the level of detail, and runs that change it.

use guen::steppers::rk4;
use guen::{Level, System};

use crate::compare::{assert_agree, states};
use crate::models::{APPELL, CONVOY, HOOP, appell, convoy, hoop};

/// Some steps of any level, from a state of the system to one: what the level does not have stays where it was.
fn run<S, const N: usize, const FULL: usize>(
    level: &S,
    full: &[f64; FULL],
    from: u32,
    steps: u32,
) -> [f64; FULL]
where
    S: System<f64, N> + Level<f64, N, FULL>,
{
    const H: f64 = 1.0 / 64.0;
    let mut state = level.project(full);
    for k in from..from + steps {
        state = rk4::step(level, f64::from(k) * H, &state, H);
    }
    level.embed(&state, full)
}

fn bits<const N: usize>(state: [f64; N]) -> [u64; N] {
    state.map(f64::to_bits)
}

/// A state of the system that is projected and embedded again is the same one, and what is embedded is found again.
#[test]
fn there_and_back() {
    fn of<S: Level<f64, N, FULL>, const N: usize, const FULL: usize>(level: S) {
        assert_eq!(S::INFO.variables.len(), N);
        assert!(S::PLACES.is_sorted() && S::PLACES.iter().all(|place| *place < FULL));
        for pair in states::<FULL>(31, 20, -2.0, 2.0).windows(2) {
            let mut held = pair[0];
            level.hold(&mut held);
            assert_eq!(level.embed(&level.project(&held), &held), held);
            let other = level.embed(&level.project(&held), &pair[1]);
            assert_eq!(level.project(&other), level.project(&held));
            // What is neither kept nor held is from the rest.
            let mut rest = pair[1];
            level.hold(&mut rest);
            for place in (0..FULL).filter(|place| !S::PLACES.contains(place)) {
                assert_eq!(other[place], rest[place]);
            }
        }
    }
    of(HOOP.prepare().unwrap());
    of(hoop::Tilt::from(HOOP).prepare().unwrap());
    of(hoop::Told::from(HOOP).prepare().unwrap());
    of(hoop::Everything::from(HOOP).prepare().unwrap());
    of(appell::Rolling { a: 0.75, A: 0.6, C: 0.9, g: 9.81, eta3: 1.7 }.prepare().unwrap());
    of(convoy::Dash::from(CONVOY).prepare().unwrap().driven(Default::default()));
}

/// The whole system is a level of itself.
#[test]
fn the_system_is_a_level() {
    let whole = HOOP.prepare().unwrap();
    let places: [usize; 9] = <hoop::Prepared as Level<f64, 9, 9>>::PLACES;
    assert_eq!(places, [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    let state: [f64; 9] = std::array::from_fn(|i| i as f64);
    assert_eq!(Level::<f64, 9, 9>::project(&whole, &state), state);
    assert_eq!(<hoop::Prepared as Level<f64, 9, 9>>::INFO.name, "Hoop");
}

/// Far away only the tilt, nearer the contact, then all: what is tracked is that of the whole system to the bit.
#[test]
fn a_run_that_changes_its_level() {
    let whole = HOOP.prepare().unwrap();
    let tilt = hoop::Tilt::from(HOOP).prepare().unwrap();
    let contact = hoop::Contact::from(HOOP).prepare().unwrap();
    let start: [f64; 9] =
        hoop::State { theta: 1.1, psi: 0.2, eta1: 0.2, eta2: -0.3, eta3: 2.5, ..Default::default() }.into();
    let expected = run(&whole, &start, 0, 900);
    let mut full = run(&tilt, &start, 0, 300);
    // Nobody looked at the rest.
    assert_eq!(full[1..6], start[1..6]);
    full = run(&contact, &full, 300, 200);
    full = run(&whole, &full, 500, 300);
    full = run(&tilt, &full, 800, 100);
    assert_eq!(bits(tilt.project(&full)), bits(tilt.project(&expected)));
    assert_ne!(full[1], expected[1]);
}

#[test]
fn a_driven_run_that_changes_its_level() {
    let inputs = convoy::Inputs { drive: 0.3, steering: 0.01 };
    let whole = CONVOY.prepare().unwrap().driven(inputs);
    let dash = convoy::Dash::from(CONVOY).prepare().unwrap().driven(inputs.into());
    let aim = convoy::Aim::from(CONVOY).prepare().unwrap().driven(inputs.into());
    let start: [f64; 13] =
        convoy::State { heading: 0.4, speed: 0.5, turn: 0.02, ..Default::default() }.into();
    let expected = run(&whole, &start, 0, 120);
    let full = run(&whole, &run(&dash, &start, 0, 60), 60, 60);
    // Not a part of the whole program: to rounding.
    assert_agree(&dash.project(&full), &dash.project(&expected), 1e-14, "dashboard");
    let steered = run(&aim, &start, 0, 120);
    assert_agree(&aim.project(&steered), &aim.project(&expected), 1e-14, "steering");
}

/// What is held goes into the state of the system too.
#[test]
fn a_held_variable_is_embedded() {
    let state: [f64; 9] =
        appell::State { theta: 0.9, eta1: 0.1, eta2: 0.4, eta3: 1.3, ..Default::default() }.into();
    let scene = appell::Rolling::of(&APPELL, &state.into()).unwrap().prepare().unwrap();
    let elsewhere = scene.embed(&scene.project(&state), &[7.0; 9]);
    let expected = appell::State {
        theta: 0.9,
        psi: 7.0,
        phi: 7.0,
        xi: 7.0,
        eta: 7.0,
        zeta: 7.0,
        eta1: 0.1,
        eta2: 0.4,
        eta3: 1.3,
    };
    assert_eq!(appell::State::from(elsewhere), expected);
}

#[test]
fn states_by_name() {
    let full = hoop::State::from(std::array::from_fn::<f64, 9, _>(|i| i as f64 + 0.5));
    let tilt = hoop::tilt::State::from(full);
    assert_eq!(tilt, hoop::tilt::State { theta: 0.5, eta1: 6.5, eta2: 7.5, eta3: 8.5 });
    let rest = hoop::State { psi: -1.0, theta: -2.0, ..Default::default() };
    let expected =
        hoop::State { theta: 0.5, psi: -1.0, eta1: 6.5, eta2: 7.5, eta3: 8.5, ..Default::default() };
    assert_eq!(tilt.within(rest), expected);
    assert_eq!(hoop::everything::State::from(&full).within(rest), full);
    let inputs = convoy::Inputs { drive: 2.0, steering: 3.0 };
    assert_eq!(convoy::aim::Inputs::from(inputs), convoy::aim::Inputs { steering: 3.0 });
}
