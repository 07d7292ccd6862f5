//! Runs a study, stage by stage: scan, reference, errors, states nearby, times. A stage that ends early leaves what
//! it has, and the next ones work with that.

use std::rc::Rc;
use std::time::Duration;

use guen_runtime::Real;
use guen_runtime::steppers::Statistics;

use super::budget::{Budget, Stage};
use super::choice::least_certain;
use super::digits71::Digits71;
use super::known::Known;
use super::measure::{Measure, against, kept};
use super::probes::{self, Probe};
use super::reference::{
    CANCELLED, NO_ENERGY, NO_MOTION, NO_SCALES, Named, Problem, ReferenceReport, References,
};
use super::report::{Ending, StudyReport, Unit};
use super::row::{FailureKind, Nearby, Row};
use super::timing::{Cost, Deadline, Wall};
use super::trade::{Means, Trade};
use super::variant::{Run, Task, Variant};
use super::{Stop, Study, lengthened};

/// Settings that err more are not worth a row, unless all do: then the best of them is one.
const USELESS_ERROR: f64 = 0.5;
/// The number of settings in a row that gain less than a factor of two on the best so far, after which a variant is given up.
const STAGNATION: u32 = 6;
/// The error below which settings that gain little are counted, and the multiple of the cost of another setting, which errs no
/// more, above which a setting is hopeless.
const SETTLED: f64 = 1e-2;
const HOPELESS_COST: f64 = 60.0;
/// The seconds below which a run is repeated before it is judged.
const REPEATED_BELOW: f64 = 5e-3;
/// A study that counts evaluations has no clock to tell it when a setting takes too long.
const MOST_EVALUATIONS: f64 = 3e6;
/// The repetitions of a timing: of all rows, and of those near the front.
const REPETITIONS: usize = 5;
const FRONT_REPETITIONS: usize = 41;
/// Rows within this factor of the front in cost are timed often, and tried from states nearby.
const NEAR_FRONT: f64 = 2.5;

/// A row on its way.
struct Tried<const N: usize> {
    row: Row,
    run: Option<Rc<Run<N>>>,
    /// Seconds of one run from all starts, roughly; evaluations in a study that counts them.
    rough: f64,
}

pub(super) fn run<S, const N: usize>(mut study: Study<S, N>) -> Trade<N> {
    let stop = std::mem::replace(&mut study.stop, Box::new(|_| false) as Stop);
    let clock = std::mem::replace(&mut study.stopwatch, Box::new(Wall));
    let mut budget = Budget::new(study.budget, study.progress, stop, clock);
    let times = study.times();

    let fault = ill_posed(&study);
    let is_posed = fault.is_none();
    if !is_posed {
        study.variants.clear();
        study.probes = 0;
    }
    let known = if is_posed { known(&study, &times, &mut budget) } else { Known::nothing(study.points) };
    let (references, reference) = match fault {
        None => references(&mut study, &times, &known, &mut budget),
        Some(reason) => (Vec::new(), Some(ReferenceReport::of_nothing(reason))),
    };
    let mut tried = errors(&mut study, &times, &references, reference.as_ref(), &mut budget);
    let probes = nearby(&study, &times, &references, &known, &mut tried, &mut budget);
    costs(&mut study, &times, &mut tried, &mut budget);

    let mut report = StudyReport {
        title: study.title.clone(),
        measure: study.measure.text(),
        span: (study.t0, study.t1),
        starts: study.starts.len(),
        unit: study.unit,
        scan: (is_posed && reference.is_some()).then(|| known.report.clone()),
        reference,
        rows: Vec::new(),
        ending: Ending::Complete,
        probes,
        noise: 0.0,
        seconds: 0.0,
        conditions: conditions(),
    };

    let mut runs = Vec::new();
    for Tried { row, run, .. } in tried {
        report.rows.push(row);
        runs.push(run);
    }
    let mut noises: Vec<f64> = report.rows.iter().filter_map(|row| Some(row.cost?.noise())).collect();
    noises.sort_by(f64::total_cmp);
    report.noise = noises.get(noises.len() / 2).copied().unwrap_or(0.0);
    report.ending = match (budget.is_cancelled(), budget.is_late()) {
        (true, _) => Ending::Cancelled,
        (false, true) => Ending::OutOfTime,
        (false, false) => Ending::Complete,
    };
    report.seconds = budget.seconds();
    let means = Means {
        runs,
        samples: study.samples,
        measure: study.measure,
        scales: study.scales,
        tells: study.tells,
        tight: study.tight,
        scanner: study.scanner,
        // What happens at a time does so from every state.
        landings: known.landings(0).to_vec(),
        points: known.points_elsewhere,
        reference: study.elsewhere,
        check: study.check,
    };
    Trade { report, means }
}

