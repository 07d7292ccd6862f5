//! The loop around an explicit formula with an error estimate: trial steps until one is good enough.

use super::control::{self, Control, Tolerance};
use super::course::{Course, Reached};
use super::dense::Dense;
use super::{all_finite, shifted};
use crate::error::{Cause, Setting};
use crate::real::{Ordered, Real};
use crate::system::System;

/// The settings that all adaptive methods share.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    pub(super) tolerance: Tolerance,
    pub(super) max_steps: u64,
    pub(super) first_step: Option<f64>,
}

/// An explicit formula with an estimate of its error.
pub trait Pair<R: Real, const N: usize> {
    /// The slopes of a step, as far as dense output needs them.
    type Stages: Copy;

    /// Evaluations of a trial step, the slope at its beginning not counted.
    const TRIAL: u64;
    const CONTROL: Control;

    /// A step on trial from `x` with the slope `k1`. The slope at the end is `Some` if the formula computes it.
    fn attempt<S>(&self, system: &S, t: R, x: &[R; N], k1: &[R; N], h: R) -> Attempt<R, Self::Stages, N>
    where
        S: System<R, N> + ?Sized;

    /// How far a step of size `h` is from being rejected: `err^-2`, with the error in units of the tolerance. A step is
    /// good from one on. The reciprocal square is what takes the shortest to compute while the next step waits for it.
    fn margin(&self, attempt: &Attempt<R, Self::Stages, N>, h: f64, weights: &[f64; N]) -> f64;

    /// The polynomial over a step, with the slope at its end, and the evaluations that it took.
    fn dense<S>(&self, system: &S, step: &Step<'_, R, Self::Stages, N>) -> (Dense<R, N>, u64)
    where
        S: System<R, N> + ?Sized;
}

pub struct Attempt<R, K, const N: usize> {
    pub state: [R; N],
    pub stages: K,
    pub end: Option<[R; N]>,
}

/// A step that was accepted.
pub struct Step<'a, R, K, const N: usize> {
    pub from: &'a Reached<R, N>,
    pub to: &'a Reached<R, N>,
    pub stages: &'a K,
    pub end: &'a [R; N],
    pub h: R,
}

/// A run of an adaptive explicit method.
#[derive(Clone, Copy, Debug)]
pub struct Adaptive<'a, P, K, R, const N: usize> {
    pair: &'a P,
    settings: Settings,
    reached: Reached<R, N>,
    before: Reached<R, N>,
    /// What the next step starts with; absent before the first.
    ready: Option<Ready<R, N>>,
    stages: Option<K>,
}

/// The slope at the present state, which the step before computed, and the step to try.
#[derive(Clone, Copy, Debug)]
struct Ready<R, const N: usize> {
    slope: [R; N],
    step: f64,
}

impl<'a, P, R, const N: usize> Adaptive<'a, P, P::Stages, R, N>
where
    P: Pair<R, N>,
    R: Ordered,
{
    pub(super) fn new(pair: &'a P, settings: Settings, t0: R, x0: &[R; N]) -> Self {
        let reached = Reached::new(t0, x0);
        Self { pair, settings, reached, before: reached, ready: None, stages: None }
    }

    /// Checks the settings and finds the first slope and step.
    fn start<S>(&mut self, system: &S, target: R) -> Result<Ready<R, N>, Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let tolerance = self.settings.tolerance;
        tolerance.check()?;
        let Reached { time, state, .. } = self.reached;
        if !time.is_finite() || !all_finite(&state) {
            return Err(Cause::NotFinite);
        }
        let slope = system.rhs(time, &state);
        self.reached.statistics.evaluations += 1;
        if !all_finite(&slope) {
            return Err(Cause::NotFinite);
        }
        if let Some(step) = self.settings.first_step {
            let valid = step > 0.0 && step.is_finite();
            return if valid { Ok(Ready { slope, step }) } else { Err(Cause::Setting(Setting::Step)) };
        }
        let span = (target - time).to_f64();
        let (guess, slope_size) = tolerance.first_guess(&state, &slope, span.abs());
        let h = R::from_f64(guess.copysign(span));
        let ahead = system.rhs(time + h, &shifted(&state, h, &slope));
        self.reached.statistics.evaluations += 1;
        let change: [R; N] = core::array::from_fn(|i| ahead[i] - slope[i]);
        let step = if all_finite(&change) {
            let change = control::size(&change, &tolerance.weights(&state, &state));
            P::CONTROL.first_step(guess, slope_size, change, span.abs())
        } else {
            guess
        };
        Ok(Ready { slope, step })
    }
}

