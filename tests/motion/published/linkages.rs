//! Andrews' squeezer and the car axis of the test set for initial value problems (Mazzia and Magherini), whose end states are published
//! with 16 digits. Not all of them are right. The squeezer's positions are right to ten: DOP853 and Radau 5 at 1e-11 to 1e-15 agree with each
//! other to 2e-13 and with the published crank angle to 7e-11, its velocities violate its own constraints by 1e-9, and its multipliers are right to
//! six digits. The car axis' velocities are right to nine, its multipliers to seven.

#![allow(clippy::excessive_precision, reason = "the digits are those that were published")]

use super::close;
use guen::prelude::*;
use guen::projected;

guen::mechanical_system! {
    /// Seven bodies in the plane, three loops, a spring and a motor: one degree of freedom.
    pub system Squeezer {
        constants { mom = 0.033, c0 = 4530, l0 = 0.07785 }
        coordinates { beta, theta, gamma, phi, delta, omega, epsilon }
        // Pivots and lengths in metres.
        let a = vec(-0.06934, -0.00227);
        let b = vec(-0.03635, 0.03273);
        let c = vec(0.014, 0.072);
        let crank = rot_z(beta);
        let rod = rot_z(beta + theta);
        let variant = rot_z(gamma);
        let upper = rot_z(phi + delta);
        let upper_arm = rot_z(delta);
        let lower = rot_z(omega + epsilon);
        let lower_arm = rot_z(epsilon);
        let knee = crank*vec(0.007, 0);
        let pin = knee - rod*vec(0.028, 0);
        let elbow = a + upper_arm*vec(0.04, 0);
        let heel = a - lower_arm*vec(0, 0.04);
        let spring = b + variant*vec(0.02, -0.018) - c;
        bodies {
            k1 { mass: 0.04325, inertia: diag(0, 0, 2.194e-6), center: crank*vec(0.00092, 0), orientation: crank }
            k2 { mass: 0.00365, inertia: diag(0, 0, 4.41e-7), center: knee - rod*vec(0.0115, 0), orientation: rod }
            k3 { mass: 0.02373, inertia: diag(0, 0, 5.255e-6), center: b + variant*vec(0.01043, -0.01874), orientation: variant }
            k4 { mass: 0.00706, inertia: diag(0, 0, 5.667e-7), center: elbow - upper*vec(0, 0.00579), orientation: upper }
            k5 { mass: 0.0705, inertia: diag(0, 0, 1.169e-5), center: a + upper_arm*vec(0.02308, 0.00916), orientation: upper_arm }
            k6 { mass: 0.00706, inertia: diag(0, 0, 5.667e-7), center: heel + lower*vec(0.00579, 0), orientation: lower }
            k7 { mass: 0.05498, inertia: diag(0, 0, 1.912e-5), center: a - lower_arm*vec(0.00449, 0.01228), orientation: lower_arm }
        }
        potential_energy = c0/2*(sqrt(inner(spring, spring)) - l0)^2;
        parameters { speed = dot(beta); }
        forces { mom along speed; }
        holonomic {
            with_lever: pin = b - variant*vec(0, 0.035);
            with_upper: pin = elbow - upper*vec(0, 0.02);
            with_lower: pin = heel + lower*vec(0.02, 0);
        }
    }
}

/// The published start, put onto the constraints.
pub(super) fn squeezer_start(system: &squeezer::Prepared) -> [f64; 8] {
    let published = [
        -0.0617138900142764496,
        0.0,
        0.455279819163070380,
        0.222668390165885885,
        0.487364979543842550,
        -0.222668390165885885,
        1.23054744454982119,
    ];
    let start = system.consistent(0.0, &published.into(), &["theta"]).unwrap();
    close("start", &<[f64; 7]>::from(start), &published, 1.0, 1e-15);
    let mut state = [0.0; 8];
    state[..7].copy_from_slice(&<[f64; 7]>::from(start));
    state
}

