//! Observables of a motion: the places of bodies, and declared outputs.

pub(crate) mod bodies;
pub(crate) mod outputs;
