//! The explicit method of Euler, with a fixed step.

use crate::numbers::real::Real;
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, Method};
use crate::steppers::driver::statistics::Statistics;
use crate::steppers::explicit::fixed::{Fixed, Formula, LastStep, NextStep, Slopes, fixed_step};
use crate::steppers::guard::defect::quadrature;
use crate::steppers::shifted;
use crate::system::System;

/// The explicit method of Euler with a fixed step.
///
/// ```text
/// x(t + h) = x + h f(t, x) + O(h^2)
/// ```
///
/// - Order 1: for comparisons, and for programs that have to be followed by hand; [`Rk4`](crate::steppers::Rk4) reaches any
///   accuracy with less work.
/// - Steps, demands and dense output as of [`Rk4`](crate::steppers::Rk4). One evaluation a step.
/// - Source: L. Euler, *Institutionum calculi integralis*, volume 1, section 2, chapter 7 (1768).
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::{from_fn, steppers::Euler};
///
/// let growth = from_fn(|_t: f64, &[x]: &[f64; 1]| [x]);
/// let done = Euler::new(1.0 / 32.0).integrate(&growth, 0.0, &[1.0], 1.0, |_, _| ControlFlow::Continue(()))?;
/// assert!((done.state[0] - (33.0_f64 / 32.0).powi(32)).abs() < 1e-14);
/// // A step of a half would miss by a sixth: that is an error, unless the guard is told otherwise.
/// let coarse = Euler::new(0.5).integrate(&growth, 0.0, &[1.0], 1.0, |_, _| ControlFlow::Continue(()));
/// assert!(coarse.is_err());
/// # Ok::<(), guen_runtime::IntegrationError<f64, 1>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Euler<R = f64> {
    /// The step, in units of time: positive and finite.
    pub step: R,
}

impl<R: Real> Euler<R> {
    /// The method with this step.
    pub const fn new(step: R) -> Self {
        Self { step }
    }
}

impl<R: Real, S: System<R, N> + ?Sized, const N: usize> Formula<R, S, N> for Euler<R> {
    type Memory = Slopes<R, N>;
    const EVALUATIONS: u32 = 1;

    fn step_size(&self) -> R {
        self.step
    }

    fn memory(&self) -> Self::Memory {
        Slopes::new()
    }

    #[inline]
    fn step(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> Result<[R; N], Cause> {
        let slope = next.memory.begin(next.system, next.from, next.statistics);
        Ok(shifted(&next.from.state, next.h, &slope))
    }

    fn dense(
        &self,
        last: LastStep<'_, R, S, &mut Self::Memory, N>,
        h: R,
        statistics: &mut Statistics,
    ) -> Dense<R, N> {
        last.memory.hermite(last.system, (last.from, last.to), h, statistics)
    }

    fn defect(&self, last: LastStep<'_, R, S, &Self::Memory, N>) -> [R; N] {
        quadrature(last.system, &last.memory.first, last.from, last.to)
    }
}

fixed_step!(Euler over Real, systems System, memory Slopes<R, N>);
