//! A guard at work: the times of its checks, the runs that it checks, and the faults that it reports.

use core::marker::PhantomData;

use crate::numbers::lanes::Mask;
use crate::numbers::real::Real;
use crate::steppers::all_finite;
use crate::steppers::driver::any_run::AnyRun;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::Checkpoint;
use crate::steppers::guard::Guard;
use crate::steppers::guard::known::{Known, TimeAndState, Watched};
use crate::steppers::guard::runs::{One, Runs};
use crate::steppers::guard::schedule::Schedule;

/// A guard at work on `V` runs that make their steps together. Each is judged as it would be alone: with the same limits, after the
/// same steps and in the same order.
pub(in crate::steppers) struct Watch<R: Real, V: Runs<R>, const N: usize> {
    guard: Guard,
    every: u32,
    /// Whether steps have a fixed length.
    fixed: bool,
    /// Steps after which the sizes of entries are known, and the part of the largest entry that counts as zero then.
    young: u32,
    negligible: f64,
    /// Steps until the next check of the functions that must not vanish, at most: they are cheaper than the rest.
    until_singularities: u32,
    /// Steps until the guard does something for one of the runs, and those that it was when it did something last.
    left: u32,
    planned: u32,
    /// Steps from when it did something last to the next check of everything, which all runs have at once, and from the last one
    /// to that.
    rest: u32,
    between: u32,
    /// The steps of each run from its last check to its next one, where they are not the same for all.
    turns: Option<V::Steps>,
    /// The moment of the last check that found everything in order.
    good: (R, [R; N]),
    known: Option<Known<R, N>>,
    runs: PhantomData<V>,
}

impl<R: Real, V: Runs<R>, const N: usize> Watch<R, V, N> {
    /// Creates a watch over steps of so many evaluations, `fixed` or not, with limits that were checked.
    pub(crate) fn new<S>(
        guard: Guard,
        system: &S,
        evaluations: u32,
        fixed: bool,
        start: TimeAndState<'_, R, N>,
    ) -> Self
    where
        S: Watched<R, N> + ?Sized,
    {
        let Schedule { young, singularities, every } =
            Schedule::new(evaluations, system.costs(), fixed, guard.every);
        let first = if every == u32::MAX { every } else { 1 };
        Self {
            guard: guard.for_real::<R>(),
            every,
            fixed,
            young,
            negligible: libm::sqrt(R::epsilon().to_f64()),
            until_singularities: singularities,
            left: first,
            planned: first,
            rest: first,
            between: first,
            turns: None,
            good: (start.time, *start.state),
            known: None,
            runs: PhantomData,
        }
    }

    /// Whether the guard will do something after the next step.
    #[inline(always)]
    pub(crate) fn is_next(&self) -> bool {
        self.left == 1
    }

    /// Whether the guard will want to know where the next step began; `last` if it is the last one.
    #[inline(always)]
    pub(crate) fn wants_before(&self, last: bool) -> bool {
        self.fixed && (last || self.is_next())
    }

    /// Returns the number of steps that can be made before the guard has to be told.
    #[inline]
    pub(crate) fn patience(&self) -> u32 {
        if self.fixed { (self.left - 1).max(1) } else { self.left }
    }

    /// Counts steps, no more than [`patience`](Watch::patience) allowed, and says whether it is time for [`check`](Watch::check).
    #[inline(always)]
    pub(crate) fn counts(&mut self, made: u32) -> bool {
        self.left = self.left.saturating_sub(made);
        self.left == 0
    }

