//! The driver that all methods share: from a start to a time, with samples, events, an observer and guards.

use core::ops::ControlFlow;

use crate::numbers::real::{Ordered, Real};
use crate::steppers::driver::any_run::{Observer, SystemRun};
use crate::steppers::driver::drive_loop::{DriveLoop, Receiver, Visitor};
use crate::steppers::driver::error::IntegrationError;
use crate::steppers::driver::events::{Event, Occurrence};
use crate::steppers::driver::followed::Followed;
use crate::steppers::driver::run::{Checkpoint, IntegrationResult, Method};
use crate::steppers::guard::Guard;
use crate::system::System;

/// An integration of a system from a state: what to look at on the way, to be run by any method.
///
/// - [`observe`](Integration::observe): every accepted step, and the state at which a terminal event ends the run.
/// - [`sample`](Integration::sample): the states at given times, from the dense output, so that samples do not change
///   the steps.
/// - [`events`](Integration::events): functions of the state that cross zero, located on the dense output.
/// - [`guard`](Integration::guard): what must not happen; a [`Guard`] with its defaults is always there.
///
/// Within a step the order is that of time, then samples before events before the observer. Samples and states of
/// events are put back onto the constraints by [`System::restore`], as steps are. Runs go backwards as well; a span of
/// zero is no step, and has the sample at its time but no event. What was shown before a failure stays shown.
///
/// | method | error of the dense output within a step | further evaluations for it |
/// | --- | --- | --- |
/// | [`Euler`](crate::steppers::Euler), [`Rk4`](crate::steppers::Rk4) | `O(h^4)`, cubic Hermite | none: the slope at the end is the next step's |
/// | [`Rk8`](crate::steppers::Rk8), [`Dop853`](crate::steppers::Dop853) | `O(h^8)` | 3 (and one that `Rk8`'s next step uses) |
/// | [`Tsit5`](crate::steppers::Tsit5) | `O(h^5)` | none |
/// | [`Gauss4`](crate::steppers::Gauss4), [`Gauss6`](crate::steppers::Gauss6) | `O(h^4)` and `O(h^6)`, Hermite | 2 and 4 |
/// | [`Radau5`](crate::steppers::Radau5) | `O(h^4)`, collocation | none |
/// | [`Taylor`](crate::steppers::Taylor) | that of the step, its own series | none |
///
/// No allocation; every callback is called through a reference, once in a step.
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::from_fn;
/// use guen_runtime::steppers::{Direction, Dop853, Event, Integration, Outcome};
///
/// // A stone, thrown up with 10 m/s.
/// let stone = from_fn(|_t: f64, &[_, v]: &[f64; 2]| [v, -9.81]);
/// let (height, speed) = (|_t: f64, x: &[f64; 2]| x[0], |_t: f64, x: &[f64; 2]| x[1]);
/// let (mut samples, mut top) = (Vec::new(), 0.0);
/// let done = Integration::new(&stone, 0.0, &[0.0, 10.0])
///     .sample(&[0.0, 0.5, 1.0], &mut |_k, _t, x| samples.push(x[0]))
///     .events(
///         [Event::new(&speed), Event::new(&height).direction(Direction::Falling).terminal()],
///         &mut |event| {
///             if event.index == 0 {
///                 top = event.time;
///             }
///             ControlFlow::Continue(())
///         },
///     )
///     .run(&Dop853::new(1e-10, 1e-10), 100.0)
///     .unwrap();
/// assert_eq!(done.outcome, Outcome::Event(1));
/// assert!((done.time - 20.0 / 9.81).abs() < 1e-12 && (top - 10.0 / 9.81).abs() < 1e-12);
/// assert!((samples[1] - (5.0 - 9.81 / 8.0)).abs() < 1e-12);
/// ```
pub struct Integration<'a, R, S: ?Sized, const N: usize, const E: usize = 0> {
    system: &'a S,
    start: Checkpoint<R, N>,
    guard: Guard,
    observer: Option<Observer<'a, R, N>>,
    samples: &'a [R],
    visitor: Option<Visitor<'a, R, N>>,
    events: [Event<'a, R, N>; E],
    receiver: Option<Receiver<'a, R, N>>,
}

impl<R: Real, S: ?Sized, const N: usize, const E: usize> core::fmt::Debug for Integration<'_, R, S, N, E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Integration")
            .field("start", &self.start)
            .field("guard", &self.guard)
            .field("samples", &self.samples)
            .field("events", &self.events)
            .finish_non_exhaustive()
    }
}

impl<'a, R: Real, S: System<R, N> + ?Sized, const N: usize> Integration<'a, R, S, N> {
    /// An integration from the state `x0` at time `t0`.
    pub fn new(system: &'a S, t0: R, x0: &[R; N]) -> Self {
        Self {
            system,
            start: Checkpoint::new(t0, x0),
            guard: Guard::default(),
            observer: None,
            samples: &[],
            visitor: None,
            events: [],
            receiver: None,
        }
    }
}

