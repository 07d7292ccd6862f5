//! Reals, duals, elementary functions, and what stands on them alone.

mod classification;
mod duals;
mod elementary;
mod nalgebra;
mod operators;
mod running_error;
mod scalar;
mod with_functions;
mod wrapper;
