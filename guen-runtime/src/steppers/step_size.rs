//! Step control: how large an error is, and which step comes next.
//!
//! Everything is computed in `f64`, whatever the real of the state: a step size needs few digits, and so the
//! step stays a constant when the state is a dual, whose tangents must not be led through the control.
//!
//! Source: the program `dop853.f` named in the coefficients' module, with its default settings and without the
//! stabilised control (`beta = 0`), from which two things differ. The explicit methods predict the error of the next step from
//! that of two steps, and aim at a smaller part of the tolerance: `docs/design/step-control.md` has what that is worth. The other
//! methods differ in the constants that they give.

use crate::numbers::real::Real;
use crate::steppers::driver::error::{Cause, Setting};
use crate::steppers::entries;

/// The law by which a method's step follows its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Control {
    /// The error of a step falls as this power of the step.
    pub power: u32,
    /// The factor on the step that is predicted to meet the tolerance just so.
    pub safety: f64,
    /// A step is never shortened below this part of the one before.
    pub shorten: f64,
    /// A step never grows beyond this multiple of the one before.
    pub grow: f64,
    /// Whether a growing error is expected to go on to grow: see [`Control::factor_after_success`].
    pub predict: bool,
}

impl Control {
    /// The factor on the step that is predicted to meet the tolerance, for a step with an error of `2^(-margin/2)`.
    #[inline]
    fn factor(&self, margin: f64) -> f64 {
        self.safety * rough_exp2(margin * (0.5 / f64::from(self.power)))
    }

    /// The factor to the next step after an accepted step, with the [`trend`](Control::trend) that it is part of: the
    /// smaller of two predictions, that the error stays what it is for steps of the same size, and that it goes on to grow as
    /// it did from the step before.
    ///
    /// ```text
    /// safety min(err_n^(-1/p), (h_n / h_(n-1)) (err_(n-1) / err_n^2)^(1/p))
    /// ```
    ///
    /// Source: K. Gustafsson, *Control-theoretic techniques for stepsize selection in implicit Runge-Kutta methods*, ACM
    /// Transactions on Mathematical Software 20 (1994) 496-517, whose prediction it is; the smaller of both is taken by the
    /// program `radau5.f` of E. Hairer and G. Wanner.
    #[inline]
    pub(crate) fn factor_after_success(&self, margin: f64, trend: f64) -> f64 {
        self.factor(margin + (margin + trend).min(0.0)).clamp(self.shorten, self.grow)
    }

    /// Returns the term that predicts the next error: added to the margin of a step of this size it gives the change
    /// since the step before, of which the [`level`](Control::level) is given, had that been of the same size. Zero
    /// if there was none: no change for the worse.
    #[inline]
    pub(crate) fn trend(&self, before: Option<f64>, size: f64) -> f64 {
        match before {
            Some(level) if self.predict => self.scale(size) - level,
            _ => 0.0,
        }
    }

    /// The margin that a step of size one would have had in the place of one of this size and with this margin.
    #[inline]
    pub(crate) fn level(&self, margin: f64, size: f64) -> f64 {
        /// The margin of an error of `1e-4`: a smaller error says nothing about the next.
        const LARGEST_MARGIN: f64 = 26.6;
        margin.min(LARGEST_MARGIN) + self.scale(size)
    }

    #[inline]
    fn scale(&self, size: f64) -> f64 {
        f64::from(2 * self.power) * rough_log2(size)
    }

    /// The factor to the repeated step after a rejected step.
    pub(crate) fn factor_after_failure(&self, margin: f64) -> f64 {
        f64::max(self.shorten, self.factor(margin))
    }

    /// The factor to the repeated step after one that was not finite, about whose error nothing is known.
    pub(crate) fn factor_out_of_domain(&self) -> f64 {
        self.shorten
    }

    /// The first step, from the guess `h`, the size of the slope and its change over the guess:
    /// `step^power max(|x'|, |x''|) = 1/100`, at most a hundred times the guess.
    pub(crate) fn first_step(&self, h: f64, slope_size: f64, change_size: f64, longest: f64) -> f64 {
        /// The size of slope and curvature below which neither limits the step.
        const NEGLIGIBLE_SLOPE: f64 = 1e-15;

        let size = (change_size / h).max(slope_size);
        let step = if size <= NEGLIGIBLE_SLOPE {
            f64::max(1e-6, 1e-3 * h)
        } else {
            rough_root(0.01 / size, self.power)
        };
        // An infinite curvature would give a zero step: the trial steps will find out how short is short enough.
        let step = if step > 0.0 { step } else { h };
        step.min(100.0 * h).min(longest)
    }
}

