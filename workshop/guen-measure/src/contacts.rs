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
use guen::steppers::{Dop853, Method};
use guen_benchmarks::contacts::{BouncingBall, PendulumStop, StickSlip};

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