/// The reason why there is nothing to measure.
fn ill_posed<S, const N: usize>(study: &Study<S, N>) -> Option<&'static str> {
    let mut numbers = [study.t0, study.t1].into_iter().chain(study.starts.iter().flatten().copied());
    if !numbers.all(f64::is_finite) || study.t0 == study.t1 {
        return Some(NO_MOTION);
    }
    // Infinity leaves an entry out.
    if study.scales.is_some_and(|scales| scales.iter().any(|scale| scale.is_nan() || *scale <= 0.0)) {
        return Some(NO_SCALES);
    }
    let has_energy =
        |start: &[f64; N]| (study.tells)(Digits71::from_f64(study.t0), &lengthened(start)).energy.is_some();
    let is_energy = matches!(study.measure, Measure::Energy);
    (is_energy && !study.starts.iter().all(has_energy)).then_some(NO_ENERGY)
}

/// Looks for what references might step over, where there are any.
fn known<S, const N: usize>(study: &Study<S, N>, times: &[f64], budget: &mut Budget) -> Known<N> {
    if !study.measure.needs_reference() {
        return Known::nothing(study.points);
    }
    Known::refine(&study.scanner, &study.starts, (study.t0, times), study.points, &mut |part| {
        budget.goes_on(Stage::Scan, part)
    })
}

/// The reference of every start, and what is to be said of it. Nothing where the measure needs none, and nothing where
/// one of them failed. Shorter reals take the place of long ones that take too long, from then on.
fn references<S, const N: usize>(
    study: &mut Study<S, N>,
    times: &[f64],
    known: &Known<N>,
    budget: &mut Budget,
) -> (Vec<Vec<[Digits71; N]>>, Option<ReferenceReport>) {
    if !study.measure.needs_reference() {
        return (Vec::new(), None);
    }
    let (found, said) = references_by(study, times, known, Stage::Reference, budget);
    let slow = said.failure.as_ref().is_some_and(|failure| failure.ends_with(CANCELLED));
    // States nearby take the time of the reference each, and half of that stage is for them.
    let each = said.seconds / 2.0 / study.starts.len().max(1) as f64;
    let nearby = 2.0 * each * study.probes as f64 > budget.share(Stage::Nearby).as_secs_f64();
    if budget.is_cancelled() || !(slow || nearby) {
        return (found, Some(said));
    }
    let Some(References { reference, check, elsewhere }) = study.shorter.take() else {
        budget.be_late(slow);
        return (found, Some(said));
    };
    study.elsewhere = elsewhere;
    if !slow {
        return (found, Some(said));
    }
    (study.reference, study.check) = (reference, Some(check));
    let (found, said) = references_by(study, times, known, Stage::Shorter, budget);
    (found, Some(said))
}

