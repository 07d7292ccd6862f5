//! Bodies in space: systems that are declared by positions, orientations, masses and contacts, each beside a
//! calculation that shares nothing with the macro.

#![allow(non_snake_case, reason = "constants are called as in the declarations")]
#[macro_use]
extern crate guen_benchmarks;

#[allow(dead_code, reason = "the examples use the rest")]
#[path = "../../workshop/guen-measure/src/large_systems.rs"]
mod large_systems;

#[allow(dead_code, reason = "the paper's tests need all of it")]
#[path = "../language/paper/formulas.rs"]
mod formulas;

mod balls;
mod bicycle;
mod bricard;
mod by_hand;
mod expansion;
mod floating;
mod hinges;
mod hoop;
mod linkages;
mod manifold;
mod pendulums;
mod physical;
mod restoring;
mod rotations;
mod snakes;
mod stones;
mod tops;
mod twenty_links;
mod vehicles;
