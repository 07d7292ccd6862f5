//! An arm on a floating base, whose orientation is a quaternion or three angles: one motion in the same parameters. The reaction of
//! `|q| = 1` is held against Lagrange's expression of the energy as it is written, which knows lengths that are not one.

use guen::{Dual, Real};

use crate::by_hand::{
    Vector, apply, by_quaternion, cross, inner, minus, moving, plus, product, rate, real, rot_x, rot_y,
    rot_z, times, transposed,
};

macro_rules! floating {
    ($name:ident, [$($coordinate:ident),*], $orientation:expr, {$($holonomic:tt)*}) => {
        guen::mechanical_system! {
            /// A base with an arm of three links, in gravity.
            pub system $name {
                constants { m > 0, i > 0, l > 0, g = 9.81 }
                inputs { torque }
                coordinates { x, y, z, $($coordinate,)* a, b, c }
                let B = $orientation;
                let p0 = vec(x, y, z);
                let R1 = B*rot_x(a);
                let R2 = R1*rot_z(b);
                let R3 = R2*rot_y(c);
                let p1 = p0 + R1*vec(0, l/3, l);
                let p2 = p1 + R2*vec(l, 0, 0);
                bodies {
                    base  { mass: 3*m, inertia: sym(i, 2*i, 3*i/2, i/5, 0, i/7), center: p0 + B*vec(l/9, 0, l/8), orientation: B }
                    one   { mass: m, inertia: diag(i, i, i/5), center: p0 + R1*vec(0, 0, l/2), orientation: R1 }
                    two   { mass: m, inertia: diag(i/5, i, i), center: p1 + R2*vec(l/2, 0, 0), orientation: R2 }
                    three { mass: m/2, inertia: diag(i/5, i, i/2), center: p2 + R3*vec(l/2, l/4, 0), orientation: R3 }
                }
                gravity = vec(0, 0, -g);
                parameters { v = dot(p0); w = angular_velocity_body(B); ua = dot(a); ub = dot(b); uc = dot(c); }
                $($holonomic)*
                forces { torque along uc; }
            }
        }
    };
}

floating!(InQuaternions, [q0, q1, q2, q3], quaternion(q0, q1, q2, q3), {
    holonomic { length: q0^2 + q1^2 + q2^2 + q3^2 = 1; }
});
floating!(InAngles, [yaw, pitch, roll], rot_z(yaw) * rot_y(pitch) * rot_x(roll), {});

const MASS: f64 = 1.5;
const INERTIA: f64 = 0.2;
const LENGTH: f64 = 0.7;
const GRAVITY: f64 = 9.81;

/// `T + U` with a quaternion of any length: coordinates in the order of the declaration, and their velocities.
fn lagrangian<R: Real>(x: &[R; 10], v: &[R; 10]) -> R {
    let vector = |v: [f64; 3]| v.map(real::<Dual<R, 1>>);
    let (_, at) = moving(R::zero(), x, v);
    let l = LENGTH;
    let base = by_quaternion(&at[3..7]);
    let turns = [rot_x(at[7]), rot_z(at[8]), rot_y(at[9])];
    let one = product(&base, &turns[0]);
    let two = product(&one, &turns[1]);
    let three = product(&two, &turns[2]);
    let place = [at[0], at[1], at[2]];
    let elbow = plus(&place, &apply(&one, &vector([0.0, l / 3.0, l])));
    let wrist = plus(&elbow, &apply(&two, &vector([l, 0.0, 0.0])));
    let centers = [
        plus(&place, &apply(&base, &vector([l / 9.0, 0.0, l / 8.0]))),
        plus(&place, &apply(&one, &vector([0.0, 0.0, l / 2.0]))),
        plus(&elbow, &apply(&two, &vector([l / 2.0, 0.0, 0.0]))),
        plus(&wrist, &apply(&three, &vector([l / 2.0, l / 4.0, 0.0]))),
    ];
    // 2 q* q', and from joint to joint.
    let (q, qd) = ([x[4], x[5], x[6]], [v[4], v[5], v[6]]);
    let straight = minus(&times(x[3], &qd), &times(v[3], &q));
    let mut spins = vec![times(real(2.0), &minus(&straight, &cross(&q, &qd)))];
    for (joint, axis) in [0, 2, 1].into_iter().enumerate() {
        let turn = turns[joint].map(|row| row.map(|e| e.value));
        let mut spin = apply(&transposed(&turn), &spins[joint]);
        spin[axis] += v[7 + joint];
        spins.push(spin);
    }
    let i = INERTIA;
    let inertias = [
        [i, 2.0 * i, 1.5 * i, i / 5.0, 0.0, i / 7.0],
        [i, i, i / 5.0, 0.0, 0.0, 0.0],
        [i / 5.0, i, i, 0.0, 0.0, 0.0],
        [i / 5.0, i, i / 2.0, 0.0, 0.0, 0.0],
    ];
    let masses = [3.0, 1.0, 1.0, 0.5].map(|m| m * MASS);
    let mut sum = R::zero();
    for (((mass, center), spin), inertia) in masses.into_iter().zip(centers).zip(&spins).zip(inertias) {
        let velocity: Vector<R> = rate(&center);
        let [xx, yy, zz, xy, yz, zx] = inertia.map(real::<R>);
        let momentum = apply(&[[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]], spin);
        sum += real::<R>(0.5) * (real::<R>(mass) * inner(&velocity, &velocity) + inner(spin, &momentum));
        sum += real::<R>(-mass * GRAVITY) * center[2].value;
    }
    sum
}

