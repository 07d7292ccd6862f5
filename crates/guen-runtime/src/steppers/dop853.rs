//! Dormand and Prince's method of order eight with estimates of orders five and three: the adaptive driver. One
//! step of it is a [`Trial`] of the [`Tableau`].

use core::ops::ControlFlow;

pub use super::tableau::{Tableau, Trial};

use super::control::{self, Tolerance};
use super::integrate::{Course, Done, Progress};
use super::{all_finite, shifted};
use crate::error::{Cause, IntegrationError, Setting};
use crate::real::Ordered;
use crate::system::System;

/// DOP853: order eight, with a step that adapts to a tolerance.
///
/// A step is accepted if its estimated error, in the mean over the entries, is below `atol + rtol |x_i|`:
///
/// ```text
/// err = |h| s5 / sqrt(N (s5 + s3 / 100)) <= 1      s_q = sum_i (error_q,i / (atol + rtol max |x_i|))^2
/// ```
///
/// with the estimates `error_5` and `error_3` of the [`Trial`] and the maximum over both ends of the step. The
/// next step is the present one times `0.9 err^(-1/8)`, between a third and six times, and no longer than the
/// present one after a rejection.
///
/// - For smooth right-hand sides that are not stiff. Not symplectic; there is no dense output yet.
/// - Tolerances and steps are `f64` for every real; with duals the values alone decide the steps.
/// - A trial that is not finite is repeated with a shorter step, so a motion may approach the edge of a domain;
///   if it cannot be continued, the error says [`Cause::NotFinite`].
/// - Cost of a step: 12 evaluations if accepted, 11 if not.
/// - Source: E. Hairer and G. Wanner's program `dop853.f`, described in Hairer, Norsett and Wanner, *Solving
///   Ordinary Differential Equations I*, second edition, Springer 1993, as the program's own header says.
///   Differs from it in three points: trials that are not finite are caught, the step before a landing is
///   remembered after it, and there is no test for stiffness.
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

    /// Integrates from `x0` at `t0` to `t1`, forwards or backwards, calling the observer after each accepted
    /// step; when it breaks, the run ends with [`Outcome::Stopped`](super::Outcome::Stopped). The last step is
    /// shortened to land on `t1`. A span of zero is no step at all.
    ///
    /// # Errors
    ///
    /// Tolerances or a first step that make no sense; too many steps; a step that underflows; a state or rate
    /// that is not finite. The error carries the last good time and state.
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
    /// state at each of them, exactly: steps are shortened to land there, so many times make many steps. The
    /// times may repeat and may turn back.
    ///
    /// # Errors
    ///
    /// Those of [`integrate`](Dop853::integrate); times visited before stay visited.
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

    fn course<const N: usize>(&self, t0: R, x0: &[R; N]) -> Run<'_, R, N> {
        Run { method: self, progress: Progress::new(t0, x0), ready: None }
    }
}

/// A run of the method.
struct Run<'a, R, const N: usize> {
    method: &'a Dop853<R>,
    progress: Progress<R, N>,
    /// What the next step starts with; absent before the first.
    ready: Option<Ready<R, N>>,
}

/// The slope at the present state, which the step before computed, and the step to try.
#[derive(Clone, Copy)]
struct Ready<R, const N: usize> {
    slope: [R; N],
    step: f64,
}

impl<R: Ordered, const N: usize> Run<'_, R, N> {
    fn tolerance(&self) -> Tolerance {
        Tolerance { relative: self.method.rtol, absolute: self.method.atol }
    }

    /// Checks the settings and finds the first slope and step.
    fn start<S>(&mut self, system: &S, target: R) -> Result<Ready<R, N>, Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let tolerance = self.tolerance();
        if !tolerance.is_valid() {
            return Err(Cause::Setting(Setting::Tolerance));
        }
        let Progress { time, state, .. } = self.progress;
        if !time.is_finite() || !all_finite(&state) {
            return Err(Cause::NotFinite);
        }
        let slope = system.rhs(time, &state);
        self.progress.statistics.evaluations += 1;
        if !all_finite(&slope) {
            return Err(Cause::NotFinite);
        }
        if let Some(step) = self.method.first_step {
            let valid = step > 0.0 && step.is_finite();
            return if valid { Ok(Ready { slope, step }) } else { Err(Cause::Setting(Setting::Step)) };
        }
        let span = (target - time).to_f64();
        let (guess, slope_size) = tolerance.first_guess(&state, &slope, span.abs());
        let h = R::from_f64(guess.copysign(span));
        let ahead = system.rhs(time + h, &shifted(&state, h, &slope));
        self.progress.statistics.evaluations += 1;
        let change = core::array::from_fn(|i| ahead[i] - slope[i]);
        let step = if all_finite(&change) {
            tolerance.first_step(guess, slope_size, &change, &state, span.abs())
        } else {
            guess
        };
        Ok(Ready { slope, step })
    }
}

impl<R: Ordered, const N: usize> Course<R, N> for Run<'_, R, N> {
    fn progress(&self) -> &Progress<R, N> {
        &self.progress
    }

    fn advance<S: System<R, N> + ?Sized>(&mut self, system: &S, target: R) -> Result<(), Cause> {
        /// A rest of less than this part of a step is not left for a step of its own.
        const STRETCH: f64 = 1.01;
        /// How many spacings of numbers at the present time a step must span.
        const SPACINGS: f64 = 10.0;

        let Ready { slope, mut step } = match self.ready {
            Some(ready) => ready,
            None => self.start(system, target)?,
        };
        let tolerance = self.tolerance();
        let Progress { time, state, .. } = self.progress;
        let rest = target - time;
        let span = rest.to_f64();
        let shortest = SPACINGS * time.to_f64().abs() * R::epsilon().to_f64();
        let mut rejected = false;
        let mut finite = true;
        loop {
            let statistics = &mut self.progress.statistics;
            if statistics.accepted + statistics.rejected >= self.method.max_steps {
                return Err(Cause::TooManySteps { limit: self.method.max_steps });
            }
            if step <= shortest {
                return Err(if finite { Cause::StepUnderflow } else { Cause::NotFinite });
            }
            let landing = STRETCH * step > span.abs();
            let (next, h) = if landing {
                (target, rest)
            } else {
                let h = R::from_f64(step.copysign(span));
                (time + h, h)
            };
            let size = if landing { span.abs() } else { step };
            let mut trial = self.method.tableau.trial(system, time, &state, &slope, h);
            statistics.evaluations += 11;
            let error = tolerance.error(size, &trial.error5, &trial.error3, &state, &trial.state);
            finite = all_finite(&trial.state) && !error.is_nan();
            if finite && error <= 1.0 {
                system.restore(next, &mut trial.state).map_err(|_| Cause::Positions)?;
                let next_slope = system.rhs(next, &trial.state);
                statistics.evaluations += 1;
                finite = all_finite(&next_slope);
                if finite {
                    statistics.accepted += 1;
                    let mut next_step = size * control::factor_after_success(error);
                    if rejected {
                        next_step = next_step.min(size);
                    }
                    // What was asked for beyond the landing has not become wrong by the landing.
                    if landing {
                        next_step = next_step.max(step);
                    }
                    self.progress.time = next;
                    self.progress.state = trial.state;
                    self.ready = Some(Ready { slope: next_slope, step: next_step });
                    return Ok(());
                }
            }
            statistics.rejected += 1;
            rejected = true;
            let factor =
                if finite { control::factor_after_failure(error) } else { control::FACTOR_OUT_OF_DOMAIN };
            step = size * factor;
        }
    }
}
