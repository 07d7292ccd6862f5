//! Studies of systems whose motion is known in closed form, with clocks that tell what they are told.

#![cfg(feature = "study")]

mod budget;
#[path = "../files/cells.rs"]
mod cells;
mod forecasts;
mod kicks;
mod spreadsheet;
mod systems;
mod uncertain_errors;

use std::cell::Cell;
use std::rc::Rc;
use std::sync::LazyLock;
use std::time::Duration;

use guen_runtime::steppers::{Dop853, Rk4, Rk8};
use guen_runtime::{Equations, Invariants, Real, from_fn, generic};
use guen_study::{
    Cost, Digits71, Ending, FailureKind, NoChoice, Row, Settings, Stopwatch, Study, StudyReport, Trade, Unit,
};

use cells::cells;
use systems::{Planar, Scalar};

/// `x' = v`, `v' = -4 x`: `x = x0 cos 2t + v0/2 sin 2t`.
struct Oscillator;

impl Equations<2> for Oscillator {
    fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, -R::from_ratio(4, 1) * x]
    }
}

const START: [f64; 2] = [0.75, 1.0];
const SPAN: std::ops::Range<f64> = 0.0..3.0;

fn exact(t: f64) -> [Digits71; 2] {
    let angle = Digits71::from_f64(2.0 * t);
    let (sin, cos) = angle.sin_cos();
    let [x, half] = [0.75, 0.5].map(Digits71::from_f64);
    let two = Digits71::from_ratio(2, 1);
    [x * cos + half * sin, two * (half * cos - x * sin)]
}

fn oscillator() -> Study<guen_runtime::Generic<Planar>, 2> {
    Study::new(generic(Planar::Oscillator), START, SPAN)
        .unwrap()
        .title("oscillator")
        .count_evaluations()
        .scan(1 << 12)
        // Each has two references in 71 digits.
        .probes(3, 0.2)
}

fn plain(method: &str, real: &str) -> bool {
    real == "f64" && ["RK4", "DOP853", "Tsit5", "Radau 5"].contains(&method)
}

/// What a whole study of the oscillator by these methods says.
fn report() -> &'static StudyReport {
    static REPORT: LazyLock<StudyReport> = LazyLock::new(|| oscillator().keep(plain).run().report);
    &REPORT
}

#[test]
fn reported_errors_are_the_true_ones() {
    let report = report();
    assert_eq!(report.ending, Ending::Complete);
    let reference = report.reference.as_ref().unwrap();
    assert!(reference.error.unwrap() < 1e-15, "{reference:?}");
    let truth = exact(SPAN.end);
    let mut compared = 0;
    for row in report.rows.iter().filter(|row| row.method == "RK4" && row.failure.is_none()) {
        let method = Rk4::new(row.setting);
        let go_on = |_, _: &[f64; 2]| std::ops::ControlFlow::Continue(());
        let end = method.integrate(&generic(Planar::Oscillator), 0.0, &START, SPAN.end, go_on).unwrap().state;
        let off = |i: usize| {
            (Digits71::from_f64(end[i]) - truth[i]).abs().to_f64() / truth[i].to_f64().abs().max(1.0)
        };
        let expected = f64::max(off(0), off(1));
        let error = row.error.unwrap();
        assert!(
            (error - expected).abs() <= 1e-12 * expected + 1e-18,
            "{}: {error:e} {expected:e}",
            row.name()
        );
        compared += 1;
    }
    assert!(compared > 8, "{compared}");
    // Evaluations are what RK4 takes: four a step.
    let row = report.rows.iter().find(|row| row.method == "RK4").unwrap();
    assert_eq!(row.evaluations, 4.0 * (SPAN.end / row.setting).round());
    assert_eq!(
        row.cost,
        Some(Cost { median: row.evaluations, low: row.evaluations, high: row.evaluations, repetitions: 1 })
    );
}

