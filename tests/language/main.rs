//! The language: what `mechanical_system!` generates, prints and accepts, for the paper's systems and for strange ones.
#![allow(
    mixed_script_confusables,
    reason = "Greek letters are names of physics; the lint is one of the whole crate"
)]

#[macro_use]
extern crate guen_benchmarks;

mod derived;
mod generated;
mod hygiene;
mod paper;
mod report;
mod serde;
mod signs;
mod slip;
mod strange;
mod three_ways;
mod with_scalar;
