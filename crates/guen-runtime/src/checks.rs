//! Checks that generated code calls, out of line.

use crate::{ConstantsError, Real};

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

/// Refuses a prepared value that is not finite.
///
/// ```
/// assert!(guen_runtime::checks::check_hoisted(f64::INFINITY).is_err());
/// ```
///
/// # Errors
///
/// [`ConstantsError::SingularPivot`]: constants are finite, so only a division can have made it so.
pub fn check_hoisted<R: Real>(value: R) -> Result<(), ConstantsError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(ConstantsError::SingularPivot { what: "an expression of the constants", value: value.to_f64() })
}

/// The largest absolute value, as a real without an order can have it: through `f64` for the comparison. Zero for
/// no values; a value that is not finite is returned as it is.
///
/// ```
/// assert_eq!(guen_runtime::checks::largest(&[1.0, -3.0, 2.0]), 3.0);
/// ```
pub fn largest<R: Real>(values: &[R]) -> R {
    let mut most = R::zero();
    for value in values {
        let size = value.abs();
        if !size.is_finite() {
            return size;
        }
        if size.to_f64() > most.to_f64() {
            most = size;
        }
    }
    most
}
