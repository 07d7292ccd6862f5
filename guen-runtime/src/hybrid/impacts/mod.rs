//! Impacts by Poisson's law: `impact` has the two phases, `phase` solves one by enumeration, `turning` finds directions of spatial slip.

pub(super) mod impact;
pub(super) mod phase;
pub(super) mod turning;
