//! The classical method of order four, with a fixed step.

use crate::numbers::lanes::Lanes;
use crate::numbers::real::Real;
use crate::report::cost::Cost;
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, Method};
use crate::steppers::driver::statistics::Statistics;
use crate::steppers::explicit::compensated::Compensated;
use crate::steppers::explicit::fixed::{Changes, Fixed, Formula, LastStep, NextStep, Slopes, fixed_step};
use crate::steppers::explicit::lanes::{LaneFormula, Moment, in_lanes};
use crate::steppers::guard::defect::quadrature;
use crate::steppers::moved;
use crate::system::System;

/// Makes one step of the classical Runge-Kutta method.
///
/// ```text
/// k1 = f(t, x)                    k3 = f(t + h/2, x + h/2 k2)
/// k2 = f(t + h/2, x + h/2 k1)     k4 = f(t + h, x + h k3)
/// x(t + h) = x + h/6 (k1 + 2 k2 + 2 k3 + k4) + O(h^5)
/// ```
///
/// `h` may be negative. Nothing is checked: a right-hand side outside its domain shows as NaN in the result.
/// Four evaluations, about `13 N` further operations, no allocation. Source: W. Kutta's method as in every
/// textbook; the tests measure its order.
///
/// ```
/// use guen_runtime::{from_fn, steppers::rk4};
///
/// let growth = from_fn(|_t: f64, &[x]: &[f64; 1]| [x]);
/// let [x] = rk4::step(&growth, 0.0, &[1.0], 0.5);
/// // the exponential series up to the fourth power
/// assert!((x - (1.0 + 0.5 + 0.125 + 0.125 / 6.0 + 0.0625 / 24.0)).abs() < 1e-15);
/// ```
pub fn step<R, S, const N: usize>(system: &S, t: R, x: &[R; N], h: R) -> [R; N]
where
    R: Real,
    S: System<R, N> + ?Sized,
{
    R::vectorize(
        #[inline(always)]
        || step_from(system, t, x, &system.rhs(t, x), h),
    )
}

/// The step, where the slope at its beginning is known.
#[inline(always)]
fn step_from<R, S, const N: usize>(system: &S, t: R, x: &[R; N], k1: &[R; N], h: R) -> [R; N]
where
    R: Real,
    S: System<R, N> + ?Sized,
{
    moved(x, h * R::from_ratio(1, 6), &sum_from(system, t, x, k1, h))
}

/// Returns the increment of the state in a step.
#[inline(always)]
fn change_from<R, S, const N: usize>(system: &S, t: R, x: &[R; N], k1: &[R; N], h: R) -> [R; N]
where
    R: Real,
    S: System<R, N> + ?Sized,
{
    let sixth = h * R::from_ratio(1, 6);
    let mut change = sum_from(system, t, x, k1, h);
    for entry in &mut change {
        *entry *= sixth;
    }
    change
}

/// `k1 + 2 k2 + 2 k3 + k4`
#[inline(always)]
fn sum_from<R, S, const N: usize>(system: &S, t: R, x: &[R; N], k1: &[R; N], h: R) -> [R; N]
where
    R: Real,
    S: System<R, N> + ?Sized,
{
    let half = h * R::from_ratio(1, 2);
    let k2 = system.rhs(t + half, &moved(x, half, k1));
    let k3 = system.rhs(t + half, &moved(x, half, &k2));
    let k4 = system.rhs(t + h, &moved(x, h, &k3));
    let two = R::from_ratio(2, 1);
    let mut sum = k4;
    for i in 0..N {
        sum[i] += two.times_plus(k2[i] + k3[i], k1[i]);
    }
    sum
}

/// The operations of one [`step`] of a system of `n` equations whose right-hand side costs `rhs`.
///
/// ```
/// use guen_runtime::{Cost, steppers::rk4};
/// let rhs = Cost { additions: 1, multiplications: 2, ..Cost::ZERO };
/// assert_eq!(rk4::cost(rhs, 2), Cost { additions: 21, multiplications: 20, ..Cost::ZERO });
/// ```
pub const fn cost(rhs: Cost, n: u32) -> Cost {
    // Three stages x + h k, and x + h/6 (k1 + 2 (k2 + k3) + k4); h/2 and h/6; t + h/2 twice, and t + h.
    let own = Cost { additions: 7 * n + 3, multiplications: 5 * n + 2, ..Cost::ZERO };
    rhs.plus(rhs).plus(rhs).plus(rhs).plus(own)
}

