//! Simulations from named states, by laws for inputs or without, and the trajectories that they leave.

pub(super) mod by_law;
#[cfg(feature = "alloc")]
pub(super) mod kept;
#[cfg(feature = "alloc")]
pub(super) mod simulation;
#[cfg(feature = "alloc")]
pub(super) mod trajectory;
#[cfg(feature = "alloc")]
pub(super) mod unheld;
