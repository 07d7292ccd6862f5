//! Reports as comma-separated values: a spreadsheet runs nothing.

use guen_runtime::steppers::Rk4;
use guen_runtime::{from_fn, generic};
use guen_study::{Knob, Settings, Study};

use crate::cells::{cells, runs};
use crate::systems::Scalar;

#[test]
fn names_and_failures_in_a_report_are_no_formulas() {
    let study =
        Study::new(generic(Scalar::Pole), [0.5], 0.0..1.0).unwrap().keep(|_, _| false).count_evaluations();
    let study = study.with_method_on(
        from_fn(|_t: f64, &[x]: &[f64; 1]| [-x]),
        ["=HYPERLINK(\"http://x\")", "@real", "-form"],
        Settings::List(Knob::Step, vec![0.1, -0.1]),
        Rk4::new,
        |_| "=code".to_owned(),
    );
    let csv = study.run().report.to_csv();
    assert!(csv.lines().count() > 1);
    for line in csv.lines().skip(1) {
        let cells = cells(line);
        assert!(cells.iter().all(|cell| !runs(cell)), "{line}");
        assert_eq!(&cells[..3], ["'=HYPERLINK(\"http://x\")", "'@real", "'-form"]);
    }
}
