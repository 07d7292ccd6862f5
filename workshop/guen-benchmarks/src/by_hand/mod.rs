//! Right-hand sides as a person would write them, with all constants combined beforehand.
//!
//! They are generic over the real like the generated code, so both sides call the same elementary functions. Each is
//! derived on paper, from the sources that its module names, and not from what the macro printed.

mod arms;
mod cars;
mod chains;
mod hoop;
mod sled;
mod tops;

pub use arms::arm;
pub use cars::car;
pub use chains::{chain_by_elimination, chain_by_tensions, joints};
pub use hoop::{appell, hoop, rate_hoop};
pub use sled::sled;
pub use tops::{euler_top, turntable};
