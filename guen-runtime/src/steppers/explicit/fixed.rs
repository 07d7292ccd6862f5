//! The part that methods with a fixed step share: where the steps begin and end, and the loop around a formula.

use crate::numbers::real::Real;
use crate::steppers::all_finite;
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::error::{Cause, Setting};
use crate::steppers::driver::run::{Checkpoint, StepperRun};
use crate::steppers::driver::statistics::Statistics;
use crate::system::System;

/// A step that is to be made.
pub(in crate::steppers) struct NextStep<'a, R, S: ?Sized, M, const N: usize> {
    pub system: &'a S,
    pub memory: &'a mut M,
    pub from: &'a Checkpoint<R, N>,
    /// The size of the step, of either sign.
    pub h: R,
    /// Whether dense output over the step, or its error, may be asked for.
    pub dense: bool,
    /// The work, which the step is added to.
    pub statistics: &'a mut Statistics,
}

/// A step that was made, from one checkpoint to another.
pub(in crate::steppers) struct LastStep<'a, R, S: ?Sized, M, const N: usize> {
    pub system: &'a S,
    pub memory: M,
    pub from: &'a Checkpoint<R, N>,
    pub to: &'a Checkpoint<R, N>,
}

/// A formula that makes one step.
pub(in crate::steppers) trait Formula<R: Real, S: ?Sized, const N: usize> {
    /// The memory of a step, for the next one and for dense output.
    type Memory: Copy;

    const EVALUATIONS: u32;

    /// The step size.
    fn step_size(&self) -> R;

    /// The memory at the beginning of a run.
    fn memory(&self) -> Self::Memory;

    /// Returns the state at the end of a step. Counts its work.
    fn step(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> Result<[R; N], Cause>;

    /// Returns the polynomial over a step of size `h` that was made.
    fn dense(
        &self,
        last: LastStep<'_, R, S, &mut Self::Memory, N>,
        h: R,
        statistics: &mut Statistics,
    ) -> Dense<R, N>;

    /// Returns the estimated error of a step that was made with `dense`: see `Defects`. Its evaluations are not counted.
    fn defect(&self, last: LastStep<'_, R, S, &Self::Memory, N>) -> [R; N];
}

/// A formula whose step is a change that is added to the state.
pub(in crate::steppers) trait Changes<R: Real, S: ?Sized, const N: usize>:
    Formula<R, S, N>
{
    /// Returns the increment that [`Formula::step`] adds to the state.
    fn change(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> [R; N];
}

/// A run with a fixed step, in legs between the times that it has to land on.
#[derive(Clone, Copy, Debug)]
pub struct Fixed<'a, F, M, R, const N: usize> {
    formula: &'a F,
    memory: M,
    step: R,
    reached: Checkpoint<R, N>,
    before: Checkpoint<R, N>,
    leg: Option<Leg<R>>,
}

impl<'a, F, M, R: Real, const N: usize> Fixed<'a, F, M, R, N> {
    pub(in crate::steppers) fn new<S: ?Sized>(formula: &'a F, start: &Checkpoint<R, N>) -> Self
    where
        F: Formula<R, S, N, Memory = M>,
    {
        let step = formula.step_size();
        Self { formula, memory: formula.memory(), step, reached: *start, before: *start, leg: None }
    }
}

impl<F, M, R, S, const N: usize> StepperRun<R, S, N> for Fixed<'_, F, M, R, N>
where
    F: Formula<R, S, N, Memory = M>,
    M: Copy,
    R: Real,
    S: System<R, N> + ?Sized,
{
    const EVALUATIONS: u32 = F::EVALUATIONS;
    const JUDGED: bool = true;

    type Polynomial = Dense<R, N>;

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        &self.reached
    }

    #[inline]
    fn is_last(&self, target: R) -> bool {
        self.leg.is_some_and(|leg| leg.is_last() && leg.target == target)
    }

    #[inline]
    fn advance(&mut self, system: &S, target: R, dense: bool) -> Result<(), Cause> {
        let Checkpoint { time: now, time_rest, .. } = self.reached;
        let leg = match &mut self.leg {
            Some(leg) if leg.target == target && leg.index < leg.count => leg,
            leg => leg.insert(Leg::new(now, target, self.step)?),
        };
        let next = leg.end();
        if next == now {
            return Err(Cause::StepUnderflow);
        }
        let h = (next - now) - time_rest;
        let mut statistics = self.reached.statistics;
        let (memory, from) = (&mut self.memory, &self.reached);
        let made =
            self.formula.step(NextStep { system, memory, from, h, dense, statistics: &mut statistics });
        self.reached.statistics = statistics;
        let mut state = made?;
        if !all_finite(&state) {
            return Err(Cause::NotFinite);
        }
        system.restore(next, &mut state).map_err(Cause::of_positions)?;
        if dense {
            self.before = self.reached;
        }
        leg.index += 1;
        self.reached.statistics.accepted += 1;
        self.reached.time = next;
        self.reached.time_rest = R::zero();
        self.reached.state = state;
        Ok(())
    }

    fn defect(&self, system: &S, before: &Checkpoint<R, N>) -> [R; N] {
        self.formula.defect(LastStep { system, memory: &self.memory, from: before, to: &self.reached })
    }

    fn dense(&mut self, system: &S) -> Dense<R, N> {
        let h = self.reached.since(&self.before);
        let mut statistics = self.reached.statistics;
        let last = LastStep { system, memory: &mut self.memory, from: &self.before, to: &self.reached };
        let dense = self.formula.dense(last, h, &mut statistics);
        self.reached.statistics = statistics;
        dense
    }
}

/// The slopes that an explicit formula knows: at the beginning of its last step, and where it stands if somebody has
/// asked for it already.
#[derive(Clone, Copy, Debug)]
pub struct Slopes<R, const N: usize> {
    pub(in crate::steppers) first: [R; N],
    pub(in crate::steppers) ahead: Option<[R; N]>,
}

impl<R: Real, const N: usize> Slopes<R, N> {
    pub(in crate::steppers) fn new() -> Self {
        Self { first: [R::zero(); N], ahead: None }
    }

    /// The slope where the next step begins, evaluated unless it is known.
    #[inline]
    pub(in crate::steppers) fn begin<S>(
        &mut self,
        system: &S,
        from: &Checkpoint<R, N>,
        statistics: &mut Statistics,
    ) -> [R; N]
    where
        S: System<R, N> + ?Sized,
    {
        self.first = match self.ahead.take() {
            Some(slope) => slope,
            None => {
                statistics.evaluations += 1;
                system.rhs(from.time, &from.state)
            }
        };
        self.first
    }

    /// The slope at the end of the last step, which the next one will begin with.
    pub(in crate::steppers) fn end<S>(
        &mut self,
        system: &S,
        to: &Checkpoint<R, N>,
        statistics: &mut Statistics,
    ) -> [R; N]
    where
        S: System<R, N> + ?Sized,
    {
        let slope = self.ahead.unwrap_or_else(|| {
            statistics.evaluations += 1;
            system.rhs(to.time, &to.state)
        });
        self.ahead = Some(slope);
        slope
    }

    /// The cubic through both ends with their slopes.
    pub(in crate::steppers) fn hermite<S>(
        &mut self,
        system: &S,
        (from, to): (&Checkpoint<R, N>, &Checkpoint<R, N>),
        h: R,
        statistics: &mut Statistics,
    ) -> Dense<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        let end = self.end(system, to, statistics);
        Dense::hermite(from.time, h, &from.state, &self.first, &to.state, &end)
    }
}

/// The method of a formula with a fixed step, and the short ways to run it.
macro_rules! fixed_step {
    ($Formula:ident over $Real:ident, systems $System:ident, memory $Memory:ty) => {
        impl<R: $Real, S: $System<R, N> + ?Sized, const N: usize> Method<R, S, N> for $Formula<R> {
            type Run<'a> = Fixed<'a, Self, $Memory, R, N>;

            fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
                Fixed::new::<S>(self, start)
            }
        }

        crate::steppers::driver::short_ways::short_ways!($Formula over $Real, systems $System);
    };
}
pub(in crate::steppers) use fixed_step;

