//! Planning: which velocity follows from which, and which are left as unknowns of the core.
//!
//! `independent` chooses other velocities than the parameters where loops are short in these; `plan` goes through the tree, `directions` chooses the
//! components of contacts, `safety` judges divisors, `core` solves what is left.

pub(super) mod core;
mod directions;
pub(super) mod independent;
pub(super) mod plan;
mod safety;
