//! The heavy top of Terze, Müller, Zlatar (2016), recomputed in 30 digits: right to the twelve digits that stand here. The Euler
//! top against Jacobi's functions, evaluated in 30 digits.

use super::close;
use guen::prelude::*;
use guen::projected;
use guen_benchmarks::systems::{EulerTop, euler_top};

guen::mechanical_system! {
    pub system HeavyTop {
        constants { m > 0 = 15, A > 0 = 0.234375, B > 0 = 0.46875, l = 1, g = 9.81 }
        coordinates { w, i, j, k }
        let R = quaternion(w, i, j, k);
        bodies { top { mass: m, inertia: diag(A, B, A), center: R*vec(0, l, 0), orientation: R } }
        gravity = vec(0, 0, -g);
        parameters { spin = angular_velocity_body(R); }
        holonomic { length: w^2 + i^2 + j^2 + k^2 = 1; }
    }
}

#[test]
fn heavy_top_turns_as_it_is_published_to() {
    let system = HeavyTop::default().prepare().unwrap();
    let start = heavy_top::State { w: 1.0, spin_y: 150.0, spin_z: -4.61538, ..Default::default() };
    let end = Integration::new(&projected(&system), 0.0, &start.into())
        .run(&Dop853::new(1e-13, 1e-13), 0.2)
        .unwrap()
        .state;
    let quaternion = [-0.708279152974, 0.438781088127, 0.545728396145, 0.089399752824];
    close("quaternion", &end[..4], &quaternion, 1.0, 2e-11);
    close("spin", &end[4..], &[-2.6915909121, 150.0, 4.9172609899], 1.0, 1e-9);
}

#[test]
fn euler_top_follows_jacobi_s_functions() {
    let [a, b, c] = [2.0, 1.0, 2.0 / 3.0];
    let system = EulerTop { I1: a, I2: b, I3: c }.prepare().unwrap();
    let (sin, cos) = 1.1_f64.sin_cos();
    let start = euler_top::State { theta: 1.0, p: cos / a, r: sin / c, ..Default::default() };
    let end = Integration::new(&system, 0.0, &start.into()).run(&Dop853::new(1e-13, 1e-13), 10.0);
    let end: euler_top::State = end.unwrap().state.into();
    let momentum = [a * end.p, b * end.q, c * end.r];
    close("momentum", &momentum, &[0.4070661365880408, 0.2830074268128441, 0.8684491676615616], 1.0, 1e-11);
}
