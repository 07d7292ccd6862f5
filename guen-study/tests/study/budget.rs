//! A reference in 71 digits that takes too long is one in 31 digits, and the report says so.

use std::time::Duration;

use guen_runtime::{Equations, Real, generic};
use guen_study::Study;

use crate::systems::Planar;

/// A pendulum whose rates take twelve thousandths of a second in 71 digits.
pub struct Slow;

impl Equations<2> for Slow {
    fn rates<R: Real>(&self, _t: R, &[q, w]: &[R; 2]) -> [R; 2] {
        if R::epsilon().to_f64() < 1e-40 {
            std::thread::sleep(Duration::from_millis(12));
        }
        [w, -q.sin()]
    }
}

#[test]
fn what_is_too_slow_for_71_digits_has_31() {
    let study = Study::new(generic(Planar::Slow), [1.0, 0.0], 0.0..2.0).unwrap();
    let trade = study
        .count_evaluations()
        .keep(|method, real| real == "f64" && ["RK4", "DOP853"].contains(&method))
        .probes(0, 0.0)
        .scan(1 << 12)
        // 140 evaluations in 71 digits, where the shortest of references takes 157 for a step.
        .within(Duration::from_millis(8400))
        .run();
    let reference = trade.report.reference.as_ref().unwrap();
    assert!(reference.method.contains("31 digits") && reference.check.contains("31 digits"), "{reference:?}");
    assert!(reference.error.unwrap() < 1e-15, "{reference:?}");
    assert!(trade.report.to_string().contains("31 digits"));
    for asked in [1e-3, 1e-9, 1e-12] {
        let choice = trade.report.fastest_within(asked).unwrap();
        assert!(trade.forecast(choice.index, asked, &[1.0, 0.0], 0.0..2.0).holds());
    }
}

#[test]
fn what_is_quick_has_71() {
    let trade = crate::oscillator().keep(|method, _| method == "RK4").run();
    let reference = trade.report.reference.as_ref().unwrap();
    assert!(reference.method.contains("71 digits") && reference.check.contains("71 digits"), "{reference:?}");
}
