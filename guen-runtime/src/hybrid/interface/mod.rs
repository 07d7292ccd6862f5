//! The interface of a system with contacts: its elements, modes and the trait `HybridSystem`; and the reactions, transitions and errors that a run tells of.

pub(super) mod element;
pub(super) mod error;
pub(super) mod loads;
pub(super) mod mode;
pub(super) mod mode_info;
pub(super) mod reactions;
pub(super) mod system;
pub(super) mod transition;
