//! Guards: what is watched while a run goes on, besides that every state is finite.
//!
//! A look is taken after the first step, then every `k` steps, with a `k` that [`Schedule`] chooses, and at the end; where a look
//! finds a fault, the run goes back to the last look that did not, so that what it returns was seen to be in order.
//!
//! An edge of the chart may be passed twice between two looks, and the functions that must not vanish are then on the side where they
//! were. So they are looked at in between, as often as their price allows, and more often while they become smaller: after half of
//! the steps that would lead to zero at this pace, then after half of the rest.

pub(crate) mod defect;
pub(crate) mod lanes;
pub(crate) mod reversal;
mod schedule;
mod singularities;

use crate::numbers::real::Real;
use crate::numbers::running_error::RunningError;
use crate::steppers::driver::error::{Cause, IntegrationError, Setting};
use crate::steppers::driver::run::{Checkpoint, StepperRun};
use crate::steppers::entries;
use crate::steppers::guard::defect::{Defects, worst};
use crate::steppers::guard::schedule::Schedule;
use crate::steppers::guard::singularities::{MAX_SINGULARITIES, distances, functions, paces, soonest};
use crate::system::System;

/// The limits that a run must not violate. A stepper checks these by default, on whatever the system tells in
/// [`System::conserved`], [`System::singularities`] and [`System::condition`], and methods with a fixed step by
/// estimates of the errors of single steps.
///
/// Every accepted state is tested to be finite. After the first step, then every [`every`](Guard::every) steps, at the end
/// of the run and before an error is returned, the guard looks at the rest; the first look looks at the start too. Where it
/// finds a fault, the run ends with the cause, and with the time and state of the last look that found none; an observer
/// has been shown the steps since then. So a run of one step is looked at twice, which can cost as much as the step: a loop
/// of such runs may take [`Guard::FINITE`], and guards of its own.
///
/// With lanes as the real every lane is looked at, with limits relative to its own energy and its own largest values, and a fault
/// of one ends the run of all; [`LaneMethod::integrate_in_lanes`](crate::steppers::LaneMethod::integrate_in_lanes) gives each lane an end of its own.
///
/// ```
/// use guen_runtime::steppers::Guard;
///
/// let strict = Guard { energy: 1e-9, every: Some(1), ..Guard::default() };
/// assert!(strict.energy < Guard::default().energy);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guard {
    /// The largest change of the energy since the start, relative to the largest scale `|T| + |U|` at the start and at
    /// the looks until now; for systems that keep their energy. By default 0.01: a run that is off by more is rarely one
    /// that somebody wants, whatever its accuracy was meant to be.
    pub energy: f64,
    /// The largest left side of a constraint on positions, relative to the size of its terms. By default 0.001: what
    /// is typed in with four digits passes.
    pub residual: f64,
    /// How far functions that are carried as states may be from what they stand for: the largest of `|w - f|/(1 + |f|)`
    /// and of what is left of `sin^2 + cos^2 - 1` and the like. By default 0.01, as for the energy.
    pub carried: f64,
    /// The distance to the edge of the chart at which to stop: what is [`left`](crate::RunningError::left) of each function that
    /// must not vanish, given that every entry of the state is uncertain by a rounding of the largest value that it has
    /// had. By default `1e-8`, where a term with its square in the denominator has no digits left in `f64`; in another
    /// real the limit is multiplied by the root of the ratio of the roundings.
    ///
    /// A look that finds another sign than at the start ends the run, whatever the limit. Two changes of sign between two looks
    /// are not seen. An adaptive method looks at these functions as often as a 160th of the run pays for, which is after every step
    /// where they cost little beside a right-hand side, and sooner while one becomes smaller. `every: Some(1)` looks after each step.
    ///
    /// A negative limit watches none of it, and neither does [`approach`](Guard::approach) then: for a motion that is meant to pass
    /// such positions, as a linkage whose bars come to lie on one line, where the state at each side is as it should be. Everything else
    /// is watched as before, the condition of the mass matrix included.
    pub singularity: f64,
    /// The largest [`condition`](System::condition) of the mass matrix. By default `1e12`, where accelerations have
    /// four digits left in `f64`; in another real the limit is divided by the ratio of the roundings.
    pub condition: f64,
    /// The largest error of methods with a fixed step, estimated at every look from one step, relative to the largest value
    /// that an entry has had, and summed up as if it stood for all steps since the last look. By default 0.05.
    /// `docs/integrators.md` has the estimate of each method. Within about 160 right-hand sides of the start what is
    /// below this part of the largest entry counts as nothing, since an entry that begins at zero has no size yet.
    pub step: f64,
    /// The largest factor by which a fixed step may change a function that must not vanish. Where it is divided by, there
    /// is a pole, and the step is too long for the motion next to it. By default 2. Not watched where [`singularity`](Guard::singularity) is
    /// negative.
    pub approach: f64,
    /// The number of steps from one check to the next, at least one; if absent, chosen by the costs of a step and of
    /// a check.
    pub every: Option<u32>,
}

