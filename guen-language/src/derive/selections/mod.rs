//! Selections: the part of a declared system that a level of detail has, closed under what its rates depend on.
//!
//! `closure` finds the variables, `fixed` sets values that a scene fixes, `manifold` uses holonomic equations.

pub(super) mod closure;
pub(super) mod facts;
pub(super) mod fixed;
pub(super) mod manifold;
pub(super) mod selection;
