//! Functions of the coordinates: which of them an expression depends on, what it is on the constraints, and which belong together.

pub(super) mod constancy;
pub(super) mod dependence;
pub(super) mod parts;
pub(super) mod relative_angles;
pub(super) mod restriction;
pub(super) mod symmetry;
