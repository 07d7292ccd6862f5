//! The ensemble on two threads against one, beside what a loop in registers gains from the second thread.

use std::hint::black_box;
use std::time::Instant;

use guen::prelude::*;
use guen_benchmarks::systems::hoop::{Prepared, State};
use guen_study::Ensemble;

use crate::median;

/// Rounds in which the four candidates take turns.
const ROUNDS: usize = 31;
/// Trajectories, and steps of each.
const HOOPS: usize = 2048;
const STEPS: usize = 200;
/// Rounds of the loop in registers, for each thread.
const TURNS: u64 = 4_000_000;

/// Work done in a nanosecond by so many threads that share nothing but the processor.
fn calibration(threads: usize) -> f64 {
    let turn = || {
        let mut x = black_box(0.3_f64);
        for _ in 0..TURNS {
            x = 3.7 * x * (1.0 - x);
        }
        black_box(x);
    };
    let begin = Instant::now();
    std::thread::scope(|scope| {
        for _ in 1..threads {
            scope.spawn(turn);
        }
        turn();
    });
    (threads as u64 * TURNS) as f64 / begin.elapsed().as_nanos() as f64
}

/// Steps made in a nanosecond.
fn steps(ensemble: &Ensemble<Prepared, 9>) -> f64 {
    let begin = Instant::now();
    let ends = ensemble.integrate(&Rk4::new(1e-3), 0.0, 1e-3 * STEPS as f64);
    let seconds = begin.elapsed().as_nanos() as f64;
    assert!(ends.iter().all(Result::is_ok));
    (HOOPS * STEPS) as f64 / seconds
}

pub fn table(hoop: Prepared) {
    let start =
        |i: usize| State { theta: 0.8 + i as f64 / HOOPS as f64, eta2: 3.0, eta3: 0.9, ..Default::default() };
    let two = Ensemble::of_states(hoop, (0..HOOPS).map(start)).with_threads(2);
    let one = two.clone().with_threads(1);
    let mut rounds: [Vec<f64>; 4] = Default::default();
    for _ in 0..ROUNDS {
        let round = [calibration(1), calibration(2), steps(&one), steps(&two)];
        rounds.iter_mut().zip(round).for_each(|(all, one)| all.push(one));
    }
    let gain = |of: usize, over: usize| -> Vec<f64> {
        rounds[of].iter().zip(&rounds[over]).map(|(of, over)| of / over).collect()
    };
    let (loops, ensembles) = (gain(1, 0), gain(3, 2));
    let ratio = median(ensembles.iter().zip(&loops).map(|(ensemble, of_loop)| ensemble / of_loop).collect());
    println!("\nensemble of {HOOPS} hoops, gain by the second thread");
    println!("  loop in registers {:.2}, ensemble {:.2}, ratio {ratio:.3}", median(loops), median(ensembles));
    println!(
        "  {:.2} ns for a step of RK4 on one thread",
        median(rounds[2].iter().map(|rate| 1.0 / rate).collect())
    );
}
