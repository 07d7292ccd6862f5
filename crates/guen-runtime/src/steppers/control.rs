//! Step control for DOP853: how large an error is, and which step comes next.
//!
//! Everything is computed in `f64`, whatever the real of the state: a step size needs few digits, and so the
//! step stays a constant when the state is a dual, whose tangents must not be led through the control.
//!
//! Source: the program `dop853.f` named in the coefficients' module, with its default settings and without the
//! stabilised control (`beta = 0`).

use crate::real::Real;

/// The factor on the step that is predicted to meet the tolerance just so.
const SAFETY: f64 = 0.9;
/// A step is never shortened below this part of the one before.
const SHORTEN: f64 = 0.333;
/// A step never grows beyond this multiple of the one before.
const GROW: f64 = 6.0;

/// `x^(1/8)`: the error of a step falls as the eighth power of the step. Three roots are faster than a power.
fn eighth_root(x: f64) -> f64 {
    libm::sqrt(libm::sqrt(libm::sqrt(x)))
}

/// The tolerances: an error `e` in an entry `x` counts as `e / (absolute + relative |x|)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    pub relative: f64,
    pub absolute: f64,
}

impl Tolerance {
    pub fn is_valid(self) -> bool {
        self.relative >= 0.0 && self.relative.is_finite() && self.absolute > 0.0 && self.absolute.is_finite()
    }

    /// The sum of the squares of the entries of `error`, each measured by the tolerance at the larger of the
    /// entries of `x` and `y`.
    fn squares<R: Real, const N: usize>(self, error: &[R; N], x: &[R; N], y: &[R; N]) -> f64 {
        let mut sum = 0.0;
        for i in 0..N {
            let size = x[i].to_f64().abs().max(y[i].to_f64().abs());
            let part = error[i].to_f64() / (self.absolute + self.relative * size);
            sum += part * part;
        }
        sum
    }

    /// The error of a step of size `h` in units of the tolerance; a step is good up to one.
    ///
    /// ```text
    /// err = |h| s5 / sqrt(N (s5 + s3 / 100))
    /// ```
    ///
    /// with `s5`, `s3` the sums of squares of the two estimates, as slopes. Since `s5` falls as `h^10` and `s3` as
    /// `h^6`, this falls as `h^8`.
    pub fn error<R: Real, const N: usize>(
        self,
        h: f64,
        error5: &[R; N],
        error3: &[R; N],
        x: &[R; N],
        y: &[R; N],
    ) -> f64 {
        let five = self.squares(error5, x, y);
        let three = self.squares(error3, x, y);
        let denominator = five + 0.01 * three;
        if denominator == 0.0 {
            return 0.0;
        }
        h.abs() * five / libm::sqrt(N as f64 * denominator)
    }

    /// Two quantities for the first step: a guess that moves the state by about a hundredth of its size, and the
    /// size of the slope.
    pub fn first_guess<R: Real, const N: usize>(
        self,
        x: &[R; N],
        slope: &[R; N],
        longest: f64,
    ) -> (f64, f64) {
        /// Below this, a sum of squares says nothing about the size of state or slope.
        const NEGLIGIBLE: f64 = 1e-10;
        /// The guess then.
        const TINY: f64 = 1e-6;

        let slope_squares = self.squares(slope, x, x);
        let state_squares = self.squares(x, x, x);
        let guess = if slope_squares <= NEGLIGIBLE || state_squares <= NEGLIGIBLE {
            TINY
        } else {
            0.01 * libm::sqrt(state_squares / slope_squares)
        };
        (guess.min(longest), libm::sqrt(slope_squares))
    }

    /// The first step, from the guess `h`, the size of the slope and its change over the guess:
    /// `step^8 max(|x'|, |x''|) = 1/100`, at most a hundred times the guess.
    pub fn first_step<R: Real, const N: usize>(
        self,
        h: f64,
        slope_size: f64,
        change: &[R; N],
        x: &[R; N],
        longest: f64,
    ) -> f64 {
        /// Below this, neither slope nor curvature limits the step.
        const STILL: f64 = 1e-15;

        let curvature = libm::sqrt(self.squares(change, x, x)) / h;
        let size = curvature.max(slope_size);
        let step = if size <= STILL { f64::max(1e-6, 1e-3 * h) } else { eighth_root(0.01 / size) };
        // An infinite curvature would give a zero step: the trial steps will find out how short is short enough.
        let step = if step > 0.0 { step } else { h };
        step.min(100.0 * h).min(longest)
    }
}

/// The factor to the next step after an accepted step with this error.
pub(super) fn factor_after_success(error: f64) -> f64 {
    if error == 0.0 { GROW } else { (SAFETY / eighth_root(error)).clamp(SHORTEN, GROW) }
}

/// The factor to the repeated step after a rejected step with this error, which may be infinite.
pub(super) fn factor_after_failure(error: f64) -> f64 {
    f64::max(SHORTEN, SAFETY / eighth_root(error))
}

/// The factor to the repeated step after one that was not finite, about whose error nothing is known.
pub(super) const FACTOR_OUT_OF_DOMAIN: f64 = SHORTEN;
