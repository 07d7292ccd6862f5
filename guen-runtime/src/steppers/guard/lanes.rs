//! The guard of runs in lanes: it judges every lane as [`Watch`](crate::steppers::guard::Watch) judges a run alone, with the same limits,
//! after the same steps and in the same order, so that a lane ends with the error that it would have had alone.
//!
//! What is looked at is computed and compared with the limits in all lanes at once; where a lane could be beyond one of them, that
//! lane is judged alone.

use crate::numbers::lanes::{Lanes, Mask};
use crate::numbers::running_error::RunningError;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::Checkpoint;
use crate::steppers::entries;
use crate::steppers::guard::defect::{Defects, Worst, worst};
use crate::steppers::guard::schedule::Schedule;
use crate::steppers::guard::singularities::{MAX_SINGULARITIES, distances, functions, paces};
use crate::steppers::guard::{Guard, exceeds, in_order};
use crate::system::System;

/// The most lanes that there are.
pub(in crate::steppers) const MOST: usize = 8;

/// A time and the states in all lanes.
#[derive(Clone, Copy)]
pub(in crate::steppers) struct Moment<L, const N: usize> {
    pub time: f64,
    pub state: [L; N],
}

impl<L: Lanes, const N: usize> Moment<L, N> {
    pub fn checkpoint(&self) -> Checkpoint<L, N> {
        Checkpoint::new(L::from_f64(self.time), &self.state)
    }

    /// The state in one lane.
    pub fn alone(&self, lane: usize) -> [f64; N] {
        entries(|i| self.state[i].lane(lane))
    }
}

/// A fault of a lane: what is the matter, and the last time and state that were in order.
#[derive(Clone, Copy)]
pub(in crate::steppers) struct Fault<const N: usize> {
    pub cause: Cause,
    pub time: f64,
    pub state: [f64; N],
}

impl<const N: usize> Fault<N> {
    pub fn new<L: Lanes>(lane: usize, cause: Cause, good: &Moment<L, N>) -> Self {
        Self { cause, time: good.time, state: good.alone(lane) }
    }
}

/// The faults of the lanes that have one.
pub(in crate::steppers) struct Faults<const N: usize> {
    pub lanes: Mask,
    pub of: [Option<Fault<N>>; MOST],
}

impl<const N: usize> Faults<N> {
    fn none() -> Self {
        Self { lanes: Mask::all(0), of: [None; MOST] }
    }

    /// They are no longer of interest.
    fn forget(&mut self) {
        self.lanes = Mask::all(0);
    }

    fn add<L: Lanes>(&mut self, lane: usize, cause: Cause, good: &Moment<L, N>) {
        self.lanes = self.lanes.with(lane);
        self.of[lane] = Some(Fault::new(lane, cause, good));
    }
}

/// A guard at work.
pub(in crate::steppers) struct LaneWatch<L, const N: usize> {
    guard: Guard,
    every: u32,
    /// Steps after which the sizes of entries are known.
    young: u32,
    /// Steps until the edges are looked at.
    until_edges: u32,
    /// Steps made since the guard did something, and those after which it does something again, for one of the lanes.
    made: u32,
    due: u32,
    /// For each lane, steps from when the guard did something last; where they are the same for all, none but `due`.
    until: Option<[u32; MOST]>,
    /// The number of steps until the next check, which all lanes have at once, and the steps between the last one and
    /// that.
    rest: u32,
    between: u32,
    /// Where the last look found everything in order, in lanes that are going.
    good: Moment<L, N>,
    known: Option<Known<L, N>>,
    /// The faults that the last call has found.
    pub faults: Faults<N>,
}

/// The values that checks remember, the first one from the initial state.
#[derive(Clone, Copy)]
struct Known<L, const N: usize> {
    energy: Option<L>,
    scale: L,
    /// How many functions there are that must not vanish.
    count: usize,
    /// The functions at the start, at the last check, and a step before that.
    start: [L; MAX_SINGULARITIES],
    functions: [RunningError<L>; MAX_SINGULARITIES],
    before: [RunningError<L>; MAX_SINGULARITIES],
    /// The largest absolute value of each entry of the state.
    largest: [L; N],
    defects: Defects<L, N>,
}

