//! Runs three scenes with contacts at many tolerances, for the comparison in `workshop/benches/peers/contacts.py`.
//!
//! ```text
//! cargo run --release -p guen-measure --bin contacts
//! ```
//!
//! A line of JSON for each scene and tolerance: the times of its transitions, the state at the end, and the shortest time of a run in microseconds.

use std::error::Error;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use guen::hybrid::{Hybrid, HybridSystem, InMode, Transition, TransitionKind};
use guen::mechanical_system;
use guen::steppers::{Dop853, Method};

mechanical_system! {
    pub system BouncingBall {
        constants   { g = 9.81, e = 4/5 }
        coordinates { z }
        parameters  { v = dot(z); }
        kinetic_energy = 1/2*v^2;
        potential_energy = g*z;
        contacts    { floor: gap = z, restitution = e; }
    }
}

mechanical_system! {
    pub system PendulumStop {
        constants   { l = 1, g = 9.81, e = 3/5, limit = 1/5 }
        coordinates { theta }
        parameters  { omega = dot(theta); }
        kinetic_energy = l^2/2*omega^2;
        potential_energy = -g*l*cos(theta);
        contacts    { stop: gap = theta + limit, restitution = e; }
    }
}

mechanical_system! {
    pub system StickSlip {
        constants   { m = 1, k = 1, vb = 1/5, mus = 1/10, delta = 3, g = 10 }
        coordinates { x, z }
        parameters  { u = dot(x); w = dot(z); }
        kinetic_energy = m/2*(u^2 + w^2);
        potential_energy = k/2*x^2 + m*g*z;
        contacts    { belt: gap = z, slip = dot(x) - vb, friction = mus/(1 + delta*speed), restitution = 0; }
    }
}

/// Runs of which the shortest time counts.
const RUNS: u32 = 200;

/// Prints a line for each tolerance.
fn scene<H, const N: usize, const W: usize, const C: usize, const S: usize>(
    name: &str,
    system: &H,
    start: [f64; N],
    end: f64,
) -> Result<(), Box<dyn Error>>
where
    H: HybridSystem<N, W, C, S> + Clone,
    Dop853: Method<f64, InMode<H, N, W, C, S>, N>,
{
    for tolerance in (2..=13).map(|digits| 10.0_f64.powi(-digits)) {
        let (mut times, mut state) = (Vec::new(), start);
        Hybrid::new(system, 0.0, &start)
            .sample(&[end], &mut |_, _, x: &[f64; N], _: &H::Mode| state = *x)
            .transitions(&mut |at: &Transition<H::Mode, N, W, C>| {
                // The end of infinitely many impacts is a time of its own.
                times.push(match at.kind {
                    TransitionKind::Rest { until, .. } => until,
                    _ => at.t,
                });
                ControlFlow::Continue(())
            })
            .run(&Dop853::new(tolerance, tolerance), end)
            .map_err(|error| format!("{name} at {tolerance:e}: {error}"))?;
        let mut shortest = f64::INFINITY;
        for _ in 0..RUNS {
            let begin = Instant::now();
            let done = Hybrid::new(system, 0.0, &start).run(&Dop853::new(tolerance, tolerance), end);
            shortest = shortest.min(begin.elapsed().as_secs_f64() * 1e6);
            black_box(done.is_ok());
        }
        println!(
            "{{\"scene\": \"{name}\", \"setting\": {tolerance:e}, \"times\": {times:?}, \"end\": {state:?}, \"us\": {shortest}}}"
        );
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    scene("bouncing_ball", &BouncingBall::default().prepare()?, [1.0, 0.0], 5.0)?;
    scene("pendulum_stop", &PendulumStop::default().prepare()?, [1.0, 0.0], 10.0)?;
    scene("stick_slip_belt", &StickSlip::default().prepare()?, [1.5, 0.0, 0.0, 0.0], 40.0)
}
