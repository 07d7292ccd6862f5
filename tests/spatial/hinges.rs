//! Rods with quaternions and centres whose hinges are equations: started in a plane, where these have nothing but roundings in them.

use guen::prelude::*;

mechanical_system! {
    /// Two rods, the hinge of the second along an axis of the first.
    pub system HingedRods {
        constants { l = 1, m = 1, I = 1/12, g = 9.81 }
        coordinates { a1, b1, c1, w1, x1, y1, z1, a2, b2, c2, w2, x2, y2, z2 }
        let R1 = quaternion(w1, x1, y1, z1);
        let R2 = quaternion(w2, x2, y2, z2);
        let p1 = vec(a1, b1, c1);
        let p2 = vec(a2, b2, c2);
        holonomic {
            unit1: w1^2 + x1^2 + y1^2 + z1^2 = 1;
            unit2: w2^2 + x2^2 + y2^2 + z2^2 = 1;
            pin1: p1 - l/2*R1.x = vec(0, 0, 0);
            pin2: p2 - l/2*R2.x = p1 + l/2*R1.x;
            across1: R1.z.x = 0;
            along1: R1.z.y = 0;
            across2: inner(R2.z, R1.z) = 0;
            along2: inner(R2.z, R1.x) = 0;
        }
        bodies {
            first { mass: m, inertia: diag(0, I, I), center: p1, orientation: R1 }
            second { mass: m, inertia: diag(0, I, I), center: p2, orientation: R2 }
        }
        parameters {
            turn1 = angular_velocity_body(R1).z;
            turn2 = inner(R2.z, angular_velocity(R2) - angular_velocity(R1));
        }
        gravity = vec(0, -g, 0);
    }
}

#[test]
fn rods_on_hinges_keep_energy_and_equations() {
    let rods = HingedRods::default().prepare().unwrap();
    let half = core::f64::consts::FRAC_1_SQRT_2;
    // Along the first axis of the world, the second rod turned about it by a quarter.
    let start = hinged_rods::State {
        a1: 0.5,
        a2: 1.5,
        w1: 1.0,
        w2: half,
        x2: -half,
        turn1: 1.0,
        turn2: 2.0,
        ..Default::default()
    };
    let motion = rods.simulate(&start, 0.0..10.0).unwrap();
    let end = motion.end();
    let change = rods.energy(10.0, &end) - rods.energy(0.0, &start);
    assert!(change.abs() < 1e-6 * 9.81, "{change}");
    let left = rods.residuals(10.0, &end);
    for off in [left.unit2, left.pin2_x, left.pin2_y, left.across2, left.along2] {
        assert!(off.abs() < 1e-9, "{left:?}");
    }
    // It has moved out of the plane.
    assert!(rods.residuals(10.0, &hinged_rods::State { y2: end.y2 + 0.1, ..end }).across2.abs() > 1e-3);
}

guen::mechanical_system! {
    /// Two bodies on a hinge, whose axis is written as one vector in the world: one of its three equations follows from the others.
    pub system Hinge {
        constants { m > 0 = 1.3 }
        inputs { torque }
        coordinates { w, i, j, k, w2, i2, j2, k2 }
        let Q = quaternion(w, i, j, k);
        let P = quaternion(w2, i2, j2, k2);
        holonomic { u1: w^2 + i^2 + j^2 + k^2 = 1; u2: w2^2 + i2^2 + j2^2 + k2^2 = 1; hinge: Q.z = P.z; }
        bodies {
            a { mass: m, center: Q*vec(1, 0, 0), inertia: diag(1, 2, 2), orientation: Q }
            b { mass: m, center: P*vec(-1, 0, 0), inertia: diag(1, 2, 2), orientation: P }
        }
        forces { torque*Q.z along a.angular_velocity - b.angular_velocity; }
    }
}

/// Two of the three equations hold on two branches, which meet where the axis lies in a plane of the world.
#[test]
fn a_hinge_closes_whichever_way_its_axis_points() {
    let system = Hinge::default().prepare().unwrap();
    let driven = system.driven(hinge::Inputs { torque: 0.0 });
    for (number, spread) in (0..150).zip([0.01, 0.1, 0.5].into_iter().cycle()) {
        let draw = |place: u32| f64::from(17 * number + 5 * place + 1).sin();
        let q: [f64; 4] = std::array::from_fn(|i| draw(i as u32));
        let q = q.map(|e| e / q.iter().map(|e| e * e).sum::<f64>().sqrt());
        let (sine, cosine) = (1.5 * draw(4)).sin_cos();
        let [w, x, y, z] = q;
        let p = [w * cosine - z * sine, x * cosine + y * sine, y * cosine - x * sine, z * cosine + w * sine];
        let both = [q, p].concat();
        let guess: [f64; 8] = std::array::from_fn(|i| both[i] + spread * draw(5 + i as u32));
        let found = system.consistent(0.0, &guess.into(), &[]).unwrap();
        let end: [f64; 8] = found.into();
        assert!(
            end.iter().zip(&guess).all(|(end, guess)| (end - guess).abs() < 3.0 * spread),
            "{guess:?} {end:?}"
        );
        assert!(guen::Positions::surplus(&driven, 0.0, &end) < 1e-7);
        // Coordinates that are given keep their values.
        let held = system.consistent(0.0, &found, &["w", "i"]).unwrap();
        assert_eq!((held.w, held.i), (found.w, found.i));
    }
}
