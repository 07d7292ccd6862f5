//! Samples and events within one step of a run, in the order of time, and the end of a run at an event.

use crate::numbers::real::Real;
use crate::steppers::driver::crossing::{Checks, Crossing, Tracker, earlier, sign};
use crate::steppers::driver::dense::Interpolant;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::events::{Event, Occurrence};
use crate::steppers::driver::integration::Integration;
use crate::steppers::driver::run::{Checkpoint, IntegrationResult, Outcome, StepperRun};
use crate::steppers::entries;
use crate::system::System;

/// The motion over the step that a run has made last, on the constraints.
struct Motion<'a, C: StepperRun<R, S, N>, R: Real, S: ?Sized, const N: usize> {
    system: &'a S,
    run: &'a mut C,
    after: Checkpoint<R, N>,
    polynomial: Option<C::Polynomial>,
}

impl<C: StepperRun<R, S, N>, R: Real, S: System<R, N> + ?Sized, const N: usize> Motion<'_, C, R, S, N> {
    fn at(&mut self, time: R) -> Result<[R; N], Cause> {
        if time == self.after.time {
            return Ok(self.after.state);
        }
        let dense = self.polynomial.get_or_insert_with(|| self.run.dense(self.system));
        let mut state = dense.at(time);
        self.system.restore(time, &mut state).map_err(|_| Cause::Positions)?;
        Ok(state)
    }
}

/// The progress of an event through a step.
#[derive(Clone, Copy, Default)]
struct Followed<R> {
    /// Up to where its crossings have been reported, and the tracker as it stood there.
    from: R,
    behind: Tracker,
    checks: Checks<R>,
    /// The function at the end of the step.
    end: f64,
    /// The next crossing, if there is one, and the tracker past it, or at the end of the step.
    crossing: Option<Crossing<R>>,
    ahead: Tracker,
}

impl<R: Real> Followed<R> {
    /// Looks for the next crossing.
    fn follow<C, S, const N: usize>(
        &mut self,
        event: &Event<'_, R, N>,
        origin: R,
        motion: &mut Motion<'_, C, R, S, N>,
    ) where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        self.ahead = self.behind;
        self.crossing = None;
        if event.parts() > 1 || self.checks.close || !self.behind.stays(self.end) {
            let range = (origin, self.from);
            self.crossing = self.ahead.next(event, self.checks, range, self.end, |t| motion.at(t).ok());
        } else {
            self.ahead = self.behind.at(self.end);
        }
    }

    /// Looks for a crossing before a time, at which the function has this value, that checks until now have not shown: since
    /// then the function has come back. Says whether there is one.
    fn search_back<C, S, const N: usize>(
        &mut self,
        event: &Event<'_, R, N>,
        origin: R,
        (time, value): (R, f64),
        motion: &mut Motion<'_, C, R, S, N>,
    ) -> bool
    where
        C: StepperRun<R, S, N>,
        S: System<R, N> + ?Sized,
    {
        let backwards = (self.checks.end - self.checks.start).to_f64() < 0.0;
        let known = self.crossing.is_some_and(|crossing| !earlier(time, crossing.after, backwards));
        if known || self.from == time {
            return false;
        }
        let mut tracker = self.behind;
        let checks = Checks { end: time, ..self.checks };
        let found = tracker.next(event, checks, (origin, self.from), value, |t| motion.at(t).ok());
        if found.is_some() {
            (self.crossing, self.ahead) = (found, tracker);
        }
        found.is_some()
    }

    /// Whether an event has happened when a run ends at a time at which its function has this value, and if so, whether the
    /// function was rising.
    fn happened(&self, time: R, value: f64) -> Option<bool> {
        let backwards = (self.checks.end - self.checks.start).to_f64() < 0.0;
        let crossing = self.crossing.filter(|crossing| !earlier(time, crossing.after, backwards))?;
        let past = !earlier(time, crossing.time, backwards);
        let crossed = !value.is_nan() && sign(value) != crossing.side();
        (self.from != time && (past || crossed)).then_some(crossing.rising)
    }

    /// The side on which the function is before its next crossing.
    fn side(&self) -> i8 {
        self.crossing.map_or(self.ahead.side(), |crossing| crossing.side())
    }
}

