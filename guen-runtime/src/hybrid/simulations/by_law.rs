//! Systems with contacts whose inputs are functions of time and state.

#[cfg(feature = "alloc")]
use super::simulation::{HybridSimulation, HybridSimulationError};
#[cfg(feature = "alloc")]
use super::trajectory::HybridTrajectory;
use crate::hybrid::interface::element::{Element, Signal};
use crate::hybrid::interface::loads::Loads;
use crate::hybrid::interface::mode::Mode;
use crate::hybrid::interface::system::{Conditions, FreeMotion, HybridSystem};
use crate::numbers::lift::Lift;
use crate::numbers::real::Real;
use crate::numbers::running_error::RunningError;
use crate::system::constraints::positions_error::PositionsError;
use crate::system::forward::forward;
use crate::system::guarded::Guarded;
use crate::system::inputs::actuated::{Actuated, StateOf};
use crate::system::inputs::input_law::{InputLaw, InputRecords};
use crate::system::observables::bodies::{Bodies, Body};
use crate::system::simulate::Simulate;
use crate::system::{Monitored, System};
#[cfg(feature = "alloc")]
use core::ops::Range;

/// A prepared system with contacts and `M` inputs: the programs in which inputs stand, over every real. Generated systems are.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no contacts that run with inputs",
    note = "runs through modes are over `f64`, of systems with `contacts` and `inputs`"
)]
pub trait ActuatedModes<const N: usize, const W: usize, const C: usize, const S: usize, const M: usize>:
    InputRecords + Clone
{
    /// The system with inputs that are held.
    type Held: HybridSystem<N, W, C, S>;

    /// The system with all inputs held at zero.
    fn at_zero(&self) -> Self::Held;

    /// The inputs by a law at a time and state.
    fn inputs_by<R: Real, L: InputLaw<Self>>(law: &L, t: R, state: &[R; N]) -> [R; M];

    /// [`HybridSystem::free_motion`] with these inputs.
    fn free_motion_with<R: Lift<f64>>(
        &self,
        t: R,
        state: &[R; N],
        inputs: &[R; M],
        switches: &[R; S],
        speeds: &[R; C],
    ) -> FreeMotion<R, N, W, C>;

    /// [`HybridSystem::free_rates`] with these inputs.
    fn free_rates_with<R: Lift<f64>>(
        &self,
        t: R,
        state: &[R; N],
        inputs: &[R; M],
        switches: &[R; S],
    ) -> [R; N];

    /// [`HybridSystem::loads`] with these inputs.
    #[inline]
    fn loads_with<R: Lift<f64>>(
        &self,
        _t: R,
        _state: &[R; N],
        _inputs: &[R; M],
        _switches: &[R; S],
    ) -> Loads<R, W, C> {
        Loads::none()
    }

    /// [`HybridSystem::signals`] with these inputs.
    fn signals_with<R: Lift<f64>>(&self, t: R, state: &[R; N], inputs: &[R; M]) -> [R; S];

    /// [`HybridSystem::eliminated_rates`] with these inputs.
    #[inline]
    fn eliminated_rates_with<R: Lift<f64>>(
        &self,
        _place: usize,
        t: R,
        state: &[R; N],
        inputs: &[R; M],
    ) -> [R; N] {
        self.free_rates_with(t, state, inputs, &[R::zero(); S])
    }

    /// [`HybridSystem::reset`] with these inputs.
    #[inline]
    fn reset_with<R: Lift<f64>>(
        &self,
        _signal: usize,
        _t: R,
        state: &[R; N],
        _inputs: &[R; M],
        _switches: &[R; S],
    ) -> [R; N] {
        *state
    }
}

/// A system with contacts whose inputs follow an [`InputLaw`]: that of a prepared system by `with_law`.
///
/// The law is evaluated wherever the rates are, in dual numbers and power series too: transitions are located and modes are selected with its
/// derivatives. It has to be smooth: a jump or a kink of it is not located. What jumps is a switch of the declaration, or a
/// controller that holds its inputs, [`Hybrid::hold`](crate::hybrid::Hybrid::hold).
#[derive(Clone, Copy, Debug)]
pub struct ByLaw<P, L, const M: usize> {
    system: P,
    law: L,
}

impl<P, L, const M: usize> ByLaw<P, L, M> {
    /// A prepared system with a law for its inputs.
    pub fn new(system: P, law: L) -> Self {
        Self { system, law }
    }

    /// The law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// The prepared system.
    pub fn system(&self) -> &P {
        &self.system
    }

