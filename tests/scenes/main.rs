//! Scenes: that they keep what they must and nothing else, that their equations are those of the whole system, and that
//! levels of detail can be changed during a run.

#[macro_use]
extern crate guen_benchmarks;

mod closure;
mod compare;
mod edge_cases;
mod ensembles;
mod equations;
mod fixing;
mod golden;
mod kinds;
mod levels;
mod models;
mod positions;
mod provided;
mod random_scenes;
