//! Reals, duals, elementary functions, and what stands on them alone.

mod classification;
mod duals;
mod elementary;
mod nalgebra;
mod operators;
mod rounded;
mod scalar;
mod tuned;