impl<L: Lanes, const N: usize> LaneWatch<L, N> {
    pub fn new(guard: Guard, evaluations: u32, price: (u32, f64), start: &Moment<L, N>) -> Self {
        let Schedule { young, edges, every } = Schedule::new(evaluations, price, true, guard.every);
        let first = if every == u32::MAX { every } else { 1 };
        Self {
            guard: guard.for_real::<L>(),
            every,
            young,
            until_edges: edges,
            made: 0,
            due: first,
            until: None,
            rest: first,
            between: first,
            good: *start,
            known: None,
            faults: Faults::none(),
        }
    }

    /// Whether the guard will want to know where the next step began.
    #[inline(always)]
    pub fn wants_before(&self) -> bool {
        self.made + 1 == self.due
    }

    /// Counts a step, and says whether it is time for [`look`](LaneWatch::look).
    #[inline(always)]
    pub fn counts(&mut self) -> bool {
        self.made += 1;
        self.made == self.due
    }

    /// Looks at what is due. `defects` are the estimated errors of the step that began at `before`.
    #[inline(never)]
    pub fn look<S: System<L, N> + ?Sized>(
        &mut self,
        system: &S,
        before: &Moment<L, N>,
        now: &Moment<L, N>,
        defects: impl FnOnce() -> [L; N],
        going: Mask,
    ) {
        self.faults.forget();
        self.rest -= self.rest.min(self.made);
        if let Some(until) = &mut self.until {
            for until in until {
                *until -= (*until).min(self.made);
            }
        }
        self.made = 0;
        let is_whole = self.rest == 0;
        if is_whole {
            let defects = (self.guard.step < f64::INFINITY).then(defects);
            self.whole(system, self.between, defects, now, going);
            (self.between, self.rest) = (self.every, self.every);
            self.until = None;
        }
        let Self { guard, known, faults, until, rest, until_edges, good, due, between, .. } = self;
        *due = *rest;
        let Some(known) = known.as_mut().filter(|known| known.count > 0) else { return };
        // What a whole look has judged is not judged again.
        let (suspects, soonest, patient) = L::vectorize(
            #[inline(always)]
            || {
                let suspects =
                    if is_whole { Mask::all(0) } else { known.look_at_edges(system, now, guard.singularity) };
                let (soonest, patient) = known.paces(system, before, guard.approach, *until_edges);
                (suspects, soonest, patient)
            },
        );
        let since = *between - *rest;
        let next = |soonest: u32| (*rest).min(Schedule::next(*until_edges, soonest, since));
        let lanes = going - faults.lanes;
        let together = until.is_none_or(|until| lanes.lanes().all(|lane| until[lane] == 0));
        if together && (lanes - patient).is_empty() && (lanes & suspects).is_empty() {
            (*due, *until) = (next(*until_edges), None);
            return;
        }
        let mut apart = until.unwrap_or([0; MOST]);
        for lane in lanes.lanes() {
            if apart[lane] > 0 {
                continue;
            }
            let distances = if suspects.contains(lane) {
                known.distances(lane, now.time, guard.singularity)
            } else {
                Ok(())
            };
            match distances.and_then(|()| known.pace(lane, soonest, now.time, guard.approach)) {
                Ok(soonest) => apart[lane] = next(soonest),
                Err(cause) => faults.add(lane, cause, good),
            }
        }
        *due = apart.into_iter().filter(|until| *until > 0).fold(*rest, u32::min);
        *until = Some(apart);
    }

    /// Looks at the end of a run, unless it was just looked at. The last step began at `before`, with these estimated errors,
    /// unless nobody has asked for that.
    #[inline(never)]
    pub fn finish<S: System<L, N> + ?Sized>(
        &mut self,
        system: &S,
        before: Option<&Moment<L, N>>,
        now: &Moment<L, N>,
        defects: impl FnOnce() -> [L; N],
        going: Mask,
    ) {
        self.faults.forget();
        let steps = (self.between - self.rest).saturating_add(self.made);
        if steps == 0 || self.every == u32::MAX {
            return;
        }
        let judged = before.is_some() && self.guard.step < f64::INFINITY;
        self.whole(system, steps, judged.then(defects), now, going);
        let Self { guard, known, faults, good, .. } = self;
        if let (Some(known), Some(before)) = (known, before)
            && known.count > 0
        {
            let (soonest, patient) = L::vectorize(
                #[inline(always)]
                || known.paces(system, before, guard.approach, 1),
            );
            for lane in (going - faults.lanes - patient).lanes() {
                if let Err(cause) = known.pace(lane, soonest, now.time, guard.approach) {
                    faults.add(lane, cause, good);
                }
            }
        }
    }

