//! A run through modes as its user sets it up.

use core::ops::ControlFlow;

use super::held::{Controller, Sampler};
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::interface::transition::Transition;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::steppers::{Guard, Statistics};

/// Is shown each sample: its position, time, state and mode.
type Visitor<'a, M, const N: usize> = &'a mut dyn FnMut(usize, f64, &[f64; N], &M);
/// Is told of each transition; ends the run when it breaks.
type Receiver<'a, M, const N: usize, const W: usize, const C: usize> =
    &'a mut dyn FnMut(&Transition<M, N, W, C>) -> ControlFlow<()>;

/// Is told of each transition with the systems in the modes before and after it; ends the run when it breaks.
type Between<'a, H, M, const N: usize, const W: usize, const C: usize, const S: usize> =
    &'a mut dyn FnMut(
        &Transition<M, N, W, C>,
        &InMode<H, N, W, C, S>,
        &InMode<H, N, W, C, S>,
    ) -> ControlFlow<()>;

/// A run of a system with contacts through its modes, from one time and state.
///
/// - The mode at the start is found: contacts whose gap is zero touch, latches whose gap is zero at rest are locked. What moves into a
///   contact there meets it at once.
/// - The step in which a mode ends is cut there; the next one begins with its size.
/// - A run goes forwards in time. Runs over duals are refused by the types: the times of transitions depend on the start, which their
///   derivatives would not know. Derivatives go through transitions by [`Transition::saltation`].
/// - Spatial slip that begins from rest is stiff, since its direction follows the force at once: explicit methods make some ten thousand
///   small steps there.
/// - A [`Guard`] watches it within its modes: it refuses to come close to where the chart or the equations end. Permanent constraints on
///   positions, gaps and slips that are closed are put back after every step; the start is put onto the permanent ones.
///
/// The [module](crate::hybrid) has an example.
pub struct Hybrid<'a, H, const N: usize, const W: usize, const C: usize, const S: usize>
where
    H: HybridSystem<N, W, C, S>,
{
    pub(super) system: &'a H,
    pub(super) t: f64,
    pub(super) state: [f64; N],
    pub(super) samples: &'a [f64],
    pub(super) visitor: Option<Visitor<'a, H::Mode, N>>,
    pub(super) inputs: &'a [(f64, H::Inputs)],
    pub(super) sampler: Option<Sampler<'a, H::Inputs, N>>,
    pub(super) receiver: Option<Receiver<'a, H::Mode, N, W, C>>,
    pub(super) between: Option<Between<'a, H, H::Mode, N, W, C, S>>,
    pub(super) resting_accuracy: f64,
    pub(super) max_transitions: u64,
    pub(super) guard: Guard,
}

/// The end of a run through modes that did not fail: what [`Hybrid::run`] returns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HybridResult<M, const N: usize> {
    /// The time reached.
    pub t: f64,
    /// The state at that time.
    pub state: [f64; N],
    /// The mode at that time.
    pub mode: M,
    /// Whether the receiver of transitions ended the run.
    pub stopped: bool,
    /// The number of transitions.
    pub transitions: u64,
    /// The work done.
    pub work: Statistics,
}

impl<'a, H, const N: usize, const W: usize, const C: usize, const S: usize> Hybrid<'a, H, N, W, C, S>
where
    H: HybridSystem<N, W, C, S> + Clone,
{
    /// The number of transitions allowed unless another one is set.
    pub const MAX_TRANSITIONS: u64 = 10_000_000;

    /// A run of the system from a time and state. The mode at the start is found: contacts whose gap is zero touch.
    pub fn new(system: &'a H, t: f64, state: &[f64; N]) -> Self {
        Self {
            system,
            t,
            state: *state,
            samples: &[],
            visitor: None,
            inputs: &[],
            sampler: None,
            receiver: None,
            between: None,
            resting_accuracy: 1e-12,
            max_transitions: Self::MAX_TRANSITIONS,
            guard: Guard { every: Some(1), ..Guard::default() },
        }
    }

    /// Shows the state and the mode at these times, in order from the start to the end, to a visitor; at the time of a transition those
    /// after it.
    #[must_use]
    pub fn sample(self, times: &'a [f64], visitor: Visitor<'a, H::Mode, N>) -> Self {
        Self { samples: times, visitor: Some(visitor), ..self }
    }

    /// Changes the inputs at these times, in order. No step goes across one of them.
    #[must_use]
    pub fn inputs(self, inputs: &'a [(f64, H::Inputs)]) -> Self {
        Self { inputs, ..self }
    }

    /// Holds inputs that a controller finds every `period`, from the start on. No step goes across one of these times; the controller is asked
    /// there once, in order, with the state before an impact at the same instant, and not at the end. Where [`inputs`](Self::inputs) change at
    /// the same time, the controller has the last word.
    #[must_use]
    pub fn hold(self, period: f64, controller: &'a mut dyn FnMut(f64, &[f64; N]) -> H::Inputs) -> Self {
        let controller: Controller<'a, H::Inputs, N> = controller;
        Self { sampler: Some(Sampler::new(period, controller)), ..self }
    }

    /// Tells a receiver of every transition; when it breaks, the run ends there.
    #[must_use]
    pub fn transitions(self, receiver: Receiver<'a, H::Mode, N, W, C>) -> Self {
        Self { receiver: Some(receiver), ..self }
    }

    /// Tells a receiver of every transition that ends a mode, with the systems in the modes before and after it, as
    /// [`Transition::saltation`] takes them; when it breaks, the run ends there.
    #[must_use]
    pub fn transitions_between(self, receiver: Between<'a, H, H::Mode, N, W, C, S>) -> Self {
        Self { between: Some(receiver), ..self }
    }

    /// Sets the error, as a time, with which the end of infinitely many impacts may be found: `1e-12` unless it is set. A nonnegative number.
    #[must_use]
    pub fn resting_accuracy(self, time: f64) -> Self {
        Self { resting_accuracy: time, ..self }
    }

    /// Limits the number of transitions.
    #[must_use]
    pub fn max_transitions(self, limit: u64) -> Self {
        Self { max_transitions: limit, ..self }
    }

    /// Sets the limits of what is watched within a mode; by default those of [`Guard`], after every step.
    #[must_use]
    pub fn guard(self, guard: Guard) -> Self {
        Self { guard, ..self }
    }
}
