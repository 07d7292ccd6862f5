//! A method that keeps the polynomial of every step that another one makes.

use alloc::vec::Vec;
use core::cell::RefCell;
use core::marker::PhantomData;

use crate::numbers::real::Real;
use crate::steppers::{Cause, Checkpoint, Interpolant, Method, StepperRun};
use crate::system::System;

/// A step of a run: where it began, and the motion from there on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Step<R, P> {
    pub start: R,
    pub polynomial: P,
}

/// The steps of a run, in bounded memory.
struct Log<R, P> {
    steps: Vec<Step<R, P>>,
    most: usize,
    memory: usize,
}

impl<R, P> Log<R, P> {
    fn push(&mut self, step: Step<R, P>) -> Result<(), Cause> {
        let full = Cause::Memory { limit: self.memory };
        if self.steps.len() >= self.most || self.steps.try_reserve(1).is_err() {
            return Err(full);
        }
        self.steps.push(step);
        Ok(())
    }
}

/// The method with its log.
pub(super) struct Recorder<'m, M, R, P> {
    method: &'m M,
    log: RefCell<Log<R, P>>,
}

impl<'m, M, R, P> Recorder<'m, M, R, P> {
    /// The method, with `beside` bytes of memory for each step that others take.
    pub(super) fn new(method: &'m M, memory: usize, beside: usize) -> Self {
        let most = memory / (size_of::<Step<R, P>>() + beside).max(1);
        Self { method, log: RefCell::new(Log { steps: Vec::new(), most, memory }) }
    }

    pub(crate) fn into_steps(self) -> Vec<Step<R, P>> {
        self.log.into_inner().steps
    }
}

impl<R, S, M, P, const N: usize> Method<R, S, N> for Recorder<'_, M, R, P>
where
    R: Real,
    S: System<R, N>,
    P: Interpolant<R, N>,
    M: Method<R, S, N>,
    for<'r> M::Run<'r>: StepperRun<R, S, N, Polynomial = P>,
{
    type Run<'a>
        = Recorded<'a, M::Run<'a>, R, P, N>
    where
        Self: 'a;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        Recorded { run: self.method.start(start), log: &self.log, last: None, state: PhantomData }
    }

    /// A step that is not taken is not kept.
    fn restart<'a>(&'a self, run: &mut Self::Run<'a>, start: &Checkpoint<R, N>) {
        self.method.restart(&mut run.run, start);
        run.last = None;
        let steps = &mut self.log.borrow_mut().steps;
        while steps.last().is_some_and(|step| (step.start - start.time).to_f64() == 0.0) {
            steps.pop();
        }
    }
}

/// A run of the method.
pub(super) struct Recorded<'a, C, R, P, const N: usize> {
    run: C,
    log: &'a RefCell<Log<R, P>>,
    last: Option<P>,
    state: PhantomData<[R; N]>,
}

impl<C, R, S, P, const N: usize> StepperRun<R, S, N> for Recorded<'_, C, R, P, N>
where
    R: Real,
    S: System<R, N>,
    P: Interpolant<R, N>,
    C: StepperRun<R, S, N, Polynomial = P>,
{
    const EVALUATIONS: u32 = C::EVALUATIONS;
    const JUDGED: bool = C::JUDGED;
    const COARSE_POLYNOMIAL: bool = C::COARSE_POLYNOMIAL;
    type Polynomial = P;

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        self.run.checkpoint()
    }

    fn advance(&mut self, system: &S, target: R, _dense: bool) -> Result<(), Cause> {
        let start = self.run.checkpoint().time;
        self.run.advance(system, target, true)?;
        let polynomial = self.run.dense(system);
        self.last = Some(polynomial);
        self.log.borrow_mut().push(Step { start, polynomial })
    }

    fn try_first(&mut self, step: f64) {
        self.run.try_first(step);
    }

    fn is_last(&self, target: R) -> bool {
        self.run.is_last(target)
    }

    fn defect(&self, system: &S, before: &Checkpoint<R, N>) -> [R; N] {
        self.run.defect(system, before)
    }

    fn dense(&mut self, system: &S) -> P {
        match self.last {
            Some(polynomial) => polynomial,
            None => self.run.dense(system),
        }
    }
}
