//! What guards cost: runs with the default guard and with none beyond finiteness, in turn.
//!
//! ```text
//! cargo bench --bench guards
//! python3 benches/guard_instructions.py      # the ratio of instructions, which decides; needs valgrind
//! ```
//!
//! The hoop of the paper and a chain of five links over some seconds. With a method and `plain` or `guarded` as arguments
//! one run is made and nothing printed: what callgrind counts.

use std::hint::black_box;
use std::time::Instant;

use guen::Differentiable;
use guen::prelude::*;
use guen::steppers::Method;
use guen_benchmarks::systems::{Chain5, Hoop, chain5, hoop};

/// Runs with either guard, by name.
struct Pair {
    name: String,
    run: Box<dyn Fn(Guard)>,
}

fn pair<S, M, const N: usize>(
    system: &'static str,
    method: &'static str,
    of: S,
    start: [f64; N],
    span: f64,
    by: M,
) -> Pair
where
    S: System<f64, N> + 'static,
    M: Method<f64, S, N> + 'static,
{
    let run = Box::new(move |guard: Guard| {
        let start = black_box(&start);
        black_box(
            Integration::new(&of, 0.0, start).guard(guard).run(&by, span).expect("nothing is wrong with it"),
        );
    });
    Pair { name: format!("{system}:{method}"), run }
}

fn pairs_of<S, const N: usize>(name: &'static str, system: S, start: [f64; N], span: f64) -> Vec<Pair>
where
    S: System<f64, N> + Differentiable<f64, N> + Copy + 'static,
{
    vec![
        pair(name, "euler", system, start, span / 8.0, Euler { step: 1e-5 }),
        pair(name, "rk4", system, start, span, Rk4 { step: 1e-3 }),
        pair(name, "rk8", system, start, span, Rk8::new(1e-2)),
        pair(name, "gauss4", system, start, span / 8.0, Gauss4::new(1e-3)),
        pair(name, "gauss6", system, start, span / 8.0, Gauss6::new(1e-3)),
        pair(name, "tsit5", system, start, span, Tsit5::new(1e-9, 1e-9)),
        pair(name, "dop853", system, start, span, Dop853::new(1e-9, 1e-9)),
        pair(name, "radau5", system, start, span / 8.0, Radau5::new(1e-9, 1e-9)),
    ]
}

fn pairs() -> Vec<Pair> {
    let rolling = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().expect("positive constants");
    let start: [f64; 9] = hoop::State {
        theta: 1.1,
        zeta: 1.1_f64.sin(),
        eta1: 0.4,
        eta2: 0.9,
        eta3: 2.5,
        ..Default::default()
    }
    .into();
    let hanging = Chain5 { m: 1.0, l: 0.5, g: 9.81 }.prepare().expect("positive constants");
    let angles: [f64; 10] =
        chain5::State { q1: 0.3, q2: 0.2, q3: -0.1, q4: 0.4, q5: 0.3, ..Default::default() }.into();
    let mut pairs = pairs_of("hoop", rolling, start, 10.0);
    pairs.extend(pairs_of("chain5", hanging, angles, 4.0));
    pairs
}

fn seconds(run: &dyn Fn(Guard), guard: Guard) -> f64 {
    let start = Instant::now();
    run(guard);
    start.elapsed().as_secs_f64()
}

fn main() {
    const ROUNDS: usize = 61;
    let arguments: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    if let [name, guard] = &arguments[..] {
        let guard = if guard == "plain" { Guard::FINITE } else { Guard::default() };
        if let Some(pair) = pairs().iter().find(|pair| pair.name == *name) {
            (pair.run)(guard);
        }
        return;
    }
    println!("{:<16} {:>10} {:>18}", "run", "us", "guarded to plain");
    for Pair { name, run } in pairs() {
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..ROUNDS {
            times[0].push(seconds(&run, Guard::FINITE));
            times[1].push(seconds(&run, Guard::default()));
        }
        let [plain, guarded] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[ROUNDS / 2]
        });
        println!("{name:<16} {:>10.1} {:>18.3}", 1e6 * plain, guarded / plain);
    }
}
