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

mod by_law;
mod driver;
mod element;
mod error;
mod facts;
pub(crate) mod filled;
mod held;
mod hybrid_state;
mod impact;
mod in_mode;
mod jump;
#[cfg(feature = "alloc")]
mod kept;
mod loads;
mod located;
mod mode;
mod mode_info;
mod mode_rows;
mod phase;
mod pivots;
mod polished;
mod reactions;
mod redundant;
mod resets;
mod resting;
mod run;
mod saltation;
mod select;
#[cfg(feature = "alloc")]
mod sensitivity;
mod signals;
#[cfg(feature = "alloc")]
mod simulation;
mod stopping;
mod system;
#[cfg(feature = "alloc")]
mod trajectory;
mod transition;
mod turn;
mod turning;
#[cfg(feature = "alloc")]
mod unheld;
mod vanishing;
mod watched;

pub use by_law::{ActuatedModes, ByLaw};
pub use driver::{Hybrid, HybridResult};
pub use element::{Effect, Element, Kind, Signal};
pub use error::{HybridCause, HybridError};
pub use in_mode::InMode;
pub use loads::Loads;
pub use mode::{ElementState, Mode};
pub use mode_info::ModeInfo;
pub use reactions::Reactions;
pub use saltation::{NoSaltation, Saltation};
#[cfg(feature = "alloc")]
pub use sensitivity::{SensitivityError, TransitionSensitivity};
#[cfg(feature = "alloc")]
pub use simulation::{HybridSimulation, HybridSimulationError};
pub use system::{Conditions, FreeMotion, HybridSystem};
#[cfg(feature = "alloc")]
pub use trajectory::HybridTrajectory;
pub use transition::{Transition, TransitionKind};
#[cfg(feature = "alloc")]
pub use unheld::ModesWithoutInputs;

/// Implemented by nothing: the bound of methods that a system with contacts refuses. A closure is for one real, and the selection of modes
/// needs derivatives along them.
#[doc(hidden)]
#[diagnostic::on_unimplemented(
    message = "a run through modes takes no closure for its inputs: it needs their derivatives",
    note = "a law that is written for every real is `impl InputLaw<Prepared> for Law`: `.with_law(law)`",
    note = "inputs that are held: `.driven(inputs)`, or sampled `.simulation(&start).hold(period, |t, state| ..)`"
)]
pub trait ThroughModes {}
