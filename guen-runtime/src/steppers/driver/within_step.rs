//! Samples and events within one step of a run, in the order of time, and the end of a run at an event.

use crate::numbers::real::Real;
use crate::steppers::driver::any_run::AnyRun;
use crate::steppers::driver::crossing::{Crossing, earlier};
use crate::steppers::driver::drive_loop::DriveLoop;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::events::Occurrence;
use crate::steppers::driver::followed::Followed;
use crate::steppers::driver::run::{Checkpoint, Outcome};

impl<R: Real, const N: usize> DriveLoop<'_, '_, R, N> {
    /// Samples and events of the step from `before` to where the run stands. Answers with the outcome of the run, and writes
    /// its end, if one of them ended it.
    pub(super) fn within_step(
        &mut self,
        run: &mut dyn AnyRun<R, N>,
        before: &Checkpoint<R, N>,
        end: &mut Checkpoint<R, N>,
    ) -> Result<Option<Outcome>, Cause> {
        let after = run.checkpoint().time;
        let backwards = (after - before.time).to_f64() < 0.0;
        let origin = self.start.time;
        for followed in self.events.iter_mut() {
            followed.enter(origin, before, run);
        }
        let mut state = before.state;
        loop {
            let mut first: Option<(usize, bool, Crossing<R>)> = None;
            for (i, Followed { event, crossing, .. }) in self.events.iter().enumerate() {
                if let Some(crossing) = *crossing
                    && first.is_none_or(|(_, _, sooner)| earlier(crossing.time, sooner.time, backwards))
                {
                    first = Some((i, event.is_terminal(), crossing));
                }
            }
            let mut until = first.map_or(after, |(_, _, crossing)| crossing.time);
            if first.is_some_and(|(_, terminal, _)| terminal) {
                // Brackets that overlap with the first are one instant, at the end of the last of them.
                let instant = until;
                for crossing in self.events.iter().filter_map(|followed| followed.crossing) {
                    if earlier(crossing.after, instant, backwards) && earlier(until, crossing.time, backwards)
                    {
                        until = crossing.time;
                    }
                }
                run.at(until, &mut state)?;
                let mut moved = false;
                for followed in self.events.iter_mut() {
                    let value = followed.event.value(until, &state);
                    moved |= followed.search_back(origin, (until, value), run);
                }
                if moved {
                    continue;
                }
            }
            while let Some(&time) = self.samples.get(self.visited)
                && !earlier(until, time, backwards)
            {
                run.at(time, &mut state)?;
                self.visit(time, &state);
            }
            let Some((index, terminal, Crossing { rising, .. })) = first else {
                return Ok(None);
            };
            run.at(until, &mut state)?;
            if !terminal {
                let stopped = self.report(&Occurrence { index, time: until, state, rising });
                if let Some(followed) = self.events.get_mut(index) {
                    followed.pass(origin, until, run);
                }
                if !stopped {
                    continue;
                }
            }
            let outcome = self.end_within(run, until, &state);
            *end = Checkpoint { time: until, state, ..*run.checkpoint() };
            return Ok(Some(outcome));
        }
    }

    /// Ends the run at a time within its last step: all that has happened by then is found first, then reported.
    fn end_within(&mut self, run: &mut dyn AnyRun<R, N>, time: R, state: &[R; N]) -> Outcome {
        for followed in self.events.iter_mut() {
            followed.settle(self.start.time, time, state, run);
        }
        let mut outcome = Outcome::Stopped;
        for (index, Followed { event, happened, .. }) in self.events.iter().enumerate() {
            let Some(rising) = *happened else { continue };
            // The run is over, whatever the receiver answers, and the observer.
            if let Some(receiver) = &mut self.receiver {
                let _ = receiver(&Occurrence { index, time, state: *state, rising });
            }
            if event.is_terminal() && outcome == Outcome::Stopped {
                outcome = Outcome::Event(index);
            }
        }
        if let Some(observer) = &mut self.observer {
            let _ = observer(time, state);
        }
        outcome
    }
}
