//! What is zero is judged on the holonomic constraints: a component that vanishes only there imposes nothing.

use guen::System;

use crate::by_hand::Numbers;

guen::mechanical_system! {
    /// A ball that rolls on a table at rest.
    pub system Ball {
        constants { m > 0, a > 0 }
        coordinates { w, i, j, k, x, y }
        let R = quaternion(w, i, j, k);
        let moment = 2/5*m*a^2;
        bodies { ball { mass: m, inertia: diag(moment, moment, moment), center: vec(x, y, a), orientation: R } }
        parameters { omega = angular_velocity(R); }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
        constraints { rolling: ball.velocity_at(vec(x, y, 0)) = 0; }
    }
}

guen::mechanical_system! {
    /// The same ball; the third component of its constraint is zero where the quaternion has its length.
    pub system Disguised {
        constants { m > 0, a > 0 }
        coordinates { w, i, j, k, x, y }
        let R = quaternion(w, i, j, k);
        let moment = 2/5*m*a^2;
        let excess = w^2 + i^2 + j^2 + k^2 - 1;
        bodies { ball { mass: m, inertia: diag(moment, moment, moment), center: vec(x, y, a), orientation: R } }
        parameters { omega = angular_velocity(R); }
        holonomic { length: excess = 0; }
        constraints { rolling: ball.velocity_at(vec(x, y, 0)) + excess*dot(x)*vec(0, 0, 1) = 0; }
    }
}

#[test]
fn a_component_that_vanishes_on_the_constraints_is_left_out() {
    let plain = Ball { m: 1.3, a: 0.8 }.prepare().unwrap();
    let disguised = Disguised { m: 1.3, a: 0.8 }.prepare().unwrap();
    assert!(disguised::REPORT.lines("Forms").contains(&"rolling_z is left out: it says 0 = 0"));
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let mut state: [f64; 9] = numbers.state();
        let length = state[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
        state[..4].iter_mut().for_each(|q| *q /= length);
        let (one, other) = (System::rhs(&plain, 0.0, &state), System::rhs(&disguised, 0.0, &state));
        for (a, b) in one.iter().zip(other) {
            assert!((a - b).abs() <= 1e-13, "{a} and {b}");
        }
    }
}
