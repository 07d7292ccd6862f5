//! An ellipsoid that rolls on the plane, its axes of inertia turned against its own, in quaternions and in angles whose pole
//! no heading has: what holds on the constraint only, and next to a pole, against the calculation by hand.

use guen::{Real, System};

use crate::by_hand::{
    Body, ByHand, Matrix, Numbers, Vector, by_quaternion, check, column, inner, minus, moving, plus, product,
    real, rot_x, rot_y, rot_z, spin, times, velocity_at,
};

macro_rules! stone {
    ($System:ident, [$($q:ident),*], $R:expr, $spin:ident $(, $length:expr)?) => { guen::mechanical_system! {
        pub system $System {
            constants { m > 0, a > 0, b > 0, c > 0, h, A > 0, B > 0, C > 0, D, E, F, g = 9.81 }
            coordinates { $($q,)* x, y, z }
            let R = $R;
            let n = transpose(R)*vec(0, 0, 1);
            let size = sqrt((a*n.x)^2 + (b*n.y)^2 + (c*n.z)^2);
            let lowest = vec(a^2*n.x, b^2*n.y, c^2*n.z)/-size;
            bodies { stone { mass: m, inertia: sym(A, B, C, D, E, F), center: vec(x, y, z), orientation: R } }
            gravity = vec(0, 0, -g);
            parameters { spin = $spin(R); }
            constraints { rolling: stone.velocity_at(vec(x, y, z) + R*(lowest + vec(0, 0, h))) = 0; }
            $(holonomic { length: $length = 1; })?
        }
    } };
}

stone!(
    ByQuaternion,
    [w, i, j, k],
    quaternion(w, i, j, k),
    angular_velocity_body,
    w ^ 2 + i ^ 2 + j ^ 2 + k ^ 2
);
stone!(
    WorldByQuaternion,
    [w, i, j, k],
    quaternion(w, i, j, k),
    angular_velocity,
    w ^ 2 + i ^ 2 + j ^ 2 + k ^ 2
);
stone!(ByAngles, [p, q, r], rot_x(p) * rot_y(q) * rot_z(r), angular_velocity_body);
stone!(WorldByAngles, [p, q, r], rot_x(p) * rot_y(q) * rot_z(r), angular_velocity);

const AXES: [f64; 3] = [1.3, 0.6, 0.4];
const HEIGHT: f64 = 0.1;
const INERTIA: [f64; 6] = [0.3, 0.8, 0.9, 0.1, -0.07, 0.05];

/// The stone with its constants, prepared.
macro_rules! prepared {
    ($System:ident) => {{
        let ([a, b, c], [A, B, C, D, E, F]) = (AXES, INERTIA);
        $System { m: 1.1, a, b, c, h: HEIGHT, A, B, C, D, E, F, g: 9.81 }.prepare().unwrap()
    }};
}

struct Hand {
    quaternions: bool,
    in_body: bool,
}

impl Hand {
    fn rotation<R: Real>(&self, x: &[R]) -> (Matrix<R>, Vector<R>) {
        if self.quaternions {
            (by_quaternion(x), [x[4], x[5], x[6]])
        } else {
            (product(&product(&rot_x(x[0]), &rot_y(x[1])), &rot_z(x[2])), [x[3], x[4], x[5]])
        }
    }
}

impl ByHand for Hand {
    fn bodies<R: Real>(&self, _t: R, x: &[R]) -> Vec<Body<R>> {
        // Moments, then the entries xy, yz, zx.
        let [A, B, C, D, E, F] = INERTIA;
        let inertia = [[A, D, F], [D, B, E], [F, E, C]];
        let (rotation, center) = self.rotation(x);
        vec![Body { mass: 1.1, inertia, center, rotation }]
    }

    fn forms<R: Real>(&self, t: R, x: &[R], v: &[R]) -> Vec<R> {
        let (time, path) = moving(t, x, v);
        let body = self.bodies(time, &path).remove(0);
        let axes = [0, 1, 2].map(|k| column(&body.rotation, k).map(|e| e.value));
        let omega = spin(&body.rotation);
        let weighted = |k: usize| real::<R>(AXES[k] * AXES[k]) * axes[k][2];
        let size = (0..3).fold(R::zero(), |sum, k| sum + weighted(k) * axes[k][2]).sqrt();
        let mut touch = plus(&body.center.map(|e| e.value), &times(real(HEIGHT), &axes[2]));
        for (k, axis) in axes.iter().enumerate() {
            touch = minus(&touch, &times(weighted(k) / size, axis));
        }
        let mut forms: Vec<R> =
            if self.in_body { axes.iter().map(|axis| inner(axis, &omega)).collect() } else { omega.to_vec() };
        forms.extend(velocity_at(&body, &touch));
        if self.quaternions {
            forms.push(real::<R>(2.0) * (0..4).fold(R::zero(), |sum, i| sum + x[i] * v[i]));
        }
        forms
    }

