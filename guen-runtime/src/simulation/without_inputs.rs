//! Simulations of systems with inputs, before it is known what the inputs are.

use crate::numbers::real::Ordered;
use crate::simulation::Simulation;
use crate::simulation::hold::{Hold, Sampled};
use crate::steppers::Dop853;
use crate::system::derivatives::linearization::Liftable;
use crate::system::inputs::actuated::{Actuated, StateOf, WithInputs};
use crate::system::inputs::input_law::{InputLaw, InputRecords, SmoothLaw};
use crate::system::inputs::input_values::InputSamples;

/// A simulation of a system with inputs that does not know them yet: [`inputs`](Self::inputs), [`law`](Self::law) or
/// [`hold`](Self::hold) make it a [`Simulation`]. Inputs that stay as they are need none of them: `system.driven(inputs)` is a
/// system that can be simulated itself.
#[derive(Clone, Copy)]
#[must_use = "a simulation runs when it has inputs and `run` is called"]
pub struct SimulationWithoutInputs<S, R, const N: usize>
where
    R: Ordered,
    S: Actuated<R, N>,
{
    system: S,
    start: StateOf<S, R, N>,
}

impl<S: Actuated<R, N>, R: Ordered, const N: usize> core::fmt::Debug for SimulationWithoutInputs<S, R, N> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("SimulationWithoutInputs").finish_non_exhaustive()
    }
}

impl<S: Actuated<R, N>, R: Ordered, const N: usize> SimulationWithoutInputs<S, R, N> {
    pub(crate) fn new(system: S, start: &StateOf<S, R, N>) -> Self {
        Self { system, start: *start }
    }

    /// Inputs that are a function of time and state, evaluated in every right-hand side: the same as the simulation of
    /// [`with_inputs`](Actuated::with_inputs).
    pub fn inputs<'a, F>(self, law: F) -> Simulation<'a, WithInputs<S, F, R, N>, N, R>
    where
        F: Fn(R, &StateOf<S, R, N>) -> S::Inputs,
    {
        Simulation::new(self.system.with_inputs(law), &self.start)
    }

    /// Inputs by an [`InputLaw`], which implicit methods see through: the same as the simulation of
    /// [`with_law`](Actuated::with_law).
    pub fn law<'a, L, const M: usize>(
        self,
        law: L,
    ) -> Simulation<'a, WithInputs<S, SmoothLaw<L, S, M>, R, N>, N, R>
    where
        S: InputRecords<StateOver<R> = StateOf<S, R, N>, InputsOver<R> = S::Inputs> + Liftable<R, N, M>,
        L: InputLaw<S>,
    {
        Simulation::new(self.system.with_law(law), &self.start)
    }

    /// Inputs that a controller finds every `period`, from the start on, and that are held in between.
    ///
    /// - The controller may have a memory. It is asked at `t0 + k period`, once, in order, and not at the end of the run. Steps
    ///   land on these times exactly, and the method begins anew at each: the states are those of a run for every period with
    ///   the inputs held, to the bit. Events, guards and the dense output go through.
    /// - Every method serves that integrates the system with inputs held, `Radau5` and `Taylor` among them.
    /// - The trajectory keeps the samples: `motion.system().inputs(t, &state)` are the inputs that were held at a time, and
    ///   `motion.system().law().as_slice()` all of them.
    /// - A controller has no past to go back to: a run backwards is refused with
    ///   [`Setting::Backwards`](crate::Setting::Backwards), a period that is not a positive number with
    ///   [`Setting::Period`](crate::Setting::Period).
    ///
    /// ```
    /// use guen_runtime::{Actuated, Simulate, System};
    ///
    /// /// A mass that is pushed.
    /// #[derive(Clone, Copy)]
    /// struct Cart;
    /// #[derive(Clone, Copy)]
    /// struct Pushed(f64);
    ///
    /// impl System<f64, 2> for Pushed {
    ///     fn rhs(&self, _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
    ///         [v, self.0]
    ///     }
    /// }
    /// impl Simulate<f64, 2> for Pushed {
    ///     type State = [f64; 2];
    /// }
    /// impl Actuated<f64, 2> for Cart {
    ///     type Inputs = f64;
    ///     type Driven = Pushed;
    ///     fn held(&self, force: f64) -> Pushed {
    ///         Pushed(force)
    ///     }
    /// }
    ///
    /// // A servo that looks ten times a second, and sums up what is left.
    /// let mut sum = 0.0;
    /// let servo = move |_t: f64, &[x, v]: &[f64; 2]| {
    ///     sum += 0.1 * (1.0 - x);
    ///     4.0 * (1.0 - x) - 3.0 * v + sum
    /// };
    /// let motion = Cart.simulation(&[0.0, 0.0]).hold(0.1, servo).run(0.0..20.0).unwrap();
    /// assert!((motion.end()[0] - 1.0).abs() < 1e-2);
    /// let samples = motion.system().law().as_slice();
    /// assert_eq!((samples.len(), samples[0]), (200, (0.0, 4.1)));
    /// ```
    pub fn hold<'a>(
        self,
        period: R,
        controller: impl FnMut(R, &StateOf<S, R, N>) -> S::Inputs + 'a,
    ) -> Simulation<'a, Sampled<S, R, N>, N, R, Dop853<R>, 0, Hold<'a, S, R, N>> {
        let Self { system, start } = self;
        let system = WithInputs::new(system, InputSamples::new());
        Simulation::sampled_by(system, &start, Hold::new(period, controller))
    }
}
