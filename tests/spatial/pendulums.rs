//! Pendulums: a point on a sphere by angles and by a constraint on its position, two rods, a body on a moving pivot.

use guen::Real;

use crate::by_hand::{
    Body, ByHand, Matrix, Numbers, POINT, Vector, apply, by_quaternion, check, close, moving, plus, product,
    rate, real, rot_x, rot_z, spin, times, upright,
};

guen::mechanical_system! {
    pub system Spherical {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { theta, psi }
        let R = rot_z(psi)*rot_y(theta);
        particles { m at -l*R.z; }
        gravity = vec(0, 0, -g);
        parameters { falling = dot(theta); turning = dot(psi); }
    }
}

guen::mechanical_system! {
    pub system Tethered {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates { x, y, z }
        let p = vec(x, y, z);
        particles { m at p; }
        gravity = vec(0, 0, -g);
        parameters { u = dot(x); v = dot(y); }
        holonomic { rod: inner(p, p) = l^2; }
    }
}

guen::mechanical_system! {
    /// Two rods in a plane, their angles from the vertical, friction in the middle joint.
    pub system DoublePendulum {
        constants { m1 > 0, m2 > 0, l1 > 0, l2 > 0, c >= 0, g = 9.81 }
        coordinates { q1, q2 }
        let A = rot_z(q1);
        let B = rot_z(q2);
        let joint = -l1*A.y;
        bodies {
            upper { mass: m1, inertia: diag(0, 0, m1*l1^2/12), center: joint/2, orientation: A }
            lower { mass: m2, inertia: diag(0, 0, m2*l2^2/12), center: joint - l2/2*B.y, orientation: B }
        }
        gravity = vec(0, -g);
        parameters { w1 = dot(q1); w2 = dot(q2); }
        let slip = lower.angular_velocity - upper.angular_velocity;
        forces { -c*slip along slip; }
    }
}

guen::mechanical_system! {
    /// A skew body on a frame that is driven about a tilted axis, its pivot going up and down: everything moves by
    /// itself. A spring pulls one of its points, a constant torque turns it.
    pub system Gimbal {
        constants { m > 0, p, q, r, nu, h, c, f, s, g = 9.81 }
        coordinates { b, d }
        let axis = unit(vec(p, q, r));
        let R = rot(axis, nu*t)*rot_x(b)*rot(vec(3/5, 0, 4/5), d);
        let pivot = vec(0, 0, h*sin(nu*t));
        bodies {
            skew {
                mass: m,
                inertia: sym(3*c, 4*c, 5*c, c/2, -c/3, c/5),
                center: pivot + R*vec(1, 0, 1/2),
                orientation: R,
            }
        }
        gravity = vec(0, 0, -g);
        parameters { turn = dot(b); spin = dot(d) + dot(b)*cos(d); }
        let tip = pivot + 2*R.y;
        forces {
            -s*tip along dot(tip);
            vec(0, f, 0) along skew.angular_velocity;
        }
        outputs {
            at_tip = skew.velocity_at(tip);
            speed = skew.velocity_at(pivot);
        }
    }
}

const M: f64 = 1.2;
const L: f64 = 0.9;
const G: f64 = 9.81;

struct Point {
    tethered: bool,
}

impl ByHand for Point {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let center = if self.tethered {
            [x[0], x[1], x[2]]
        } else {
            let (s, c) = x[0].sin_cos();
            times(real(-L), &[s * x[1].cos(), s * x[1].sin(), c])
        };
        vec![Body { mass: M, inertia: POINT, center, rotation: upright() }]
    }

    fn forms<R: Real>(&self, _t: R, x: &[R], v: &[R]) -> Vec<R> {
        let mut forms = v[..2].to_vec();
        if self.tethered {
            forms.push(real::<R>(2.0) * (0..3).fold(R::zero(), |sum, i| sum + x[i] * v[i]));
        }
        forms
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, 0.0, -G]
    }
}

#[test]
fn a_point_on_a_sphere() {
    let angles = Spherical { m: M, l: L, g: G }.prepare().unwrap();
    let tethered = Tethered { m: M, l: L, g: G }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let mut state: [f64; 4] = numbers.state();
        state[0] += 1.5;
        check(&angles, &Point { tethered: false }, 0.0, &state, &[], 2);
        let [theta, psi, falling, turning] = state;
        // theta'' = sin cos psi'^2 - g/l sin (theta from the vertical that points down), psi'' = -2 cot theta' psi'
        let (s, c) = theta.sin_cos();
        let rates: [f64; 4] = angles.rhs(0.0, &state.into()).into();
        let expected = [s * c * turning * turning - G / L * s, -2.0 * c / s * falling * turning];
        close("closed form", &rates[2..], &expected);

        let mut state: [f64; 5] = numbers.state();
        let z = theta.cos();
        state[..3].copy_from_slice(&[-L * s * psi.cos(), -L * s * psi.sin(), -L * z]);
        let reactions: [f64; 1] = tethered.reactions(0.0, &state.into()).into();
        check(&tethered, &Point { tethered: true }, 0.0, &state, &reactions, 3);
        let residuals: [f64; 1] = tethered.residuals(0.0, &state.into()).into();
        assert!(residuals[0].abs() < 1e-15);
    }
}