/// `d/dt (dL/dx' . X) - (X . dL/dx + X' . dL/dx')` for `X = q/2`, along which `|q|^2` grows by one and no parameter does.
fn reaction_by_hand(x: &[f64; 10], v: &[f64; 10], a: &[f64; 10]) -> f64 {
    type Jet = Dual<Dual<f64, 1>, 1>;
    let stretched = |i: usize| if (3..7).contains(&i) { 0.5 } else { 0.0 };
    let on_path = |x: f64, v: f64| Dual { value: x, tangent: [v] };
    let still = |value: Dual<f64, 1>| -> Jet { Dual { value, tangent: [Dual::constant(0.0)] } };
    let place: [Jet; 10] = std::array::from_fn(|i| still(on_path(x[i], v[i])));
    let pushed: [Jet; 10] = std::array::from_fn(|i| Dual {
        value: on_path(v[i], a[i]),
        tangent: [on_path(stretched(i) * x[i], stretched(i) * v[i])],
    });
    let rate_of_momentum = lagrangian(&place, &pushed).tangent[0].tangent[0];
    let beside = |x: &[f64; 10], v: &[f64; 10]| std::array::from_fn(|i| on_path(x[i], stretched(i) * v[i]));
    rate_of_momentum - lagrangian(&beside(x, x), &beside(v, v)).tangent[0]
}

