//! The language: what `mechanical_system!` generates, prints and accepts, for the paper's systems and for edge cases.
#![allow(
    mixed_script_confusables,
    reason = "Greek letters are names of physics; the lint is one of the whole crate"
)]

#[macro_use]
extern crate guen_benchmarks;

mod components;
mod derived;
mod edge_cases;
mod families;
mod generated;
mod hygiene;
mod moving_frames;
mod paper;
mod piecewise;
mod report;
mod serde;
mod slip;
mod supplied;
mod three_ways;
mod with_scalar;
