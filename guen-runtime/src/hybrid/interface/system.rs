//! The interface between a declared system with contacts and the run time: one trait, of straight-line programs and tables.

use super::element::{Element, Signal};
use super::loads::Loads;
use super::mode::Mode;
use crate::numbers::lift::Lift;
use crate::numbers::real::Real;
use crate::numbers::running_error::RunningError;
use crate::system::constraints::positions_error::PositionsError;
#[cfg(feature = "alloc")]
use {
    crate::hybrid::simulations::simulation::{HybridSimulation, HybridSimulationError},
    crate::hybrid::simulations::trajectory::HybridTrajectory,
    core::ops::Range,
};

/// The motion without reactions at one time and state, and what reactions do to it: everything that the rates of every mode
/// are made of.
///
/// Rows, their reactions `l` and the mode-free equations `M eta' + b = Q + sum_w W_w^T l_w` give
///
/// ```text
/// eta'   = M^-1 (Q - b) + sum_w (M^-1 W_w^T) l_w
/// gamma' = biases + D l,      D = W M^-1 W^T
/// ```
///
/// With `N` entries of the state, `W` rows and `C` elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeMotion<R, const N: usize, const W: usize, const C: usize> {
    /// The rates of the state with all contacts open, all grips slipping without force, all latches free.
    pub rates: [R; N],
    /// The gaps of contacts and latches; zero for a grip.
    pub gaps: [R; C],
    /// The rows `gamma_w = W_w eta + w_w`.
    pub row_rates: [R; W],
    /// The rates of the rows in the free motion, `zeta + W M^-1 (Q - b)`.
    pub biases: [R; W],
    /// The Delassus matrix `D = W M^-1 W^T`, symmetric.
    pub delassus: [[R; W]; W],
    /// `responses[w]` is what a unit reaction of the row adds to the rates of the state: zeros for the coordinates, then
    /// `M^-1 W_w^T`.
    pub responses: [[R; N]; W],
    /// The coefficients of friction at the given speeds of slip; zero where there is none.
    pub friction: [R; C],
    /// The coefficients that limit sticking: `stiction`, or the friction at speed zero.
    pub stiction: [R; C],
    /// The limits of grips that do not come from a load; zero elsewhere.
    pub limits: [R; C],
}

/// The conditions of elements at one time and state: see [`HybridSystem::conditions`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions<R, const C: usize> {
    /// A contact closes, and a latch locks, only where this is positive.
    pub when: [R; C],
    /// A latch is released where this rises through zero.
    pub release: [R; C],
}

impl<R: Real, const C: usize> Conditions<R, C> {
    /// No condition: contacts close at all times, and latches are never released.
    ///
    /// ```
    /// use guen_runtime::hybrid::Conditions;
    /// assert!(Conditions::<f64, 1>::none().when[0] > 0.0);
    /// ```
    pub fn none() -> Self {
        Self { when: [R::one(); C], release: [-R::one(); C] }
    }
}

/// A system of `N` equations with contacts, grips and latches: `C` elements with `W` rows, and `S` signals.
///
/// A declared system with `contacts` implements it, with its inputs held where it has any. The state holds the coordinates
/// and then the quasi-velocities of the *mode-free* system: permanent constraints are eliminated, all contacts are open.
///
/// Programs are generic in their real, so that derivatives along a mode come from dual numbers and power series; constants are
/// doubles. The values of switches and the speeds of slip are arguments, because both are constant or of one sign within a mode:
/// the program has no branch.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no contacts that `Hybrid` could run",
    note = "a declared system has them by its section `contacts`; with inputs through `driven(..)`"
)]
pub trait HybridSystem<const N: usize, const W: usize, const C: usize, const S: usize> {
    /// Contacts, grips and latches, in the order of their declaration.
    const ELEMENTS: [Element; C];
    /// Switches and resets, in the order of their declaration.
    const SIGNALS: [Signal; S];
    /// The number of coordinates, which come first in the state.
    const COORDINATES: usize;
    /// Whether it is proved that in no mode a slipping contact can have an inconsistent or an undetermined reaction.
    const PAINLEVE_FREE: bool = false;
    /// The modes whose rates [`eliminated_rates`](Self::eliminated_rates) computes.
    const ELIMINATED: &'static [Mode<C>] = &[];

    /// The mode with named fields; [`Mode`] itself where there is none.
    type Mode: Copy + From<Mode<C>>;
    /// The inputs; `()` where there are none.
    type Inputs: Copy;

    /// The system with other inputs.
    #[must_use]
    fn with_inputs(&self, inputs: Self::Inputs) -> Self
    where
        Self: Sized;

    /// The free motion at time `t`.
    ///
    /// - `switches`: the values of the signals that are switches or branches, zero or one, a half on the zero of a branch; of other signals
    ///   zero.
    /// - `speeds`: the magnitudes of the slip of the elements, for coefficients of friction that depend on it; zero where an element
    ///   does not slip.
    fn free_motion<R: Lift<f64>>(
        &self,
        t: R,
        state: &[R; N],
        switches: &[R; S],
        speeds: &[R; C],
    ) -> FreeMotion<R, N, W, C>;

    /// The rates of the free motion alone.
    #[inline]
    fn free_rates<R: Lift<f64>>(&self, t: R, state: &[R; N], switches: &[R; S]) -> [R; N] {
        self.free_motion(t, state, switches, &[R::zero(); C]).rates
    }

    /// The rates in a mode by its place among [`ELIMINATED`](Self::ELIMINATED), from equations in which its rows are constraints: those of
    /// [`InMode::rates`](crate::hybrid::InMode::rates), wherever these hold, with fewer operations.
    #[inline]
    fn eliminated_rates<R: Lift<f64>>(&self, _place: usize, t: R, state: &[R; N]) -> [R; N] {
        self.free_rates(t, state, &[R::zero(); S])
    }