#[test]
fn andrews_squeezer_ends_where_it_is_published_to() {
    let system = Squeezer::default().prepare().unwrap();
    let state = squeezer_start(&system);
    let end = Integration::new(&projected(&system), 0.0, &state)
        .run(&Dop853::new(1e-13, 1e-13), 0.03)
        .unwrap()
        .state;
    let positions = [
        15.81077119629904,
        -15.75637105984298,
        0.04082224013073101,
        -0.5347301163226948,
        0.5244099658805304,
        0.5347301163226948,
        1.048080741042263,
    ];
    close("positions", &end[..7], &positions, 1.0, 2e-10);
    let other = Integration::new(&projected(&system), 0.0, &state)
        .run(&Radau5::new(1e-11, 1e-11), 0.03)
        .unwrap()
        .state;
    close("another method", &end, &other, 1.0, 5e-12);
    let velocities = [
        1139.920302151208,
        -1424.379294994111,
        11.03291221937134,
        19.29337464421385,
        0.5735699284790808,
        -19.29337464421385,
        0.3231791658026955,
    ];
    let found: [f64; 7] = system.velocities(0.03, &end.into()).into();
    close("velocities", &found, &velocities, 1000.0, 1e-9);
    // A force on the side that the equation subtracts is a multiplier with the other sign.
    let multipliers = [
        199.1753333731910,
        -29.75531228015052,
        23.06654119098399,
        31.45271365475927,
        22.64249232082739,
        11.61740700019673,
    ];
    let reactions: [f64; 6] = system.reactions(0.03, &end.into()).into();
    close("multipliers", &reactions.map(|r| -r), &multipliers, 100.0, 2e-6);
}

guen::mechanical_system! {
    /// An axle on two springs whose right wheel goes up and down: two particles, two holonomic equations, one of them with time.
    pub system CarAxis {
        constants { m > 0 = 5e-4, l > 0 = 1, l0 > 0 = 1/2, r = 0.1, omega = 10, g = 1 }
        coordinates { xl, yl, xr, yr }
        let left = vec(xl, yl);
        let right = vec(xr, yr);
        let height = r*sin(omega*t);
        let bump = vec(sqrt(l^2 - height^2), height);
        particles { m at left; m at right; }
        gravity = vec(0, -g);
        potential_energy = (sqrt(inner(left, left)) - l0)^2/2 + (sqrt(inner(right - bump, right - bump)) - l0)^2/2;
        parameters { rise = dot(yl); lift = dot(yr); }
        holonomic {
            upright: inner(left, bump) = 0;
            length: inner(left - right, left - right) = l^2;
        }
    }
}

#[test]
fn car_axis_ends_where_it_is_published_to() {
    let system = CarAxis::default().prepare().unwrap();
    let start = car_axis::State { yl: 0.5, xr: 1.0, yr: 0.5, ..Default::default() };
    let thrown: [f64; 4] = system.velocities(0.0, &start).into();
    close("start", &thrown, &[-0.5, 0.0, -0.5, 0.0], 1.0, 1e-15);
    let end = Integration::new(&projected(&system), 0.0, &start.into())
        .run(&Dop853::new(1e-13, 1e-13), 3.0)
        .unwrap()
        .state;
    let positions = [0.04934557842755629, 0.4969894602303324, 1.041742524885400, 0.3739110272652214];
    close("positions", &end[..4], &positions, 1.0, 1e-11);
    let velocities = [-0.07705836840321485, 0.007446866596327776, 0.01755681574942899, 0.7703410437794031];
    close("velocities", &<[f64; 4]>::from(system.velocities(3.0, &end.into())), &velocities, 1.0, 1e-9);
    let reactions: [f64; 2] = system.reactions(3.0, &end.into()).into();
    let multipliers = [-0.004736886750784630, -0.001104680411345730];
    close("multipliers", &reactions, &multipliers, 0.005, 1e-6);
}
