//! Constraints on states: positions that fulfil them, and states beside the motion that are kept on their relations.

pub(crate) mod auxiliary_states;
mod nearer;
pub(crate) mod positions;
pub(crate) mod positions_error;
