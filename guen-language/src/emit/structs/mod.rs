//! Structs that users name: constants, states, inputs and outputs, components; and how they are checked and become each other.

pub(super) mod components;
pub(super) mod constants;
pub(super) mod levels;
pub(super) mod limits;
pub(super) mod physical;
pub(super) mod records;
pub(super) mod serde;
