//! The equations of a scene are those of the whole system: to the bit where its report says that the operations are the
//! same, else within roundings.

use guen::steppers::rk4;
use guen::{Level, Report, System};

use crate::compare::{assert_agree, assert_same_rates, states};
use crate::models::{APPELL, CONVOY, HOOP, SLED, appell, convoy, hoop, sled};

const SAME: &str = "computed by the same operations as in the whole system";

fn is_part(report: &'static Report) -> bool {
    report.lines("Rates").contains(&SAME)
}

/// Roundings of other operations: some dozens, of terms that are not larger than the largest rate by much.
const NEAR: f64 = 1e-13;

fn bound(report: &'static Report) -> f64 {
    if is_part(report) { 0.0 } else { NEAR }
}

/// Half a radian to a little over one: far enough from where the hoop lies flat.
fn hoop_states() -> Vec<[f64; 9]> {
    states(11, 2000, 0.3, 1.4)
}

#[test]
fn of_the_hoop() {
    let (whole, states) = (HOOP.prepare().unwrap(), hoop_states());
    macro_rules! same {
        ($($scene:ident :: $Scene:ident),*) => { $(
            assert!(is_part(&hoop::$scene::REPORT), stringify!($Scene));
            let scene = hoop::$Scene::from(HOOP).prepare().unwrap();
            assert_same_rates(&whole, &scene, &states, 0.0);
        )* };
    }
    same!(tilt::Tilt, contact::Contact, told::Told, everything::Everything, nodding::Nodding);
}

#[test]
fn of_the_hoop_at_fixed_values() {
    let states = hoop_states();
    let unit = hoop::Unit { A: 0.3, C: 0.45 };
    assert!(!is_part(&hoop::unit::REPORT));
    assert_same_rates(&unit.system().prepare().unwrap(), &unit.prepare().unwrap(), &states, NEAR);
    let numbers = hoop::Numbers::default();
    assert_same_rates(&numbers.system().prepare().unwrap(), &numbers.prepare().unwrap(), &states, NEAR);
}

#[test]
fn of_the_sled() {
    let states = states::<5>(12, 2000, -3.0, 3.0);
    let turn = sled::Turn::from(SLED);
    assert!(is_part(&sled::turn::REPORT));
    assert_same_rates(&SLED.prepare().unwrap(), &turn.prepare().unwrap(), &states, 0.0);
    macro_rules! near {
        ($($Scene:ident { $($field:ident),* }),*) => { $(
            let scene = sled::$Scene { $($field: SLED.$field),* };
            assert_same_rates(&scene.system().prepare().unwrap(), &scene.prepare().unwrap(), &states, NEAR);
        )* };
    }
    near!(
        Centred { m, beta, k, incline, g },
        Level { m, alpha, beta, k, g },
        Straight { m, alpha, k, incline, g },
        Flat { m, alpha, k, g }
    );
}

#[test]
fn of_appells_system() {
    let whole = APPELL.prepare().unwrap();
    for state in states::<9>(13, 500, 0.3, 1.4) {
        let scene = appell::Rolling::of(&APPELL, &state.into()).unwrap().prepare().unwrap();
        assert_same_rates(&whole, &scene, &[state], bound(&appell::rolling::REPORT));
        let scene = appell::Spinning::of(&APPELL, &state.into()).unwrap().prepare().unwrap();
        assert_same_rates(&whole, &scene, &[state], NEAR);
    }
}

#[test]
fn of_the_convoy() {
    let states = states::<13>(14, 500, -1.0, 1.0);
    let inputs = convoy::Inputs { drive: 0.7, steering: -0.4 };
    let whole = CONVOY.prepare().unwrap().driven(inputs);
    macro_rules! same {
        ($($scene:ident :: $Scene:ident),*) => { $(
            let scene = convoy::$Scene::from(CONVOY).prepare().unwrap().driven(inputs.into());
            assert_same_rates(&whole, &scene, &states, bound(&convoy::$scene::REPORT));
        )* };
    }
    same!(course::Course, dash::Dash, hitch::Hitch, aim::Aim);
    let alone = convoy::Alone {
        m: CONVOY.m,
        J: CONVOY.J,
        I: CONVOY.I,
        base: CONVOY.base,
        half: CONVOY.half,
        r: CONVOY.r,
        d1: CONVOY.d1,
        d2: CONVOY.d2,
        drag: CONVOY.drag,
    };
    let whole = alone.system().prepare().unwrap().driven(inputs);
    assert_same_rates(&whole, &alone.prepare().unwrap().driven(inputs.into()), &states, NEAR);
}

/// A run of both on the same steps: what the scene keeps is the same to the bit at every step.
fn assert_same_run<const N: usize, const FULL: usize>(
    whole: &impl System<f64, FULL>,
    scene: &(impl System<f64, N> + Level<f64, N, FULL>),
    start: [f64; FULL],
    steps: u32,
    h: f64,
) {
    let (mut full, mut small) = (start, scene.project(&start));
    for k in 0..steps {
        let t = f64::from(k) * h;
        full = rk4::step(whole, t, &full, h);
        small = rk4::step(scene, t, &small, h);
        let bits = |x: [f64; N]| x.map(f64::to_bits);
        assert_eq!(bits(small), bits(scene.project(&full)), "after {} steps", k + 1);
    }
    assert!(small.iter().all(|x| x.is_finite()));
    assert_ne!(small, scene.project(&start));
}

/// 10^4 s of the hoop in 10^5 steps, and of the sled on its incline in steps that shorten and lengthen.
#[test]
fn a_long_run_to_the_bit() {
    let start = hoop::State { theta: 1.2, eta1: 0.1, eta2: 0.4, eta3: 3.0, ..Default::default() };
    let tilt = hoop::Tilt::from(HOOP).prepare().unwrap();
    assert_same_run(&HOOP.prepare().unwrap(), &tilt, start.into(), 100_000, 0.1);
}

#[test]
fn a_run_with_prescribed_steps_of_many_lengths() {
    let (whole, scene) = (SLED.prepare().unwrap(), sled::Turn::from(SLED).prepare().unwrap());
    let start: [f64; 5] = sled::State { phi: 0.3, eta1: 0.9, ..Default::default() }.into();
    let (mut full, mut small, mut t, mut k) = (start, scene.project(&start), 0.0, 0_u32);
    while t < 100.0 {
        let h = 0.002 * (1.0 + f64::from(k % 17));
        full = rk4::step(&whole, t, &full, h);
        small = rk4::step(&scene, t, &small, h);
        t += h;
        k += 1;
        assert_agree(&small, &scene.project(&full), 0.0, "after steps of many lengths");
    }
}
