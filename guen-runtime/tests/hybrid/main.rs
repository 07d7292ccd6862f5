//! Runs through modes: the reference scenes with systems written by hand, impacts, and what goes wrong.

mod bodies;
mod friction;
mod json;
#[cfg(feature = "alloc")]
mod least_flights;
mod methods;
#[cfg(feature = "alloc")]
mod no_number;
#[cfg(feature = "alloc")]
mod polygons;
mod reference;
#[cfg(feature = "alloc")]
mod saltation;
mod scenarios;
mod systems;
