//! Speed for accuracy on the three systems of the paper: every method over every real, measured on this machine.
//!
//! ```text
//! cargo run --release -p guen-measure --bin tradeoff                        # about a minute and a half
//! cargo run --release -p guen-measure --bin tradeoff -- --system hoop --quick
//! cargo run --release -p guen-measure --bin tradeoff -- --help
//! ```
//!
//! Prints what is worth choosing, choices for given errors and times with the code to write, and whether a choice keeps
//! its promise from twenty other states. Leaves pictures, CSV and JSON in `target/guen/tradeoff`.

use std::error::Error;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use guen::mechanical_system;
use guen_study::{Study, StudyReport, Trade, Unit};

#[path = "../../../examples/common/folder.rs"]
mod folder;

guen_benchmarks::hoop!(guen::mechanical_system; provide taylor, carried;);
guen_benchmarks::sled!(guen::mechanical_system; provide taylor, carried;);

mechanical_system! {
    /// The system of Appell's Mécanique rationnelle, no. 469.
    pub system Appell {
        constants   { a > 0, A > 0, C > 0, g = 9.81 }
        coordinates { theta, psi, phi, xi, eta, zeta }
        parameters {
            eta1 = dot(theta);
            eta2 = dot(psi)*sin(theta);
            eta3 = dot(psi)*cos(theta) + dot(phi);
        }
        constraints {
            eta4: dot(xi)   + a*sin(theta)*dot(theta) = 0;
            eta5: dot(eta)  = 0;
            eta6: dot(zeta) - a*cos(theta)*dot(theta) = 0;
        }
        kinetic_energy = 1/2*((A + a^2)*eta1^2 + A*eta2^2 + (C + a^2)*eta3^2);
        force_function = -a*g*sin(theta);
        provide taylor, carried;
    }
}

const HELP: &str = "\
Speed for accuracy on the systems of the paper, measured on this machine.

usage: tradeoff [--system hoop|appell|sled] [--quick] [--all] [--evaluations] [--states NUMBER] [--out FOLDER]

  --system NAME   one system only
  --quick         two seconds of motion in place of ten, and ten seconds of work for a system, for a first look
  --all           print every setting, not only those that no other one beats
  --evaluations   count evaluations in place of taking times, with 15 minutes for a system: the same on busy machines
  --states NUMBER from so many initial states at once, for which there are lanes
  --out FOLDER    where pictures, CSV and JSON go, in place of target/guen/tradeoff

Ends with 0; with 1 if a reference or a choice is missing, a promise was broken, or more than two states of twenty were \
not promised, each of which is said at the end; with 2 if it was called wrongly.";

/// What the command line says.
struct Arguments {
    system: Option<String>,
    quick: bool,
    all: bool,
    evaluations: bool,
    states: usize,
    out: PathBuf,
}

/// None if help was asked for.
fn arguments() -> Result<Option<Arguments>, String> {
    let mut found = Arguments {
        system: None,
        quick: false,
        all: false,
        evaluations: false,
        states: 1,
        out: folder::folder("tradeoff"),
    };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        match word.as_str() {
            "--help" | "-h" => return Ok(None),
            "--quick" => found.quick = true,
            "--all" => found.all = true,
            "--evaluations" => found.evaluations = true,
            "--system" => match words.next() {
                Some(name) if ["hoop", "appell", "sled"].contains(&name.as_str()) => {
                    found.system = Some(name)
                }
                Some(name) => return Err(format!("no system `{name}`: there are hoop, appell and sled")),
                None => return Err("`--system` needs a name".to_owned()),
            },
            "--states" => {
                let number = words.next().and_then(|word| word.parse().ok()).filter(|number| *number > 0);
                found.states = number.ok_or("`--states` needs a number, one at least")?;
            }
            "--out" => found.out = words.next().ok_or("`--out` needs a folder")?.into(),
            other => return Err(format!("no argument `{other}`")),
        }
    }
    Ok(Some(found))
}

/// The errors that choices are made for, and the time that the most accurate choice is to fit into.
const ERRORS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];
const PERIOD: f64 = 20e-6;
/// From where to where, in seconds.
const SPAN: Range<f64> = 0.0..10.0;
const SHORT: Range<f64> = 0.0..2.0;
/// The error of the trial, the number of its states, how far they are away, and how often a choice may say that it will
/// not hold.
const TRIED: f64 = 1e-6;
const STATES: usize = 20;
/// How far the other initial states are from the first, where several are asked for.
const NEIGHBOURS: f64 = 0.1;
const AWAY: f64 = 0.4;
const EXCUSES: usize = 2;

