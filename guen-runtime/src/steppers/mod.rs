//! Steppers: methods that carry a state through time.
//!
//! | method | order | step | for | demands |
//! | --- | --- | --- | --- | --- |
//! | [`Euler`] | 1 | fixed | comparisons | any [`Real`] |
//! | [`Rk4`] | 4 | fixed | inputs that change at every step, lanes | any [`Real`] |
//! | [`Rk8`] | 8 | fixed | smooth motions, lanes | any [`Real`] |
//! | [`Gauss4`], [`Gauss6`] | 4, 6 | fixed, implicit | long runs, moderate stiffness | [`Ordered`](crate::Ordered), [`Differentiable`](crate::Differentiable) |
//! | [`Tsit5`] | 5, dense output 4 | adaptive | low accuracy | [`Ordered`](crate::Ordered) |
//! | [`Dop853`] | 8, dense output 7 | adaptive | the usual choice | [`Ordered`](crate::Ordered) |
//! | [`Radau5`] | 5, dense output 3 | adaptive, implicit | stiff systems | [`Ordered`](crate::Ordered), [`Differentiable`](crate::Differentiable) |
//! | [`Taylor`] | up to 32, dense output the same | adaptive | high accuracy, long runs | [`Ordered`](crate::Ordered), [`TaylorSeries`](crate::TaylorSeries) |
//! | [`Bounded`] | 8 or 5 | fixed number of evaluations | control periods | [`Ordered`](crate::Ordered) |
//!
//! All but the last are driven alike, by an [`Integration`]: an observer sees every accepted step and may stop the run,
//! samples and [`Event`]s lie on the [`Dense`] output, a [`Guard`] watches what the system keeps. Each has the short ways
//! `integrate`, with an observer, and `sample`, which lands on given times. Sizes are fixed at compile time and nothing
//! is allocated. Every accepted state is finite, and a failure carries the last one that was in order.
//!
//! Methods with a fixed step are made by `new(step)`, those that choose it by `new(rtol, atol)`; `with_..` sets what else there is.
//!
//! ```
//! use guen_runtime::steppers::{Dop853, Euler, Gauss4, Gauss6, Radau5, Rk4, Rk8, Taylor, Tsit5};
//!
//! let steps = [Euler::new(0.1).step, Rk4::new(0.1).step, Rk8::new(0.1).step, Gauss4::new(0.1).step, Gauss6::new(0.1).step];
//! assert_eq!(steps, [0.1; 5]);
//! let (a, b, c) = (Tsit5::<f64>::new(1e-6, 1e-9), Dop853::<f64>::new(1e-6, 1e-9), Radau5::<f64>::new(1e-6, 1e-9));
//! let d = Taylor::<f64>::new(1e-6, 1e-9);
//! assert_eq!([a.rtol, b.rtol, c.rtol, d.rtol, a.atol, b.atol, c.atol, d.atol], [1e-6, 1e-6, 1e-6, 1e-6, 1e-9, 1e-9, 1e-9, 1e-9]);
//! ```

mod driver;
pub(crate) mod explicit;
pub(crate) mod guard;
mod implicit;
pub(crate) mod root;
mod settings;
mod step_size;
pub(crate) mod taylor;

pub use driver::dense::{Dense, Interpolant};
pub use driver::error::{Cause, IntegrationError, Setting};
pub(crate) use driver::error::{NamedError, Names};
pub use driver::events::{Direction, Event, Occurrence};
pub use driver::integration::Integration;
pub use driver::run::{Checkpoint, IntegrationResult, Method, Outcome, StepperRun};
pub use driver::statistics::Statistics;
pub use explicit::bounded::{Bounded, BoundedResult};
pub use explicit::compensated::Compensated;
pub use explicit::dop853::{self, Dop853};
pub use explicit::euler::Euler;
pub use explicit::lanes::{InLanes, LaneMethod};
pub use explicit::rk4::{self, Rk4};
pub use explicit::rk8::Rk8;
pub use explicit::tsit5::Tsit5;
pub use guard::Guard;
pub use guard::reversal::{Reversible, Varied, reversible};
pub use implicit::gauss::{Gauss4, Gauss6};
pub use implicit::radau5::Radau5;
pub use taylor::{Series, Taylor};

