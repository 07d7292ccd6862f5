//! Times Taylor's method on the hoop on request, a line for each line that is read: the partner of
//! `workshop/benches/peers/taylor_heyoka.py`.
//!
//! ```text
//! conditions              how this program was compiled, and for what
//! problem                 constants a, A, C, g; span; the state at the beginning and at the end, of the reference
//! run TOLERANCE ORDER     error of the end state, steps, microseconds of a run; `default` for the order that suits
//! expand ORDER            nanoseconds of an expansion into a series
//! ```
#![allow(clippy::result_large_err, reason = "an error keeps the state that was reached")]

use std::hint::black_box;
use std::io::{self, BufRead, Write};
use std::time::Instant;
use std::{error, fmt::Write as _};

use guen::prelude::*;
use guen::steppers::Taylor;
use guen::{HIGHEST_ORDER, TaylorSeries};
use guen_benchmarks::timing::conditions;

guen_benchmarks::hoop!(guen::mechanical_system; provide taylor;);

/// The reference: the state at the beginning and after ten seconds, from `tests/data`, where numbers are texts.
fn reference() -> Option<[[f64; 9]; 2]> {
    let text = include_str!("../../../tests/data/01_hoop_rolling.json");
    let file: serde_json::Value = serde_json::from_str(text).ok()?;
    let case = &file["cases"][0];
    let at = case["times"].as_array()?.iter().position(|time| time == "10")?;
    let state = |k: usize| -> Option<[f64; 9]> {
        let entries = case["states"].get(k)?.as_array()?;
        let numbers: Option<Vec<f64>> = entries.iter().map(|entry| entry.as_str()?.parse().ok()).collect();
        numbers?.try_into().ok()
    };
    Some([state(0)?, state(at)?])
}

const SPAN: f64 = 10.0;
/// How often something is timed: the shortest time counts, which other work on the machine disturbs least.
const TIMES: u32 = 101;

/// The shortest time of a call, in seconds.
fn seconds<T>(mut call: impl FnMut() -> T) -> f64 {
    let once = |_| {
        let start = Instant::now();
        black_box(call());
        start.elapsed().as_secs_f64()
    };
    (0..TIMES).map(once).fold(f64::INFINITY, f64::min)
}

fn main() -> Result<(), Box<dyn error::Error>> {
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare()?;
    let [begin, end] = reference().ok_or("the reference cannot be read")?;
    for line in io::stdin().lock().lines() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let answer = match words[..] {
            ["conditions"] => conditions().trim_end().replace('\n', ";"),
            ["problem"] => {
                let mut text = format!("1 0.5 1 9.81 {SPAN}");
                for x in begin.iter().chain(&end) {
                    write!(text, " {x:e}")?;
                }
                text
            }
            ["run", tolerance, order] => {
                let tolerance = tolerance.parse()?;
                let method = Taylor::new(tolerance, tolerance);
                let method = if order == "default" { method } else { method.with_order(order.parse()?) };
                let run = || Integration::new(&hoop, 0.0, &begin).run(&method, SPAN);
                let Ok(done) = run() else {
                    println!("inf 0 inf");
                    continue;
                };
                let error = (0..9).map(|i| (done.state[i] - end[i]).abs()).fold(0.0, f64::max);
                format!("{error:e} {} {}", done.statistics.accepted, 1e6 * seconds(run))
            }
            ["expand", order] => {
                let order = order.parse()?;
                let mut coefficients = [[0.0; 9]; HIGHEST_ORDER + 1];
                // Longer than the clock's own time.
                const MANY: u32 = 100;
                let time = seconds(|| {
                    for _ in 0..MANY {
                        hoop.series(0.0, black_box(&begin), black_box(0.125), order, &mut coefficients);
                        black_box(&coefficients);
                    }
                });
                let products = <hoop::Prepared as TaylorSeries<f64, 9>>::PRODUCTS;
                format!("{products} products, {:.1} ns", 1e9 * time / f64::from(MANY))
            }
            _ => String::from("?"),
        };
        println!("{answer}");
        io::stdout().flush()?;
    }
    Ok(())
}
