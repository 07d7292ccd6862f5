//! The loop around an explicit formula with an error estimate: trial steps until one is good enough.

use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, StepperRun};
use crate::steppers::entries;
use crate::steppers::settings::Settings;
use crate::steppers::step_size::{self, Control, Margin};
use crate::steppers::{all_finite, is_long, shifted};
use crate::system::System;

/// An explicit formula with an estimate of its error.
pub(in crate::steppers) trait Pair<R: Real, const N: usize> {
    /// The slopes of a step, as far as dense output needs them.
    type Stages: Copy;
    /// The slopes or sums that the error of a step is measured by.
    type Errors;

    /// Evaluations of a trial step, the slope at its beginning not counted.
    const TRIAL: u64;
    /// Evaluations for the polynomial over a step.
    const DENSE: u64;
    const CONTROL: Control;

    /// Room for a step on trial.
    fn room() -> Attempt<R, Self::Stages, Self::Errors, N>;

    /// Makes a step on trial from `x` with the slope `k1`. The slope at the end is `Some` if the formula computes it.
    fn attempt<S>(
        &self,
        system: &S,
        t: R,
        x: &[R; N],
        k1: &[R; N],
        h: R,
        made: &mut Attempt<R, Self::Stages, Self::Errors, N>,
    ) where
        S: System<R, N> + ?Sized;

    /// The error of a step of size `h` in units of the tolerance.
    fn margin(&self, errors: &Self::Errors, h: f64, weights: &[f64; N]) -> Margin;

    /// The polynomial over a step, with the slope at its end.
    fn dense<S>(&self, system: &S, step: &Step<'_, R, Self::Stages, N>) -> Dense<R, N>
    where
        S: System<R, N> + ?Sized;
}

/// A step on trial.
#[derive(Clone, Copy, Debug)]
pub(in crate::steppers) struct Attempt<R, K, E, const N: usize> {
    pub state: [R; N],
    /// About that state, for the sizes of its entries: what is known of it early.
    pub guess: [R; N],
    pub stages: K,
    pub errors: E,
    pub end: Option<[R; N]>,
}

/// A step that was accepted.
pub(in crate::steppers) struct Step<'a, R, K, const N: usize> {
    pub from: &'a Checkpoint<R, N>,
    pub to: &'a Checkpoint<R, N>,
    pub stages: &'a K,
    pub end: &'a [R; N],
    pub h: R,
}

/// A run of an adaptive explicit method.
#[derive(Clone, Copy, Debug)]
pub struct Adaptive<'a, P, K, R, const N: usize> {
    pair: &'a P,
    settings: Settings,
    /// The time at which the run began.
    origin: R,
    reached: Checkpoint<R, N>,
    before: Checkpoint<R, N>,
    /// The slope and the size with which the next step starts; absent before the first.
    ready: Option<Ready<R, N>>,
    stages: Option<K>,
}

/// The slope at the present state, which the step before computed, and the step to try.
#[derive(Clone, Copy, Debug)]
struct Ready<R, const N: usize> {
    slope: [R; N],
    step: f64,
    /// The error of the step before, independently of its size.
    level: Option<f64>,
}

impl<'a, P, K: Copy, R: Ordered, const N: usize> Adaptive<'a, P, K, R, N> {
    pub(in crate::steppers) fn new(pair: &'a P, settings: Settings, start: &Checkpoint<R, N>) -> Self {
        let reached = *start;
        Self { pair, settings, origin: start.time, reached, before: reached, ready: None, stages: None }
    }

    /// Checks the settings and finds the first slope and step.
    fn start<S>(&mut self, system: &S, target: R) -> Result<(), Cause>
    where
        P: Pair<R, N, Stages = K>,
        S: System<R, N> + ?Sized,
    {
        let (slope, first_step) = self.settings.begin(system, &mut self.reached)?;
        if let Some(step) = first_step {
            self.ready = Some(Ready { slope, step, level: None });
            return Ok(());
        }
        let (tolerance, Checkpoint { time, state, .. }) = (self.settings.tolerance, self.reached);
        let span = (target - time).to_f64();
        let (guess, slope_size) = tolerance.first_guess(&state, &slope, span.abs());
        let h = R::from_f64(guess.copysign(span));
        let ahead = system.rhs(time + h, &shifted(&state, h, &slope));
        self.reached.statistics.evaluations += 1;
        let change: [R; N] = entries(|i| ahead[i] - slope[i]);
        let step = if all_finite(&change) {
            let change = step_size::size(&change, &tolerance.weights(&state, &state));
            P::CONTROL.first_step(guess, slope_size, change, span.abs())
        } else {
            guess
        };
        self.ready = Some(Ready { slope, step, level: None });
        Ok(())
    }

    /// Makes so many accepted steps, or fewer if it arrives.
    fn steps<S>(&mut self, system: &S, target: R, dense: bool, steps: u32) -> Result<(), Cause>
    where
        P: Pair<R, N, Stages = K>,
        S: System<R, N> + ?Sized,
    {
        if self.ready.is_none() {
            self.start(system, target)?;
        }
        let Self { pair, settings, origin, reached, before, ready: Some(ready), stages } = self else {
            return Ok(());
        };
        let mut room = P::room();
        let mut several = |reached: &mut Checkpoint<R, N>, ready: &mut Ready<R, N>| {
            for _ in 0..steps {
                let kept = dense.then_some((&mut *before, &mut *stages));
                step(*pair, *settings, system, (*origin, target), (reached, ready), kept, &mut room)?;
                if reached.time == target {
                    break;
                }
            }
            Ok(())
        };
        if const { is_long::<N>() } {
            return several(reached, ready);
        }
        // Copies that nobody else knows of stay in registers from step to step. In memory, slopes are written one by one
        // and read together, for which a processor waits until all that was written before is in its cache.
        let (mut here, mut next) = (*reached, *ready);
        let made = several(&mut here, &mut next);
        (*reached, *ready) = (here, next);
        made
    }
}

