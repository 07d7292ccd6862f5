//! The benchmark bicycle of Meijaard, Papadopoulos, Ruina, Schwab (2007): the eigenvalues of the upright straight motion, which
//! were recomputed in 30 digits from the published matrices, and the forces on the wheels at rest.

guen::mechanical_system! {
    /// Axes as in the publication: `x` ahead, `y` to the right, `z` down. `x`, `y` are the rear contact.
    pub system Whipple {
        constants { w = 1.02, c = 0.08, tilt = pi/10, g = 9.81, rR > 0 = 0.3, rF > 0 = 0.35 }
        coordinates { x, y, yaw, lean, pitch, steer, rear, front }
        let L = rot_z(yaw)*rot_x(lean);
        let B = L*rot_y(pitch);
        let S = B*rot_y(tilt)*rot_z(steer);
        let H = S*rot_y(-tilt);
        let contact = vec(x, y, 0);
        let hub = contact - rR*L.z;
        // Where the steering axis would meet the ground, in the axes of the frame.
        let foot = hub + B*vec(w + c, 0, rR);
        let nose = foot + H*vec(-c, 0, -rF);
        let touch = nose + rF*unit(vec(0, 0, 1) - H.y.z*H.y);
        bodies {
            rear_wheel { mass: 2, inertia: diag(0.0603, 0.12, 0.0603), center: hub, orientation: L*rot_y(rear) }
            rider { mass: 85, inertia: sym(9.2, 11, 2.8, 0, 0, 2.4), center: hub + B*vec(0.3, 0, rR - 0.9), orientation: B }
            fork { mass: 4, inertia: sym(0.05892, 0.06, 0.00708, 0, 0, -0.00756), center: foot + H*vec(0.9 - w - c, 0, -0.7), orientation: H }
            front_wheel { mass: 3, inertia: diag(0.1405, 0.28, 0.1405), center: nose, orientation: H*rot_y(front) }
        }
        gravity = vec(0, 0, g);
        parameters { roll_rate = dot(lean); steer_rate = dot(steer); turning = dot(rear); }
        constraints {
            behind: rear_wheel.velocity_at(contact) = 0;
            ahead: front_wheel.velocity_at(touch) = 0;
        }
    }
}

/// Castering, capsize and weave (real and imaginary part) at the speed in m/s.
const EIGENVALUES: [(f64, f64, f64, f64, f64); 10] = [
    (1.0, -7.11008014637434, -3.13423125066578, 3.52696170990068, 0.807740275199312),
    (2.0, -8.67387984831728, -3.07158645641514, 2.68234517512745, 1.68066296590675),
    (3.0, -10.3510146724591, -2.63366137253666, 1.70675605663975, 2.31582447384323),
    (4.0, -12.1586142657643, -1.42944427361329, 0.413253315211274, 3.07910818603203),
    (5.0, -14.0783896927981, -0.322866429004108, -0.775341882195809, 4.46486771378819),
    (6.0, -16.0853712309801, -0.00406690076971472, -1.52644486584138, 5.87673060598705),
    (7.0, -18.1578846612518, 0.102681705747656, -2.13875644258359, 7.195259133298),
    (8.0, -20.2794089439454, 0.143278797657124, -2.6934868358109, 8.46037971396929),
    (9.0, -22.4378855904083, 0.157901840309168, -3.21675402252486, 9.69377351531777),
    (10.0, -24.6245963501736, 0.161053386531711, -3.72016840437282, 10.9068113947628),
];

#[test]
fn whipple_bicycle_has_the_published_eigenvalues() {
    let system = Whipple::default().prepare().unwrap();
    let mut worst: f64 = 0.0;
    for (speed, castering, capsize, real, imaginary) in EIGENVALUES {
        let state = whipple::State { turning: -speed / 0.3, ..Default::default() };
        let a = system.linearize(0.0, &state).a;
        // The rates of lean, steering angle and their rates by these four: nothing else acts on them.
        let rows = [3, 5, 8, 9];
        let chosen = nalgebra::SMatrix::<f64, 4, 4>::from_fn(|i, j| a[rows[i]][rows[j]]);
        let found = chosen.complex_eigenvalues();
        for expected in [(castering, 0.0), (capsize, 0.0), (real, imaginary), (real, -imaginary)] {
            let distance =
                |value: &nalgebra::Complex<f64>| (value.re - expected.0).hypot(value.im - expected.1);
            let nearest = found.iter().map(distance).fold(f64::INFINITY, f64::min);
            worst = worst.max(nearest);
            assert!(nearest < 1e-10, "{expected:?} at {speed} m/s is off by {nearest:.1e}");
        }
        for row in rows {
            for column in [0, 1, 2, 4, 6, 7, 10] {
                assert!(a[row][column].abs() < 1e-11, "{row} depends on {column}: {}", a[row][column]);
            }
        }
    }
    println!("largest difference of an eigenvalue: {worst:.1e}");
}

#[test]
fn whipple_bicycle_stands_on_its_wheels_as_published() {
    let system = Whipple::default().prepare().unwrap();
    let reactions = system.reactions(0.0, &Default::default());
    // The third axis points down.
    super::close("front wheel", &[reactions.ahead_z], &[-309.303529411765], 1.0, 1e-13);
}
