//! Zeros of a function of one number, within a bracket.

/// The bracket of a zero: the function is positive at `before` and not at `after`, which may lie on either side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bracket {
    /// The last place found at which the function is positive.
    pub(crate) before: f64,
    /// The first place found at which it is not.
    pub(crate) after: f64,
}

/// Narrows a bracket until it is no longer than two spacings of numbers, or than `resolution`. `values` are those of the function
/// at its ends: positive, and not positive.
///
/// Regula falsi with the value at an end that stays halved (the Illinois rule; M. Dowell and P. Jarratt, BIT 11 (1971) 168-174),
/// and a bisection whenever three steps have not halved the bracket.
pub(crate) fn narrow(
    Bracket { mut before, mut after }: Bracket,
    (mut high, mut low): (f64, f64),
    resolution: f64,
    value: &mut dyn FnMut(f64) -> f64,
) -> Bracket {
    /// Enough to halve a bracket from one end of the exponents to the other.
    const MAX_ITERATIONS: u32 = 10_000;
    const ITERATIONS_TO_HALVE: u32 = 3;

    let (mut width, mut since, mut last) = ((after - before).abs(), 0, None);
    for _ in 0..MAX_ITERATIONS {
        let present = (after - before).abs();
        let spacing = f64::EPSILON * f64::max(before.abs(), after.abs());
        if present <= f64::max(resolution, spacing) {
            break;
        }
        let stuck = since >= ITERATIONS_TO_HALVE;
        if stuck || present <= width / 2.0 {
            (width, since) = (present, 0);
        }
        since += 1;
        let part = if stuck { 0.5 } else { high / (high - low) };
        let margin = (0.5 * f64::max(resolution, spacing) / present).min(0.5);
        let part = if part.is_nan() { 0.5 } else { part.clamp(margin, 1.0 - margin) };
        let middle = before + (after - before) * part;
        if middle == before || middle == after {
            break;
        }
        let found = value(middle);
        let positive = found > 0.0;
        if positive {
            (before, high) = (middle, found);
        } else {
            (after, low) = (middle, found);
        }
        if last == Some(positive) {
            if positive {
                low /= 2.0;
            } else {
                high /= 2.0;
            }
        }
        last = Some(positive);
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
        let found = narrow(Bracket { before: 0.0, after: 10.0 }, (2.0, -98.0), 0.0, &mut f);
        assert!(found.after - found.before <= 4e-16 && (found.after - libm::sqrt(2.0)).abs() < 4e-16);
        assert!(calls < 30, "{calls}");
        // Backwards, and where the function is so flat that its slope tells nothing.
        let found = narrow(Bracket { before: 1.0, after: -1.0 }, (1.0, -1.0), 1e-12, &mut |t| t * t * t);
        assert!(found.before > 0.0 && found.after <= 0.0 && found.before - found.after <= 1e-12);
    }
}