/// The place from which the last step was made, and its slopes, for dense output.
type Kept<'a, R, K, const N: usize> = Option<(&'a mut Checkpoint<R, N>, &'a mut Option<K>)>;

/// Makes one accepted step of a run that began at `origin`.
#[inline(always)]
fn step<P, R, S, const N: usize>(
    pair: &P,
    Settings { tolerance, max_steps, .. }: Settings,
    system: &S,
    (origin, target): (R, R),
    (reached, ready): (&mut Checkpoint<R, N>, &mut Ready<R, N>),
    kept: Kept<'_, R, P::Stages, N>,
    attempt: &mut Attempt<R, P::Stages, P::Errors, N>,
) -> Result<(), Cause>
where
    P: Pair<R, N>,
    R: Ordered,
    S: System<R, N> + ?Sized,
{
    let Ready { slope, step, level } = *ready;
    let Checkpoint { time, time_rest, state, .. } = *reached;
    let statistics = &mut reached.statistics;
    let span = ((target - time) - time_rest).to_f64();
    let shortest = step_size::shortest(time, origin);
    let mut step = if step < shortest { shortest } else { step };
    let mut rejected = false;
    loop {
        if statistics.accepted + statistics.rejected >= max_steps {
            return Err(Cause::TooManySteps { limit: max_steps });
        }
        let landing = step_size::STRETCH * step > span.abs();
        let next = if landing { target } else { time + R::from_f64(step.copysign(span)) };
        // The distance that time really moves.
        let h = (next - time) - time_rest;
        let size = h.to_f64().abs();
        // Known before the step is made, so that nothing waits for it afterwards.
        let trend = P::CONTROL.trend(level, size);
        pair.attempt(system, time, &state, &slope, h, attempt);
        statistics.evaluations += P::TRIAL;
        let margin = pair.margin(&attempt.errors, size, &tolerance.weights(&state, &attempt.guess));
        // An error beyond the range of doubles, in units of a tiny tolerance, is an error of a state that there is.
        let mut defined = all_finite(&attempt.state);
        let finite = defined && margin.is_finite();
        if finite && margin.is_enough() {
            let mut accepted = attempt.state;
            system.restore(next, &mut accepted).map_err(Cause::of_positions)?;
            let next_slope = match attempt.end {
                // Of the very state that goes on: nothing was put back.
                Some(end) if accepted == attempt.state => end,
                _ => {
                    statistics.evaluations += 1;
                    system.rhs(next, &accepted)
                }
            };
            defined = all_finite(&next_slope);
            if defined {
                let margin = margin.log2();
                let mut next_step = size * P::CONTROL.factor_after_success(margin, trend);
                if rejected {
                    next_step = next_step.min(size);
                }
                // What was asked for beyond the landing has not become wrong by the landing.
                if landing {
                    next_step = next_step.max(step);
                }
                let level = Some(P::CONTROL.level(margin, size));
                *ready = Ready { slope: next_slope, step: next_step, level };
                if let Some((before, stages)) = kept {
                    *before = *reached;
                    keep(stages, &attempt.stages);
                }
                reached.statistics.accepted += 1;
                reached.time = next;
                reached.time_rest = R::zero();
                reached.state = accepted;
                return Ok(());
            }
        }
        statistics.rejected += 1;
        rejected = true;
        let factor = if finite && defined {
            P::CONTROL.factor_after_failure(margin.log2())
        } else {
            P::CONTROL.factor_out_of_domain()
        };
        if step <= shortest {
            return Err(if defined { Cause::StepUnderflow } else { Cause::NotFinite });
        }
        step = f64::max(size * factor, shortest);
        // A step of a few spacings of numbers that ends where the one before did would be refused for ever.
        if time + R::from_f64(step.copysign(span)) == next {
            step = shortest;
        }
    }
}

// A function of its own, so that its copies of long states are not in the frame of the caller in a build without optimisation.
#[inline]
fn keep<K: Copy>(place: &mut Option<K>, stages: &K) {
    *place = Some(*stages);
}

impl<P, K, R, S, const N: usize> StepperRun<R, S, N> for Adaptive<'_, P, K, R, N>
where
    P: Pair<R, N, Stages = K>,
    K: Copy,
    R: Ordered,
    S: System<R, N> + ?Sized,
{
    const EVALUATIONS: u32 = P::TRIAL as u32;

    type Polynomial = Dense<R, N>;

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        &self.reached
    }

    fn advance(&mut self, system: &S, target: R, dense: bool) -> Result<(), Cause> {
        self.steps(system, target, dense, 1)
    }

    fn try_first(&mut self, step: f64) {
        if step > 0.0 && step.is_finite() && self.settings.first_step.is_none() {
            self.settings.first_step = Some(step);
        }
    }

    fn go_on(&mut self, system: &S, target: R, steps: u32) -> Result<(), Cause> {
        self.steps(system, target, false, steps)
    }

    fn dense(&mut self, system: &S) -> Dense<R, N> {
        let (from, to) = (&self.before, &self.reached);
        let h = to.since(from);
        let (Some(stages), Some(ready)) = (&self.stages, &self.ready) else {
            // No step was made with `dense`: there is nothing to interpolate but the present state.
            let zero = [R::zero(); N];
            return Dense::cubic(to.time, R::one(), [to.state, zero, zero, zero]);
        };
        let step = Step { from, to, stages, end: &ready.slope, h };
        let dense = self.pair.dense(system, &step);
        self.reached.statistics.evaluations += P::DENSE;
        dense
    }
}
