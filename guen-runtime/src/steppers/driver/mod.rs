//! Drives a method to a result: the run of a method, the loop around it, dense output, events and samples.

pub(crate) mod any_run;
pub(crate) mod crossing;
pub(crate) mod dense;
mod drive_loop;
pub(crate) mod error;
pub(crate) mod events;
mod followed;
pub(crate) mod integration;
pub(crate) mod run;
pub(crate) mod short_ways;
pub(crate) mod statistics;
mod swings;
mod switches;
mod within_step;
