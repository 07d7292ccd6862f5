//! Methods and traits of generated systems.

pub(super) mod bodies;
pub(super) mod classification;
pub(super) mod control;
pub(super) mod integrated;
pub(super) mod lanes;
pub(super) mod linearization;
pub(super) mod missing;
pub(super) mod motion;
pub(super) mod operators;
pub(super) mod positions;
pub(super) mod with_scalar;
