//! The equations of motion by their definition (2.7), and the proof that what is emitted agrees with it.
//!
//! `equations` is a mass matrix and forces; `poincare` and `projection` state them in two ways; `lagrange` has the same equations in numbers modulo p, and `proof`
//! compares with these.

pub(super) mod equations;
mod lagrange;
pub(super) mod poincare;
pub(super) mod projection;
pub(super) mod proof;
