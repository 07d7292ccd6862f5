//! Steppers: methods that carry a state through time.
//!
//! | method | order | step | kept invariants | demands |
//! | --- | --- | --- | --- | --- |
//! | [`Rk4`] | 4 | fixed | none: not symplectic | any [`Real`] |
//! | [`Dop853`] | 8, errors estimated by orders 5 and 3 | adaptive | none: not symplectic | an [`Ordered`](crate::Ordered) real, a smooth and not stiff right-hand side |
//!
//! Both are driven alike: `integrate` shows each accepted step to an observer, which may stop the run; `sample`
//! stops at given times exactly. Sizes are fixed at compile time and nothing is allocated. Every accepted state
//! is finite, and a failure carries the last of them.

mod adaptive;
mod collocation;
mod control;
mod course;
mod dense;
pub mod dop853;
mod dop853_coefficients;
mod euler;
mod events;
mod fixed;
mod gauss;
mod guard;
mod integration;
mod landing;
mod lanes;
mod lu;
mod radau5;
pub mod rk4;
mod rk8;
mod tableau;
mod tsit5;
mod tsit5_coefficients;

pub use course::{Course, Done, Method, Outcome, Reached, Statistics};
pub use dense::Dense;
pub use dop853::Dop853;
pub use euler::Euler;
pub use events::{Direction, Event, Occurrence};
pub use gauss::{Gauss4, Gauss6};
pub use guard::Guard;
pub use integration::Integration;
pub use lanes::InLanes;
pub use radau5::Radau5;
pub use rk4::Rk4;
pub use rk8::Rk8;
pub use tsit5::Tsit5;

use crate::real::Real;

/// `x + h k`
#[inline]
fn shifted<R: Real, const N: usize>(x: &[R; N], h: R, slope: &[R; N]) -> [R; N] {
    core::array::from_fn(|i| x[i] + h * slope[i])
}

/// `sum_j w_j k_j`
#[inline]
fn weighted<R: Real, const N: usize, const M: usize>(weights: &[R; M], slopes: [&[R; N]; M]) -> [R; N] {
    core::array::from_fn(|i| {
        let mut sum = weights[0] * slopes[0][i];
        for j in 1..M {
            sum += weights[j] * slopes[j][i];
        }
        sum
    })
}

/// Whether every entry is finite.
#[inline]
fn all_finite<R: Real, const N: usize>(x: &[R; N]) -> bool {
    // All of them, without a branch in between.
    x.iter().fold(true, |finite, entry| finite & entry.is_finite())
}
