//! Systems whose motions are asked for by one call, with states that have names.

use core::fmt;

use super::constraints::positions::{Positions, Projected};
use super::constraints::positions_error::PositionsError;
use super::derivatives::differentiable::{Equations, Generic};
use crate::numbers::real::{Ordered, Real};
use crate::steppers::{IntegrationError, NamedError, Names};
use crate::system::{FromFn, System};
#[cfg(feature = "alloc")]
use {
    crate::simulation::{Simulation, SimulationError, Trajectory},
    crate::steppers::Dop853,
    core::ops::Range,
};

/// A system with a type for its states, whose motions can be simulated: with the feature `alloc` in two lines.
///
/// Prepared systems and scenes have their `State` with named fields, closures and what is written by hand an array.
///
/// ```
/// # #[cfg(feature = "alloc")] {
/// use guen_runtime::{Simulate, from_fn};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let motion = oscillator.simulate(&[1.0, 0.0], 0.0..10.0).unwrap();
/// assert!((motion.at(3.0)[0] - 3.0_f64.cos()).abs() < 1e-7);
/// # }
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no motions to simulate",
    note = "constants become a system with `.prepare()?`, a system with inputs with `.with_inputs(..)`, a closure with `from_fn`"
)]
pub trait Simulate<R: Real, const N: usize>: System<R, N> {
    /// A state: what a simulation starts from, and what its trajectory returns.
    type State: Copy + From<[R; N]> + Into<[R; N]>;

    /// The names of the entries of a state, for messages, tables and plots; empty where they have none.
    const STATES: &'static [&'static str] = &[];

    /// The units of the entries of a state, for tables and plots; each may be empty, and all are missing where none is declared.
    const UNITS: &'static [&'static str] = &[];

    /// The functions that must not vanish, in the order of [`singularities`](crate::Guarded::singularities), for messages; empty where
    /// they have no names.
    const DOMAIN: &'static [&'static str] = &[];

    /// The functions at whose zeros the rates change their formula, in the order of [`switches`](System::switches), for messages;
    /// empty where they have no names.
    const SWITCHES: &'static [&'static str] = &[];

    /// The digest of the declaration, by which a study in files finds that it was begun with another one; zero where there is no declaration.
    /// The text of a system or scene enters as far as motions follow from it: documentation, layout, what is provided and the other scenes
    /// do not.
    const DECLARATION: u64 = 0;

    /// Moves a state onto the constraints on positions, as simulations do after every step: by [`project`](crate::project) in
    /// declared systems that have some. What [`restore`](System::restore) does, unless a system says more.
    ///
    /// # Errors
    ///
    /// [`PositionsError`]; the state is unchanged then.
    #[inline]
    fn onto_constraints(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError>
    where
        R: Ordered,
    {
        self.restore(t, state)
    }

    /// Simulates from a state over a span of time, forwards or backwards, and returns the whole motion.
    ///
    /// The method is [`Dop853`] with the tolerance 1e-9, relative and absolute; the default
    /// [`Guard`](crate::steppers::Guard) looks after every step, and constraints on positions hold to rounding. [`simulation`](Self::simulation) has everything else.
    ///
    /// # Errors
    ///
    /// What stopped the method, or what the guard found, with the trajectory up to the last good time.
    #[cfg(feature = "alloc")]
    #[allow(clippy::type_complexity, reason = "the types of the simulation with its defaults")]
    fn simulate(
        &self,
        start: &Self::State,
        span: Range<R>,
    ) -> Result<Trajectory<Self, N, R>, SimulationError<Self, N, R>>
    where
        R: Ordered,
        Self: Clone,
    {
        self.simulation(start).run(span)
    }

    /// A simulation from a state, to be given a method, events or limits, and to be [run](Simulation::run).
    #[cfg(feature = "alloc")]
    fn simulation<'a>(&self, start: &Self::State) -> Simulation<'a, Self, N, R, Dop853<R>>
    where
        R: Ordered,
        Self: Clone,
    {
        Simulation::new(self.clone(), start)
    }
}

impl<R, F, const N: usize> Simulate<R, N> for FromFn<F>
where
    R: Real,
    F: Fn(R, &[R; N]) -> [R; N],
{
    type State = [R; N];
}

impl<R: Real, E: Equations<N>, const N: usize> Simulate<R, N> for Generic<E> {
    type State = [R; N];
}

impl<R: Real, S: Simulate<R, N> + ?Sized, const N: usize> Simulate<R, N> for &S {
    type State = S::State;
    const STATES: &'static [&'static str] = S::STATES;
    const UNITS: &'static [&'static str] = S::UNITS;
    const DOMAIN: &'static [&'static str] = S::DOMAIN;
    const SWITCHES: &'static [&'static str] = S::SWITCHES;
    const DECLARATION: u64 = S::DECLARATION;

    fn onto_constraints(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError>
    where
        R: Ordered,
    {
        (**self).onto_constraints(t, state)
    }
}

impl<R, S, const N: usize, const H: usize, const M: usize> Simulate<R, M> for Projected<S, N, H>
where
    R: crate::numbers::real::Ordered,
    S: Simulate<R, M> + Positions<R, N, H>,
{
    type State = S::State;
    const STATES: &'static [&'static str] = S::STATES;
    const UNITS: &'static [&'static str] = S::UNITS;
    const DOMAIN: &'static [&'static str] = S::DOMAIN;
    const SWITCHES: &'static [&'static str] = S::SWITCHES;
    const DECLARATION: u64 = S::DECLARATION;
}

impl Names {
    /// The names of a system.
    pub(crate) fn of<R: Real, S: Simulate<R, N> + ?Sized, const N: usize>() -> Self {
        Self { states: S::STATES, domain: S::DOMAIN, switches: S::SWITCHES }
    }
}

impl<R: Real, const N: usize> IntegrationError<R, N> {
    /// The message in the names of the system: its variables and the functions that must not vanish, and not their numbers.
    ///
    /// ```
    /// use guen_runtime::steppers::{Guard, Integration, Rk4};
    /// use guen_runtime::{Simulate, System};
    ///
    /// struct Growth;
    /// impl System<f64, 1> for Growth {
    ///     fn rhs(&self, _t: f64, &[x]: &[f64; 1]) -> [f64; 1] {
    ///         [100.0 * x]
    ///     }
    /// }
    /// impl Simulate<f64, 1> for Growth {
    ///     type State = [f64; 1];
    ///     const STATES: &'static [&'static str] = &["size"];
    /// }
    ///
    /// let error = Integration::new(&Growth, 0.0, &[1.0]).run(&Rk4::new(0.05), 10.0).unwrap_err();
    /// assert!(error.named(&Growth).to_string().contains("`size` is off"));
    /// ```
    pub fn named<S: Simulate<R, N> + ?Sized>(&self, _system: &S) -> impl fmt::Display + use<R, S, N> {
        NamedError { time: self.time.to_f64(), cause: self.cause, names: Names::of::<R, S, N>() }
    }
}
