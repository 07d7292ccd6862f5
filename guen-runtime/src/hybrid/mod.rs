//! Systems with contacts: modes, transitions between them, impacts.
#![allow(clippy::needless_range_loop, reason = "an element is an entry of several arrays")]
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "what is no number fails every condition")]

mod driver;
mod element;
mod error;
mod facts;
mod impact;
mod in_mode;
mod located;
mod mode;
mod phase;
mod pivots;
mod polished;
mod resting;
mod run;
mod select;
mod stopping;
mod system;
mod transition;
mod turn;
mod watched;

pub use driver::{Hybrid, HybridResult};
pub use element::{Effect, Element, Kind, Signal};
pub use error::{HybridCause, HybridError};
pub use in_mode::{InMode, Reactions};
pub use mode::{ElementState, Mode};
pub use system::{Conditions, FreeMotion, HybridSystem};
pub use transition::{Transition, TransitionKind};
