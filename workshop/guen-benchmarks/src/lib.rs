//! What guen is measured on: declared systems, the same right-hand sides written by hand, states, and a clock for pairs
//! of programs.
//!
//! Benchmarks, golden counts, the check of the assembly and the tables of accuracy and growth all take their systems
//! from here, so that a figure in one of them is about the same code as in the others. Not published.
#![forbid(unsafe_code)]

pub mod arms;
pub mod bars;
pub mod by_hand;
pub mod chains;
pub mod contacts;
#[macro_use]
mod declarations;
pub mod parallel;
pub mod platform;
mod processor;
mod random;
pub mod robots;
#[macro_use]
mod rolling;
mod subjects;
pub mod systems;
pub mod timing;

pub use random::Random;
pub use subjects::*;
