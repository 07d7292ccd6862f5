//! The energy of the paper's hoop over a long time, by Taylor's method.
//!
//! ```text
//! cargo run --release -p guen-measure --bin taylor_energy          # ten thousand seconds
//! cargo run --release -p guen-measure --bin taylor_energy -- 300   # fewer
//! ```
//!
//! For several orders and tolerances prints the largest error of the energy relative to its size, and the time. The energy
//! is evaluated in 71 digits at the states that the run reached, because in double precision its own evaluation would be
//! off by more than what is to be seen. Ends with a nonzero status where the finest setting is off by more than 2e-15.

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use guen::prelude::*;

use guen_study::Digits71;

guen_benchmarks::hoop!(guen::mechanical_system; provide taylor;);

/// What the energy may be off by with the finest setting: the rounding of the state alone is 1e-16.
const ALLOWED: f64 = 2e-15;
/// The energy is looked at every so many steps, and at the end.
const EVERY: u64 = 16;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let span: f64 = match std::env::args().nth(1) {
        Some(argument) => argument.parse().map_err(|_| format!("`{argument}` is no number of seconds"))?,
        None => 1e4,
    };
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare()?;
    let long: hoop::Prepared<Digits71> = {
        let of = Digits71::from_ratio;
        Hoop { a: of(1, 1), A: of(1, 2), C: of(1, 1), g: of(981, 100) }.prepare()?
    };
    let start = hoop::State { theta: 1.2, psi: 0.3, eta1: 0.1, eta2: 0.4, eta3: 5.0, ..Default::default() };
    let start: [f64; 9] = hoop::State { zeta: start.theta.sin(), ..start }.into();
    let energy = |t: f64, x: &[f64; 9]| {
        long.energy(Digits71::from_f64(t), &hoop::State::from(x.map(Digits71::from_f64)))
    };
    let first = energy(0.0, &start);
    let off = |t: f64, x: &[f64; 9]| ((energy(t, x) - first) / first).abs().to_f64();

    println!("| method | steps | energy off by | at the end | seconds |");
    println!("| --- | --- | --- | --- | --- |");
    let mut finest = f64::NAN;
    for (order, tolerance) in [(15, 1e-12), (20, 1e-14), (24, 1e-16), (20, 1e-18), (16, 1e-18)] {
        let method = Taylor::new(tolerance, tolerance).with_order(order).with_max_steps(u64::MAX);
        let (mut seen, mut steps) = (Vec::new(), 0);
        let clock = Instant::now();
        let done = method.integrate(&hoop, 0.0, &start, span, |t, x| {
            steps += 1;
            if steps % EVERY == 0 {
                seen.push((t, *x));
            }
            ControlFlow::Continue(())
        })?;
        let seconds = clock.elapsed().as_secs_f64();
        let last = off(done.time, &done.state);
        finest = seen.iter().map(|(t, x)| off(*t, x)).fold(last, f64::max);
        println!(
            "| Taylor, order {order}, {tolerance:e} | {} | {finest:.1e} | {last:.1e} | {seconds:.3} |",
            done.statistics.accepted
        );
    }
    Ok(if finest <= ALLOWED { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
