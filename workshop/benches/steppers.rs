//! What a stepper costs beyond the right-hand side, and what its guards cost.
//!
//! ```text
//! cargo bench -p guen-benchmarks --bench steppers
//! RUSTFLAGS="-C target-cpu=native" cargo bench -p guen-benchmarks --bench steppers
//! ```
//!
//! The paper's hoop over ten seconds. Each figure is the median of many short runs, and those that are compared are
//! taken in turn. The right-hand side alone is timed twice: `chain` evaluates each at the state that the one before
//! moved by a tiny step of Euler's method, so that one waits for the other as in a stepper; `apart` evaluates at 1024
//! states that do not depend on each other, of which the processor works on several at once. `beyond` is what a
//! stepper takes for an evaluation beyond the latter, so it counts the waiting as the stepper's. An evaluation of `Taylor` is
//! one order of a series, which is no right-hand side: only its last columns compare with those of the others.

use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::Instant;

use guen::prelude::*;
use guen::steppers::Method;

guen_benchmarks::hoop! { guen::mechanical_system; provide taylor; }

type State = [f64; 9];

/// Seconds that a task takes, once.
fn seconds(task: &mut dyn FnMut()) -> f64 {
    let start = Instant::now();
    task();
    start.elapsed().as_secs_f64()
}

/// The medians of tasks that are run in turn, and beside each half the distance of its quartiles.
fn medians<const K: usize>(tasks: [&mut dyn FnMut(); K]) -> [(f64, f64); K] {
    const ROUNDS: usize = 301;
    let mut times: [Vec<f64>; K] = std::array::from_fn(|_| Vec::with_capacity(ROUNDS));
    for _ in 0..ROUNDS {
        for k in 0..K {
            times[k].push(seconds(tasks[k]));
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        (times[ROUNDS / 2], (times[3 * ROUNDS / 4] - times[ROUNDS / 4]) / 2.0)
    })
}

fn run<M>(hoop: &hoop::Prepared, start: &State, method: &M, guard: Guard) -> IntegrationResult<f64, 9>
where
    M: Method<f64, hoop::Prepared, 9>,
{
    let start = black_box(start);
    black_box(Integration::new(hoop, 0.0, start).guard(guard).run(method, 10.0).expect("the hoop rolls"))
}

fn measure<M>(name: &str, hoop: &hoop::Prepared, start: &State, method: &M)
where
    M: Method<f64, hoop::Prepared, 9>,
{
    const CHAIN: u64 = 2000;
    let mut chain = || {
        let mut x = *black_box(start);
        for _ in 0..CHAIN {
            let rates = System::rhs(hoop, 0.0, &x);
            for (x, rate) in x.iter_mut().zip(rates) {
                *x += 1e-9 * rate;
            }
        }
        black_box(x);
    };
    let states: Vec<State> = (0..1024)
        .map(|k| std::array::from_fn(|i| start[i] + 1e-3 * f64::from(k % 32) * (i as f64 - 4.0)))
        .collect();
    let mut apart = || {
        for x in black_box(&states) {
            black_box(System::rhs(hoop, 0.0, x));
        }
    };
    let evaluations = run(hoop, start, method, Guard::default()).statistics.evaluations as f64;
    let mut plain = || {
        run(hoop, start, method, Guard::FINITE);
    };
    let mut guarded = || {
        run(hoop, start, method, Guard::default());
    };
    let [(chain, _), (apart, _), (plain, spread), (guarded, _)] =
        medians([&mut chain, &mut apart, &mut plain, &mut guarded]);
    let chain = 1e9 * chain / CHAIN as f64;
    let apart = 1e9 * apart / states.len() as f64;
    let each = 1e9 * plain / evaluations;
    println!(
        "{name:<22} {evaluations:>7} {:>9.1} {each:>9.2} {chain:>7.2} {apart:>7.2} {:>8.2} {:>8.3} {:>6.1}%",
        1e6 * plain,
        each - apart,
        guarded / plain,
        100.0 * spread / plain,
    );
}

fn main() {
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().expect("positive constants");
    let start: State = hoop::State {
        theta: 1.1,
        psi: 0.3,
        phi: -0.2,
        zeta: 1.1_f64.sin(),
        eta1: 0.4,
        eta2: 0.9,
        eta3: 2.5,
        ..Default::default()
    }
    .into();
    println!("The hoop over 10 s; times in ns where not said otherwise, medians of interleaved runs.\n");
    println!(
        "{:<22} {:>7} {:>9} {:>9} {:>7} {:>7} {:>8} {:>8} {:>7}",
        "method", "evals", "run, us", "per eval", "chain", "apart", "beyond", "guarded", "spread"
    );
    measure("DOP853 1e-6", &hoop, &start, &Dop853::new(1e-6, 1e-6));
    measure("DOP853 1e-9", &hoop, &start, &Dop853::new(1e-9, 1e-9));
    measure("DOP853 1e-12", &hoop, &start, &Dop853::new(1e-12, 1e-12));
    measure("Tsit5 1e-6", &hoop, &start, &Tsit5::new(1e-6, 1e-6));
    measure("RK4 h = 0.01", &hoop, &start, &Rk4::new(0.01));
    measure("RK8 h = 0.1", &hoop, &start, &Rk8::new(0.1));
    measure("Taylor 1e-6", &hoop, &start, &Taylor::new(1e-6, 1e-6));
    measure("Taylor 1e-12", &hoop, &start, &Taylor::new(1e-12, 1e-12));
    measure("Euler h = 0.0001", &hoop, &start, &Euler::new(0.0001));

    // The observer's price: a closure that does next to nothing, called once in a step.
    let method = Dop853::new(1e-9, 1e-9);
    let mut bare = || {
        run(&hoop, &start, &method, Guard::default());
    };
    let mut observed = || {
        let mut steps = 0_u64;
        let done = method.integrate(&hoop, 0.0, &start, 10.0, |_, _| {
            steps += 1;
            ControlFlow::Continue(())
        });
        black_box((done.is_ok(), steps));
    };
    let times: Vec<f64> = (0..=1000).map(|k| 0.01 * f64::from(k)).collect();
    let mut sampled = || {
        let mut sum = 0.0;
        let done = Integration::new(&hoop, 0.0, &start)
            .sample(&times, &mut |_, _, x| sum += x[0])
            .run(&method, 10.0);
        black_box((done.is_ok(), sum));
    };
    let height = |_: f64, x: &State| x[0] - 0.5;
    let mut watched = || {
        let mut count = 0;
        let done = Integration::new(&hoop, 0.0, &start)
            .events([Event::new(&height)], &mut |_| {
                count += 1;
                ControlFlow::Continue(())
            })
            .run(&method, 10.0);
        black_box((done.is_ok(), count));
    };
    let [(bare, _), (observed, _), (sampled, _), (watched, _)] =
        medians([&mut bare, &mut observed, &mut sampled, &mut watched]);
    println!("\nDOP853 1e-9: with an observer {:.3} of the time without; ", observed / bare);
    println!("with 1001 samples {:.3}; with an event {:.3}", sampled / bare, watched / bare);
}
