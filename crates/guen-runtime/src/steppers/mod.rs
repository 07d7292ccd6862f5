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

mod control;
pub mod dop853;
mod dop853_coefficients;
mod integrate;
mod lanes;
pub mod rk4;
mod tableau;

pub use dop853::Dop853;
pub use integrate::{Done, Outcome, Statistics};
pub use lanes::InLanes;
pub use rk4::Rk4;

use crate::real::Real;

/// `x + h k`
// A loop, because the calls behind `core::array::from_fn` are not always inlined, and lanes need that.
#[inline(always)]
fn shifted<R: Real, const N: usize>(x: &[R; N], h: R, slope: &[R; N]) -> [R; N] {
    let mut shifted = *x;
    for (entry, slope) in shifted.iter_mut().zip(slope) {
        *entry += h * *slope;
    }
    shifted
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
    x.iter().all(|entry| entry.is_finite())
}
