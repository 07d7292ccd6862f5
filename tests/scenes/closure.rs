//! What a scene keeps, against what depends on what when numbers are changed: neither more nor less.

use guen::{Level, System};

use crate::compare::{closed, depends, states};
use crate::kinds::{
    BEAD, KEPLER, NEEDLESS, PAIR, SPINNING_BODY, bead, kepler, needless, pair, spinning_body,
};
use crate::models::{APPELL, CONVOY, HOOP, SLED, appell, convoy, hoop, sled};

/// A scene keeps what is tracked, what is provided, and what their rates depend on: found in the whole system by moving
/// every variable by itself.
fn assert_least<const N: usize, const FULL: usize, const M: usize>(
    whole: &impl System<f64, FULL>,
    scene: &impl Level<f64, N, FULL>,
    tracked: &[&str],
    names: [&str; FULL],
    provided: impl Fn(&[f64; FULL]) -> [f64; M],
    states: &[[f64; FULL]],
) {
    let rates = depends(|state| whole.rhs(0.4, state), states, |state| scene.hold(state));
    let quantities = depends(provided, states, |state| scene.hold(state));
    let asked = tracked.iter().map(|name| names.iter().position(|known| known == name).unwrap());
    let needed = quantities.iter().flat_map(|row| (0..FULL).filter(|j| row[*j]));
    let expected = closed(&rates, asked.chain(needed), &[]);
    assert_eq!(expected, places(scene), "tracked: {tracked:?}");
}

fn places<const N: usize, const FULL: usize, S: Level<f64, N, FULL>>(_: &S) -> [usize; N] {
    S::PLACES
}

/// Nothing is provided.
fn none<const FULL: usize>(_: &[f64; FULL]) -> [f64; 0] {
    []
}

const PARAMETERS: [&str; 3] = ["eta1", "eta2", "eta3"];

#[test]
fn of_the_hoop() {
    let (states, names) = (states::<9>(41, 5, 0.3, 1.2), hoop::State::NAMES);
    let whole = HOOP.prepare().unwrap();
    let tilt = hoop::Tilt::from(HOOP).prepare().unwrap();
    assert_least(&whole, &tilt, &["theta"], names, none, &states);
    let contact = hoop::Contact::from(HOOP).prepare().unwrap();
    let reaction = |state: &[f64; 9]| [whole.reactions(0.0, &(*state).into()).eta4];
    assert_least(&whole, &contact, &["theta"], names, reaction, &states);
    let nodding = hoop::Nodding::from(HOOP).prepare().unwrap();
    let rate = |state: &[f64; 9]| [whole.outputs(0.0, &(*state).into()).nodding];
    assert_least(&whole, &nodding, &["theta"], names, rate, &states);
    let told = hoop::Told::from(HOOP).prepare().unwrap();
    let all = |state: &[f64; 9]| {
        let state = (*state).into();
        let outputs = whole.outputs(0.0, &state);
        let reactions: [f64; 3] = whole.reactions(0.0, &state).into();
        [
            whole.energy(0.0, &state),
            reactions[0],
            reactions[1],
            reactions[2],
            outputs.trace[0],
            outputs.trace[1],
        ]
    };
    assert_least(&whole, &told, &PARAMETERS, names, all, &states);
    let numbers = hoop::Numbers::default();
    let whole = numbers.system().prepare().unwrap();
    let reactions = |state: &[f64; 9]| <[f64; 3]>::from(whole.reactions(0.0, &(*state).into()));
    assert_least(&whole, &numbers.prepare().unwrap(), &["theta", "psi"], names, reactions, &states);
}

