//! Rotations as values: axes, inverses and angular velocities beside hand-written matrices and their derivatives.

use guen::Dual;

use crate::by_hand::{
    Matrix, Numbers, apply, by_quaternion, close, column, cross, moving, plus, product, real, rot_y, rot_z,
    spin, times, transposed,
};

guen::mechanical_system! {
    /// Every function of rotations, on a body that is there to be asked.
    pub system Turns {
        constants { p, q > 0, r }
        coordinates { a, b, c, w, i, j, k }
        let Q = quaternion(w, i, j, k);
        let A = rot_z(a)*rot(unit(vec(p, q, r)), 2*b + t)*rot_y(c - a);
        let B = transpose(A)*Q;
        let center = vec(a*b, c, t) + A*vec(1, 2, 3);
        bodies { body { mass: 1, inertia: diag(1, 1, 1), center: center, orientation: A } quad { inertia: diag(1, 1, 1), orientation: Q } }
        parameters { da = dot(a); db = dot(b); dc = dot(c); omega = angular_velocity(Q); }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
        outputs {
            first = A.x; second = B.y; third = transpose(B).z;
            world = angular_velocity(A); own = angular_velocity_body(A);
            relative = angular_velocity(B); relative_own = angular_velocity_body(B);
            inverse = angular_velocity(transpose(A));
            image = B*vec(a, -b, 1/2);
            back = transpose(A)*(body.center - center + cross(Q.x, A.z));
            same = body.angular_velocity;
            point = body.velocity_at(vec(0, 0, 0));
        }
    }
}

type Path = Dual<f64, 1>;

/// The matrices `A` and `Q` on a path, and the centre of the body.
fn placed(t: Path, x: &[Path]) -> (Matrix<Path>, Matrix<Path>, [Path; 3]) {
    let axis = [0.4, 0.7, -1.1];
    let length = axis.iter().map(|e: &f64| e * e).sum::<f64>().sqrt();
    let half = x[1] + real::<Path>(0.5) * t;
    let [ax, ay, az] = axis.map(|e| real::<Path>(e / length) * guen::Real::sin(half));
    let turned = by_quaternion(&[guen::Real::cos(half), ax, ay, az]);
    let a = product(&product(&rot_z(x[0]), &turned), &rot_y(x[2] - x[0]));
    let arm = apply(&a, &[real(1.0), real(2.0), real(3.0)]);
    (a, by_quaternion(&x[3..]), plus(&[x[0] * x[1], x[2], t], &arm))
}

#[test]
fn rotations_are_what_their_matrices_say() {
    let system = Turns { p: 0.4, q: 0.7, r: -1.1 }.prepare().unwrap();
    let mut numbers = Numbers::new();
    for _ in 0..20 {
        let mut state = numbers.state::<13>();
        let length = state[3..7].iter().map(|q| q * q).sum::<f64>().sqrt();
        state[3..7].iter_mut().for_each(|q| *q /= length);
        let t = numbers.next();
        let velocities: [f64; 7] = system.velocities(t, &state.into()).into();
        let (time, path) = moving(t, &state[..7], &velocities);
        let (a, q, center) = placed(time, &path);
        let b = product(&transposed(&a), &q);
        let still = |m: &Matrix<Path>| m.map(|row| row.map(|e| e.value));
        let out = system.outputs(t, &state.into());
        close("first", &out.first, &column(&still(&a), 0));
        close("second", &out.second, &column(&still(&b), 1));
        close("third", &out.third, &still(&b)[2]);
        close("world", &out.world, &spin(&a));
        close("own", &out.own, &apply(&transposed(&still(&a)), &spin(&a)));
        close("relative", &out.relative, &spin(&b));
        close("relative own", &out.relative_own, &apply(&transposed(&still(&b)), &spin(&b)));
        close("inverse", &out.inverse, &spin(&transposed(&a)));
        close("image", &out.image, &apply(&still(&b), &[state[0], -state[1], 0.5]));
        let crossed = cross(&column(&still(&q), 0), &column(&still(&a), 2));
        close("back", &out.back, &apply(&transposed(&still(&a)), &crossed));
        close("same", &out.same, &spin(&a));
        let arm = times(-1.0, &center.map(|e| e.value));
        let speed = plus(&center.map(|e| e.tangent[0]), &cross(&spin(&a), &arm));
        close("point", &out.point, &speed);
        close("omega", &state[10..], &spin(&q));
    }
}
