//! Simulations through modes of systems with inputs, before it is known what the inputs are.

use core::fmt;

use super::by_law::{ActuatedModes, ByLaw};
use super::simulation::HybridSimulation;
use crate::hybrid::ThroughModes;
use crate::hybrid::interface::system::HybridSystem;
use crate::system::inputs::input_law::InputLaw;

/// A simulation of a system with contacts and inputs that does not know them yet: [`law`](Self::law) or [`hold`](Self::hold) make it a
/// [`HybridSimulation`]. Inputs that stay as they are need neither: `system.driven(inputs)` is a system that can be simulated itself.
#[derive(Clone, Copy)]
#[must_use = "a simulation runs when it has inputs and `run` is called"]
pub struct ModesWithoutInputs<P, X> {
    system: P,
    start: X,
}

impl<P, X> fmt::Debug for ModesWithoutInputs<P, X> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ModesWithoutInputs").finish_non_exhaustive()
    }
}

impl<P, X> ModesWithoutInputs<P, X> {
    /// A simulation from a state.
    #[doc(hidden)]
    pub fn new(system: P, start: X) -> Self {
        Self { system, start }
    }

    /// Inputs by an [`InputLaw`], evaluated in every right-hand side: the simulation of [`ByLaw`].
    pub fn law<'a, L, const N: usize, const W: usize, const C: usize, const S: usize, const M: usize>(
        self,
        law: L,
    ) -> HybridSimulation<'a, ByLaw<P, L, M>, X, N, W, C, S>
    where
        P: ActuatedModes<N, W, C, S, M>,
        L: InputLaw<P> + Clone,
        X: Copy,
    {
        HybridSimulation::new(ByLaw::new(self.system, law), &self.start)
    }

    /// Inputs that a controller finds every `period`, from the start on, and that are held in between: see [`HybridSimulation::hold`].
    pub fn hold<'a, I, const N: usize, const W: usize, const C: usize, const S: usize, const M: usize>(
        self,
        period: f64,
        controller: impl FnMut(f64, &X) -> I + 'a,
    ) -> HybridSimulation<'a, P::Held, X, N, W, C, S>
    where
        P: ActuatedModes<N, W, C, S, M>,
        P::Held: HybridSystem<N, W, C, S, Inputs = I> + Clone,
        X: Copy + From<[f64; N]> + Into<[f64; N]>,
    {
        HybridSimulation::new(self.system.at_zero(), &self.start).hold(period, controller)
    }

    /// Refused: a closure for inputs has no derivatives. See [`law`](Self::law) and [`hold`](Self::hold).
    pub fn inputs<F>(self, _law: F)
    where
        Self: ThroughModes,
    {
    }
}
