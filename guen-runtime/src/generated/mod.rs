//! The functions that the code of an expansion calls, and the facts that it states: nothing here integrates or knows
//! of a stepper.

pub mod checks;
mod condition;
pub(crate) mod derived;
mod emitted;
pub(crate) mod entries;
pub(crate) mod instances;
mod nalgebra_support;
pub(crate) mod serde_support;
pub(crate) mod shape;
mod through_modes;
