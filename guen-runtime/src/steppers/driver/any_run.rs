//! A run of any method on any system, behind one reference: what the driver and the guard ask is compiled once for a real and a
//! size of the state.

use core::ops::ControlFlow;

use crate::numbers::real::Real;
use crate::steppers::driver::dense::Interpolant;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, StepperRun};
use crate::steppers::guard::Watched;
use crate::system::System;

/// Is shown every accepted step; ends the run when it breaks.
pub(super) type Observer<'a, R, const N: usize> = &'a mut dyn FnMut(R, &[R; N]) -> ControlFlow<()>;

/// A run with its system, as the driver and the guard see it. Steps are made many at a time where nobody looks between them, so
/// that a call through the reference costs nothing beside them.
pub(in crate::steppers) trait AnyRun<R: Real, const N: usize> {
    /// The system, as a guard asks it.
    fn system(&self) -> &dyn Watched<R, N>;

    /// The evaluations of a step.
    fn evaluations(&self) -> u32;

    /// Whether a guard has to judge the errors of steps.
    fn is_judged(&self) -> bool;

    fn checkpoint(&self) -> &Checkpoint<R, N>;

    /// See [`StepperRun::advance`].
    fn advance(&mut self, target: R, dense: bool) -> Result<(), Cause>;

    /// Makes so many steps, or fewer where [`StepperRun::go_on`] does, and shows each but the last to the observer. Says whether it
    /// broke.
    fn go_on(&mut self, target: R, steps: u32, observer: Option<Observer<'_, R, N>>) -> Result<bool, Cause>;

    /// See [`StepperRun::is_last`].
    fn is_last(&self, target: R) -> bool;

    /// See [`StepperRun::defect`].
    fn defect(&self, before: &Checkpoint<R, N>) -> [R; N];

    /// The state at a time of the last step, on the constraints.
    fn at(&mut self, time: R) -> Result<[R; N], Cause>;
}

/// A run, its system, and the polynomial of its last step once somebody has asked for it.
pub(in crate::steppers) struct SystemRun<'a, C: StepperRun<R, S, N>, R: Real, S: ?Sized, const N: usize> {
    run: C,
    system: &'a S,
    polynomial: Option<C::Polynomial>,
}

impl<'a, C: StepperRun<R, S, N>, R: Real, S: ?Sized, const N: usize> SystemRun<'a, C, R, S, N> {
    pub(crate) fn new(run: C, system: &'a S) -> Self {
        Self { run, system, polynomial: None }
    }
}

impl<C, R, S, const N: usize> AnyRun<R, N> for SystemRun<'_, C, R, S, N>
where
    C: StepperRun<R, S, N>,
    R: Real,
    S: System<R, N> + ?Sized,
{
    fn system(&self) -> &dyn Watched<R, N> {
        &self.system
    }

    fn evaluations(&self) -> u32 {
        C::EVALUATIONS
    }

    fn is_judged(&self) -> bool {
        C::JUDGED
    }

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        self.run.checkpoint()
    }

    fn advance(&mut self, target: R, dense: bool) -> Result<(), Cause> {
        self.polynomial = None;
        self.run.advance(self.system, target, dense)
    }

    fn go_on(&mut self, target: R, steps: u32, observer: Option<Observer<'_, R, N>>) -> Result<bool, Cause> {
        self.polynomial = None;
        let Some(observer) = observer else {
            return self.run.go_on(self.system, target, steps).map(|()| false);
        };
        for made in 0..steps.max(1) {
            if made > 0 {
                let reached = self.run.checkpoint();
                if reached.time == target || self.run.is_last(target) {
                    break;
                }
                if observer(reached.time, &reached.state).is_break() {
                    return Ok(true);
                }
            }
            self.run.advance(self.system, target, false)?;
        }
        Ok(false)
    }

    fn is_last(&self, target: R) -> bool {
        self.run.is_last(target)
    }

    fn defect(&self, before: &Checkpoint<R, N>) -> [R; N] {
        self.run.defect(self.system, before)
    }

    fn at(&mut self, time: R) -> Result<[R; N], Cause> {
        let reached = self.run.checkpoint();
        if time == reached.time {
            return Ok(reached.state);
        }
        let Self { run, system, polynomial } = self;
        let mut state = polynomial.get_or_insert_with(|| run.dense(system)).at(time);
        system.restore(time, &mut state).map_err(|_| Cause::Positions)?;
        Ok(state)
    }
}
