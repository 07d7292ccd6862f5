//! The guard of runs in lanes: it judges every lane as [`Watch`](super::guard::Watch) judges a run alone, with the same limits,
//! after the same steps and in the same order, so that a lane ends with the error that it would have had alone.
//!
//! What is looked at is computed in all lanes at once, and the sizes of it too; what is left for each lane is a handful of
//! comparisons.

use super::course::Reached;
use super::defect::{Defects, Worst, worst};
use super::edges::{EDGES, Edges, values};
use super::guard::{Guard, exceeds, in_order, steps_between_looks};
use crate::error::Cause;
use crate::lanes::{Lanes, Mask};
use crate::real::Real;
use crate::rounded::Rounded;
use crate::system::System;

/// The most lanes that there are.
pub(super) const MOST: usize = 8;

/// A time and the states in all lanes.
#[derive(Clone, Copy)]
pub(super) struct Moment<L, const N: usize> {
    pub time: f64,
    pub state: [L; N],
}

impl<L: Lanes, const N: usize> Moment<L, N> {
    pub fn reached(&self) -> Reached<L, N> {
        Reached::new(L::from_f64(self.time), &self.state)
    }

    /// The state in one lane.
    pub fn alone(&self, lane: usize) -> [f64; N] {
        self.state.map(|entry| entry.lane(lane))
    }
}

/// A fault of a lane: what is the matter, and the last time and state that were in order.
#[derive(Clone, Copy)]
pub(super) struct Fault<const N: usize> {
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
pub(super) struct Faults<const N: usize> {
    pub lanes: Mask,
    pub of: [Option<Fault<N>>; MOST],
}

impl<const N: usize> Faults<N> {
    fn none() -> Self {
        Self { lanes: Mask::all(0), of: [None; MOST] }
    }

