//! Simulations through modes: a run from a named state, and the trajectory that it leaves.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::cell::Cell;
use core::fmt;
use core::ops::{ControlFlow, Range};

use super::kept::{Kept, Log};
use super::trajectory::HybridTrajectory;
use crate::hybrid::execution::driver::Hybrid;
use crate::hybrid::interface::error::{HybridCause, HybridError};
use crate::hybrid::interface::mode::Mode;
use crate::hybrid::interface::system::HybridSystem;
use crate::hybrid::interface::transition::Transition;
use crate::hybrid::mode_dynamics::in_mode::InMode;
use crate::steppers::{Cause, Dense, Dop853, Guard, Interpolant, Method, StepperRun};

/// The tolerance of a simulation that nobody sets, relative and absolute.
const TOLERANCE: f64 = 1e-9;
/// The memory that a trajectory may take unless another limit is set: 256 MiB.
const MEMORY: usize = 1 << 28;

/// Is told of each transition; ends the run when it breaks.
type Receiver<'a, M, const N: usize, const W: usize, const C: usize> =
    Box<dyn FnMut(&Transition<M, N, W, C>) -> ControlFlow<()> + 'a>;

/// A function of time and state that finds inputs, with its period.
type Sampled<'a, I, X> = (f64, Box<dyn FnMut(f64, &X) -> I + 'a>);

/// A simulation through modes that is being described: system and start are given, everything else has a default.
///
/// | setting | default |
/// | --- | --- |
/// | [`method`](Self::method), [`tolerance`](Self::tolerance) | [`Dop853`] with 1e-9, relative and absolute |
/// | [`inputs`](Self::inputs), [`hold`](Self::hold) | those of the system |
/// | [`observe_transitions`](Self::observe_transitions) | nobody |
/// | [`resting_accuracy`](Self::resting_accuracy), [`max_transitions`](Self::max_transitions), [`guard`](Self::guard) | those of [`Hybrid`] |
/// | [`memory`](Self::memory) | 256 MiB for the trajectory |
#[must_use = "a simulation runs when `run` is called"]
pub struct HybridSimulation<
    'a,
    H,
    X,
    const N: usize,
    const W: usize,
    const C: usize,
    const S: usize,
    M = Dop853<f64>,
> where
    H: HybridSystem<N, W, C, S>,
{
    system: H,
    start: X,
    method: M,
    memory: usize,
    inputs: Vec<(f64, H::Inputs)>,
    sampled: Option<Sampled<'a, H::Inputs, X>>,
    receiver: Option<Receiver<'a, H::Mode, N, W, C>>,
    resting_accuracy: Option<f64>,
    max_transitions: Option<u64>,
    guard: Option<Guard>,
}

impl<'a, H, X, M, const N: usize, const W: usize, const C: usize, const S: usize>
    HybridSimulation<'a, H, X, N, W, C, S, M>
