//! Trajectories: the motion of a simulation, at every time of its span.

use alloc::vec::Vec;

use crate::numbers::real::{Ordered, Real};
use crate::simulation::optional_projection::OptionalProjection;
use crate::simulation::recorder::Step;
use crate::steppers::{Dense, Interpolant, Outcome, Statistics};
use crate::system::guarded::Guarded;
use crate::system::observables::outputs::OutputMap;
use crate::system::simulate::Simulate;
use crate::system::{Monitored, System};

/// An event that happened during a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Happened<R, X> {
    /// The position of the event among those that were asked for.
    pub index: usize,
    /// The time, at most the event's tolerance past the crossing.
    pub time: R,
    /// The state at that time.
    pub state: X,
    /// Whether the function rises through zero, in the order in which the run goes.
    pub rising: bool,
}

/// The work of a simulation, and how well its trajectory keeps what the exact motion keeps: the largest deviations among all
/// accepted steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Steps and evaluations.
    pub work: Statistics,
    /// The largest change of the energy since the start, relative to the largest scale of energies; none if the system does
    /// not keep its energy.
    pub energy: Option<f64>,
    /// The largest left side of the constraints on positions, relative to the size of its terms.
    pub residual: f64,
    /// The largest distance of carried functions from their values, relative to one and their size.
    pub carried: f64,
}

/// The motion of a system over a span of time: states at any time of it, by the dense output of the method.
///
/// It owns a copy of the system and the polynomial of every step, in `8 (8 N + 3)` bytes for each step of
/// [`Dop853`](crate::steppers::Dop853). A call of [`at`](Self::at) takes a search among the steps and about `24 N` operations;
/// its states are put back onto the constraints on positions, as those of steps are.
///
/// ```
/// use guen_runtime::{Simulate, from_fn};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let motion = oscillator.simulate(&[1.0, 0.0], 0.0..10.0).unwrap();
/// assert_eq!((motion.start(), motion.end_time()), ([1.0, 0.0], 10.0));
/// assert_eq!(motion.at(10.0), motion.end());
/// let samples: Vec<(f64, [f64; 2])> = motion.sample(2.5).collect();
/// assert_eq!(samples.len(), 5);
/// // A run goes on where another one ended.
/// let more = oscillator.simulate(&motion.end(), 10.0..20.0).unwrap();
/// assert!((more.end()[0] - 20.0_f64.cos()).abs() < 1e-6);
/// ```
#[derive(Clone)]
pub struct Trajectory<S, const N: usize, R = f64, P = Dense<R, N>>
where
    R: Real,
    S: Simulate<R, N>,
{
    system: OptionalProjection<S>,
    start: (R, [R; N]),
    steps: Vec<Step<R, P>>,
    end: (R, [R; N]),
    events: Vec<Happened<R, S::State>>,
    work: Statistics,
    outcome: Option<Outcome>,
}

impl<R: Real, S: Simulate<R, N>, P, const N: usize> core::fmt::Debug for Trajectory<S, N, R, P> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Trajectory")
            .field("start", &self.start)
            .field("end", &self.end)
            .field("steps", &self.steps.len())
            .field("events", &self.events.len())
            .field("outcome", &self.outcome)
            .finish_non_exhaustive()
    }
}

impl<R: Real, S: Simulate<R, N>, P, const N: usize> Trajectory<S, N, R, P> {
    /// The trajectory of the steps that begin before its end.
    pub(super) fn new(
        system: OptionalProjection<S>,
        start: (R, [R; N]),
        mut steps: Vec<Step<R, P>>,
        end: (R, [R; N]),
        mut events: Vec<Happened<R, S::State>>,
        work: Statistics,
        outcome: Option<Outcome>,
    ) -> Self {
        // A guard looks back: what came after the last good time is no part of the motion.
        let backwards = is_earlier(end.0, start.0);
        let is_before = |a: R, b: R| if backwards { is_earlier(b, a) } else { is_earlier(a, b) };
        steps.truncate(steps.partition_point(|step| is_before(step.start, end.0)));
        events.retain(|event| !is_before(end.0, event.time));
        steps.shrink_to_fit();
        Self { system, start, steps, end, events, work, outcome }
    }

    /// The system that moves.
    pub fn system(&self) -> &S {
        &self.system.system
    }

    /// The state at the beginning.
    pub fn start(&self) -> S::State {
        self.start.1.into()
    }

    /// The time of the beginning.
    pub fn start_time(&self) -> R {
        self.start.0
    }

    /// The state at the end, from which a further run can go on.
    pub fn end(&self) -> S::State {
        self.end.1.into()
    }

    /// The time of the end: that asked for, that of a terminal event or, in an error, the last good one.
    pub fn end_time(&self) -> R {
        self.end.0
    }

    /// Returns how the run ended; none if the trajectory is that of a [`SimulationError`](crate::SimulationError).
    pub fn outcome(&self) -> Option<Outcome> {
        self.outcome
    }

    /// The events that happened, in the order of time.
    pub fn events(&self) -> &[Happened<R, S::State>] {
        &self.events
    }

    /// The times of all accepted steps, start and end included.
    pub fn times(&self) -> impl Iterator<Item = R> + Clone + '_ {
        let end = (!self.steps.is_empty()).then_some(self.end.0);
        let first = self.steps.is_empty().then_some(self.start.0);
        first.into_iter().chain(self.steps.iter().map(|step| step.start)).chain(end)
    }

    fn is_backwards(&self) -> bool {
        is_earlier(self.end.0, self.start.0)
    }

    /// Whether the first time comes before the second one in the order of the run.
    fn is_before(&self, a: R, b: R) -> bool {
        if self.is_backwards() { is_earlier(b, a) } else { is_earlier(a, b) }
    }
}

