//! Many motions at once: of one system from many states, or of many systems, over lanes and threads.
//!
//! What a trajectory is does not depend on its neighbours, on the number of threads or on the processor: lanes compute
//! the bits of plain `f64`, and results are in the order of what was put in.

mod device;
mod modes;
mod threads;

use std::marker::PhantomData;
use std::ops::Range;

use guen_runtime::lanes::{Backend, LaneTask, Lanes, Width, dispatch_on};
use guen_runtime::steppers::{IntegrationResult, LaneMethod};
use guen_runtime::{
    IntegrationError, LaneScalar, Laned, PlainLanes, Simulate, Simulation, SimulationError, Trajectory,
};

use crate::progress::Progress;

pub use device::{Device, DeviceFault, DeviceMethod, DeviceRun, OnDevice};
pub use device::{KernelBatch, KernelEngine, KernelOutcome};
use threads::in_turn;
pub(crate) use threads::processors;

/// The end of one trajectory: the last time and state with the work done, or the same with a cause.
pub type End<const N: usize> = Result<IntegrationResult<f64, N>, IntegrationError<f64, N>>;

/// A trajectory at the times that were asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled<const N: usize> {
    /// The states at the first of the times, as many as were reached.
    pub states: Vec<[f64; N]>,
    /// The end of the trajectory.
    pub end: End<N>,
}

/// Many motions: each a system and an initial state.
///
/// - Work is shared between threads, as many as there are processors for this program when it first asks, and each of
///   them integrates several trajectories at once in lanes. Neither changes a bit of any result. What is too little for a
///   second thread, because that would take longer to start, is done without one.
/// - A trajectory that fails, because its motion leaves the domain or grows out of range, fails alone.
/// - Long runs show their [`Progress`](crate::Progress), unless the environment variable `GUEN_PROGRESS` is `never`.
///
/// ```
/// use guen_runtime::lanes::Lanes;
/// use guen_runtime::steppers::Rk4;
/// use guen_runtime::{Laned, Real, System};
/// use guen_study::Ensemble;
///
/// /// `x' = -rate x`
/// #[derive(Clone, Copy)]
/// struct Decay<R>(R);
///
/// impl<R: Real> System<R, 1> for Decay<R> {
///     #[inline]
///     fn rhs(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
///         R::vectorize(#[inline(always)] || [-self.0 * x])
///     }
/// }
///
/// impl Laned<1> for Decay<f64> {
///     type Over<L: Lanes> = Decay<L>;
///
///     fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Decay<L> {
///         Decay(L::from_fn(|lane| member(lane).0))
///     }
/// }
///
/// // One system from many states; then many systems from one state each.
/// let states = (0..100).map(|i| [i as f64]);
/// let ends = Ensemble::of_states(&Decay(1.0), states).integrate(&Rk4::new(0.01), 0.0, 1.0);
/// let last = ends[99].as_ref().unwrap();
/// assert!((last.state[0] - 99.0 * f64::exp(-1.0)).abs() < 1e-7);
///
/// let systems = (0..100).map(|i| (Decay(i as f64 / 10.0), [1.0]));
/// let ends = Ensemble::of_systems(systems).integrate(&Rk4::new(0.01), 0.0, 1.0);
/// assert!((ends[10].as_ref().unwrap().state[0] - f64::exp(-1.0)).abs() < 1e-9);
/// ```
#[derive(Clone, Debug)]
pub struct Ensemble<S, const N: usize, C = PlainLanes> {
    /// The systems: one for each start, or one for all.
    systems: Vec<S>,
    starts: Vec<[f64; N]>,
    /// The number of threads; as many as the machine has processors, if absent.
    threads: Option<usize>,
    backend: Backend,
    width: Width,
    silent: bool,
    choice: PhantomData<fn() -> C>,
}

impl<S, const N: usize> Ensemble<S, N> {
    /// Creates an ensemble of one system and many initial states.
    pub fn of_states(system: S, states: impl IntoIterator<Item: Into<[f64; N]>>) -> Self {
        Self::new(vec![system], states.into_iter().map(Into::into).collect())
    }

    /// Many systems, each with its initial state: the same system with other constants, or with other inputs held.
    pub fn of_systems(members: impl IntoIterator<Item = (S, impl Into<[f64; N]>)>) -> Self {
        let (systems, starts) = members.into_iter().map(|(system, start)| (system, start.into())).unzip();
        Self::new(systems, starts)
    }

    fn new(systems: Vec<S>, starts: Vec<[f64; N]>) -> Self {
        let backend = Backend::best();
        Self {
            systems,
            starts,
            threads: None,
            backend,
            width: backend.width(),
            silent: false,
            choice: PhantomData,
        }
    }
}

impl<S, const N: usize, C> Ensemble<S, N, C> {
    /// Uses so many threads, one at least.
    pub fn with_threads(self, threads: usize) -> Self {
        Self { threads: Some(threads.max(1)), ..self }
    }

