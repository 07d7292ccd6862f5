//! A reference in 71 digits that takes too long is one in 31 digits, and the report says so.

use std::cell::Cell;
use std::time::Duration;

use guen_runtime::{Equations, Real, generic};
use guen_study::{Stopwatch, Study};

use crate::systems::Planar;

thread_local! {
    static NOW: Cell<Duration> = const { Cell::new(Duration::ZERO) };
}

/// A clock that stands still until it is told that time has passed.
pub struct Told;

impl Stopwatch for Told {
    fn seconds(&mut self, _row: usize, work: &mut dyn FnMut()) -> f64 {
        work();
        1.0
    }

    fn now(&self) -> Duration {
        NOW.get()
    }
}

/// Tells the clock of this thread that so much time has passed.
pub fn pass(time: Duration) {
    NOW.set(NOW.get() + time);
}

/// A pendulum whose rates take eight seconds in 71 digits, by the clock that is told.
pub struct Slow;

impl Equations<2> for Slow {
    fn rates<R: Real>(&self, _t: R, &[q, w]: &[R; 2]) -> [R; 2] {
        if R::epsilon().to_f64() < 1e-40 {
            pass(Duration::from_secs(8));
        }
        [w, -q.sin()]
    }
}

#[test]
fn what_is_too_slow_for_71_digits_has_31() {
    let study = Study::new(generic(Planar::Slow), [1.0, 0.0], 0.0..2.0).unwrap();
    let trade = study
        .count_evaluations()
        .stopwatch(Told)
        .keep(|method, real| real == "f64" && ["RK4", "DOP853"].contains(&method))
        .probes(0, 0.0)
        .scan(1 << 12)
        // 135 evaluations in 71 digits, where the shortest of references takes 157 for a step.
        .within(Duration::from_secs(3600))
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