impl<R, S, P, const N: usize> Trajectory<S, N, R, P>
where
    R: Ordered,
    S: Simulate<R, N>,
    P: Interpolant<R, N>,
{
    /// The state at time `t`. A time outside of the span counts as the nearer end of it; what is no number gives states that
    /// are none.
    ///
    /// The error is that of the steps and of the method's dense output, which the table at
    /// [`Integration`](crate::steppers::Integration) states.
    pub fn at(&self, t: R) -> S::State {
        self.array_at(t).into()
    }

    fn array_at(&self, t: R) -> [R; N] {
        if t.to_f64().is_nan() {
            return [t; N];
        }
        if !self.is_before(t, self.end.0) {
            return self.end.1;
        }
        // The last step that does not begin later.
        let place = self.steps.partition_point(|step| !self.is_before(t, step.start));
        let Some(step) = place.checked_sub(1).and_then(|place| self.steps.get(place)) else {
            return self.start.1;
        };
        let mut state = step.polynomial.at(t);
        if t != step.start {
            // What cannot be put back stays what the polynomial says.
            let _ = self.system.restore(t, &mut state);
        }
        state
    }

    /// The states at all accepted steps, start and end included.
    pub fn iter(&self) -> impl Iterator<Item = (R, S::State)> + '_ {
        self.times().map(|t| (t, self.at(t)))
    }

    /// The states at multiples of `dt` after the start, and at the end. Of a duration that is not positive, start and end.
    pub fn sample(&self, dt: R) -> impl Iterator<Item = (R, S::State)> + '_ {
        let span = self.end.0 - self.start.0;
        let dt = if (dt.to_f64() < 0.0) == self.is_backwards() { dt } else { -dt };
        let parts = (span / dt).to_f64();
        // A last sample next to the end would be the end a second time.
        let whole = if parts.is_finite() { libm::ceil(parts * (1.0 - f64::EPSILON * 4.0)) as u64 } else { 1 };
        let count = if self.steps.is_empty() { 0 } else { whole.max(1) };
        let start = self.start.0;
        let times = (0..count).map(move |k| if k == 0 { start } else { start + R::from_f64(k as f64) * dt });
        times.chain([self.end.0]).map(|t| (t, self.at(t)))
    }

    /// Returns a value for every accepted step, start and end included.
    pub fn map<T>(&self, mut value: impl FnMut(R, &S::State) -> T) -> impl Iterator<Item = T> {
        self.iter().map(move |(t, state)| value(t, &state))
    }

    /// The energy at all accepted steps, start and end included.
    pub fn energy(&self) -> impl Iterator<Item = (R, R)> + '_
    where
        S: Monitored<R, N>,
    {
        self.times().map(|t| (t, self.system().energy(t, &self.array_at(t))))
    }

    /// The declared outputs at all accepted steps, start and end included.
    pub fn outputs<const K: usize>(&self) -> impl Iterator<Item = (R, S::Outputs)> + '_
    where
        S: OutputMap<R, N, K>,
    {
        self.times().map(|t| (t, self.outputs_at(t)))
    }

    /// The declared outputs at time `t`, as those of the state [`at`](Self::at) that time.
    ///
    /// ```
    /// use guen_runtime::{OutputMap, Simulate, System};
    ///
    /// /// What the macro generates for a declared system.
    /// #[derive(Clone, Copy)]
    /// struct Oscillator;
    /// impl System<f64, 2> for Oscillator {
    ///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
    ///         [v, -x]
    ///     }
    /// }
    /// impl Simulate<f64, 2> for Oscillator {
    ///     type State = [f64; 2];
    /// }
    /// impl OutputMap<f64, 2, 1> for Oscillator {
    ///     type Outputs = f64;
    ///     const OUTPUTS: [&'static str; 1] = ["radius"];
    ///     fn output_values(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 1] {
    ///         [x.hypot(v)]
    ///     }
    ///     fn named_outputs(values: &[f64; 1]) -> f64 {
    ///         values[0]
    ///     }
    /// }
    ///
    /// let motion = Oscillator.simulate(&[2.0, 0.0], 0.0..5.0).unwrap();
    /// assert!((motion.outputs_at(1.3) - 2.0).abs() < 1e-7);
    /// assert_eq!(motion.outputs().count(), motion.times().count());
    /// ```
    pub fn outputs_at<const K: usize>(&self, t: R) -> S::Outputs
    where
        S: OutputMap<R, N, K>,
    {
        S::named_outputs(&self.system().output_values(t, &self.array_at(t)))
    }

    /// The work of the run, and the largest deviations from what the exact motion keeps. Evaluates the invariants at all
    /// accepted steps.
    pub fn statistics(&self) -> Quality {
        let guarded = self.system.guarded();
        let start = guarded.conserved(self.start.0, &self.start.1);
        let mut quality = Quality { work: self.work, energy: None, residual: 0.0, carried: 0.0 };
        let (mut change, mut scale) = (0.0_f64, 0.0_f64);
        for t in self.times() {
            let here = guarded.conserved(t, &self.array_at(t));
            if let (Some(energy), Some(first)) = (here.energy, start.energy) {
                change = change.max((energy - first).to_f64().abs());
                scale = scale.max(here.scale.to_f64());
            }
            quality.residual = quality.residual.max(here.residual.to_f64());
            quality.carried = quality.carried.max(here.carried.to_f64());
        }
        let relative = if change > 0.0 { change / scale } else { 0.0 };
        Quality { energy: start.energy.map(|_| relative), ..quality }
    }
}

/// Whether a time is earlier than another, to its last digit.
fn is_earlier<R: Real>(a: R, b: R) -> bool {
    (a - b).to_f64() < 0.0
}
