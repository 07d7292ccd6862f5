//! What `mechanical_system!` generates, row by row of the table in the language reference.

mod classification;
mod constants;
mod expansion;
mod indefinite;
mod momenta;
mod motion;
mod operators;
mod power;
mod reals;
mod state;