#[test]
fn of_the_sled() {
    let (states, names) = (states::<5>(42, 5, -1.0, 1.0), sled::State::NAMES);
    let turn = sled::Turn::from(SLED).prepare().unwrap();
    assert_least(&SLED.prepare().unwrap(), &turn, &["phi"], names, none, &states);
    macro_rules! least {
        ($($Scene:ident { $($field:ident),* } tracks $tracked:expr;)*) => { $(
            let scene = sled::$Scene { $($field: SLED.$field),* };
            let (whole, scene) = (scene.system().prepare().unwrap(), scene.prepare().unwrap());
            assert_least(&whole, &scene, &$tracked, names, none, &states);
        )* };
    }
    least! {
        Centred { m, beta, k, incline, g } tracks ["phi"];
        Level { m, alpha, beta, k, g } tracks ["eta1", "eta2"];
        Straight { m, alpha, k, incline, g } tracks ["eta1", "eta2"];
    }
    let flat = sled::Flat { m: 1.3, alpha: 0.4, k: 0.7, g: 9.81 };
    let (whole, flat) = (flat.system().prepare().unwrap(), flat.prepare().unwrap());
    let provided = |state: &[f64; 5]| {
        let state = (*state).into();
        [whole.energy(0.0, &state), whole.reactions(0.0, &state).eta3]
    };
    assert_least(&whole, &flat, &["eta1", "eta2"], names, provided, &states);
}

#[test]
fn of_appells_system() {
    let states = states::<9>(43, 5, 0.3, 1.2);
    let whole = APPELL.prepare().unwrap();
    let scene = appell::Measured { a: APPELL.a, A: APPELL.A, C: APPELL.C, g: APPELL.g, eta3: 1.7 };
    let scene = scene.prepare().unwrap();
    let provided = |state: &[f64; 9]| {
        let state = (*state).into();
        let [a, b, c]: [f64; 3] = whole.reactions(0.0, &state).into();
        [whole.energy(0.0, &state), a, b, c]
    };
    assert_least(&whole, &scene, &["eta1", "eta2"], appell::State::NAMES, provided, &states);
}

#[test]
fn of_the_convoy() {
    let (states, names) = (states::<13>(44, 5, -0.9, 0.9), convoy::State::NAMES);
    let inputs = convoy::Inputs { drive: 0.7, steering: -0.4 };
    let whole = CONVOY.prepare().unwrap().driven(inputs);
    macro_rules! least {
        ($($Scene:ident tracks $tracked:expr;)*) => { $(
            let scene = convoy::$Scene::from(CONVOY).prepare().unwrap().driven(inputs.into());
            assert_least(&whole, &scene, &$tracked, names, none, &states);
        )* };
    }
    least! {
        Course tracks ["x", "y", "heading"];
        Dash tracks ["speed", "steer", "heading"];
        Hitch tracks ["first", "second"];
        Aim tracks ["steer"];
    }
}

/// Coordinates that are written and cancel, or leave by an identity of trigonometric functions.
#[test]
fn what_is_written_but_not_needed() {
    let (states, names) = (states::<6>(45, 5, -0.9, 0.9), needless::State::NAMES);
    let system = NEEDLESS;
    let whole = system.prepare().unwrap();
    let cancels = needless::Cancels::from(system).prepare().unwrap();
    assert_eq!(needless::cancels::State::NAMES, ["x", "u"]);
    assert_least(&whole, &cancels, &["x"], names, none, &states);
    let identity = needless::Identity::from(system).prepare().unwrap();
    assert_eq!(needless::identity::State::NAMES, ["z", "w"]);
    assert_least(&whole, &identity, &["z"], names, none, &states);
    let pulled = needless::Pulled::from(system).prepare().unwrap();
    assert_eq!(needless::pulled::State::NAMES, ["x", "y", "u", "v"]);
    assert_least(&whole, &pulled, &["y"], names, none, &states);
}

/// A momentum that is conserved: kept where it is needed, a constant where that is said.
#[test]
fn a_conserved_momentum() {
    let (states, names) = (states::<4>(46, 5, 0.5, 1.5), kepler::State::NAMES);
    let whole = KEPLER.prepare().unwrap();
    let distance = kepler::Distance::from(KEPLER).prepare().unwrap();
    assert_eq!(kepler::distance::State::NAMES, ["r", "radial", "areal"]);
    assert_least(&whole, &distance, &["r"], names, none, &states);
    let reduced = kepler::Reduced { mu: KEPLER.mu, areal: 0.8 }.prepare().unwrap();
    assert_eq!(kepler::reduced::State::NAMES, ["r", "radial"]);
    assert_least(&whole, &reduced, &["r"], names, none, &states);
}

