//! A core with a known motion, a layer on it, a layer on that, and a variable that no run of the core tells.

use guen_runtime::{Cost, LevelInfo, from_fn};

use super::*;

/// Keeps `x = sin t` and `v = cos t` out of `x, y, z, w, v` with `y' = x v`, `z' = y + v`, `w' = -w + x`.
struct Circle;

impl Level<f64, 2, 5> for Circle {
    const PLACES: [usize; 2] = [0, 4];
    const QUADRATURES: &'static [&'static [usize]] = &[&[1], &[2]];
    const INFO: LevelInfo =
        LevelInfo { name: "Circle", variables: &["x", "v"], cost: Cost::ZERO, prepare_cost: Cost::ZERO };
}

const REST: [f64; 5] = [0.0, 0.25, -1.0, 7.0, 1.0];

fn full() -> impl System<f64, 5> {
    from_fn(|_t: f64, &[x, y, _z, w, v]: &[f64; 5]| [v, x * v, y + v, x - w, -x])
}

fn exact(t: f64) -> [f64; 5] {
    let y = 0.25 + t.sin().powi(2) / 2.0;
    // y = 1/2 - cos(2 t)/4
    let z = -1.0 + t / 2.0 - (2.0 * t).sin() / 8.0 + t.sin();
    [t.sin(), y, z, 7.0, t.cos()]
}

fn motion(times: &[f64], off: f64) -> Vec<[f64; 2]> {
    times.iter().map(|t| [t.sin() * (1.0 + off), t.cos()]).collect()
}

fn recovered(intervals: u32, off: f64) -> Recovered<5> {
    let length = 20.0 / f64::from(intervals);
    let grid: Vec<f64> = (0..=intervals).map(|k| f64::from(k) * length).collect();
    let nodes = Nodes::new(&grid).unwrap();
    let run = motion(nodes.times(), 0.0);
    recover(&Circle, &full(), &nodes, &run, &motion(nodes.times(), off), &REST).unwrap()
}

fn off(recovered: &Recovered<5>, place: usize) -> f64 {
    let pairs = recovered.times.iter().zip(&recovered.states);
    pairs.map(|(t, state)| (state[place] - exact(*t)[place]).abs()).fold(0.0, f64::max)
}

#[test]
fn layers_are_recovered_within_what_is_stated() {
    for intervals in [10, 20, 40, 80] {
        let recovered = recovered(intervals, 0.0);
        for place in [1, 2] {
            let (off, stated) = (off(&recovered, place), recovered.error(place));
            assert!(off <= stated, "{intervals} intervals, {place}: {off:e} of {stated:e}");
        }
        assert_eq!(recovered.error(3), f64::INFINITY);
        assert!(recovered.states.iter().all(|state| state[3] == 7.0));
    }
    assert!(off(&recovered(80, 0.0), 2) < 1e-13 && recovered(80, 0.0).error(2) < 1e-6);
}

/// The core of the tests above where an equation says that `w = 2 x + t`, and `y' = w` follows.
struct Bound;

impl Level<f64, 2, 5> for Bound {
    const PLACES: [usize; 2] = [0, 4];
    const QUADRATURES: &'static [&'static [usize]] = &[&[1]];
    const DETERMINED: &'static [usize] = &[3];
    const INFO: LevelInfo =
        LevelInfo { name: "Bound", variables: &["x", "v"], cost: Cost::ZERO, prepare_cost: Cost::ZERO };

    fn determine(&self, t: f64, state: &[f64; 2], full: &mut [f64; 5]) {
        full[3] = 2.0 * state[0] + t;
    }
}

#[test]
fn what_an_equation_says_is_as_good_as_what_it_says_it_of() {
    let full = from_fn(|_t: f64, &[x, _y, _z, w, v]: &[f64; 5]| [v, w, f64::NAN, f64::NAN, -x]);
    let grid: Vec<f64> = (0..=40).map(|k| 0.25 * f64::from(k)).collect();
    let nodes = Nodes::new(&grid).unwrap();
    let (run, check) = (motion(nodes.times(), 0.0), motion(nodes.times(), 1e-4));
    let rest = [0.0, 0.0, 0.0, f64::NAN, 1.0];
    let recovered = recover(&&Bound, &full, &nodes, &run, &check, &rest).unwrap();
    for (t, state) in recovered.times.iter().zip(&recovered.states) {
        let expected = [2.0 * t.sin() + t, 2.0 - 2.0 * t.cos() + t * t / 2.0];
        for (place, expected) in [3, 1].into_iter().zip(expected) {
            assert!((state[place] - expected).abs() < 1e-12, "{} and not {expected} at {t}", state[place]);
        }
    }
    assert!(recovered.error(3) >= 1.9e-4 && recovered.error(3) < 2.1e-4 && recovered.error(2).is_infinite());
}

#[test]
fn the_orders_are_those_of_the_rules() {
    // Halving the interval: 2^-9 at least of the error, 2^-5 of what is stated.
    let [coarse, fine] = [10, 20].map(|intervals| recovered(intervals, 0.0));
    assert!(off(&fine, 2) < off(&coarse, 2) / 256.0, "{:e} {:e}", off(&coarse, 2), off(&fine, 2));
    assert!(fine.error(2) < coarse.error(2) / 16.0, "{:e} {:e}", coarse.error(2), fine.error(2));
}

#[test]
fn errors_of_the_run_are_in_what_is_stated() {
    let recovered = recovered(80, 1e-4);
    assert!(recovered.error(0) >= 0.99e-4 && recovered.error(1) >= 0.4e-4);
    assert!(recovered.errors.windows(2).all(|pair| pair[0][2] <= pair[1][2]), "the bound falls");
}

#[test]
fn backwards_as_forwards() {
    let grid: Vec<f64> = (0..=40).map(|k| -0.25 * f64::from(k)).collect();
    let nodes = Nodes::new(&grid).unwrap();
    let run = motion(nodes.times(), 0.0);
    let recovered = recover(&Circle, &full(), &nodes, &run, &run, &REST).unwrap();
    assert!(off(&recovered, 2) <= recovered.error(2) && off(&recovered, 2) < 1e-12);
}

#[test]
fn what_is_wrong_is_said() {
    for grid in [&[][..], &[1.0], &[0.0, 0.0], &[0.0, 1.0, 0.5], &[0.0, f64::NAN], &[0.0, f64::INFINITY]] {
        assert_eq!(Nodes::new(grid), Err(RecoveryError::Grid), "{grid:?}");
    }
    let nodes = Nodes::new(&[0.0, 1.0]).unwrap();
    let mut run = motion(nodes.times(), 0.0);
    let short = recover(&Circle, &full(), &nodes, &run, &run[1..], &REST);
    assert_eq!(short, Err(RecoveryError::Samples { expected: 9, found: 8 }));
    run[4][0] = f64::NAN;
    let broken = recover(&Circle, &full(), &nodes, &run, &run, &REST);
    assert_eq!(broken, Err(RecoveryError::NotFinite { t: nodes.times()[4], entry: 1 }));
}