/// The steps from one time to another: to `origin + k h` for `k = 1 .. count - 1`, then to the target. These times are rounded,
/// and a step is as long as their difference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leg<R> {
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
    pub(in crate::steppers) fn new(origin: R, target: R, step: R) -> Result<Self, Cause> {
        /// The number of steps beyond which `f64` no longer counts them one by one.
        const COUNTABLE: f64 = (1_u64 << 53) as f64;
        /// Roundings by which a span may exceed a whole number of steps without being given a further one: those
        /// of the span, of the quotient, and of the step as the user divided it.
        const SPAN_ROUNDINGS: f64 = 4.0;

        let size = step.to_f64();
        if !(step.is_finite() && size > 0.0) {
            return Err(Cause::Setting(Setting::Step));
        }
        let span = (target - origin).to_f64();
        let steps = (span / size).abs();
        if steps >= COUNTABLE || steps.is_nan() {
            return Err(Cause::StepUnderflow);
        }
        let slack = SPAN_ROUNDINGS * f64::max(R::epsilon().to_f64(), f64::EPSILON);
        let count = libm::ceil(steps * (1.0 - slack)).max(1.0) as i64;
        Ok(Self { origin, target, h: if span < 0.0 { -step } else { step }, index: 0, count })
    }

    /// Whether the next step is the last.
    #[inline(always)]
    pub(in crate::steppers) fn is_last(&self) -> bool {
        self.index + 1 == self.count
    }

    /// The end of the next step.
    #[inline(always)]
    fn end(&self) -> R {
        let index = self.index + 1;
        if index == self.count { self.target } else { self.origin + self.h * R::from_f64(index as f64) }
    }

    /// The end and the length of the next step, which is made.
    pub(in crate::steppers) fn next(&mut self, now: R) -> Result<(R, R), Cause> {
        let next = self.end();
        self.index += 1;
        if next == now { Err(Cause::StepUnderflow) } else { Ok((next, next - now)) }
    }
}