#[test]
fn every_measure_of_error() {
    let small = |study: Study<_, 2>| study.keep(|method, real| method == "RK8" && real == "f64").run();
    let largest = |trade: &Trade<2>| trade.report.rows.iter().filter_map(|row| row.error).fold(0.0, f64::max);
    let least =
        |trade: &Trade<2>| trade.report.rows.iter().filter_map(|row| row.error).fold(f64::INFINITY, f64::min);
    let end = small(oscillator());
    let trajectory = small(oscillator().trajectory(7));
    assert!(largest(&trajectory) >= largest(&end) && least(&trajectory) < 1e-12);
    let output = small(oscillator().output("x v", 7, |_, &[x, v]| x * v));
    assert!(output.report.measure.contains("x v") && least(&output) < 1e-12);
    // An entry that is left out.
    let scaled = small(oscillator().scales([f64::INFINITY, 1e-3]));
    let unscaled = small(oscillator().scales([f64::INFINITY, 1.0]));
    let ratio = largest(&unscaled) / scaled.report.rows[0].error.unwrap();
    assert!(ratio > 0.0 && least(&scaled) < 1e-9);
    for (a, b) in unscaled.report.rows.iter().zip(&scaled.report.rows).filter(|(a, _)| a.error.is_some()) {
        if a.setting == b.setting && a.failure.is_none() && b.failure.is_none() {
            assert!((a.error.unwrap() * 1e3 / b.error.unwrap() - 1.0).abs() < 1e-9);
        }
    }
}

/// Makes [`Turning`] over every real.
struct Told;

impl guen_runtime::WithScalar<2> for Told {
    type Over<R: Real> = Turning;
    fn with_scalar<R: Real>(&self) -> Result<Turning, guen_runtime::ConstantsError> {
        Ok(Turning)
    }
}

/// `x' = v`, `v' = -x` with `x^2 + v^2` as energy and, less one, as constraint.
#[derive(Clone, Copy)]
struct Turning;

impl<R: Real> guen_runtime::System<R, 2> for Turning {
    fn rhs(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, -x]
    }

    fn guarded(&self) -> impl guen_runtime::Guarded<R, 2> {
        self
    }
}

impl<R: Real> guen_runtime::Guarded<R, 2> for Turning {
    fn conserved(&self, _t: R, &[x, v]: &[R; 2]) -> Invariants<R> {
        let energy = x * x + v * v;
        Invariants {
            energy: Some(energy),
            scale: energy,
            residual: energy - R::one(),
            ..Invariants::default()
        }
    }
}

impl<R: Real> guen_runtime::Differentiable<R, 2> for Turning {
    fn jacobian(&self, _t: R, _x: &[R; 2]) -> [[R; 2]; 2] {
        [[R::zero(), R::one()], [-R::one(), R::zero()]]
    }
    fn along(&self, t: R, _x: &[R; 2], _dt: R, dx: &[R; 2]) -> [R; 2] {
        guen_runtime::System::rhs(self, t, dx)
    }
}

#[test]
fn energy_and_constraints_need_no_reference() {
    let study = || {
        Study::new(Told, [1.0, 0.0], 0.0..6.0)
            .unwrap()
            .count_evaluations()
            .keep(|method, real| method == "RK4" && real == "f64")
    };
    for trade in [study().energy(1).run(), study().residual(1).run()] {
        assert_eq!(trade.report.reference, None);
        for row in trade.report.rows.iter().filter(|row| row.failure.is_none()) {
            // |1 + z + z^2/2 + z^3/6 + z^4/24|^2 = 1 - h^6/72 + h^8/576 for z = i h: RK4's amplification.
            let n = (6.0 / row.setting).round();
            let change = (1.0 - row.setting.powi(6) / 72.0 + row.setting.powi(8) / 576.0).powf(n) - 1.0;
            let error = row.error.unwrap();
            assert!((error - change.abs()).abs() < 1e-8 * change.abs() + 1e-13, "{error:e} {change:e}");
        }
        assert!(trade.report.fastest_within(1e-6).is_ok());
    }
}

#[test]
fn a_wrong_reference_is_noticed() {
    // A reference of low order, checked by another one: the stated error is the difference, and settings that are better
    // are marked and not taken for what they seem.
    let step = |n: i64| Digits71::from_ratio(3, n);
    let study = oscillator().keep(|method, real| method == "DOP853" && real == "f64").probes(0, 0.0);
    let trade = study.reference_by(["RK4", "RK8"], Rk4::new(step(100)), Rk8::new(step(100))).unwrap().run();
    let reference = trade.report.reference.as_ref().unwrap();
    let stated = reference.error.unwrap();
    assert!(stated > 1e-8, "{stated:e}");
    let best = trade.report.rows.last().unwrap();
    assert!(best.limited && best.error.unwrap() > 0.5 * stated);
    assert!(trade.report.to_string().contains("of the size of the reference's own error"));
    // A good reference marks nothing that errs more than it.
    let good = oscillator().keep(|method, real| method == "RK4" && real == "f64").probes(0, 0.0).run();
    assert!(good.report.rows.iter().all(|row| !row.limited));
}

