//! A guard on a part of a run: on the steps within one mode of a system with contacts.

use crate::numbers::lanes::Mask;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, Method, StepperRun};
use crate::steppers::guard::runs::One;
use crate::steppers::guard::{Guard, TimeAndState, Watch};
use crate::system::System;

/// A fault, with the time and state of the last check that found none.
pub(crate) struct Failed<const N: usize> {
    pub(crate) cause: Cause,
    pub(crate) time: f64,
    pub(crate) state: [f64; N],
}

/// The guard at work on the steps of one mode.
pub(crate) struct PartWatch<const N: usize>(Watch<f64, One, N>);

impl<const N: usize> PartWatch<N> {
    /// Creates a watch over the steps of a method.
    pub(crate) fn new<S, M>(guard: Guard, system: &S, start: &Checkpoint<f64, N>) -> Result<Self, Cause>
    where
        S: System<f64, N>,
        M: Method<f64, S, N>,
    {
        let (evaluations, fixed) = (M::Run::EVALUATIONS, M::Run::JUDGED);
        guard.check()?;
        Ok(Self(Watch::new(guard, system, evaluations, fixed, place(start))))
    }

    /// Counts a step, and checks its end if it is time to.
    pub(crate) fn step<S, X>(
        &mut self,
        system: &S,
        run: &X,
        before: &Checkpoint<f64, N>,
    ) -> Result<(), Failed<N>>
    where
        S: System<f64, N>,
        X: StepperRun<f64, S, N>,
    {
        if !self.0.counts(1) {
            return Ok(());
        }
        let mut failed = None;
        let now = place(run.checkpoint());
        let last = (X::JUDGED.then(|| place(before)), || run.defect(system, before));
        self.0.check(system, last, now, Mask::all(1), |_, cause, good| failed = Some(fault(cause, good)));
        failed.map_or(Ok(()), Err)
    }

    /// Checks the end of the part, unless that was just done.
    pub(crate) fn finish<S>(&mut self, system: &S, time: f64, state: &[f64; N]) -> Result<(), Failed<N>>
    where
        S: System<f64, N>,
    {
        let mut failed = None;
        let now = TimeAndState { time, state };
        let unjudged = (None, || [0.0; N]);
        self.0
            .finish(system, unjudged, now, Mask::all(1), |_, cause, good| failed = Some(fault(cause, good)));
        failed.map_or(Ok(()), Err)
    }

    /// The fault of a part whose steps cannot go on: the cause given, unless the steps since the last check went wrong before.
    pub(crate) fn stopped<S>(&mut self, system: &S, reached: &Checkpoint<f64, N>, cause: Cause) -> Failed<N>
    where
        S: System<f64, N>,
    {
        let mut failed = Failed { cause, time: reached.time, state: reached.state };
        self.0.stopped(system, place(reached), Mask::all(1), cause, |_, cause, good| {
            failed = fault(cause, good);
        });
        failed
    }
}

fn place<const N: usize>(checkpoint: &Checkpoint<f64, N>) -> TimeAndState<'_, f64, N> {
    TimeAndState { time: checkpoint.time, state: &checkpoint.state }
}

fn fault<const N: usize>(cause: Cause, good: TimeAndState<'_, f64, N>) -> Failed<N> {
    Failed { cause, time: good.time, state: *good.state }
}
