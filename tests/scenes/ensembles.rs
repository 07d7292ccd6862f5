//! Ensembles of scenes: lanes and threads compute the same bits as one run after another.

use guen::steppers::{Integration, Rk4};
use guen_study::Ensemble;

use crate::compare::states;
use crate::models::{APPELL, HOOP, appell, hoop};

#[test]
fn many_states_of_one_scene() {
    let tilt = hoop::Tilt::from(HOOP).prepare().unwrap();
    let starts: Vec<[f64; 4]> = states(3, 21, 0.8, 1.4);
    let ends = Ensemble::of_states(&tilt, starts.iter().copied()).integrate(&Rk4::new(0.01), 0.0, 0.2);
    for (start, end) in starts.iter().zip(ends) {
        let alone = Integration::new(&tilt, 0.0, start).run(&Rk4::new(0.01), 0.2);
        assert_eq!(end.unwrap().state, alone.unwrap().state);
    }
}

/// What a scene holds may differ from one trajectory to the next.
#[test]
fn scenes_that_hold_different_values() {
    let whole: Vec<[f64; 9]> = states(5, 11, 0.8, 1.4);
    let members: Vec<_> = whole
        .iter()
        .map(|full| {
            let full = appell::State::from(*full);
            let scene = appell::Rolling::of(&APPELL, &full).unwrap().prepare().unwrap();
            (scene, <[f64; 3]>::from(appell::rolling::State::from(&full)))
        })
        .collect();
    let ends = Ensemble::of_systems(members.iter().copied()).integrate(&Rk4::new(0.01), 0.0, 0.2);
    for ((scene, start), end) in members.iter().zip(ends) {
        let alone = Integration::new(scene, 0.0, start).run(&Rk4::new(0.01), 0.2);
        assert_eq!(end.unwrap().state, alone.unwrap().state);
    }
}
