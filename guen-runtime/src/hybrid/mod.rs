//! Systems with contacts: modes, transitions between them, impacts.

mod element;
mod mode;
mod system;

pub use element::{Effect, Element, Kind, Signal};
pub use mode::{ElementState, Mode};
pub use system::{Conditions, FreeMotion, HybridSystem};