where
    H: HybridSystem<N, W, C, S> + Clone,
    X: Copy + From<[f64; N]> + Into<[f64; N]>,
{
    /// Sets the method.
    pub fn method<M2>(self, method: M2) -> HybridSimulation<'a, H, X, N, W, C, S, M2> {
        let Self {
            system,
            start,
            memory,
            inputs,
            sampled,
            receiver,
            resting_accuracy,
            max_transitions,
            guard,
            ..
        } = self;
        HybridSimulation {
            system,
            start,
            method,
            memory,
            inputs,
            sampled,
            receiver,
            resting_accuracy,
            max_transitions,
            guard,
        }
    }

    /// Changes the inputs at these times, in order.
    pub fn inputs(self, inputs: &[(f64, H::Inputs)]) -> Self {
        Self { inputs: inputs.to_vec(), ..self }
    }

    /// Holds inputs that a controller finds every `period`, from the start on, as [`Hybrid::hold`] does. The controller may have a memory.
    /// The trajectory knows the inputs: its modes begin anew with them.
    pub fn hold(self, period: f64, controller: impl FnMut(f64, &X) -> H::Inputs + 'a) -> Self {
        Self { sampled: Some((period, Box::new(controller))), ..self }
    }

    /// Tells a receiver of every transition; when it breaks, the run ends there.
    pub fn observe_transitions(
        self,
        receiver: impl FnMut(&Transition<H::Mode, N, W, C>) -> ControlFlow<()> + 'a,
    ) -> Self {
        Self { receiver: Some(Box::new(receiver)), ..self }
    }

    /// Sets the error, as a time, with which the end of infinitely many impacts may be found.
    pub fn resting_accuracy(self, time: f64) -> Self {
        Self { resting_accuracy: Some(time), ..self }
    }

    /// Limits the number of transitions.
    pub fn max_transitions(self, limit: u64) -> Self {
        Self { max_transitions: Some(limit), ..self }
    }

    /// Sets the limits of what is watched within a mode.
    pub fn guard(self, guard: Guard) -> Self {
        Self { guard: Some(guard), ..self }
    }

    /// Limits the memory of the steps of the trajectory, and that of its modes, in bytes.
    pub fn memory(self, bytes: usize) -> Self {
        Self { memory: bytes, ..self }
    }

    /// Runs over a span of time, forwards.
    ///
    /// # Errors
    ///
    /// What kept the motion from going on, with the trajectory until then.
    #[allow(clippy::type_complexity, reason = "one trajectory or the error with it")]
    pub fn run<P>(
        self,
        span: Range<f64>,
    ) -> Result<HybridTrajectory<H, X, N, W, C, S, P>, HybridSimulationError<H, X, N, W, C, S, P>>
    where
        M: Method<f64, InMode<H, N, W, C, S>, N>,
        for<'r> M::Run<'r>: StepperRun<f64, InMode<H, N, W, C, S>, N, Polynomial = P>,
        P: Interpolant<f64, N>,
    {
        let Self {
            system,
            start,
            method,
            memory,
            inputs,
            sampled,
            mut receiver,
            resting_accuracy,
            max_transitions,
            guard,
        } = self;
        let mut transitions = Vec::new();
        let told = Cell::new(0);
        let kept = Kept::new(&method, memory);
        let mut log = Log::new();
        let mut tell = |transition: &Transition<H::Mode, N, W, C>| {
            transitions.push(*transition);
            told.set(told.get() + 1);
            receiver.as_mut().map_or(ControlFlow::Continue(()), |receiver| receiver(transition))
        };
        let is_sampled = sampled.is_some();
        let (period, mut controller) = sampled.unzip();
        let mut find =
            controller.as_mut().map(|controller| |t: f64, state: &[f64; N]| controller(t, &(*state).into()));
        let mut hybrid =
            Hybrid::new(&system, span.start, &start.into()).inputs(&inputs).transitions(&mut tell);
        if let (Some(period), Some(find)) = (period, &mut find) {
            hybrid = hybrid.hold(period, find);
        }
        if let Some(time) = resting_accuracy {
            hybrid = hybrid.resting_accuracy(time);
        }
        if let Some(limit) = max_transitions {
            hybrid = hybrid.max_transitions(limit);
        }
        if let Some(guard) = guard {
            hybrid = hybrid.guard(guard);
        }
        let done = hybrid.witnessed(&kept, span.end, &mut |t, state, in_mode| {
            log.begin((t, state), in_mode, (kept.count(), told.get()), memory)
        });
        // What happened in a step that did not fit is no part of the motion.
        let full = kept.full();
        log.steps = kept.into_steps();
        let done = match (done, full) {
            (done, None) => done.map(|done| (done.t, done.state, done.work)),
            (done, Some((t, state))) => {
                log.segments.retain(|segment| segment.start <= t);
                transitions.retain(|transition: &Transition<H::Mode, N, W, C>| transition.t <= t);
                let work = done.map_or_else(|error| error.work, |done| done.work);
                let mode = log.segments.last().map_or(Mode::free(&H::ELEMENTS), |part| part.in_mode.mode());
                let cause = HybridCause::Integration(Cause::Memory { limit: memory });
                Err(HybridError { t, mode, state, cause, work })
            }
        };
        let (t, state, work) = match &done {
            Ok(done) => *done,
            Err(error) => (error.t, error.state, error.work),
        };
        let trajectory =
            HybridTrajectory::new(log, (span.start, start), (t, state.into()), transitions, work)
                .sampled(is_sampled);
        match done {
            Ok(_) => Ok(trajectory),
            Err(error) => Err(HybridSimulationError { error, trajectory: Box::new(trajectory) }),
        }
    }
}

impl<'a, H, X, const N: usize, const W: usize, const C: usize, const S: usize>
    HybridSimulation<'a, H, X, N, W, C, S>
where
    H: HybridSystem<N, W, C, S>,
{
    /// A simulation of a system from a state.
    pub(in crate::hybrid) fn new(system: H, start: &X) -> Self
    where
        X: Copy,
    {
        Self {
            system,
            start: *start,
            method: Dop853::new(TOLERANCE, TOLERANCE),
            memory: MEMORY,
            inputs: Vec::new(),
            sampled: None,
            receiver: None,
            resting_accuracy: None,
            max_transitions: None,
            guard: None,
        }
    }

    /// Sets the tolerance of the default method, relative and absolute.
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self { method: Dop853::new(tolerance, tolerance), ..self }
    }
}

/// A simulation through modes that failed: why it stopped, and the motion until then.
pub struct HybridSimulationError<
    H,
    X,
    const N: usize,
    const W: usize,
    const C: usize,
    const S: usize,
    P = Dense<f64, N>,
> where
    H: HybridSystem<N, W, C, S>,
{
    /// The time and state at which it stopped, and the reason.
    pub error: HybridError<N, C>,
    /// The motion up to there.
    pub trajectory: Box<HybridTrajectory<H, X, N, W, C, S, P>>,
}

impl<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize> fmt::Debug
    for HybridSimulationError<H, X, N, W, C, S, P>
where
    H: HybridSystem<N, W, C, S>,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // The message, because `main` and `unwrap` show an error so; the motion until then would hide it.
        write!(f, "HybridSimulationError({self})")
    }
}

impl<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize> fmt::Display
    for HybridSimulationError<H, X, N, W, C, S, P>
where
    H: HybridSystem<N, W, C, S>,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.error, f)
    }
}

impl<H, X, P, const N: usize, const W: usize, const C: usize, const S: usize> core::error::Error
    for HybridSimulationError<H, X, N, W, C, S, P>
where
    H: HybridSystem<N, W, C, S>,
{
}