impl<P, R, S, const N: usize> Course<R, S, N> for Adaptive<'_, P, P::Stages, R, N>
where
    P: Pair<R, N>,
    R: Ordered,
    S: System<R, N> + ?Sized,
{
    const EVALUATIONS: u32 = P::TRIAL as u32;

    type Polynomial = Dense<R, N>;

    fn reached(&self) -> &Reached<R, N> {
        &self.reached
    }

    fn advance(&mut self, system: &S, target: R, dense: bool) -> Result<(), Cause> {
        let Ready { slope, mut step } = match self.ready {
            Some(ready) => ready,
            None => self.start(system, target)?,
        };
        let Settings { tolerance, max_steps, .. } = self.settings;
        let Reached { time, state, .. } = self.reached;
        let rest = target - time;
        let span = rest.to_f64();
        let shortest = control::shortest(time);
        let mut rejected = false;
        let mut finite = true;
        loop {
            let statistics = &mut self.reached.statistics;
            if statistics.accepted + statistics.rejected >= max_steps {
                return Err(Cause::TooManySteps { limit: max_steps });
            }
            if step <= shortest {
                return Err(if finite { Cause::StepUnderflow } else { Cause::NotFinite });
            }
            let landing = control::STRETCH * step > span.abs();
            let (next, h) = if landing {
                (target, rest)
            } else {
                let h = R::from_f64(step.copysign(span));
                (time + h, h)
            };
            let size = if landing { span.abs() } else { step };
            let attempt = self.pair.attempt(system, time, &state, &slope, h);
            statistics.evaluations += P::TRIAL;
            let margin = self.pair.margin(&attempt, size, &tolerance.weights(&state, &attempt.state));
            finite = all_finite(&attempt.state) && !margin.is_nan();
            if finite && margin >= 1.0 {
                let mut accepted = attempt.state;
                system.restore(next, &mut accepted).map_err(|_| Cause::Positions)?;
                let next_slope = match attempt.end {
                    // Of the very state that goes on: nothing was put back.
                    Some(end) if accepted == attempt.state => end,
                    _ => {
                        statistics.evaluations += 1;
                        system.rhs(next, &accepted)
                    }
                };
                finite = all_finite(&next_slope);
                if finite {
                    let mut next_step = size * P::CONTROL.factor_after_success(margin);
                    if rejected {
                        next_step = next_step.min(size);
                    }
                    // What was asked for beyond the landing has not become wrong by the landing.
                    if landing {
                        next_step = next_step.max(step);
                    }
                    self.ready = Some(Ready { slope: next_slope, step: next_step });
                    if dense {
                        self.before = self.reached;
                        self.stages = Some(attempt.stages);
                    }
                    self.reached.statistics.accepted += 1;
                    self.reached.time = next;
                    self.reached.state = accepted;
                    return Ok(());
                }
            }
            statistics.rejected += 1;
            rejected = true;
            let factor = if finite {
                P::CONTROL.factor_after_failure(margin)
            } else {
                P::CONTROL.factor_out_of_domain()
            };
            step = size * factor;
        }
    }

    fn dense(&mut self, system: &S) -> Dense<R, N> {
        let (from, to) = (&self.before, &self.reached);
        let h = to.time - from.time;
        let (Some(stages), Some(ready)) = (&self.stages, &self.ready) else {
            // No step was made with `dense`: there is nothing to interpolate but the present state.
            let zero = [R::zero(); N];
            return Dense::cubic(to.time, R::one(), [to.state, zero, zero, zero]);
        };
        let step = Step { from, to, stages, end: &ready.slope, h };
        let (dense, evaluations) = self.pair.dense(system, &step);
        self.reached.statistics.evaluations += evaluations;
        dense
    }
}
