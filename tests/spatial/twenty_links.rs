//! A planar chain of twenty links: its rates against a dense solve, and that a debug build compiles it at all. A straight
//! line of several thousand `let`s once overflowed the stack of the compiler's back end.

use guen_benchmarks::systems::{Chain20, chain20};
use nalgebra::{DMatrix, DVector};

/// The links of the chain.
const N: usize = 20;

/// `sum_j c_ij cos(q_i - q_j) w_j' = -sum_j c_ij sin(q_i - q_j) w_j^2 - c_ii g/l sin(q_i)`, where `c_ij` counts the
/// masses below both links.
fn by_hand(q: &[f64], w: &[f64], gravity_over_length: f64) -> DVector<f64> {
    let below = |i: usize, j: usize| (N - i.max(j)) as f64;
    let mass = DMatrix::from_fn(N, N, |i, j| below(i, j) * (q[i] - q[j]).cos());
    let force = DVector::from_fn(N, |i, _| {
        let turning: f64 = (0..N).map(|j| below(i, j) * (q[i] - q[j]).sin() * w[j] * w[j]).sum();
        -turning - below(i, i) * gravity_over_length * q[i].sin()
    });
    mass.lu().solve(&force).expect("the mass matrix is regular")
}

#[test]
fn rates_of_twenty_links_agree_with_a_dense_solve() {
    let system = Chain20 { m: 0.7, l: 0.4, g: 9.81 }.prepare().expect("the constants are in order");
    for round in 0..20 {
        // Angles all over the circle, and one state that hangs nearly straight.
        let spread = if round == 0 { 1e-3 } else { 2.0 };
        let state: [f64; 2 * N] =
            core::array::from_fn(|k| spread * ((k * k + 31 * round + 1) as f64 * 0.731).sin());
        let rates: [f64; 2 * N] = system.rhs(0.0, &chain20::State::from(state)).into();
        assert_eq!(rates[..N], state[N..]);
        let expected = by_hand(&state[..N], &state[N..], 9.81 / 0.4);
        let error = (0..N).map(|i| (rates[N + i] - expected[i]).abs()).fold(0.0, f64::max);
        let size = expected.amax();
        assert!(error <= 1e-9 * size, "round {round}: {error:e} of {size:e}");
    }
}