impl Guard {
    /// Watches nothing but that every state is finite.
    pub const FINITE: Self = Self {
        energy: f64::INFINITY,
        residual: f64::INFINITY,
        carried: f64::INFINITY,
        singularity: 0.0,
        condition: f64::INFINITY,
        step: f64::INFINITY,
        approach: f64::INFINITY,
        every: Some(u32::MAX),
    };

    pub(super) fn is_valid(&self) -> bool {
        let Self { energy, residual, carried, singularity, condition, step, approach, .. } = *self;
        !singularity.is_nan()
            && [energy, residual, carried, condition, step, approach].iter().all(|limit| *limit >= 0.0)
    }

    /// The limits for a real: those given are meant for `f64`.
    pub(super) fn for_real<R: Real>(self) -> Self {
        let ratio = R::epsilon().to_f64() / f64::EPSILON;
        // Of a real too long for a ratio of its rounding to be one.
        let ratio = if ratio > 0.0 { ratio } else { f64::MIN_POSITIVE };
        Self { singularity: self.singularity * libm::sqrt(ratio), condition: self.condition / ratio, ..self }
    }
}

impl Default for Guard {
    fn default() -> Self {
        Self {
            energy: 1e-2,
            residual: 1e-3,
            carried: 1e-2,
            singularity: 1e-8,
            condition: 1e12,
            step: 0.05,
            approach: 2.0,
            every: None,
        }
    }
}

/// A guard at work.
pub(super) struct Watch<R, const N: usize> {
    guard: Guard,
    every: u32,
    /// Steps until the guard does something.
    until_look: u32,
    /// Steps from then until a look; zero if it is one, while otherwise only the edges are looked at.
    until_next: u32,
    /// Steps from the last look to the next one.
    between: u32,
    /// Steps after which the sizes of entries are known.
    young: u32,
    /// Whether the method has a fixed step.
    fixed: bool,
    /// Steps until the edges are looked at, at most: they are cheaper than the rest.
    until_edges: u32,
    /// Steps that were to be made since they were looked at.
    since_edges: u32,
    /// Where the last look found everything in order.
    good: Checkpoint<R, N>,
    /// The values that checks have remembered so far.
    known: Option<Known<R, N>>,
}

/// The values that checks remember, the first one from the initial state.
struct Known<R, const N: usize> {
    energy: Option<R>,
    scale: R,
    /// How many functions there are that must not vanish, what they were at the start, and what the last look has found.
    count: usize,
    start: [R; MAX_SINGULARITIES],
    functions: [RunningError<R>; MAX_SINGULARITIES],
    /// The functions at the check before the last.
    earlier: [R; MAX_SINGULARITIES],
    /// The largest absolute value of each entry of the state.
    largest: [R; N],
    defects: Defects<R, N>,
}

