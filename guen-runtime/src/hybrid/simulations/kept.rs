//! The polynomials of the steps of a simulation through modes and its modes, kept in bounded memory.

use alloc::vec::Vec;
use core::cell::{Cell, RefCell};

use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::steppers::{Cause, Checkpoint, Interpolant, Method, StepperRun};

/// A part of a motion in one mode.
pub(in crate::hybrid) struct Segment<H, const N: usize, const W: usize, const C: usize, const S: usize> {
    pub(in crate::hybrid) start: f64,
    pub(in crate::hybrid) state: [f64; N],
    pub(in crate::hybrid) in_mode: InMode<H, N, W, C, S>,
    /// The position of its first step.
    pub(super) first: usize,
    /// The number of transitions until it begins, that with which it begins included.
    pub(in crate::hybrid) transitions: usize,
}

/// The steps and modes of a run.
pub(in crate::hybrid) struct Log<H, P, const N: usize, const W: usize, const C: usize, const S: usize> {
    pub(in crate::hybrid) segments: Vec<Segment<H, N, W, C, S>>,
    /// The beginnings and polynomials of steps.
    pub(super) steps: Vec<(f64, P)>,
}

/// A list that takes at most so much memory.
fn push<T>(list: &mut Vec<T>, entry: T, memory: usize) -> Result<(), Cause> {
    let full = (list.len() + 1).saturating_mul(size_of::<T>()) > memory;
    if full || list.try_reserve(1).is_err() {
        return Err(Cause::Memory { limit: memory });
    }
    list.push(entry);
    Ok(())
}

impl<H: Clone, P, const N: usize, const W: usize, const C: usize, const S: usize> Log<H, P, N, W, C, S> {
    pub(super) fn new() -> Self {
        Self { segments: Vec::new(), steps: Vec::new() }
    }

    /// The number of transitions until the last mode begins.
    pub(in crate::hybrid) fn told(&self) -> usize {
        self.segments.last().map_or(0, |segment| segment.transitions)
    }

    /// Keeps a mode that begins.
    pub(super) fn begin(
        &mut self,
        (start, state): (f64, &[f64; N]),
        in_mode: &InMode<H, N, W, C, S>,
        (first, transitions): (usize, usize),
        memory: usize,
    ) -> Result<(), Cause> {
        let segment = Segment { start, state: *state, in_mode: in_mode.clone(), first, transitions };
        push(&mut self.segments, segment, memory)
    }
}

/// A method that keeps the polynomial of every step of which somebody asks for it.
pub(super) struct Kept<'m, M, P, const N: usize> {
    method: &'m M,
    steps: RefCell<Vec<(f64, P)>>,
    memory: usize,
    /// The beginning of the first step that did not fit: then no further one is made.
    full: Cell<Option<(f64, [f64; N])>>,
}

impl<'m, M, P, const N: usize> Kept<'m, M, P, N> {
    pub(super) fn new(method: &'m M, memory: usize) -> Self {
        Self { method, steps: RefCell::new(Vec::new()), memory, full: Cell::new(None) }
    }

    /// The number of steps that it has kept.
    pub(super) fn count(&self) -> usize {
        self.steps.borrow().len()
    }

    /// The time and state up to which everything fitted; none if all did.
    pub(super) fn full(&self) -> Option<(f64, [f64; N])> {
        self.full.get()
    }

    pub(super) fn into_steps(self) -> Vec<(f64, P)> {
        self.steps.into_inner()
    }
}

impl<Y, M, P, const N: usize> Method<f64, Y, N> for Kept<'_, M, P, N>
where
    P: Interpolant<f64, N>,
    M: Method<f64, Y, N>,
    for<'r> M::Run<'r>: StepperRun<f64, Y, N, Polynomial = P>,
{
    type Run<'a>
        = KeptRun<'a, 'a, M::Run<'a>, M, P, N>
    where
        Self: 'a;

    fn start(&self, start: &Checkpoint<f64, N>) -> Self::Run<'_> {
        KeptRun { run: self.method.start(start), kept: self, before: (start.time, start.state) }
    }
}

/// A run of the method.
pub(super) struct KeptRun<'a, 'm, X, M, P, const N: usize> {
    run: X,
    kept: &'a Kept<'m, M, P, N>,
    /// The beginning of the last step.
    before: (f64, [f64; N]),
}

impl<X, Y, M, P, const N: usize> StepperRun<f64, Y, N> for KeptRun<'_, '_, X, M, P, N>
where
    P: Interpolant<f64, N>,
    X: StepperRun<f64, Y, N, Polynomial = P>,
{
    const EVALUATIONS: u32 = X::EVALUATIONS;
    const JUDGED: bool = X::JUDGED;
    const COARSE_POLYNOMIAL: bool = X::COARSE_POLYNOMIAL;
    type Polynomial = P;

    fn checkpoint(&self) -> &Checkpoint<f64, N> {
        self.run.checkpoint()
    }

    fn advance(&mut self, system: &Y, target: f64, dense: bool) -> Result<(), Cause> {
        if self.kept.full.get().is_some() {
            return Err(Cause::Memory { limit: self.kept.memory });
        }
        let here = self.run.checkpoint();
        self.before = (here.time, here.state);
        self.run.advance(system, target, dense)
    }

    fn try_first(&mut self, step: f64) {
        self.run.try_first(step);
    }

    fn is_last(&self, target: f64) -> bool {
        self.run.is_last(target)
    }

    fn dense(&mut self, system: &Y) -> P {
        let polynomial = self.run.dense(system);
        let Kept { steps, memory, full, .. } = self.kept;
        let kept = push(&mut steps.borrow_mut(), (self.before.0, polynomial), *memory);
        if kept.is_err() && full.get().is_none() {
            full.set(Some(self.before));
        }
        polynomial
    }
}
