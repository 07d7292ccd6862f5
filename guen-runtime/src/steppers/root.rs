//! Zeros of a function of time, within a bracket.

use crate::numbers::real::Real;

/// The bracket of a zero: the function is positive at `before` and not at `after`, which may lie on either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bracket<R> {
    /// The last place found at which the function is positive.
    pub(crate) before: R,
    /// The first place found at which it is not.
    pub(crate) after: R,
}

/// Narrows a bracket until it is no longer than the `resolution` at its ends. `values` are those of the function there: positive, and
/// not positive. Where the function is NaN nothing has been crossed.
///
/// Regula falsi with the value at an end that stays halved (the Illinois rule; M. Dowell and P. Jarratt, BIT 11
/// (1971) 168-174), and a bisection whenever three steps have not halved the bracket, so that at most four evaluations
/// gain a bit.
pub(crate) fn narrow<R: Real>(
    Bracket { mut before, mut after }: Bracket<R>,
    (mut high, mut low): (f64, f64),
    resolution: &dyn Fn(R) -> f64,
    value: &mut dyn FnMut(R) -> f64,
) -> Bracket<R> {
    /// Enough to halve a bracket from one end of the exponents to the other.
    const MAX_ITERATIONS: u32 = 10_000;
    const ITERATIONS_TO_HALVE: u32 = 3;

    let mut width = (after - before).to_f64().abs();
    let (mut since, mut last) = (0, None);
    for _ in 0..MAX_ITERATIONS {
        let present = (after - before).to_f64().abs();
        let resolution = resolution(before).max(resolution(after));
        if present <= resolution {
            break;
        }
        if present <= width / 2.0 {
            (width, since) = (present, 0);
        }
        let mut part = high / (high - low);
        if since >= ITERATIONS_TO_HALVE {
            part = 0.5;
            (width, since) = (present, 0);
        }
        // A probe nearer to an end than the resolution could not close the bracket from the other side.
        let margin = (0.5 * resolution / present).min(0.5);
        part = if part.is_nan() { 0.5 } else { part.max(margin).min(1.0 - margin) };
        since += 1;
        let middle = before + (after - before) * R::from_f64(part);
        if middle == before || middle == after {
            break;
        }
        let found = value(middle);
        let is_before = found > 0.0 || found.is_nan();
        if is_before {
            (before, high) = (middle, found);
            if last == Some(is_before) {
                low /= 2.0;
            }
        } else {
            (after, low) = (middle, found);
            if last == Some(is_before) {
                high /= 2.0;
            }
        }
        last = Some(is_before);
    }
    Bracket { before, after }
}

#[cfg(test)]
mod tests {
    use super::{Bracket, narrow};

    #[test]
    fn zeros_are_found_to_the_last_digit() {
        let mut calls = 0;
        let mut f = |t: f64| {
            calls += 1;
            2.0 - t * t
        };
        let found = narrow(
            Bracket { before: 0.0, after: 10.0 },
            (2.0, -98.0),
            &|t: f64| f64::EPSILON * t.abs(),
            &mut f,
        );
        assert!(found.after - found.before <= 4e-16 && (found.after - libm::sqrt(2.0)).abs() < 4e-16);
        assert!(calls < 30, "{calls}");
        // Backwards, and where the function is so flat that its slope tells nothing.
        let found = narrow(Bracket { before: 1.0, after: -1.0 }, (1.0, -1.0), &|_| 1e-12, &mut |t| t * t * t);
        assert!(found.before > 0.0 && found.after <= 0.0 && found.before - found.after <= 1e-12);
    }
}
