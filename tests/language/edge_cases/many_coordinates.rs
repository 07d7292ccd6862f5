//! Many coordinates: a chain of twelve masses with nonlinear springs and two constraints, and a sixfold pendulum.

use super::assert_near;
use guen::prelude::*;
use nalgebra::{SMatrix, SVector};

guen::mechanical_system! {
    /// Twelve masses on a line between walls; the last two move as they are told.
    pub system Chain {
        constants { m > 0, k > 0, b, rate }
        coordinates { x1, x2, x3, x4, x5, x6, x7, x8, x9, x10, x11, x12 }
        parameters {
            v1 = dot(x1); v2 = dot(x2); v3 = dot(x3); v4 = dot(x4); v5 = dot(x5);
            v6 = dot(x6); v7 = dot(x7); v8 = dot(x8); v9 = dot(x9); v10 = dot(x10);
        }
        constraints {
            c11: dot(x11) = 2*dot(x10) - dot(x1);
            c12: dot(x12) = rate*cos(t);
        }
        kinetic_energy = m/2*(dot(x1)^2 + dot(x2)^2 + dot(x3)^2 + dot(x4)^2 + dot(x5)^2 + dot(x6)^2
                            + dot(x7)^2 + dot(x8)^2 + dot(x9)^2 + dot(x10)^2 + dot(x11)^2 + dot(x12)^2);
        potential_energy = k/2*(x1^2 + (x2 - x1)^2 + (x3 - x2)^2 + (x4 - x3)^2 + (x5 - x4)^2 + (x6 - x5)^2
                + (x7 - x6)^2 + (x8 - x7)^2 + (x9 - x8)^2 + (x10 - x9)^2 + (x11 - x10)^2 + (x12 - x11)^2)
            + b/4*(x1^4 + (x2 - x1)^4 + (x3 - x2)^4 + (x4 - x3)^4 + (x5 - x4)^4 + (x6 - x5)^4
                + (x7 - x6)^4 + (x8 - x7)^4 + (x9 - x8)^4 + (x10 - x9)^4 + (x11 - x10)^4 + (x12 - x11)^4);
    }
}

guen::mechanical_system! {
    /// Six equal rods with point masses, in absolute angles: a dense mass matrix.
    pub system Sixfold {
        constants { l > 0, g = 9.81 }
        coordinates { q1, q2, q3, q4, q5, q6 }
        parameters { w1 = dot(q1); w2 = dot(q2); w3 = dot(q3); w4 = dot(q4); w5 = dot(q5); w6 = dot(q6); }
        let p1 = vec(l*sin(q1), -l*cos(q1));
        let p2 = p1 + vec(l*sin(q2), -l*cos(q2));
        let p3 = p2 + vec(l*sin(q3), -l*cos(q3));
        let p4 = p3 + vec(l*sin(q4), -l*cos(q4));
        let p5 = p4 + vec(l*sin(q5), -l*cos(q5));
        let p6 = p5 + vec(l*sin(q6), -l*cos(q6));
        particles { 1 at p1; 1 at p2; 1 at p3; 1 at p4; 1 at p5; 1 at p6; }
        gravity = vec(0, -g);
    }
}

/// The constraints put in by hand: the masses 10 and 11 and the first share their forces.
#[test]
fn chain_of_twelve() {
    let (m, k, b, drive) = (0.9, 4.0, 0.7, 0.3);
    let system = Chain::new(m, k, b, drive).prepare().unwrap();
    let t = 0.6_f64;
    let x: [f64; 12] = std::array::from_fn(|i| (1.3 * i as f64).sin() * 0.4 + 0.1 * i as f64);
    let state: [f64; 22] = std::array::from_fn(|i| if i < 12 { x[i] } else { (i as f64).cos() });
    let pull = |i: usize| {
        let d = if i == 0 { x[0] } else { x[i] - x[i - 1] };
        k * d + b * d * d * d
    };
    let force: [f64; 12] = std::array::from_fn(|i| if i == 11 { -pull(11) } else { pull(i + 1) - pull(i) });
    let rates = System::rhs(&system, t, &state);
    for i in 1..9 {
        assert_near(rates[12 + i], force[i] / m, 1e-13);
    }
    // x11'' = 2 x10'' - x1'': virtual work over x1 and x10.
    let mass = SMatrix::<f64, 2, 2>::new(2.0 * m, -2.0 * m, -2.0 * m, 5.0 * m);
    let solved = mass.lu().solve(&SVector::<f64, 2>::new(force[0] - force[10], force[9] + 2.0 * force[10]));
    let solved = solved.unwrap();
    assert_near(rates[12], solved[0], 1e-13);
    assert_near(rates[21], solved[1], 1e-13);
    assert_near(rates[10], 2.0 * state[21] - state[12], 1e-15);
    assert_near(rates[11], drive * t.cos(), 1e-15);
    let reactions = <[f64; 2]>::from(system.reactions(t, &state.into()));
    assert_near(reactions[0], m * (2.0 * solved[1] - solved[0]) - force[10], 1e-13);
    assert_near(reactions[1], -m * drive * t.sin() - force[11], 1e-13);
    assert_eq!(chain::INTEGRABLE, 2);
}

/// `sum_j (7 - max(i, j)) (cos(q_i - q_j) q_j'' + sin(q_i - q_j) q_j'^2) = -(7 - i) g/l sin(q_i)`.
#[test]
fn sixfold_pendulum() {
    let (l, g) = (0.7, 9.81);
    let system = Sixfold::new(l).prepare().unwrap();
    let q: [f64; 6] = std::array::from_fn(|i| 0.3 * (i as f64 - 1.7) + 0.2 * (i as f64).sin());
    let w: [f64; 6] = std::array::from_fn(|i| (2.0 * i as f64).cos());
    let weight = |i: usize, j: usize| (6 - i.max(j)) as f64;
    let mass = SMatrix::<f64, 6, 6>::from_fn(|i, j| weight(i, j) * (q[i] - q[j]).cos());
    let force = SVector::<f64, 6>::from_fn(|i, _| {
        let turning: f64 = (0..6).map(|j| weight(i, j) * (q[i] - q[j]).sin() * w[j] * w[j]).sum();
        -turning - weight(i, i) * g / l * q[i].sin()
    });
    let expected = mass.lu().solve(&force).unwrap();
    let state: [f64; 12] = std::array::from_fn(|i| if i < 6 { q[i] } else { w[i - 6] });
    let rates = System::rhs(&system, 0.0, &state);
    for i in 0..6 {
        assert_near(rates[6 + i], expected[i], 1e-11);
    }
    let end = Integration::new(&system, 0.0, &state).run(&Dop853::new(1e-11, 1e-11), 1.0).unwrap().state;
    assert_near(system.energy(1.0, &end.into()), system.energy(0.0, &state.into()), 1e-9);
}