    fn gravity(&self) -> Vector<f64> {
        [0.0, 0.0, -9.81]
    }
}

/// A state of length one: anywhere, next to a turn by nothing or by half a turn, or there, where components vanish.
fn of_length_one(numbers: &mut Numbers, round: usize) -> [f64; 10] {
    let mut state: [f64; 10] = numbers.state();
    if round % 3 > 0 {
        let distance = if round % 3 == 1 { 1e-5 } else { 0.0 };
        state[..4].iter_mut().for_each(|q| *q *= distance);
        state[round / 3 % 4] = 1.0;
    }
    let length = state[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
    state[..4].iter_mut().for_each(|q| *q /= length);
    state
}

#[test]
fn quaternions_agree_with_the_calculation_by_hand() {
    let (body, world) = (prepared!(ByQuaternion), prepared!(WorldByQuaternion));
    let mut numbers = Numbers::new();
    for round in 0..40 {
        let state = of_length_one(&mut numbers, round);
        let reactions = body.reactions(0.0, &state.into());
        let contact = [reactions.rolling_x, reactions.rolling_y, reactions.rolling_z];
        check(&body, &Hand { quaternions: true, in_body: true }, 0.0, &state, &contact, 7);
        let reactions = world.reactions(0.0, &state.into());
        let contact = [reactions.rolling_x, reactions.rolling_y, reactions.rolling_z];
        check(&world, &Hand { quaternions: true, in_body: false }, 0.0, &state, &contact, 7);
    }
}

#[test]
fn angles_without_a_heading_agree_with_the_calculation_by_hand() {
    let (body, world) = (prepared!(ByAngles), prepared!(WorldByAngles));
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let state: [f64; 9] = numbers.state();
        let reactions: [f64; 3] = body.reactions(0.0, &state.into()).into();
        check(&body, &Hand { quaternions: false, in_body: true }, 0.0, &state, &reactions, 6);
        let reactions: [f64; 3] = world.reactions(0.0, &state.into()).into();
        check(&world, &Hand { quaternions: false, in_body: false }, 0.0, &state, &reactions, 6);
    }
}

/// What is compared can differ: another moment of inertia is seen.
#[test]
#[should_panic(expected = "rates")]
fn another_stone_is_seen() {
    let ([a, b, c], [A, B, C, D, E, F]) = (AXES, INERTIA);
    let stone = ByQuaternion { m: 1.1, a, b, c, h: HEIGHT, A: 1.01 * A, B, C, D, E, F, g: 9.81 };
    let state = of_length_one(&mut Numbers::new(), 0);
    check(&stone.prepare().unwrap(), &Hand { quaternions: true, in_body: true }, 0.0, &state, &[], 7);
}

/// Off the constraint too the length of the quaternion is an integral, and rates are near those on it.
#[test]
fn what_is_off_the_constraint_stays_as_far_off_it() {
    let stone = prepared!(ByQuaternion);
    let hoop = guen_hoop::prepared();
    let mut numbers = Numbers::new();
    for round in 0..20 {
        let state = of_length_one(&mut numbers, 3 * round);
        for excess in [1e-12, 1e-9, 1e-6, 0.1] {
            let mut off = state;
            off[..4].iter_mut().for_each(|q| *q *= 1.0 + excess);
            let both = [
                (System::rhs(&stone, 0.0, &state), System::rhs(&stone, 0.0, &off)),
                (System::rhs(&hoop, 0.0, &state), System::rhs(&hoop, 0.0, &off)),
            ];
            for (on, off_it) in both {
                let size = on.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
                let drift: f64 = (0..4).map(|i| off[i] * off_it[i]).sum();
                assert!(drift.abs() <= 1e-14 * size, "{drift}");
                for (a, b) in on.iter().zip(off_it) {
                    assert!((a - b).abs() <= 100.0 * size * size * excess, "{a} and {b}, off by {excess}");
                }
            }
        }
    }
}

mod guen_hoop {
    quaternion_hoop!(guen::mechanical_system);

    pub fn prepared() -> impl guen::System<f64, 10> {
        QuaternionHoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap()
    }
}
