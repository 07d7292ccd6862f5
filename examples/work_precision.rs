//! What an accuracy costs with each method: the paper's hoop over ten seconds, against a reference of 25 digits.
//!
//! ```text
//! cargo run --release --example work_precision
//! RUSTFLAGS="-C target-cpu=native" cargo run --release --example work_precision
//! cargo run --release --example work_precision -- --all     # every setting that was tried
//! ```
//!
//! The error is the largest difference between the end state and the reference, in any entry. Times are medians of
//! repeated runs; methods are interleaved, so that they can be compared, but another machine has other figures. Ends with
//! a nonzero status if some method does not reach an accuracy that it should.

use std::error::Error;
use std::process::ExitCode;
use std::time::Instant;

use guen::mechanical_system;
use guen::prelude::*;
use guen::steppers::Method;
use guen_study::{Progress, significant};

#[path = "common/arguments.rs"]
mod arguments;

mechanical_system! {
    /// A hoop of radius `a` that rolls without slipping on a horizontal plane.
    pub system Hoop {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = dot(psi)*cos(theta) + dot(phi);
        }
        constraints {
            eta4: dot(xi)   = a*sin(theta)*sin(psi)*dot(theta) - a*cos(theta)*cos(psi)*dot(psi) - a*cos(psi)*dot(phi);
            eta5: dot(eta)  + a*sin(theta)*cos(psi)*dot(theta) + a*cos(theta)*sin(psi)*dot(psi) + a*sin(psi)*dot(phi) = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*(dot(xi)^2 + dot(eta)^2 + dot(zeta)^2) + 1/2*(A*eta1^2 + A*eta2^2 + C*eta3^2);
        force_function = -a*g*sin(theta);
        // Taylor series, and a form without sines, which are states of their own.
        provide taylor, carried;
    }
}

/// The motion at the beginning, and the reference at its end.
struct Reference {
    start: [f64; 9],
    span: f64,
    end: [f64; 9],
}

/// Reads `tests/data/01_hoop_rolling.json`, whose first case has the constants of `main`.
fn reference() -> Result<Reference, Box<dyn Error>> {
    let file: serde_json::Value = serde_json::from_str(include_str!("../tests/data/01_hoop_rolling.json"))?;
    let case = &file["cases"][0];
    let number = |value: &serde_json::Value| -> Result<f64, Box<dyn Error>> {
        Ok(value.as_str().ok_or("a number as text")?.parse()?)
    };
    let state = |value: &serde_json::Value| -> Result<[f64; 9], Box<dyn Error>> {
        let entries = value.as_array().ok_or("a state as a list")?;
        let numbers = entries.iter().map(number).collect::<Result<Vec<f64>, _>>()?;
        numbers.try_into().map_err(|_| "nine entries".into())
    };
    let times = case["times"].as_array().ok_or("times")?;
    let states = case["states"].as_array().ok_or("states")?;
    let at = times.iter().position(|time| time == "10").ok_or("the time 10")?;
    Ok(Reference { start: state(&states[0])?, span: number(&times[at])?, end: state(&states[at])? })
}

/// One setting of one method.
struct Row {
    method: &'static str,
    setting: String,
    evaluations: u64,
    error: f64,
    microseconds: f64,
    run: Box<dyn Fn() -> bool>,
}

/// The settings of a method as rows, without their times, for a form of the hoop and its state at the beginning.
fn rows<S, M, const N: usize>(
    method: &'static str,
    (form, start): (S, [f64; N]),
    reference: &Reference,
    settings: impl IntoIterator<Item = f64>,
    make: impl Fn(f64) -> M,
) -> Vec<Row>
where
    S: System<f64, N> + Copy + 'static,
    M: Method<f64, S, N> + Copy + 'static,
{
    let mut rows = Vec::new();
    for setting in settings {
        let (span, stepper) = (reference.span, make(setting));
        let run = move || Integration::new(&form, 0.0, &start).run(&stepper, span).ok();
        // A setting too coarse for the guards is no candidate.
        let Some(done) = run() else { continue };
        let error = (0..9).map(|i| (done.state[i] - reference.end[i]).abs()).fold(0.0, f64::max);
        let (evaluations, setting) = (done.statistics.evaluations, significant(setting, 3));
        let run = Box::new(move || std::hint::black_box(run()).is_some());
        rows.push(Row { method, setting, evaluations, error, microseconds: f64::INFINITY, run });
    }
    rows
}

/// Fills in the times: all rows in turn, the median of each.
fn time(rows: &mut [Row]) {
    const ROUNDS: usize = 21;
    /// Rows that take longer than this are timed fewer times.
    const LONG: f64 = 5e-3;

    let mut times: Vec<Vec<f64>> = rows.iter().map(|_| Vec::new()).collect();
    let mut progress = Progress::new(0.0, ROUNDS as f64);
    for round in 0..ROUNDS {
        progress.at(round as f64);
        for (row, times) in rows.iter().zip(&mut times) {
            if round >= 5 && times[0] > LONG {
                continue;
            }
            let start = Instant::now();
            std::hint::black_box((row.run)());
            times.push(start.elapsed().as_secs_f64());
        }
    }
    progress.finish();
    for (row, mut times) in rows.iter_mut().zip(times) {
        times.sort_by(f64::total_cmp);
        row.microseconds = 1e6 * times[times.len() / 2];
    }
}

