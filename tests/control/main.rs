//! What controllers take of a system: linearisations, leaves, discrete models, steady motions, reactions.

#[macro_use]
extern crate guen_benchmarks;

mod balance;
mod dynamics;
#[macro_use]
mod jacobians;
mod examples;
mod models;
mod motion;
mod reduction;
mod states;
mod vehicles;
