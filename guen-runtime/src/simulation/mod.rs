//! Simulations: a run of a system from a named state, and the trajectory that it leaves. Needs the feature `alloc`.
//!
//! The run is an [`Integration`](crate::steppers::Integration) of a method that keeps the polynomial of every step; what does
//! not ask for a trajectory does not pay for one.

mod error;
mod hold;
mod optional_projection;
mod recorder;
mod sampling;
mod trajectory;
mod trigger;
mod without_inputs;

use alloc::boxed::Box;
use core::ops::{ControlFlow, Range};

pub use error::SimulationError;
pub use trajectory::{Happened, Quality, Trajectory};
pub use trigger::Trigger;
pub use without_inputs::SimulationWithoutInputs;

use super::system::inputs::actuated::Actuated;
use crate::numbers::real::Ordered;
use crate::simulation::hold::{Hold, Sampled};
use crate::simulation::optional_projection::OptionalProjection;
use crate::simulation::recorder::Recorder;
use crate::simulation::sampling::{Continuous, Sampling};
use crate::steppers::{Dop853, Event, Guard, Integration, Interpolant, Method, Occurrence, StepperRun};
use crate::system::simulate::Simulate;

/// The tolerance of a simulation that nobody sets, relative and absolute.
const TOLERANCE: f64 = 1e-9;

/// The memory that a trajectory may take unless another limit is set: 256 MiB.
const MEMORY: usize = 1 << 28;

/// The function that is called after every step.
type Observer<'a, R, X> = Box<dyn FnMut(R, &X) -> ControlFlow<()> + 'a>;

/// The function that is told how far a run has come.
type Progress<'a, R> = Box<dyn FnMut(R, f64) + 'a>;

/// A simulation that is being described: system and start are given, everything else has a default.
///
/// | setting | default |
/// | --- | --- |
/// | [`method`](Self::method), [`tolerance`](Self::tolerance) | [`Dop853`] with 1e-9, relative and absolute |
/// | [`guard`](Self::guard) | the default [`Guard`], after every step |
/// | [`stop_at`](Self::stop_at), [`events`](Self::events) | none |
/// | [`observe`](Self::observe), [`progress`](Self::progress) | nobody |
/// | [`memory`](Self::memory) | 256 MiB for the trajectory |
/// | constraints on positions | put back after every step; not [`without_projection`](Self::without_projection) |
///
/// ```
/// use guen_runtime::steppers::Rk8;
/// use guen_runtime::{Simulate, from_fn};
///
/// // A stone is thrown up with 10 m/s, and lands.
/// let stone = from_fn(|_t: f64, &[_, v]: &[f64; 2]| [v, -9.81]);
/// let flight = stone
///     .simulation(&[0.0, 10.0])
///     .method(Rk8::new(0.1))
///     .stop_at(|_t, &[height, _]| height)
///     .run(0.0..100.0)
///     .unwrap();
/// assert!((flight.end_time() - 20.0 / 9.81).abs() < 1e-12);
/// assert!((flight.at(1.0)[0] - (10.0 - 9.81 / 2.0)).abs() < 1e-12);
/// ```
#[must_use = "a simulation runs when `run` is called"]
pub struct Simulation<'a, S, const N: usize, R = f64, M = Dop853<R>, const E: usize = 0, D = Continuous>
where
    R: Ordered,
    S: Simulate<R, N>,
{
    system: S,
    start: S::State,
    method: M,
    guard: Guard,
    memory: usize,
    projects: bool,
    triggers: [Trigger<'a, R, S::State>; E],
    observer: Option<Observer<'a, R, S::State>>,
    progress: Option<Progress<'a, R>>,
    sampling: D,
}

impl<S, const N: usize, R, M, const E: usize, D> core::fmt::Debug for Simulation<'_, S, N, R, M, E, D>
where
    R: Ordered,
    S: Simulate<R, N>,
    M: core::fmt::Debug,
{
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Simulation")
            .field("method", &self.method)
            .field("guard", &self.guard)
            .field("memory", &self.memory)
            .finish_non_exhaustive()
    }
}

impl<R: Ordered, S: Simulate<R, N>, const N: usize> Simulation<'_, S, N, R> {
    pub(crate) fn new(system: S, start: &S::State) -> Self {
        Self::sampled_by(system, start, Continuous)
    }
}