use crate::numbers::real::Real;

/// Whether a state has so many entries that steps are made in place. Copies of it cost more than they save then, and fill the stack in
/// a build without optimisation. An evaluation of DOP853 in place takes 1.2 times as long as by expressions with 64 entries, 0.7 with
/// 128 and 0.55 with 2,000.
const fn is_long<const N: usize>() -> bool {
    N > 96
}

/// Returns the array with `entry(i)` in place `i`.
// A loop, because the calls behind `core::array::from_fn` are not always inlined, and lanes need that. Each closure given to that
// function makes five more to compile, too.
#[inline(always)]
fn entries<T: Copy + Default, const N: usize>(mut entry: impl FnMut(usize) -> T) -> [T; N] {
    let mut all = [T::default(); N];
    for (i, place) in all.iter_mut().enumerate() {
        *place = entry(i);
    }
    all
}

/// `h k`
#[inline(always)]
fn scaled<R: Real, const N: usize>(h: R, slope: &[R; N]) -> [R; N] {
    entries(|i| h * slope[i])
}

/// `x + h k`
#[inline(always)]
fn shifted<R: Real, const N: usize>(x: &[R; N], h: R, slope: &[R; N]) -> [R; N] {
    let mut shifted = *x;
    for (entry, slope) in shifted.iter_mut().zip(slope) {
        *entry += h * *slope;
    }
    shifted
}

/// [`shifted`] by [`Real::times_plus`], with one rounding in [`Fused`](crate::Fused) reals: for sums that the next stage waits
/// for, in a function that is inlined into one of [`Real::vectorize`]. Elsewhere a default build calls a function for each.
#[inline(always)]
fn moved<R: Real, const N: usize>(x: &[R; N], h: R, slope: &[R; N]) -> [R; N] {
    let mut moved = *x;
    for (entry, slope) in moved.iter_mut().zip(slope) {
        *entry = h.times_plus(*slope, *entry);
    }
    moved
}

/// `sum_j w_j k_j`
#[inline(always)]
fn weighted<R: Real, const N: usize, const M: usize>(weights: &[R; M], slopes: [&[R; N]; M]) -> [R; N] {
    leading(weights, slopes)
}

/// `sum_j w_j k_j` over as many weights as there are slopes.
// With iterators and a test for the first term DOP853 took 1.7 times as long: measure what is changed here.
#[allow(clippy::needless_range_loop, reason = "the loops that the compiler keeps in registers")]
#[inline(always)]
fn leading<R: Real, const N: usize, const M: usize>(weights: &[R], slopes: [&[R; N]; M]) -> [R; N] {
    let mut sum = *slopes[0];
    for entry in &mut sum {
        *entry = weights[0] * *entry;
    }
    for j in 1..M {
        for i in 0..N {
            sum[i] += weights[j] * slopes[j][i];
        }
    }
    sum
}

/// The part of a stage's argument that is known before its last slope.
#[inline(always)]
fn ahead<const EARLY: bool, R: Real, const N: usize, const M: usize>(
    x: &[R; N],
    h: R,
    weights: &[R],
    slopes: [&[R; N]; M],
) -> [R; N] {
    let sum = leading(weights, slopes);
    if EARLY { shifted(x, h, &sum) } else { sum }
}

/// A stage's argument, from what [`ahead`] knew and the last slope with its weight.
#[inline(always)]
fn arrived<const EARLY: bool, R: Real, const N: usize>(
    x: &[R; N],
    h: R,
    near: &[R; N],
    weight: R,
    slope: &[R; N],
) -> [R; N] {
    if EARLY { shifted(near, h * weight, slope) } else { moved(x, h, &moved(near, weight, slope)) }
}

/// Whether every entry is finite.
#[inline]
fn all_finite<R: Real, const N: usize>(x: &[R; N]) -> bool {
    // All of them, without a branch in between.
    x.iter().fold(true, |finite, entry| finite & entry.is_finite())
}
