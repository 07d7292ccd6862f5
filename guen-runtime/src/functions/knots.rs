//! Arguments of tables: their order, the slopes of curves through values, and the piece in which an argument lies.

use crate::functions::error::TableError;

/// Checks that arguments are finite, increase and are two or more.
pub(super) fn check(arguments: &[f64]) -> Result<(), TableError> {
    if arguments.len() < 2 {
        return Err(TableError::TooFew { points: arguments.len() });
    }
    check_finite(arguments)?;
    for index in 1..arguments.len() {
        let (before, value) = (arguments[index - 1], arguments[index]);
        if value <= before {
            return Err(TableError::NotIncreasing { index, before, value });
        }
    }
    Ok(())
}

/// Checks that all values are finite.
pub(super) fn check_finite(values: &[f64]) -> Result<(), TableError> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(TableError::NotFinite { index }),
        None => Ok(()),
    }
}

/// Checks that slopes and what follows from them are finite.
pub(super) fn check_slopes(slopes: &[f64]) -> Result<(), TableError> {
    match slopes.iter().position(|slope| !slope.is_finite()) {
        Some(index) => Err(TableError::TooSteep { index: index.max(1) }),
        None => Ok(()),
    }
}

/// The knot that the piece of an argument begins at, and whether the argument lies between two knots.
#[inline]
pub(super) fn piece(arguments: impl Fn(usize) -> f64, count: usize, x: f64) -> (usize, bool) {
    // The number of knots that are not above `x`; none for NaN.
    let (mut low, mut high) = (0, count);
    while low < high {
        let middle = (low + high) / 2;
        if arguments(middle) <= x {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    (low.saturating_sub(1), (1..count).contains(&low))
}

/// The slope of the chord behind a knot.
fn chord(x: &[f64], y: impl Fn(usize) -> f64, i: usize) -> f64 {
    (y(i + 1) - y(i)) / (x[i + 1] - x[i])
}

/// The slopes at the knots of the natural cubic spline: it is twice continuously differentiable, and its second derivatives at the ends
/// vanish.
pub(super) fn natural<const N: usize>(x: &[f64], y: impl Fn(usize) -> f64) -> [f64; N] {
    let last = x.len() - 1;
    let (mut slopes, mut upper) = ([0.0; N], [0.0; N]);
    // m[i-1]/h[i-1] + 2 m[i] (1/h[i-1] + 1/h[i]) + m[i+1]/h[i] = 3 (d[i-1]/h[i-1] + d[i]/h[i]), by elimination.
    for i in 0..=last {
        let before = if i > 0 { (x[i] - x[i - 1]).recip() } else { 0.0 };
        let behind = if i < last { (x[i + 1] - x[i]).recip() } else { 0.0 };
        let mut right = 0.0;
        if i > 0 {
            right += 3.0 * before * chord(x, &y, i - 1);
        }
        if i < last {
            right += 3.0 * behind * chord(x, &y, i);
        }
        let (eliminated, known) = if i > 0 { (upper[i - 1], slopes[i - 1]) } else { (0.0, 0.0) };
        let pivot = 2.0 * (before + behind) - before * eliminated;
        upper[i] = behind / pivot;
        slopes[i] = (right - before * known) / pivot;
    }
    for i in (0..last).rev() {
        slopes[i] -= upper[i] * slopes[i + 1];
    }
    slopes
}

/// The slopes at the knots of a cubic curve that rises and falls where the values do: harmonic means of the chords beside each knot,
/// zero at extrema of the values. F. N. Fritsch, J. Butland, *A method for constructing local monotone piecewise cubic
/// interpolants*, 1984.
pub(super) fn monotone<const N: usize>(x: &[f64], y: impl Fn(usize) -> f64) -> [f64; N] {
    let last = x.len() - 1;
    let mut slopes = [0.0; N];
    if last == 1 {
        slopes[0] = chord(x, &y, 0);
        slopes[1] = slopes[0];
        return slopes;
    }
    for i in 1..last {
        let (before, behind) = (chord(x, &y, i - 1), chord(x, &y, i));
        let (h0, h1) = (x[i] - x[i - 1], x[i + 1] - x[i]);
        if (before > 0.0 && behind > 0.0) || (before < 0.0 && behind < 0.0) {
            let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
            slopes[i] = (w0 + w1) / (w0 / before + w1 / behind);
        }
    }
    slopes[0] = end(x[1] - x[0], x[2] - x[1], chord(x, &y, 0), chord(x, &y, 1));
    slopes[last] =
        end(x[last] - x[last - 1], x[last - 1] - x[last - 2], chord(x, &y, last - 1), chord(x, &y, last - 2));
    slopes
}

/// The slope at an end, of a parabola through three points as far as the curve then has no extremum of its own.
fn end(near: f64, far: f64, chord: f64, next: f64) -> f64 {
    let slope = ((2.0 * near + far) * chord - near * next) / (near + far);
    if slope * chord <= 0.0 {
        0.0
    } else if chord * next < 0.0 && slope.abs() > 3.0 * chord.abs() {
        3.0 * chord
    } else {
        slope
    }
}