struct Rods;

impl ByHand for Rods {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        let rod = |angle: R, length: f64| {
            [real::<R>(length) * angle.sin(), -real::<R>(length) * angle.cos(), R::zero()]
        };
        let bar = |mass: f64, length: f64, center: Vector<R>, angle: R| {
            let mut inertia = POINT;
            inertia[2][2] = mass * length * length / 12.0;
            Body { mass, inertia, center, rotation: rot_z(angle) }
        };
        let joint = rod(x[0], 0.9);
        vec![bar(1.2, 0.9, rod(x[0], 0.45), x[0]), bar(0.8, 0.6, plus(&joint, &rod(x[1], 0.3)), x[1])]
    }

    fn forms<R: Real>(&self, _t: R, _x: &[R], v: &[R]) -> Vec<R> {
        v.to_vec()
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, -G, 0.0]
    }

    fn forces(&self, _t: f64, _x: &[f64], v: &[f64]) -> Vec<f64> {
        let torque = 0.3 * (v[1] - v[0]);
        vec![torque, -torque]
    }
}

#[test]
fn two_rods() {
    let system = DoublePendulum { m1: 1.2, m2: 0.8, l1: 0.9, l2: 0.6, c: 0.3, g: G }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        check(&system, &Rods, 0.0, &numbers.state::<4>(), &[], 2);
    }
}

struct Driven;

const AXIS: [f64; 3] = [0.4, -0.7, 1.1];
const NU: f64 = 1.3;
const H: f64 = 0.4;
const C_: f64 = 0.2;
const F: f64 = 0.7;
const S: f64 = 1.9;

impl Driven {
    fn about<R: Real>(axis: [f64; 3], angle: R) -> Matrix<R> {
        let length = axis.iter().map(|e| e * e).sum::<f64>().sqrt();
        let (s, c) = (real::<R>(0.5) * angle).sin_cos();
        let [x, y, z] = axis.map(|e| real::<R>(e / length) * s);
        by_quaternion(&[c, x, y, z])
    }

    fn pivot<R: Real>(t: R) -> Vector<R> {
        [R::zero(), R::zero(), real::<R>(H) * (real::<R>(NU) * t).sin()]
    }

    fn rotation<R: Real>(t: R, x: &[R]) -> Matrix<R> {
        let inner = product(&rot_x(x[0]), &Self::about([0.6, 0.0, 0.8], x[1]));
        product(&Self::about(AXIS, real::<R>(NU) * t), &inner)
    }

    fn tip<R: Real>(t: R, x: &[R]) -> Vector<R> {
        plus(&Self::pivot(t), &apply(&Self::rotation(t, x), &[R::zero(), real(2.0), R::zero()]))
    }
}

impl ByHand for Driven {
    fn bodies<R: Real>(&self, t: R, x: &[R]) -> Vec<Body<R>> {
        let rotation = Self::rotation(t, x);
        let center = plus(&Self::pivot(t), &apply(&rotation, &[R::one(), R::zero(), real(0.5)]));
        let c = C_;
        let inertia =
            [[3.0 * c, c / 2.0, c / 5.0], [c / 2.0, 4.0 * c, -c / 3.0], [c / 5.0, -c / 3.0, 5.0 * c]];
        vec![Body { mass: 1.7, inertia, center, rotation }]
    }

    fn forms<R: Real>(&self, _t: R, x: &[R], v: &[R]) -> Vec<R> {
        vec![v[0], v[1] + v[0] * x[1].cos()]
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, 0.0, -G]
    }

    fn forces(&self, t: f64, x: &[f64], _v: &[f64]) -> Vec<f64> {
        let tip = Self::tip(t, x);
        (0..2)
            .map(|i| {
                let mut v = [0.0; 2];
                v[i] = 1.0;
                let (mut time, path) = moving(t, x, &v);
                time.tangent = [0.0];
                let lever = rate(&Self::tip(time, &path));
                let turning = spin(&Self::rotation(time, &path));
                -S * (0..3).map(|k| tip[k] * lever[k]).sum::<f64>() + F * turning[1]
            })
            .collect()
    }
}

#[test]
fn a_body_on_a_driven_frame() {
    let [p, q, r] = AXIS;
    let system = Gimbal { m: 1.7, p, q, r, nu: NU, h: H, c: C_, f: F, s: S, g: G }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let (t, state) = (2.0 * numbers.next(), numbers.state::<4>());
        check(&system, &Driven, t, &state, &[], 2);
        let velocities: [f64; 2] = system.velocities(t, &state.into()).into();
        let (time, path) = moving(t, &state[..2], &velocities);
        let outputs = system.outputs(t, &state.into());
        close("tip", &outputs.at_tip, &rate(&Driven::tip(time, &path)));
        close("pivot", &outputs.speed, &rate(&Driven::pivot(time)));
    }
}
