//! Errors that are not certain lead to no choice and to no promise, on any way there is to one.

use guen_runtime::steppers::{Dop853, Rk4, Rk8};
use guen_runtime::{Equations, Real, from_fn, generic};
use guen_study::{Caveat, Digits71, Forecast, Knob, NoChoice, Settings, Study, StudyReport};

use crate::systems::{Planar, Scalar};

/// `x'' = -x`.
pub struct Spring;

impl Equations<2> for Spring {
    fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, -x]
    }
}

const START: [f64; 2] = [1.0, 0.0];

fn explicit(method: &str, real: &str) -> bool {
    real == "f64" && ["RK4", "DOP853"].contains(&method)
}

fn spring() -> Study<guen_runtime::Generic<Planar>, 2> {
    Study::new(generic(Planar::Spring), START, 0.0..50.0)
        .unwrap()
        .count_evaluations()
        .scan(1 << 12)
        .keep(explicit)
        .probes(0, 0.0)
}

/// References that are far from the truth, and from each other.
fn disagreeing() -> Study<guen_runtime::Generic<Planar>, 2> {
    let step = |n| Digits71::from_ratio(n, 2);
    spring().reference_by(["RK4", "RK8"], Rk4::new(step(2)), Rk8::new(step(5))).unwrap()
}

/// Of a report in which nothing is certain: no choice, whatever is asked for, and the reason in words.
fn nothing_is_chosen(report: &StudyReport, word: &str) {
    for asked in [1e-12, 1e-9, 1e-6, 1e-3, 1e-1] {
        let none = report.fastest_within(asked).unwrap_err();
        assert!(none.to_string().contains(word), "{asked:e}: {none}");
    }
    for cost in [1e3, 1e5, f64::INFINITY] {
        assert!(report.most_accurate_within(cost).unwrap_err().to_string().contains(word), "{cost:e}");
    }
}

#[test]
fn references_that_disagree_lead_to_no_choice() {
    let trade = disagreeing().run();
    let report = &trade.report;
    let difference = report.reference.as_ref().unwrap().error.unwrap();
    assert!(difference > 0.1, "{difference:e}");
    nothing_is_chosen(report, "differ by");
    assert!(matches!(report.fastest_within(1e-6), Err(NoChoice::ReferencesDisagree { .. })));
    for (index, row) in report.rows.iter().enumerate().filter(|(_, row)| row.limited) {
        let forecast = trade.forecast(index, 1e-6, &START, 0.0..50.0);
        assert!(matches!(forecast, Forecast::Refused(_)), "{}: {forecast:?}", row.name());
    }
    let tried = trade.trial(report.rows.len() - 1, 1e-6, [[0.5, 0.0]], 0.0..50.0);
    assert!(tried.iter().all(|one| matches!(one.forecast, Forecast::Refused(_))));
}

#[test]
fn a_reference_without_its_check_leads_to_no_choice() {
    // The check has a step that it refuses.
    let fine = Rk8::new(Digits71::from_ratio(1, 20));
    let none = Rk8::new(Digits71::zero());
    let trade = spring().reference_by(["RK8", "nothing"], fine, none).unwrap().run();
    let reference = trade.report.reference.as_ref().unwrap();
    assert!(reference.error.is_none() && reference.failure.is_some());
    nothing_is_chosen(&trade.report, "not checked");
    let measured =
        trade.report.rows.iter().position(|row| row.error.is_some_and(|error| error < 1e-3)).unwrap();
    let forecast = trade.forecast(measured, 1e-3, &START, 0.0..50.0);
    assert_eq!(forecast, Forecast::Refused(NoChoice::Unchecked));
}

#[test]
fn choices_are_certain_and_marks_are_not_relied_upon() {
    let trade = spring().run();
    let report = &trade.report;
    let reference = report.reference.as_ref().unwrap().error.unwrap();
    for asked in [1e-3, 1e-6, 1e-9, 1e-12] {
        let choice = report.fastest_within(asked).unwrap();
        assert!(!choice.row.limited && choice.row.error >= Some(10.0 * reference));
        assert!(choice.ties.iter().all(|row| !row.limited));
    }
    // A report whose rows lost their marks, as one that was edited or written by another program.
    let mut edited = report.clone();
    edited.reference.as_mut().unwrap().error = Some(0.84);
    assert!(edited.rows.iter().all(|row| !row.limited));
    nothing_is_chosen(&edited, "differ by");
    edited.reference.as_mut().unwrap().error = Some(f64::NAN);
    nothing_is_chosen(&edited, "differ by");
    edited.reference.as_mut().unwrap().error = None;
    nothing_is_chosen(&edited, "not checked");
    // A reference that is good for some errors only: those are chosen, and smaller ones are not.
    edited.reference.as_mut().unwrap().error = Some(1e-9);
    assert!(edited.fastest_within(1e-6).unwrap().row.error >= Some(1e-8));
    assert!(matches!(edited.fastest_within(1e-10), Err(NoChoice::ReferencesDisagree { .. })));
    assert!(edited.most_accurate_within(f64::INFINITY).unwrap().row.error >= Some(1e-8));
}