/// References by the methods of the study, within the time of a stage.
fn references_by<S, const N: usize>(
    study: &Study<S, N>,
    times: &[f64],
    known: &Known<N>,
    stage: Stage,
    budget: &mut Budget,
) -> (Vec<Vec<[Digits71; N]>>, ReferenceReport) {
    let begun = budget.seconds();
    let span = (study.t1 - study.t0).abs().max(f64::MIN_POSITIVE);
    let runs = 2.0 * study.starts.len() as f64;
    let compute = |named: &Named<N>, k: usize, before: usize, budget: &mut Budget| {
        let problem = Problem { start: &study.starts[k], t0: study.t0, times, landings: known.landings(k) };
        (named.source)(&problem, &mut |t| {
            let part = ((before + k) as f64 + (t - study.t0).abs() / span) / runs;
            budget.goes_on(stage, part)
        })
    };
    let mut said = ReferenceReport {
        method: study.reference.name.clone(),
        check: study.check.as_ref().map_or_else(String::new, |check| check.name.clone()),
        error: None,
        failure: None,
        seconds: 0.0,
    };
    let mut found = Vec::new();
    for k in 0..study.starts.len() {
        match compute(&study.reference, k, 0, budget) {
            Ok(states) => found.push(states),
            Err(failure) => {
                said.failure = Some(failure);
                said.seconds = budget.seconds() - begun;
                return (Vec::new(), said);
            }
        }
    }
    if let Some(check) = &study.check {
        let mut largest = 0.0_f64;
        for (k, reference) in found.iter().enumerate() {
            match compute(check, k, study.starts.len(), budget) {
                Ok(states) => {
                    let states = states.into_iter();
                    largest = largest.max(against(&study.measure, &study.scales, times, states, reference));
                }
                Err(failure) => {
                    said.failure = Some(format!("the check of the reference: {failure}"));
                    said.seconds = budget.seconds() - begun;
                    return (found, said);
                }
            }
        }
        // Both may have stepped over what the motion in doubles did not.
        let off = |states: &[[f64; N]], truth: &[[Digits71; N]]| {
            against(&study.measure, &study.scales, times, states.iter().map(lengthened), truth)
        };
        for (motion, reference) in known.motions.iter().zip(&found) {
            let fine: Vec<_> = motion.fine.iter().map(lengthened).collect();
            let found = motion.contradicts(off(&motion.fine, reference), off(&motion.coarse, &fine));
            largest = largest.max(found);
        }
        said.error = Some(largest);
    }
    said.seconds = budget.seconds() - begun;
    (found, said)
}

/// Runs every variant at its settings, from coarse to fine, until nothing is gained.
fn errors<S, const N: usize>(
    study: &mut Study<S, N>,
    times: &[f64],
    references: &[Vec<[Digits71; N]>],
    reference: Option<&ReferenceReport>,
    budget: &mut Budget,
) -> Vec<Tried<N>> {
    let variants = std::mem::take(&mut study.variants);
    // Without a reference errors cannot be had. Unchecked, they are shown as limited.
    let measurable = !study.measure.needs_reference() || !references.is_empty();
    let floor = reference.map_or(0.0, |reference| least_certain(reference.error));
    let share = budget.share(Stage::Accuracy);
    let patience = share.div_f64(4.0 * variants.len().max(1) as f64).max(Duration::from_millis(10));
    let count = variants.len() as f64;
    let mut all: Vec<Tried<N>> = Vec::new();
    let mut least: Option<Tried<N>> = None;
    for (k, variant) in variants.iter().enumerate() {
        if !budget.goes_on(Stage::Accuracy, k as f64 / count) {
            break;
        }
        let make = match &variant.make {
            Ok(make) => make,
            Err(failure) => {
                let row = Row { failure: Some(failure.clone()), ..blank(variant, f64::NAN) };
                all.push(Tried { row, run: None, rough: f64::NAN });
                continue;
            }
        };
        let mut best = f64::INFINITY;
        let (mut idle, mut hopeless) = (0, 0);
        let mut failed: Option<Tried<N>> = None;
        let mut shown = false;
        for setting in variant.settings.values(study.t1 - study.t0) {
            let run = make(setting);
            let begun = budget.seconds();
            let deadline = if study.unit == Unit::Seconds {
                budget.after(patience)
            } else {
                budget.deadline(Stage::Accuracy)
            };
            let task = Task { starts: &study.starts, t0: study.t0, times, deadline: Some(deadline) };
            let mut states = Vec::new();
            let outcome = run(&task, &mut states);
            let mut seconds = budget.seconds() - begun;
            if outcome.is_ok() && seconds < REPEATED_BELOW && study.unit == Unit::Seconds {
                // The first run may have found nothing where it is needed.
                let begun = budget.seconds();
                let _ = std::hint::black_box(run(&task, &mut Vec::new()));
                seconds = seconds.min(budget.seconds() - begun);
            }
            let mut row = blank(variant, setting);
            let statistics = match outcome {
                Ok(statistics) => statistics,
                Err(failure) => {
                    let over = failure.kind == FailureKind::OutOfTime;
                    row.failure = Some(failure);
                    failed = Some(Tried { row, run: None, rough: f64::NAN });
                    // Coarse settings fail; what takes too long takes longer when it is finer.
                    if over || shown {
                        break;
                    }
                    continue;
                }
            };
            let starts = study.starts.len() as f64;
            row.evaluations = statistics.evaluations as f64 / starts;
            row.jacobians = statistics.jacobians as f64 / starts;
            let work = evaluations(&statistics, N);
            let rough = if study.unit == Unit::Seconds { seconds } else { work };
            if !measurable {
                all.push(Tried { row, run: Some(Rc::new(run)), rough });
                shown = true;
                if work > MOST_EVALUATIONS * starts {
                    break;
                }
                continue;
            }
            let error = error_of(study, times, references, &states);
            if error.is_finite() {
                row.error = Some(error);
                row.limited = error < floor;
                if error <= USELESS_ERROR {
                    // The finest setting that failed is a row as well.
                    all.extend(failed.take());
                    all.push(Tried { row, run: Some(Rc::new(run)), rough });
                    shown = true;
                } else {
                    failed = None;
                    if least.as_ref().is_none_or(|least| least.row.error > row.error) {
                        least = Some(Tried { row, run: Some(Rc::new(run)), rough });
                    }
                }
            }
            idle = if best < SETTLED && error > 0.5 * best { idle + 1 } else { 0 };
            best = best.min(error);
            let beaten = all.iter().any(|other| {
                other.row.error.is_some_and(|e| e <= error) && HOPELESS_COST * other.rough < rough
            });
            hopeless = if beaten { hopeless + 1 } else { 0 };
            let too_many = work > MOST_EVALUATIONS * starts;
            if idle >= STAGNATION || hopeless >= 3 || too_many {
                break;
            }
        }
        all.extend(failed);
    }
    if all.iter().all(|one| one.row.error.is_none()) {
        all.extend(least);
    }
    budget.goes_on(Stage::Accuracy, 1.0);
    all
}

