//! The loop around a run: steps from the start to one time after the other, and what is looked at on the way.

use core::ops::ControlFlow;

use crate::numbers::real::Real;
use crate::steppers::driver::any_run::{AnyRun, Observer};
use crate::steppers::driver::error::{Cause, IntegrationError, Setting};
use crate::steppers::driver::events::Occurrence;
use crate::steppers::driver::followed::Followed;
use crate::steppers::driver::run::{Checkpoint, IntegrationResult, Outcome};
use crate::steppers::guard::{Guard, Watch};

/// Is shown each sample, with its position, time and state.
pub(super) type Visitor<'a, R, const N: usize> = &'a mut dyn FnMut(usize, R, &[R; N]);
/// Is told of each event; ends the run when it breaks.
pub(super) type Receiver<'a, R, const N: usize> = &'a mut dyn FnMut(&Occurrence<R, N>) -> ControlFlow<()>;

/// The loop of a run with everything that is checked on its way: samples, events, observer and guard.
pub(super) struct DriveLoop<'a, 'e, R, const N: usize> {
    pub start: &'e Checkpoint<R, N>,
    pub guard: Guard,
    pub observer: Option<Observer<'a, R, N>>,
    pub samples: &'a [R],
    /// The number of samples that have been visited.
    pub visited: usize,
    pub visitor: Option<Visitor<'a, R, N>>,
    pub events: &'e mut [Followed<'a, R, N>],
    pub receiver: Option<Receiver<'a, R, N>>,
}

impl<R: Real, const N: usize> DriveLoop<'_, '_, R, N> {
    /// Takes the run through all times, and calls `visit` at each of them.
    pub(super) fn through(
        &mut self,
        run: &mut dyn AnyRun<R, N>,
        times: &[R],
        visit: Visitor<'_, R, N>,
    ) -> Result<IntegrationResult<R, N>, IntegrationError<R, N>> {
        let mut end = *self.start;
        match self.legs(run, times, visit, &mut end) {
            Ok(outcome) => Ok(end.done(outcome)),
            Err(cause) => Err(end.failed(cause)),
        }
    }

    /// Does so, and writes where it ends or failed.
    // One place for all ends, so that a run of a long state needs no further ones in a build without optimisation.
    fn legs(
        &mut self,
        run: &mut dyn AnyRun<R, N>,
        times: &[R],
        visit: Visitor<'_, R, N>,
        end: &mut Checkpoint<R, N>,
    ) -> Result<Outcome, Cause> {
        self.check(times)?;
        self.guard.check()?;
        let mut watch = Watch::of_run(self.guard, run);
        let start = self.start;
        for followed in self.events.iter_mut() {
            followed.begin(start.time, &start.state);
        }
        self.check_events()?;
        while self.samples.get(self.visited) == Some(&start.time) {
            self.visit(start.time, &start.state);
        }
        let mut before = *start;
        let mut kept = false;
        let mut outcome = Outcome::Arrived;
        'times: for (index, &time) in times.iter().enumerate() {
            if !time.is_finite() {
                *end = *run.checkpoint();
                return Err(Cause::Setting(Setting::Time));
            }
            loop {
                let here = run.checkpoint();
                if here.time == time {
                    break;
                }
                let dense = !self.events.is_empty() || self.visited < self.samples.len();
                kept = dense || watch.wants_before(index + 1 == times.len() && run.is_last(time));
                if kept {
                    before = *here;
                }
                let from = here.statistics.accepted;
                let observer = self.observer.as_mut().map(|observer| &mut **observer as Observer<'_, R, N>);
                let made = if kept {
                    run.advance(time, true).map(|()| false)
                } else {
                    run.go_on(time, watch.patience(), observer)
                };
                let broken = match made {
                    Ok(broken) => broken,
                    Err(cause) => return Err(watch.stop_run(run, cause, end)),
                };
                watch.step(from, kept.then_some(&before), run, end)?;
                if dense {
                    *end = before;
                    if let Some(outcome) = self.within_step(run, &before, end)? {
                        watch.finish_run(Some(&before), run, end)?;
                        return Ok(outcome);
                    }
                    *end = *run.checkpoint();
                    self.check_events()?;
                }
                let reached = run.checkpoint();
                if broken || self.show(reached.time, &reached.state) {
                    outcome = Outcome::Stopped;
                    break 'times;
                }
            }
            visit(index, time, &run.checkpoint().state);
        }
        watch.finish_run(kept.then_some(&before), run, end)?;
        *end = *run.checkpoint();
        Ok(outcome)
    }

    /// Refuses to go on from a place at which the function of an event is NaN: its crossings would be passed over.
    fn check_events(&self) -> Result<(), Cause> {
        let unknown = self.events.iter().position(|followed| !followed.is_known());
        unknown.map_or(Ok(()), |event| Err(Cause::EventFunction { event }))
    }

    /// Refuses settings that make no sense.
    fn check(&self, times: &[R]) -> Result<(), Cause> {
        if !self.start.time.is_finite() || times.first().is_some_and(|time| !time.is_finite()) {
            return Err(Cause::Setting(Setting::Time));
        }
        if !self.events.iter().all(|followed| followed.event.is_valid()) {
            return Err(Cause::Setting(Setting::Event));
        }
        let Some(&end) = times.last() else { return Ok(()) };
        if self.samples.is_empty() {
            return Ok(());
        }
        let forwards = (end - self.start.time).to_f64() >= 0.0;
        let in_order = |mut last: R, times: &[R]| {
            times.iter().all(|&time| {
                let ahead = (time - last).to_f64();
                last = time;
                ahead == 0.0 || ahead.abs() > 0.0 && (ahead > 0.0) == forwards
            })
        };
        let last = self.samples.last().copied().unwrap_or(end);
        let all = in_order(self.start.time, self.samples)
            && in_order(last, &[end])
            && in_order(self.start.time, times);
        if all { Ok(()) } else { Err(Cause::Setting(Setting::Samples)) }
    }

    /// Shows a step, and says whether the run is to end.
    fn show(&mut self, time: R, state: &[R; N]) -> bool {
        self.observer.as_mut().is_some_and(|observer| observer(time, state).is_break())
    }

    /// Shows the next sample.
    pub(super) fn visit(&mut self, time: R, state: &[R; N]) {
        if let Some(visitor) = &mut self.visitor {
            visitor(self.visited, time, state);
        }
        self.visited += 1;
    }

    /// Tells of an event, and says whether the run is to end.
    pub(super) fn report(&mut self, event: &Occurrence<R, N>) -> bool {
        self.receiver.as_mut().is_some_and(|receiver| receiver(event).is_break())
    }
}