    /// Uses lanes of a certain kind and number instead of those that suit this processor best.
    pub fn with_lanes(self, backend: Backend, width: Width) -> Self {
        Self { backend, width, ..self }
    }

    /// Shows no progress: for those whose own work it is a part of.
    pub(crate) fn silent(self) -> Self {
        Self { silent: true, ..self }
    }

    fn progress(&self) -> Progress {
        let progress = Progress::new(0.0, self.len() as f64);
        if self.silent { progress.silent() } else { progress }
    }

    /// Exchanges the elementary functions, as in `with_scalar::<Approx7Functions>()`.
    pub fn with_scalar<D: LaneScalar>(self) -> Ensemble<S, N, D> {
        let Self { systems, starts, threads, backend, width, silent, .. } = self;
        Ensemble { systems, starts, threads, backend, width, silent, choice: PhantomData }
    }

    /// The number of trajectories.
    pub fn len(&self) -> usize {
        self.starts.len()
    }

    /// Whether there is nothing to do.
    pub fn is_empty(&self) -> bool {
        self.starts.is_empty()
    }

    /// A system and its initial state.
    pub fn member(&self, index: usize) -> Option<(&S, &[f64; N])> {
        self.starts.get(index).map(|start| (self.system(index), start))
    }

    fn system(&self, index: usize) -> &S {
        &self.systems[if self.systems.len() == 1 { 0 } else { index }]
    }

    /// Calls a function for every member, one by one on several threads: for what no method in lanes can do, such as a step
    /// that follows the error, or a recording. For simulations there is [`simulate`](Self::simulate).
    ///
    /// ```
    /// use guen_runtime::{System, from_fn};
    /// use guen_study::Ensemble;
    ///
    /// let pendulum = from_fn(|_t: f64, &[q, w]: &[f64; 2]| [w, -q.sin()]);
    /// let ensemble = Ensemble::of_states(pendulum, (1..10).map(|i| [0.1 * f64::from(i), 0.0]));
    /// let pulls = ensemble.each(|pendulum, start| pendulum.rhs(0.0, start)[1]);
    /// assert!(pulls.is_sorted_by(|a, b| a > b));
    /// ```
    pub fn each<T: Send>(&self, work: impl Fn(&S, &[f64; N]) -> T + Sync) -> Vec<T>
    where
        S: Sync,
    {
        in_turn(self.len(), 1, self.threads.unwrap_or_else(processors), self.progress(), |range| {
            range.map(|i| work(self.system(i), &self.starts[i])).collect()
        })
    }
}

impl<S: Simulate<f64, N> + Clone + Sync, const N: usize, C> Ensemble<S, N, C> {
    /// Simulates every member over a span of time on all threads: whole motions, by the method and the tolerance of
    /// [`Simulate::simulate`]. Each motion is that of the member alone, to the bit; one that fails fails alone.
    ///
    /// ```
    /// use guen_runtime::from_fn;
    /// use guen_study::Ensemble;
    ///
    /// let pendulum = from_fn(|_t: f64, &[q, w]: &[f64; 2]| [w, -q.sin()]);
    /// let starts = (1..10).map(|i| [0.3 * f64::from(i), 0.0]);
    /// let motions = Ensemble::of_states(pendulum, starts).simulate(0.0..20.0);
    /// assert!(motions.iter().all(|motion| motion.is_ok()));
    /// ```
    pub fn simulate(&self, span: Range<f64>) -> Vec<Result<Trajectory<S, N>, SimulationError<S, N>>>
    where
        S: Send,
        S::State: Send,
    {
        self.simulations(|simulation| simulation.run(span.clone()))
    }

    /// Runs a simulation of every member on all threads. The closure gives each simulation its method, events and limits, runs it, and says
    /// what is kept of it, in the order of the members: its trajectory, its end or a number.
    ///
    /// Each result is that of the member's own simulation, to the bit. A member that fails fails alone: its error has its motion
    /// until then. A trajectory takes `8 (8 N + 3)` bytes for every step of [`Dop853`](guen_runtime::steppers::Dop853); where the
    /// closure returns less than that, there is one in memory for each thread at a time, of at most the simulation's own
    /// [`memory`](Simulation::memory). Of fixed steps, [`integrate`](Self::integrate) makes several at once in lanes, for ends alone.
    ///
    /// ```
    /// use guen_runtime::{Simulate, from_fn};
    /// use guen_study::Ensemble;
    ///
    /// let pendulum = from_fn(|_t: f64, &[q, w]: &[f64; 2]| [w, -q.sin()]);
    /// let ensemble = Ensemble::of_states(pendulum, (1..10).map(|i| [0.3 * f64::from(i), 0.0]));
    /// // The time at which each passes its lowest point: a quarter of its period.
    /// let quarters = ensemble.simulations(|simulation| {
    ///     simulation.stop_at(|_t, &[q, _]| q).run(0.0..20.0).map(|motion| motion.end_time()).ok()
    /// });
    /// assert!(quarters.is_sorted_by(|a, b| a < b));
    /// ```
    pub fn simulations<T: Send>(&self, run: impl Fn(Simulation<'_, S, N>) -> T + Sync) -> Vec<T> {
        self.each(|system, start| run(system.simulation(&(*start).into())))
    }
}

impl<S: Laned<N> + Sync, const N: usize, C: LaneScalar> Ensemble<S, N, C> {
    /// Integrates every member from `t0` to `t1`.
    ///
    /// The end of each is that of the method's `integrate` for it alone, to the bit.
    pub fn integrate<M: LaneMethod + Sync>(&self, method: &M, t0: f64, t1: f64) -> Vec<End<N>> {
        self.run(
            &Task { ensemble: self, method, t0, times: &[t1], visit: |_: &mut (), _| () },
            |((), end)| end,
        )
    }