#[test]
fn the_length_of_a_quaternion_reacts_as_the_energy_has_it() {
    let system = InQuaternions { m: MASS, i: INERTIA, l: LENGTH, g: GRAVITY }.prepare().unwrap();
    for k in 0..10 {
        let part = |n: usize| 2.0 * (0.618 * f64::from(k) + 0.37 * n as f64).fract() - 1.0;
        let mut state: [f64; 19] = std::array::from_fn(|n| 2.0 * part(n));
        let length = state[3..7].iter().map(|q| q * q).sum::<f64>().sqrt();
        state[3..7].iter_mut().for_each(|q| *q /= length);
        let inputs = in_quaternions::Inputs { torque: 0.3 };
        let rates: [f64; 19] = system.rhs(0.0, &state.into(), &inputs).into();
        let found = system.reactions(0.0, &state.into(), &inputs).length;
        let x: [f64; 10] = std::array::from_fn(|i| state[i]);
        let v: [f64; 10] = std::array::from_fn(|i| rates[i]);
        // q' = q (0, w)/2, along the motion once more.
        let along = |i: usize| -> Dual<f64, 1> { Dual { value: state[i], tangent: [rates[i]] } };
        let (w, q) = ([13, 14, 15].map(along), [4, 5, 6].map(along));
        let half = Dual::constant(0.5);
        let scalar = -half * inner(&q, &w);
        let turned = times(half, &plus(&times(along(3), &w), &cross(&q, &w)));
        assert!((scalar.value - v[3]).abs() < 1e-12 && (turned[2].value - v[6]).abs() < 1e-12);
        let quaternion = [scalar, turned[0], turned[1], turned[2]].map(|e| e.tangent[0]);
        let a: [f64; 10] = std::array::from_fn(|i| match i {
            0..3 => rates[10 + i],
            3..7 => quaternion[i - 3],
            _ => rates[9 + i],
        });
        let expected = reaction_by_hand(&x, &v, &a);
        assert!((found - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{found}, not {expected}");
    }
}

#[test]
fn an_arm_on_a_quaternion_moves_as_on_angles() {
    let quaternions = InQuaternions { m: MASS, i: INERTIA, l: LENGTH, g: GRAVITY }.prepare().unwrap();
    let angles = InAngles { m: MASS, i: INERTIA, l: LENGTH, g: GRAVITY }.prepare().unwrap();
    for k in 0..20 {
        let part = |n: usize| 2.0 * (0.618 * f64::from(k) + 0.31 * n as f64).fract() - 1.0;
        let (yaw, pitch, roll) = (3.0 * part(1), part(2), 2.0 * part(3));
        let [z, y, x] = [yaw, pitch, roll].map(|angle: f64| (0.5 * angle).sin_cos());
        let (a, b, c) = (2.0 * part(4), 2.0 * part(5), 2.0 * part(6));
        let (v, w) = ([part(7), part(8), part(9)], [3.0 * part(10), 3.0 * part(11), 3.0 * part(12)]);
        let (ua, ub, uc) = (4.0 * part(13), 4.0 * part(14), 4.0 * part(15));
        let in_quaternions = in_quaternions::State {
            q0: z.1 * y.1 * x.1 + z.0 * y.0 * x.0,
            q1: z.1 * y.1 * x.0 - z.0 * y.0 * x.1,
            q2: z.1 * y.0 * x.1 + z.0 * y.1 * x.0,
            q3: z.0 * y.1 * x.1 - z.1 * y.0 * x.0,
            a,
            b,
            c,
            v_x: v[0],
            v_y: v[1],
            v_z: v[2],
            w_x: w[0],
            w_y: w[1],
            w_z: w[2],
            ua,
            ub,
            uc,
            ..Default::default()
        };
        let in_angles = in_angles::State {
            yaw,
            pitch,
            roll,
            a,
            b,
            c,
            v_x: v[0],
            v_y: v[1],
            v_z: v[2],
            w_x: w[0],
            w_y: w[1],
            w_z: w[2],
            ua,
            ub,
            uc,
            ..Default::default()
        };
        let one = quaternions.rhs(0.0, &in_quaternions, &in_quaternions::Inputs { torque: 0.3 });
        let other = angles.rhs(0.0, &in_angles, &in_angles::Inputs { torque: 0.3 });
        let one = [one.v_x, one.v_y, one.v_z, one.w_x, one.w_y, one.w_z, one.ua, one.ub, one.uc];
        let other =
            [other.v_x, other.v_y, other.v_z, other.w_x, other.w_y, other.w_z, other.ua, other.ub, other.uc];
        let size = one.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
        for (one, other) in one.into_iter().zip(other) {
            assert!((one - other).abs() < 1e-12 * size, "{one} or {other} of {size}");
        }
    }
    // Multiplied out they take thousands.
    for cost in [InQuaternions::<f64>::COST, InAngles::<f64>::COST] {
        assert!(cost.total() < 1600, "{cost:?}");
    }
}

/// An arm on a ship that rocks by given angles: a double and a triple frequency as numbers, or as constants.
macro_rules! arm_on_a_ship {
    ($name:ident, $double:expr, $triple:expr) => {
        guen::mechanical_system! {
            pub system $name {
                constants { l > 0 = 0.4, m > 0 = 1.1, J > 0 = 0.05, two = 2, three = 3, g = 9.81 }
                coordinates { q0, q1, q2 }
                let ship = rot_x(sin($double)/5)*rot_y(cos($triple)/7);
                let R0 = ship*rot_z(q0);
                let R1 = R0*rot_y(q1);
                let R2 = R1*rot_x(q2);
                let p1 = R0*vec(l, 0, l/3);
                let p2 = p1 + R1*vec(l, 0, l/3);
                let p3 = p2 + R2*vec(l, 0, l/3);
                bodies {
                    first { mass: m, center: p1/2, inertia: diag(J, 2*J, 3*J), orientation: R0 }
                    second { mass: m, center: (p1 + p2)/2, inertia: diag(J, 2*J, 3*J), orientation: R1 }
                    third { mass: m, center: (p2 + p3)/2, inertia: diag(J, 2*J, 3*J), orientation: R2 }
                }
                gravity = vec(0, 0, -g);
                outputs { _used = two + three; }
            }
        }
    };
}

arm_on_a_ship!(InNumbers, 2 * t, 3 * t);
arm_on_a_ship!(InConstants, two * t, three * t);

#[test]
fn a_base_turns_by_multiples_of_time() {
    let numbers = InNumbers::default().prepare().unwrap();
    let constants = InConstants::default().prepare().unwrap();
    for k in 0..4 {
        let state: [f64; 6] = std::array::from_fn(|i| f64::sin((1 + i + 7 * k) as f64));
        let t = 0.3 * f64::from(k as u32);
        let one: [f64; 6] = numbers.rhs(t, &state.into()).into();
        let other: [f64; 6] = constants.rhs(t, &state.into()).into();
        for (one, other) in one.into_iter().zip(other) {
            assert!((one - other).abs() < 1e-11 * (1.0 + other.abs()), "{one} or {other}");
        }
    }
    // Multiplied out they take two thousand.
    let costs = [InNumbers::<f64>::COST, InConstants::<f64>::COST].map(|cost| cost.total());
    assert!(costs[0] < 320 && costs[0].abs_diff(costs[1]) < 20, "{costs:?}");
}
