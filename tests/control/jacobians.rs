//! `A, B, C, D` against dual numbers and against differences in 71 digits, on systems of every kind.

use guen::prelude::*;
use guen::{Liftable, Linearizable};

use crate::vehicles::{Robot, Train, train};
use guen_study::Digits71;

hoop!(guen::mechanical_system);
appell!(guen::mechanical_system);
sled!(guen::mechanical_system);
trailer!(guen::mechanical_system);
turntable!(guen::mechanical_system);
euler_top!(guen::mechanical_system);
cart!(guen::mechanical_system);
particle_pendulum!(guen::mechanical_system);

/// Largest difference of an entry, in units of the largest entry of its row, or of one. The differences come from
/// what rounding of the state's functions leaves of `f64`; where it cancels in a row it is not the formula's.
const TOLERANCE: f64 = 1e-12;

fn assert_close(found: &[f64], expected: &[f64], what: &str) {
    let scale = expected.iter().fold(1.0_f64, |most, x| most.max(x.abs()));
    for (j, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= TOLERANCE * scale, "{what}, column {j}: {a} and {b}");
    }
}

/// Pseudo-random numbers between -1 and 1, the same every time.
pub fn numbers<const N: usize>(seed: u64) -> [f64; N] {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    std::array::from_fn(|_| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / (1_u64 << 30) as f64 - 1.0
    })
}

/// `A` and `B` of a system against duals, and against central differences of the same system in 71 digits.
pub fn check<const N: usize, const M: usize>(
    name: &str,
    system: &(impl Linearizable<f64, N, M> + Liftable<f64, N, M>),
    long: &impl Linearizable<Digits71, N, M>,
    state: [f64; N],
    inputs: [f64; M],
) {
    let t = 0.3;
    let linear = system.linearization(t, &state, &inputs);
    // Duals through the program of the rates.
    let constant = |x: f64| Dual::<f64, 1>::constant(x);
    let along = |place: usize| {
        let seed = |x: f64, is: bool| Dual { value: x, tangent: [if is { 1.0 } else { 0.0 }] };
        let s = std::array::from_fn(|j| seed(state[j], j == place));
        let u = std::array::from_fn(|j| seed(inputs[j], N + j == place));
        system.lifted_rates(constant(t), &s, &u).map(|rate| rate.tangent[0])
    };
    // Differences, of second order in 1e-22.
    let h = Digits71::from_ratio(1, 10_i64.pow(11)) * Digits71::from_ratio(1, 10_i64.pow(11));
    let exact = state.map(Digits71::from_f64);
    let held = inputs.map(Digits71::from_f64);
    let difference = |place: usize| {
        let at = |h: Digits71| {
            let (mut s, mut u) = (exact, held);
            if place < N {
                s[place] += h
            } else {
                u[place - N] += h
            }
            long.rates(Digits71::from_f64(t), &s, &u)
        };
        let (above, below) = (at(h), at(-h));
        let values: [f64; N] = std::array::from_fn(|i| ((above[i] - below[i]) / (h + h)).to_f64());
        values
    };
    let by_duals: Vec<[f64; N]> = (0..N + M).map(along).collect();
    let by_difference: Vec<[f64; N]> = (0..N + M).map(difference).collect();
    for i in 0..N {
        let found: Vec<f64> = linear.a[i].iter().chain(&linear.b[i]).copied().collect();
        let row = |columns: &[[f64; N]]| columns.iter().map(|column| column[i]).collect::<Vec<_>>();
        assert_close(&found, &row(&by_duals), &format!("{name}, row {i}, duals"));
        assert_close(&found, &row(&by_difference), &format!("{name}, row {i}, differences"));
    }
    assert!(linear.a.iter().flatten().any(|x| *x != 0.0), "{name}");
}

/// Prepared in both reals, from the same `f64`.
macro_rules! both {
    ($System:ident { $($constant:ident: $value:expr),* $(,)? }) => {
        (
            $System::<f64> { $($constant: From::from($value)),* }.prepare().unwrap(),
            $System::<Digits71> { $($constant: From::from(Digits71::from_f64($value))),* }.prepare().unwrap(),
        )
    };
}

#[test]
fn the_systems_of_the_paper() {
    for seed in 1..6 {
        let (system, long) = both!(Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 });
        let mut state = numbers::<9>(seed);
        state[0] += 1.5;
        check("hoop", &system, &long, state, []);
        let (system, long) = both!(Appell { a: 0.7, A: 0.4, C: 0.6, g: 9.81 });
        check("appell", &system, &long, state, []);
        let (system, long) = both!(Sled { m: 1.3, alpha: 0.2, beta: 0.1, k: 0.5, incline: 0.3, g: 9.81 });
        check("sled", &system, &long, numbers(seed), []);
    }
}

