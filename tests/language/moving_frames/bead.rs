//! A bead on a hoop that turns at `W(t)` about its vertical diameter and has the radius `r(t)`: once with the
//! motion of the hoop inside of the energies, once with constraints that move, and by hand.

use super::{assert_near, follow};
use guen::prelude::*;

guen::mechanical_system! {
    /// `theta` is the angle from the lowest point; explicit time in `T°` and `U`.
    pub system Prescribed {
        constants { m > 0, R > 0, swell, W, gust, g = 9.81 }
        coordinates { theta }
        let r = R*(1 + swell*sin(t));
        let turn = W + gust*cos(2*t);
        let velocity_r = R*swell*cos(t);
        parameters { omega = dot(theta); }
        kinetic_energy = m/2*(velocity_r^2 + r^2*omega^2 + (r*sin(theta)*turn)^2);
        potential_energy = -m*g*r*cos(theta);
    }
}

guen::mechanical_system! {
    /// The same in space, where two constraints move the hoop: time is in their terms without velocity alone.
    pub system Constrained {
        constants { m > 0, R > 0, swell, W, gust, g = 9.81 }
        coordinates { r, theta, phi }
        parameters { omega = dot(theta); }
        constraints {
            radius: dot(r) = R*swell*cos(t);
            turning: dot(phi) = W + gust*cos(2*t);
        }
        kinetic_energy = m/2*(dot(r)^2 + r^2*dot(theta)^2 + (r*sin(theta)*dot(phi))^2);
        potential_energy = -m*g*r*cos(theta);
    }
}

const M: f64 = 0.3;
const R: f64 = 0.8;
const SWELL: f64 = 0.2;
const W: f64 = 4.0;
const GUST: f64 = 0.7;
const G: f64 = 9.81;

/// `r^2 theta'' + 2 r r' theta' - r^2 sin(theta) cos(theta) W^2 + g r sin(theta) = 0`.
fn by_hand(t: f64, &[theta, omega]: &[f64; 2]) -> [f64; 2] {
    let (r, rate, turn) = (R * (1.0 + SWELL * t.sin()), R * SWELL * t.cos(), W + GUST * (2.0 * t).cos());
    let (sin, cos) = theta.sin_cos();
    [omega, sin * cos * turn * turn - G / r * sin - 2.0 * rate / r * omega]
}

fn prescribed() -> prescribed::Prepared {
    Prescribed::new(M, R, SWELL, W, GUST).prepare().unwrap()
}

fn constrained() -> constrained::Prepared {
    Constrained::new(M, R, SWELL, W, GUST).prepare().unwrap()
}

const TIMES: [f64; 5] = [0.5, 1.0, 1.7, 2.5, 4.0];

#[test]
fn rates_are_those_by_hand() {
    for k in 0..40 {
        let (t, theta, omega) = (0.17 * f64::from(k), 0.1 * f64::from(k) - 1.5, 2.0 - 0.13 * f64::from(k));
        let expected = by_hand(t, &[theta, omega]);
        let found = prescribed().rhs(t, &prescribed::State { theta, omega });
        assert_near(found.omega, expected[1], 1e-13);
        let r = R * (1.0 + SWELL * t.sin());
        let found = constrained().rhs(t, &constrained::State { r, theta, phi: 0.4, omega });
        assert_near(found.omega, expected[1], 1e-13);
        assert_near(found.r, R * SWELL * t.cos(), 1e-15);
        assert_near(found.phi, W + GUST * (2.0 * t).cos(), 1e-15);
    }
}

#[test]
fn motions_are_the_same() {
    let expected = follow(&from_fn(by_hand), [0.6, -0.5], &TIMES);
    let inside = follow(&prescribed(), [0.6, -0.5], &TIMES);
    let outside = follow(&constrained(), [R, 0.6, 0.0, -0.5], &TIMES);
    for k in 0..TIMES.len() {
        assert_near(inside[k][0], expected[k][0], 1e-11);
        assert_near(inside[k][1], expected[k][1], 1e-11);
        assert_near(outside[k][1], expected[k][0], 1e-11);
        assert_near(outside[k][3], expected[k][1], 1e-11);
    }
}

/// The forces that move the hoop, from Newton's law in spherical coordinates.
#[test]
fn reactions_are_those_by_hand() {
    let (t, theta, omega) = (0.9_f64, 0.7_f64, -1.2);
    let (r, rate) = (R * (1.0 + SWELL * t.sin()), R * SWELL * t.cos());
    let (turn, gain) = (W + GUST * (2.0 * t).cos(), -2.0 * GUST * (2.0 * t).sin());
    let (sin, cos) = theta.sin_cos();
    let reactions = constrained().reactions(t, &constrained::State { r, theta, phi: 0.0, omega });
    let radial = M * (-R * SWELL * t.sin() - r * omega * omega - r * sin * sin * turn * turn) - M * G * cos;
    // The rate of m r^2 sin^2(theta) W.
    let torque = M * r * sin * (2.0 * rate * sin * turn + 2.0 * r * cos * omega * turn + r * sin * gain);
    assert_near(reactions.radius, radial, 1e-13);
    assert_near(reactions.turning, torque, 1e-13);
}

/// `h' = -sum_v lambda_v a_v0` for moving constraints, `h' = -d(T° + U)/dt` for explicit time: both are the work
/// done, and `h` changes by it.
#[test]
fn energy_integral_is_balanced() {
    fn check<const N: usize, const L: usize>(
        start: [f64; N],
        rates: impl Fn(f64, &[f64; N]) -> [f64; N],
        power: impl Fn(f64, &[f64; N]) -> f64,
        energy: impl Fn(f64, &[f64; N]) -> f64,
    ) {
        let head = |x: &[f64; L]| -> [f64; N] { std::array::from_fn(|i| x[i]) };
        let both = from_fn(|t, x: &[f64; L]| {
            let (rates, power) = (rates(t, &head(x)), power(t, &head(x)));
            std::array::from_fn(|i| if i < N { rates[i] } else { power })
        });
        let begin = std::array::from_fn(|i| if i < N { start[i] } else { 0.0 });
        let mut largest = 0.0_f64;
        for (t, x) in TIMES.iter().zip(follow(&both, begin, &TIMES)) {
            let change = energy(*t, &head(&x)) - energy(0.0, &start);
            assert_near(x[N], change, 1e-11);
            largest = largest.max(change.abs());
        }
        assert!(largest > 0.1, "nothing was balanced: {largest}");
    }
    let system = constrained();
    check::<4, 5>(
        [R, 0.6, 0.0, -0.5],
        |t, x| System::rhs(&system, t, x),
        |t, x| {
            let reactions = system.reactions(t, &(*x).into());
            let (radius, turning) = (-R * SWELL * t.cos(), -(W + GUST * (2.0 * t).cos()));
            -reactions.radius * radius - reactions.turning * turning
        },
        |t, x| system.energy(t, &(*x).into()),
    );
    let system = prescribed();
    check::<2, 3>(
        [0.6, -0.5],
        |t, x| System::rhs(&system, t, x),
        |t, x| system.power(t, &(*x).into()),
        |t, x| system.energy(t, &(*x).into()),
    );
}