impl<R: Real, S: System<R, N> + ?Sized, const N: usize, const E: usize> Integration<'_, R, S, N, E> {
    /// Samples and events of the step from `before` to where the run stands. Answers with the end of the run, if
    /// one of them ended it.
    pub(in crate::steppers) fn within_step<C>(
        &mut self,
        run: &mut C,
        before: &Checkpoint<R, N>,
        trackers: &mut [Tracker; E],
        visited: &mut usize,
    ) -> Result<Option<IntegrationResult<R, N>>, Cause>
    where
        C: StepperRun<R, S, N>,
    {
        let Self { system, start, events, samples, visitor, receiver, observer, .. } = self;
        let after = *run.checkpoint();
        let mut motion = Motion { system: *system, run, after, polynomial: None };
        let backwards = (after.time - before.time).to_f64() < 0.0;
        let origin = start.time;
        let mut followed: [Followed<R>; E] = entries(|i| {
            let event = &events[i];
            let end = event.value(after.time, &after.state);
            let close = before.time == origin && is_near(event, before, end, &mut motion);
            let checks = Checks { start: before.time, end: after.time, close };
            let (behind, ahead) = (trackers[i], trackers[i]);
            let mut followed = Followed { from: before.time, behind, checks, end, crossing: None, ahead };
            followed.follow(event, origin, &mut motion);
            followed
        });
        loop {
            let mut first: Option<(usize, Crossing<R>)> = None;
            for (i, event) in followed.iter().enumerate() {
                if let Some(crossing) = event.crossing
                    && first.is_none_or(|(_, sooner)| earlier(crossing.time, sooner.time, backwards))
                {
                    first = Some((i, crossing));
                }
            }
            // Below `E` it is; said again, the compiler knows it too and leaves no panic.
            let first = first.filter(|(i, _)| *i < E);
            let terminal = first.is_some_and(|(i, _)| events[i].is_terminal());
            let mut until = first.map_or(after.time, |(_, crossing)| crossing.time);
            if terminal {
                // Brackets that overlap with the first are one instant, at the end of the last of them.
                let instant = until;
                for crossing in followed.iter().filter_map(|event| event.crossing) {
                    if earlier(crossing.after, instant, backwards) && earlier(until, crossing.time, backwards)
                    {
                        until = crossing.time;
                    }
                }
                let state = motion.at(until)?;
                let mut moved = false;
                for (event, followed) in events.iter().zip(&mut followed) {
                    let value = event.value(until, &state);
                    moved |= followed.search_back(event, origin, (until, value), &mut motion);
                }
                if moved {
                    continue;
                }
            }
            while let Some(&time) = samples.get(*visited)
                && !earlier(until, time, backwards)
            {
                let state = motion.at(time)?;
                if let Some(visitor) = visitor {
                    visitor(*visited, time, &state);
                }
                *visited += 1;
            }
            let Some((i, Crossing { rising, .. })) = first else {
                for (tracker, followed) in trackers.iter_mut().zip(&followed) {
                    *tracker = followed.ahead;
                }
                return Ok(None);
            };
            let state = motion.at(until)?;
            let mut report = |index: usize, rising: bool| {
                let occurrence = Occurrence { index, time: until, state, rising };
                receiver.as_mut().is_some_and(|receiver| receiver(&occurrence).is_break())
            };
            if !terminal {
                let stopped = report(i, rising);
                let (event, followed) = (&events[i], &mut followed[i]);
                (followed.from, followed.behind) = (until, followed.ahead);
                followed.follow(event, origin, &mut motion);
                if !stopped {
                    continue;
                }
            }
            // The run ends here. All that has happened by now is found first, then reported.
            let mut happened = [None; E];
            for ((event, followed), happened) in events.iter().zip(&mut followed).zip(&mut happened) {
                let value = event.value(until, &state);
                followed.search_back(event, origin, (until, value), &mut motion);
                *happened = followed.happened(until, value);
                if happened.is_none() && followed.from != until && event.is_for_both() {
                    // A run that goes on from here takes what follows at once for a return.
                    let ahead = R::from_f64(2.0 * event.returns_within(until));
                    let soon = if backwards { until - ahead } else { until + ahead };
                    let value = motion.at(soon).map_or(f64::NAN, |state| event.value(soon, &state));
                    let (side, next) = (followed.side(), sign(value));
                    let comes = side != 0 && next != side && !value.is_nan();
                    *happened = comes.then_some(side < 0);
                }
            }
            let mut outcome = Outcome::Stopped;
            for (index, (event, happened)) in events.iter().zip(happened).enumerate() {
                let Some(rising) = happened else { continue };
                // The run is over, whatever the receiver answers, and the observer.
                let _ = report(index, rising);
                if event.is_terminal() && outcome == Outcome::Stopped {
                    outcome = Outcome::Event(index);
                }
            }
            if let Some(observer) = observer {
                let _ = observer(until, &state);
            }
            let statistics = motion.run.checkpoint().statistics;
            return Ok(Some(
                Checkpoint { time: until, time_rest: R::zero(), state, statistics }.done(outcome),
            ));
        }
    }
}

/// Whether an event's function is much smaller where a run begins than where its first step ends or in its middle.
fn is_near<C, R: Real, S, const N: usize>(
    event: &Event<'_, R, N>,
    start: &Checkpoint<R, N>,
    end: f64,
    motion: &mut Motion<'_, C, R, S, N>,
) -> bool
where
    C: StepperRun<R, S, N>,
    S: System<R, N> + ?Sized,
{
    /// By this factor.
    const MUCH: f64 = 256.0;

    let near = MUCH * event.value(start.time, &start.state).abs();
    if near <= end.abs() {
        return true;
    }
    let middle = start.time + R::from_ratio(1, 2) * (motion.after.time - start.time);
    motion.at(middle).is_ok_and(|state| near <= event.value(middle, &state).abs())
}
