//! Systems with contacts: modes, transitions between them, impacts.

mod driver;
mod element;
mod error;
mod impact;
mod in_mode;
mod located;
mod mode;
mod phase;
mod pivots;
mod resting;
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
