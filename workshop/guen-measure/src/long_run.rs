//! Digits71 runs: how the error of the energy grows with the number of steps, against the square-root law of rounding.
//!
//! ```text
//! cargo run --release -p guen-measure --bin long_run                # 10^6 steps of 32 motions, 10^7 of four of them
//! cargo run --release -p guen-measure --bin long_run -- --quick     # 10^5 steps of 8 motions, 10^6 of two
//! cargo run --release -p guen-measure --bin long_run -- --full      # 10^7 steps of all 32
//! ```
//!
//! The paper's hoop from 32 initial states, on all processors. The energy is evaluated with 71 digits from the states in
//! `f64`, so that what is shown is the error of the states. Where the error of the method is below rounding, each step adds a
//! rounding error of random sign, and the sum of `n` of them grows like the square root of `n` (D. Brouwer, *On the
//! accumulation of errors in numerical integration*, Astronomical Journal 46, 1937); a method whose errors have a preferred
//! sign grows like `n`. Prints a table and the exponent of the growth, draws `target/guen/long-run.svg`, and ends with a
//! nonzero status where a compensated method exceeds its bounds.

use std::error::Error;
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use guen::prelude::*;
use guen::steppers::Method;
use guen_study::{Plot, Progress};

use guen_study::Digits71;

#[path = "../../../examples/common/folder.rs"]
mod folder;

guen_benchmarks::hoop!(guen::mechanical_system; provide taylor, carried;);

fn prepared<R: Real>() -> Result<hoop::Prepared<R>, guen::ConstantsError> {
    let ratio = R::from_ratio;
    Hoop { a: ratio(1, 1), A: ratio(1, 2), C: ratio(1, 1), g: ratio(981, 100) }.prepare()
}

/// The energy of a state with 71 digits.
fn energy(exact: &hoop::Prepared<Digits71>, state: &[f64]) -> Digits71 {
    let state: [Digits71; 9] = std::array::from_fn(|i| Digits71::from_f64(state[i]));
    exact.energy(Digits71::zero(), &state.into())
}

/// `|h - h_0|/|h_0|`
fn error(exact: &hoop::Prepared<Digits71>, before: Digits71, state: &[f64]) -> f64 {
    ((energy(exact, state) - before).abs() / before.abs()).to_f64()
}

/// A hoop that turns fast enough not to fall; the `k`-th of a fixed sequence of numbers (additive recurrence of Weyl).
fn start(k: usize) -> hoop::State {
    let draw = |irrational: f64| (0.5 + irrational * (k + 1) as f64).fract() - 0.5;
    let theta = 1.2 + 0.4 * draw(0.754_877_666_246_692_7);
    hoop::State {
        theta,
        psi: 6.0 * draw(0.569_840_290_998_053_3),
        zeta: theta.sin(),
        eta1: 0.6 * draw(0.618_033_988_749_895),
        eta2: 0.4 + draw(0.414_213_562_373_095),
        eta3: 5.0 + 2.0 * draw(0.732_050_807_568_877_3),
        ..Default::default()
    }
}

/// How long the runs are.
#[derive(Clone, Copy)]
struct Size {
    motions: usize,
    steps: u64,
    /// The first motions go on for longer.
    long_motions: usize,
    long_steps: u64,
}

/// Runs a motion for a number of steps: errors of the energy at the marks, or why it stopped.
type Run = Box<dyn Fn(usize, u64, &AtomicU64) -> Result<Vec<f64>, String> + Sync>;

/// A method on trial.
struct Candidate {
    name: &'static str,
    /// Its steps are so much dearer that it makes fewer: the number is divided by this.
    fewer: u64,
    run: Run,
}

/// Half decades: 1000, 3162, 10000, ..
fn marks(steps: u64) -> Vec<u64> {
    let all = (6..).map(|k| 10.0_f64.powf(0.5 * f64::from(k)).round() as u64);
    all.take_while(|mark| *mark <= steps).collect()
}

