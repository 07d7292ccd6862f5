//! Checks that generated code calls, out of line.

use core::fmt;

pub use crate::generated::condition::condition;
use crate::hybrid::{Conditions, FreeMotion};
use crate::system::constants_error::BodyFault;
use crate::{ConstantsError, Ordered, Real, RunningError};

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
///         show(f, "Point", &["x", "y"], &self.0)
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
    values: &[R],
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
/// assert!(equal(&[1.0, 2.0], &[1.0, 2.0]));
/// assert!(!equal(&[1.0, f64::NAN], &[1.0, f64::NAN]));
/// ```
#[inline]
pub fn equal<R: PartialEq, const N: usize>(a: &[R; N], b: &[R; N]) -> bool {
    a == b
}

/// Refuses a constant that is not finite.
///
/// ```
/// assert!(guen_runtime::checks::check_finite(1.0_f64, "a").is_ok());
/// assert!(guen_runtime::checks::check_finite(f64::NAN, "a").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::NotFinite`] with its name and value.
pub fn check_finite<R: Real>(value: R, name: &'static str) -> Result<(), ConstantsError> {
    if value.is_finite() { Ok(()) } else { Err(ConstantsError::NotFinite { name, value: value.to_f64() }) }
}

/// Refuses a constant that has to be positive and is not; `bound` says so in words.
///
/// ```
/// assert!(guen_runtime::checks::check_positive(1.0_f64, "a", "a > 0").is_ok());
/// assert!(guen_runtime::checks::check_positive(0.0_f64, "a", "a > 0").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::OutOfBound`] with its name, bound and value.
pub fn check_positive<R: Real>(
    value: R,
    name: &'static str,
    bound: &'static str,
) -> Result<(), ConstantsError> {
    bounded(value, name, bound, |value| value > 0.0)
}

/// Refuses a constant that is negative and must not be.
///
/// ```
/// assert!(guen_runtime::checks::check_nonnegative(0.0_f64, "a", "a >= 0").is_ok());
/// assert!(guen_runtime::checks::check_nonnegative(-1.0_f64, "a", "a >= 0").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::OutOfBound`] with its name, bound and value.
pub fn check_nonnegative<R: Real>(
    value: R,
    name: &'static str,
    bound: &'static str,
) -> Result<(), ConstantsError> {
    bounded(value, name, bound, |value| value >= 0.0)
}

/// Refuses a constant that is zero and must not be.
///
/// ```
/// assert!(guen_runtime::checks::check_nonzero(-1.0_f64, "a", "a != 0").is_ok());
/// assert!(guen_runtime::checks::check_nonzero(0.0_f64, "a", "a != 0").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::OutOfBound`] with its name, bound and value.
pub fn check_nonzero<R: Real>(
    value: R,
    name: &'static str,
    bound: &'static str,
) -> Result<(), ConstantsError> {
    bounded(value, name, bound, |value| value != 0.0)
}

/// Refuses a constant outside of its limits; `bound` says so in words.
///
/// ```
/// use guen_runtime::checks::check_within;
/// assert!(check_within(0.5, 0.0, 1.0, "e", "e in 0..1").is_ok());
/// assert!(check_within(1.5, 0.0, 1.0, "e", "e in 0..1").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::OutOfBound`] with its name, bound and value.
pub fn check_within<R: Real>(
    value: R,
    lower: R,
    upper: R,
    name: &'static str,
    bound: &'static str,
) -> Result<(), ConstantsError> {
    let (lower, upper) = (lower.to_f64(), upper.to_f64());
    bounded(value, name, bound, |value| lower <= value && value <= upper)
}

fn bounded<R: Real>(
    value: R,
    name: &'static str,
    bound: &'static str,
    holds: impl Fn(f64) -> bool,
) -> Result<(), ConstantsError> {
    let value = value.to_f64();
    if holds(value) { Ok(()) } else { Err(ConstantsError::OutOfBound { name, bound, value }) }
}

