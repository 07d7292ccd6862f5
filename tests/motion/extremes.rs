//! What was silent once, each by itself: steps that are too long where nobody looked. The whole battery is
//! `cargo run --release -p guen-measure --bin extremes`.

use guen::prelude::*;
use guen::steppers::Method;
use guen_benchmarks::systems::{EulerTop, Hoop, hoop};

guen::mechanical_system! {
    system Damped {
        constants { m > 0, k, c >= 0 }
        coordinates { q }
        parameters { v = dot(q); }
        kinetic_energy   = m/2*v^2;
        potential_energy = k/2*q^2;
        forces { -c*v along v; }
    }
}

#[test]
fn what_was_silent_is_refused() {
    fn cause<M, S, const N: usize>(method: &M, system: &S, start: &[f64; N], span: f64) -> Cause
    where
        M: Method<f64, S, N>,
        S: System<f64, N>,
    {
        let error = Integration::new(system, 0.0, start).run(method, span).unwrap_err();
        assert_eq!((error.time, error.state), (0.0, *start), "nothing but the start is in order");
        error.cause
    }
    // A pole of 1/sin(theta) that the first step jumps over.
    let top = EulerTop { I1: 1.0, I2: 2.0, I3: 3.0 }.prepare().unwrap();
    let start = [0.0, 1e-9, 0.0, 0.2, 0.3, 1.0];
    let causes = [
        cause(&Euler::new(1e-4), &top, &start, 1.0),
        cause(&Rk4::new(1e-3), &top, &start, 1.0),
        cause(&Rk8::new(4e-3), &top, &start, 1.0),
    ];
    for cause in causes {
        assert!(matches!(cause, Cause::ApproachingSingularity { .. } | Cause::Step { .. }), "{cause}");
    }
    // A tilt next to pi, of which rounding leaves nothing, in a run of a few steps.
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
    let theta = std::f64::consts::PI - 1e-9;
    let flat = hoop::State { theta, zeta: theta.sin(), eta2: theta.sin(), eta3: -1.0, ..Default::default() };
    let edge = cause(&Dop853::new(1e-12, 1e-12), &hoop, &flat.into(), 0.01);
    assert!(matches!(edge, Cause::ChartSingularity { .. }), "{edge}");
    // Damping of 1e6/s in ten steps: explicit methods blow up, Gauss's keep the velocity.
    let damped = Damped { m: 1.0, k: 1.0, c: 1e6 }.prepare().unwrap();
    let (start, step) = ([1.0, -1.0], 1e-3);
    let causes = [
        cause(&Rk4::new(step), &damped, &start, 0.01),
        cause(&Rk8::new(step), &damped, &start, 0.01),
        cause(&Gauss4::new(step), &damped, &start, 0.01),
        cause(&Gauss6::new(step), &damped, &start, 0.01),
    ];
    for cause in causes {
        assert!(matches!(cause, Cause::Step { entry: 1, .. }), "{cause}");
    }
    // The same methods where they are right: the velocity creeps.
    let slow = [1.0, -1e-6];
    for end in [
        Integration::new(&damped, 0.0, &slow).run(&Gauss4::new(step), 0.01).unwrap().state,
        Integration::new(&damped, 0.0, &slow).run(&Gauss6::new(step), 0.01).unwrap().state,
    ] {
        assert!((end[1] + 1e-6).abs() < 1e-12, "{end:?}");
    }
}