/// Studies one system, and says what is not in order.
fn study<S, const N: usize>(
    arguments: &Arguments,
    name: &str,
    study: Study<S, N>,
    start: [f64; N],
    span: Range<f64>,
) -> Result<Vec<String>, Box<dyn Error>> {
    let seconds = match (arguments.evaluations, arguments.quick) {
        // What is counted does not depend on the machine, so there is more time than it takes on a busy one.
        (true, _) => 900,
        (false, true) => 10,
        (false, false) => 25,
    };
    let mut study = study
        .title(format!("{name}, {} s", span.end - span.start))
        .within(Duration::from_secs(seconds))
        .starts(Trade::around(&start, arguments.states - 1, NEIGHBOURS, 1618))
        .show_progress();
    if arguments.evaluations {
        study = study.count_evaluations();
    }
    let trade = study.run();
    let report = &trade.report;
    println!("{report}\n");
    if arguments.all {
        println!("{}", report.table());
    }
    let mut faults = Vec::new();
    match &report.reference {
        Some(reference) if reference.error.is_some() => {}
        Some(reference) => {
            let reason = reference.failure.as_deref().unwrap_or("it was not checked");
            faults.push(format!("no reference: {reason}"));
        }
        None => faults.push("no reference".to_owned()),
    }
    faults.extend(choices(report));
    faults.extend(promise(&trade, &start, span));
    save(report, &arguments.out.join(name))?;
    Ok(faults.into_iter().map(|fault| format!("{name}: {fault}")).collect())
}

/// Prints choices; says which are missing that should be there.
fn choices(report: &StudyReport) -> Vec<String> {
    let mut missing = Vec::new();
    for error in ERRORS {
        match report.fastest_within(error) {
            Ok(choice) => println!("right to {error:e}: {choice}"),
            Err(none) => {
                println!("right to {error:e}: {none}");
                if error >= 1e-9 {
                    missing.push(format!("no choice for {error:e}: {none}"));
                }
            }
        }
    }
    if report.unit == Unit::Seconds {
        match report.most_accurate_within(PERIOD) {
            Ok(choice) => println!("in {} us: {choice}", 1e6 * PERIOD),
            Err(none) => println!("in {} us: {none}", 1e6 * PERIOD),
        }
        // RK4 in doubles is what people begin with.
        let plain = report.rows.iter().filter(|row| row.variant() == "RK4" && !row.limited);
        let cheap = plain.filter_map(|row| row.measured()).filter(|(error, _)| *error <= ERRORS[0]);
        let rk4 = cheap.map(|(_, cost)| cost.median).min_by(f64::total_cmp);
        let best = report.fastest_within(ERRORS[0]).ok().and_then(|choice| choice.row.cost);
        if let (Some(rk4), Some(best)) = (rk4, best) {
            let coarse = report.rows.iter().filter(|row| !row.limited).filter_map(|row| row.measured());
            let coarse = coarse.filter(|(error, _)| *error <= ERRORS[0]);
            let least = coarse.map(|(_, cost)| cost.median).fold(f64::INFINITY, f64::min);
            println!(
                "the choice for 1e-3 takes {:.2} of the time of RK4, the fastest setting from this state {:.2}",
                best.median / rk4,
                least / rk4,
            );
        }
    }
    if let Ok(choice) = report.fastest_within(TRIED) {
        println!("\nthe code for {TRIED:e}:\n\n{}", choice.row.code);
    }
    missing
}

/// Tries the choice for 1e-6, if there is one, from twenty other states; says what is not as promised.
fn promise<const N: usize>(trade: &Trade<N>, start: &[f64; N], span: Range<f64>) -> Vec<String> {
    let Ok(choice) = trade.report.fastest_within(TRIED) else { return Vec::new() };
    let states = Trade::around(start, STATES, AWAY, 2718);
    let tried = trade.trial(choice.index, choice.asked, states, span);
    let excused = tried.iter().filter(|one| !one.forecast.holds()).count();
    let broken = tried.iter().filter(|one| !one.kept).count();
    let worst = tried.iter().filter(|one| one.forecast.holds()).map(|one| one.error).fold(0.0, f64::max);
    println!(
        "{}, chosen for {TRIED:e}, from {} other states: {} promised, worst error of those {worst:.1e}; \
         {excused} not promised; {broken} broken\n",
        choice.row.name(),
        tried.len(),
        tried.len() - excused,
    );
    let mut faults = Vec::new();
    if broken > 0 {
        faults.push(format!("{broken} of {} promises broken", tried.len() - excused));
    }
    // A study that had no time for states nearby could not know better.
    if excused > EXCUSES && trade.report.probes > 0 {
        faults.push(format!("{excused} of {} states not promised, {EXCUSES} are allowed", tried.len()));
    }
    faults
}

