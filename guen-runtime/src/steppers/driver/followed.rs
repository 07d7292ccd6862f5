//! Events, each followed through the steps of a run.

use crate::numbers::real::Real;
use crate::steppers::driver::any_run::AnyRun;
use crate::steppers::driver::crossing::{Checks, Crossing, Tracker, earlier, sign};
use crate::steppers::driver::events::Event;
use crate::steppers::driver::run::Checkpoint;

/// An event, and its progress through a step.
#[derive(Clone, Copy)]
pub(super) struct Followed<'a, R, const N: usize> {
    pub event: Event<'a, R, N>,
    /// The time up to which crossings have been reported, and the tracker as it stood there.
    from: R,
    behind: Tracker,
    checks: Checks<R>,
    /// The function at the end of the step.
    end: f64,
    /// The next crossing, if there is one, and the tracker past it, or at the end of the step.
    pub crossing: Option<Crossing<R>>,
    ahead: Tracker,
    /// Whether the event has happened by the time at which the run ends, and if so, whether its function was rising.
    pub happened: Option<bool>,
}

impl<'a, R: Real, const N: usize> Followed<'a, R, N> {
    /// An event that is not followed yet.
    pub(super) fn new(event: Event<'a, R, N>) -> Self {
        let (behind, ahead) = (Tracker::default(), Tracker::default());
        let (from, checks) = (R::zero(), Checks::default());
        Self { event, from, behind, checks, end: 0.0, crossing: None, ahead, happened: None }
    }

    /// Begins at the start of a run.
    pub(super) fn begin(&mut self, time: R, state: &[R; N]) {
        self.end = self.event.value(time, state);
        self.ahead = Tracker::new(self.end);
    }

    /// Whether the function is a number where the last step ended, or where the run begins.
    pub(super) fn is_known(&self) -> bool {
        !self.end.is_nan()
    }

    /// The function at a time of the last step; NaN where it has no state.
    fn value(&self, run: &mut dyn AnyRun<R, N>, time: R) -> f64 {
        let mut state = [R::zero(); N];
        run.at(time, &mut state).map_or(f64::NAN, |()| self.event.value(time, &state))
    }

    /// Looks for the first crossing of a new step.
    pub(super) fn enter(&mut self, origin: R, before: &Checkpoint<R, N>, run: &mut dyn AnyRun<R, N>) {
        let after = *run.checkpoint();
        self.from = before.time;
        self.behind = self.ahead;
        self.end = self.event.value(after.time, &after.state);
        let close = before.time == origin && self.is_near(before, after.time, run);
        self.checks = Checks { start: before.time, end: after.time, close };
        self.follow(origin, run);
    }

    /// Goes on from a crossing that has been reported.
    pub(super) fn pass(&mut self, origin: R, time: R, run: &mut dyn AnyRun<R, N>) {
        (self.from, self.behind) = (time, self.ahead);
        self.follow(origin, run);
    }

    /// Looks for the next crossing.
    fn follow(&mut self, origin: R, run: &mut dyn AnyRun<R, N>) {
        self.ahead = self.behind;
        self.crossing = None;
        if self.event.parts() > 1 || self.checks.close || !self.behind.stays(self.end) {
            let (mut tracker, range) = (self.ahead, (origin, self.from));
            let mut value = |t: R| self.value(run, t);
            let crossing = tracker.next(&self.event, self.checks, range, self.end, &mut value);
            (self.crossing, self.ahead) = (crossing, tracker);
        } else {
            self.ahead = self.behind.at(self.end);
        }
    }

    /// Looks for a crossing before a time, at which the function has this value, that checks until now have not shown: since
    /// then the function has come back. Says whether there is one.
    pub(super) fn search_back(
        &mut self,
        origin: R,
        (time, value): (R, f64),
        run: &mut dyn AnyRun<R, N>,
    ) -> bool {
        let known = self.crossing.is_some_and(|crossing| !earlier(time, crossing.after, self.backwards()));
        if known || self.from == time {
            return false;
        }
        let mut tracker = self.behind;
        let checks = Checks { end: time, ..self.checks };
        let mut within = |t: R| self.value(run, t);
        let found = tracker.next(&self.event, checks, (origin, self.from), value, &mut within);
        if found.is_some() {
            (self.crossing, self.ahead) = (found, tracker);
        }
        found.is_some()
    }

    /// Settles whether it has happened when the run ends at this time and state.
    pub(super) fn settle(&mut self, origin: R, time: R, state: &[R; N], run: &mut dyn AnyRun<R, N>) {
        let event = self.event;
        let value = event.value(time, state);
        self.search_back(origin, (time, value), run);
        self.happened = self.by(time, value);
        if self.happened.is_none() && self.from != time && event.is_for_both() {
            // A run that goes on from here takes what follows at once for a return.
            let ahead = R::from_f64(2.0 * event.returns_within(time));
            let value = self.value(run, if self.backwards() { time - ahead } else { time + ahead });
            let (side, next) = (self.side(), sign(value));
            let comes = side != 0 && next != side && !value.is_nan();
            self.happened = comes.then_some(side < 0);
        }
    }

    /// Returns whether the function was rising, if the event has happened by a time at which the function has this value; `None` if
    /// it has not happened.
    fn by(&self, time: R, value: f64) -> Option<bool> {
        let crossing = self.crossing.filter(|crossing| !earlier(time, crossing.after, self.backwards()))?;
        let past = !earlier(time, crossing.time, self.backwards());
        let crossed = !value.is_nan() && sign(value) != crossing.side();
        (self.from != time && (past || crossed)).then_some(crossing.rising)
    }

    /// The side on which the function is before its next crossing.
    fn side(&self) -> i8 {
        self.crossing.map_or(self.ahead.side(), |crossing| crossing.side())
    }

    fn backwards(&self) -> bool {
        (self.checks.end - self.checks.start).to_f64() < 0.0
    }

    /// Whether the function is much smaller at the start of the first step than it becomes in it: it begins at the surface, as far as
    /// roundings can tell, and may leave it and come back before the first check.
    fn is_near(&self, start: &Checkpoint<R, N>, end: R, run: &mut dyn AnyRun<R, N>) -> bool {
        /// The factor by which a function grows within a step that starts at its zero.
        const GROWTH_IN_STEP: f64 = 256.0;

        let near = GROWTH_IN_STEP * self.event.value(start.time, &start.state).abs();
        if near <= self.end.abs() {
            return true;
        }
        let middle = start.time + R::from_ratio(1, 2) * (end - start.time);
        near <= self.value(run, middle).abs()
    }
}
