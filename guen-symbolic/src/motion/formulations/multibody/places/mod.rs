//! Places: in which axes and at which points the bodies are seen, as a tree.
//!
//! `axes` (with `shifts`, `rotations`, and `neighbours` for axes given in the world) and `points` (with `pins`) come first; `tree` puts them together in numbered
//! expressions.

mod axes;
pub(super) mod combinations;
mod neighbours;
mod pins;
mod points;
pub(super) mod rotations;
pub(super) mod shifts;
pub(super) mod tree;
