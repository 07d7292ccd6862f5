//! Walks a hot path a given number of times, for an instruction counter to look at: the partner of
//! `workshop/benches/instructions`.
//!
//! ```text
//! paths list                                    the systems
//! paths SYSTEM declared|by-hand PATH COUNT      PATH is rhs, rk4 or dop853
//! ```
//!
//! It answers with the number of evaluations or steps that were made.

use std::hint::black_box;
use std::{env, error};

use guen::System;
use guen::prelude::*;
use guen_benchmarks::{Random, Subject, Visitor, visit_all};

/// States that evaluations go through, so that a count is a mean over them.
const STATES: usize = 256;

struct Walk {
    words: Vec<String>,
    answer: Option<u64>,
}

impl Visitor for Walk {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        match &self.words[..] {
            [command] if command == "list" => println!("{}", S::NAME),
            [name, program, path, count] if name == S::NAME => {
                let Ok(count) = count.parse() else { return };
                let mut random = Random::new(1);
                let states: Vec<[f64; N]> = (0..STATES).map(|_| S::state(&mut random)).collect();
                self.answer = match program.as_str() {
                    "declared" => walk(S::declared::<f64>(), &states, path, count),
                    "by-hand" => walk(S::by_hand::<f64>(), &states, path, count),
                    _ => None,
                };
            }
            _ => {}
        }
    }
}

#[inline(never)]
fn evaluate<S: System<f64, N>, const N: usize>(system: &S, state: &[f64; N]) -> [f64; N] {
    system.rhs(0.0, state)
}

fn walk<const N: usize>(
    system: impl System<f64, N>,
    states: &[[f64; N]],
    path: &str,
    count: u64,
) -> Option<u64> {
    let on = |_, _: &[f64; N]| ControlFlow::Continue(());
    let end = count as f64 * 1e-3;
    match path {
        "rhs" => {
            for state in states.iter().cycle().take(usize::try_from(count).ok()?) {
                black_box(evaluate(&system, state));
            }
            Some(count)
        }
        "rk4" => {
            let done = Rk4::new(1e-3).integrate(&system, 0.0, &states[0], end, on).ok()?;
            Some(done.statistics.accepted)
        }
        "dop853" => {
            // A tolerance so wide that the step stays at what the span allows would not be a step of this method.
            let done = Dop853::new(1e-12, 1e-12).integrate(&system, 0.0, &states[0], 10.0 * end, on).ok()?;
            Some(done.statistics.accepted + done.statistics.rejected)
        }
        _ => None,
    }
}

fn main() -> Result<(), Box<dyn error::Error>> {
    let mut walk = Walk { words: env::args().skip(1).collect(), answer: None };
    visit_all(&mut walk);
    match walk.answer {
        Some(units) => println!("{units}"),
        None if walk.words == ["list"] => {}
        None => return Err("usage: paths list, or paths SYSTEM declared|by-hand rhs|rk4|dop853 COUNT".into()),
    }
    Ok(())
}