/// Time is no variable, and stays.
#[test]
fn explicit_time() {
    let (states, names) = (states::<4>(47, 5, -0.9, 0.9), bead::State::NAMES);
    let whole = BEAD.prepare().unwrap();
    let shaken = bead::Shaken::from(BEAD).prepare().unwrap();
    assert_eq!(bead::shaken::State::NAMES, ["x", "u"]);
    assert_least(&whole, &shaken, &["x"], names, none, &states);
    assert_ne!(shaken.rhs(0.1, &[0.3, 0.4].into()), shaken.rhs(0.2, &[0.3, 0.4].into()));
    let free = bead::Free::from(BEAD).prepare().unwrap();
    assert_least(&whole, &free, &["y"], names, none, &states);
}

/// Inputs that nothing kept depends on leave too, and those that are needed do not.
#[test]
fn inputs() {
    let (states, names) = (states::<4>(48, 5, -0.9, 0.9), pair::State::NAMES);
    let system = PAIR.prepare().unwrap();
    let inputs = pair::Inputs { one: 0.6, two: -0.3, both: 0.2 };
    let whole = system.driven(inputs);
    let left = pair::Left::from(PAIR).prepare().unwrap();
    assert_eq!(pair::left::Inputs::NAMES, ["one", "both"]);
    assert_least(&whole, &left.driven(inputs.into()), &["x"], names, none, &states);
    let told = pair::Told::from(PAIR).prepare().unwrap();
    assert_eq!(pair::told::Inputs::NAMES, pair::Inputs::NAMES);
    assert_least(&whole, &told.driven(inputs.into()), &["x"], names, none, &states);
    // An input is in if and only if some kept rate or output changes with it.
    for (k, full) in states.iter().enumerate() {
        let small = Level::<f64, 2, 4>::project(&left.driven(inputs.into()), full);
        let rate = |inputs: pair::Inputs| {
            let rates = system.rhs(0.4, &(*full).into(), &inputs);
            [rates.x, rates.u]
        };
        assert_eq!(rate(inputs), rate(pair::Inputs { two: 5.0, ..inputs }), "state {k}");
        assert_ne!(rate(inputs), rate(pair::Inputs { one: 5.0, ..inputs }));
        assert_ne!(rate(inputs), rate(pair::Inputs { both: 5.0, ..inputs }));
        let found = left.rhs(0.4, &small.into(), &inputs.into());
        assert_eq!([found.x, found.u], rate(inputs));
    }
}

/// A unit quaternion is kept whole, or not at all.
#[test]
fn a_quaternion_stays_whole() {
    let names = spinning_body::State::NAMES;
    let whole = SPINNING_BODY.prepare().unwrap();
    let normalize = |state: &mut [f64; 13]| {
        let length = state[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
        state[..4].iter_mut().for_each(|q| *q /= length);
    };
    let states = states::<13>(49, 5, 0.2, 0.9);
    let rates = depends(|state| System::rhs(&whole, 0.4, state), &states, normalize);
    let group: [usize; 4] = [0, 1, 2, 3];
    let kept = |tracked: &[&str]| {
        let asked = tracked.iter().map(|name| names.iter().position(|known| known == name).unwrap());
        closed(&rates, asked, &[&group])
    };
    assert_eq!(kept(&["w"]), [0, 1, 2, 3, 7, 8, 9]);
    assert_eq!(spinning_body::one::State::NAMES, ["w", "i", "j", "k", "omega_x", "omega_y", "omega_z"]);
    // Free of forces: the angular velocity in the body does not ask where the body is.
    assert_eq!(spinning_body::euler::State::NAMES, ["omega_x", "omega_y", "omega_z"]);
    assert_eq!(kept(&["omega_x", "omega_y", "omega_z"]), [7, 8, 9]);
    assert_eq!(spinning_body::fall::State::NAMES, ["z", "vz"]);
}
