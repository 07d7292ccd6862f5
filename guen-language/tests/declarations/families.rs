//! The texts of declarations of families of systems, as the benchmarks have them.
#![allow(dead_code, reason = "the rest is for systems that are compiled")]

#[path = "../../../workshop/guen-benchmarks/src/arms.rs"]
pub mod arms;
#[path = "../../../workshop/guen-benchmarks/src/bars.rs"]
pub mod bars;
#[path = "../../../workshop/guen-benchmarks/src/chains.rs"]
pub mod chains;
#[path = "../../../workshop/guen-benchmarks/src/parallel.rs"]
pub mod parallel;
#[path = "../../../workshop/guen-benchmarks/src/robots.rs"]
pub mod robots;