    /// Integrates every member from `t0` through the given times, which may turn back, and keeps the states at them.
    ///
    /// The states and the end of each are those of the method's `sample` for it alone, to the bit.
    pub fn sample<M: LaneMethod + Sync>(&self, method: &M, t0: f64, times: &[f64]) -> Vec<Sampled<N>> {
        let visit = |states: &mut Vec<[f64; N]>, state| states.push(state);
        self.run(&Task { ensemble: self, method, t0, times, visit }, |(states, end)| Sampled { states, end })
    }

    fn run<K: Default + Send, M: LaneMethod + Sync, V, T: Send>(
        &self,
        task: &Task<'_, S, M, V, N, C>,
        result: impl Fn((K, End<N>)) -> T + Sync,
    ) -> Vec<T>
    where
        V: Fn(&mut K, [f64; N]) + Sync,
    {
        in_turn(self.len(), self.width.lanes(), self.threads_for(task), self.progress(), |range| {
            let groups = range.step_by(self.width.lanes());
            let ends = groups.flat_map(|first| {
                dispatch_on(
                    self.backend,
                    self.width_from(first),
                    Group { task, first, kept: PhantomData::<K> },
                )
            });
            ends.map(&result).collect()
        })
    }

    /// The lanes for the members from one on: fewer than usual where fewer members are left, since idle lanes cost what the others do.
    fn width_from(&self, first: usize) -> Width {
        let wanted = self.width.lanes().min(self.len() - first);
        [Width::One, Width::Four].into_iter().find(|width| width.lanes() >= wanted).unwrap_or(self.width)
    }

    /// Returns as many threads as were asked for, or as there are processors, unless the work is done before a second
    /// one begins.
    fn threads_for<M: LaneMethod, V>(&self, task: &Task<'_, S, M, V, N, C>) -> usize {
        /// Entries of the state times steps of a group of lanes: some 17 ns each, so that they take as long as it takes to
        /// start a thread.
        const WORK_OF_A_START: f64 = 2500.0;
        let ends = std::iter::once(&task.t0).chain(task.times);
        let span: f64 = ends.zip(task.times).map(|(from, to)| (to - from).abs()).sum();
        let groups = self.len().div_ceil(self.width.lanes());
        let work = span / task.method.step() * groups as f64 * N as f64;
        if work < WORK_OF_A_START { 1 } else { self.threads.unwrap_or_else(processors) }
    }
}

/// The task of integrating all members: `visit` is shown the states at the times.
struct Task<'a, S, M, V, const N: usize, C> {
    ensemble: &'a Ensemble<S, N, C>,
    method: &'a M,
    t0: f64,
    times: &'a [f64],
    visit: V,
}

/// The task for as many members as there are lanes, from `first` on.
struct Group<'a, S, M, K, V, const N: usize, C> {
    task: &'a Task<'a, S, M, V, N, C>,
    first: usize,
    kept: PhantomData<K>,
}

impl<S, M, K, V, const N: usize, C> LaneTask for Group<'_, S, M, K, V, N, C>
where
    S: Laned<N>,
    M: LaneMethod,
    K: Default,
    V: Fn(&mut K, [f64; N]),
    C: LaneScalar,
{
    type Output = Vec<(K, End<N>)>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let Task { ensemble, method, t0, times, visit } = self.task;
        let count = L::COUNT.min(ensemble.len() - self.first);
        // Lanes without a member of their own repeat the last one.
        let member = |lane: usize| self.first + lane.min(count - 1);
        let system = S::gather::<C::Of<L>>(|lane| ensemble.system(member(lane)));
        let start: [C::Of<L>; N] =
            std::array::from_fn(|i| Lanes::from_fn(|lane| ensemble.starts[member(lane)][i]));
        let mut kept: Vec<K> = (0..L::COUNT).map(|_| K::default()).collect();
        let ends = method.sample_in_lanes(&system, *t0, &start, times, |_, _, state, going| {
            for lane in going.lanes() {
                visit(&mut kept[lane], state.map(|entry| entry.lane(lane)));
            }
        });
        kept.into_iter().zip(ends).take(count).collect()
    }
}

#[cfg(test)]
mod tests;