/// A body that nothing moves: reference, check and settings are right to the bit.
pub struct Free;

impl Equations<2> for Free {
    fn rates<R: Real>(&self, _t: R, &[_, v]: &[R; 2]) -> [R; 2] {
        [v, R::zero()]
    }
}

#[test]
fn a_motion_that_every_method_has_exactly_is_chosen() {
    let study =
        Study::new(generic(Planar::Free), [0.0, 0.5], 0.0..4.0).unwrap().count_evaluations().scan(1 << 12);
    let trade = study.keep(|_, real| real == "f64").probes(0, 0.0).run();
    assert!(trade.report.fastest_within(1e-9).is_ok());
}

#[cfg(feature = "serde")]
#[test]
fn reports_from_files_are_judged_as_new_ones() {
    let path = std::env::temp_dir().join(format!("guen-doubt-{}.json", std::process::id()));
    let report = disagreeing().run().report;
    report.save_json(&path).unwrap();
    let back = StudyReport::load_json(&path).unwrap();
    std::fs::remove_file(&path).unwrap();
    assert_eq!(back, report);
    nothing_is_chosen(&back, "differ by");
}

/// Settings of the user's own are judged like all others.
#[test]
fn forms_and_methods_of_ones_own_are_judged_alike() {
    let by_hand = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
    let trade = disagreeing()
        .keep(|_, _| false)
        .with_form("by hand", by_hand, |x| *x, |x| *x)
        .with_method("own", Settings::Tolerances, |tol| Dop853::new(tol, tol), |_| String::new())
        .unwrap()
        .run();
    assert!(trade.report.rows.iter().any(|row| row.method == "own" && row.error.is_some()));
    nothing_is_chosen(&trade.report, "differ by");
}

/// What DOP853 in doubles cannot follow, as stiff motions, is chosen for with a word on it, and forecasts carry the same.
#[test]
fn choices_and_forecasts_say_what_nobody_looked_at() {
    let study = Study::of_closures(
        // It looks closely, and cannot.
        |_, _: &[f64; 2]| [f64::NAN; 2],
        |_, &[x, v]: &[Digits71; 2]| [v, -x],
        START,
        0.0..5.0,
    );
    let trade = study
        .keep(|_, _| false)
        .with_method_on(
            from_fn(|_, &[x, v]: &[f64; 2]| [v, -x]),
            ["DOP853", "f64", "by hand"],
            Settings::Tolerances,
            |tolerance| Dop853::new(tolerance, tolerance),
            |_| String::new(),
        )
        .count_evaluations()
        .probes(2, 0.1)
        .run();
    let report = &trade.report;
    assert_eq!(report.scan.as_ref().unwrap().width, None, "{report}");
    let choice = report.fastest_within(1e-6).unwrap();
    assert_eq!(choice.caveats, [Caveat::NotScanned]);
    assert!(choice.to_string().contains("may have been stepped over"), "{choice}");
    let forecast = trade.forecast(choice.index, choice.asked, &[0.9, 0.0], 0.0..5.0);
    assert!(matches!(forecast, Forecast::Holds { caveat: Some(Caveat::NotScanned), .. }), "{forecast:?}");

    // What was looked at needs no word, but for states nearby that nobody asked for.
    let report = spring().run().report;
    let choice = report.fastest_within(1e-6).unwrap();
    assert_eq!(choice.caveats, [Caveat::NotTriedNearby]);
    assert!(choice.to_string().contains("not tried from states nearby"), "{choice}");
    let report = spring().probes(3, 0.4).run().report;
    assert_eq!(report.fastest_within(1e-6).unwrap().caveats, []);
    assert!(report.most_accurate_within(f64::INFINITY).unwrap().caveats.len() <= 1);
}

/// Where every setting is far off, as in chaotic motions over long spans, the reason says how far, and not that nothing was measured.
#[test]
fn settings_that_are_all_useless_are_said_to_be() {
    let study = Study::new(generic(Scalar::Growing), [1.0], 0.0..4.0).unwrap();
    let steps = Settings::List(Knob::Step, vec![2.0, 1.0, 0.5]);
    let study = study.keep(|_, _| false).with_method("RK4", steps, Rk4::new, |_| String::new());
    let report = study.unwrap().scales([1e3]).count_evaluations().scan(1 << 12).probes(0, 0.0).run().report;
    let [row] = &report.rows[..] else { panic!("{}", report.table()) };
    assert!(row.setting == 0.5 && row.error > Some(0.5), "{row:?}");
    assert_eq!(report.fastest_within(1e-3), Err(NoChoice::NotThatAccurate { least: row.error.unwrap() }));
}
