//! Balls that roll: on a turntable, on a belt, on planes with unequal moments of inertia; in quaternions and in angles.

use guen::Real;
use guen::prelude::*;
use nalgebra::Vector3;

use crate::by_hand::{
    Body, ByHand, Numbers, apply, by_quaternion, check, column, cross, diagonal, inner, minus, moving,
    product, real, rot_x, rot_z, spin, transposed, velocity_at,
};

guen::mechanical_system! {
    /// A ball on a table that turns evenly.
    pub system TableBall {
        constants { m > 0, a > 0, Omega, g = 9.81 }
        coordinates { w, i, j, k, x, y }
        let R = quaternion(w, i, j, k);
        let moment = 2/5*m*a^2;
        bodies { ball { mass: m, inertia: diag(moment, moment, moment), center: vec(x, y, a), orientation: R } }
        gravity = vec(0, 0, -g);
        parameters { omega = angular_velocity(R); }
        let contact = vec(x, y, 0);
        constraints { rolling: ball.velocity_at(contact) = cross(vec(0, 0, Omega), contact); }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
    }
}

belt_ball!(guen::mechanical_system);

guen::mechanical_system! {
    /// The ball on a belt in the angles of Euler.
    pub system AngleBall {
        constants { m > 0, a > 0, A > 0, B > 0, C > 0, u, nu }
        coordinates { psi, theta, phi, x, y }
        let R = rot_z(psi)*rot_x(theta)*rot_z(phi);
        bodies { ball { mass: m, inertia: diag(A, B, C), center: vec(x, y, a), orientation: R } }
        parameters { spin = angular_velocity_body(R); }
        constraints { rolling: ball.velocity_at(vec(x, y, 0)) = vec(u*cos(nu*t), 0, 0); }
    }
}

const MASS: f64 = 1.3;
const RADIUS: f64 = 0.8;

/// A ball by quaternion or by angles, on a table or on a belt.
struct Hand {
    quaternions: bool,
    in_body: bool,
    moments: [f64; 3],
    turn: f64,
    belt: (f64, f64),
}

impl ByHand for Hand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let (rotation, place) = if self.quaternions {
            (by_quaternion(x), &x[4..])
        } else {
            (product(&product(&rot_z(x[0]), &rot_x(x[1])), &rot_z(x[2])), &x[3..])
        };
        let center = [place[0], place[1], real(RADIUS)];
        vec![Body { mass: MASS, inertia: diagonal(self.moments), center, rotation }]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let body = self.bodies(time, &path).remove(0);
        let omega = spin(&body.rotation);
        let mut forms = if self.in_body {
            apply(&transposed(&body.rotation.map(|row| row.map(|e| e.value))), &omega).to_vec()
        } else {
            omega.to_vec()
        };
        let [cx, cy, _] = body.center.map(|e| e.value);
        let point = [cx, cy, R::zero()];
        let (u, nu) = self.belt;
        let belt = [real::<R>(u) * (real::<R>(nu) * t).cos(), R::zero(), R::zero()];
        let turning = cross(&[R::zero(), R::zero(), real(self.turn)], &point);
        let slip = minus(&minus(&velocity_at(&body, &point), &belt), &turning);
        forms.extend(&slip[..2]);
        if self.quaternions {
            forms.push(real::<R>(2.0) * (0..4).fold(R::zero(), |sum, i| sum + x[i] * v[i]));
        }
        forms
    }
}

fn unit_quaternion<const N: usize>(mut state: [f64; N]) -> [f64; N] {
    let length = state[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
    state[..4].iter_mut().for_each(|q| *q /= length);
    state
}

const MOMENTS: [f64; 3] = [0.5, 0.35, 0.3];

#[test]
fn balls_agree_with_the_calculation_by_hand() {
    let even = 0.4 * MASS * RADIUS * RADIUS;
    let table = TableBall { m: MASS, a: RADIUS, Omega: 1.7, g: 9.81 }.prepare().unwrap();
    let [A, B, C] = MOMENTS;
    let belt = BeltBall { m: MASS, a: RADIUS, A, B, C, u: 0.9, nu: 1.4 }.prepare().unwrap();
    let angles = AngleBall { m: MASS, a: RADIUS, A, B, C, u: 0.9, nu: 1.4 }.prepare().unwrap();
    let on_table =
        Hand { quaternions: true, in_body: false, moments: [even; 3], turn: 1.7, belt: (0.0, 0.0) };
    let mut on_belt =
        Hand { quaternions: true, in_body: true, moments: MOMENTS, turn: 0.0, belt: (0.9, 1.4) };
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let t = numbers.next();
        // The forces of the contact; the reaction of the quaternion's length is nobody's force.
        let state = unit_quaternion(numbers.state::<9>());
        let table_ball::Reactions { rolling_x, rolling_y, .. } = table.reactions(t, &state.into());
        check(&table, &on_table, t, &state, &[rolling_x, rolling_y], 6);
        let state = unit_quaternion(numbers.state::<9>());
        let belt_ball::Reactions { rolling_x, rolling_y, .. } = belt.reactions(t, &state.into());
        check(&belt, &on_belt, t, &state, &[rolling_x, rolling_y], 6);
        let mut state = numbers.state::<8>();
        state[1] += 1.5;
        on_belt.quaternions = false;
        let reactions: [f64; 2] = angles.reactions(t, &state.into()).into();
        check(&angles, &on_belt, t, &state, &reactions, 5);
        on_belt.quaternions = true;
    }
}