/// The error of a step in units of the tolerance, as the ratio of two numbers: `err^2 = found / allowed`. Nothing is
/// divided, and no root taken, while the next step waits for it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Margin {
    pub allowed: f64,
    pub found: f64,
}

impl Margin {
    /// Creates the error from the sum of the squares of `N` weighted errors, of which it takes the mean.
    #[inline]
    pub(crate) fn of_mean<const N: usize>(squares: f64) -> Self {
        Self { allowed: N as f64, found: squares }
    }

    #[inline]
    pub(crate) fn is_finite(self) -> bool {
        self.found < f64::INFINITY && self.allowed < f64::INFINITY
    }

    /// Whether the error is within the tolerance.
    #[inline]
    pub(crate) fn is_enough(self) -> bool {
        self.found <= self.allowed
    }

    /// `-2 log2(err)` to almost four digits after the point; large without any error.
    #[inline]
    pub(crate) fn log2(self) -> f64 {
        rough_log2(self.allowed) - rough_log2(self.found)
    }
}

/// `x^(1/power)` of a positive number to almost four digits, as `2^(log2(x)/power)`.
#[inline]
fn rough_root(x: f64, power: u32) -> f64 {
    if !(x > 0.0 && x < f64::INFINITY) {
        return x;
    }
    rough_exp2(rough_log2(x) * (1.0 / f64::from(power)))
}

/// The logarithm to the base two of a positive finite number: enough for a step, and without a division, which the next
/// step would wait for. Of zero it is -1023.
///
/// ```text
/// log2(1 + m) = m + m (1 - m) (L_0 + L_1 m + L_2 m^2)     0 <= m < 1          off by at most 1.2e-4
/// ```
///
/// Minimax with the ends held, by Lawson's weights on 401 points, as that of [`rough_exp2`].
#[inline]
fn rough_log2(x: f64) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    const FRACTION: u64 = (1 << 52) - 1;
    const L: [f64; 3] = [0.438726, -0.239058, 0.0821306];

    let bits = x.to_bits();
    let m = f64::from_bits(bits & FRACTION | ONE) - 1.0;
    // The exponent and `m`, which the bits are with a point after the twelfth.
    let linear = (bits as i64 - ONE as i64) as f64 * f64::EPSILON;
    linear + (m * (1.0 - m)) * ((L[0] + L[1] * m) + L[2] * (m * m))
}

/// `2^x` for `abs(x) <= 1000`.
///
/// ```text
/// 2^f = 1 + f (E_0 + E_1 f + E_2 f^2)                     -1/2 <= f <= 1/2    off by at most 1.1e-4, relative
/// ```
#[inline]
fn rough_exp2(x: f64) -> f64 {
    const E: [f64; 3] = [0.693283, 0.242211, 0.0550089];
    /// `2^52 + 2^51`: added to a number, it rounds that to an integer, whose low bits are then those of the sum.
    const ROUND: f64 = 6_755_399_441_055_744.0;

    let shifted = x + ROUND;
    let f = x - (shifted - ROUND);
    let mantissa = 1.0 + f * ((E[0] + E[1] * f) + E[2] * (f * f));
    f64::from_bits(mantissa.to_bits().wrapping_add(shifted.to_bits() << 52))
}

/// The factor by which the last step may be longer than the others, so that no small rest needs a step of its own.
pub(in crate::steppers) const STRETCH: f64 = 1.01;

/// The shortest step of a run that began at `origin`: it moves the time, and is so many roundings of the time since then.
#[inline]
pub(in crate::steppers) fn shortest<R: Real>(time: R, origin: R) -> f64 {
    const STEP_ROUNDINGS: f64 = 10.0;
    let elapsed = STEP_ROUNDINGS * (time - origin).to_f64().abs();
    // A rounding of the time itself is a spacing of numbers there, or two.
    let clock = time.to_f64().abs();
    R::epsilon().to_f64() * if elapsed > clock { elapsed } else { clock }
}

