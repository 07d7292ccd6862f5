//! Velocities as named variables, and the declared forms and loads over them.
//!
//! `variables` says which velocities vanish or are one, `relations` how each follows from others; `forms` and `declared` write the declaration in them.

pub(super) mod declared;
pub(super) mod definitions;
pub(super) mod forms;
pub(super) mod relations;
pub(super) mod strain;
pub(super) mod variables;