impl<R: Real, const N: usize> Watch<R, N> {
    pub fn new<C, S>(guard: Guard, system: &S, start: &Checkpoint<R, N>) -> Result<Self, Cause>
    where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        if !guard.is_valid() {
            return Err(Cause::Setting(Setting::Guard));
        }
        let guard = guard.for_real::<R>();
        let price = (system.check_cost(), system.singularity_check_cost());
        let Schedule { young, edges, every } = Schedule::new(C::EVALUATIONS, price, C::JUDGED, guard.every);
        let first = if every == u32::MAX { every } else { 1 };
        Ok(Self {
            guard,
            every,
            until_look: first,
            until_next: 0,
            between: first,
            young,
            fixed: C::JUDGED,
            until_edges: edges,
            since_edges: first,
            good: *start,
            known: None,
        })
    }

    /// Whether the guard will want to know where the next step began; `last` if it is the last one.
    #[inline]
    pub fn wants_before(&self, last: bool) -> bool {
        self.fixed && (last || self.until_look == 1)
    }

    /// As many steps can be made before anything has to be told.
    #[inline]
    pub fn patience(&self) -> u32 {
        if self.fixed { (self.until_look - 1).max(1) } else { self.until_look }
    }

    /// Counts the steps since `from`, no more than [`patience`](Watch::patience) allowed, and looks if it is time to;
    /// `before` is where the last one began, if that was wanted.
    #[inline]
    pub fn step<C, S>(
        &mut self,
        system: &S,
        from: u64,
        before: Option<&Checkpoint<R, N>>,
        run: &C,
    ) -> Result<(), Cause>
    where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        let made = run.checkpoint().statistics.accepted.saturating_sub(from);
        self.until_look = self.until_look.saturating_sub(u32::try_from(made).unwrap_or(u32::MAX));
        if self.until_look > 0 {
            return Ok(());
        }
        self.due(system, before, run)
    }

    #[inline(never)]
    fn due<C, S>(&mut self, system: &S, before: Option<&Checkpoint<R, N>>, run: &C) -> Result<(), Cause>
    where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        let mut rest = self.until_next;
        if rest == 0 {
            self.look(system, self.between, before, run)?;
            (self.between, rest) = (self.every, self.every);
        } else if let Some(known) = &mut self.known {
            known.look_at_edges(system, run.checkpoint(), self.guard.singularity)?;
        }
        self.until_look = match (self.approach(system, before, run.checkpoint())?, &self.known) {
            (Some(soonest), _) => rest.min(Schedule::next(self.until_edges, soonest, self.between - rest)),
            (None, Some(known)) if !self.fixed && known.count > 0 && self.until_edges < u32::MAX => {
                rest.min(self.until_edges).min(soonest(known.since_the_look_before(), self.since_edges))
            }
            (None, _) => rest,
        };
        self.since_edges = self.until_look;
        self.until_next = rest - self.until_look;
        Ok(())
    }

    /// Looks at the end of a run, unless it was just looked at.
    pub fn finish<C, S>(
        &mut self,
        system: &S,
        before: Option<&Checkpoint<R, N>>,
        run: &C,
    ) -> Result<(), Cause>
    where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        let steps = self.between - self.until_look - self.until_next;
        if steps == 0 || self.every == u32::MAX {
            return Ok(());
        }
        self.look(system, steps, before, run)?;
        self.approach(system, before, run.checkpoint()).map(|_| ())
    }

    /// The error of a run that cannot go on from where it stands: for the cause given, unless the steps since the last
    /// look went wrong before.
    pub fn stopped<C, S>(&mut self, system: &S, run: &C, cause: Cause) -> IntegrationError<R, N>
    where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        let reached = run.checkpoint();
        if reached.time == self.good.time || self.every == u32::MAX {
            return reached.failed(cause);
        }
        match self.look(system, 0, None, run) {
            Ok(()) => reached.failed(cause),
            Err(earlier) => self.good(reached).failed(earlier),
        }
    }

    /// The last time and state that were found in order, with the work done since then counted.
    pub fn good(&self, reached: &Checkpoint<R, N>) -> Checkpoint<R, N> {
        Checkpoint { statistics: reached.statistics, ..self.good }
    }

    /// In how many steps of a fixed length to look at the edges again at the latest, after they were looked at where the run
    /// stands; nothing where there are none.
    fn approach<S>(
        &self,
        system: &S,
        before: Option<&Checkpoint<R, N>>,
        reached: &Checkpoint<R, N>,
    ) -> Result<Option<u32>, Cause>
    where
        S: System<R, N> + ?Sized,
    {
        match (&self.known, before) {
            (Some(known), Some(before)) if self.fixed && known.count > 0 => {
                known.approach(system, before, reached.time.to_f64(), self.guard.approach).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// Looks at the state where the run stands, for so many steps; `before` is where the last of them began.
    #[inline(never)]
    fn look<C, S>(
        &mut self,
        system: &S,
        steps: u32,
        before: Option<&Checkpoint<R, N>>,
        run: &C,
    ) -> Result<(), Cause>
    where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        R::vectorize(
            #[inline(always)]
            || self.look_here(system, steps, before, run),
        )
    }

    #[inline(always)]
    fn look_here<C, S>(
        &mut self,
        system: &S,
        steps: u32,
        before: Option<&Checkpoint<R, N>>,
        run: &C,
    ) -> Result<(), Cause>
    where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        let Self { guard, good, known, young, .. } = self;
        let reached = run.checkpoint();
        let known = match known {
            Some(known) => known,
            None => known.insert(Known::new(system, guard, good)?),
        };
        let found = reached.time.to_f64();
        let invariants = system.conserved(reached.time, &reached.state);
        if let (Some(energy), Some(before)) = (invariants.energy, known.energy) {
            // With the scale of this state, for the start may have none: at rest, where the potential is zero. A state
            // that blew up is no larger than its own energy, so that its change is about one.
            known.scale = invariants.scale.where_above(known.scale, invariants.scale, known.scale);
            // What does not change at all is no change even of nothing.
            let change = (energy - before).abs();
            let change = change.where_above(R::zero(), change / known.scale, R::zero()).most();
            if exceeds(change, guard.energy) {
                return Err(Cause::Energy { found, change, limit: guard.energy });
            }
        }
        let condition = system.condition(reached.time, &reached.state);
        in_order(guard, found, invariants.residual.most(), condition.most())?;
        for (largest, entry) in known.largest.iter_mut().zip(&reached.state) {
            let size = entry.abs();
            *largest = size.where_above(*largest, size, *largest);
        }
        known.look_at_edges(system, reached, guard.singularity)?;
        *young = young.saturating_sub(steps);
        let limit = guard.step;
        if let Some(before) = before
            && C::JUDGED
            && limit < f64::INFINITY
        {
            let defects = run.defect(system, before);
            // In the first steps an entry that was zero has no size yet.
            let negligible = if *young > 0 { limit } else { libm::sqrt(R::epsilon().to_f64()) };
            if exceeds(known.defects.add(&defects, steps, &known.largest, negligible).most(), limit) {
                let worst = worst(&known.defects.judged(R::most));
                return Err(Cause::Step { found, entry: worst.entry, defect: worst.defect, limit });
            }
        }
        let drift = invariants.carried.most();
        if exceeds(drift, guard.carried) {
            return Err(Cause::Carried { found, drift, limit: guard.carried });
        }
        *good = *reached;
        Ok(())
    }
}

