//! Forces that are constant to rounding where a series is expanded, and others further on: no coefficient tells of them. The
//! references are runs of order eight whose steps are far shorter than anything there.

use std::cell::Cell;

use guen::mechanical_system;
use guen::prelude::*;
use guen::steppers::Outcome;

mechanical_system! {
    /// On a spring, and pushed from a time on.
    system Ramp {
        constants { e > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = 1/2*v^2;
        forces { (1 + tanh((t - 1)/e))/2 - x along v; }
        provide taylor;
    }
}

mechanical_system! {
    /// A ball that falls onto a floor.
    system Ball {
        constants { k > 0, e > 0, d >= 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = 1/2*v^2;
        potential_energy = 9.81*x;
        forces { k*e*ln(1 + exp(-x/e)) - d*v along v; }
        provide taylor;
    }
}

mechanical_system! {
    /// A pendulum with dry friction.
    system Dry {
        constants { c >= 0, e > 0 }
        coordinates { q }
        parameters { w = dot(q); }
        kinetic_energy = 1/2*w^2;
        potential_energy = -9.81*cos(q);
        forces { -c*tanh(w/e) along w; }
        provide taylor;
    }
}

fn off(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    f64::max((a[0] - b[0]).abs(), (a[1] - b[1]).abs())
}

fn reference<S: System<f64, 2>>(system: &S, start: [f64; 2], end: f64) -> [f64; 2] {
    let method = Rk8::new(1e-4);
    Integration::new(system, 0.0, &start).run(&method, end).unwrap().state
}

#[test]
fn a_push_that_begins_on_the_way() {
    for e in [0.3, 0.03, 0.003] {
        let system = Ramp { e }.prepare().unwrap();
        let exact = reference(&system, [0.2, 0.0], 3.0);
        for tolerance in [1e-6, 1e-10, 1e-15] {
            let run = Integration::new(&system, 0.0, &[0.2, 0.0])
                .run(&Taylor::new(tolerance, tolerance), 3.0)
                .unwrap();
            let error = off(&run.state, &exact);
            println!("{e} {tolerance:e}: {error:.1e}, {:?}", run.statistics);
            assert!(error < f64::max(300.0 * tolerance, 3e-12), "{e} {tolerance:e}: {error:e}");
        }
    }
}

#[test]
fn a_ball_stays_above_its_floor() {
    let system = Ball { k: 1e4, e: 0.01, d: 1.0 }.prepare().unwrap();
    let exact = reference(&system, [1.0, 0.0], 1.5);
    for tolerance in [1e-8, 1e-12, 1e-15] {
        let method = Taylor::new(tolerance, tolerance);
        let lowest = Cell::new(f64::INFINITY);
        let below = |_: f64, x: &[f64; 2]| x[0] + 0.5;
        let times: Vec<f64> = (0..=300).map(|k| 0.005 * f64::from(k)).collect();
        // Neither a sample nor an event comes from a step that is refused.
        let run = Integration::new(&system, 0.0, &[1.0, 0.0])
            .sample(&times, &mut |_, _, x| lowest.set(lowest.get().min(x[0])))
            .events([Event::new(&below).terminal()], &mut |_| ControlFlow::Continue(()))
            .run(&method, 1.5)
            .unwrap();
        let error = off(&run.state, &exact);
        println!("{tolerance:e}: {error:.1e}, lowest {:.3}, {:?}", lowest.get(), run.statistics);
        assert_eq!(run.outcome, Outcome::Arrived);
        assert!(lowest.get() > -0.1 && error < f64::max(1e4 * tolerance, 1e-9), "{tolerance:e}: {error:e}");
    }
}

#[test]
fn a_pendulum_that_turns_back() {
    let mut bits = 7_u64;
    let mut number = || {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (bits >> 33) as f64 / (1_u64 << 31) as f64
    };
    let mut worst = 0.0_f64;
    for _ in 0..12 {
        let system = Dry { c: 0.2 + number(), e: 0.01 }.prepare().unwrap();
        let start = [1.0 + number(), 4.0 * number() - 2.0];
        let exact = reference(&system, start, 2.0);
        let run = Integration::new(&system, 0.0, &start).run(&Taylor::new(1e-15, 1e-15), 2.0).unwrap();
        worst = worst.max(off(&run.state, &exact));
    }
    println!("{worst:.1e}");
    assert!(worst < 1e-10, "{worst:e}");
}
