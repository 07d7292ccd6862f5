//! Numbers: the trait of reals, the reals of the platform, and what is built over them.
//!
//! | file | what |
//! | --- | --- |
//! | `real` | [`Real`](real::Real), [`Ordered`](real::Ordered) |
//! | `float`, `elementary` | `f32`, `f64` and their sines, cosines and roots |
//! | `dual`, `running_error` | a value with derivatives, a value with a bound of its rounding error |
//! | `power_series` | a value with its Taylor coefficients |
//! | `with_functions` | a real with exchanged elementary functions |
//! | `lanes` | several reals in the registers of the processor |
//! | `choices` | the smaller, the larger, the one of a condition: the same for every real |
//! | `lift` | from a real to those built over it |
//! | `rules`, `decimal` | rules of derivatives, and long constants, that these share |

pub(crate) mod choices;
pub(crate) mod decimal;
pub(crate) mod dual;
pub(crate) mod elementary;
mod float;
pub mod lanes;
pub(crate) mod lift;
pub(crate) mod power_series;
pub(crate) mod real;
mod rules;
pub(crate) mod running_error;
pub(crate) mod with_functions;
