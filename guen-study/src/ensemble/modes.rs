//! Ensembles of systems with contacts: one run through modes for each member, on all threads.

use std::ops::Range;

use guen_runtime::hybrid::{HybridSimulation, HybridSimulationError, HybridSystem, HybridTrajectory};

use super::Ensemble;

/// A motion through modes from a state in the order of its entries, or why it stopped, with the motion until then.
pub type ModesEnd<S, const N: usize, const W: usize, const C: usize, const K: usize> =
    Result<HybridTrajectory<S, [f64; N], N, W, C, K>, HybridSimulationError<S, [f64; N], N, W, C, K>>;

impl<S, const N: usize, L> Ensemble<S, N, L> {
    /// Simulates every member, a system with contacts, through its modes over a span of time on all threads: whole motions with their
    /// transitions, by the method and the tolerance of [`HybridSystem::simulate`]. Each motion is that of the member alone, to the bit; one
    /// that fails, as at an impact without an answer, fails alone.
    ///
    /// ```
    /// # use guen_runtime::hybrid::{Element, FreeMotion, HybridSystem, Mode, Signal};
    /// # use guen_runtime::{Lift, Real};
    /// # #[derive(Clone, Copy)]
    /// # struct Ball;
    /// # impl HybridSystem<2, 1, 1, 0> for Ball {
    /// #     const ELEMENTS: [Element; 1] = [Element::smooth("floor", 0)];
    /// #     const SIGNALS: [Signal; 0] = [];
    /// #     const COORDINATES: usize = 1;
    /// #     type Mode = Mode<1>;
    /// #     type Inputs = ();
    /// #     fn with_inputs(&self, (): ()) -> Self {
    /// #         *self
    /// #     }
    /// #     fn free_motion<R: Lift<f64>>(&self, _t: R, &[z, v]: &[R; 2], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
    /// #         let (zero, one, g) = (R::zero(), R::one(), R::lift(9.81));
    /// #         FreeMotion {
    /// #             rates: [v, -g], gaps: [z], row_rates: [v], biases: [-g], delassus: [[one]], responses: [[zero, one]],
    /// #             friction: [zero], stiction: [zero], limits: [zero],
    /// #         }
    /// #     }
    /// #     fn restitutions(&self) -> [f64; 1] {
    /// #         [0.5]
    /// #     }
    /// #     fn signals<R: Lift<f64>>(&self, _t: R, _: &[R; 2]) -> [R; 0] {
    /// #         []
    /// #     }
    /// # }
    /// use guen_study::Ensemble;
    ///
    /// // Balls from many heights: the higher, the later it lands. One that begins below the floor fails, and alone.
    /// let heights = (-1..10).map(|k| [f64::from(k) + 0.5, 0.0]);
    /// let motions = Ensemble::of_states(Ball, heights).simulate_modes(0.0..1.5);
    /// assert!(motions[0].is_err());
    /// let landings: Vec<f64> = motions[1..].iter().map(|motion| motion.as_ref().unwrap().transitions()[0].t).collect();
    /// assert!(landings.is_sorted_by(|a, b| a < b));
    /// ```
    pub fn simulate_modes<const W: usize, const C: usize, const K: usize>(
        &self,
        span: Range<f64>,
    ) -> Vec<ModesEnd<S, N, W, C, K>>
    where
        S: HybridSystem<N, W, C, K> + Clone + Send + Sync,
        S::Mode: Send,
    {
        self.mode_simulations(|simulation| simulation.run(span.clone()))
    }

    /// Runs a simulation through modes of every member on all threads. The closure gives each its method, inputs and limits, runs it, and
    /// says what is kept of it, in the order of the members: its trajectory, its transitions or a number. States are arrays, in the order
    /// of their fields.
    ///
    /// Each result is that of the member's own simulation, to the bit, whatever the number of threads; one motion is in memory for each
    /// thread at a time where the closure keeps less.
    ///
    /// ```
    /// # use guen_runtime::hybrid::{Element, FreeMotion, HybridSystem, Mode, Signal};
    /// # use guen_runtime::{Lift, Real};
    /// # #[derive(Clone, Copy)]
    /// # struct Ball;
    /// # impl HybridSystem<2, 1, 1, 0> for Ball {
    /// #     const ELEMENTS: [Element; 1] = [Element::smooth("floor", 0)];
    /// #     const SIGNALS: [Signal; 0] = [];
    /// #     const COORDINATES: usize = 1;
    /// #     type Mode = Mode<1>;
    /// #     type Inputs = ();
    /// #     fn with_inputs(&self, (): ()) -> Self {
    /// #         *self
    /// #     }
    /// #     fn free_motion<R: Lift<f64>>(&self, _t: R, &[z, v]: &[R; 2], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
    /// #         let (zero, one, g) = (R::zero(), R::one(), R::lift(9.81));
    /// #         FreeMotion {
    /// #             rates: [v, -g], gaps: [z], row_rates: [v], biases: [-g], delassus: [[one]], responses: [[zero, one]],
    /// #             friction: [zero], stiction: [zero], limits: [zero],
    /// #         }
    /// #     }
    /// #     fn restitutions(&self) -> [f64; 1] {
    /// #         [0.5]
    /// #     }
    /// #     fn signals<R: Lift<f64>>(&self, _t: R, _: &[R; 2]) -> [R; 0] {
    /// #         []
    /// #     }
    /// # }
    /// use guen_study::Ensemble;
    ///
    /// let heights = (1..10).map(|k| [f64::from(k), 0.0]);
    /// let impacts = Ensemble::of_states(Ball, heights).mode_simulations(|simulation| {
    ///     simulation.tolerance(1e-11).run(0.0..5.0).map(|motion| motion.transitions().len()).ok()
    /// });
    /// assert!(impacts.iter().all(|count| count.is_some_and(|count| count > 2)));
    /// ```
    pub fn mode_simulations<T: Send, const W: usize, const C: usize, const K: usize>(
        &self,
        run: impl Fn(HybridSimulation<'_, S, [f64; N], N, W, C, K>) -> T + Sync,
    ) -> Vec<T>
    where
        S: HybridSystem<N, W, C, K> + Clone + Sync,
    {
        self.each(|system, start| run(HybridSystem::<N, W, C, K>::simulation(system, start)))
    }
}
