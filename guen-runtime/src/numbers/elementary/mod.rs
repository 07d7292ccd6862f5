//! Elementary functions of our own, for the hot path of a right-hand side.
//!
//! They are straight-line code without fused operations, written for any register of lanes, so that `f64`, lanes and
//! every platform give the same bits. One forward branch leaves the line, for arguments out of range. A sine or cosine
//! of one number without its partner has a second branch, which chooses one of two polynomials.
//!
//! | function | range | error | beyond the range |
//! | --- | --- | --- | --- |
//! | [`sin_cos`], default | `abs(x) <= 2^18` | below 0.8 ulp | Payne's and Hanek's reduction, same error |
//! | [`sin_cos_13`] | `abs(x) <= 2^18` | below 1e-13 | as above |
//! | [`sin_cos_7`] | `abs(x) <= 2^18` | below 4e-8 | as above |
//!
//! `tests/numbers/elementary.rs` measures the errors against 71 digits; `workshop/benches/elementary` prints them beside the times.

mod argument_reduction;
pub(crate) mod correctly_rounded;
mod trigonometric;

pub(crate) use correctly_rounded::{fused, sqrt};
pub(crate) use trigonometric::{cos, sin, sin_cos, sin_cos_7, sin_cos_13};
