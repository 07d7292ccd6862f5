//! A scene beside its system: states, rates, and what depends on what, found by changing numbers.

use guen::{Level, System};
use guen_benchmarks::Random;

/// States with every variable between two bounds.
pub fn states<const N: usize>(seed: u64, count: usize, low: f64, high: f64) -> Vec<[f64; N]> {
    let mut random = Random::new(seed);
    (0..count).map(|_| std::array::from_fn(|_| random.between(low, high))).collect()
}

/// Numbers that agree to the bit, or within a tolerance relative to the largest of them and one.
pub fn assert_agree(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size = expected.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!(a.is_finite(), "{what}, number {i}: {a}");
        let agree =
            if tolerance == 0.0 { a.to_bits() == b.to_bits() } else { (a - b).abs() <= tolerance * size };
        assert!(agree, "{what}, number {i}: {a:e} and {b:e}, apart by {:e} of {size:e}", (a - b).abs());
    }
}

/// The rates of a scene are those of the system, at each state with what the scene holds.
pub fn assert_same_rates<const N: usize, const FULL: usize>(
    whole: &impl System<f64, FULL>,
    scene: &(impl System<f64, N> + Level<f64, N, FULL>),
    states: &[[f64; FULL]],
    tolerance: f64,
) {
    for (k, state) in states.iter().enumerate() {
        let t = k as f64 / 7.0;
        let mut full = *state;
        scene.hold(&mut full);
        let expected = scene.project(&whole.rhs(t, &full));
        let found = scene.rhs(t, &scene.project(&full));
        assert_agree(&found, &expected, tolerance, &format!("rates at state {k}"));
    }
}

/// Which results of a function depend on which variables: some result differs by more than roundings at some state when
/// the variable is moved, and `restore` has put the state back to where it may be.
pub fn depends<const M: usize, const FULL: usize>(
    function: impl Fn(&[f64; FULL]) -> [f64; M],
    states: &[[f64; FULL]],
    restore: impl Fn(&mut [f64; FULL]),
) -> [[bool; FULL]; M] {
    let mut found = [[false; FULL]; M];
    for state in states {
        let mut state = *state;
        restore(&mut state);
        let there = function(&state);
        let size = there.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
        for j in 0..FULL {
            let mut moved = state;
            moved[j] += 0.07;
            restore(&mut moved);
            for (row, (a, b)) in found.iter_mut().zip(function(&moved).into_iter().zip(there)) {
                assert!(a.is_finite() && b.is_finite());
                row[j] |= (a - b).abs() > 1e-10 * size;
            }
        }
    }
    found
}

/// The least set of variables that contains those asked for and, with each, those its rate depends on.
pub fn closed<const FULL: usize>(
    rates: &[[bool; FULL]; FULL],
    asked: impl IntoIterator<Item = usize>,
    groups: &[&[usize]],
) -> Vec<usize> {
    let mut kept = [false; FULL];
    let mut waiting: Vec<usize> = asked.into_iter().collect();
    while let Some(place) = waiting.pop() {
        if !std::mem::replace(&mut kept[place], true) {
            waiting.extend((0..FULL).filter(|j| rates[place][*j]));
            waiting.extend(groups.iter().filter(|group| group.contains(&place)).copied().flatten());
        }
    }
    (0..FULL).filter(|place| kept[*place]).collect()
}
