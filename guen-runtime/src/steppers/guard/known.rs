//! The values that a guard's checks remember of its runs, and the judgement of the runs by them.

use core::ops::Range;

use crate::numbers::lanes::Mask;
use crate::numbers::real::Real;
use crate::numbers::running_error::RunningError;
use crate::steppers::driver::error::Cause;
use crate::steppers::entries;
use crate::steppers::guard::Guard;
use crate::steppers::guard::defect::{Defects, Worst, worst};
use crate::steppers::guard::runs::Runs;
use crate::system::System;
use crate::system::check_costs::CheckCosts;
use crate::system::guarded::Guarded;
use crate::system::invariants::Invariants;

/// The number of functions that are watched; further ones are not.
const MAX_SINGULARITIES: usize = 16;

/// A time and the state there.
#[derive(Clone, Copy)]
pub(in crate::steppers) struct TimeAndState<'a, R, const N: usize> {
    pub time: R,
    pub state: &'a [R; N],
}

/// The functions that must not vanish.
type Functions<R> = [RunningError<R>; MAX_SINGULARITIES];

/// A system as a guard asks it: all at once, so that expressions that a check has in common are computed once, however the system is
/// referred to.
pub(in crate::steppers) trait Watched<R: Real, const N: usize> {
    /// The costs of a check.
    fn costs(&self) -> CheckCosts;

    /// The invariants and the condition, and the functions that must not vanish as of [`functions`](Watched::functions), with their number.
    fn everything(
        &self,
        place: TimeAndState<'_, R, N>,
        largest: &[R; N],
        into: &mut Functions<R>,
    ) -> Found<R>;

    /// Writes the functions that must not vanish, where every entry is uncertain by a rounding of the largest value it has had, and
    /// returns how many they are.
    fn functions(&self, place: TimeAndState<'_, R, N>, largest: &[R; N], into: &mut Functions<R>) -> usize;
}

/// The answer of a system.
pub(in crate::steppers) struct Found<R> {
    invariants: Invariants<R>,
    condition: R,
    /// The number of functions that must not vanish.
    count: usize,
}

impl<R: Real, S: System<R, N> + ?Sized, const N: usize> Watched<R, N> for S {
    fn costs(&self) -> CheckCosts {
        self.guarded().check_costs()
    }

    #[inline]
    fn everything(
        &self,
        place: TimeAndState<'_, R, N>,
        largest: &[R; N],
        into: &mut Functions<R>,
    ) -> Found<R> {
        R::vectorize(
            #[inline(always)]
            || {
                let asked = self.guarded();
                let invariants = asked.conserved(place.time, place.state);
                let condition = asked.condition(place.time, place.state);
                Found { invariants, condition, count: self.functions(place, largest, into) }
            },
        )
    }

