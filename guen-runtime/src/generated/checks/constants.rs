//! Checks of constants and of what is prepared from them: each names the guilty constant in its error.

use crate::system::constants_error::BodyFault;
use crate::{ConstantsError, EntryNames, Real};

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
    let mut checked = values.iter().zip(bounds);
    checked.try_for_each(|(value, (name, bound))| check_constant(*value, name, *bound))
}

fn check_constant<R: Real>(value: R, name: &'static str, bound: Bound) -> Result<(), ConstantsError> {
    check_finite(value, name)?;
    match bound {
        Bound::None => Ok(()),
        Bound::Positive(words) => check_positive(value, name, words),
        Bound::Nonnegative(words) => check_nonnegative(value, name, words),
        Bound::Nonzero(words) => check_nonzero(value, name, words),
    }
}

/// Refuses entries of an array that are not finite or outside of their bound.
///
/// ```
/// use guen_runtime::checks::{Bound, check_entries};
/// use guen_runtime::EntryNames;
/// const NAMES: &EntryNames<2, 4> = &EntryNames::new("m[", 0, "]");
/// const WORDS: &EntryNames<2, 8> = &EntryNames::new("m[", 0, "] > 0");
/// assert!(check_entries(&[1.0, 2.0], NAMES, WORDS, Bound::Positive).is_ok());
/// assert!(check_entries(&[1.0, 0.0], NAMES, WORDS, Bound::Positive).is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::NotFinite`] or [`ConstantsError::OutOfBound`] of the first of them.
pub fn check_entries<R: Real, const N: usize, const L: usize, const W: usize>(
    values: &[R],
    names: &'static EntryNames<N, L>,
    words: &'static EntryNames<N, W>,
    bound: impl Fn(&'static str) -> Bound,
) -> Result<(), ConstantsError> {
    let mut checked = values.iter().enumerate();
    checked.try_for_each(|(k, value)| check_constant(*value, names.get(k), bound(words.get(k))))
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
    const PIVOT_ROUNDING: f64 = 1e-9;
    let sizes: [f64; L] = core::array::from_fn(|s| matrix[s][s].abs());
    for s in 0..L {
        let pivot = matrix[s][s];
        if pivot < -PIVOT_ROUNDING * sizes[s] {
            return true;
        }
        if pivot.is_nan() || pivot <= PIVOT_ROUNDING * sizes[s] {
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
    const TRACE_ROUNDING: f64 = 64.0 * f64::EPSILON;

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
    if half > 0.0 && minors.iter().all(|minor| *minor >= -TRACE_ROUNDING) { Ok(()) } else { Err(fault) }
}