    /// The faults of lanes that cannot go on from where they stand: for the cause given, unless the steps since the last look
    /// went wrong before. Of the other lanes nothing is learned.
    #[cold]
    #[inline(never)]
    pub fn stopped<S: System<L, N> + ?Sized>(
        &mut self,
        system: &S,
        now: &Moment<L, N>,
        stopped: Mask,
        cause: Cause,
    ) {
        self.faults.forget();
        if now.time != self.good.time && self.every != u32::MAX {
            let before = (self.known, self.good, self.young);
            self.whole(system, 0, None, now, stopped);
            (self.known, self.good, self.young) = before;
        }
        for lane in (stopped - self.faults.lanes).lanes() {
            self.faults.add(lane, cause, now);
        }
    }

    /// Looks at everything, for so many steps.
    fn whole<S: System<L, N> + ?Sized>(
        &mut self,
        system: &S,
        steps: u32,
        defects: Option<[L; N]>,
        now: &Moment<L, N>,
        lanes: Mask,
    ) {
        let Self { guard, good, known, young, faults, .. } = self;
        let known = match known {
            Some(known) => known,
            None => known.insert(Known::new(system, guard, good, lanes, faults)),
        };
        *young = young.saturating_sub(steps);
        // In the first steps an entry that was zero has no size yet.
        let negligible = if *young > 0 { guard.step } else { libm::sqrt(f64::EPSILON) };
        let time = L::from_f64(now.time);
        let (invariants, condition, change, most, suspects) = L::vectorize(
            #[inline(always)]
            || {
                let invariants = system.conserved(time, &now.state);
                let condition = system.condition(time, &now.state);
                known.scale = invariants.scale.where_above(known.scale, invariants.scale, known.scale);
                let change = match (invariants.energy, known.energy) {
                    (Some(energy), Some(before)) => (energy - before).abs(),
                    _ => L::zero(),
                };
                let change = change.where_above(L::zero(), change / known.scale, L::zero());
                for i in 0..N {
                    let (before, size) = (known.largest[i], now.state[i].abs());
                    known.largest[i] = size.where_above(before, size, before);
                }
                let most = match &defects {
                    Some(found) => known.defects.add(found, steps, &known.largest, negligible),
                    None => L::zero(),
                };
                let suspects = above(change, guard.energy)
                    + above(invariants.residual, guard.residual)
                    + above(condition, guard.condition)
                    + above(most, guard.step)
                    + above(invariants.carried, guard.carried);
                let mut suspects = Mask::all(L::COUNT) - suspects.finite();
                if known.count > 0 {
                    suspects = suspects.or(known.look_at_edges(system, now, guard.singularity));
                }
                (invariants, condition, change, most, suspects)
            },
        );
        let found = now.time;
        for lane in ((lanes - faults.lanes) & suspects).lanes() {
            let judge = || {
                let change = change.lane(lane);
                if exceeds(change, guard.energy) {
                    return Err(Cause::Energy { found, change, limit: guard.energy });
                }
                in_order(guard, found, invariants.residual.lane(lane), condition.lane(lane))?;
                known.distances(lane, found, guard.singularity)?;
                let limit = guard.step;
                if exceeds(most.lane(lane), limit) {
                    let Worst { entry, defect } = worst(&known.defects.judged(|entry| entry.lane(lane)));
                    return Err(Cause::Step { found, entry, defect, limit });
                }
                let (drift, limit) = (invariants.carried.lane(lane), guard.carried);
                if exceeds(drift, limit) { Err(Cause::Carried { found, drift, limit }) } else { Ok(()) }
            };
            if let Err(cause) = judge() {
                faults.add(lane, cause, good);
            }
        }
        *good = *now;
    }
}

/// NaN in the lanes that are above the limit or no number, zero elsewhere.
#[inline(always)]
fn above<L: Lanes>(value: L, limit: f64) -> L {
    value.where_above(L::from_f64(limit), L::from_f64(f64::NAN), L::zero())
}

