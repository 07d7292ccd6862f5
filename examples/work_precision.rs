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
use guen_study::significant;

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
        provide taylor;
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
    run: Box<dyn Fn() -> Option<Done<f64, 9>>>,
}

/// The settings of a method as rows, without their times.
fn rows<M>(
    method: &'static str,
    hoop: hoop::Prepared,
    reference: &Reference,
    settings: impl IntoIterator<Item = f64>,
    make: impl Fn(f64) -> M,
) -> Vec<Row>
where
    M: Method<f64, hoop::Prepared, 9> + 'static,
{
    let mut rows = Vec::new();
    for setting in settings {
        let (start, span, stepper) = (reference.start, reference.span, make(setting));
        let run = Box::new(move || Integration::new(&hoop, 0.0, &start).run(&stepper, span).ok());
        // A setting too coarse for the guards is no candidate.
        let Some(done) = run() else { continue };
        let error = (0..9).map(|i| (done.state[i] - reference.end[i]).abs()).fold(0.0, f64::max);
        let (evaluations, setting) = (done.statistics.evaluations, significant(setting, 3));
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
    for round in 0..ROUNDS {
        for (row, times) in rows.iter().zip(&mut times) {
            if round >= 5 && times[0] > LONG {
                continue;
            }
            let start = Instant::now();
            std::hint::black_box((row.run)());
            times.push(start.elapsed().as_secs_f64());
        }
    }
    for (row, mut times) in rows.iter_mut().zip(times) {
        times.sort_by(f64::total_cmp);
        row.microseconds = 1e6 * times[times.len() / 2];
    }
}

/// Accuracies to choose settings for.
const ACCURACIES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare()?;
    let reference = reference()?;
    let steps = |from: f64, to: f64| {
        let span = reference.span;
        (0..)
            .map(move |k| (from * 1.26_f64.powi(k)).round())
            .take_while(move |n| *n <= to)
            .map(move |n| span / n)
    };
    let tolerances = || (6..=30).map(|k| 10.0_f64.powf(-0.5 * f64::from(k)));
    let mut all = Vec::new();
    all.extend(rows("Euler", hoop, &reference, steps(1e4, 4e5), |step| Euler { step }));
    all.extend(rows("RK4", hoop, &reference, steps(100.0, 2e5), |step| Rk4 { step }));
    all.extend(rows("RK8", hoop, &reference, steps(20.0, 2e3), Rk8::new));
    all.extend(rows("Gauss 4", hoop, &reference, steps(100.0, 2e4), Gauss4::new));
    all.extend(rows("Gauss 6", hoop, &reference, steps(40.0, 6e3), Gauss6::new));
    all.extend(rows("Tsit5", hoop, &reference, tolerances(), |tolerance| Tsit5::new(tolerance, tolerance)));
    all.extend(rows("DOP853", hoop, &reference, tolerances(), |tolerance| Dop853::new(tolerance, tolerance)));
    all.extend(rows("Radau 5", hoop, &reference, tolerances(), |tolerance| {
        Radau5::new(tolerance, tolerance)
    }));
    all.extend(rows("Taylor", hoop, &reference, tolerances(), Taylor::new));
    time(&mut all);

    println!("The hoop over {} s: step or tolerance, and what it costs.\n", reference.span);
    if std::env::args().any(|argument| argument == "--all") {
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
        for method in ["Euler", "RK4", "RK8", "Gauss 4", "Gauss 6", "Tsit5", "DOP853", "Taylor", "Radau 5"] {
            let Some(row) = cheapest(method) else {
                if ["RK8", "Gauss 6", "DOP853", "Tsit5", "Taylor"].contains(&method) {
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
        println!();
    }
    for (method, accuracy) in &missed {
        eprintln!("{method} did not reach {accuracy:e}");
    }
    Ok(if missed.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
