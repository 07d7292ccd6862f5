//! Functions of the coordinates: which of them an expression depends on, and what it is on the constraints.

pub(super) mod constancy;
pub(super) mod dependence;
pub(super) mod relative_angles;
pub(super) mod restriction;
pub(super) mod symmetry;