impl<R: Real, const N: usize> Known<R, N> {
    /// Looks at the start.
    fn new<S>(system: &S, guard: &Guard, start: &Checkpoint<R, N>) -> Result<Self, Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let invariants = system.conserved(start.time, &start.state);
        let found = start.time.to_f64();
        let condition = system.condition(start.time, &start.state);
        in_order(guard, found, invariants.residual.most(), condition.most())?;
        let largest = entries(|i| start.state[i].abs());
        let mut values = [RunningError::exact(R::zero()); MAX_SINGULARITIES];
        let count = R::vectorize(
            #[inline(always)]
            || functions(system, start.time, &start.state, &largest, &mut values),
        );
        let count = if guard.singularity < 0.0 { 0 } else { count };
        let known = Self {
            energy: invariants.energy,
            scale: invariants.scale,
            count,
            start: entries(|i| values[i].value),
            functions: values,
            earlier: entries(|i| values[i].value),
            largest,
            defects: Defects::new(),
        };
        known.distances(found, guard.singularity)?;
        Ok(known)
    }

    fn distances(&self, found: f64, limit: f64) -> Result<(), Cause> {
        let functions = self.functions.iter().copied().zip(self.start);
        distances(functions.take(self.count), found, limit)
    }

    /// Whether a state is on the same side of the edges as the start, and further than the limit from them.
    fn look_at_edges<S>(&mut self, system: &S, reached: &Checkpoint<R, N>, limit: f64) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        if self.count == 0 {
            return Ok(());
        }
        self.earlier = entries(|i| self.functions[i].value);
        R::vectorize(
            #[inline(always)]
            || functions(system, reached.time, &reached.state, &self.largest, &mut self.functions),
        );
        self.distances(reached.time.to_f64(), limit)
    }

    /// Returns the functions at the last two checks.
    fn since_the_look_before(&self) -> impl Iterator<Item = (R, R)> {
        self.earlier
            .iter()
            .copied()
            .zip(self.functions.iter().map(|function| function.value))
            .take(self.count)
    }

    /// In how many steps to look at the edges again, judged by the step that began at `before` and led to where they were
    /// looked at last.
    fn approach<S>(&self, system: &S, before: &Checkpoint<R, N>, found: f64, limit: f64) -> Result<u32, Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let mut from = [RunningError::exact(R::zero()); MAX_SINGULARITIES];
        R::vectorize(
            #[inline(always)]
            || functions(system, before.time, &before.state, &self.largest, &mut from),
        );
        let values = from.iter().zip(&self.functions).map(|(from, to)| (from.value, to.value));
        paces(values.take(self.count), found, limit)
    }
}

/// Tests of one state that need nothing of the states before.
pub(super) fn in_order(guard: &Guard, found: f64, residual: f64, condition: f64) -> Result<(), Cause> {
    if exceeds(residual, guard.residual) {
        return Err(Cause::Residual { found, residual, limit: guard.residual });
    }
    if exceeds(condition, guard.condition) {
        return Err(Cause::Condition { found, condition, limit: guard.condition });
    }
    Ok(())
}

/// Whether a value is above its limit, or none at all.
pub(super) fn exceeds(value: f64, limit: f64) -> bool {
    value > limit || value.is_nan()
}
