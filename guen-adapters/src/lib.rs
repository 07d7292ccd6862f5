//! Prepared systems of guen as systems of other solvers.
//!
//! | feature | crate | what for |
//! | --- | --- | --- |
//! | `differential-equations` | `differential-equations` 0.7 | its methods for ordinary, delay and boundary value problems |
//! | `diffsol` | `diffsol` 0.18 | BDF and SDIRK methods for stiff systems, sensitivities |
//!
//! Neither is on by default. Both get the Jacobian from the linearisation that the macro emits, exact to rounding, instead
//! of differences: a prepared system is [`Linearizable`](guen_runtime::Linearizable), and so is a scene that provides its linearisation. What is
//! [`Differentiable`](guen_runtime::Differentiable) only (a carried form, a driven system, another scene, equations
//! written by hand) becomes so by [`ByDuals`].
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod by_duals;
#[cfg(feature = "differential-equations")]
pub mod differential_equations;
#[cfg(feature = "diffsol")]
pub mod diffsol;

pub use by_duals::ByDuals;
