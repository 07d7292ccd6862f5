//! Pendulums in a frame that turns, evenly or not, against the same in the inertial frame.

use super::{assert_near, follow};
use guen::{Conservative, Rheonomic};

guen::mechanical_system! {
    /// A spherical pendulum; `phi` in the inertial frame.
    pub system Inertial {
        constants { l > 0, g = 9.81 }
        coordinates { theta, phi }
        parameters { tilting = dot(theta); turning = dot(phi); }
        kinetic_energy = l^2/2*(tilting^2 + sin(theta)^2*turning^2);
        potential_energy = -g*l*cos(theta);
    }
}

guen::mechanical_system! {
    /// The same; `phi` in a frame that has turned by `alpha(t)`, so that `T°` has linear and constant parts.
    pub system Turned {
        constants { l > 0, W, s, g = 9.81 }
        coordinates { theta, phi }
        let alpha = W*t + s*sin(3*t);
        parameters { tilting = dot(theta); turning = dot(phi); }
        kinetic_energy = l^2/2*(tilting^2 + sin(theta)^2*(turning + dot(alpha))^2);
        potential_energy = -g*l*cos(theta);
    }
}

guen::mechanical_system! {
    /// A plane oscillator in Cartesian coordinates of a frame that turns evenly: Coriolis' and centrifugal force.
    pub system Foucault {
        constants { k > 0, W }
        coordinates { x, y }
        parameters { u = dot(x); v = dot(y); }
        kinetic_energy = 1/2*((dot(x) - W*y)^2 + (dot(y) + W*x)^2);
        potential_energy = k/2*(x^2 + y^2);
    }
}

const L: f64 = 1.3;
const TIMES: [f64; 4] = [0.4, 1.1, 2.0, 3.0];

fn angle(w: f64, s: f64, t: f64) -> f64 {
    w * t + s * (3.0 * t).sin()
}

#[test]
fn spherical_pendulum_in_a_turning_frame() {
    for (w, s) in [(0.9, 0.0), (-0.4, 0.3)] {
        let inertial = Inertial::new(L).prepare().unwrap();
        let turned = Turned::new(L, w, s).prepare().unwrap();
        let (theta, phi, tilting, turning) = (0.8, 0.2, 0.3, 1.1);
        let expected = follow(&inertial, [theta, phi, tilting, turning], &TIMES);
        let found = follow(&turned, [theta, phi, tilting, turning - w - 3.0 * s], &TIMES);
        for (k, t) in TIMES.iter().enumerate() {
            assert_near(found[k][0], expected[k][0], 1e-11);
            assert_near(found[k][1] + angle(w, s, *t), expected[k][1], 1e-11);
            assert_near(found[k][2], expected[k][2], 1e-11);
        }
    }
}

/// `h = sum x' dT/dx' - T - U` is not `T - U` here: in an evenly turning frame it is conserved, `T - U` is not its
/// value, and for the pendulum it is the inertial energy less `W` times the angular momentum.
#[test]
fn energy_integral_of_a_turning_frame() {
    let (w, s) = (0.9, 0.0);
    let turned = Turned::new(L, w, s).prepare().unwrap();
    let start = turned::State { theta: 0.8, phi: 0.2, tilting: 0.3, turning: 0.2 };
    let h = turned.energy(0.0, &start);
    let plain = turned.kinetic_energy(0.0, &start) - turned.force_function(0.0, &start);
    let momentum = (L * 0.8_f64.sin()).powi(2) * (0.2 + w);
    assert_near(plain - h, w * momentum, 1e-14);
    assert!((plain - h).abs() > 0.1);
    for (t, x) in TIMES.iter().zip(follow(&turned, start.into(), &TIMES)) {
        assert_near(turned.energy(*t, &x.into()), h, 1e-12);
    }
    fn conserved<S: Conservative>() {}
    conserved::<foucault::Prepared>();
    fn moving<S: Rheonomic>() {}
    moving::<turned::Prepared>();
}

/// Closed form: an ellipse in the inertial frame, turned back.
#[test]
fn oscillator_in_a_turning_frame() {
    let (k, w) = (6.25_f64, 0.7_f64);
    let system = Foucault::new(k, w).prepare().unwrap();
    let (x, y, u, v) = (0.5, -0.2, 0.1, 0.6);
    // Velocities in the inertial frame, whose axes agree with the turning ones at t = 0.
    let (su, sv) = (u - w * y, v + w * x);
    let rate = k.sqrt();
    for (t, found) in TIMES.iter().zip(follow(&system, [x, y, u, v], &TIMES)) {
        let (sin, cos) = (rate * t).sin_cos();
        let (fx, fy) = (x * cos + su / rate * sin, y * cos + sv / rate * sin);
        let (sin, cos) = (w * t).sin_cos();
        assert_near(found[0], cos * fx + sin * fy, 1e-11);
        assert_near(found[1], -sin * fx + cos * fy, 1e-11);
    }
}