    /// The rows `gamma_w = W_w eta + w_w` alone.
    #[inline]
    fn row_rates<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> [R; W] {
        self.free_motion(t, state, &[R::zero(); S], &[R::zero(); C]).row_rates
    }

    /// The parts `w_w` of the rows that do not depend on the velocities. Zero where nothing that touches moves by itself.
    #[inline]
    fn row_drifts(&self, _t: f64, _state: &[f64; N]) -> [f64; W] {
        [0.0; W]
    }

    /// The reactions of permanent constraints that load grips, of elements that are
    /// [`loaded_by_constraint`](Element::loaded_by_constraint). Without any, [`Loads::none`].
    #[inline]
    fn loads<R: Lift<f64>>(&self, _t: R, _state: &[R; N], _switches: &[R; S]) -> Loads<R, W, C> {
        Loads::none()
    }

    /// The restitutions of contacts, between zero and one; zero for other elements.
    fn restitutions(&self) -> [f64; C];

    /// The conditions `when` and `release`. Without any, [`Conditions::none`].
    #[inline]
    fn conditions<R: Lift<f64>>(&self, _t: R, _state: &[R; N], _switches: &[R; S]) -> Conditions<R, C> {
        Conditions::none()
    }

    /// The functions of the signals.
    fn signals<R: Lift<f64>>(&self, t: R, state: &[R; N]) -> [R; S];

    /// The state after a reset by this signal, from the state and the values of the switches before it.
    #[inline]
    fn reset<R: Lift<f64>>(&self, _signal: usize, _t: R, state: &[R; N], _switches: &[R; S]) -> [R; N] {
        *state
    }

    /// The state with coordinates at which the permanent constraints on positions hold. Steppers ask for it after every step.
    ///
    /// # Errors
    ///
    /// Nothing near the state fulfils them.
    #[inline]
    fn onto_constraints<R: Lift<f64>>(&self, _t: R, state: &[R; N]) -> Result<[R; N], PositionsError> {
        Ok(*state)
    }

    /// Writes the functions that must not vanish, as [`Guarded::singularities`](crate::Guarded::singularities) does, and returns how many.
    #[inline]
    fn singularities<R: Lift<f64>>(
        &self,
        _t: RunningError<R>,
        _state: &[RunningError<R>; N],
        _values: &mut [RunningError<R>],
    ) -> usize {
        0
    }

    /// Whether the declaration has this mode among its `modes`.
    #[inline]
    fn allows(&self, _mode: &Mode<C>) -> bool {
        true
    }

    /// Simulates the motion from a state over a span of time, with the default settings of [`HybridSimulation`].
    ///
    /// ```
    /// use guen_runtime::hybrid::{Element, FreeMotion, HybridSystem, Mode, Signal};
    /// use guen_runtime::{Lift, Real};
    ///
    /// /// A ball above a floor.
    /// #[derive(Clone, Copy)]
    /// struct Ball;
    /// impl HybridSystem<2, 1, 1, 0> for Ball {
    ///     const ELEMENTS: [Element; 1] = [Element::smooth("floor", 0)];
    ///     const SIGNALS: [Signal; 0] = [];
    ///     const COORDINATES: usize = 1;
    ///     type Mode = Mode<1>;
    ///     type Inputs = ();
    ///     fn with_inputs(&self, (): ()) -> Self {
    ///         *self
    ///     }
    ///     fn free_motion<R: Lift<f64>>(&self, _t: R, &[z, v]: &[R; 2], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
    ///         let (zero, one, g) = (R::zero(), R::one(), R::lift(9.81));
    ///         FreeMotion {
    ///             rates: [v, -g], gaps: [z], row_rates: [v], biases: [-g], delassus: [[one]], responses: [[zero, one]],
    ///             friction: [zero], stiction: [zero], limits: [zero],
    ///         }
    ///     }
    ///     fn restitutions(&self) -> [f64; 1] {
    ///         [0.5]
    ///     }
    ///     fn signals<R: Lift<f64>>(&self, _t: R, _: &[R; 2]) -> [R; 0] {
    ///         []
    ///     }
    /// }
    ///
    /// // It falls from a height of one, and bounces with a half of its speed.
    /// let motion = Ball.simulate(&[1.0, 0.0], 0.0..2.0).unwrap();
    /// let landing = motion.transitions()[0].t;
    /// assert!((landing - f64::sqrt(2.0 / 9.81)).abs() < 1e-12);
    /// assert!(motion.before(landing)[1] < 0.0 && motion.at(landing)[1] > 0.0);
    /// // At rest the floor carries it.
    /// assert!((motion.reactions_at(2.0)[0] - 9.81).abs() < 1e-12);
    /// ```
    ///
    /// # Errors
    ///
    /// What kept the motion from going on, with the trajectory until then.
    #[cfg(feature = "alloc")]
    #[allow(clippy::type_complexity, reason = "one trajectory or the error with it")]
    fn simulate<X>(
        &self,
        start: &X,
        span: Range<f64>,
    ) -> Result<HybridTrajectory<Self, X, N, W, C, S>, HybridSimulationError<Self, X, N, W, C, S>>
    where
        Self: Clone,
        X: Copy + From<[f64; N]> + Into<[f64; N]>,
    {
        self.simulation(start).run(span)
    }

    /// A simulation from a state, to be described further and run.
    #[cfg(feature = "alloc")]
    fn simulation<X>(&self, start: &X) -> HybridSimulation<'_, Self, X, N, W, C, S>
    where
        Self: Clone,
        X: Copy + From<[f64; N]> + Into<[f64; N]>,
    {
        HybridSimulation::new(self.clone(), start)
    }
}
