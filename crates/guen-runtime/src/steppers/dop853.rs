//! Dormand and Prince's method of order eight with estimates of orders five and three: the adaptive method. One
//! step of it is a [`Trial`] of the [`Tableau`].

pub use super::tableau::{Tableau, Trial};

use super::adaptive::{Adaptive, Attempt, Pair, Settings, Step};
use super::control::{self, Control, Tolerance};
use super::course::Method;
use super::dense::Dense;
use super::landing::short_ways;
use super::shifted;
use super::tableau::Stages;
use crate::real::{Ordered, Real};
use crate::system::System;

/// DOP853: order eight, with a step that adapts to a tolerance.
///
/// A step is accepted if its estimated error, in the mean over the entries, is below `atol + rtol |x_i|`:
///
/// ```text
/// err = |h| s5 / sqrt(N (s5 + s3 / 100)) <= 1      s_q = sum_i (error_q,i / (atol + rtol max |x_i|))^2
/// ```
///
/// with the estimates `error_5` and `error_3` of the [`Trial`] and the maximum over both ends of the step. Since `s5`
/// falls as `h^10` and `s3` as `h^6`, this falls as `h^8`. The next step is the present one times `0.9 err^(-1/8)`,
/// between a third and six times, and no longer than the present one after a rejection.
///
/// - For smooth right-hand sides that are not stiff. Not symplectic.
/// - Tolerances and steps are `f64` for every real; with duals the values alone decide the steps.
/// - A trial that is not finite is repeated with a shorter step, so a motion may approach the edge of a domain;
///   if it cannot be continued, the error says [`Cause::NotFinite`](crate::Cause::NotFinite).
/// - Cost of a step: 12 evaluations if accepted, 11 if not; three more where dense output, of order seven, is asked
///   for.
/// - Source: E. Hairer and G. Wanner's program `dop853.f`, described in Hairer, Norsett and Wanner, *Solving
///   Ordinary Differential Equations I*, second edition, Springer 1993, as the program's own header says.
///   Differs from it in four points: trials that are not finite are caught, the step before a landing is
///   remembered after it, the root that gives the next step has almost four digits, and there is no test for stiffness.
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::{from_fn, steppers::Dop853};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let done = Dop853::new(1e-12, 1e-12)
///     .integrate(&oscillator, 0.0, &[0.0, 1.0], 10.0, |_t, _x| ControlFlow::Continue(()))
///     .unwrap();
/// assert!((done.state[0] - 10.0_f64.sin()).abs() < 1e-10);
/// assert!(done.statistics.evaluations < 700);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dop853<R = f64> {
    /// The tolerance relative to each entry of the state: nonnegative.
    pub rtol: f64,
    /// The absolute tolerance, the same for every entry of the state: positive.
    pub atol: f64,
    /// The largest number of trial steps of one run.
    pub max_steps: u64,
    /// The first step to try, a positive duration; estimated from the right-hand side if absent.
    pub first_step: Option<f64>,
    tableau: Tableau<R>,
}

impl<R: Ordered> Dop853<R> {
    /// The number of trial steps allowed unless another one is set.
    pub const MAX_STEPS: u64 = 100_000;

    /// The method with the given relative and absolute tolerances.
    pub fn new(rtol: f64, atol: f64) -> Self {
        Self { rtol, atol, max_steps: Self::MAX_STEPS, first_step: None, tableau: Tableau::new() }
    }

    /// The same with another limit on the number of trial steps.
    pub fn with_max_steps(self, max_steps: u64) -> Self {
        Self { max_steps, ..self }
    }

    /// The same with a given first step.
    pub fn with_first_step(self, first_step: f64) -> Self {
        Self { first_step: Some(first_step), ..self }
    }

    fn settings(&self) -> Settings {
        let tolerance = Tolerance { relative: self.rtol, absolute: self.atol };
        Settings { tolerance, max_steps: self.max_steps, first_step: self.first_step }
    }
}

impl<R: Real, const N: usize> Pair<R, N> for Tableau<R> {
    type Stages = Stages<R, N>;

    const TRIAL: u64 = 11;
    const CONTROL: Control = Control { power: 8, safety: 0.9, shorten: 0.333, grow: 6.0 };

    #[inline]
    fn attempt<S>(&self, system: &S, t: R, x: &[R; N], k1: &[R; N], h: R) -> Attempt<R, Stages<R, N>, N>
    where
        S: System<R, N> + ?Sized,
    {
        let stages = self.stages::<true, S, N>(system, t, x, k1, h);
        let slope = self.slope(&stages);
        Attempt { state: shifted(x, h, &slope), stages, end: None }
    }

    #[inline]
    fn margin(&self, attempt: &Attempt<R, Stages<R, N>, N>, h: f64, weights: &[f64; N]) -> f64 {
        let slope = self.slope(&attempt.stages);
        let five = control::squares(&self.error5(&attempt.stages), weights);
        let three = control::squares(&self.error3(&attempt.stages, &slope), weights);
        if five == 0.0 {
            return f64::INFINITY;
        }
        let size = h * five;
        N as f64 * (five + 0.01 * three) / (size * size)
    }

    fn dense<S>(&self, system: &S, step: &Step<'_, R, Stages<R, N>, N>) -> (Dense<R, N>, u64)
    where
        S: System<R, N> + ?Sized,
    {
        (self.dense(system, step.stages, step.from, step.to, step.end, step.h), 3)
    }
}

impl<R: Ordered, S: System<R, N> + ?Sized, const N: usize> Method<R, S, N> for Dop853<R> {
    type Course<'a> = Adaptive<'a, Tableau<R>, Stages<R, N>, R, N>;

    fn start(&self, t0: R, x0: &[R; N]) -> Self::Course<'_> {
        Adaptive::new(&self.tableau, self.settings(), t0, x0)
    }
}

short_ways!(Dop853 over Ordered, systems System);