/// Whether two steps are the same to this part: so nearly that what was factored for one of them serves the other. Times are
/// rounded, and with them what is between them.
#[inline]
pub(in crate::steppers) fn nearly_the_same<R: Real>(step: R, other: R, part: f64) -> bool {
    (step - other).to_f64().abs() <= part * other.to_f64().abs()
}

/// The tolerances: an error `e` in an entry `x` counts as `e / (absolute + relative |x|)`.
#[derive(Clone, Copy, Debug)]
pub(in crate::steppers) struct Tolerance {
    pub relative: f64,
    pub absolute: f64,
}

impl Tolerance {
    pub(super) fn check(self) -> Result<(), Cause> {
        let valid = self.relative >= 0.0
            && self.relative.is_finite()
            && self.absolute > 0.0
            && self.absolute.is_finite();
        if valid { Ok(()) } else { Err(Cause::Setting(Setting::Tolerance)) }
    }

    /// Returns the weight of the error in each entry, by the larger of the entries of `x` and `y`.
    #[inline]
    pub(super) fn weights<R: Real, const N: usize>(self, x: &[R; N], y: &[R; N]) -> [f64; N] {
        entries(|i| {
            let (a, b) = (x[i].to_f64().abs(), y[i].to_f64().abs());
            1.0 / (self.absolute + self.relative * if a > b { a } else { b })
        })
    }

    /// A guess for the first step that moves the state by about a hundredth of its size, and the size of the slope.
    pub(super) fn first_guess<R: Real, const N: usize>(
        self,
        x: &[R; N],
        slope: &[R; N],
        longest: f64,
    ) -> (f64, f64) {
        /// The sum of squares below which nothing is known of the size of state or slope.
        const NEGLIGIBLE_SQUARES: f64 = 1e-10;
        /// The guess where the sums are smaller.
        const LEAST_GUESS: f64 = 1e-6;

        let weights = self.weights(x, x);
        let slope_squares = squares(slope, &weights);
        let state_squares = squares(x, &weights);
        let guess = if slope_squares <= NEGLIGIBLE_SQUARES || state_squares <= NEGLIGIBLE_SQUARES {
            LEAST_GUESS
        } else if slope_squares.is_finite() && state_squares.is_finite() {
            0.01 * libm::sqrt(state_squares / slope_squares)
        } else {
            0.01 * (size(x, &weights) / size(slope, &weights))
        };
        (guess.min(longest), size(slope, &weights))
    }
}

/// The sum of the squares of the weighted entries, in four parts that do not wait for each other.
#[inline]
pub(in crate::steppers) fn squares<R: Real, const N: usize>(values: &[R; N], weights: &[f64; N]) -> f64 {
    let parts: [f64; N] = entries(|i| {
        let part = values[i].to_f64() * weights[i];
        part * part
    });
    let mut sums = [0.0; 4];
    for (i, part) in parts.into_iter().enumerate() {
        sums[i % 4] += part;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// The root of the sum of squares; where that is beyond the range of doubles the largest entry.
pub(in crate::steppers) fn size<R: Real, const N: usize>(values: &[R; N], weights: &[f64; N]) -> f64 {
    let sum = squares(values, weights);
    if sum.is_finite() {
        return libm::sqrt(sum);
    }
    values
        .iter()
        .zip(weights)
        .fold(0.0, |most, (value, weight)| f64::max(most, value.to_f64().abs() * weight))
}

#[cfg(test)]
mod tests {
    use super::rough_root;

    #[test]
    fn rough_roots_have_four_digits() {
        for power in [3, 4, 5, 6, 8, 16] {
            for k in -200..200 {
                let x = libm::exp2(f64::from(k) * 1.7 + 0.3);
                let error = rough_root(x, power) / libm::pow(x, 1.0 / f64::from(power)) - 1.0;
                assert!(error.abs() < 3e-4, "{power} {x:e}: {error:e}");
            }
        }
        assert_eq!(rough_root(1.0, 5), 1.0);
        assert_eq!(rough_root(0.0, 5), 0.0);
        assert_eq!(rough_root(f64::INFINITY, 5), f64::INFINITY);
    }
}