    fn add<L: Lanes>(&mut self, lane: usize, cause: Cause, good: &Moment<L, N>) {
        self.lanes = self.lanes.with(lane);
        self.of[lane] = Some(Fault::new(lane, cause, good));
    }
}

/// A guard at work.
pub(super) struct LaneWatch<L, const N: usize> {
    guard: Guard,
    every: u32,
    /// Steps after which the sizes of entries are known.
    young: u32,
    /// Steps until the edges are looked at, at least.
    until_edges: u32,
    /// Steps made since the guard did something, and those after which it does something again, for one of the lanes.
    made: u32,
    due: u32,
    /// For each lane, steps from when the guard did something last.
    until: [u32; MOST],
    /// The same until the next look, which all lanes have at once, and the steps between the last one and that.
    rest: u32,
    between: u32,
    /// Where the last look found everything in order, in lanes that are going.
    good: Moment<L, N>,
    known: Option<Known<L, N>>,
}

/// What looks learn, the first one from the initial state.
#[derive(Clone, Copy)]
struct Known<L, const N: usize> {
    energy: Option<L>,
    scale: L,
    /// How many functions there are that must not vanish.
    count: usize,
    edges: [Edges; MOST],
    /// The largest absolute value of each entry of the state.
    largest: [L; N],
    defects: Defects<L, N>,
}

impl<L: Lanes, const N: usize> LaneWatch<L, N> {
    pub fn new(guard: Guard, evaluations: u32, cost_of_look: u32, start: &Moment<L, N>) -> Self {
        let (young, usual) = steps_between_looks(evaluations, cost_of_look, true);
        let every = guard.every.unwrap_or(usual).max(1);
        let first = if every == u32::MAX { every } else { 1 };
        Self {
            guard: guard.for_real::<L>(),
            every,
            young,
            until_edges: if guard.every.is_none() { young } else { u32::MAX },
            made: 0,
            due: first,
            until: [first; MOST],
            rest: first,
            between: first,
            good: *start,
            known: None,
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
    ) -> Faults<N> {
        for until in &mut self.until {
            *until -= (*until).min(self.made);
        }
        self.rest -= self.rest.min(self.made);
        self.made = 0;
        let mut faults = Faults::none();
        let is_whole = self.rest == 0;
        let seen = if is_whole {
            let defects = (self.guard.step < f64::INFINITY).then(defects);
            let seen = self.whole(system, self.between, defects, now, going, &mut faults);
            (self.between, self.rest) = (self.every, self.every);
            seen
        } else {
            self.known.as_ref().and_then(|known| known.edges_at(system, now))
        };
        let limits = self.guard;
        match (&self.known, &seen) {
            (Some(known), Some(to)) => {
                let from = known.functions(system, before);
                for lane in (going - faults.lanes).lanes() {
                    if self.until[lane] > 0 {
                        continue;
                    }
                    let edges = &known.edges[lane];
                    let distances = || edges.distances(to.distances(lane), now.time, limits.edge);
                    let apart = if is_whole { Ok(()) } else { distances() };
                    match apart.and_then(|()| edges.paces(to.paces(&from, lane), now.time, limits.approach)) {
                        Ok(soonest) => self.until[lane] = self.rest.min(self.until_edges).min(soonest),
                        Err(cause) => faults.add(lane, cause, &self.good),
                    }
                }
            }
            _ => self.until = [self.rest; MOST],
        }
        self.due = self.until.into_iter().filter(|until| *until > 0).fold(self.rest, u32::min);
        faults
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
    ) -> Faults<N> {
        let mut faults = Faults::none();
        let steps = (self.between - self.rest).saturating_add(self.made);
        if steps == 0 || self.every == u32::MAX {
            return faults;
        }
        let judged = before.is_some() && self.guard.step < f64::INFINITY;
        let seen = self.whole(system, steps, judged.then(defects), now, going, &mut faults);
        if let (Some(known), Some(to), Some(before)) = (&self.known, &seen, before) {
            let from = known.functions(system, before);
            for lane in (going - faults.lanes).lanes() {
                let paces = to.paces(&from, lane);
                if let Err(cause) = known.edges[lane].paces(paces, now.time, self.guard.approach) {
                    faults.add(lane, cause, &self.good);
                }
            }
        }
        faults
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
    ) -> Faults<N> {
        let mut faults = Faults::none();
        if now.time != self.good.time && self.every != u32::MAX {
            let before = (self.known, self.good, self.young);
            self.whole(system, 0, None, now, stopped, &mut faults);
            (self.known, self.good, self.young) = before;
        }
        for lane in (stopped - faults.lanes).lanes() {
            faults.add(lane, cause, now);
        }
        faults
    }

    /// Looks at everything, for so many steps, and returns the functions that must not vanish.
    fn whole<S: System<L, N> + ?Sized>(
        &mut self,
        system: &S,
        steps: u32,
        defects: Option<[L; N]>,
        now: &Moment<L, N>,
        lanes: Mask,
        faults: &mut Faults<N>,
    ) -> Option<EdgesAt<L>> {
        let Self { guard, good, known, young, .. } = self;
        let known = match known {
            Some(known) => known,
            None => known.insert(Known::new(system, guard, good, lanes, faults)),
        };
        *young = young.saturating_sub(steps);
        // In the first steps an entry that was zero has no size yet.
        let negligible = if *young > 0 { guard.step } else { libm::sqrt(f64::EPSILON) };
        let time = L::from_f64(now.time);
        let vitals = system.vitals(time, &now.state);
        let condition = system.condition(time, &now.state);
        let (change, judged, most) = L::vectorize(
            #[inline(always)]
            || {
                known.scale = vitals.scale.where_above(known.scale, vitals.scale, known.scale);
                let change = match (vitals.energy, known.energy) {
                    (Some(energy), Some(before)) => (energy - before).abs(),
                    _ => L::zero(),
                };
                let change = change.where_above(L::zero(), change / known.scale, L::zero());
                for i in 0..N {
                    let (before, size) = (known.largest[i], now.state[i].abs());
                    known.largest[i] = size.where_above(before, size, before);
                }
                let judged = match &defects {
                    Some(found) => known.defects.add(found, steps, &known.largest, negligible),
                    None => [L::zero(); N],
                };
                let mut most = L::zero();
                for entry in &judged {
                    most = entry.where_above(most, *entry, most);
                }
                (change, judged, most)
            },
        );
        let edges = known.edges_at(system, now);
        let found = now.time;
        for lane in (lanes - faults.lanes).lanes() {
            let judge = || {
                let change = change.lane(lane);
                if exceeds(change, guard.energy) {
                    return Err(Cause::Energy { found, change, limit: guard.energy });
                }
                in_order(guard, found, vitals.residual.lane(lane), condition.lane(lane))?;
                if let Some(edges) = &edges {
                    known.edges[lane].distances(edges.distances(lane), found, guard.edge)?;
                }
                let limit = guard.step;
                if exceeds(most.lane(lane), limit) {
                    let Worst { entry, defect } = worst(&judged.map(|entry| entry.lane(lane)));
                    return Err(Cause::Step { found, entry, defect, limit });
                }
                let (drift, limit) = (vitals.carried.lane(lane), guard.carried);
                if exceeds(drift, limit) { Err(Cause::Carried { found, drift, limit }) } else { Ok(()) }
            };
            if let Err(cause) = judge() {
                faults.add(lane, cause, good);
            }
        }
        *good = *now;
        edges
    }
}

/// The functions that must not vanish, and what is left of them.
struct EdgesAt<L> {
    values: [Rounded<L>; EDGES],
    left: [L; EDGES],
}

impl<L: Lanes> EdgesAt<L> {
    fn new(count: usize, values: [Rounded<L>; EDGES]) -> Self {
        let mut left = [L::zero(); EDGES];
        L::vectorize(
            #[inline(always)]
            || {
                for (left, value) in left.iter_mut().zip(&values).take(count) {
                    *left = value.value.abs() / value.error;
                }
            },
        );
        Self { values, left }
    }