fn blank<const N: usize>(variant: &Variant<N>, setting: f64) -> Row {
    Row {
        method: variant.method.clone(),
        real: variant.real.clone(),
        form: variant.form.clone(),
        knob: variant.settings.knob(),
        setting,
        error: None,
        limited: false,
        nearby: None,
        evaluations: 0.0,
        jacobians: 0.0,
        cost: None,
        failure: None,
        code: (variant.code)(setting),
    }
}

/// The work in right-hand sides.
fn evaluations(statistics: &Statistics, variables: usize) -> f64 {
    statistics.evaluations as f64 + variables as f64 * statistics.jacobians as f64
}

fn error_of<S, const N: usize>(
    study: &Study<S, N>,
    times: &[f64],
    references: &[Vec<[Digits71; N]>],
    states: &[[f64; N]],
) -> f64 {
    let mut largest = 0.0_f64;
    for (k, start) in study.starts.iter().enumerate() {
        let own = &states[k * times.len()..(k + 1) * times.len()];
        largest = largest.max(match references.get(k) {
            Some(reference) => {
                against(&study.measure, &study.scales, times, own.iter().map(lengthened), reference)
            }
            None => kept(&study.measure, &study.tells, (study.t0, start), times, own),
        });
    }
    largest
}

/// Returns the distance of each row from the front in rough cost: the factor to the cheapest row that errs no more.
fn distances<const N: usize>(tried: &[Tried<N>]) -> Vec<f64> {
    let distance = |one: &Tried<N>| {
        let Some(error) = one.row.error else { return f64::INFINITY };
        let cheaper = tried.iter().filter(|other| other.row.error.is_some_and(|e| e <= error));
        one.rough / cheaper.map(|other| other.rough).fold(one.rough, f64::min)
    };
    tried.iter().map(distance).collect()
}

/// Times all rows in turn, those near the front more often; or takes the evaluations.
fn costs<S, const N: usize>(
    study: &mut Study<S, N>,
    times: &[f64],
    tried: &mut [Tried<N>],
    budget: &mut Budget,
) {
    let starts = study.starts.len() as f64;
    if study.unit == Unit::Evaluations {
        for one in tried.iter_mut().filter(|one| one.run.is_some()) {
            one.row.cost = Some(Cost::exact(one.rough / starts));
        }
        budget.goes_on(Stage::Timing, 1.0);
        return;
    }
    let distances = distances(tried);
    let mut seconds: Vec<Vec<f64>> = tried.iter().map(|_| Vec::new()).collect();
    let task = Task { starts: &study.starts, t0: study.t0, times, deadline: None };
    let mut states = Vec::new();
    'rounds: for round in 0..FRONT_REPETITIONS {
        for place in 0..tried.len() {
            // Back and forth, so that what drifts favours nobody.
            let k = if round % 2 == 0 { place } else { tried.len() - 1 - place };
            let Some(run) = &tried[k].run else { continue };
            if round >= REPETITIONS && distances[k] > NEAR_FRONT {
                continue;
            }
            let part = (round as f64 + place as f64 / tried.len() as f64) / FRONT_REPETITIONS as f64;
            if !budget.goes_on(Stage::Timing, part) {
                break 'rounds;
            }
            let taken = budget.clock.seconds(k, &mut || {
                states.clear();
                let _ = std::hint::black_box(run(&task, &mut states));
            });
            seconds[k].push(taken / starts);
        }
    }
    for (one, mut seconds) in tried.iter_mut().zip(seconds) {
        one.row.cost = Cost::of(&mut seconds);
        if let Some(cost) = one.row.cost {
            one.rough = cost.median;
        }
    }
}