    #[inline]
    fn functions(&self, place: TimeAndState<'_, R, N>, largest: &[R; N], into: &mut Functions<R>) -> usize {
        R::vectorize(
            #[inline(always)]
            || {
                let mut rounded = [RunningError::exact(place.time); N];
                for ((entry, value), error) in rounded.iter_mut().zip(place.state).zip(largest) {
                    *entry = RunningError { value: *value, error: *error };
                }
                self.guarded()
                    .singularities(RunningError::once(place.time), &rounded, into)
                    .min(MAX_SINGULARITIES)
            },
        )
    }
}

/// The values that checks remember, the first one from the initial state.
#[derive(Clone, Copy)]
pub(super) struct Known<R, const N: usize> {
    energy: Option<R>,
    scale: R,
    /// The number of functions that must not vanish.
    pub count: usize,
    /// The functions at the start, at the last check, and before that: where the last step began, if it has a fixed length, else
    /// at the check before.
    start: [R; MAX_SINGULARITIES],
    functions: Functions<R>,
    earlier: Functions<R>,
    /// The largest absolute value of each entry of the state.
    largest: [R; N],
    defects: Defects<R, N>,
}

/// The result of a check.
pub(super) struct Check<R> {
    invariants: Invariants<R>,
    condition: R,
    /// The change of the energy, relative to its scale.
    change: R,
    /// The largest estimated error of an entry.
    defect: R,
}

impl<R: Real, const N: usize> Known<R, N> {
    /// Starts from a state, and returns what the first check finds there.
    pub(super) fn new<S>(system: &S, guard: &Guard, start: TimeAndState<'_, R, N>) -> (Self, Check<R>)
    where
        S: Watched<R, N> + ?Sized,
    {
        let nothing = [RunningError::exact(R::zero()); MAX_SINGULARITIES];
        let mut functions = nothing;
        let largest = entries(|i| start.state[i].abs());
        let Found { invariants, condition, count } = system.everything(start, &largest, &mut functions);
        let known = Self {
            energy: invariants.energy,
            scale: invariants.scale,
            count: if guard.singularity < 0.0 { 0 } else { count },
            start: entries(|i| functions[i].value),
            functions,
            earlier: nothing,
            largest,
            defects: Defects::new(),
        };
        let (change, defect, carried) = (R::zero(), R::zero(), R::zero());
        (known, Check { invariants: Invariants { carried, ..invariants }, condition, change, defect })
    }

    /// The functions that must not vanish. Zipped iterators with a count take forty instructions more in each check.
    #[inline(always)]
    fn watched(&self) -> Range<usize> {
        0..self.count.min(MAX_SINGULARITIES)
    }

    /// Returns the first of the functions that must not vanish that is zero.
    pub(super) fn vanishing(&self) -> Option<usize> {
        self.watched().find(|function| self.functions[*function].value.to_f64() == 0.0)
    }

    /// Checks everything, the functions that must not vanish for [`close`](Known::close) and others to judge. `defects` are the
    /// estimated errors of a step, taken for those of `steps` of them.
    #[inline(always)]
    pub(super) fn check<S>(
        &mut self,
        system: &S,
        now: TimeAndState<'_, R, N>,
        defects: Option<[R; N]>,
        steps: u32,
        negligible: f64,
    ) -> Check<R>
    where
        S: Watched<R, N> + ?Sized,
    {
        let zero = R::zero();
        for (largest, entry) in self.largest.iter_mut().zip(now.state) {
            let size = entry.abs();
            *largest = size.where_above(*largest, size, *largest);
        }
        let Found { invariants, condition, .. } = system.everything(now, &self.largest, &mut self.functions);
        let change = match (invariants.energy, self.energy) {
            (Some(energy), Some(before)) => {
                // With the scale of this state, for the start may have none: at rest, where the potential is zero. A state
                // that blew up is no larger than its own energy, so that its change is about one.
                self.scale = invariants.scale.where_above(self.scale, invariants.scale, self.scale);
                // What does not change at all is no change even of nothing.
                let change = (energy - before).abs();
                change.where_above(zero, change / self.scale, zero)
            }
            _ => zero,
        };
        let defect = match &defects {
            Some(found) => self.defects.add(found, steps, &self.largest, negligible),
            None => zero,
        };
        Check { invariants, condition, change, defect }
    }

    /// The runs that may have a fault, by what a check has found.
    #[inline(always)]
    pub(super) fn suspects<V: Runs<R>>(&self, guard: &Guard, check: &Check<R>) -> Mask {
        if V::COUNT == 1 {
            return Mask::all(1);
        }
        let Check { invariants, condition, change, defect } = check;
        let sum = above(*change, guard.energy)
            + above(invariants.residual, guard.residual)
            + above(*condition, guard.condition)
            + above(*defect, guard.step)
            + above(invariants.carried, guard.carried);
        Mask::all(V::COUNT) - V::finite(sum + self.close(guard.singularity))
    }

    /// Judges a run by what a check has found.
    #[inline(always)]
    pub(super) fn judge<V: Runs<R>>(
        &self,
        guard: &Guard,
        check: &Check<R>,
        found: f64,
        run: usize,
    ) -> Result<(), Cause> {
        let change = V::alone(check.change, run);
        if exceeds(change, guard.energy) {
            return Err(Cause::Energy { found, change, limit: guard.energy });
        }
        let residual = V::alone(check.invariants.residual, run);
        if exceeds(residual, guard.residual) {
            return Err(Cause::Residual { found, residual, limit: guard.residual });
        }
        let condition = V::alone(check.condition, run);
        if exceeds(condition, guard.condition) {
            return Err(Cause::Condition { found, condition, limit: guard.condition });
        }
        self.judge_distances::<V>(found, guard.singularity, run)?;
        let limit = guard.step;
        if exceeds(V::alone(check.defect, run), limit) {
            let Worst { entry, defect } = worst(&self.defects.judged(|entry| V::alone(entry, run)));
            return Err(Cause::Step { found, entry, defect, limit });
        }
        let (drift, limit) = (V::alone(check.invariants.carried, run), guard.carried);
        if exceeds(drift, limit) { Err(Cause::Carried { found, drift, limit }) } else { Ok(()) }
    }

    /// Evaluates the functions that must not vanish.
    #[inline(always)]
    pub(super) fn evaluate_singularities<S>(&mut self, system: &S, now: TimeAndState<'_, R, N>)
    where
        S: Watched<R, N> + ?Sized,
    {
        system.functions(now, &self.largest, &mut self.functions);
    }

    /// Keeps their values for the next check to compare with.
    #[inline(always)]
    pub(super) fn keep_singularities(&mut self) {
        for function in self.watched() {
            self.earlier[function] = self.functions[function];
        }
    }

    /// Evaluates them where the last step began.
    #[inline(always)]
    pub(super) fn evaluate_before<S>(&mut self, system: &S, before: TimeAndState<'_, R, N>)
    where
        S: Watched<R, N> + ?Sized,
    {
        system.functions(before, &self.largest, &mut self.earlier);
    }

    /// NaN in the runs in which one may have come too close to zero, else zero.
    #[inline(always)]
    pub(super) fn close(&self, limit: f64) -> R {
        let (zero, nan) = (R::zero(), R::from_f64(f64::NAN));
        let mut sum = zero;
        for function in self.watched() {
            let (now, start) = (&self.functions[function], self.start[function]);
            let left = now.left();
            // One that is exact is judged by itself as well, and so is one that is no number.
            sum += left * zero
                + left.where_above(R::from_f64(limit), zero, nan)
                + (now.value * start).where_above(zero, zero, nan);
        }
        sum
    }

    /// Whether the functions of a run are on the same side as at the start, and further than the limit from zero.
    #[inline(always)]
    pub(super) fn judge_distances<V: Runs<R>>(
        &self,
        found: f64,
        limit: f64,
        run: usize,
    ) -> Result<(), Cause> {
        for function in self.watched() {
            let near = nearness(&self.functions[function], self.start[function]);
            let distance = -V::alone(near, run);
            if distance <= limit || distance.is_nan() {
                return Err(Cause::ChartSingularity { found, function, distance, limit });
            }
        }
        Ok(())
    }

    /// The number of times of what lies between before and now after which to check them again: half of what would lead the
    /// nearest to zero at this pace. And what is NaN in the runs in which a function may have changed by more than a factor, else zero.
    #[inline(always)]
    pub(super) fn paces(&self, limit: f64) -> (R, R) {
        let mut sum = R::zero();
        let mut soonest = R::from_f64(f64::from(u32::MAX));
        for function in self.watched() {
            let (from, to) = (self.earlier[function].value.abs(), self.functions[function].value.abs());
            sum += above(from / to, limit) + above(to / from, limit);
            soonest = sooner(from, to, soonest);
        }
        (soonest, sum)
    }

    /// The number of times until the next check of one run, as of [`paces`](Known::paces). An error where a function changed by more
    /// than a factor: what divides by it is a pole that such steps do not resolve.
    #[inline(always)]
    pub(super) fn judge_pace<V: Runs<R>>(&self, found: f64, limit: f64, run: usize) -> Result<R, Cause> {
        let mut soonest = R::from_f64(f64::from(u32::MAX));
        for function in self.watched() {
            let (from, to) = (self.earlier[function].value.abs(), self.functions[function].value.abs());
            if limit < f64::INFINITY {
                let (down, up) = (from / to, to / from);
                let ratio = down.where_above(up, down, up);
                // Of two zeros there is no ratio.
                let ratio = V::alone((-ratio).where_above(R::zero(), R::zero(), ratio), run);
                if ratio > limit {
                    return Err(Cause::ApproachingSingularity { found, function, ratio, limit });
                }
            }
            soonest = sooner(from, to, soonest);
        }
        Ok(soonest)
    }
}

/// The sooner of a number of steps and half of those after which a function that went from one value to another is zero.
#[inline(always)]
fn sooner<R: Real>(from: R, to: R, soonest: R) -> R {
    let steps = from.where_above(to, R::from_ratio(1, 2) * to / (from - to), soonest);
    soonest.where_above(steps, steps, soonest)
}

/// The distance of a function from zero with the other sign, so that what is too close is above a limit: positive on the other side
/// than at the start.
#[inline(always)]
fn nearness<R: Real>(now: &RunningError<R>, start: R) -> R {
    let left = now.left();
    let same = now.value.where_above(R::zero(), start, -start);
    same.where_above(R::zero(), -left, left)
}

/// NaN where a value is above its limit or no number, zero elsewhere.
#[inline(always)]
fn above<R: Real>(value: R, limit: f64) -> R {
    value.where_above(R::from_f64(limit), R::from_f64(f64::NAN), R::zero())
}

/// Whether a value is above its limit, or none at all.
fn exceeds(value: f64, limit: f64) -> bool {
    value > limit || value.is_nan()
}
