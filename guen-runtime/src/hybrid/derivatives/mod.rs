//! Derivatives of a motion through modes: `jump` and `saltation` at one transition, `sensitivity` along the whole motion.

mod jump;
pub(super) mod saltation;
#[cfg(feature = "alloc")]
pub(super) mod sensitivity;
#[cfg(feature = "alloc")]
mod start;
