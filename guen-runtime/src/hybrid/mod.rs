//! Systems with contacts: modes, transitions between them, impacts.
//!
//! Each combination of what touches, sticks, slips and is locked is a [`Mode`]: a smooth system, [`InMode`], that every stepper
//! runs. [`Hybrid`] runs a [`HybridSystem`] through its modes: it locates the end of a mode, solves the impact if there is one, finds the
//! mode that goes on, and tells of the [`Transition`].
//!
//! | question | answer |
//! | --- | --- |
//! | when does a mode end? | where one of its inequalities falls to zero: a gap, a normal reaction, a margin of a friction cone, a slip in its direction; where a signal crosses zero |
//! | which mode follows? | the one whose inequalities all hold right after it: the first derivative in time that does not vanish is positive |
//! | what do impacts do? | Poisson's law: compression and expansion, each a complementarity problem of all contacts that touch, with Coulomb's law between impulses and slips |
//! | what of infinitely many impacts? | the contact closes early, where what is left out is wrong by the third order of the rebound |
//! | what if reactions are not determined? | the motion goes on if some reactions lie in all cones; [`InMode::with_least_norm`] gives the smallest |
//!
//! Nothing is allocated. The times of transitions are as exact as the method: they are located on its dense output, and computed once more by
//! the method itself where that output is of lower order.
//!
//! ```
//! use core::ops::ControlFlow;
//! use guen_runtime::hybrid::{Element, FreeMotion, Hybrid, HybridSystem, Mode, Signal, TransitionKind};
//! use guen_runtime::steppers::Dop853;
//! use guen_runtime::{Lift, Real};
//!
//! /// A ball above a floor. A declared system writes this by itself.
//! #[derive(Clone, Copy)]
//! struct Ball;
//!
//! impl HybridSystem<2, 1, 1, 0> for Ball {
//!     const ELEMENTS: [Element; 1] = [Element::smooth("floor", 0)];
//!     const SIGNALS: [Signal; 0] = [];
//!     const COORDINATES: usize = 1;
//!     type Mode = Mode<1>;
//!     type Inputs = ();
//!
//!     fn with_inputs(&self, (): ()) -> Self {
//!         *self
//!     }
//!     fn free_motion<R: Lift<f64>>(&self, _t: R, &[z, v]: &[R; 2], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
//!         let (zero, one, g) = (R::zero(), R::one(), R::lift(9.81));
//!         FreeMotion {
//!             rates: [v, -g],
//!             gaps: [z],
//!             row_rates: [v],
//!             biases: [-g],
//!             delassus: [[one]],
//!             responses: [[zero, one]],
//!             friction: [zero],
//!             stiction: [zero],
//!             limits: [zero],
//!         }
//!     }
//!     fn restitutions(&self) -> [f64; 1] {
//!         [0.5]
//!     }
//!     fn signals<R: Lift<f64>>(&self, _t: R, _: &[R; 2]) -> [R; 0] {
//!         []
//!     }
//! }
//!
//! let mut rest = 0.0;
//! let done = Hybrid::new(&Ball, 0.0, &[1.0, 0.0])
//!     .transitions(&mut |transition| {
//!         if let TransitionKind::Rest { until, .. } = transition.kind {
//!             rest = until;
//!         }
//!         ControlFlow::Continue(())
//!     })
//!     .run(&Dop853::new(1e-11, 1e-11), 2.0)?;
//! // Each flight takes half as long as the one before.
//! assert!((rest - 3.0 * f64::sqrt(2.0 / 9.81)).abs() < 1e-11);
//! assert_eq!(done.state, [0.0, 0.0]);
//! # Ok::<(), guen_runtime::hybrid::HybridError<2, 1>>(())
//! ```
#![allow(clippy::needless_range_loop, reason = "an element is an entry of several arrays")]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "what is no number fails every condition")]

// In the order of a run: `interface` is what a system says and hears; `mode_dynamics` the motion in a mode; `events` end it; `impacts` and
// `transitions` lead to the next; `execution` is the loop of all this, `simulations` what users begin it with. `derivatives` are of the whole.
mod derivatives;
mod events;
mod execution;
pub(crate) mod filled;
mod impacts;
mod interface;
mod mode_dynamics;
mod simulations;
mod transitions;

pub use derivatives::saltation::{NoSaltation, Saltation};
#[cfg(feature = "alloc")]
pub use derivatives::sensitivity::{SensitivityError, TransitionSensitivity};
pub use execution::driver::{Hybrid, HybridResult};
pub use interface::element::{Effect, Element, Kind, Signal};
pub use interface::error::{HybridCause, HybridError};
pub use interface::loads::Loads;
pub use interface::mode::{ElementState, Mode};
pub use interface::mode_info::ModeInfo;
pub use interface::reactions::Reactions;
pub use interface::system::{Conditions, FreeMotion, HybridSystem};
pub use interface::transition::{Transition, TransitionKind};
pub use mode_dynamics::in_mode::InMode;
pub use simulations::by_law::{ActuatedModes, ByLaw};
#[cfg(feature = "alloc")]
pub use simulations::simulation::{HybridSimulation, HybridSimulationError};
#[cfg(feature = "alloc")]
pub use simulations::trajectory::HybridTrajectory;
#[cfg(feature = "alloc")]
pub use simulations::unheld::ModesWithoutInputs;

/// Implemented by nothing: the bound of methods that a system with contacts refuses. A closure is for one real, and the selection of modes
/// needs derivatives along them.
#[doc(hidden)]
#[diagnostic::on_unimplemented(
    message = "a run through modes takes no closure for its inputs: it needs their derivatives",
    note = "a law that is written for every real is `impl InputLaw<Prepared> for Law`: `.with_law(law)`",
    note = "inputs that are held: `.driven(inputs)`, or sampled `.simulation(&start).hold(period, |t, state| ..)`"
)]
pub trait ThroughModes {}
