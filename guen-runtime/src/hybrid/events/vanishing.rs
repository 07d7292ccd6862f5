//! Numbers that count as zero: within roundings, or within the errors of integration and location.

use crate::numbers::running_error::RunningError;

/// The number of roundings of everything that it is made of within which a number vanishes.
pub(super) const NOISE: f64 = 256.0;
/// The part of what a derivative is made of below which it vanishes: what integration and location leave of a zero.
pub(in crate::hybrid) const VANISHING: f64 = 1e-9;
/// Below this part of it a derivative vanishes where values are taken as they are: what roundings leave of a zero.
pub(in crate::hybrid) const VANISHING_ROUNDING: f64 = NOISE * 0.5 * f64::EPSILON;

/// Whether a number is no more than rounding.
pub(in crate::hybrid) fn is_rounding(number: RunningError<f64>) -> bool {
    number.value.abs() <= VANISHING_ROUNDING * number.error
}

/// Whether a number vanishes up to what it is made of.
pub(in crate::hybrid) fn vanishes(number: RunningError<f64>) -> bool {
    vanishes_within(number, VANISHING)
}

/// Whether a number vanishes up to a part of what it is made of.
pub(in crate::hybrid) fn vanishes_within(number: RunningError<f64>, part: f64) -> bool {
    number.value.abs() <= part * number.error
}