    /// Checks what is due in the runs that are going. `before` is where the last step began, of methods with a fixed step, and
    /// `defects` estimates its errors. `fail` is told of each run with a fault: the cause, and the place where the last check found none.
    /// Returns the runs without one.
    #[inline(never)]
    pub(crate) fn check<S, D>(
        &mut self,
        system: &S,
        (before, defects): (Option<TimeAndState<'_, R, N>>, D),
        now: TimeAndState<'_, R, N>,
        mut going: Mask,
        mut fail: impl FnMut(usize, Cause, TimeAndState<'_, R, N>),
    ) -> Mask
    where
        S: Watched<R, N> + ?Sized,
        D: FnOnce() -> [R; N],
    {
        let made = self.planned;
        self.rest -= made;
        if V::COUNT > 1
            && let Some(turns) = &mut self.turns
        {
            turns.as_mut().iter_mut().for_each(|steps| *steps = steps.saturating_sub(made));
        }
        let is_whole = self.rest == 0;
        if is_whole {
            let defects = before.is_some().then_some(defects);
            self.whole(system, self.between, defects, now, &mut going, &mut fail);
            (self.between, self.rest) = (self.every, self.every);
            self.turns = None;
        }
        (self.planned, self.left) = (self.rest, self.rest);
        if self.known.as_ref().is_some_and(|known| known.count > 0) && !going.is_empty() {
            R::vectorize(
                #[inline(always)]
                || self.singularities(system, before, now, (is_whole, made), &mut going, &mut fail),
            );
        }
        going
    }

    /// Checks the functions that must not vanish, unless that was just done, and chooses when to do so again; `made` are the steps
    /// since their last check.
    #[inline(always)]
    fn singularities<S>(
        &mut self,
        system: &S,
        before: Option<TimeAndState<'_, R, N>>,
        now: TimeAndState<'_, R, N>,
        (is_done, made): (bool, u32),
        going: &mut Mask,
        fail: &mut impl FnMut(usize, Cause, TimeAndState<'_, R, N>),
    ) where
        S: Watched<R, N> + ?Sized,
    {
        let (rest, until, fixed, guard) = (self.rest, self.until_singularities, self.fixed, &self.guard);
        let Some(known) = &mut self.known else { return };
        let (found, good) = (now.time.to_f64(), TimeAndState { time: self.good.0, state: &self.good.1 });
        let mut close = R::zero();
        if !is_done {
            if !fixed {
                known.keep_singularities();
            }
            known.evaluate_singularities(system, now);
            if V::COUNT > 1 {
                close = known.close(guard.singularity);
            }
        }
        if let Some(before) = before {
            known.evaluate_before(system, before);
        }
        // A pace is that of a step of a fixed length, or of all steps since the check before, which may be long.
        let has_pace = before.is_some() || !fixed && until < u32::MAX;
        let limit = if fixed { guard.approach } else { f64::INFINITY };
        let (soonest, abrupt) = if V::COUNT > 1 { known.paces(limit) } else { (R::zero(), R::zero()) };
        let span = if fixed { 1.0 } else { f64::from(made) };
        let since = self.between - rest;
        let next = |soonest: u32| {
            rest.min(if fixed { Schedule::next(until, soonest, since) } else { until.min(soonest) })
        };
        if V::COUNT > 1 {
            // Where all may go on as long as that, none is asked by itself.
            let least = R::from_f64(f64::from(until));
            let hasty = least.where_above(soonest, R::from_f64(f64::NAN), abrupt + close);
            let patient = V::finite(hasty);
            let together = match &mut self.turns {
                Some(turns) => turns.as_mut().iter().all(|steps| *steps == 0),
                None => true,
            };
            if together && (*going - patient).is_empty() {
                let steps = next(until);
                (self.planned, self.left, self.turns) = (steps, steps, None);
                return;
            }
        }
        let suspects = |sum: R| Mask::all(V::COUNT) - V::finite(sum);
        let (close, abrupt) = if V::COUNT > 1 {
            (suspects(close), suspects(abrupt))
        } else {
            (Mask::all(usize::from(!is_done)), Mask::all(1))
        };
        let mut turns = if V::COUNT > 1 { self.turns.unwrap_or_default() } else { V::Steps::default() };
        for (run, turn) in turns.as_mut().iter_mut().enumerate() {
            if !going.contains(run) || *turn > 0 {
                continue;
            }
            let judge = || {
                if close.contains(run) {
                    known.judge_distances::<V>(found, guard.singularity, run)?;
                }
                if !has_pace {
                    return Ok(rest);
                }
                let abrupt = abrupt.contains(run);
                let pace = if abrupt { known.judge_pace::<V>(found, limit, run)? } else { soonest };
                // The least of several lanes; in the next step where that is no number.
                Ok(next(((-V::alone(-pace, run) * span) as u32).max(1)))
            };
            match judge() {
                Ok(steps) => *turn = steps,
                Err(cause) => {
                    *going = *going - Mask::from_bits(0).with(run);
                    fail(run, cause, good);
                }
            }
        }
        let steps =
            turns.as_mut().iter().filter(|turn| **turn > 0).fold(rest, |least, turn| least.min(*turn));
        (self.planned, self.left) = (steps, steps);
        if V::COUNT > 1 {
            self.turns = Some(turns);
        }
    }

    /// Checks the end of runs, unless that was just done; `step` as of [`check`](Watch::check), if it was wanted.
    #[inline(never)]
    pub(crate) fn finish<S, D>(
        &mut self,
        system: &S,
        (before, defects): (Option<TimeAndState<'_, R, N>>, D),
        now: TimeAndState<'_, R, N>,
        mut going: Mask,
        mut fail: impl FnMut(usize, Cause, TimeAndState<'_, R, N>),
    ) where
        S: Watched<R, N> + ?Sized,
        D: FnOnce() -> [R; N],
    {
        let steps = self.between - (self.rest - (self.planned - self.left));
        if steps == 0 || self.every == u32::MAX {
            return;
        }
        let defects = before.is_some().then_some(defects);
        self.whole(system, steps, defects, now, &mut going, &mut fail);
        let Self { guard, known: Some(known), good, .. } = self else { return };
        let Some(before) = before.filter(|_| known.count > 0) else { return };
        let (found, good) = (now.time.to_f64(), TimeAndState { time: good.0, state: &good.1 });
        R::vectorize(
            #[inline(always)]
            || {
                known.evaluate_before(system, before);
                let steady =
                    if V::COUNT > 1 { V::finite(known.paces(guard.approach).1) } else { Mask::all(0) };
                for run in (going - steady).lanes() {
                    if let Err(cause) = known.judge_pace::<V>(found, guard.approach, run) {
                        fail(run, cause, good);
                    }
                }
            },
        );
    }

    /// Tells the faults of runs that cannot go on from where they stand: the cause given, unless the steps since the last check went
    /// wrong before. Other runs are not checked.
    #[cold]
    #[inline(never)]
    pub(crate) fn stopped<S>(
        &mut self,
        system: &S,
        now: TimeAndState<'_, R, N>,
        stopped: Mask,
        cause: Cause,
        mut fail: impl FnMut(usize, Cause, TimeAndState<'_, R, N>),
    ) where
        S: Watched<R, N> + ?Sized,
    {
        let mut rest = stopped;
        if now.time != self.good.0 && self.every != u32::MAX {
            let before = (self.known, self.good, self.young);
            self.whole(system, 0, None::<fn() -> [R; N]>, now, &mut rest, &mut fail);
            (self.known, self.good, self.young) = before;
        }
        for run in rest.lanes() {
            fail(run, cause, now);
        }
    }

    /// Checks everything, for so many steps, and takes the runs with a fault out of `going`.
    #[inline(never)]
    fn whole<S, D>(
        &mut self,
        system: &S,
        steps: u32,
        defects: Option<D>,
        now: TimeAndState<'_, R, N>,
        going: &mut Mask,
        fail: &mut impl FnMut(usize, Cause, TimeAndState<'_, R, N>),
    ) where
        S: Watched<R, N> + ?Sized,
        D: FnOnce() -> [R; N],
    {
        let Self { guard, fixed, young, negligible, good, known, .. } = self;
        *young = young.saturating_sub(steps);
        // In the first steps an entry that was zero has no size yet.
        let negligible = if *young > 0 { guard.step } else { *negligible };
        R::vectorize(
            #[inline(always)]
            || {
                let place = TimeAndState { time: good.0, state: &good.1 };
                if known.is_none() {
                    let (begun, check) = Known::new(system, guard, place);
                    for run in (*going & begun.suspects::<V>(guard, &check)).lanes() {
                        if let Err(cause) = begun.judge::<V>(guard, &check, place.time.to_f64(), run) {
                            *going = *going - Mask::from_bits(0).with(run);
                            fail(run, cause, place);
                        }
                    }
                    *known = Some(begun);
                }
                let Some(known) = known else { return };
                let defects = defects.filter(|_| guard.step < f64::INFINITY).map(|defects| defects());
                if !*fixed {
                    known.keep_singularities();
                }
                let check = known.check(system, now, defects, steps, negligible);
                let suspects = *going & known.suspects::<V>(guard, &check);
                for run in suspects.lanes() {
                    if let Err(cause) = known.judge::<V>(guard, &check, now.time.to_f64(), run) {
                        *going = *going - Mask::from_bits(0).with(run);
                        fail(run, cause, place);
                    }
                }
            },
        );
        if !going.is_empty() {
            *good = (now.time, *now.state);
        }
    }
}

/// The place of a checkpoint.
fn place<R: Real, const N: usize>(at: &Checkpoint<R, N>) -> TimeAndState<'_, R, N> {
    TimeAndState { time: at.time, state: &at.state }
}

impl<R: Real, const N: usize> Watch<R, One, N> {
    /// Creates a watch over one run of a method.
    pub(crate) fn of_run(guard: Guard, run: &dyn AnyRun<R, N>) -> Self {
        Self::new(guard, run.system(), run.evaluations(), run.is_judged(), place(run.checkpoint()))
    }

    /// Counts the steps since `from`, and checks if it is time to; `before` is where the last one began, if that was wanted. Writes the
    /// end of a run that cannot go on.
    #[inline]
    pub(crate) fn step(
        &mut self,
        from: u64,
        before: Option<&Checkpoint<R, N>>,
        run: &dyn AnyRun<R, N>,
        end: &mut Checkpoint<R, N>,
    ) -> Result<(), Cause> {
        let reached = run.checkpoint();
        let made = reached.statistics.accepted.saturating_sub(from);
        if !self.counts(u32::try_from(made).unwrap_or(u32::MAX)) {
            return Ok(());
        }
        let mut fault = Cause::NotFinite;
        let (step, now) = (last(before.filter(|_| self.fixed), run), place(reached));
        let going = self.check(run.system(), step, now, Mask::all(1), |_, cause, _| fault = cause);
        if !going.is_empty() {
            return Ok(());
        }
        self.failed(run.checkpoint(), end);
        Err(fault)
    }

    /// Checks the end of the run. Writes the place that was found in order last, if there is a fault.
    pub(crate) fn finish_run(
        &mut self,
        before: Option<&Checkpoint<R, N>>,
        run: &dyn AnyRun<R, N>,
        end: &mut Checkpoint<R, N>,
    ) -> Result<(), Cause> {
        let mut judged = Ok(());
        let (step, now) = (last(before.filter(|_| self.fixed), run), place(run.checkpoint()));
        self.finish(run.system(), step, now, Mask::all(1), |_, cause, _| judged = Err(cause));
        if judged.is_err() {
            self.failed(run.checkpoint(), end);
        }
        judged
    }

    /// Writes the end of the run, which cannot go on from where it stands, and returns the cause.
    pub(crate) fn stop_run(
        &mut self,
        run: &dyn AnyRun<R, N>,
        cause: Cause,
        end: &mut Checkpoint<R, N>,
    ) -> Cause {
        let (system, now) = (run.system(), place(run.checkpoint()));
        let mut found = cause;
        *end = *run.checkpoint();
        self.stopped(system, now, Mask::all(1), cause, |_, cause, good| {
            found = cause;
            (end.time, end.state) = (good.time, *good.state);
        });
        if found == Cause::NotFinite && end.statistics.accepted == 0 && all_finite(&end.state) {
            // What is not finite at a start that is so, is so because of a function that vanishes there, if there is one.
            let (known, _) = Known::new(system, &self.guard, now);
            if let Some(function) = known.vanishing() {
                let limit = self.guard.singularity;
                return Cause::ChartSingularity { found: end.time.to_f64(), function, distance: 0.0, limit };
            }
        }
        found
    }

    /// Writes the place that was found in order last, with the work done since then counted.
    #[cold]
    fn failed(&self, reached: &Checkpoint<R, N>, end: &mut Checkpoint<R, N>) {
        (end.time, end.state) = self.good;
        end.statistics = reached.statistics;
    }
}

/// Returns the beginning of the last step, and the estimate of its errors.
#[inline(always)]
fn last<'a, R: Real, const N: usize>(
    before: Option<&'a Checkpoint<R, N>>,
    run: &'a dyn AnyRun<R, N>,
) -> (Option<TimeAndState<'a, R, N>>, impl FnOnce() -> [R; N]) {
    (before.map(place), move || before.map_or([R::zero(); N], |before| run.defect(before)))
}