#[test]
fn further_systems() {
    for seed in 1..6 {
        let (system, long) = both!(Turntable { m: 0.7, a: 0.25, Omega: 1.5, swing: 0.8, nu: 1.3 });
        check("turntable", &system, &long, numbers(seed), []);
        let (system, long) = both!(EulerTop { I1: 1.0, I2: 2.0, I3: 2.5 });
        let mut state = numbers::<6>(seed);
        state[1] += 1.5;
        check("top", &system, &long, state, []);
        let (system, long) = both!(Cart { M: 2.0, m: 0.6, l: 0.5, I: 0.05, c: 0.1, g: 9.81 });
        check("cart", &system, &long, numbers(seed), numbers(seed + 10));
        let (system, long) = both!(ParticlePendulum { m: 1.3, l: 0.8, g: 9.81 });
        check("pendulum", &system, &long, numbers(seed), []);
    }
}

#[test]
fn vehicles() {
    for seed in 1..4 {
        let (system, long) = both!(Robot {
            m: 10.0,
            mw: 1.0,
            h: 0.5,
            b: 0.3,
            r: 0.1,
            A: 0.5,
            B: 0.4,
            C: 0.2,
            I: 0.003,
            J: 0.005,
            g: 9.81
        });
        check("robot", &system, &long, numbers(seed), numbers(seed + 10));
        let (system, long) = both!(Train { m: 3.0, I: 1.3, l: 1.1, d: 0.9, k: 0.3 });
        check("train", &system, &long, numbers(seed), numbers(seed + 10));
    }
}

/// What is emitted costs at most 0.7 of what duals cost, counted operation by operation.
#[test]
fn the_cost_against_duals() {
    use crate::vehicles::robot;
    let check = |name: &str, cost: Option<guen::Cost>, rhs: guen::Cost, directions: [usize; 2]| {
        let cost = cost.expect("these systems are small");
        let duals: u32 = directions.iter().filter(|n| **n > 0).map(|n| by_duals(rhs, *n as u32)).sum();
        let ratio = f64::from(cost.total()) / f64::from(duals);
        println!(
            "{name}: {} for A and B, {} for the rates, {duals} by duals: {ratio:.3}",
            cost.total(),
            rhs.total()
        );
        assert!(ratio <= 0.7, "{name}: {ratio}");
    };
    check("hoop", hoop::LINEARIZATION_COST, hoop::COST, [9, 0]);
    check("appell", appell::LINEARIZATION_COST, appell::COST, [9, 0]);
    check("sled", sled::LINEARIZATION_COST, sled::COST, [5, 0]);
    check("trailer", trailer::LINEARIZATION_COST, trailer::COST, [6, 0]);
    check("cart", cart::LINEARIZATION_COST, cart::COST, [4, 2]);
    check("robot", robot::LINEARIZATION_COST, robot::COST, [9, 2]);
    check("train", train::LINEARIZATION_COST, train::COST, [8, 2]);
}

/// The operations of a program in duals of `n` directions, by the formulas of `Dual`.
fn by_duals(cost: guen::Cost, n: u32) -> u32 {
    let guen::Cost { additions, negations, multiplications, divisions, roots, calls } = cost;
    // A product is u v, u dv + v du; a quotient (du - r dv)/v; a root 1/(2 r), then a product; a sine with its cosine
    // changes one sign.
    (additions + negations) * (1 + n)
        + (multiplications + divisions) * (1 + 3 * n)
        + roots * (3 + n)
        + calls * (2 + 2 * n)
}

/// `C` and `D`, of scalars and vectors, with inputs.
#[test]
fn outputs_of_the_cart() {
    let system = Cart { M: 2.0, m: 0.6, l: 0.5, I: 0.05.into(), c: 0.1, g: 9.81 }.prepare().unwrap();
    let state = cart::State::from(numbers::<4>(7));
    let inputs = cart::Inputs::from(numbers::<2>(8));
    let found = system.linearize_outputs(0.3, &state, &inputs);
    // Height, hinge, and the three of the pointer: l(sin), -l cos.
    let (sin, cos) = state.phi.sin_cos();
    let expected = [[0.0, 0.5 * sin], [0.0, 0.0], [1.0, 0.5 * cos], [0.0, 0.5 * sin], [0.0, 0.0]];
    for (row, expected) in found.c.iter().zip(expected) {
        assert_close(&row[..2], &expected, "C");
        assert_eq!(row[2..], [0.0, 0.0]);
    }
    assert_eq!(found.d, [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]]);
}