#[test]
fn a_reference_that_cannot_be_had_leaves_the_rest() {
    let trade = Study::new(generic(Scalar::Pole), [1.0], 0.0..2.0)
        .unwrap()
        .count_evaluations()
        .keep(|method, real| method == "DOP853" && real == "f64")
        // Few steps: where no error tells that one is short enough, the study's own go on to the limit of evaluations.
        .with_method("RK8", Settings::List(guen_study::Knob::Step, vec![0.1, 0.01, 0.001]), Rk8::new, |_| {
            String::new()
        })
        .unwrap()
        .run();
    let reference = trade.report.reference.as_ref().unwrap();
    assert!(reference.error.is_none() && reference.failure.as_ref().unwrap().contains("singularity"));
    assert!(trade.report.rows.iter().all(|row| row.error.is_none()));
    let failed: Vec<&Row> = trade.report.rows.iter().filter(|row| row.failure.is_some()).collect();
    assert!(!failed.is_empty() && failed.iter().all(|row| row.failure.as_ref().unwrap().time < Some(1.5)));
    assert!(matches!(trade.report.fastest_within(1.0), Err(NoChoice::NoReference)));
    assert!(trade.report.table().contains("failed"));
}

/// A span of zero, or numbers that are none: nothing is tried, and nothing recommended.
#[test]
fn a_study_without_a_motion_says_so() {
    let nan = f64::NAN;
    let all = [
        ([1.0, 0.0], 0.0..0.0, [0.0, 1.0]),
        ([1.0, 0.0], 0.0..nan, [0.0, 1.0]),
        ([1.0, 0.0], f64::INFINITY..0.0, [0.0, 1.0]),
        ([nan, 0.0], 0.0..1.0, [0.0, 1.0]),
        ([1.0, 0.0], 0.0..1.0, [0.0, nan]),
    ];
    for (start, span, other) in all {
        for energy in [false, true] {
            let study = Study::new(generic(Planar::Oscillator), start, span.clone()).unwrap().starts([other]);
            let study = study.count_evaluations().scan(1 << 12);
            let trade = if energy { study.energy(3).run() } else { study.run() };
            assert!(trade.report.rows.is_empty());
            let none = trade.report.fastest_within(1e-3).unwrap_err();
            assert!(matches!(none, NoChoice::NoMotion), "{none}");
            assert_eq!(trade.report.most_accurate_within(1e9).unwrap_err(), none);
            assert!(none.to_string().contains("span") && trade.report.to_string().contains("not finite"));
        }
    }
}

/// No energy, and sizes that are none: nothing is measured. All the time that there is is enough.
#[test]
fn a_study_that_has_nothing_to_measure_says_so() {
    let study = || {
        let study = Study::new(generic(Planar::Oscillator), [1.0, 0.0], 0.0..1.0).unwrap();
        study
            .count_evaluations()
            .scan(1 << 10)
            .keep(|method, real| method == "RK4" && real == "f64")
            .probes(0, 0.0)
    };
    let none = |trade: guen_study::Trade<2>| {
        assert!(trade.report.rows.is_empty());
        let none = trade.report.fastest_within(1e-3).unwrap_err();
        assert!(trade.report.to_string().contains(&none.to_string()), "{none}");
        none
    };
    assert_eq!(none(study().energy(3).run()), NoChoice::NoEnergy);
    for scales in [[0.0, 1.0], [1.0, -1.0], [f64::NAN, 1.0]] {
        assert_eq!(none(study().scales(scales).run()), NoChoice::NoScales);
    }
    let trade = study().scales([1.0, f64::INFINITY]).within(std::time::Duration::MAX).run();
    assert!(trade.report.fastest_within(1e-3).is_ok());
}

/// A clock that tells each row's own time, with noise that is the same in every study.
struct Told64 {
    seconds: fn(usize) -> f64,
    noise: f64,
    draws: u64,
}

impl Stopwatch for Told64 {
    fn seconds(&mut self, row: usize, work: &mut dyn FnMut()) -> f64 {
        work();
        self.draws = self.draws.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let random = (self.draws >> 33) as f64 / (1_u64 << 31) as f64;
        (self.seconds)(row) * (1.0 + self.noise * random)
    }
}

fn two_settings(noise: f64) -> Trade<2> {
    Study::new(generic(Planar::Oscillator), START, SPAN)
        .unwrap()
        .keep(|_, _| false)
        .probes(0, 0.0)
        .with_method("RK8", Settings::List(guen_study::Knob::Step, vec![0.2, 0.1]), Rk8::new, |step| {
            format!("Rk8::new({step})")
        })
        .unwrap()
        // The second setting takes 30 percent longer.
        .stopwatch(Told64 { seconds: |row| [1.0, 1.3][row], noise, draws: 1 })
        .run()
}

