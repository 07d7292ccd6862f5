//! Quantities of a level, as formulas and then as straight-line programs.
//!
//! `formulas` has those of the whole system, `parts` those of a scene, `domain` and `switches` where they end or change; `programs` makes code of them.

pub(super) mod control;
pub(super) mod domain;
pub(super) mod formulas;
pub(super) mod jacobians;
pub(super) mod missing_bounds;
pub(super) mod parts;
pub(super) mod programs;
pub(super) mod switches;
