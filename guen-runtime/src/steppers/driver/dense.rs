//! Dense output: the motion between the ends of a step, as a polynomial.

use crate::numbers::real::Real;
use crate::steppers::entries;

/// The motion over one step of a method, to be asked for any time within it.
///
/// ```
/// use guen_runtime::steppers::{Dense, Interpolant};
///
/// fn middle(motion: impl Interpolant<f64, 1>) -> f64 {
///     motion.at(0.5)[0]
/// }
/// assert_eq!(middle(Dense::hermite(0.0, 1.0, &[0.0], &[0.0], &[1.0], &[2.0])), 0.25);
/// ```
pub trait Interpolant<R, const N: usize>: Copy {
    /// The state at time `t`.
    fn at(&self, t: R) -> [R; N];
}

impl<R: Real, const N: usize> Interpolant<R, N> for Dense<R, N> {
    fn at(&self, t: R) -> [R; N] {
        Dense::at(self, t)
    }
}

/// The largest number of terms: a polynomial of degree seven.
const TERMS: usize = 8;

/// The motion over one step as a polynomial in `s = (t - t0) / h`.
///
/// ```text
/// x(t0 + s h) = r0 + s (r1 + (1 - s) (r2 + s (r3 + (1 - s) (r4 + s (r5 + (1 - s) (r6 + s r7))))))
/// ```
///
/// - `r0` is the state at the beginning and `r0 + r1` that at the end; `r2`, `r3` make the slopes at both ends right;
///   what follows is the method's own and vanishes at both ends together with its slope.
/// - Beyond the step it extrapolates, which is rarely wanted.
/// - About `3 * 8 N` operations for each time; no allocation.
///
/// The form is that of E. Hairer and G. Wanner's program `dop853.f`; every interpolant of degree up to seven fits it.
///
/// ```
/// use guen_runtime::steppers::Dense;
///
/// // t^3 between 1 and 2, from values and slopes
/// let cube = Dense::hermite(1.0, 1.0, &[1.0], &[3.0], &[8.0], &[12.0]);
/// assert_eq!(cube.at(1.5), [3.375]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dense<R, const N: usize> {
    start: R,
    step: R,
    terms: [[R; N]; TERMS],
    used: usize,
}

impl<R: Real, const N: usize> Dense<R, N> {
    /// The cubic through two states with the given slopes, `step` apart in time: `O(h^4)`.
    pub fn hermite(start: R, step: R, x0: &[R; N], slope0: &[R; N], x1: &[R; N], slope1: &[R; N]) -> Self {
        let mut terms = [[R::zero(); N]; TERMS];
        for i in 0..N {
            let change = x1[i] - x0[i];
            let bend = step * slope0[i] - change;
            terms[0][i] = x0[i];
            terms[1][i] = change;
            terms[2][i] = bend;
            terms[3][i] = change - step * slope1[i] - bend;
        }
        Self { start, step, terms, used: 4 }
    }

    /// Adds two terms to the cubic, so that the second derivatives are the given ones, too: a polynomial of degree
    /// five, `O(h^6)`.
    #[must_use]
    pub fn with_curvatures(mut self, curvature0: &[R; N], curvature1: &[R; N]) -> Self {
        let (two, four) = (R::from_ratio(2, 1), R::from_ratio(4, 1));
        let half = R::from_ratio(1, 2);
        let square = self.step * self.step;
        for i in 0..N {
            let (bend, skew) = (self.terms[2][i], self.terms[3][i]);
            // The cubic's own second derivatives are 2 (r3 - r2) and -2 r2 - 4 r3.
            let at_start = half * (square * curvature0[i] + two * (bend - skew));
            let at_end = half * (square * curvature1[i] + two * bend + four * skew);
            self.terms[4][i] = at_start;
            self.terms[5][i] = at_end - at_start;
        }
        self.used = 6;
        self
    }

    /// Adds further terms `r4 ..`, at most four, which `term` returns in their order.
    pub(in crate::steppers) fn add_terms<const M: usize>(&mut self, mut term: impl FnMut(usize) -> [R; N]) {
        const { assert!(M <= TERMS - 4, "a polynomial of degree seven at most") }
        for j in 0..M {
            self.terms[4 + j] = term(j);
        }
        self.used = 4 + M;
    }

    /// The polynomial with the terms `r0 .. r3` given directly.
    pub(in crate::steppers) fn cubic(start: R, step: R, given: [[R; N]; 4]) -> Self {
        let mut terms = [[R::zero(); N]; TERMS];
        terms[..4].copy_from_slice(&given);
        Self { start, step, terms, used: 4 }
    }

    /// The state at time `t`. At the beginning of the step it is the state there; at the end up to a rounding.
    pub fn at(&self, t: R) -> [R; N] {
        let s = (t - self.start) / self.step;
        let rest = R::one() - s;
        let mut terms = self.terms.iter().enumerate().take(self.used).rev();
        let mut x = terms.next().map_or([R::zero(); N], |(_, highest)| *highest);
        for (k, term) in terms {
            let factor = if k % 2 == 0 { s } else { rest };
            x = entries(|i| term[i] + factor * x[i]);
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::Dense;

    #[test]
    fn a_quintic_is_its_own_interpolant() {
        let p = |t: f64| [t.powi(5) - 2.0 * t.powi(3), 3.0 - t * t];
        let d = |t: f64| [5.0 * t.powi(4) - 6.0 * t * t, -2.0 * t];
        let dd = |t: f64| [20.0 * t.powi(3) - 12.0 * t, -2.0];
        for (t0, t1) in [(0.5, 2.0), (2.0, 0.5), (-1.0, 0.25)] {
            let dense =
                Dense::hermite(t0, t1 - t0, &p(t0), &d(t0), &p(t1), &d(t1)).with_curvatures(&dd(t0), &dd(t1));
            for k in 0..=8 {
                let t = t0 + (t1 - t0) * f64::from(k) / 8.0;
                for (found, expected) in dense.at(t).into_iter().zip(p(t)) {
                    assert!((found - expected).abs() < 1e-13, "{t}: {found} instead of {expected}");
                }
            }
        }
    }
}
