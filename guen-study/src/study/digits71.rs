//! The long real that references are computed in.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use f256::f256;
use guen_runtime::{Lift, Real};

/// A real of 237 bits, 71 decimal digits: the arithmetic and the functions of the crate `f256`, and those made of them
/// that it has not.
///
/// - Errors: below 1e-69 of the result, for every operation and function; measured against values of another program
///   (`tests/digits71.rs`), from which the bound of that test comes.
/// - Cost: some 40 ns for an operation and 6 us for sine and cosine, hundreds of times those of `f64`: for references, not
///   for work.
/// - It does not contain `f64` in the sense of [`Lift`]: prepare a system in it, as [`WithScalar`](guen_runtime::WithScalar)
///   does.
///
/// ```
/// use guen_runtime::Real;
/// use guen_study::Digits71;
///
/// let tenth = Digits71::from_ratio(1, 10);
/// // The double nearest to a tenth is another number.
/// let off = (Digits71::from_f64(0.1) - tenth).to_f64();
/// assert!((off - 5.551115123125783e-18).abs() < 1e-30);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Digits71(f256);

impl Default for Digits71 {
    fn default() -> Self {
        Self(f256::ZERO)
    }
}

macro_rules! operators {
    ($($trait:ident, $method:ident, $assign:ident, $assigned:ident;)*) => {
        $(impl $trait for Digits71 {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
        impl $assign for Digits71 {
            fn $assigned(&mut self, other: Self) {
                self.0 = self.0.$method(other.0);
            }
        })*
    };
}

operators! {
    Add, add, AddAssign, add_assign;
    Sub, sub, SubAssign, sub_assign;
    Mul, mul, MulAssign, mul_assign;
    Div, div, DivAssign, div_assign;
}

impl Neg for Digits71 {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Lift<Digits71> for Digits71 {
    fn lift(base: Self) -> Self {
        base
    }
}

impl Digits71 {
    fn half_of(value: f256) -> Self {
        Self(value / f256::from(2))
    }
}

impl Real for Digits71 {
    fn from_ratio(num: i64, den: i64) -> Self {
        Self(f256::from(num) / f256::from(den))
    }

    fn from_f64(value: f64) -> Self {
        Self(f256::from(value))
    }

    /// The nearest double, ties to even; subnormal results are rounded twice.
    fn to_f64(self) -> f64 {
        if !self.0.is_finite() {
            return if self.0.is_nan() {
                f64::NAN
            } else if self.0.is_sign_negative() {
                f64::NEG_INFINITY
            } else {
                f64::INFINITY
            };
        }
        let (sign, exponent, (high, low)) = self.0.as_sign_exp_signif();
        let (top, exponent) = leading(high, low, exponent);
        let size = times_power_of_two(top as f64, exponent);
        if sign == 0 { size } else { -size }
    }

    fn pi() -> Self {
        Self(::f256::consts::PI)
    }

    fn epsilon() -> Self {
        Self(f256::EPSILON)
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Self(sin), Self(cos))
    }

    fn asin(self) -> Self {
        Self(self.0.asin())
    }

    fn acos(self) -> Self {
        Self(self.0.acos())
    }

    fn atan(self) -> Self {
        Self(self.0.atan())
    }

    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(&x.0))
    }

    // With `e = exp(x) - 1`, so that small arguments keep their digits.
    fn sinh(self) -> Self {
        if self.0.abs() > f256::ONE {
            return Self::half_of(self.0.exp() - (-self.0).exp());
        }
        let e = self.0.exp_m1();
        Self::half_of(e + e / (e + f256::ONE))
    }

    fn cosh(self) -> Self {
        Self::half_of(self.0.exp() + (-self.0).exp())
    }

    fn tanh(self) -> Self {
        // Beyond, the quotient of two infinities would be none.
        let limit = f256::from(100);
        if self.0.abs() > limit {
            return self.sign();
        }
        let e = (self.0 + self.0).exp_m1();
        Self(e / (e + f256::from(2)))
    }

    fn exp(self) -> Self {
        Self(self.0.exp())
    }

    fn ln(self) -> Self {
        Self(self.0.ln())
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn root(self, q: u32) -> Self {
        let negative = self.0 < f256::ZERO;
        if q == 0 || negative && q.is_multiple_of(2) {
            return Self(f256::NAN);
        }
        if q == 1 || self.0.eq_zero() || !self.0.is_finite() {
            return self;
        }
        let size = Self(self.0.abs());
        let count = Self::from_ratio(i64::from(q), 1);
        let guess = (size.ln() / count).exp();
        // One step of Newton's method, since the logarithm has lost what the argument's exponent took.
        let below = guess.powi(i32::try_from(q - 1).unwrap_or(i32::MAX));
        let root = guess - (guess * below - size) / (count * below);
        if negative { -root } else { root }
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn sign(self) -> Self {
        if self.0.eq_zero() || self.0.is_nan() { self } else { Self(f256::ONE.copysign(self.0)) }
    }

    fn floor(self) -> Self {
        Self(self.0.floor())
    }

    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        if self.0 <= limit.0 { below } else { above }
    }

    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

/// The leading 128 bits of an integer, the last of them set if anything was cut off, and the exponent that belongs to
/// them.
fn leading(high: u128, low: u128, exponent: i32) -> (u128, i32) {
    if high == 0 {
        return (low, exponent);
    }
    let shift = 128 - high.leading_zeros();
    let rest = if shift == 128 { low } else { low << (128 - shift) };
    let top = if shift == 128 { high } else { high << (128 - shift) | low >> shift };
    (top | u128::from(rest != 0), exponent + shift as i32)
}

/// `value * 2^exponent` in factors that are doubles.
fn times_power_of_two(value: f64, exponent: i32) -> f64 {
    const STRIDE: i32 = 512;
    let mut scaled = value;
    let mut rest = exponent;
    // Beyond 4 strides nothing is left but zero or infinity.
    for _ in 0..8 {
        let stride = rest.clamp(-STRIDE, STRIDE);
        scaled *= 2.0_f64.powi(stride);
        rest -= stride;
    }
    scaled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_come_back() {
        for value in [0.0, 1.0, -1.5, 1e-300, f64::MAX, -f64::MIN_POSITIVE, 0.1, 3e17 + 64.0, 5e-324] {
            assert_eq!(Digits71::from_f64(value).to_f64(), value);
        }
        assert!(Digits71::from_f64(f64::NAN).to_f64().is_nan());
        assert_eq!(Digits71::from_f64(f64::NEG_INFINITY).to_f64(), f64::NEG_INFINITY);
    }

    #[test]
    fn rounding_is_to_the_nearest() {
        let ulp = f64::EPSILON;
        let tiny = Digits71::from_f64(1e-60);
        let halfway = Digits71::one() + Digits71::from_f64(ulp / 2.0);
        assert_eq!(halfway.to_f64(), 1.0);
        assert_eq!((halfway + tiny).to_f64(), 1.0 + ulp);
        assert_eq!((halfway - tiny).to_f64(), 1.0);
        assert_eq!((Digits71::from_ratio(1, 3)).to_f64(), 1.0 / 3.0);
        assert_eq!((-Digits71::from_ratio(1, 3)).to_f64(), -1.0 / 3.0);
    }

    #[test]
    fn roots_and_signs_at_their_edges() {
        let number = |value: f64| Digits71::from_f64(value);
        assert_eq!(number(-32.0).root(5).to_f64(), -2.0);
        assert!(!number(-1.0).root(4).is_finite() && !number(1.0).root(0).is_finite());
        assert_eq!(number(0.0).root(3).to_f64(), 0.0);
        assert_eq!([-2.0, 0.0, 3.0].map(|x| number(x).sign().to_f64()), [-1.0, 0.0, 1.0]);
        assert_eq!([-1e9, 1e9].map(|x| number(x).tanh().to_f64()), [-1.0, 1.0]);
    }
}
