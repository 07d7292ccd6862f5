//! Functions that generated code calls, out of line: checks of constants, and parts of arrays.

mod constants;
mod contacts;

use core::fmt;

pub use crate::generated::condition::condition;
pub use crate::numbers::choices::largest;
pub use crate::numbers::running_error::rounded;
use crate::{Ordered, Real, RunningError};
pub use constants::{
    Bound, check_constants, check_definite, check_entries, check_finite, check_fixed, check_hoisted,
    check_inertia, check_limits, check_mass, check_nonnegative, check_nonzero, check_pivot, check_positive,
    check_within,
};
pub use contacts::{conditions, free_motion, loads, padded};

/// The names of fields without the `r#` of those that are keywords.
///
/// ```
/// assert_eq!(guen_runtime::checks::plain(["r#type", "theta"]), ["type", "theta"]);
/// ```
pub const fn plain<const N: usize>(mut fields: [&'static str; N]) -> [&'static str; N] {
    let mut i = 0;
    while i < N {
        if let [b'r', b'#', ..] = fields[i].as_bytes() {
            fields[i] = fields[i].split_at(2).1;
        }
        i += 1;
    }
    fields
}

/// Writes a struct of reals as `derive(Debug)` does.
///
/// ```
/// use core::fmt;
/// use guen_runtime::checks::show;
///
/// struct Point([f64; 2]);
/// impl fmt::Debug for Point {
///     fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
///         show(f, "Point", &["x", "y"], &self.0.each_ref())
///     }
/// }
/// assert_eq!(format!("{:?}", Point([1.0, 2.5])), "Point { x: 1.0, y: 2.5 }");
/// ```
///
/// # Errors
///
/// Those of the formatter.
pub fn show<R: fmt::Debug>(
    f: &mut fmt::Formatter<'_>,
    name: &str,
    fields: &[&str],
    values: &[&R],
) -> fmt::Result {
    let mut all = f.debug_struct(name);
    for (field, value) in fields.iter().zip(values) {
        all.field(field, value);
    }
    all.finish()
}

/// Whether each entry equals its counterpart, as in the `==` of arrays.
///
/// ```
/// use guen_runtime::checks::equal;
/// assert!(equal([&1.0, &2.0], [&1.0, &2.0]));
/// assert!(!equal([&1.0, &f64::NAN], [&1.0, &f64::NAN]));
/// ```
// References in the type, so that the compiler need not look for `PartialEq` of references in each expansion.
#[inline]
pub fn equal<R: PartialEq, const N: usize>(a: [&R; N], b: [&R; N]) -> bool {
    a == b
}

/// A value inside of limits; what cannot be compared with them stays as it is.
///
/// ```
/// use guen_runtime::checks::clamped;
/// assert_eq!((clamped(3.0, -1.0, 1.0), clamped(-3.0, -1.0, 1.0), clamped(0.5, -1.0, 1.0)), (1.0, -1.0, 0.5));
/// assert!(clamped(f64::NAN, -1.0, 1.0).is_nan());
/// ```
#[inline]
pub fn clamped<R: Ordered>(value: R, lower: R, upper: R) -> R {
    if value < lower {
        lower
    } else if value > upper {
        upper
    } else {
        value
    }
}

/// The largest of some differences that should vanish, each relative to the size of its terms.
///
/// ```
/// use guen_runtime::{RunningError, checks::furthest};
/// // x^2 + y^2 - 1 at (3/5, 0.81)
/// let [x, y] = [0.6, 0.81].map(RunningError::once);
/// assert!((0.002..0.02).contains(&furthest(&[x * x + y * y - RunningError::exact(1.0)])));
/// ```
#[inline(always)]
pub fn furthest<R: Real, const N: usize>(differences: &[RunningError<R>; N]) -> R {
    largest(
        &differences
            .map(|difference| difference.value.abs().where_above(R::zero(), difference.left(), R::zero())),
    )
}

/// A symmetric matrix from its lower triangle, row by row, at the head of a list that may go on; zeros where it ends before.
///
/// ```
/// assert_eq!(guen_runtime::checks::symmetric::<f64, 2>(&[1.0, 2.0, 3.0, 9.0]), [[1.0, 2.0], [2.0, 3.0]]);
/// ```
#[inline(always)]
pub fn symmetric<R: Real, const N: usize>(triangle: &[R]) -> [[R; N]; N] {
    let mut matrix = [[R::zero(); N]; N];
    let places = (0..N).flat_map(|s| (0..=s).map(move |k| (s, k)));
    for ((s, k), value) in places.zip(triangle) {
        matrix[s][k] = *value;
        matrix[k][s] = *value;
    }
    matrix
}

/// Values of a state, rounded once.
///
/// ```
/// use guen_runtime::{RunningError, checks::rounded_once};
/// assert_eq!(rounded_once([1.5])[0], RunningError::once(1.5));
/// ```
#[inline]
pub fn rounded_once<R: Real, const N: usize>(values: [R; N]) -> [RunningError<R>; N] {
    values.map(RunningError::once)
}

/// Positions, each rounded once, and as uncertain as one of at least `1e-10` of the largest: an equation that is a product of positions, as
/// `x z + w y = 0` of a hinge, has nothing but roundings in it where `x` and `y` vanish.
///
/// ```
/// use guen_runtime::checks::{furthest, positions_rounded_once};
/// let off = |x: f64| {
///     let [x, y, z, w] = positions_rounded_once([x, 0.0, 0.6, 0.8]);
///     furthest(&[x * z + w * y])
/// };
/// assert!(off(1e-17) < 1e-6 && off(1e-4) > 0.1);
/// ```
#[inline]
pub fn positions_rounded_once<R: Real, const N: usize>(positions: [R; N]) -> [RunningError<R>; N] {
    let least = largest(&positions) * R::from_ratio(1, 10_000_000_000);
    positions.map(|value| {
        let size = value.abs();
        RunningError { value, error: size.where_above(least, size, least) }
    })
}

/// Returns what is left of each value beside its rounding.
///
/// ```
/// use guen_runtime::{RunningError, checks::left};
/// let value = RunningError::once(2.0);
/// assert_eq!(left([value]), [value.left()]);
/// ```
#[inline]
pub fn left<R: Real, const N: usize>(values: [RunningError<R>; N]) -> [R; N] {
    values.map(RunningError::left)
}

/// A row of a matrix that is stored row by row; zeros where it ends before.
///
/// ```
/// assert_eq!(guen_runtime::checks::row::<f64, 2>(&[1.0, 2.0, 3.0, 4.0], 1), [3.0, 4.0]);
/// ```
#[inline]
pub fn row<R: Real, const N: usize>(matrix: &[R], index: usize) -> [R; N] {
    core::array::from_fn(|i| matrix.get(index * N + i).copied().unwrap_or_else(R::zero))
}

/// The first values of a list; zeros where there are no more.
///
/// ```
/// assert_eq!(guen_runtime::checks::first::<f64, 2>(&[1.0, 2.0, 3.0]), [1.0, 2.0]);
/// ```
#[inline(always)]
pub fn first<R: Real, const N: usize>(values: &[R]) -> [R; N] {
    let mut first = [R::zero(); N];
    for (first, value) in first.iter_mut().zip(values) {
        *first = *value;
    }
    first
}

/// The first values of an array, of which there are at least so many.
///
/// ```
/// assert_eq!(guen_runtime::checks::head::<f64, 3, 2>(&[1.0, 2.0, 3.0]), [1.0, 2.0]);
/// ```
// Without a loop, in which guards would spend more than in what they check: the length is known when it is compiled.
#[inline(always)]
pub fn head<R: Real, const N: usize, const K: usize>(values: &[R; N]) -> [R; K] {
    match values.first_chunk() {
        Some(head) => *head,
        None => first(values),
    }
}

/// The values of a list, and behind them those of another as far as there is place.
///
/// ```
/// assert_eq!(guen_runtime::checks::joined::<f64, 3>(&[1.0, 2.0], &[3.0, 4.0]), [1.0, 2.0, 3.0]);
/// ```
#[inline(always)]
pub fn joined<R: Real, const N: usize>(head: &[R], tail: &[R]) -> [R; N] {
    let mut joined = [R::zero(); N];
    for (joined, value) in joined.iter_mut().zip(head.iter().chain(tail)) {
        *joined = *value;
    }
    joined
}

/// Writes the first `count` functions that must not vanish to the head of `values`, as far as there is place for them, and
/// returns how many: what [`Guarded::singularities`](crate::Guarded::singularities) and [`System::switches`](crate::System::switches) do with them.
///
/// ```
/// use guen_runtime::{RunningError, checks::placed};
/// let functions = [1.0, 2.0, 3.0].map(RunningError::once);
/// let mut values = [RunningError::once(0.0); 4];
/// assert_eq!((placed(&mut values, &functions, 2), values[1].value, values[2].value), (2, 2.0, 0.0));
/// assert_eq!(placed(&mut values[..1], &functions, 3), 1);
/// ```
#[inline(always)]
pub fn placed<T: Copy, const N: usize>(values: &mut [T], functions: &[T; N], count: usize) -> usize {
    let mut written = 0;
    for (place, function) in values.iter_mut().zip(functions.iter().take(count)) {
        *place = *function;
        written += 1;
    }
    written
}

/// Returns the distance of carried functions from their values: the largest `|w - f|/(1 + |f|)`.
///
/// ```
/// assert_eq!(guen_runtime::checks::drift(&[1.0, 3.0], &[1.0, 5.0]), 0.5);
/// ```
#[inline(always)]
pub fn drift<R: Real, const K: usize>(values: &[R; K], carried: &[R]) -> R {
    let mut apart = [R::zero(); K];
    for ((apart, f), w) in apart.iter_mut().zip(values).zip(carried) {
        *apart = (*w - *f) / (R::one() + f.abs());
    }
    largest(&apart)
}
