//! What scenes leave out, recovered from runs of what they keep: against runs of the whole systems.

use guen::Level;
use guen::prelude::*;
use guen_study::{Nodes, Recovered, recover};

hoop! { guen::mechanical_system;
    scene Tilt { track theta; }
}

sled! { guen::mechanical_system;
    scene Coasting { track phi; fix alpha = 0; }
}

appell! { guen::mechanical_system;
    scene Rolling { fix eta3; }
}

const FINE: f64 = 1e-12;
const CHECK: f64 = 1e-9;

fn sampled<S: System<f64, N>, const N: usize>(
    system: &S,
    start: [f64; N],
    times: &[f64],
    tolerance: f64,
) -> Vec<[f64; N]> {
    let mut states = Vec::new();
    Integration::new(system, times[0], &start)
        .sample(times, &mut |_k, _t, state| states.push(*state))
        .run(&Dop853::new(tolerance, tolerance), times[times.len() - 1])
        .expect("the motion is regular");
    states
}

/// Runs the scene, recovers the rest, and compares each entry with a run of the system as far as stated.
fn compared<S, F, const N: usize, const FULL: usize>(
    core: &S,
    full: &F,
    start: [f64; FULL],
    grid: &[f64],
) -> (Recovered<FULL>, [f64; FULL])
where
    S: Level<f64, N, FULL> + System<f64, N>,
    F: System<f64, FULL>,
{
    let nodes = Nodes::new(grid).unwrap();
    let run = |tolerance| sampled(core, core.project(&start), nodes.times(), tolerance);
    let recovered = recover(core, full, &nodes, &run(FINE), &run(CHECK), &start).unwrap();
    let reference = sampled(full, start, grid, 1e-14);
    assert_eq!((recovered.times.len(), recovered.states.len()), (grid.len(), grid.len()));
    let mut largest = [0.0_f64; FULL];
    for ((state, exact), stated) in recovered.states.iter().zip(&reference).zip(&recovered.errors) {
        for i in 0..FULL {
            let off = (state[i] - exact[i]).abs();
            // The reference has an error of its own.
            assert!(off <= stated[i] + 1e-11, "entry {i} is off by {off:e}, and {:e} is stated", stated[i]);
            largest[i] = largest[i].max(off);
        }
    }
    (recovered, largest)
}

fn grid(until: f64, intervals: u32) -> Vec<f64> {
    (0..=intervals).map(|k| until * f64::from(k) / f64::from(intervals)).collect()
}

#[test]
fn the_path_of_the_hoop_from_four_variables() {
    let tilt = hoop::Tilt { a: 1.0, A: 0.5, C: 1.0, g: 9.81 };
    let (hoop, tilt) = (tilt.system().prepare().unwrap(), tilt.prepare().unwrap());
    let start = hoop::State {
        theta: 1.0_f64,
        psi: 0.2,
        phi: -0.4,
        xi: 3.0,
        eta: -2.0,
        zeta: 1.0_f64.sin(),
        eta1: 0.1,
        eta2: 3.0,
        eta3: 0.9,
    };
    let (recovered, off) = compared(&tilt, &hoop, start.into(), &grid(10.0, 400));
    assert!(off.iter().all(|off| *off < 1e-9), "{off:?}");
    assert!((0..9).all(|entry| recovered.error(entry) < 1e-6), "{:?}", recovered.errors.last());
    // The constraint on positions that the derivation finds integrable.
    let end = hoop::State::from(*recovered.states.last().unwrap());
    assert!((end.zeta - end.theta.sin()).abs() < 1e-10);
}

#[test]
fn the_place_of_the_sled() {
    let scene = sled::Coasting { m: 1.0, beta: 0.1, k: 0.5, incline: 0.1, g: 9.81 };
    let (sled, scene) = (scene.system().prepare().unwrap(), scene.prepare().unwrap());
    assert_eq!(sled.constants().alpha, 0.0);
    let start = sled::State { eta1: 3.0, eta2: 1.0, ..Default::default() };
    let (recovered, off) = compared(&scene, &sled, start.into(), &grid(20.0, 200));
    assert!(off.iter().all(|off| *off < 1e-9), "{off:?}");
    assert!((0..5).all(|entry| recovered.error(entry) < 1e-6), "{:?}", recovered.errors.last());
}

#[test]
fn what_a_scene_holds_is_recovered_as_it_is() {
    let constants = Appell { a: 1.0, A: 0.5, C: 1.0, g: 9.81 };
    let start = appell::State { theta: 1.2, zeta: 1.2_f64.sin(), eta2: 4.0, eta3: 2.5, ..Default::default() };
    let scene = appell::Rolling::of(&constants, &start).unwrap().prepare().unwrap();
    let appell = constants.prepare().unwrap();
    let nodes = Nodes::new(&grid(5.0, 100)).unwrap();
    let whole: [f64; 9] = start.into();
    let run = |tolerance| sampled(&scene, scene.project(&whole), nodes.times(), tolerance);
    let recovered = recover(&scene, &appell, &nodes, &run(FINE), &run(CHECK), &whole).unwrap();
    let (end, exact) =
        (recovered.states.last().unwrap(), *sampled(&appell, whole, &[0.0, 5.0], 1e-14).last().unwrap());
    for i in 0..9 {
        let off = (end[i] - exact[i]).abs();
        assert!(off <= recovered.error(i) + 1e-11 && off < 1e-9, "entry {i}: {off:e}");
    }
    assert_eq!((end[8], recovered.error(8)), (2.5, 0.0));
}
