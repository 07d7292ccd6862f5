//! Fixed steps whose sum loses no digits.

use core::ops::ControlFlow;

use crate::numbers::real::Real;
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::error::{Cause, IntegrationError};
use crate::steppers::driver::integration::Integration;
use crate::steppers::driver::run::{Checkpoint, IntegrationResult, Method};
use crate::steppers::driver::statistics::Statistics;
use crate::steppers::explicit::fixed::{Changes, Fixed, Formula, LastStep, NextStep};
use crate::system::System;

/// A method with a fixed step that adds up the changes of its steps with compensation: made by
/// [`Rk4::compensated`](crate::steppers::Rk4::compensated) and [`Rk8::compensated`](crate::steppers::Rk8::compensated).
///
/// ```text
/// y = h sum_i b_i k_i + lost          x' = x + y          lost = y - (x' - x), exactly
/// ```
///
/// - `lost` is what rounding took from the sum; it is found by the two-sum of Knuth (The Art of Computer Programming 2,
///   4.2.2, theorem B), whatever the sizes of `x` and `y`, and given back in the next step. What is left are the roundings of
///   the changes, smaller than those of the states by the length of a step relative to the motion.
/// - What is left beside them grows like the number of steps, though slowly: the coefficients of the method are rounded to
///   the real's digits too, always to the same side. It is proportional to the step. On simple oscillators with some 300 steps in a
///   period it is as large as what compensation saves after 1e6 steps.
/// - Seven additions for each variable in a step. It pays where the error of the method is below rounding, on long runs:
///   `docs/design/sums.md` has the figures.
/// - Everything else is as without it. A change of the state from outside, by [`System::restore`], keeps what was lost.
///
/// ```
/// use guen_runtime::prelude::*;
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let off = |done: IntegrationResult<f64, 2>| (done.state[0].powi(2) + done.state[1].powi(2) - 1.0).abs();
/// let (method, start) = (Rk8::new(0.01), [0.0, 1.0]);
/// let plain = Integration::new(&oscillator, 0.0, &start).run(&method, 100.0).unwrap();
/// let compensated = Integration::new(&oscillator, 0.0, &start).run(&method.compensated(), 100.0).unwrap();
/// assert!(off(compensated) < 2e-15 && off(plain) > 5e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensated<F> {
    pub(in crate::steppers) method: F,
}

impl<F> Compensated<F> {
    /// Integrates from `x0` at `t0` to `t1`, as [`Rk4::integrate`](crate::steppers::Rk4::integrate) does.
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use guen_runtime::{from_fn, steppers::Rk4};
    ///
    /// let growth = from_fn(|_t: f64, &[x]: &[f64; 1]| [x]);
    /// let go_on = |_, _: &[f64; 1]| ControlFlow::Continue(());
    /// let done = Rk4::new(0.01).compensated().integrate(&growth, 0.0, &[1.0], 1.0, go_on).unwrap();
    /// assert!((done.state[0] - 1.0_f64.exp()).abs() < 1e-9);
    /// ```
    ///
    /// # Errors
    ///
    /// Settings that make no sense; else what stopped the method, or what the default [`Guard`](crate::steppers::Guard) found.
    pub fn integrate<R, S, O, const N: usize>(
        &self,
        system: &S,
        t0: R,
        x0: &[R; N],
        t1: R,
        mut observer: O,
    ) -> Result<IntegrationResult<R, N>, IntegrationError<R, N>>
    where
        R: Real,
        S: System<R, N> + ?Sized,
        Self: Method<R, S, N>,
        O: FnMut(R, &[R; N]) -> ControlFlow<()>,
    {
        Integration::new(system, t0, x0).observe(&mut observer).run(self, t1)
    }

    /// Integrates from `x0` at `t0` through the given times and lands on each of them, as
    /// [`Rk4::sample`](crate::steppers::Rk4::sample) does. What rounding took is kept from one to the next.
    ///
    /// # Errors
    ///
    /// Those of `integrate`; times visited before stay visited.
    pub fn sample<R, S, V, const N: usize>(
        &self,
        system: &S,
        t0: R,
        x0: &[R; N],
        times: &[R],
        visit: V,
    ) -> Result<IntegrationResult<R, N>, IntegrationError<R, N>>
    where
        R: Real,
        S: System<R, N> + ?Sized,
        Self: Method<R, S, N>,
        V: FnMut(usize, R, &[R; N]),
    {
        Integration::new(system, t0, x0).run_through(self, times, visit)
    }
}

impl<R, S, F, const N: usize> Formula<R, S, N> for Compensated<F>
where
    R: Real,
    S: System<R, N> + ?Sized,
    F: Changes<R, S, N>,
{
    /// The memory of the formula, and the rounding that the sum lost.
    type Memory = (F::Memory, [R; N]);
    const EVALUATIONS: u32 = F::EVALUATIONS;

    fn step_size(&self) -> R {
        self.method.step_size()
    }

    fn memory(&self) -> Self::Memory {
        (self.method.memory(), [R::zero(); N])
    }

    #[inline]
    fn step(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> Result<[R; N], Cause> {
        let NextStep { system, memory: (memory, lost), from, h, dense, statistics } = next;
        let change = self.method.change(NextStep { system, memory, from, h, dense, statistics });
        let mut next = from.state;
        for i in 0..N {
            let (x, y) = (from.state[i], change[i] + lost[i]);
            let sum = x + y;
            let of_y = sum - x;
            lost[i] = (x - (sum - of_y)) + (y - of_y);
            next[i] = sum;
        }
        Ok(next)
    }

    fn dense(
        &self,
        last: LastStep<'_, R, S, &mut Self::Memory, N>,
        h: R,
        statistics: &mut Statistics,
    ) -> Dense<R, N> {
        let LastStep { system, memory: (memory, _), from, to } = last;
        self.method.dense(LastStep { system, memory, from, to }, h, statistics)
    }

    fn defect(&self, last: LastStep<'_, R, S, &Self::Memory, N>) -> [R; N] {
        let LastStep { system, memory: (memory, _), from, to } = last;
        self.method.defect(LastStep { system, memory, from, to })
    }
}

impl<R, S, F, M, const N: usize> Method<R, S, N> for Compensated<F>
where
    R: Real,
    S: System<R, N> + ?Sized,
    F: Changes<R, S, N, Memory = M>,
    M: Copy,
{
    type Run<'a>
        = Fixed<'a, Self, (M, [R; N]), R, N>
    where
        F: 'a;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        Fixed::new::<S>(self, start)
    }
}