/// Tries the rows near the front from states nearby, and returns the number of those.
fn nearby<S, const N: usize>(
    study: &Study<S, N>,
    times: &[f64],
    references: &[Vec<[Digits71; N]>],
    known: &Known<N>,
    tried: &mut [Tried<N>],
    budget: &mut Budget,
) -> usize {
    let measurable = !study.measure.needs_reference() || !references.is_empty();
    if study.probes == 0 || !measurable || study.starts.is_empty() {
        return 0;
    }
    let along = along(study, budget.deadline(Stage::Nearby));
    let states = probes::states(&study.starts, &along, study.t0, &study.tells, (study.probes, study.spread));
    // References take their time; half of the stage is for trying.
    let now = budget.clock.now();
    let halfway = now + budget.deadline(Stage::Nearby).at.saturating_sub(now) / 2;
    let mut computed = 0.0;
    let probes = probes::with_references(
        states,
        &study.measure,
        (study.t0, times),
        &study.elsewhere.source,
        (&study.scanner, known.landings(0), known.points_elsewhere, known.report.width.is_some()),
        &mut || {
            computed += 1e-5;
            budget.goes_on(Stage::Nearby, f64::min(computed, 0.5)) && budget.clock.now() < halfway
        },
    );
    let distances = distances(tried);
    // Those on the front first: should the time not suffice for all, the best choices are known.
    let mut near: Vec<usize> = (0..tried.len()).filter(|k| distances[*k] <= NEAR_FRONT).collect();
    near.sort_by(|a, b| distances[*a].total_cmp(&distances[*b]));
    for (done, &k) in near.iter().enumerate() {
        if !budget.goes_on(Stage::Nearby, 0.5 + 0.5 * done as f64 / near.len() as f64) {
            break;
        }
        let Some(run) = &tried[k].run else { continue };
        let worst = probes.iter().map(|probe| try_at(study, run, probe, times)).reduce(Nearby::worse);
        tried[k].row.nearby = worst;
    }
    probes.len()
}

fn try_at<S, const N: usize>(study: &Study<S, N>, run: &Run<N>, probe: &Probe<N>, times: &[f64]) -> Nearby {
    let task = Task { starts: &[probe.start], t0: study.t0, times, deadline: None };
    let mut states = Vec::new();
    if run(&task, &mut states).is_err() {
        return Nearby::Failed;
    }
    let at = (study.t0, times);
    let error = probes::error_of(probe, &states, &study.measure, &study.scales, &study.tells, at);
    if error.is_finite() { Nearby::Error(error) } else { Nearby::Failed }
}

/// States of the motions themselves, by the tight method in doubles.
fn along<S, const N: usize>(study: &Study<S, N>, deadline: Deadline<'_>) -> Vec<[f64; N]> {
    const COUNT: usize = 16;
    let times = super::sample_times(study.t0, study.t1, COUNT);
    let task = Task { starts: &study.starts, t0: study.t0, times: &times, deadline: Some(deadline) };
    let mut states = Vec::new();
    // Of a run that fails, what it reached serves as well.
    let _ = (study.tight)(1e-12)(&task, &mut states);
    states
}

/// Returns the conditions that the figures depend on.
fn conditions() -> String {
    let threads = std::thread::available_parallelism().map_or(0, usize::from);
    let build = if cfg!(debug_assertions) { "a build with debug assertions" } else { "a release build" };
    let target = std::env::consts::ARCH;
    format!("on {target} with {threads} threads, {build}")
}