#[test]
fn a_noisy_machine_ranks_nothing_and_a_quiet_one_does() {
    let quiet = two_settings(0.002).report;
    let costs = |report: &StudyReport| [0, 1].map(|k: usize| report.rows[k].cost.unwrap());
    let [first, second] = costs(&quiet);
    assert!(!first.ties_with(&second), "{first:?} {second:?}");
    assert!(first.repetitions >= 5);
    let noisy = two_settings(2.0).report;
    let [first, second] = costs(&noisy);
    assert!(first.ties_with(&second), "{first:?} {second:?}");
    assert!(noisy.noise > 20.0 * quiet.noise && noisy.noise > 0.05);
    let choice = noisy.fastest_within(1e-3).unwrap();
    assert_eq!(choice.ties.len(), 1);
    assert!(choice.to_string().contains("too noisy"));
    // The finer setting is on the front because it errs less; who is quicker is not known.
    assert_eq!(noisy.ties_on_front(), (1, 1));
    assert!(noisy.to_string().contains("too noisy to rank 1 of 1"));
}

#[test]
fn a_cancelled_study_keeps_what_it_has() {
    for limit in [0.31, 0.45, 0.9] {
        let trade = oscillator().keep(plain).stop_when(move |part| part > limit).run();
        assert_eq!(trade.report.ending, Ending::Cancelled);
        assert!(trade.report.to_string().contains("cancelled"));
        if limit > 0.4 {
            assert!(!trade.report.rows.is_empty() && trade.report.rows[0].error.is_some());
        }
        if limit > 0.8 {
            assert!(trade.report.fastest_within(1e-3).is_ok());
        }
    }
    // From the very beginning: nothing, and said so.
    let trade = oscillator().keep(plain).stop_when(|_| true).run();
    assert!(trade.report.rows.is_empty());
    assert!(trade.report.reference.as_ref().unwrap().failure.as_ref().unwrap().contains("cancelled"));
    assert_eq!(trade.report.fastest_within(1.0), Err(NoChoice::NothingMeasured));
}

#[test]
fn time_runs_out_before_the_work_does() {
    let trade = Study::new(generic(Planar::Oscillator), START, 0.0..1e6)
        .unwrap()
        .keep(plain)
        .within(Duration::from_millis(60))
        .run();
    assert_eq!(trade.report.ending, Ending::OutOfTime);
    assert!(trade.report.seconds < 20.0);
    assert!(trade.report.rows.iter().all(|row| row.measured().is_none()));
}

#[test]
fn choices_by_error_and_by_cost() {
    let report = report();
    let front = report.front();
    assert!(front.len() > 4);
    for asked in [1e-2, 1e-5, 1e-8, 1e-11] {
        let choice = report.fastest_within(asked).unwrap();
        assert!(choice.row.error.unwrap() <= asked && choice.asked == asked);
        let cost = choice.row.cost.unwrap().median;
        for row in &report.rows {
            let Some((error, other)) = row.measured() else { continue };
            let robust = row.nearby.is_some_and(|nearby| nearby.is_within(2.0 * asked));
            assert!(error > asked || !robust || other.median >= cost, "{}", row.name());
        }
        let within = report.most_accurate_within(cost).unwrap();
        assert!(within.row.error <= choice.row.error && within.row.cost.unwrap().high <= cost);
    }
    assert!(matches!(report.fastest_within(1e-30), Err(NoChoice::NotThatAccurate { .. })));
    assert!(matches!(report.most_accurate_within(3.0), Err(NoChoice::NotThatCheap { .. })));
}

#[test]
fn levers_of_ones_own() {
    let closures = Study::of_closures(
        |_t: f64, &[x, v]: &[f64; 2]| [v, -4.0 * x],
        |_t: Digits71, &[x, v]: &[Digits71; 2]| [v, -Digits71::from_ratio(4, 1) * x],
        START,
        SPAN,
    );
    let trade =
        closures.keep(|method, _| method == "RK8").count_evaluations().scan(1 << 12).probes(3, 0.2).run();
    assert!(trade.report.fastest_within(1e-10).is_ok());

    // A form with another state: twice the oscillator.
    let doubled = from_fn(|_t: f64, &[x, v, y]: &[f64; 3]| [v, -4.0 * x, v + y - y]);
    let trade = oscillator()
        .keep(|_, _| false)
        .with_form("doubled", doubled, |&[x, v]| [x, v, x], |&[_, v, y]| [y, v])
        .with_method(
            "own",
            Settings::List(guen_study::Knob::Tolerance, vec![1e-6]),
            |t| Dop853::new(t, t),
            |_| "own".to_owned(),
        )
        .unwrap()
        .run();
    assert!(trade.report.rows.iter().any(|row| row.name() == "DOP853, doubled, tol = 1e-6"));
    assert!(trade.report.rows.iter().all(|row| row.failure.is_none()));
    assert!(trade.report.rows.iter().any(|row| row.method == "own" && row.code == "own"));
}

