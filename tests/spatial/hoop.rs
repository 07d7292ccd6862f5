//! The hoop as a body with a contact: the paper's equations, the cost of the paper's declaration, and quaternions.

use guen::Real;
use guen::prelude::*;
use guen_benchmarks::systems::{BODYHOOP_TEXT, BodyHoop, body_hoop};

use crate::by_hand::{
    Body, ByHand, Numbers, Vector, apply, by_quaternion, check, column, cross, diagonal, inner, moving, plus,
    product, real, rot_x, rot_z, spin, times, velocity_at,
};
use crate::formulas::derive;

mod paper {
    hoop!(guen::mechanical_system);
}

quaternion_hoop!(guen::mechanical_system);

const A_RADIUS: f64 = 0.7;
const DIAMETER: f64 = 0.4;
const AXIS: f64 = 0.6;

/// Both hoops: by angles and by quaternions.
struct Hand {
    quaternions: bool,
}

impl ByHand for Hand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let (rotation, center) = if self.quaternions {
            (by_quaternion(x), [x[4], x[5], x[6]])
        } else {
            (product(&product(&rot_z(x[1]), &rot_x(x[0])), &rot_z(x[2])), [x[3], x[4], x[5]])
        };
        vec![Body { mass: 1.0, inertia: diagonal([DIAMETER, DIAMETER, AXIS]), center, rotation }]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (t, path) = moving(t, x, v);
        let body = self.bodies(t, &path).remove(0);
        let axle = column(&body.rotation, 2).map(|e| e.value);
        let up = [R::zero(), R::zero(), R::one()];
        // In the plane of the hoop, downwards.
        let steep = plus(&times(inner(&up, &axle), &axle), &times(-R::one(), &up));
        let arm = times(real::<R>(A_RADIUS) / inner(&steep, &steep).sqrt(), &steep);
        let touch: Vector<R> = plus(&body.center.map(|e| e.value), &arm);
        let slip = velocity_at(&body, &touch);
        let omega = spin(&body.rotation);
        if self.quaternions {
            let axes = [0, 1, 2].map(|k| column(&body.rotation, k).map(|e| e.value));
            let mut forms: Vec<R> = axes.iter().map(|axis| inner(axis, &omega)).collect();
            forms.extend(slip);
            forms.push(real::<R>(2.0) * (0..4).fold(R::zero(), |sum, i| sum + x[i] * v[i]));
            forms
        } else {
            let horizontal = apply(&rot_z(x[1]), &[R::one(), R::zero(), R::zero()]);
            let rising = cross(&axle, &horizontal);
            let mut forms = [horizontal, rising, axle].map(|axis| inner(&axis, &omega)).to_vec();
            forms.extend(slip);
            forms
        }
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, 0.0, -9.81]
    }
}

#[test]
fn the_body_derives_the_paper_s_equations() {
    derive(BODYHOOP_TEXT, |hoop| {
        hoop.equation(1, "(A + a^2)*dot(eta1) - A*cot(theta)*eta2^2 + (C + a^2)*eta2*eta3 + a*g*cos(theta)");
        hoop.equation(2, "A*dot(eta2) + A*cot(theta)*eta1*eta2 - C*eta1*eta3");
        hoop.equation(3, "(C + a^2)*dot(eta3) - a^2*eta1*eta2");
    });
    assert_eq!(body_hoop::COST, paper::hoop::COST);
    const {
        let cost = body_hoop::COST;
        assert!(cost.additions + cost.multiplications + cost.divisions == 24 && cost.calls == 2);
    }
    assert_eq!(body_hoop::GROWTH, [3, 4, 5]);
}

#[test]
fn both_agree_with_the_calculation_by_hand() {
    let system = BodyHoop { a: A_RADIUS, A: DIAMETER, C: AXIS, g: 9.81 }.prepare().unwrap();
    let quaternions = QuaternionHoop { a: A_RADIUS, A: DIAMETER, C: AXIS, g: 9.81 }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let mut state: [f64; 9] = numbers.state();
        state[0] = 1.5 + 1.2 * state[0];
        let reactions: [f64; 3] = system.reactions(0.0, &state.into()).into();
        check(&system, &Hand { quaternions: false }, 0.0, &state, &reactions, 6);

        let mut state: [f64; 10] = numbers.state();
        let length = state[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
        state[..4].iter_mut().for_each(|q| *q /= length);
        let reactions = quaternions.reactions(0.0, &state.into());
        let contact = [reactions.rolling_x, reactions.rolling_y, reactions.rolling_z];
        check(&quaternions, &Hand { quaternions: true }, 0.0, &state, &contact, 7);
    }
}

/// What is compared can differ: a hoop of other inertia is seen.
#[test]
#[should_panic(expected = "rates")]
fn another_hoop_is_seen() {
    let system = BodyHoop { a: A_RADIUS, A: DIAMETER, C: 1.01 * AXIS, g: 9.81 }.prepare().unwrap();
    let state = [1.2, 0.3, 0.1, 0.0, 0.0, 0.0, 0.3, 0.4, 2.0];
    check(&system, &Hand { quaternions: false }, 0.0, &state, &[], 6);
}

/// The same motion, as long as the hoop does not lie flat.
#[test]
fn quaternions_follow_the_angles() {
    let (theta, psi, phi) = (1.1_f64, 0.4_f64, -0.3_f64);
    let angles = BodyHoop { a: A_RADIUS, A: DIAMETER, C: AXIS, g: 9.81 }.prepare().unwrap();
    let redundant = QuaternionHoop { a: A_RADIUS, A: DIAMETER, C: AXIS, g: 9.81 }.prepare().unwrap();
    let (eta1, eta2, eta3) = (0.3, 0.8, 4.0);
    let start = body_hoop::State {
        theta,
        psi,
        phi,
        xi: 0.0,
        eta: 0.0,
        zeta: A_RADIUS * theta.sin(),
        eta1,
        eta2,
        eta3,
    };
    // exp(psi z/2) exp(theta x/2) exp(phi z/2), and the rates in the body's own axes.
    let (plus, minus) = ((psi + phi) / 2.0, (psi - phi) / 2.0);
    let (s, c) = (theta / 2.0).sin_cos();
    let same = quaternion_hoop::State {
        w: c * plus.cos(),
        i: s * minus.cos(),
        j: s * minus.sin(),
        k: c * plus.sin(),
        zeta: start.zeta,
        spin_x: eta1 * phi.cos() + eta2 * phi.sin(),
        spin_y: -eta1 * phi.sin() + eta2 * phi.cos(),
        spin_z: eta3,
        ..Default::default()
    };
    let method = Dop853::new(1e-13, 1e-13);
    let go = |_: f64, _: &[f64; 9]| ControlFlow::Continue(());
    let end = method.integrate(&angles, 0.0, &start.into(), 3.0, go).unwrap();
    let go = |_: f64, _: &[f64; 10]| ControlFlow::Continue(());
    let redundant_end = method.integrate(&redundant, 0.0, &same.into(), 3.0, go).unwrap();
    let (a, b) = (body_hoop::State::from(end.state), quaternion_hoop::State::from(redundant_end.state));
    let axle = [a.psi.sin() * a.theta.sin(), -a.psi.cos() * a.theta.sin(), a.theta.cos()];
    let found = redundant.outputs(3.0, &b).axle;
    for (x, y) in axle.iter().zip(&found).chain([(&a.xi, &b.xi), (&a.eta, &b.eta), (&a.zeta, &b.zeta)]) {
        assert!((x - y).abs() < 1e-10, "{x} {y}");
    }
    assert!((a.eta3 - b.spin_z).abs() < 1e-10);
}