/// What is compared, in the order of the tables.
const METHODS: [&str; 12] = [
    "Euler", "RK4", "RK4'", "RK8", "RK8'", "Gauss 4", "Gauss 6", "Tsit5", "DOP853", "DOP853'", "Taylor",
    "Radau 5",
];

/// Accuracies to choose settings for.
const ACCURACIES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let about = "What an accuracy costs with each method: the paper's hoop over ten seconds.";
    let all = |word: &str| (word == "--all").then_some(true);
    let every = match arguments::read(about, "--all", "print every setting that was tried", false, all) {
        Ok(every) => every,
        Err(status) => return Ok(status),
    };
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare()?;
    let reference = reference()?;
    let (form, state) = (hoop.carried()?, hoop::State::from(reference.start));
    let (whole, carried) = ((hoop, reference.start), (form, state.carried(&form, 0.0).into()));
    let span = reference.span;
    let by = |factor: f64| {
        move |from: f64, to: f64| {
            let counts = (0..).map(move |k| (from * factor.powi(k)).round());
            counts.take_while(move |n| *n <= to).map(move |n| span / n)
        }
    };
    // With order 8 a step that is 26 percent too short is a fifth of the accuracy in vain.
    let (steps, finer) = (by(1.26), by(1.08));
    let tolerances = || (6..=30).map(|k| 10.0_f64.powf(-0.5 * f64::from(k)));
    let mut all = Vec::new();
    all.extend(rows("Euler", whole, &reference, steps(1e4, 4e5), |step| Euler { step }));
    all.extend(rows("RK4", whole, &reference, steps(100.0, 2e5), |step| Rk4 { step }));
    all.extend(rows("RK8", whole, &reference, finer(20.0, 2e3), Rk8::new));
    all.extend(rows("Gauss 4", whole, &reference, steps(100.0, 2e4), Gauss4::new));
    all.extend(rows("Gauss 6", whole, &reference, steps(40.0, 6e3), Gauss6::new));
    all.extend(rows("Tsit5", whole, &reference, tolerances(), |tolerance| Tsit5::new(tolerance, tolerance)));
    all.extend(rows("DOP853", whole, &reference, tolerances(), |tolerance| {
        Dop853::new(tolerance, tolerance)
    }));
    all.extend(rows("Radau 5", whole, &reference, tolerances(), |tolerance| {
        Radau5::new(tolerance, tolerance)
    }));
    all.extend(rows("RK4'", carried, &reference, steps(100.0, 2e5), |step| Rk4 { step }));
    all.extend(rows("RK8'", carried, &reference, finer(20.0, 2e3), Rk8::new));
    all.extend(rows("DOP853'", carried, &reference, tolerances(), |tolerance| {
        Dop853::new(tolerance, tolerance)
    }));
    all.extend(rows("Taylor", whole, &reference, tolerances(), Taylor::new));
    time(&mut all);

    println!(
        "The hoop over {} s: step or tolerance, and what it costs. With an apostrophe: the carried form.\n",
        reference.span
    );
    if every {
        println!("{:<8} {:>10} {:>11} {:>11} {:>9}", "method", "setting", "evaluations", "us", "error");
        for row in &all {
            let Row { method, setting, evaluations, microseconds, error, .. } = row;
            println!("{method:<8} {setting:>10} {evaluations:>11} {microseconds:>11.1} {error:>9.1e}");
        }
        println!();
    }
    let mut missed = Vec::new();
    for accuracy in ACCURACIES {
        println!("error at most {accuracy:e}");
        println!(
            "{:<8} {:>10} {:>11} {:>9} {:>9} {:>10}",
            "method", "setting", "evaluations", "us", "error", "of DOP853"
        );
        let cheapest = |method: &str| {
            let candidates = all.iter().filter(|row| row.method == method && row.error <= accuracy);
            candidates.min_by(|a, b| a.microseconds.total_cmp(&b.microseconds))
        };
        let base = cheapest("DOP853").map_or(f64::NAN, |row| row.microseconds);
        for method in METHODS {
            let Some(row) = cheapest(method) else {
                if ["RK8", "RK8'", "Gauss 6", "DOP853", "DOP853'", "Tsit5", "Taylor"].contains(&method) {
                    missed.push((method, accuracy));
                }
                continue;
            };
            let Row { setting, evaluations, microseconds, error, .. } = row;
            let ratio = microseconds / base;
            println!(
                "{method:<8} {setting:>10} {evaluations:>11} {microseconds:>9.1} {error:>9.1e} {ratio:>10.2}"
            );
        }
        for method in ["RK4", "RK8", "DOP853"] {
            let carried = format!("{method}'");
            if let (Some(plain), Some(carried)) = (cheapest(method), cheapest(&carried)) {
                let ratio = carried.microseconds / plain.microseconds;
                println!("carried, of the time of {method} as it is: {ratio:.2}");
            }
        }
        let fastest = METHODS.into_iter().filter_map(cheapest);
        let fastest = fastest.min_by(|a, b| a.microseconds.total_cmp(&b.microseconds));
        if let (Some(fastest), Some(plain)) = (fastest, cheapest("RK4")) {
            let ratio = fastest.microseconds / plain.microseconds;
            println!("the fastest, {}, of RK4's time: {ratio:.2}", fastest.method);
        }
        println!();
    }
    for (method, accuracy) in &missed {
        eprintln!("{method} did not reach {accuracy:e}");
    }
    Ok(if missed.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
