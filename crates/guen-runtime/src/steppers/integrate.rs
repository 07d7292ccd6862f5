//! What all steppers share: the loop that goes to a time, and what it reports.
//!
//! A method supplies a [`Course`], which knows how to make one accepted step towards a target and to land on it;
//! observing, sampling and wrapping causes into errors happen here, once.

use core::ops::{AddAssign, ControlFlow};

use crate::error::{Cause, IntegrationError, Setting};
use crate::real::Real;
use crate::system::System;

/// The work that an integration did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Statistics {
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Steps that advanced the state.
    pub accepted: u64,
    /// Trial steps that were repeated with a shorter step; none with a fixed step.
    pub rejected: u64,
}

impl AddAssign for Statistics {
    /// Adds the work of a further run.
    fn add_assign(&mut self, other: Self) {
        self.evaluations += other.evaluations;
        self.accepted += other.accepted;
        self.rejected += other.rejected;
    }
}

/// How an integration that did not fail came to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// It arrived at the time asked for, exactly.
    Arrived,
    /// The observer stopped it.
    Stopped,
}

/// The result of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Done<R, const N: usize> {
    /// The time reached.
    pub time: R,
    /// The state at that time.
    pub state: [R; N],
    /// Whether that is the time asked for.
    pub outcome: Outcome,
    /// The work done.
    pub statistics: Statistics,
}

/// Where a run stands: the last accepted time and state, and the work so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress<R, const N: usize> {
    pub time: R,
    pub state: [R; N],
    pub statistics: Statistics,
}

impl<R: Real, const N: usize> Progress<R, N> {
    pub fn new(time: R, state: &[R; N]) -> Self {
        Self { time, state: *state, statistics: Statistics::default() }
    }

    fn done(&self, outcome: Outcome) -> Done<R, N> {
        Done { time: self.time, state: self.state, outcome, statistics: self.statistics }
    }

    fn failed(&self, cause: Cause) -> IntegrationError<R, N> {
        IntegrationError { time: self.time, state: self.state, cause, statistics: self.statistics }
    }
}

/// A run of one method from one initial state.
pub(super) trait Course<R: Real, const N: usize> {
    fn progress(&self) -> &Progress<R, N>;

    /// Makes one accepted step towards `target`, which is not the present time. The step that reaches the
    /// target sets the time to it, to the bit. On failure the progress is that of the last accepted step.
    fn advance<S: System<R, N> + ?Sized>(&mut self, system: &S, target: R) -> Result<(), Cause>;

    /// Goes to `target`, showing each accepted step to the observer.
    fn go<S, O>(&mut self, system: &S, target: R, mut observer: O) -> Result<Outcome, IntegrationError<R, N>>
    where
        S: System<R, N> + ?Sized,
        O: FnMut(R, &[R; N]) -> ControlFlow<()>,
    {
        if !target.is_finite() {
            return Err(self.progress().failed(Cause::Setting(Setting::Time)));
        }
        while self.progress().time != target {
            self.advance(system, target).map_err(|cause| self.progress().failed(cause))?;
            if observer(self.progress().time, &self.progress().state).is_break() {
                return Ok(Outcome::Stopped);
            }
        }
        Ok(Outcome::Arrived)
    }

    /// The whole of a method's `integrate`.
    fn integrate<S, O>(mut self, system: &S, t1: R, observer: O) -> Result<Done<R, N>, IntegrationError<R, N>>
    where
        Self: Sized,
        S: System<R, N> + ?Sized,
        O: FnMut(R, &[R; N]) -> ControlFlow<()>,
    {
        let outcome = self.go(system, t1, observer)?;
        Ok(self.progress().done(outcome))
    }

    /// The whole of a method's `sample`.
    fn sample<S, V>(
        mut self,
        system: &S,
        times: &[R],
        mut visit: V,
    ) -> Result<Done<R, N>, IntegrationError<R, N>>
    where
        Self: Sized,
        S: System<R, N> + ?Sized,
        V: FnMut(usize, R, &[R; N]),
    {
        for (index, &time) in times.iter().enumerate() {
            self.go(system, time, |_, _| ControlFlow::Continue(()))?;
            visit(index, time, &self.progress().state);
        }
        Ok(self.progress().done(Outcome::Arrived))
    }
}
