//! Motions with a closed form: Chaplygin's sleigh, Suslov's body, a pendulum from the horizontal, a ball on a turntable. The numbers
//! are the forms' values in 30 digits.

use super::close;
use guen::prelude::*;
use guen::projected;
use guen_benchmarks::systems::{EvenTurntable, Sled, even_turntable, sled};

#[test]
fn chaplygin_s_sleigh_turns_into_its_direction() {
    // v = v_oo tanh(kappa t + c), omega = omega_oo sech(kappa t + c)
    let (m, inertia, a): (f64, f64, f64) = (1.0, 0.5, 0.3);
    let system =
        Sled { m, alpha: a, beta: 0.0, k: (inertia / m).sqrt(), incline: 0.0, g: 9.81 }.prepare().unwrap();
    let start = sled::State { eta1: 2.0, eta2: 0.2, ..Default::default() };
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-14, 1e-14), 5.0);
    let end: sled::State = end.unwrap().state.into();
    let expected = [1.54828719514878, 0.068972622157847, 3.602793198588515];
    close("v, omega, heading", &[end.eta2, end.eta1, end.phi], &expected, 1.0, 1e-13);
}

guen::mechanical_system! {
    /// A body that does not turn about one of its own axes.
    pub system Suslov {
        constants { A > 0, B > 0, C > 0, D, E }
        coordinates { w, i, j, k }
        let R = quaternion(w, i, j, k);
        bodies { body { inertia: sym(A, B, C, 0, D, E), orientation: R } }
        parameters { p = angular_velocity_body(R).x; q = angular_velocity_body(R).y; }
        constraints { fork: inner(R.z, body.angular_velocity) = 0; }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
    }
}

#[test]
fn suslov_s_body_comes_to_its_steady_turning() {
    let system = Suslov { A: 1.0, B: 2.0, C: 2.5, D: -0.4, E: 0.3 }.prepare().unwrap();
    let start = suslov::State { w: 1.0, p: 1.0, q: 0.5, ..Default::default() };
    let end = Integration::new(&projected(&system), 0.0, &start.into()).run(&Dop853::new(1e-14, 1e-14), 8.0);
    let end: suslov::State = end.unwrap().state.into();
    close("p, q", &[end.p, end.q], &[0.8503546007023, 0.6232563890825], 1.0, 1e-12);
}

guen::mechanical_system! {
    /// A particle on a rod: benchmark A01 of IFToMM.
    pub system Pendulum {
        constants { m > 0 = 1, l > 0 = 1, g = 9.81 }
        coordinates { angle }
        particles { m at l*vec(cos(angle), sin(angle)); }
        gravity = vec(0, -g);
        parameters { speed = dot(angle); }
    }
}

#[test]
fn pendulum_from_the_horizontal_is_where_jacobi_s_functions_say() {
    let system = Pendulum::default().prepare().unwrap();
    let start = pendulum::State { angle: -std::f64::consts::PI, speed: 0.0 };
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-14, 1e-14), 10.0);
    let end: pendulum::State = end.unwrap().state.into();
    let expected = [-0.275087462576117, -0.961419205099125];
    close("place", &[end.angle.cos(), end.angle.sin()], &expected, 1.0, 1e-12);
}

#[test]
fn ball_on_a_turntable_runs_in_a_circle_at_two_sevenths_of_its_speed() {
    // The velocity of the centre turns at 2/7 Omega (Weltner 1979), whatever the start.
    let rate = 1.3;
    let system = EvenTurntable { m: 0.7, a: 0.2, Omega: rate }.prepare().unwrap();
    let start = even_turntable::State {
        x: 0.4,
        y: -0.1,
        theta: 1.0,
        eta1: 0.3,
        eta2: 1.1,
        eta3: 0.2,
        ..Default::default()
    };
    let period = 2.0 * std::f64::consts::PI / (2.0 / 7.0 * rate);
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-14, 1e-14), period);
    let end: even_turntable::State = end.unwrap().state.into();
    close("place", &[end.x, end.y], &[start.x, start.y], 1.0, 1e-12);
    close("spin", &[end.eta1, end.eta2, end.eta3], &[start.eta1, start.eta2, start.eta3], 1.0, 1e-12);
}
