//! A free rigid body in quaternions and in angles, and Suslov's body, which cannot turn about one of its own axes.

use guen::Real;
use guen::prelude::*;

use crate::by_hand::{
    Body, ByHand, Matrix, Numbers, apply, by_quaternion, check, close, column, diagonal, inner, moving,
    product, real, rot_x, rot_z, spin, transposed,
};

guen::mechanical_system! {
    pub system QuaternionTop {
        constants { A > 0, B > 0, C > 0 }
        coordinates { w, i, j, k }
        let R = quaternion(w, i, j, k);
        bodies { top { inertia: diag(A, B, C), orientation: R } }
        parameters { spin = angular_velocity_body(R); }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
    }
}

guen::mechanical_system! {
    pub system AngleTop {
        constants { A > 0, B > 0, C > 0 }
        coordinates { psi, theta, phi }
        let R = rot_z(psi)*rot_x(theta)*rot_z(phi);
        bodies { top { inertia: diag(A, B, C), orientation: R } }
        parameters { spin = angular_velocity_body(R); }
    }
}

guen::mechanical_system! {
    pub system Suslov {
        constants { A > 0, B > 0, C > 0, D, E }
        coordinates { psi, theta, phi }
        let R = rot_z(psi)*rot_x(theta)*rot_z(phi);
        bodies { body { inertia: sym(A, B, C, 0, D, E), orientation: R } }
        parameters {
            p = angular_velocity_body(R).x;
            q = angular_velocity_body(R).y;
        }
        constraints { fork: inner(R.z, body.angular_velocity) = 0; }
    }
}

guen::mechanical_system! {
    /// Two components of the angular velocity are the same expression, in the body and in the world.
    pub system Spindle {
        constants { A > 0, B > 0, C > 0, D, E, F, kappa }
        coordinates { turn }
        let R = rot(unit(vec(1, 2, 2)), turn);
        bodies { body { inertia: sym(A, B, C, D, E, F), orientation: R } }
        parameters { omega = dot(turn); }
        potential_energy = kappa/2*turn^2;
    }
}

struct Hand {
    quaternions: bool,
    inertia: Matrix<f64>,
    constrained: bool,
}

impl ByHand for Hand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let rotation = if self.quaternions {
            by_quaternion(x)
        } else {
            product(&product(&rot_z(x[0]), &rot_x(x[1])), &rot_z(x[2]))
        };
        vec![Body { mass: 0.0, inertia: self.inertia, center: [R::zero(); 3], rotation }]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let rotation = self.bodies(time, &path).remove(0).rotation;
        let [p, q, r] = apply(&transposed(&rotation.map(|row| row.map(|e| e.value))), &spin(&rotation));
        let mut forms = vec![p, q, r];
        if self.quaternions {
            forms.push(real::<R>(2.0) * (0..4).fold(R::zero(), |sum, i| sum + x[i] * v[i]));
        }
        debug_assert!(!self.constrained || forms.len() == 3);
        forms
    }
}

const MOMENTS: [f64; 3] = [0.9, 0.7, 0.5];

