//! Step control: how large an error is, and which step comes next.
//!
//! Everything is computed in `f64`, whatever the real of the state: a step size needs few digits, and so the
//! step stays a constant when the state is a dual, whose tangents must not be led through the control.
//!
//! Source: the program `dop853.f` named in the coefficients' module, with its default settings and without the
//! stabilised control (`beta = 0`); the other methods differ in the constants that they give.

use crate::error::{Cause, Setting};
use crate::real::Real;

/// How a method's step follows its error.
#[derive(Clone, Copy, Debug)]
pub struct Control {
    /// The error of a step falls as this power of the step.
    pub power: u32,
    /// The factor on the step that is predicted to meet the tolerance just so.
    pub safety: f64,
    /// A step is never shortened below this part of the one before.
    pub shorten: f64,
    /// A step never grows beyond this multiple of the one before.
    pub grow: f64,
}

impl Control {
    /// The factor on the step that is predicted to meet the tolerance, for a step with an error of `margin^(-1/2)`.
    #[inline]
    fn factor(&self, margin: f64) -> f64 {
        self.safety * rough_root(margin, 2 * self.power)
    }

    /// The factor to the next step after an accepted step.
    #[inline]
    pub fn factor_after_success(&self, margin: f64) -> f64 {
        self.factor(margin).clamp(self.shorten, self.grow)
    }

    /// The factor to the repeated step after a rejected step.
    pub fn factor_after_failure(&self, margin: f64) -> f64 {
        f64::max(self.shorten, self.factor(margin))
    }

    /// The factor to the repeated step after one that was not finite, about whose error nothing is known.
    pub fn factor_out_of_domain(&self) -> f64 {
        self.shorten
    }

    /// The first step, from the guess `h`, the size of the slope and its change over the guess:
    /// `step^power max(|x'|, |x''|) = 1/100`, at most a hundred times the guess.
    pub fn first_step(&self, h: f64, slope_size: f64, change_size: f64, longest: f64) -> f64 {
        /// Below this, neither slope nor curvature limits the step.
        const STILL: f64 = 1e-15;

        let size = (change_size / h).max(slope_size);
        let step = if size <= STILL { f64::max(1e-6, 1e-3 * h) } else { rough_root(0.01 / size, self.power) };
        // An infinite curvature would give a zero step: the trial steps will find out how short is short enough.
        let step = if step > 0.0 { step } else { h };
        step.min(100.0 * h).min(longest)
    }
}

/// `x^(1/power)` of a positive number to almost four digits, as `2^(log2(x)/power)`: enough for a step, and without a
/// division or a root, which the next step would wait for.
///
/// ```text
/// log2(1 + m) = m + m (1 - m) (L_0 + L_1 m + L_2 m^2)     0 <= m < 1          off by at most 1.2e-4
/// 2^f = 1 + f (E_0 + E_1 f + E_2 f^2)                     -1/2 <= f <= 1/2    off by at most 1.1e-4, relative
/// ```
///
/// Both are minimax with their ends held, by Lawson's weights on 401 points.
#[inline]
fn rough_root(x: f64, power: u32) -> f64 {
    const ONE: u64 = 1.0_f64.to_bits();
    const FRACTION: u64 = (1 << 52) - 1;
    const L: [f64; 3] = [0.438726, -0.239058, 0.0821306];
    const E: [f64; 3] = [0.693283, 0.242211, 0.0550089];
    /// `2^52 + 2^51`: added to a number, it rounds that to an integer, whose low bits are then those of the sum.
    const ROUND: f64 = 6_755_399_441_055_744.0;

    if !(x > 0.0 && x < f64::INFINITY) {
        return x;
    }
    let bits = x.to_bits();
    let m = f64::from_bits(bits & FRACTION | ONE) - 1.0;
    // The exponent and `m`, which the bits are with a point after the twelfth.
    let linear = (bits as i64 - ONE as i64) as f64 * f64::EPSILON;
    let log = linear + (m * (1.0 - m)) * ((L[0] + L[1] * m) + L[2] * (m * m));
    let log = log * (1.0 / f64::from(power));
    let shifted = log + ROUND;
    let f = log - (shifted - ROUND);
    let mantissa = 1.0 + f * ((E[0] + E[1] * f) + E[2] * (f * f));
    f64::from_bits(mantissa.to_bits().wrapping_add(shifted.to_bits() << 52))
}

/// A rest of less than this part of a step is not left for a step of its own.
pub(super) const STRETCH: f64 = 1.01;

/// The shortest step at this time: it must span so many spacings of numbers.
pub(super) fn shortest<R: Real>(time: R) -> f64 {
    const SPACINGS: f64 = 10.0;
    SPACINGS * time.to_f64().abs() * R::epsilon().to_f64()
}

/// The tolerances: an error `e` in an entry `x` counts as `e / (absolute + relative |x|)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    pub relative: f64,
    pub absolute: f64,
}

impl Tolerance {
    pub fn check(self) -> Result<(), Cause> {
        let valid = self.relative >= 0.0
            && self.relative.is_finite()
            && self.absolute > 0.0
            && self.absolute.is_finite();
        if valid { Ok(()) } else { Err(Cause::Setting(Setting::Tolerance)) }
    }

    /// What an error in each entry is multiplied by, the larger of the entries of `x` and `y` counting.
    #[inline]
    pub fn weights<R: Real, const N: usize>(self, x: &[R; N], y: &[R; N]) -> [f64; N] {
        core::array::from_fn(|i| {
            let (a, b) = (x[i].to_f64().abs(), y[i].to_f64().abs());
            1.0 / (self.absolute + self.relative * if a > b { a } else { b })
        })
    }

    /// A guess for the first step that moves the state by about a hundredth of its size, and the size of the slope.
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

        let weights = self.weights(x, x);
        let slope_squares = squares(slope, &weights);
        let state_squares = squares(x, &weights);
        let guess = if slope_squares <= NEGLIGIBLE || state_squares <= NEGLIGIBLE {
            TINY
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
pub(super) fn squares<R: Real, const N: usize>(values: &[R; N], weights: &[f64; N]) -> f64 {
    let parts: [f64; N] = core::array::from_fn(|i| {
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
pub(super) fn size<R: Real, const N: usize>(values: &[R; N], weights: &[f64; N]) -> f64 {
    let sum = squares(values, weights);
    if sum.is_finite() {
        return libm::sqrt(sum);
    }
    values
        .iter()
        .zip(weights)
        .fold(0.0, |most, (value, weight)| f64::max(most, value.to_f64().abs() * weight))
}

/// How far a step is from being rejected, for the mean of the squares of its weighted error: the reciprocal of that
/// mean. One at the limit, infinite without any error.
#[inline]
pub(super) fn margin<const N: usize>(squares: f64) -> f64 {
    N as f64 / squares
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