    /// The inputs at a time and state.
    pub fn inputs(&self, t: f64, state: &P::StateOver<f64>) -> P::InputsOver<f64>
    where
        P: InputRecords,
        L: InputLaw<P>,
    {
        self.law.at(t, state)
    }

    /// Simulates the motion from a state over a span of time, through its modes, with DOP853 at a tolerance of 1e-9.
    ///
    /// # Errors
    ///
    /// The reason why the motion could not go on, with the trajectory until then.
    // A method of its own, which goes before that of `Simulate`, whose motions know no contacts.
    #[cfg(feature = "alloc")]
    #[allow(
        clippy::type_complexity,
        clippy::result_large_err,
        reason = "the types of the simulation with its defaults"
    )]
    pub fn simulate<const N: usize, const W: usize, const C: usize, const S: usize>(
        &self,
        start: &P::StateOver<f64>,
        span: Range<f64>,
    ) -> Result<
        HybridTrajectory<Self, P::StateOver<f64>, N, W, C, S>,
        HybridSimulationError<Self, P::StateOver<f64>, N, W, C, S>,
    >
    where
        P: ActuatedModes<N, W, C, S, M>,
        P::StateOver<f64>: Copy + From<[f64; N]> + Into<[f64; N]>,
        L: InputLaw<P> + Clone,
    {
        HybridSimulation::new(self.clone(), start).run(span)
    }

    /// A simulation through modes from a state, to be described further and run.
    #[cfg(feature = "alloc")]
    pub fn simulation<'a, const N: usize, const W: usize, const C: usize, const S: usize>(
        &self,
        start: &P::StateOver<f64>,
    ) -> HybridSimulation<'a, Self, P::StateOver<f64>, N, W, C, S>
    where
        P: ActuatedModes<N, W, C, S, M>,
        P::StateOver<f64>: Copy + From<[f64; N]> + Into<[f64; N]>,
        L: InputLaw<P> + Clone + 'a,
        P: 'a,
    {
        HybridSimulation::new(self.clone(), start)
    }
}

impl<P, L, const N: usize, const W: usize, const C: usize, const S: usize, const M: usize>
    HybridSystem<N, W, C, S> for ByLaw<P, L, M>
where
    P: ActuatedModes<N, W, C, S, M>,
    L: InputLaw<P> + Clone,
{
    const ELEMENTS: [Element; C] = P::Held::ELEMENTS;
    const SIGNALS: [Signal; S] = P::Held::SIGNALS;
    const COORDINATES: usize = P::Held::COORDINATES;
    const PAINLEVE_FREE: bool = P::Held::PAINLEVE_FREE;
    const ELIMINATED: &'static [Mode<C>] = P::Held::ELIMINATED;

    type Mode = <P::Held as HybridSystem<N, W, C, S>>::Mode;
    type Inputs = ();

    fn with_inputs(&self, (): ()) -> Self {
        self.clone()
    }

    #[inline]
    fn free_motion<R: Lift<f64>>(
        &self,
        t: R,
        state: &[R; N],
        switches: &[R; S],
        speeds: &[R; C],
    ) -> FreeMotion<R, N, W, C> {
        let inputs = P::inputs_by(&self.law, t, state);
        self.system.free_motion_with(t, state, &inputs, switches, speeds)
    }

    #[inline]
    fn free_rates<R: Lift<f64>>(&self, t: R, state: &[R; N], switches: &[R; S]) -> [R; N] {
        self.system.free_rates_with(t, state, &P::inputs_by(&self.law, t, state), switches)
    }

    #[inline]
    fn loads<R: Lift<f64>>(&self, t: R, state: &[R; N], switches: &[R; S]) -> Loads<R, W, C> {
        self.system.loads_with(t, state, &P::inputs_by(&self.law, t, state), switches)
    }

    #[inline]
    fn eliminated_rates<R: Lift<f64>>(&self, place: usize, t: R, state: &[R; N]) -> [R; N] {
        self.system.eliminated_rates_with(place, t, state, &P::inputs_by(&self.law, t, state))
    }

    #[inline]
    fn row_rates<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> [R; W] {
        self.system.at_zero().row_rates(t, state)
    }

    fn row_drifts(&self, t: f64, state: &[f64; N]) -> [f64; W] {
        self.system.at_zero().row_drifts(t, state)
    }

    fn restitutions(&self) -> [f64; C] {
        self.system.at_zero().restitutions()
    }

    #[inline]
    fn conditions<R: Lift<f64>>(&self, t: R, state: &[R; N], switches: &[R; S]) -> Conditions<R, C> {
        self.system.at_zero().conditions(t, state, switches)
    }

    #[inline]
    fn signals<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> [R; S] {
        self.system.signals_with(t, state, &P::inputs_by(&self.law, t, state))
    }

    fn reset<R: Lift<f64>>(&self, signal: usize, t: R, state: &[R; N], switches: &[R; S]) -> [R; N] {
        self.system.reset_with(signal, t, state, &P::inputs_by(&self.law, t, state), switches)
    }

    fn onto_constraints<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> Result<[R; N], PositionsError> {
        self.system.at_zero().onto_constraints(t, state)
    }

    #[inline]
    fn singularities<R: Lift<f64>>(
        &self,
        t: RunningError<R>,
        state: &[RunningError<R>; N],
        values: &mut [RunningError<R>],
    ) -> usize {
        self.system.at_zero().singularities(t, state, values)
    }

    fn allows(&self, mode: &Mode<C>) -> bool {
        self.system.at_zero().allows(mode)
    }
}