impl<R: Ordered, S: Simulate<R, N>, D, const N: usize> Simulation<'_, S, N, R, Dop853<R>, 0, D> {
    fn sampled_by(system: S, start: &S::State, sampling: D) -> Self {
        Self {
            system,
            start: *start,
            method: Dop853::new(TOLERANCE, TOLERANCE),
            guard: Guard { every: Some(1), ..Guard::default() },
            memory: MEMORY,
            projects: true,
            triggers: [],
            observer: None,
            progress: None,
            sampling,
        }
    }

    /// Sets the tolerance of the default method, relative and absolute.
    pub fn tolerance(self, tolerance: f64) -> Self {
        Self { method: Dop853::new(tolerance, tolerance), ..self }
    }
}

impl<'a, R: Ordered, S: Simulate<R, N>, M, D, const N: usize> Simulation<'a, S, N, R, M, 0, D> {
    /// Ends the run where this function of time and state crosses zero, in either direction; the trajectory ends there.
    pub fn stop_at(self, function: impl Fn(R, &S::State) -> R + 'a) -> Simulation<'a, S, N, R, M, 1, D> {
        self.events([Trigger::new(function).terminal()])
    }

    /// Looks for these events; those that happen are the trajectory's [`events`](Trajectory::events).
    ///
    /// ```
    /// use guen_runtime::steppers::Direction;
    /// use guen_runtime::{Simulate, Trigger, from_fn};
    ///
    /// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
    /// let motion = oscillator
    ///     .simulation(&[1.0, 0.0])
    ///     .events([
    ///         Trigger::new(|_t, &[x, _]: &[f64; 2]| x),
    ///         Trigger::new(|_t, &[_, v]: &[f64; 2]| v).direction(Direction::Rising),
    ///     ])
    ///     .run(0.0..5.0)
    ///     .unwrap();
    /// let order: Vec<usize> = motion.events().iter().map(|event| event.index).collect();
    /// assert_eq!(order, [0, 1, 0]);
    /// ```
    pub fn events<const E: usize>(
        self,
        triggers: [Trigger<'a, R, S::State>; E],
    ) -> Simulation<'a, S, N, R, M, E, D> {
        let Self { system, start, method, guard, memory, projects, observer, progress, sampling, .. } = self;
        Simulation { system, start, method, guard, memory, projects, triggers, observer, progress, sampling }
    }
}

impl<'a, R, S, M, D, const N: usize, const E: usize> Simulation<'a, S, N, R, M, E, D>
where
    R: Ordered,
    S: Simulate<R, N>,
{
    /// Runs with this method.
    pub fn method<T>(self, method: T) -> Simulation<'a, S, N, R, T, E, D> {
        let Self { system, start, guard, memory, projects, triggers, observer, progress, sampling, .. } =
            self;
        Simulation { system, start, method, guard, memory, projects, triggers, observer, progress, sampling }
    }

    /// Watches with these limits in place of the default ones.
    pub fn guard(self, guard: Guard) -> Self {
        Self { guard, ..self }
    }

    /// Sets the memory that the trajectory may take, in bytes: a step of [`Dop853`] takes about `8 (8 N + 3)`. A run that
    /// needs more ends with [`Cause::Memory`](crate::Cause::Memory), and the error has the trajectory up to there.
    pub fn memory(self, bytes: usize) -> Self {
        Self { memory: bytes, ..self }
    }

    /// Leaves the coordinates where the method puts them. Otherwise a declared system with constraints on positions `f(t, x) = 0` is
    /// put back onto them after every step, by [`project`](crate::project), and so are the states between steps; a state that
    /// cannot be ends the run with [`Cause::Positions`](crate::Cause::Positions). Without it `f` drifts by the error of the method,
    /// and a step takes a tenth to a sixth less of the time.
    pub fn without_projection(self) -> Self {
        Self { projects: false, ..self }
    }

    /// Shows every accepted step; when the observer breaks, the run ends there.
    pub fn observe(self, observer: impl FnMut(R, &S::State) -> ControlFlow<()> + 'a) -> Self {
        Self { observer: Some(Box::new(observer)), ..self }
    }

    /// Says after every accepted step at which time the run is, and which part of its span is done, from zero to one: for what a
    /// user is shown. Costs a call for each step.
    ///
    /// ```
    /// use guen_runtime::{Simulate, from_fn};
    ///
    /// let decay = from_fn(|_t: f64, &[x]: &[f64; 1]| [-x]);
    /// let mut shown = Vec::new();
    /// decay.simulation(&[1.0]).progress(|_t, part| shown.push(part)).run(0.0..4.0).unwrap();
    /// assert!(shown.is_sorted() && shown.last() == Some(&1.0));
    /// ```
    pub fn progress(self, progress: impl FnMut(R, f64) + 'a) -> Self {
        Self { progress: Some(Box::new(progress)), ..self }
    }

