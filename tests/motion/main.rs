//! Runs of declared systems: their accuracy, their guards, their reversal, and what they take of memory.

#[macro_use]
extern crate guen_benchmarks;

mod allocations;
mod by_hand;
mod carried;
mod extremes;
mod guards;
mod inputs;
mod lanes;
mod published;
mod recovery;
mod reference;
mod reversal;
mod simulation;
mod singular;
mod states;
mod study_forecast;
mod taylor;