impl<P, L, const M: usize> ByLaw<P, L, M> {
    /// The system without contacts, with the inputs held at what the law says at a time and state.
    #[inline]
    fn held_at<const N: usize>(&self, t: f64, state: &[f64; N]) -> P::Driven
    where
        P: Actuated<f64, N> + InputRecords<StateOver<f64> = StateOf<P, f64, N>, InputsOver<f64> = P::Inputs>,
        L: InputLaw<P>,
    {
        self.system.held(self.law.at(t, &(*state).into()))
    }

    /// The system without contacts with whatever inputs, for what does not depend on them.
    #[inline]
    fn anywhere<const N: usize>(&self) -> P::Driven
    where
        P: Actuated<f64, N>,
    {
        self.system.held(P::Inputs::default())
    }
}

/// The rates without contacts. As those of every system with contacts, they are refused by runs that know no modes.
impl<P, L, const N: usize, const M: usize> System<f64, N> for ByLaw<P, L, M>
where
    P: Actuated<f64, N> + InputRecords<StateOver<f64> = StateOf<P, f64, N>, InputsOver<f64> = P::Inputs>,
    L: InputLaw<P>,
{
    forward!(self -> self.anywhere(), |t, state| self.held_at(t, state); System<f64, N>, restore);

    #[inline]
    fn guarded(&self) -> impl Guarded<f64, N> {
        self
    }
}

impl<P, L, const N: usize, const M: usize> Guarded<f64, N> for ByLaw<P, L, M>
where
    P: Actuated<f64, N> + InputRecords<StateOver<f64> = StateOf<P, f64, N>, InputsOver<f64> = P::Inputs>,
    L: InputLaw<P>,
{
    forward!(self -> self.anywhere().guarded(), |t, state| self.held_at(t, state).guarded(); Guarded<f64, N>);
}

impl<P, L, const N: usize, const M: usize> Monitored<f64, N> for ByLaw<P, L, M>
where
    P: Actuated<f64, N> + InputRecords<StateOver<f64> = StateOf<P, f64, N>, InputsOver<f64> = P::Inputs>,
    P::Driven: Monitored<f64, N>,
    L: InputLaw<P>,
{
    forward!(self -> self.anywhere(), |t, state| self.held_at(t, state); Monitored<f64, N>);
}

impl<P, L, const N: usize, const M: usize> Simulate<f64, N> for ByLaw<P, L, M>
where
    P: Actuated<f64, N> + InputRecords<StateOver<f64> = StateOf<P, f64, N>, InputsOver<f64> = P::Inputs>,
    L: InputLaw<P>,
{
    type State = StateOf<P, f64, N>;
    const STATES: &'static [&'static str] = P::Driven::STATES;
    const UNITS: &'static [&'static str] = P::Driven::UNITS;
    const DOMAIN: &'static [&'static str] = P::Driven::DOMAIN;
    const SWITCHES: &'static [&'static str] = P::Driven::SWITCHES;
    const DECLARATION: u64 = P::Driven::DECLARATION;

    fn onto_constraints(&self, t: f64, state: &mut [f64; N]) -> Result<(), PositionsError> {
        self.anywhere().onto_constraints(t, state)
    }
}

impl<P, L, const N: usize, const M: usize, const B: usize> Bodies<f64, N, B> for ByLaw<P, L, M>
where
    P: Actuated<f64, N>,
    P::Driven: Bodies<f64, N, B>,
{
    #[inline]
    fn bodies(&self, t: f64, state: &[f64; N]) -> [Body<f64>; B] {
        self.anywhere().bodies(t, state)
    }
}