#[test]
fn tops_agree_with_the_calculation_by_hand() {
    let [A, B, C] = MOMENTS;
    let redundant = QuaternionTop { A, B, C }.prepare().unwrap();
    let angles = AngleTop { A, B, C }.prepare().unwrap();
    let mut numbers = Numbers::new();
    let inertia = diagonal(MOMENTS);
    for _ in 0..20 {
        let mut state: [f64; 7] = numbers.state();
        let length = state[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
        state[..4].iter_mut().for_each(|q| *q /= length);
        check(&redundant, &Hand { quaternions: true, inertia, constrained: false }, 0.0, &state, &[], 4);
        let mut state: [f64; 6] = numbers.state();
        state[1] += 1.5;
        check(&angles, &Hand { quaternions: false, inertia, constrained: false }, 0.0, &state, &[], 3);
    }
}

/// The Euler top from `theta = 0` on: the angular momentum stays in the world, and the angles agree once they exist.
#[test]
fn the_top_passes_where_angles_end() {
    let [A, B, C] = MOMENTS;
    let redundant = QuaternionTop { A, B, C }.prepare().unwrap();
    let angles = AngleTop { A, B, C }.prepare().unwrap();
    let start = [1.0, 0.0, 0.0, 0.0, 1.2, 0.5, 0.8];
    let momentum =
        |state: &[f64; 7]| apply(&by_quaternion(&state[..4]), &[A * state[4], B * state[5], C * state[6]]);
    let kept = momentum(&start);
    let method = Dop853::new(1e-13, 1e-13);
    let mut watch = |_: f64, state: &[f64; 7]| {
        let now = momentum(state);
        assert!((0..3).all(|i| (now[i] - kept[i]).abs() < 1e-10));
        ControlFlow::Continue(())
    };
    let middle = method
        .integrate(
            &redundant,
            -3.0,
            &method.integrate(&redundant, 0.0, &start, -3.0, &mut watch).unwrap().state,
            0.5,
            &mut watch,
        )
        .unwrap();
    let last = method.integrate(&redundant, 0.5, &middle.state, 1.5, &mut watch).unwrap();
    let rotation = by_quaternion(&middle.state[..4]);
    let axle = column(&rotation, 2);
    let state = [
        axle[0].atan2(-axle[1]),
        axle[2].acos(),
        rotation[2][0].atan2(rotation[2][1]),
        middle.state[4],
        middle.state[5],
        middle.state[6],
    ];
    let end = Integration::new(&angles, 0.5, &state).run(&method, 1.5).unwrap().state;
    assert!((0..3).all(|i| (end[3 + i] - last.state[4 + i]).abs() < 1e-10));
    let other = product(&product(&rot_z(end[0]), &rot_x(end[1])), &rot_z(end[2]));
    let same = by_quaternion(&last.state[..4]);
    for k in 0..3 {
        assert!((inner(&column(&other, k), &column(&same, k)) - 1.0).abs() < 1e-10);
    }
}

/// Suslov's equations `A p' = -(E p + D q) q`, `B q' = (E p + D q) p`, the reaction as a torque, the integral
/// `A p^2 + B q^2`, and the steady turning that every motion ends in.
#[test]
fn suslov_s_body_comes_to_turn_steadily() {
    let (A, B, C, D, E) = (0.9, 0.7, 1.1, 0.2, -0.15);
    let system = Suslov { A, B, C, D, E }.prepare().unwrap();
    let inertia = [[A, 0.0, E], [0.0, B, D], [E, D, C]];
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let mut state: [f64; 5] = numbers.state();
        state[1] += 1.5;
        let [p, q] = [state[3], state[4]];
        let rate: [f64; 5] = system.rhs(0.0, &state.into()).into();
        let turning = E * p + D * q;
        close("rates", &rate[3..], &[-turning * q / A, turning * p / B]);
        let reactions: [f64; 1] = system.reactions(0.0, &state.into()).into();
        check(&system, &Hand { quaternions: false, inertia, constrained: true }, 0.0, &state, &reactions, 3);
    }
    let start = suslov::State { theta: 1.0, p: 0.3, q: 2.0, ..Default::default() };
    let integral = |state: &suslov::State| A * state.p.powi(2) + B * state.q.powi(2);
    let end = Dop853::new(1e-13, 1e-13).integrate(&system, 0.0, &start.into(), 60.0, |t, state| {
        assert!((integral(&(*state).into()) - integral(&start)).abs() < 1e-10, "at {t}");
        ControlFlow::Continue(())
    });
    // The angles may meet their pole on the way; the body's rates do not care.
    let state = match end {
        Ok(done) => suslov::State::from(done.state),
        Err(error) => panic!("{error}"),
    };
    assert!((E * state.p + D * state.q).abs() < 1e-8 && integral(&state) > 1.0);
}

/// `e . J e` for a turn about `e`, with every product of inertia.
#[test]
fn a_spindle_feels_its_inertia_about_an_axis_between_others() {
    let [A, B, C, D, E, F, kappa] = [2.0, 3.0, 2.5, 0.3, -0.4, 0.2, 1.7];
    let spindle = Spindle { A, B, C, D, E, F, kappa }.prepare().unwrap();
    let axis = [1.0, 2.0, 2.0].map(|e: f64| e / 3.0);
    let moment = inner(&axis, &apply(&[[A, D, F], [D, B, E], [F, E, C]], &axis));
    let state = spindle::State { turn: 0.8, omega: -1.3 };
    let rate = spindle.rhs(0.0, &state);
    close("rates", &[rate.turn, rate.omega], &[-1.3, -kappa * 0.8 / moment]);
    close("energy", &[spindle.kinetic_energy(0.0, &state)], &[moment / 2.0 * 1.3 * 1.3]);
}
