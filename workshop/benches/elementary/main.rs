//! What the choice of the real costs: sine and cosine alone, and the hoop's right-hand side with them.
//!
//! ```text
//! cargo bench -p guen-benchmarks --bench elementary
//! RUSTFLAGS="-C target-cpu=native" cargo bench -p guen-benchmarks --bench elementary
//! ```
//!
//! Nanoseconds: medians of [`ROUNDS`] rounds in which all candidates take turns, each beside the median of its ratios to
//! the first. Throughput is over 1024 arguments or states; latency feeds every result into the next call. Errors are the
//! largest over the same arguments, against the accurate functions; those are measured in `tests/elementary.rs` of
//! `guen-runtime`.

#[path = "../lanes/hoop.rs"]
mod hoop;

use std::hint::black_box;
use std::time::Instant;

use guen::{Approx7, Approx13, Functions, Fused, Real, Std, System, WithFunctions};
use guen_benchmarks::systems::Hoop;

/// The number of arguments and of states.
const COUNT: usize = 1024;
/// Rounds, and passes over all arguments in each.
const ROUNDS: usize = 41;
const PASSES: usize = 10;

/// The functions of the crate `libm`, as they were used before there were own ones.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
struct LibmFunctions;

impl Functions<f64> for LibmFunctions {
    #[inline(always)]
    fn sin_cos(x: f64) -> (f64, f64) {
        libm::sincos(x)
    }
}

type Libm = WithFunctions<f64, LibmFunctions>;

/// One candidate: what it is called, and what to time.
struct Candidate {
    name: &'static str,
    error: f64,
    throughput: Box<dyn FnMut() -> f64>,
    latency: Box<dyn FnMut() -> f64>,
}

/// Nanoseconds for each of so many calls.
fn timed(calls: usize, work: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    work();
    begin.elapsed().as_secs_f64() * 1e9 / calls as f64
}

fn sines<R: Real>(name: &'static str, arguments: &[f64]) -> Candidate {
    let own: Vec<R> = arguments.iter().map(|x| R::from_f64(*x)).collect();
    let error = arguments.iter().fold(0.0, |error, &x| {
        let (sin, cos) = R::from_f64(x).sin_cos();
        let (exact_sin, exact_cos) = Real::sin_cos(x);
        f64::max(error, f64::max((sin.to_f64() - exact_sin).abs(), (cos.to_f64() - exact_cos).abs()))
    });
    let (first, mut results) = (own.clone(), vec![(R::zero(), R::zero()); COUNT]);
    let throughput = move || {
        timed(PASSES * COUNT, || {
            for _ in 0..PASSES {
                for (x, result) in black_box(&own).iter().zip(&mut results) {
                    *result = x.sin_cos();
                }
                black_box(&results);
            }
        })
    };
    let latency = move || {
        timed(PASSES * COUNT, || {
            let mut last = R::zero();
            let small = R::from_f64(1e-300);
            for _ in 0..PASSES {
                for x in black_box(&first) {
                    let (sin, cos) = (*x + last).sin_cos();
                    last = (sin + cos) * small;
                }
            }
            black_box(last);
        })
    };
    Candidate { name, error, throughput: Box::new(throughput), latency: Box::new(latency) }
}

/// The constants of the hoop.
const HOOP: [f64; 4] = [1.0, 0.5, 1.0, 9.81];

/// The derived right-hand side over some real.
fn derived<R: Real>(name: &'static str, states: &[[f64; 9]]) -> Candidate {
    let [a, inertia, axial, g] = HOOP.map(R::from_f64);
    let hoop = Hoop { a, A: inertia, C: axial, g }.prepare().expect("constants are in order");
    hoops(name, states, move |state| System::rhs(&hoop, R::zero(), state))
}

fn by_hand(name: &'static str, states: &[[f64; 9]]) -> Candidate {
    let [a, inertia, axial, g] = HOOP;
    let hoop = hoop::ByHand::new(a, inertia, axial, g);
    hoops(name, states, move |state: &[f64; 9]| hoop.rhs(state))
}

/// One function of one argument, called out of line so that a loop over arguments cannot be turned into lanes.
fn alone(
    name: &'static str,
    function: fn(f64) -> f64,
    reference: fn(f64) -> f64,
    arguments: &[f64],
) -> Candidate {
    let error = arguments.iter().fold(0.0, |error, &x| f64::max(error, (function(x) - reference(x)).abs()));
    let (own, mut results) = (arguments.to_vec(), vec![0.0; COUNT]);
    let first = own.clone();
    let function = black_box(function);
    let throughput = move || {
        timed(PASSES * COUNT, || {
            for _ in 0..PASSES {
                for (x, result) in black_box(&own).iter().zip(&mut results) {
                    *result = function(*x);
                }
                black_box(&results);
            }
        })
    };
    let latency = move || {
        timed(PASSES * COUNT, || {
            let mut last = 0.0;
            for _ in 0..PASSES {
                for x in black_box(&first) {
                    last = function(*x + last) * 1e-300;
                }
            }
            black_box(last);
        })
    };
    Candidate { name, error, throughput: Box::new(throughput), latency: Box::new(latency) }
}

