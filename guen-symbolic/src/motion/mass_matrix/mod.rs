//! Elimination: `M eta' = f` solved for the accelerations, and what the mass matrix needs to be regular.
//!
//! `solve` factorises `M` with `sparse` vectors and `cancellation` of common products; `weightless` finds parameters without inertia, `indispensable` constants without
//! which nothing has any.

mod cancellation;
pub(super) mod indispensable;
pub(super) mod solve;
pub(super) mod sparse;
pub(super) mod weightless;
