//! An arm on a floating base, whose orientation is a quaternion or three angles: one motion in the same parameters.

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

#[test]
fn an_arm_on_a_quaternion_moves_as_on_angles() {
    let quaternions = InQuaternions { m: 1.5, i: 0.2, l: 0.7, g: 9.81 }.prepare().unwrap();
    let angles = InAngles { m: 1.5, i: 0.2, l: 0.7, g: 9.81 }.prepare().unwrap();
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