impl<L: Lanes, const N: usize> Known<L, N> {
    /// Looks at the start.
    fn new<S: System<L, N> + ?Sized>(
        system: &S,
        guard: &Guard,
        start: &Moment<L, N>,
        lanes: Mask,
        faults: &mut Faults<N>,
    ) -> Self {
        let time = L::from_f64(start.time);
        let invariants = system.conserved(time, &start.state);
        let condition = system.condition(time, &start.state);
        let largest = entries(|i| start.state[i].abs());
        let mut functions_there = [RunningError::exact(L::zero()); MAX_SINGULARITIES];
        let count = L::vectorize(
            #[inline(always)]
            || functions(system, time, &start.state, &largest, &mut functions_there),
        );
        let count = if guard.singularity < 0.0 { 0 } else { count };
        let known = Self {
            energy: invariants.energy,
            scale: invariants.scale,
            count,
            start: entries(|i| functions_there[i].value),
            functions: functions_there,
            before: functions_there,
            largest,
            defects: Defects::new(),
        };
        for lane in lanes.lanes() {
            let order = in_order(guard, start.time, invariants.residual.lane(lane), condition.lane(lane));
            if let Err(cause) = order.and_then(|()| known.distances(lane, start.time, guard.singularity)) {
                faults.add(lane, cause, start);
            }
        }
        known
    }

    /// Evaluates the functions that must not vanish, and returns the lanes that may have come to an edge: inside of
    /// [`Real::vectorize`], please.
    #[inline(always)]
    fn look_at_edges<S>(&mut self, system: &S, now: &Moment<L, N>, limit: f64) -> Mask
    where
        S: System<L, N> + ?Sized,
    {
        let time = L::from_f64(now.time);
        functions(system, time, &now.state, &self.largest, &mut self.functions);
        let (zero, nan) = (L::zero(), L::from_f64(f64::NAN));
        let mut suspects = zero;
        for (now, start) in self.functions.iter().zip(&self.start).take(self.count) {
            let left = now.value.abs() / now.error;
            suspects += left * zero
                + left.where_above(L::from_f64(limit), zero, nan)
                + (now.value * *start).where_above(zero, zero, nan);
        }
        Mask::all(L::COUNT) - suspects.finite()
    }

    fn distances(&self, lane: usize, found: f64, limit: f64) -> Result<(), Cause> {
        let alone =
            |f: &RunningError<L>| RunningError { value: f.value.lane(lane), error: f.error.lane(lane) };
        let functions = self.functions.iter().zip(&self.start).map(|(f, start)| (alone(f), start.lane(lane)));
        distances(functions.take(self.count), found, limit)
    }

    /// In how many steps to look at the edges again, judged by the step that began at `before`; no number where that has to be
    /// found out for a lane alone. And the lanes in which it is in as many as the longest, or later. Inside of
    /// [`Real::vectorize`], please.
    #[inline(always)]
    fn paces<S>(&mut self, system: &S, before: &Moment<L, N>, limit: f64, longest: u32) -> (L, Mask)
    where
        S: System<L, N> + ?Sized,
    {
        functions(system, L::from_f64(before.time), &before.state, &self.largest, &mut self.before);
        let (zero, half) = (L::zero(), L::from_f64(0.5));
        let mut soonest = L::from_f64(f64::from(u32::MAX));
        let mut rest = zero;
        for (from, to) in self.before.iter().zip(&self.functions).take(self.count) {
            let (from, to) = (from.value.abs(), to.value.abs());
            rest += above(from / to, limit) + above(to / from, limit);
            let steps = half * to / (from - to);
            let steps = from.where_above(to, steps, soonest);
            rest += steps * zero;
            soonest = soonest.where_above(steps, steps, soonest);
        }
        let soonest = soonest + rest;
        // NaN where the longest is longer, or cannot be compared.
        let longest = L::from_f64(f64::from(longest));
        (soonest, longest.where_above(soonest, L::from_f64(f64::NAN), zero).finite())
    }

    fn pace(&self, lane: usize, soonest: L, found: f64, limit: f64) -> Result<u32, Cause> {
        let steps = soonest.lane(lane);
        if !steps.is_nan() {
            return Ok(if steps < f64::from(u32::MAX) { (steps as u32).max(1) } else { u32::MAX });
        }
        let values = self.before.iter().zip(&self.functions);
        let alone = values.map(|(from, to)| (from.value.lane(lane), to.value.lane(lane)));
        paces(alone.take(self.count), found, limit)
    }
}