/// The bound of a constant, with its words.
///
/// ```
/// use guen_runtime::checks::{Bound, check_constants};
/// let bounds = [("a", Bound::Positive("a > 0")), ("g", Bound::None)];
/// assert!(check_constants(&[1.0, -9.81], &bounds).is_ok());
/// assert!(check_constants(&[0.0, -9.81], &bounds).is_err());
/// assert!(check_constants(&[1.0, f64::NAN], &bounds).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// Any number.
    None,
    /// A number above zero.
    Positive(&'static str),
    /// Zero, or a number above it.
    Nonnegative(&'static str),
    /// Any number but zero.
    Nonzero(&'static str),
}

/// Refuses constants that are not finite or outside of their bounds; each has its name and bound.
///
/// # Errors
///
/// [`ConstantsError::NotFinite`] or [`ConstantsError::OutOfBound`] of the first of them.
pub fn check_constants<R: Real, const N: usize>(
    values: &[R; N],
    bounds: &[(&'static str, Bound); N],
) -> Result<(), ConstantsError> {
    for (value, (name, bound)) in values.iter().zip(bounds) {
        check_finite(*value, name)?;
        match bound {
            Bound::None => {}
            Bound::Positive(words) => check_positive(*value, name, words)?,
            Bound::Nonnegative(words) => check_nonnegative(*value, name, words)?,
            Bound::Nonzero(words) => check_nonzero(*value, name, words)?,
        }
    }
    Ok(())
}

/// Refuses a pivot of constants that is zero or not finite.
///
/// ```
/// assert!(guen_runtime::checks::check_pivot(0.0_f64, "a - b").is_err());
/// assert!(guen_runtime::checks::check_pivot(1.0_f64, "a - b").is_ok());
/// ```
///
/// # Errors
///
/// [`ConstantsError::SingularPivot`] with the expression and its value.
pub fn check_pivot<R: Real>(value: R, what: &'static str) -> Result<(), ConstantsError> {
    if value == R::zero() || !value.is_finite() {
        return Err(ConstantsError::SingularPivot { what, value: value.to_f64() });
    }
    Ok(())
}

/// Refuses prepared values of which one is not finite.
///
/// ```
/// assert!(guen_runtime::checks::check_hoisted(&[1.0, f64::INFINITY]).is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::SingularPivot`]: constants are finite, so only a division can have made it so.
pub fn check_hoisted<R: Real, const N: usize>(values: &[R; N]) -> Result<(), ConstantsError> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(value) => Err(ConstantsError::SingularPivot {
            what: "an expression of the constants",
            value: value.to_f64(),
        }),
    }
}

/// Refuses a constant of a system that is not what a scene fixes it at.
///
/// ```
/// assert!(guen_runtime::checks::check_fixed(9.81, 9.81, "g").is_ok());
/// assert!(guen_runtime::checks::check_fixed(1.62, 9.81, "g").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::Contradicted`] with both values.
pub fn check_fixed<R: Real>(value: R, fixed: R, name: &'static str) -> Result<(), ConstantsError> {
    if value == fixed {
        return Ok(());
    }
    Err(ConstantsError::Contradicted { name, fixed: fixed.to_f64(), value: value.to_f64() })
}

/// The free motion of a system with contacts out of the values of its program: rates, gaps, rows, their rates, the lower
/// triangle of the Delassus matrix, the rates of the quasi-velocities that unit forces cause, coefficients of friction and of
/// stiction, limits; with `X` coordinates.
///
/// ```
/// // A point above a floor: the state is a height and its rate, the mass one half.
/// let values = [-1.0, -9.81, 2.0, -1.0, -9.81, 2.0, 2.0, 0.0, 0.0, 0.0];
/// let free = guen_runtime::checks::free_motion::<f64, 1, 2, 1, 1>(&values);
/// assert_eq!((free.gaps, free.delassus, free.responses), ([2.0], [[2.0]], [[0.0, 2.0]]));
/// ```
pub fn free_motion<R: Real, const X: usize, const N: usize, const W: usize, const C: usize>(
    values: &[R],
) -> FreeMotion<R, N, W, C> {
    let mut rest = values.iter().copied();
    let mut next = || rest.next().unwrap_or_else(R::zero);
    let rates = core::array::from_fn(|_| next());
    let gaps = core::array::from_fn(|_| next());
    let row_rates = core::array::from_fn(|_| next());
    let biases = core::array::from_fn(|_| next());
    let mut delassus = [[R::zero(); W]; W];
    let triangle = (0..W).flat_map(|row| (0..=row).map(move |column| (row, column)));
    triangle.for_each(|(row, column)| {
        let entry = next();
        (delassus[row][column], delassus[column][row]) = (entry, entry);
    });
    let responses =
        core::array::from_fn(|_| core::array::from_fn(|i| if i < X { R::zero() } else { next() }));
    let friction = core::array::from_fn(|_| next());
    let stiction = core::array::from_fn(|_| next());
    let limits = core::array::from_fn(|_| next());
    FreeMotion { rates, gaps, row_rates, biases, delassus, responses, friction, stiction, limits }
}

/// The conditions of a system with contacts: those under which contacts close, then those under which latches are released.
///
/// ```
/// let conditions = guen_runtime::checks::conditions::<f64, 1>(&[1.0, -1.0]);
/// assert_eq!((conditions.when, conditions.release), ([1.0], [-1.0]));
/// ```
pub fn conditions<R: Real, const C: usize>(values: &[R]) -> Conditions<R, C> {
    let value = |i: usize| values.get(i).copied().unwrap_or_else(R::zero);
    Conditions { when: core::array::from_fn(value), release: core::array::from_fn(|i| value(C + i)) }
}

/// The values of switches, with places for the branches of piecewise functions behind them.
///
/// ```
/// assert_eq!(guen_runtime::checks::padded::<1, 2>(&[true]), [true, false]);
/// ```
pub fn padded<const D: usize, const S: usize>(switches: &[bool; D]) -> [bool; S] {
    core::array::from_fn(|s| switches.get(s).copied().unwrap_or(false))
}

/// Refuses limits of an input that leave no value between them.
///
/// ```
/// assert!(guen_runtime::checks::check_limits(-1.0, 1.0, "tau").is_ok());
/// assert!(guen_runtime::checks::check_limits(1.0, -1.0, "tau").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::Limits`] with both limits.
pub fn check_limits<R: Real>(lower: R, upper: R, input: &'static str) -> Result<(), ConstantsError> {
    let (lower, upper) = (lower.to_f64(), upper.to_f64());
    if lower <= upper {
        return Ok(());
    }
    Err(ConstantsError::Limits { input, lower, upper })
}

/// Refuses a negative mass.
///
/// ```
/// assert!(guen_runtime::checks::check_mass(0.0, "frame").is_ok());
/// assert!(guen_runtime::checks::check_mass(-1.0, "frame").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::NotPhysical`].
pub fn check_mass<R: Real>(mass: R, body: &'static str) -> Result<(), ConstantsError> {
    let fault = BodyFault::NegativeMass;
    if mass.to_f64() < 0.0 { Err(ConstantsError::NotPhysical { body, fault }) } else { Ok(()) }
}

/// Refuses a mass matrix that has a negative direction at each of eight states: its inertia is that of a body whose negative mass
/// nothing outweighs.
///
/// ```
/// use guen_runtime::checks::check_definite;
/// assert!(check_definite(|[x]: [f64; 1]| [[2.0, x], [x, 1.0]], "cut").is_ok());
/// assert!(check_definite(|[x]: [f64; 1]| [[2.0, x], [x, -1.0]], "cut").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::Indefinite`].
pub fn check_definite<R: Real, const N: usize, const L: usize>(
    mass: impl Fn([R; N]) -> [[R; L]; L],
    body: &'static str,
) -> Result<(), ConstantsError> {
    const STATES: usize = 8;
    /// Multiples of it fill an interval evenly.
    const GOLDEN_SECTION: f64 = 0.618_033_988_749_894_9;
    for number in 0..STATES {
        let mut state = [R::zero(); N];
        for (i, entry) in state.iter_mut().enumerate() {
            let drawn = (number * N + i + 1) as f64 * GOLDEN_SECTION;
            *entry = R::from_f64(2.0 * (drawn - libm::floor(drawn)) - 1.0);
        }
        if !has_negative_pivot(mass(state).map(|row| row.map(Real::to_f64))) {
            return Ok(());
        }
    }
    Err(ConstantsError::Indefinite { body })
}

/// Whether a symmetric matrix has a pivot that is negative beyond rounding, and none before that is next to zero.
fn has_negative_pivot<const L: usize>(mut matrix: [[f64; L]; L]) -> bool {
    /// A part of the diagonal entry.
    const ROUNDING: f64 = 1e-9;
    let sizes: [f64; L] = core::array::from_fn(|s| matrix[s][s].abs());
    for s in 0..L {
        let pivot = matrix[s][s];
        if pivot < -ROUNDING * sizes[s] {
            return true;
        }
        if pivot.is_nan() || pivot <= ROUNDING * sizes[s] {
            return false;
        }
        let top = matrix[s];
        for row in matrix.iter_mut().skip(s + 1) {
            let part = row[s] / pivot;
            for (entry, above) in row.iter_mut().zip(&top).skip(s + 1) {
                *entry -= part * above;
            }
        }
    }
    false
}

/// Refuses an inertia, given by the matrix entries `xx, yy, zz, xy, yz, zx`, that no distribution of mass has.
///
/// ```text
/// S = tr(I)/2 1 - I = integral of r r^T dm
/// ```
///
/// must be positive semidefinite: all its principal minors are nonnegative. Then the principal moments are the sums
/// `s_2 + s_3, s_3 + s_1, s_1 + s_2` of nonnegative numbers, which is what the triangle inequality says.
///
/// ```
/// // A thin disc reaches the limit, C = 2 A; half of its moment about a diameter is too little.
/// assert!(guen_runtime::checks::check_inertia(&[0.1, 0.1, 0.2, 0.0, 0.0, 0.0], "disc").is_ok());
/// assert!(guen_runtime::checks::check_inertia(&[0.05, 0.05, 0.2, 0.0, 0.0, 0.0], "disc").is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::NotPhysical`].
pub fn check_inertia<R: Real>(entries: &[R; 6], body: &'static str) -> Result<(), ConstantsError> {
    /// Limits are meant to be reached: what is above them by this part of the trace is rounding.
    const ROUNDING: f64 = 64.0 * f64::EPSILON;

    let [xx, yy, zz, xy, yz, zx] = entries.map(Real::to_f64);
    let half = (xx + yy + zz) / 2.0;
    let fault = ConstantsError::NotPhysical { body, fault: BodyFault::Inertia };
    if half == 0.0 {
        // Without a trace there is nothing to measure by, and nothing but zero is physical.
        let still = [xx, yy, zz, xy, yz, zx].iter().all(|entry| *entry == 0.0);
        return if still { Ok(()) } else { Err(fault) };
    }
    // S over half the trace; the products of inertia enter with their signs turned.
    let [a, b, c] = [xx, yy, zz].map(|moment| 1.0 - moment / half);
    let [d, e, f] = [xy, yz, zx].map(|product| -product / half);
    let minors = [
        a,
        b,
        c,
        a * b - d * d,
        b * c - e * e,
        c * a - f * f,
        a * b * c + 2.0 * d * e * f - a * e * e - b * f * f - c * d * d,
    ];
    if half > 0.0 && minors.iter().all(|minor| *minor >= -ROUNDING) { Ok(()) } else { Err(fault) }
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

/// Values that were rounded once.
///
/// ```
/// use guen_runtime::{RunningError, checks::rounded};
/// assert_eq!(rounded(&[1.5, -2.0])[1], RunningError { value: -2.0, error: 2.0 });
/// ```
#[inline(always)]
pub fn rounded<R: Real, const N: usize>(values: &[R; N]) -> [RunningError<R>; N] {
    let mut rounded = [RunningError::exact(R::zero()); N];
    // A loop where the instructions of lanes are at hand: `map` is a call for each entry.
    R::vectorize(
        #[inline(always)]
        || {
            for (rounded, value) in rounded.iter_mut().zip(values) {
                *rounded = RunningError { value: *value, error: value.abs() };
            }
        },
    );
    rounded
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
/// returns how many: what [`System::singularities`](crate::System::singularities) and [`System::switches`](crate::System::switches) do with them.
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

/// The largest absolute value, as a real without an order can have it: through `f64` for the comparison, of lanes in every
/// lane by itself. Zero for no values, not finite if one of them is not.
///
/// ```
/// assert_eq!(guen_runtime::checks::largest(&[1.0, -3.0, 2.0]), 3.0);
/// ```
#[inline(always)]
pub fn largest<R: Real>(values: &[R]) -> R {
    let (mut most, mut rest) = (R::zero(), R::zero());
    for value in values {
        let size = value.abs();
        most = size.where_above(most, size, most);
        // Zero, unless it is not finite: what is compared with NaN would be taken for larger.
        rest += size * R::zero();
    }
    most + rest
}
