//! Velocities, kinetic energy and generalised forces in the quasi-velocities, along the operators.
//!
//! `velocity_forms` takes expressions apart that are affine in velocities, `frame` has the flows along the operators, `kinetic` has `T°` as products
//! of forms, `forces` the generalised forces.

pub(super) mod forces;
pub(super) mod frame;
pub(super) mod kinetic;
pub(super) mod velocity_forms;