    fn distances(&self, lane: usize) -> impl Iterator<Item = (f64, f64)> {
        let values = self.values.iter().zip(&self.left);
        values.map(move |(value, left)| (value.value.lane(lane), left.lane(lane)))
    }

    fn paces(&self, from: &[Rounded<L>; EDGES], lane: usize) -> impl Iterator<Item = (f64, f64)> {
        let values = from.iter().zip(&self.values);
        values.map(move |(from, to)| (from.value.lane(lane), to.value.lane(lane)))
    }
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
        let vitals = system.vitals(time, &start.state);
        let condition = system.condition(time, &start.state);
        let largest = start.state.map(Real::abs);
        let (count, found) = values(system, &start.reached(), &largest);
        let edges: [Edges; MOST] = core::array::from_fn(|lane| {
            // Of lanes that there are not, those of the first.
            let lane = if lane < L::COUNT { lane } else { 0 };
            Edges::new(count, |function| found.get(function).map_or(0.0, |value| value.value.lane(lane)))
        });
        let known = Self {
            energy: vitals.energy,
            scale: vitals.scale,
            count,
            edges,
            largest,
            defects: Defects::new(),
        };
        let found = EdgesAt::new(count, found);
        for lane in lanes.lanes() {
            let order = in_order(guard, start.time, vitals.residual.lane(lane), condition.lane(lane));
            let edges = || known.edges[lane].distances(found.distances(lane), start.time, guard.edge);
            if let Err(cause) = order.and_then(|()| edges()) {
                faults.add(lane, cause, start);
            }
        }
        known
    }

    /// The functions that must not vanish, as far as there are any.
    fn edges_at<S: System<L, N> + ?Sized>(&self, system: &S, at: &Moment<L, N>) -> Option<EdgesAt<L>> {
        (self.count > 0).then(|| EdgesAt::new(self.count, self.functions(system, at)))
    }

    fn functions<S: System<L, N> + ?Sized>(&self, system: &S, at: &Moment<L, N>) -> [Rounded<L>; EDGES] {
        values(system, &at.reached(), &self.largest).1
    }
}
