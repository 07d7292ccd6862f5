//! The classical method of order four, with a fixed step.

use core::ops::ControlFlow;

use super::integrate::{Course, Done, Progress};
use super::{all_finite, shifted};
use crate::error::{Cause, IntegrationError, Setting};
use crate::real::Real;
use crate::system::System;

/// One step of the classical Runge-Kutta method.
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
        || {
            let half = h * R::from_ratio(1, 2);
            let k1 = system.rhs(t, x);
            let k2 = system.rhs(t + half, &shifted(x, half, &k1));
            let k3 = system.rhs(t + half, &shifted(x, half, &k2));
            let k4 = system.rhs(t + h, &shifted(x, h, &k3));
            let two = R::from_ratio(2, 1);
            let sixth = h * R::from_ratio(1, 6);
            let mut next = *x;
            for i in 0..N {
                next[i] += sixth * (k1[i] + two * (k2[i] + k3[i]) + k4[i]);
            }
            next
        },
    )
}

/// The classical Runge-Kutta method with a fixed step.
///
/// - Order 4, not symplectic, no error estimate: halve the step and compare.
/// - The `k`-th time is `t0 + k h`, computed so and not summed up, hence without drift. The last step is
///   shortened to land on the final time; a rest of a few roundings is merged into the step before it.
/// - The step is a positive duration; the direction follows from the times. A span of zero is no step at all.
/// - Works for every [`Real`]: lanes, which share their time, included.
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::{from_fn, steppers::Rk4};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let mut highest = 0.0_f64;
/// let done = Rk4 { step: 0.01 }
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
pub struct Rk4<R = f64> {
    /// The step, in units of time: positive and finite.
    pub step: R,
}

impl<R: Real> Rk4<R> {
    /// Integrates from `x0` at `t0` to `t1`, calling the observer after each step; when it breaks, the run ends
    /// with [`Outcome::Stopped`](super::Outcome::Stopped).
    ///
    /// # Errors
    ///
    /// A step that is not positive and finite, or too small to move time; a state that is not finite. The error
    /// carries the last good time and state.
    pub fn integrate<S, O, const N: usize>(
        &self,
        system: &S,
        t0: R,
        x0: &[R; N],
        t1: R,
        observer: O,
    ) -> Result<Done<R, N>, IntegrationError<R, N>>
    where
        S: System<R, N> + ?Sized,
        O: FnMut(R, &[R; N]) -> ControlFlow<()>,
    {
        self.course(t0, x0).integrate(system, t1, observer)
    }

    /// Integrates from `x0` at `t0` through the given times, and calls `visit` with the index, the time and the
    /// state at each of them, exactly. The times may repeat and may turn back. From each one a new sequence of
    /// full steps begins.
    ///
    /// # Errors
    ///
    /// Those of [`integrate`](Rk4::integrate); times visited before stay visited.
    pub fn sample<S, V, const N: usize>(
        &self,
        system: &S,
        t0: R,
        x0: &[R; N],
        times: &[R],
        visit: V,
    ) -> Result<Done<R, N>, IntegrationError<R, N>>
    where
        S: System<R, N> + ?Sized,
        V: FnMut(usize, R, &[R; N]),
    {
        self.course(t0, x0).sample(system, times, visit)
    }

    fn course<const N: usize>(&self, t0: R, x0: &[R; N]) -> Run<R, N> {
        Run { step: self.step, progress: Progress::new(t0, x0), leg: None }
    }
}

/// A run with a fixed step, in legs between the times that it has to land on.
struct Run<R, const N: usize> {
    step: R,
    progress: Progress<R, N>,
    leg: Option<Leg<R>>,
}

/// The steps from one time to another: `origin + k h` for `k = 1 .. count - 1`, then the target.
#[derive(Clone, Copy)]
pub(super) struct Leg<R> {
    origin: R,
    target: R,
    /// The step with its direction.
    h: R,
    /// Steps made.
    index: i64,
    /// Steps to make.
    count: i64,
}

impl<R: Real> Leg<R> {
    pub(super) fn new(origin: R, target: R, step: R) -> Result<Self, Cause> {
        /// Beyond this many steps `f64` no longer counts them one by one.
        const COUNTABLE: f64 = (1_u64 << 53) as f64;
        /// Roundings by which a span may exceed a whole number of steps without being given a further one: those
        /// of the span, of the quotient, and of the step as the user divided it.
        const ROUNDINGS: f64 = 4.0;

        let size = step.to_f64();
        if !(step.is_finite() && size > 0.0) {
            return Err(Cause::Setting(Setting::Step));
        }
        let span = (target - origin).to_f64();
        let steps = (span / size).abs();
        if steps >= COUNTABLE || steps.is_nan() {
            return Err(Cause::StepUnderflow);
        }
        let slack = ROUNDINGS * f64::max(R::epsilon().to_f64(), f64::EPSILON);
        let count = libm::ceil(steps * (1.0 - slack)).max(1.0) as i64;
        Ok(Self { origin, target, h: if span < 0.0 { -step } else { step }, index: 0, count })
    }

    /// The end and the length of the next step.
    pub(super) fn next(&mut self, now: R) -> Result<(R, R), Cause> {
        self.index += 1;
        let (next, h) = if self.index == self.count {
            (self.target, self.target - now)
        } else {
            (self.origin + self.h * R::from_ratio(self.index, 1), self.h)
        };
        if next == now { Err(Cause::StepUnderflow) } else { Ok((next, h)) }
    }
}

impl<R: Real, const N: usize> Course<R, N> for Run<R, N> {
    fn progress(&self) -> &Progress<R, N> {
        &self.progress
    }

    fn advance<S: System<R, N> + ?Sized>(&mut self, system: &S, target: R) -> Result<(), Cause> {
        let now = self.progress.time;
        let mut leg = match self.leg {
            Some(leg) if leg.target == target && leg.index < leg.count => leg,
            _ => Leg::new(now, target, self.step)?,
        };
        let (next, h) = leg.next(now)?;
        let mut state = step(system, now, &self.progress.state, h);
        self.progress.statistics.evaluations += 4;
        if !all_finite(&state) {
            return Err(Cause::NotFinite);
        }
        system.restore(next, &mut state).map_err(|_| Cause::Positions)?;
        self.progress.statistics.accepted += 1;
        self.progress.time = next;
        self.progress.state = state;
        self.leg = Some(leg);
        Ok(())
    }
}
