//! The polynomials of the steps of a simulation through modes and its modes, kept in bounded memory.

use alloc::vec::Vec;
use core::cell::RefCell;
use core::marker::PhantomData;

use crate::hybrid::in_mode::InMode;
use crate::numbers::real::Real;
use crate::steppers::{Cause, Checkpoint, Interpolant, Method, StepperRun};

/// A part of a motion in one mode.
pub(super) struct Segment<H, const N: usize, const W: usize, const C: usize, const S: usize> {
    pub(super) start: f64,
    pub(super) state: [f64; N],
    pub(super) in_mode: InMode<H, N, W, C, S>,
    /// The position of its first step.
    pub(super) first: usize,
}

/// The steps and modes of a run.
pub(super) struct Log<H, P, const N: usize, const W: usize, const C: usize, const S: usize> {
    pub(super) segments: Vec<Segment<H, N, W, C, S>>,
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

    /// Keeps a mode that begins.
    pub(super) fn begin(
        &mut self,
        (start, state): (f64, &[f64; N]),
        in_mode: &InMode<H, N, W, C, S>,
        first: usize,
        memory: usize,
    ) -> Result<(), Cause> {
        let segment = Segment { start, state: *state, in_mode: in_mode.clone(), first };
        push(&mut self.segments, segment, memory)
    }
}

/// A method that keeps the polynomial of every step of which somebody asks for it.
pub(super) struct Kept<'m, M, P> {
    method: &'m M,
    steps: RefCell<Vec<(f64, P)>>,
    memory: usize,
}

impl<'m, M, P> Kept<'m, M, P> {
    pub(super) fn new(method: &'m M, memory: usize) -> Self {
        Self { method, steps: RefCell::new(Vec::new()), memory }
    }

    /// The number of steps that it has kept.
    pub(super) fn count(&self) -> usize {
        self.steps.borrow().len()
    }

    pub(super) fn into_steps(self) -> Vec<(f64, P)> {
        self.steps.into_inner()
    }
}

impl<R, Y, M, P, const N: usize> Method<R, Y, N> for Kept<'_, M, P>
where
    R: Real,
    P: Interpolant<R, N>,
    M: Method<R, Y, N>,
    for<'r> M::Run<'r>: StepperRun<R, Y, N, Polynomial = P>,
{
    type Run<'a>
        = KeptRun<'a, M::Run<'a>, R, P, N>
    where
        Self: 'a;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        let (steps, memory) = (&self.steps, self.memory);
        let run = self.method.start(start);
        KeptRun { run, steps, memory, before: start.time, full: false, state: PhantomData }
    }
}

/// A run of the method.
pub(super) struct KeptRun<'a, X, R, P, const N: usize> {
    run: X,
    steps: &'a RefCell<Vec<(f64, P)>>,
    memory: usize,
    /// The beginning of the last step.
    before: R,
    full: bool,
    state: PhantomData<[R; N]>,
}

impl<X, R, Y, P, const N: usize> StepperRun<R, Y, N> for KeptRun<'_, X, R, P, N>
where
    R: Real,
    P: Interpolant<R, N>,
    X: StepperRun<R, Y, N, Polynomial = P>,
{
    const EVALUATIONS: u32 = X::EVALUATIONS;
    const JUDGED: bool = X::JUDGED;
    const COARSE_POLYNOMIAL: bool = X::COARSE_POLYNOMIAL;
    type Polynomial = P;

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        self.run.checkpoint()
    }

    fn advance(&mut self, system: &Y, target: R, dense: bool) -> Result<(), Cause> {
        if self.full {
            return Err(Cause::Memory { limit: self.memory });
        }
        self.before = self.run.checkpoint().time;
        self.run.advance(system, target, dense)
    }

    fn try_first(&mut self, step: f64) {
        self.run.try_first(step);
    }

    fn is_last(&self, target: R) -> bool {
        self.run.is_last(target)
    }

    fn dense(&mut self, system: &Y) -> P {
        let polynomial = self.run.dense(system);
        let kept = push(&mut self.steps.borrow_mut(), (self.before.to_f64(), polynomial), self.memory);
        self.full |= kept.is_err();
        polynomial
    }
}