fn candidate<S, M, const N: usize>(
    name: &'static str,
    fewer: u64,
    system: S,
    lifted: impl Fn(hoop::State) -> [f64; N] + Sync + 'static,
    method: M,
) -> Result<Candidate, Box<dyn Error>>
where
    S: System<f64, N> + Sync + 'static,
    M: Method<f64, S, N> + Sync + 'static,
{
    /// Beyond every run: the number of steps ends it.
    const NEVER: f64 = 1e9;
    /// Steps between two reports to whoever shows progress.
    const REPORT: u64 = 1 << 12;

    let exact = prepared::<Digits71>()?;
    let run = move |motion: usize, steps: u64, done: &AtomicU64| {
        let begin = lifted(start(motion));
        let before = energy(&exact, &begin);
        let marks = marks(steps);
        let mut errors = Vec::with_capacity(marks.len());
        let mut count = 0;
        let mut observer = |_: f64, state: &[f64; N]| {
            count += 1;
            if count % REPORT == 0 {
                done.fetch_add(REPORT, Ordering::Relaxed);
            }
            if marks.get(errors.len()) == Some(&count) {
                errors.push(error(&exact, before, state));
            }
            if errors.len() == marks.len() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let integration = Integration::new(&system, 0.0, &begin).observe(&mut observer);
        integration.run(&method, NEVER).map_err(|error| error.to_string())?;
        done.fetch_add(steps % REPORT, Ordering::Relaxed);
        Ok(errors)
    };
    Ok(Candidate { name, fewer, run: Box::new(run) })
}

/// The methods, with steps at which their own errors are below rounding (except those of Gauss's method).
fn candidates() -> Result<Vec<Candidate>, Box<dyn Error>> {
    let system = prepared::<f64>()?;
    let carried = system.carried()?;
    let whole = |state: hoop::State| -> [f64; 9] { state.into() };
    let lifted = move |state: hoop::State| -> [f64; 13] { state.carried(&carried, 0.0).into() };
    // Truncation is far below rounding here. What compensation leaves grows like n from 10^6 steps on, and like the step: the
    // coefficients of the method are rounded too, and always to the same side.
    let step = 0.002;
    Ok(vec![
        candidate("RK8", 1, system, whole, Rk8::new(step))?,
        candidate("RK8 compensated", 1, system, whole, Rk8::new(step).compensated())?,
        candidate("RK8 compensated, carried", 1, carried, lifted, Rk8::new(step).compensated())?,
        candidate("DOP853, 1e-14", 1, system, whole, Dop853::new(1e-14, 1e-14).with_max_steps(u64::MAX))?,
        candidate("Taylor, 1e-19", 1, system, whole, Taylor::new(1e-19, 1e-19).with_max_steps(u64::MAX))?,
        candidate("Gauss 6", 100, system, whole, Gauss6::new(step))?,
    ])
}

/// Runs all motions with a candidate on all processors; the errors of each motion.
fn runs(candidate: &Candidate, size: Size) -> Result<Vec<Vec<f64>>, String> {
    let steps = |motion: usize| {
        let steps = if motion < size.long_motions { size.long_steps } else { size.steps };
        steps / candidate.fewer
    };
    let total: u64 = (0..size.motions).map(steps).sum();
    let (done, next, over) = (AtomicU64::new(0), AtomicUsize::new(0), AtomicBool::new(false));
    let results = Mutex::new(vec![Ok(Vec::new()); size.motions]);
    thread::scope(|scope| {
        scope.spawn(|| {
            let mut progress = Progress::new(0.0, total as f64);
            while !over.load(Ordering::Relaxed) {
                progress.at(done.load(Ordering::Relaxed) as f64);
                thread::sleep(Duration::from_millis(50));
            }
        });
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let workers: Vec<_> = (0..threads)
            .map(|_| {
                scope.spawn(|| {
                    loop {
                        let motion = next.fetch_add(1, Ordering::Relaxed);
                        if motion >= size.motions {
                            break;
                        }
                        let result = (candidate.run)(motion, steps(motion), &done);
                        if let Ok(mut results) = results.lock() {
                            results[motion] = result;
                        }
                    }
                })
            })
            .collect();
        for worker in workers {
            let _ = worker.join();
        }
        over.store(true, Ordering::Relaxed);
    });
    let results = results.into_inner().map_err(|error| error.to_string())?;
    results.into_iter().collect()
}

/// At each mark: root of the mean square, the largest, and of how many motions.
fn statistics(errors: &[Vec<f64>]) -> Vec<(f64, f64, usize)> {
    let longest = errors.iter().map(Vec::len).max().unwrap_or(0);
    let at = |k: usize| errors.iter().filter_map(move |errors| errors.get(k)).copied();
    (0..longest)
        .map(|k| {
            let count = at(k).count();
            let mean = at(k).map(|e| e * e).sum::<f64>() / count as f64;
            (mean.sqrt(), at(k).fold(0.0, f64::max), count)
        })
        .collect()
}

/// The slope of the logarithms by least squares, over marks at which every motion is, if there are two.
fn exponent(marks: &[u64], statistics: &[(f64, f64, usize)], motions: usize) -> Option<f64> {
    let whole = marks.iter().zip(statistics).filter(|(_, (rms, _, count))| *count == motions && *rms > 0.0);
    let points: Vec<(f64, f64)> = whole.map(|(n, (rms, ..))| ((*n as f64).ln(), rms.ln())).collect();
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let product: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let square: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    (points.len() > 1).then(|| product / square)
}

/// The largest relative error of the energy at any step until `t = span`, by Taylor series.
fn ten_thousand_seconds(span: f64) -> Result<f64, Box<dyn Error>> {
    let (system, exact) = (prepared::<f64>()?, prepared::<Digits71>()?);
    let begin: [f64; 9] = start(0).into();
    let before = energy(&exact, &begin);
    let mut worst = 0.0_f64;
    let mut observer = |_: f64, state: &[f64; 9]| {
        worst = worst.max(error(&exact, before, state));
        ControlFlow::Continue(())
    };
    let method = Taylor::new(1e-19, 1e-19).with_max_steps(u64::MAX);
    Integration::new(&system, 0.0, &begin).observe(&mut observer).run(&method, span)?;
    Ok(worst)
}

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let is = |name: &str| arguments.iter().any(|argument| argument == name);
    let size = match arguments.first().map(String::as_str) {
        None => Size { motions: 32, steps: 1_000_000, long_motions: 4, long_steps: 10_000_000 },
        Some("--quick") => Size { motions: 8, steps: 100_000, long_motions: 2, long_steps: 1_000_000 },
        Some("--full") => Size { motions: 32, steps: 10_000_000, long_motions: 0, long_steps: 0 },
        Some(other) => {
            if !is("--help") {
                eprintln!("unknown argument `{other}`");
            }
            println!(
                "long_run [--quick | --full | --help]\n\n  --quick  10^5 steps of 8 motions, 10^6 of two of them"
            );
            println!("  --full   10^7 steps of all 32 motions, instead of 10^6 and 10^7 of four");
            return Ok(if is("--help") { ExitCode::SUCCESS } else { ExitCode::FAILURE });
        }
    };
    println!(
        "The hoop from {} initial states: relative error of the energy, evaluated with 71 digits.",
        size.motions
    );
    println!(
        "Root of the mean square, and in brackets the largest; marked with * where fewer motions went on.\n"
    );
    let mut plot = Plot::new("Error of the energy over the number of steps")
        .size(900, 560)
        .axes("log10 of the number of steps", "log10 of the relative error");
    let marks = marks(size.steps.max(size.long_steps));
    print!("{:<26}", "method");
    marks.iter().step_by(2).for_each(|mark| print!("{:>20}", format!("{:.0e} steps", *mark as f64)));
    println!("{:>10}{:>9}", "growth", "s");
    let mut failures = Vec::new();
    for candidate in candidates()? {
        let began = Instant::now();
        let errors = runs(&candidate, size)?;
        let seconds = began.elapsed().as_secs_f64();
        let statistics = statistics(&errors);
        print!("{:<26}", candidate.name);
        for (k, _) in marks.iter().enumerate().step_by(2) {
            let cell = statistics.get(k).map_or_else(String::new, |(rms, largest, count)| {
                let star = if *count < size.motions { "*" } else { "" };
                format!("{rms:.1e} ({largest:.1e}){star}")
            });
            print!("{cell:>20}");
        }
        let growth = exponent(&marks, &statistics, size.motions);
        let growth = growth.map_or_else(|| "-".to_owned(), |growth| format!("{growth:.2}"));
        println!("{growth:>10}{seconds:>9.1}");
        let points = marks.iter().zip(&statistics).map(|(n, (rms, ..))| ((*n as f64).log10(), rms.log10()));
        plot = plot.line(candidate.name, points.collect::<Vec<_>>());
        if candidate.name.contains("compensated") {
            for (n, (rms, ..)) in marks.iter().zip(&statistics) {
                // Half a rounding a step, and that of the state as it is.
                let law = f64::EPSILON * (1.0 + 0.1 * (*n as f64).sqrt());
                if *rms > law {
                    failures.push(format!("{}: {rms:e} after {n} steps, {law:e} is allowed", candidate.name));
                }
            }
        }
    }
    let law = |n: f64| (n.log10(), (f64::EPSILON / 4.0 * n.sqrt()).log10());
    plot = plot.line("square-root law", [law(1e3), law(*marks.last().unwrap_or(&1000) as f64)]);
    let picture = folder::folder("long-run.svg");
    plot.save(&picture)?;
    println!("\n{}", picture.display());
    let span = if is("--quick") { 1e3 } else { 1e4 };
    let worst = ten_thousand_seconds(span)?;
    println!("Taylor over {span} s, the largest error of the energy at any step: {worst:.1e}");
    if worst > 2e-15 {
        failures.push(format!("Taylor: {worst:e} over {span} s, 2e-15 is allowed"));
    }
    failures.iter().for_each(|failure| eprintln!("{failure}"));
    Ok(if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