#[test]
fn many_starts_take_the_worst() {
    let one = oscillator().keep(plain).probes(0, 0.0).run();
    let many = oscillator().starts([[0.0, 0.1], [10.0, -30.0]]).keep(plain).probes(0, 0.0).run();
    assert_eq!(many.report.starts, 3);
    for (a, b) in one.report.rows.iter().zip(&many.report.rows).filter(|(a, b)| a.setting == b.setting) {
        if let (Some(a), Some(b)) = (a.error, b.error) {
            assert!(b >= a);
        }
    }
}

#[test]
fn progress_goes_forwards_to_the_end() {
    let last = Rc::new(Cell::new(0.0));
    let seen = Rc::clone(&last);
    let trade = oscillator()
        .keep(plain)
        .stop_when(move |part| {
            assert!(part >= seen.get() - 1e-12 && part <= 1.0, "{part} after {}", seen.get());
            seen.set(part);
            false
        })
        .run();
    assert_eq!(trade.report.unit, Unit::Evaluations);
    assert!(last.get() > 0.9);
}

#[test]
fn csv_says_what_the_rows_say() {
    let report = report();
    let csv = report.to_csv();
    let mut lines = csv.lines();
    let head = cells(lines.next().unwrap());
    let column = |name: &str| head.iter().position(|cell| cell == name).unwrap();
    let front: Vec<String> = report.front().iter().map(|row| row.name()).collect();
    for (line, row) in lines.zip(&report.rows) {
        let cells = cells(line);
        assert_eq!(cells.len(), head.len());
        assert_eq!(cells[column("method")], row.method);
        assert_eq!(cells[column("setting")].parse(), Ok(row.setting));
        assert_eq!(cells[column("error")].parse().ok(), row.error);
        assert_eq!(cells[column("cost")].parse().ok(), row.cost.map(|cost| cost.median));
        assert_eq!(cells[column("evaluations")].parse(), Ok(row.evaluations));
        assert_eq!(cells[column("front")] == "true", front.contains(&row.name()));
        assert_eq!(cells[column("failure")].is_empty(), row.failure.is_none());
    }
    assert_eq!(csv.lines().count(), report.rows.len() + 1);
}

#[cfg(feature = "serde")]
#[test]
fn json_comes_back() {
    let report = report();
    let text = serde_json::to_string(report).unwrap();
    let back: StudyReport = serde_json::from_str(&text).unwrap();
    assert_eq!(&back, report);
}

#[test]
fn pictures_show_every_method_that_was_measured() {
    let report = report();
    let text = report.picture().to_svg().unwrap();
    for word in ["RK4", "Tsit5", "DOP853", "Radau 5", "not beaten", "evaluations", "10⁻⁶"] {
        assert!(text.contains(word), "{word}");
    }
    assert!(!report.picture_of_reals("RK4").to_svg().unwrap().contains("Tsit5"));
}

#[test]
fn constants_that_a_real_cannot_hold_are_rows() {
    // Refused in single precision: FailureKind::Constants is what the row says.
    struct Picky;
    impl guen_runtime::WithScalar<2> for Picky {
        type Over<R: Real> = guen_runtime::Generic<Planar>;
        fn with_scalar<R: Real>(&self) -> Result<Self::Over<R>, guen_runtime::ConstantsError> {
            if R::epsilon().to_f64() > 1e-10 {
                return Err(guen_runtime::ConstantsError::NotFinite { name: "m", value: f64::INFINITY });
            }
            Ok(generic(Planar::Oscillator))
        }
    }
    let keep = |method: &str, real: &str| real == "f32" || plain(method, real);
    let study = Study::new(Picky, START, SPAN).unwrap().count_evaluations().scan(1 << 12).probes(3, 0.2);
    let report = study.keep(keep).run().report;
    let failed: Vec<&Row> = report.rows.iter().filter(|row| row.real == "f32").collect();
    assert_eq!(failed.len(), 1);
    assert_eq!(failed[0].failure.as_ref().unwrap().kind, FailureKind::Constants);
    assert!(report.fastest_within(1e-6).is_ok());
}
