//! The motion within one mode: reactions by a small solve over the Delassus matrix, and the smooth system that they make.
//!
//! `mode_rows` has the equations of the reactions, `pivots` the order of their elimination, `in_mode` the system, `redundant` the modes whose reactions are not determined.

pub(super) mod in_mode;
pub(super) mod mode_rows;
pub(super) mod pivots;
mod redundant;