fn save(report: &StudyReport, folder: &Path) -> Result<(), Box<dyn Error>> {
    report.save_csv(folder.join("rows.csv"))?;
    report.save_picture(folder.join("methods.svg"))?;
    let best = report.fastest_within(TRIED).map_or("RK8", |choice| &choice.row.method);
    report.picture_of_reals(best).save(folder.join("reals.svg"))?;
    report.save_json(folder.join("report.json"))?;
    println!("pictures and tables in {}\n", folder.display());
    Ok(())
}

/// Studies what was asked for, and says what is not in order.
fn run(arguments: &Arguments) -> Result<Vec<String>, Box<dyn Error>> {
    let span = if arguments.quick { SHORT } else { SPAN };
    let wanted = |name: &str| arguments.system.as_deref().is_none_or(|system| system == name);
    let mut faults = Vec::new();
    if wanted("hoop") {
        let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 };
        let start = hoop::State {
            theta: 1.1,
            psi: 0.3,
            phi: -0.2,
            zeta: 1.1_f64.sin(),
            eta1: 0.4,
            eta2: 0.9,
            eta3: 2.5,
            ..Default::default()
        };
        let form = hoop.prepare()?.carried()?;
        let trade = Study::new(hoop, start, span.clone())?.with_taylor()?.with_form(
            "carried",
            form,
            move |x| hoop::State::from(*x).carried(&form, 0.0).into(),
            |y| hoop::State::from(hoop::carried::State::from(*y)).into(),
        );
        let trade = if arguments.states > 1 { trade.with_lanes()? } else { trade };
        faults.extend(study(arguments, "hoop", trade, start.into(), span.clone())?);
    }
    if wanted("appell") {
        let appell = Appell { a: 1.0, A: 0.5, C: 1.0, g: 9.81 };
        let start = appell::State {
            theta: 1.0,
            xi: f64::cos(1.0),
            zeta: f64::sin(1.0),
            eta2: 2.0,
            eta3: 3.0,
            ..Default::default()
        };
        let form = appell.prepare()?.carried()?;
        let trade = Study::new(appell, start, span.clone())?.with_taylor()?.with_form(
            "carried",
            form,
            move |x| appell::State::from(*x).carried(&form, 0.0).into(),
            |y| appell::State::from(appell::carried::State::from(*y)).into(),
        );
        let trade = if arguments.states > 1 { trade.with_lanes()? } else { trade };
        faults.extend(study(arguments, "appell", trade, start.into(), span.clone())?);
    }
    if wanted("sled") {
        let sled = Sled { m: 1.0, alpha: 0.2, beta: 0.1, k: 0.5, incline: 0.1, g: 9.81 };
        let start = sled::State { phi: 0.3, eta1: 1.5, eta2: 0.5, ..Default::default() };
        let form = sled.prepare()?.carried()?;
        let trade = Study::new(sled, start, span.clone())?.with_taylor()?.with_form(
            "carried",
            form,
            move |x| sled::State::from(*x).carried(&form, 0.0).into(),
            |y| sled::State::from(sled::carried::State::from(*y)).into(),
        );
        let trade = if arguments.states > 1 { trade.with_lanes()? } else { trade };
        faults.extend(study(arguments, "sled", trade, start.into(), span.clone())?);
    }
    Ok(faults)
}

fn main() -> ExitCode {
    let arguments = match arguments() {
        Ok(Some(arguments)) => arguments,
        Ok(None) => {
            println!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(fault) => {
            eprintln!("{fault}\n\n{HELP}");
            return ExitCode::from(2);
        }
    };
    match run(&arguments) {
        Ok(faults) if faults.is_empty() => ExitCode::SUCCESS,
        Ok(faults) => {
            faults.iter().for_each(|fault| eprintln!("{fault}"));
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