/// The velocity of the centre of a uniform ball turns at two sevenths of the table's rate.
#[test]
fn the_ball_on_the_table_goes_in_circles() {
    let table = TableBall { m: MASS, a: RADIUS, Omega: 1.7, g: 9.81 }.prepare().unwrap();
    let start =
        table_ball::State { w: 1.0, x: 0.5, omega_x: 0.3, omega_y: -1.0, omega_z: 2.0, ..Default::default() };
    let rate = 2.0 / 7.0 * 1.7;
    let first = table.velocities(0.0, &start);
    let end = Integration::new(&table, 0.0, &start.into()).run(&Dop853::new(1e-13, 1e-13), 20.0).unwrap();
    let end = table_ball::State::from(end.state);
    let (s, c) = f64::sin_cos(rate * 20.0);
    let x = start.x + (s * first.x - (1.0 - c) * first.y) / rate;
    let y = start.y + ((1.0 - c) * first.x + s * first.y) / rate;
    assert!((end.x - x).abs() < 1e-9 && (end.y - y).abs() < 1e-9, "{} {x} {} {y}", end.x, end.y);
    // The spin about the vertical is kept.
    assert!((end.omega_z - start.omega_z).abs() < 1e-11);
}

/// Chaplygin's ball keeps its energy and, about the point of contact, the whole vector of angular momentum.
#[test]
fn chaplygin_s_ball_keeps_four_integrals() {
    let [A, B, C] = MOMENTS;
    let ball = BeltBall { m: MASS, a: RADIUS, A, B, C, u: 0.0, nu: 0.0 }.prepare().unwrap();
    let momentum = |state: &[f64; 9]| {
        let rotation = by_quaternion(&state[..4]);
        let [p, q, r] = [state[6], state[7], state[8]];
        let own = Vector3::from(apply(&rotation, &[A * p, B * q, C * r]));
        let omega = Vector3::from(apply(&rotation, &[p, q, r]));
        let arm = Vector3::new(0.0, 0.0, RADIUS);
        own + MASS * arm.cross(&omega.cross(&arm))
    };
    let start = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.3, 2.0, -0.8];
    let (kept, energy) = (momentum(&start), ball.energy(0.0, &start.into()));
    assert!(belt_ball::GROWTH.len() > 1 && !belt_ball::CLASS.is_holonomic());
    Dop853::new(1e-13, 1e-13)
        .integrate(&ball, 0.0, &start, 50.0, |t, state| {
            assert!((momentum(state) - kept).norm() < 1e-10, "momentum at {t}");
            assert!((ball.energy(t, &(*state).into()) - energy).abs() < 1e-10, "energy at {t}");
            ControlFlow::Continue(())
        })
        .unwrap();
}

/// The same motion in angles and in quaternions; these begin at `theta = 0`, where the angles end.
#[test]
fn quaternions_pass_where_angles_end() {
    let [A, B, C] = MOMENTS;
    let redundant = BeltBall { m: MASS, a: RADIUS, A, B, C, u: 0.9, nu: 1.4 }.prepare().unwrap();
    let angles = AngleBall { m: MASS, a: RADIUS, A, B, C, u: 0.9, nu: 1.4 }.prepare().unwrap();
    let start = belt_ball::State { w: 1.0, spin_x: 1.0, spin_y: 0.4, spin_z: 0.7, ..Default::default() };
    let flat = angle_ball::State { spin_x: 1.0, spin_y: 0.4, spin_z: 0.7, ..Default::default() };
    assert!(!angles.rhs(0.0, &flat).psi.is_finite());
    let method = Dop853::new(1e-13, 1e-13);
    let go9 = |_: f64, _: &[f64; 9]| ControlFlow::Continue(());
    let early = method
        .integrate(
            &redundant,
            -1.0,
            &method.integrate(&redundant, 0.0, &start.into(), -1.0, go9).unwrap().state,
            0.0,
            go9,
        )
        .unwrap();
    assert!((early.state[0] - 1.0).abs() < 1e-11, "there and back through theta = 0");
    let middle = method.integrate(&redundant, 0.0, &start.into(), 0.5, go9).unwrap();
    let last = method.integrate(&redundant, 0.5, &middle.state, 2.0, go9).unwrap();
    let rotation = by_quaternion(&middle.state[..4]);
    let axle = column(&rotation, 2);
    let state = angle_ball::State {
        psi: axle[0].atan2(-axle[1]),
        theta: axle[2].acos(),
        phi: rotation[2][0].atan2(rotation[2][1]),
        x: middle.state[4],
        y: middle.state[5],
        spin_x: middle.state[6],
        spin_y: middle.state[7],
        spin_z: middle.state[8],
    };
    let end = Integration::new(&angles, 0.5, &state.into()).run(&method, 2.0).unwrap();
    for i in 0..5 {
        assert!((end.state[3 + i] - last.state[4 + i]).abs() < 1e-9, "entry {i}");
    }
    let end = angle_ball::State::from(end.state);
    let other = product(&product(&rot_z(end.psi), &rot_x(end.theta)), &rot_z(end.phi));
    let same = by_quaternion(&last.state[..4]);
    for k in 0..3 {
        assert!((inner(&column(&other, k), &column(&same, k)) - 1.0).abs() < 1e-10);
    }
}
