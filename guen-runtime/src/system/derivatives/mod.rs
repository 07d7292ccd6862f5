//! Derivatives of systems: those of right-hand sides that implicit methods need, linearisations, and Taylor series of motions.

pub(crate) mod differentiable;
pub(crate) mod linearization;
pub(crate) mod series;
