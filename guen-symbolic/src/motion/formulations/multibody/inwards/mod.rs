//! Dynamics from the leaves to the root: the quadratic form and the forces are put up, then one velocity after the other is eliminated.
//!
//! `regrouping` moves constants of bodies to their parents first, `assembly` puts up the form and walks back, and `form` has the single steps. `loads`, `potentials`, `beside`,
//! `strained` and `inertial_forces` add or replace forces.

pub(super) mod assembly;
pub(super) mod beside;
mod form;
pub(super) mod inertial_forces;
mod loads;
pub(super) mod potentials;
mod regrouping;
mod strained;