impl<'a, R: Real, S: System<R, N> + ?Sized, const N: usize, const E: usize> Integration<'a, R, S, N, E> {
    /// Shows each accepted step to `observer`, but not the start; when it breaks, the run ends with
    /// [`Outcome::Stopped`](crate::steppers::Outcome::Stopped).
    #[must_use]
    pub fn observe(self, observer: &'a mut dyn FnMut(R, &[R; N]) -> ControlFlow<()>) -> Self {
        Self { observer: Some(observer), ..self }
    }

    /// Calls `visit` with the position, the time and the state at each of these times, which run in order from the
    /// start to the end of the integration and may repeat. Those after a terminal event are not visited.
    #[must_use]
    pub fn sample(self, times: &'a [R], visit: &'a mut dyn FnMut(usize, R, &[R; N])) -> Self {
        Self { samples: times, visitor: Some(visit), ..self }
    }

    /// Watches with these limits in place of the default ones.
    #[must_use]
    pub fn guard(self, guard: Guard) -> Self {
        Self { guard, ..self }
    }

    /// Reports these events to `receive`; when it breaks, the run ends there with [`Outcome::Stopped`](crate::steppers::Outcome::Stopped), and after a
    /// terminal event with [`Outcome::Event`](crate::steppers::Outcome::Event). Where the run ends, everything that has happened by then is reported with the time
    /// and the state of the end, in the order of declaration: bodies that land at the same instant are all told of.
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use guen_runtime::from_fn;
    /// use guen_runtime::steppers::{Dop853, Event, Integration};
    ///
    /// // Two stones, dropped from the same height.
    /// let stones = from_fn(|_t: f64, &[_, _, v, w]: &[f64; 4]| [v, w, -9.81, -9.81]);
    /// let heights = [|_t: f64, x: &[f64; 4]| x[0], |_t: f64, x: &[f64; 4]| x[1]];
    /// let mut landed = [false; 2];
    /// Integration::new(&stones, 0.0, &[1.0, 1.0, 0.0, 0.0])
    ///     .events([0, 1].map(|i| Event::new(&heights[i]).terminal()), &mut |event| {
    ///         landed[event.index] = true;
    ///         ControlFlow::Continue(())
    ///     })
    ///     .run(&Dop853::new(1e-10, 1e-10), 100.0)
    ///     .unwrap();
    /// assert_eq!(landed, [true, true]);
    /// ```
    #[must_use]
    pub fn events<const F: usize>(
        self,
        events: [Event<'a, R, N>; F],
        receive: &'a mut dyn FnMut(&Occurrence<R, N>) -> ControlFlow<()>,
    ) -> Integration<'a, R, S, N, F>
    where
        R: Ordered,
    {
        let Self { system, start, guard, observer, samples, visitor, .. } = self;
        Integration { system, start, guard, observer, samples, visitor, events, receiver: Some(receive) }
    }

    /// Runs to time `t1`, forwards or backwards.
    ///
    /// # Errors
    ///
    /// Settings that make no sense, before anything is integrated; else what stopped the method or what the guard
    /// found, with the last time and state that are known to be in order.
    pub fn run<M>(self, method: &M, t1: R) -> Result<IntegrationResult<R, N>, IntegrationError<R, N>>
    where
        M: Method<R, S, N>,
    {
        self.run_through(method, &[t1], |_, _, _| ())
    }

    /// Runs through the given times, lands on each of them exactly, and calls `visit` there with the index, the time and the
    /// state. The times may repeat, and turn back where nothing is [sampled](Integration::sample).
    ///
    /// ```
    /// use guen_runtime::from_fn;
    /// use guen_runtime::steppers::{Guard, Integration, Rk4};
    ///
    /// let growth = from_fn(|_t: f64, &[x]: &[f64; 1]| [x]);
    /// let mut steps = Vec::new();
    /// let done = Integration::new(&growth, 0.0, &[1.0])
    ///     .observe(&mut |t, _x| {
    ///         steps.push(t);
    ///         std::ops::ControlFlow::Continue(())
    ///     })
    ///     .run_through(&Rk4::new(0.25), &[0.3, 1.0], |_k, t, x| assert!((x[0] - t.exp()).abs() < 1e-3))
    ///     .unwrap();
    /// assert_eq!(steps, [0.25, 0.3, 0.55, 0.8, 1.0]);
    /// assert_eq!(done.time, 1.0);
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`run`](Integration::run); times visited before stay visited.
    pub fn run_through<M, V>(
        self,
        method: &M,
        times: &[R],
        mut visit: V,
    ) -> Result<IntegrationResult<R, N>, IntegrationError<R, N>>
    where
        M: Method<R, S, N>,
        V: FnMut(usize, R, &[R; N]),
    {
        let Self { system, ref start, guard, observer, samples, visitor, events, receiver } = self;
        let mut events: [Followed<'_, R, N>; E] = events.map(Followed::new);
        let mut run = SystemRun::new(method, start, system);
        let events = &mut events;
        DriveLoop { start, guard, observer, samples, visited: 0, visitor, events, receiver }
            .through(&mut run, times, &mut visit)
    }
}