fn hoops<R: Real>(
    name: &'static str,
    states: &[[f64; 9]],
    rhs: impl Fn(&[R; 9]) -> [R; 9] + Copy + 'static,
) -> Candidate {
    let [a, inertia, axial, g] = HOOP;
    let exact = Hoop { a, A: inertia, C: axial, g }.prepare().expect("constants are in order");
    let own: Vec<[R; 9]> = states.iter().map(|state| state.map(R::from_f64)).collect();
    let error = own.iter().zip(states).fold(0.0, |error, (own, state)| {
        let rates = rhs(own);
        let exact = System::rhs(&exact, 0.0, state);
        rates
            .iter()
            .zip(exact)
            .fold(error, |error, (rate, exact)| f64::max(error, (rate.to_f64() - exact).abs()))
    });
    let (first, mut results) = (own.clone(), own.clone());
    let throughput = move || {
        timed(PASSES * COUNT, || {
            for _ in 0..PASSES {
                for (state, result) in black_box(&own).iter().zip(&mut results) {
                    *result = rhs(state);
                }
                black_box(&results);
            }
        })
    };
    let latency = move || {
        timed(PASSES * COUNT, || {
            let mut state = first[0];
            let small = R::from_f64(1e-12);
            for _ in 0..PASSES * COUNT {
                let rates = rhs(&state);
                for (entry, rate) in state.iter_mut().zip(rates) {
                    *entry += small * rate;
                }
            }
            black_box(state);
        })
    };
    Candidate { name, error, throughput: Box::new(throughput), latency: Box::new(latency) }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn table(title: &str, mut candidates: Vec<Candidate>) {
    let mut times = vec![[Vec::new(), Vec::new()]; candidates.len()];
    for _ in 0..ROUNDS {
        for (candidate, times) in candidates.iter_mut().zip(&mut times) {
            times[0].push((candidate.throughput)());
            times[1].push((candidate.latency)());
        }
    }
    println!("\n{title:<34} throughput  ratio   latency  ratio   differs by");
    for (candidate, own) in candidates.iter().zip(&times) {
        let ratio = |k: usize| median(own[k].iter().zip(&times[0][k]).map(|(a, b)| a / b).collect());
        let [throughput, latency] = own.clone().map(median);
        println!(
            "  {:<32} {throughput:>10.2} {:>6.2} {latency:>9.2} {:>6.2} {:>12.1e}",
            candidate.name,
            ratio(0),
            ratio(1),
            candidate.error
        );
    }
}

fn main() {
    println!("built for fused multiply-add: {}", cfg!(target_feature = "fma"));
    let part = |i: usize| i as f64 / COUNT as f64;
    let arguments: Vec<f64> = (0..COUNT).map(|i| 20.0 * (part(i) * 37.0).fract() - 10.0).collect();
    table(
        "sin_cos, arguments to 10",
        vec![
            sines::<f64>("f64", &arguments),
            sines::<Libm>("libm", &arguments),
            sines::<Std>("Std", &arguments),
            sines::<Approx13>("Approx13", &arguments),
            sines::<Approx7>("Approx7", &arguments),
            sines::<f32>("f32", &arguments),
        ],
    );
    // Evenly spaced arguments repeat a short pattern of quadrants; drawn ones are the worst case for branches.
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        20.0 * ((state >> 11) as f64 / (1_u64 << 53) as f64) - 10.0
    };
    let drawn: Vec<f64> = (0..COUNT).map(|_| draw()).collect();
    for (title, arguments) in [("evenly spaced", &arguments), ("drawn", &drawn)] {
        table(
            &format!("one sine, {title}, to 10"),
            vec![
                alone("platform (std)", f64::sin, Real::sin, arguments),
                alone("f64", Real::sin, Real::sin, arguments),
                alone("f64, of the pair", |x| Real::sin_cos(x).0, Real::sin, arguments),
            ],
        );
        table(
            &format!("one cosine, {title}, to 10"),
            vec![
                alone("platform (std)", f64::cos, Real::cos, arguments),
                alone("f64", Real::cos, Real::cos, arguments),
                alone("f64, of the pair", |x| Real::sin_cos(x).1, Real::cos, arguments),
            ],
        );
    }
    let states: Vec<[f64; 9]> = (0..COUNT)
        .map(|i| {
            [0.5 + part(i), 6.0 * part(i), 1.0, 0.0, 0.0, 0.8, part(i) - 0.4, 3.0 - part(i), 0.9 + part(i)]
        })
        .collect();
    table(
        "the hoop's right-hand side",
        vec![
            derived::<f64>("f64", &states),
            by_hand("f64, by hand", &states),
            derived::<Libm>("libm", &states),
            derived::<Std>("Std", &states),
            derived::<Approx13>("Approx13", &states),
            derived::<Approx7>("Approx7", &states),
            derived::<Fused>("Fused", &states),
            derived::<Fused<Approx7>>("Fused<Approx7>", &states),
            derived::<f32>("f32", &states),
        ],
    );
}