/// The classical Runge-Kutta method with a fixed step.
///
/// - Order 4, not symplectic, no error estimate: halve the step and compare.
/// - The `k`-th time is `t0 + k h`, computed so and not summed up, hence without drift, and a step is as long as the
///   difference of two of these rounded times. The last step is shortened to land on the final time; a rest of a few
///   roundings is merged into the step before it.
/// - The step is a positive duration; the direction follows from the times. A span of zero is no step at all.
/// - Works for every [`Real`]: lanes, which share their time, included.
/// - Dense output is the cubic through both ends of a step with their slopes, off by `O(h^4)` as the steps are.
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::{from_fn, steppers::Rk4};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let mut highest = 0.0_f64;
/// let done = Rk4::new(0.01)
///     .integrate(&oscillator, 0.0, &[0.0, 1.0], 2.0, |_t, x| {
///         highest = highest.max(x[0]);
///         ControlFlow::Continue(())
///     })
///     .unwrap();
/// assert_eq!(done.time, 2.0);
/// assert!((done.state[0] - 2.0_f64.sin()).abs() < 1e-9);
/// assert!((highest - 1.0).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rk4<R = f64> {
    /// The step, in units of time: positive and finite.
    pub step: R,
}

impl<R: Real, S: System<R, N> + ?Sized, const N: usize> Formula<R, S, N> for Rk4<R> {
    type Memory = Slopes<R, N>;
    const EVALUATIONS: u32 = 4;

    fn step_size(&self) -> R {
        self.step
    }

    fn memory(&self) -> Self::Memory {
        Slopes::new()
    }

    #[inline]
    fn step(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> Result<[R; N], Cause> {
        let NextStep { system, memory: slopes, from, h, statistics, .. } = next;
        let slope = slopes.begin(system, from, statistics);
        statistics.evaluations += 3;
        Ok(R::vectorize(
            #[inline(always)]
            || step_from(system, from.time, &from.state, &slope, h),
        ))
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

impl<R: Real> Rk4<R> {
    /// The method with this step.
    pub const fn new(step: R) -> Self {
        Self { step }
    }

    /// The method with a sum of its steps that loses no digits: for long runs.
    pub fn compensated(self) -> Compensated<Self> {
        Compensated { method: self }
    }
}

impl<R: Real, S: System<R, N> + ?Sized, const N: usize> Changes<R, S, N> for Rk4<R> {
    #[inline]
    fn change(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> [R; N] {
        let NextStep { system, memory: slopes, from, h, statistics, .. } = next;
        let slope = slopes.begin(system, from, statistics);
        statistics.evaluations += 3;
        R::vectorize(
            #[inline(always)]
            || change_from(system, from.time, &from.state, &slope, h),
        )
    }
}

fixed_step!(Rk4 over Real, systems System, memory Slopes<R, N>);
in_lanes!(Rk4);

impl<L: Lanes, S: System<L, N> + ?Sized, const N: usize> LaneFormula<L, S, N> for Rk4 {
    /// The first slope.
    type Memory = [L; N];
    type Ready = ();
    const EVALUATIONS: u32 = 4;

    fn ready(&self) -> ((), f64, [L; N]) {
        ((), self.step, [L::zero(); N])
    }

    #[inline(always)]
    fn step((): &(), system: &S, first: &mut [L; N], (t, x): (L, &[L; N]), h: L, keep: bool) -> [L; N] {
        L::vectorize(
            #[inline(always)]
            || {
                let slope = system.rhs(t, x);
                if keep {
                    *first = slope;
                }
                step_from(system, t, x, &slope, h)
            },
        )
    }

    fn defect((): &(), system: &S, first: &[L; N], before: &Moment<L, N>, now: &Moment<L, N>) -> [L; N] {
        L::vectorize(
            #[inline(always)]
            || quadrature(system, first, &before.checkpoint(), &now.checkpoint()),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::step;
    use crate::{Fused, from_fn};

    #[test]
    fn stages_of_fused_reals_are_rounded_once() {
        let growth = from_fn(|_t: Fused, &[x]: &[Fused; 1]| [x]);
        let plain = from_fn(|_t: f64, &[x]: &[f64; 1]| [x]);
        let mut different = 0;
        for k in 1..100 {
            let (x, h) = (1.0 / f64::from(k), 0.01 * f64::from(k));
            let [found] = step(&growth, Fused::new(0.0), &[Fused::new(x)], Fused::new(h));
            let k2 = libm::fma(0.5 * h, x, x);
            let k3 = libm::fma(0.5 * h, k2, x);
            let k4 = libm::fma(h, k3, x);
            let sum = libm::fma(2.0, k2 + k3, x) + k4;
            assert_eq!(found.value, libm::fma(h * (1.0 / 6.0), sum, x));
            let [twice] = step(&plain, 0.0, &[x], h);
            different += u32::from(twice != found.value);
        }
        assert!(different > 20, "{different}");
    }
}
