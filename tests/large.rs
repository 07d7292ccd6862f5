//! A planar chain of twenty links: its rates against a dense solve, and that a debug build compiles it at all. A straight
//! line of several thousand `let`s once overflowed the stack of the compiler's back end.

use nalgebra::{DMatrix, DVector};

guen::mechanical_system! {
    /// Point masses on massless links, hanging from the origin; the angles are absolute, zero downwards.
    pub system Chain {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { q1, q2, q3, q4, q5, q6, q7, q8, q9, q10, q11, q12, q13, q14, q15, q16, q17, q18, q19, q20 }
        parameters {
            w1 = dot(q1);
            w2 = dot(q2);
            w3 = dot(q3);
            w4 = dot(q4);
            w5 = dot(q5);
            w6 = dot(q6);
            w7 = dot(q7);
            w8 = dot(q8);
            w9 = dot(q9);
            w10 = dot(q10);
            w11 = dot(q11);
            w12 = dot(q12);
            w13 = dot(q13);
            w14 = dot(q14);
            w15 = dot(q15);
            w16 = dot(q16);
            w17 = dot(q17);
            w18 = dot(q18);
            w19 = dot(q19);
            w20 = dot(q20);
        }
        let x1 = l*sin(q1);
        let y1 = -l*cos(q1);
        let x2 = x1 + l*sin(q2);
        let y2 = y1 - l*cos(q2);
        let x3 = x2 + l*sin(q3);
        let y3 = y2 - l*cos(q3);
        let x4 = x3 + l*sin(q4);
        let y4 = y3 - l*cos(q4);
        let x5 = x4 + l*sin(q5);
        let y5 = y4 - l*cos(q5);
        let x6 = x5 + l*sin(q6);
        let y6 = y5 - l*cos(q6);
        let x7 = x6 + l*sin(q7);
        let y7 = y6 - l*cos(q7);
        let x8 = x7 + l*sin(q8);
        let y8 = y7 - l*cos(q8);
        let x9 = x8 + l*sin(q9);
        let y9 = y8 - l*cos(q9);
        let x10 = x9 + l*sin(q10);
        let y10 = y9 - l*cos(q10);
        let x11 = x10 + l*sin(q11);
        let y11 = y10 - l*cos(q11);
        let x12 = x11 + l*sin(q12);
        let y12 = y11 - l*cos(q12);
        let x13 = x12 + l*sin(q13);
        let y13 = y12 - l*cos(q13);
        let x14 = x13 + l*sin(q14);
        let y14 = y13 - l*cos(q14);
        let x15 = x14 + l*sin(q15);
        let y15 = y14 - l*cos(q15);
        let x16 = x15 + l*sin(q16);
        let y16 = y15 - l*cos(q16);
        let x17 = x16 + l*sin(q17);
        let y17 = y16 - l*cos(q17);
        let x18 = x17 + l*sin(q18);
        let y18 = y17 - l*cos(q18);
        let x19 = x18 + l*sin(q19);
        let y19 = y18 - l*cos(q19);
        let x20 = x19 + l*sin(q20);
        let y20 = y19 - l*cos(q20);
        kinetic_energy = m/2*(dot(x1)^2 + dot(y1)^2)
            + m/2*(dot(x2)^2 + dot(y2)^2)
            + m/2*(dot(x3)^2 + dot(y3)^2)
            + m/2*(dot(x4)^2 + dot(y4)^2)
            + m/2*(dot(x5)^2 + dot(y5)^2)
            + m/2*(dot(x6)^2 + dot(y6)^2)
            + m/2*(dot(x7)^2 + dot(y7)^2)
            + m/2*(dot(x8)^2 + dot(y8)^2)
            + m/2*(dot(x9)^2 + dot(y9)^2)
            + m/2*(dot(x10)^2 + dot(y10)^2)
            + m/2*(dot(x11)^2 + dot(y11)^2)
            + m/2*(dot(x12)^2 + dot(y12)^2)
            + m/2*(dot(x13)^2 + dot(y13)^2)
            + m/2*(dot(x14)^2 + dot(y14)^2)
            + m/2*(dot(x15)^2 + dot(y15)^2)
            + m/2*(dot(x16)^2 + dot(y16)^2)
            + m/2*(dot(x17)^2 + dot(y17)^2)
            + m/2*(dot(x18)^2 + dot(y18)^2)
            + m/2*(dot(x19)^2 + dot(y19)^2)
            + m/2*(dot(x20)^2 + dot(y20)^2);
        potential_energy = m*g*y1 + m*g*y2 + m*g*y3 + m*g*y4 + m*g*y5 + m*g*y6 + m*g*y7 + m*g*y8 + m*g*y9 + m*g*y10 + m*g*y11 + m*g*y12 + m*g*y13 + m*g*y14 + m*g*y15 + m*g*y16 + m*g*y17 + m*g*y18 + m*g*y19 + m*g*y20;
    }
}

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
    let system = Chain { m: 0.7, l: 0.4, g: 9.81 }.prepare().expect("the constants are in order");
    for round in 0..20 {
        // Angles all over the circle, and one state that hangs nearly straight.
        let spread = if round == 0 { 1e-3 } else { 2.0 };
        let state: [f64; 2 * N] =
            core::array::from_fn(|k| spread * ((k * k + 31 * round + 1) as f64 * 0.731).sin());
        let rates: [f64; 2 * N] = system.rhs(0.0, &chain::State::from(state)).into();
        assert_eq!(rates[..N], state[N..]);
        let expected = by_hand(&state[..N], &state[N..], 9.81 / 0.4);
        let error = (0..N).map(|i| (rates[N + i] - expected[i]).abs()).fold(0.0, f64::max);
        let size = expected.amax();
        assert!(error <= 1e-9 * size, "round {round}: {error:e} of {size:e}");
    }
}
