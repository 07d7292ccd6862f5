//! Explicit methods: with a fixed step, with a step that follows the error, and with a fixed number of evaluations.

pub(crate) mod adaptive;
pub(crate) mod bounded;
pub(crate) mod compensated;
pub mod dop853;
mod dop853_coefficients;
pub(crate) mod euler;
pub(crate) mod fixed;
mod in_place;
pub(crate) mod lanes;
pub mod rk4;
pub(crate) mod rk8;
pub(crate) mod tableau;
pub(crate) mod tsit5;
mod tsit5_coefficients;
