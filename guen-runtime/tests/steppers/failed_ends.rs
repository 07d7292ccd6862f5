//! The place and the work that an error tells, by who found the fault: the guard, or what is asked of a place within a step.

use guen_runtime::steppers::{Guard, Integration, Rk4};
use guen_runtime::{Cause, Guarded, Invariants, PositionsError, System};

/// `x' = 1`, which calls `x` its energy, and has no state on its constraints at one time.
struct Straight {
    barred: f64,
}

impl System<f64, 1> for Straight {
    fn rhs(&self, _t: f64, _x: &[f64; 1]) -> [f64; 1] {
        [1.0]
    }

    fn restore(&self, t: f64, _state: &mut [f64; 1]) -> Result<(), PositionsError> {
        if t == self.barred { Err(PositionsError::NotFound { residual: 1.0 }) } else { Ok(()) }
    }

    fn guarded(&self) -> impl Guarded<f64, 1> {
        self
    }
}

impl Guarded<f64, 1> for Straight {
    fn conserved(&self, _t: f64, &[x]: &[f64; 1]) -> Invariants<f64> {
        Invariants { energy: Some(x), scale: 1.0, residual: 0.0, carried: 0.0 }
    }
}

#[test]
fn a_guard_tells_where_all_was_in_order_and_all_the_work() {
    let guard = Guard { every: Some(2), energy: 0.5, ..Guard::default() };
    let run = Integration::new(&Straight { barred: -1.0 }, 0.0, &[0.0]).guard(guard);
    let error = run.run(&Rk4::new(0.125), 1.0).unwrap_err();
    // Checked after steps 1, 3, 5: at 0.625 it is off by more than a half.
    assert!(matches!(error.cause, Cause::Energy { .. }), "{:?}", error.cause);
    assert_eq!((error.time, error.state, error.statistics.accepted), (0.375, [0.375], 5));
}

#[test]
fn a_fault_within_a_step_tells_where_the_step_began() {
    let run = Integration::new(&Straight { barred: 0.3125 }, 0.0, &[0.0]).guard(Guard::FINITE);
    let mut seen = Vec::new();
    let times = [0.0625, 0.3125, 0.4375];
    let error =
        run.sample(&times, &mut |_, t, x| seen.push((t, x[0]))).run(&Rk4::new(0.125), 1.0).unwrap_err();
    assert_eq!((error.time, error.state, error.statistics.accepted), (0.25, [0.25], 2));
    assert_eq!(seen, [(0.0625, 0.0625)]);
}