    /// Runs with inputs that are continuous, or held between samples, as `D` says.
    #[allow(clippy::type_complexity, reason = "a trajectory is as general as what made it")]
    fn run_sampled<P>(self, span: Range<R>) -> Result<Trajectory<S, N, R, P>, SimulationError<S, N, R, P>>
    where
        P: Interpolant<R, N>,
        D: Sampling<R, S, M, P, N>,
    {
        let Self {
            system,
            start,
            method,
            guard,
            memory,
            projects,
            triggers,
            mut observer,
            mut progress,
            mut sampling,
        } = self;
        let start: [R; N] = start.into();
        let functions = triggers.each_ref().map(|trigger| trigger.of_array());
        let events: [Event<'_, R, N>; E] = core::array::from_fn(|i| triggers[i].event(functions[i].as_ref()));
        let mut happened = alloc::vec::Vec::new();
        let mut receive = |event: &Occurrence<R, N>| {
            happened.push(Happened {
                index: event.index,
                time: event.time,
                state: S::State::from(event.state),
                rising: event.rising,
            });
            ControlFlow::Continue(())
        };
        let duration = span.end - span.start;
        let mut observe = |t: R, x: &[R; N]| {
            if let Some(progress) = &mut progress {
                progress(t, ((t - span.start) / duration).to_f64());
            }
            match &mut observer {
                Some(observer) => observer(t, &S::State::from(*x)),
                None => ControlFlow::Continue(()),
            }
        };
        let system = OptionalProjection { system, projects };
        let integration = Integration::new(&system, span.start, &start)
            .guard(guard)
            .observe(&mut observe)
            .events(events, &mut receive);
        let recorder = Recorder::new(&method, memory, D::MEMORY);
        let result = integration.run(&sampling.method(&recorder), span.end);
        let steps = recorder.into_steps();
        let (end, statistics, outcome, cause) = match result {
            Ok(done) => ((done.time, done.state), done.statistics, Some(done.outcome), None),
            Err(error) => ((error.time, error.state), error.statistics, None, Some(error.cause)),
        };
        drop(functions);
        let system = OptionalProjection { system: sampling.finished(system.system), projects };
        let trajectory =
            Trajectory::new(system, (span.start, start), steps, end, happened, statistics, outcome);
        match cause {
            None => Ok(trajectory),
            Some(cause) => Err(SimulationError { time: end.0, cause, trajectory: Box::new(trajectory) }),
        }
    }
}

impl<R, S, M, const N: usize, const E: usize> Simulation<'_, S, N, R, M, E>
where
    R: Ordered,
    S: Simulate<R, N>,
{
    /// Runs from the start of the span to its end, forwards or backwards, and returns the motion.
    ///
    /// # Errors
    ///
    /// Settings that make no sense; else what stopped the method, what the guard found, or that the memory is not enough:
    /// with the trajectory up to the last good time.
    #[allow(clippy::type_complexity, reason = "a trajectory is as general as what made it")]
    pub fn run<P>(self, span: Range<R>) -> Result<Trajectory<S, N, R, P>, SimulationError<S, N, R, P>>
    where
        P: Interpolant<R, N>,
        M: Method<R, OptionalProjection<S>, N>,
        for<'r> M::Run<'r>: StepperRun<R, OptionalProjection<S>, N, Polynomial = P>,
    {
        self.run_sampled(span)
    }
}

impl<S, R, M, const N: usize, const E: usize> Simulation<'_, Sampled<S, R, N>, N, R, M, E, Hold<'_, S, R, N>>
where
    R: Ordered,
    S: Actuated<R, N>,
{
    /// Runs from the start of the span to its end, forwards, and returns the motion with the inputs that the controller held.
    ///
    /// # Errors
    ///
    /// Settings that make no sense; else what stopped the method, what the guard found, or that the memory is not enough:
    /// with the trajectory up to the last good time.
    #[allow(clippy::type_complexity, reason = "a trajectory is as general as what made it")]
    pub fn run<P>(
        self,
        span: Range<R>,
    ) -> Result<Trajectory<Sampled<S, R, N>, N, R, P>, SimulationError<Sampled<S, R, N>, N, R, P>>
    where
        P: Interpolant<R, N>,
        M: Method<R, OptionalProjection<S::Driven>, N>,
        for<'r> M::Run<'r>: StepperRun<R, OptionalProjection<S::Driven>, N, Polynomial = P>,
    {
        self.run_sampled(span)
    }
}
