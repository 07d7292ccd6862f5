//! Straight-line programs as text: functions of Rust, loops in them, series, and texts of C.
//!
//! `code` writes statements, `rolled` those with loops, `unpacked` the elements of arrays as variables; `functions` is the module of them all.

mod code;
pub(super) mod formula;
pub(super) mod functions;
mod rolled;
pub(super) mod series;
pub(super) mod source;
mod unpacked;
