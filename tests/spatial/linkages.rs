//! Chains that close: a four-bar linkage by its vector of closure, and a bead on a moving wire.

use guen::Real;

use crate::by_hand::{
    Body, ByHand, Numbers, POINT, Vector, check, minus, moving, plus, rate, real, rot_z, upright,
};

guen::mechanical_system! {
    /// Crank, coupler and rocker between two fixed pivots, with a motor on the crank.
    pub system FourBar {
        constants { a > 0, b > 0, c > 0, d > 0, rho > 0, k >= 0, g = 9.81 }
        inputs { motor }
        coordinates { q1, q2, q3 }
        let crank = a*rot_z(q1).x;
        let coupler = b*rot_z(q2).x;
        let rocker = c*rot_z(q3).x;
        bodies {
            one { mass: rho*a, inertia: diag(0, 0, rho*a^3/12), center: crank/2, orientation: rot_z(q1) }
            two { mass: rho*b, inertia: diag(0, 0, rho*b^3/12), center: crank + coupler/2, orientation: rot_z(q2) }
            three { mass: rho*c, inertia: diag(0, 0, rho*c^3/12), center: vec(d, 0) + rocker/2, orientation: rot_z(q3) }
        }
        gravity = vec(0, -g);
        parameters { turn = dot(q1); }
        holonomic { closure: crank + coupler = vec(d, 0) + rocker; }
        forces {
            motor along turn;
            -k*two.angular_velocity along two.angular_velocity;
        }
    }
}

guen::mechanical_system! {
    /// A bead on a parabola that turns and grows, held on it by two positions.
    pub system WireBead {
        constants { m > 0, nu, c, g = 9.81 }
        coordinates { x, y, z }
        let p = vec(x, y, z);
        let side = rot_z(nu*t)*vec(1, 0, 0);
        particles { m at p; }
        gravity = vec(0, 0, -g);
        parameters { out = inner(side, dot(p)); }
        holonomic {
            plane: inner(rot_z(nu*t).y, p) = 0;
            wire: z = (1 + c*t)*inner(side, p)^2;
        }
    }
}

const A: f64 = 0.4;
const B: f64 = 1.1;
const C: f64 = 0.8;
const D: f64 = 1.0;

struct Bars {
    motor: f64,
}

impl Bars {
    fn tip<R: Real>(angle: R, length: f64) -> Vector<R> {
        [real::<R>(length) * angle.cos(), real::<R>(length) * angle.sin(), R::zero()]
    }

    fn gap<R: Real>(x: &[R]) -> Vector<R> {
        let chain = plus(&Self::tip(x[0], A), &Self::tip(x[1], B));
        minus(&minus(&chain, &Self::tip(x[2], C)), &[real(D), R::zero(), R::zero()])
    }

    /// Coupler and rocker to a crank, by the two circles of their joint; the upper one.
    fn closed(q1: f64) -> [f64; 3] {
        let [x, y, _] = Self::tip(q1, A);
        let (dx, dy) = (D - x, -y);
        let far = dx.hypot(dy);
        let along = (far * far + B * B - C * C) / (2.0 * far);
        let above = (B * B - along * along).sqrt();
        let joint = [x + (along * dx - above * dy) / far, y + (along * dy + above * dx) / far];
        [q1, (joint[1] - y).atan2(joint[0] - x), joint[1].atan2(joint[0] - D)]
    }
}

impl ByHand for Bars {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let bar = |length: f64, root: Vector<R>, angle: R| {
            let mass = 2.0 * length;
            let mut inertia = POINT;
            inertia[2][2] = mass * length * length / 12.0;
            Body {
                mass,
                inertia,
                center: plus(&root, &Self::tip(angle, length / 2.0)),
                rotation: rot_z(angle),
            }
        };
        let zero = [R::zero(); 3];
        vec![
            bar(A, zero, x[0]),
            bar(B, Self::tip(x[0], A), x[1]),
            bar(C, [real(D), R::zero(), R::zero()], x[2]),
        ]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (_, path) = moving(t, x, v);
        let gap = rate(&Self::gap(&path));
        vec![v[0], gap[0], gap[1]]
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, -9.81, 0.0]
    }

    fn forces(&self, _t: f64, _x: &[f64], v: &[f64]) -> Vec<f64> {
        vec![self.motor, -0.3 * v[1], 0.0]
    }
}

#[test]
fn four_bar_linkage() {
    let linkage = FourBar { a: A, b: B, c: C, d: D, rho: 2.0, k: 0.3, g: 9.81 }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let [q1, q2, q3] = Bars::closed(3.0 * numbers.next());
        assert!(Bars::gap(&[q1, q2, q3]).iter().all(|e| e.abs() < 1e-14));
        let state = [q1, q2, q3, numbers.next()];
        let motor = numbers.next();
        let inputs = four_bar::Inputs { motor };
        let reactions: [f64; 2] = linkage.reactions(0.0, &state.into(), &inputs).into();
        check(&linkage.driven(inputs), &Bars { motor }, 0.0, &state, &reactions, 3);
    }
    assert!(four_bar::CLASS.is_holonomic());
}

struct Wire;

impl ByHand for Wire {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        vec![Body { mass: 1.2, inertia: POINT, center: [x[0], x[1], x[2]], rotation: upright() }]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let (s, c) = (real::<guen::Dual<R, 1>>(0.7) * time).sin_cos();
        let (out, across) = (c * path[0] + s * path[1], c * path[1] - s * path[0]);
        let growth = real::<guen::Dual<R, 1>>(1.0) + real::<guen::Dual<R, 1>>(0.2) * time;
        let wire = path[2] - growth * out * out;
        vec![c.value * v[0] + s.value * v[1], across.tangent[0], wire.tangent[0]]
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, 0.0, -9.81]
    }
}

#[test]
fn bead_on_a_moving_wire() {
    let bead = WireBead { m: 1.2, nu: 0.7, c: 0.2, g: 9.81 }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let (t, out) = (2.0 * numbers.next(), numbers.next());
        let (s, c) = f64::sin_cos(0.7 * t);
        let state = [c * out, s * out, (1.0 + 0.2 * t) * out * out, numbers.next()];
        let reactions: [f64; 2] = bead.reactions(t, &state.into()).into();
        check(&bead, &Wire, t, &state, &reactions, 3);
    }
}
