//! [`Real`] for `f32` and `f64`: sine and cosine of our own, the other elementary functions through the crate `libm`.
//!
//! Both are ordinary Rust, so the results do not depend on the platform's C library, nor on whether some other crate of
//! the build switches `std` on. What IEEE 754 defines to the bit, such as `abs` and the square root, is the processor's.

use crate::numbers::elementary;
use crate::numbers::lanes::Two;
use crate::numbers::lanes::register::Vector;
use crate::numbers::real::Real;

/// `|num| / |den|` as `quotient * 2^-shift`, the last bit of the quotient set if a remainder was dropped.
///
/// The quotient has at least 63 significant bits, so rounding it once to a float rounds the ratio correctly.
fn quotient(num: u64, den: u64) -> (u128, u32) {
    let wide = u128::from(num);
    let shift = wide.leading_zeros();
    let wide = wide << shift;
    let den = u128::from(den);
    ((wide / den) | u128::from(wide % den != 0), shift)
}

macro_rules! real_for_float {
    ($float:ident, $exact:expr, $scale:path, {
        $($method:ident: $function:path),* $(,)?
    }, sin_cos: $sin_cos:path, atan2: $atan2:path) => {
        fn from_parts(parts: &[(i64, i32)]) -> Self {
            let Some((&(mantissa, exponent), rest)) = parts.split_first() else { return 0.0 };
            let leading = $scale(mantissa as $float, exponent);
            if leading.is_infinite() {
                return leading;
            }
            let mut tail = 0.0;
            for &(mantissa, exponent) in rest.iter().rev() {
                tail += $scale(mantissa as $float, exponent);
            }
            let sum = leading + tail;
            // A tail of exactly half a unit is one that was itself rounded; the leading part knew better.
            if sum - leading == 2.0 * tail { leading } else { sum }
        }

        #[inline]
        fn from_ratio(num: i64, den: i64) -> Self {
            const EXACT: u64 = $exact;
            // Both are exact floats, so one division rounds once; literals fold to a constant here.
            if den == 0 || (num.unsigned_abs() <= EXACT && den.unsigned_abs() <= EXACT) {
                return num as $float / den as $float;
            }
            if num == 0 {
                return 0.0;
            }
            let (quotient, shift) = quotient(num.unsigned_abs(), den.unsigned_abs());
            let size = $scale(quotient as $float, -(shift as i32));
            if (num < 0) == (den < 0) { size } else { -size }
        }

        #[inline]
        fn from_f64(value: f64) -> Self {
            value as $float
        }

        #[inline]
        fn to_f64(self) -> f64 {
            self.into()
        }

        #[inline]
        fn zero() -> Self {
            0.0
        }

        #[inline]
        fn one() -> Self {
            1.0
        }

        #[inline]
        fn pi() -> Self {
            core::$float::consts::PI
        }

        #[inline]
        fn epsilon() -> Self {
            $float::EPSILON
        }

        // As written on floats: without optimisation one call, not one for each operator.
        #[inline]
        fn times_plus(self, b: Self, c: Self) -> Self {
            self * b + c
        }

        #[inline]
        fn times_minus(self, b: Self, c: Self) -> Self {
            self * b - c
        }

        #[inline]
        fn minus_times(self, b: Self, c: Self) -> Self {
            self - b * c
        }

        $(
            #[inline]
            fn $method(self) -> Self {
                $function(self)
            }
        )*

        #[inline]
        fn sin_cos(self) -> (Self, Self) {
            $sin_cos(self)
        }

        #[inline]
        fn cot(self) -> Self {
            1.0 / Real::tan(self)
        }

        #[inline]
        fn atan2(self, x: Self) -> Self {
            $atan2(self, x)
        }

        #[inline]
        fn sign(self) -> Self {
            if self == 0.0 { 0.0 } else if self.is_nan() { self } else { (1.0 as $float).copysign(self) }
        }

        #[inline(always)]
        fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
            if self <= limit { below } else { above }
        }

        #[inline]
        fn is_finite(self) -> bool {
            $float::is_finite(self)
        }

        #[inline(always)]
        fn wide<T>(function: impl FnOnce() -> T) -> T {
            crate::numbers::lanes::wide(function)
        }
    };
}

#[inline]
fn sin_cos(x: f64) -> (f64, f64) {
    let (sin, cos) = elementary::sin_cos(Vector(x));
    (sin.0, cos.0)
}

/// Through `f64`, hence rounded correctly but for one argument in some 2^28.
#[inline]
fn sin_cos_single(x: f32) -> (f32, f32) {
    let (sin, cos) = sin_cos(x.into());
    (sin as f32, cos as f32)
}

/// The sine alone, with the bits of [`sin_cos_single`].
#[inline]
fn sin_single(x: f32) -> f32 {
    elementary::sin(x.into()) as f32
}

/// The cosine alone, with the bits of [`sin_cos_single`].
#[inline]
fn cos_single(x: f32) -> f32 {
    elementary::cos(x.into()) as f32
}

impl Real for f64 {
    real_for_float!(f64, 1 << 53, libm::scalbn, {
        sin: elementary::sin, cos: elementary::cos,
        tan: libm::tan, asin: libm::asin, acos: libm::acos, atan: libm::atan,
        sinh: libm::sinh, cosh: libm::cosh, tanh: libm::tanh, exp: libm::exp, ln: libm::log,
        sqrt: elementary::sqrt, abs: f64::abs, floor: libm::floor,
    }, sin_cos: sin_cos, atan2: libm::atan2);

    #[inline]
    fn sin_cos_pair(first: Self, second: Self) -> ((Self, Self), (Self, Self)) {
        let angles = Vector::<Two>::from_fn(|i| if i == 0 { first } else { second });
        let (sin, cos) = elementary::sin_cos(angles);
        ((sin.lane(0), cos.lane(0)), (sin.lane(1), cos.lane(1)))
    }

    #[inline]
    fn root(self, q: u32) -> Self {
        match q {
            1 => self,
            2 => elementary::sqrt(self),
            3 => libm::cbrt(self),
            _ => high_root(self, q),
        }
    }
}

impl Real for f32 {
    real_for_float!(f32, 1 << 24, libm::scalbnf, {
        sin: sin_single, cos: cos_single,
        tan: libm::tanf, asin: libm::asinf, acos: libm::acosf,
        atan: libm::atanf, sinh: libm::sinhf, cosh: libm::coshf, tanh: libm::tanhf, exp: libm::expf,
        ln: libm::logf, sqrt: libm::sqrtf, abs: f32::abs, floor: libm::floorf,
    }, sin_cos: sin_cos_single, atan2: libm::atan2f);

    #[inline]
    fn sin_cos_pair(first: Self, second: Self) -> ((Self, Self), (Self, Self)) {
        let single = |(sin, cos): (f64, f64)| (sin as f32, cos as f32);
        let (first, second) = f64::sin_cos_pair(first.into(), second.into());
        (single(first), single(second))
    }

    #[inline]
    fn root(self, q: u32) -> Self {
        match q {
            1 => self,
            2 => libm::sqrtf(self),
            3 => libm::cbrtf(self),
            _ => high_root(self.into(), q) as f32,
        }
    }
}

/// The real root of order `q`, by a power and one Newton step `y - (y - |x| / y^(q-1)) / q`, which removes the
/// rounding of `1/q`.
#[inline(never)]
fn high_root(x: f64, q: u32) -> f64 {
    if q == 0 || (q.is_multiple_of(2) && x < 0.0) {
        return f64::NAN;
    }
    let size = x.abs();
    let order = f64::from(q);
    let guess = libm::pow(size, 1.0 / order);
    let power = libm::pow(guess, order - 1.0);
    // Zero, infinity and NaN are their own roots; so is a root whose power left the normal numbers.
    let root = if power.is_normal() && guess.is_normal() && size.is_finite() {
        guess - (guess - size / power) / order
    } else {
        guess
    };
    root.copysign(x)
}

#[cfg(test)]
mod tests {
    extern crate std;
    use super::*;

    /// A linear congruential generator: the tests draw the same numbers in every run.
    fn draws() -> impl Iterator<Item = i64> {
        let mut state = 0x9e37_79b9_7f4a_7c15_u64;
        core::iter::repeat_with(move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> (state >> 58)) as i64 ^ (state as i64 & i64::MIN)
        })
    }

    #[test]
    fn ratios_are_rounded_correctly() {
        assert_eq!(f64::from_ratio(1, 10), 0.1);
        assert_eq!(f32::from_ratio(1, 10), 0.1);
        assert_eq!(f64::from_ratio(9_007_199_254_740_993, 1), 9_007_199_254_740_992.0);
        assert_eq!(f64::from_ratio(1, i64::MIN), -f64::exp2(-63.0));
        assert_eq!(f64::from_ratio(3, i64::MAX), 3.0 * f64::exp2(-63.0));
        assert_eq!(f64::from_ratio(0, i64::MAX), 0.0);
        assert!(f64::from_ratio(1, 0).is_infinite() && f64::from_ratio(0, 0).is_nan());
        // Dividing by a power of ten is what parsing a decimal does.
        for num in draws().take(2000) {
            let text = std::format!("{num}e-17");
            assert_eq!(f64::from_ratio(num, 100_000_000_000_000_000), text.parse::<f64>().unwrap(), "{text}");
            assert_eq!(f32::from_ratio(num, 100_000_000_000_000_000), text.parse::<f32>().unwrap(), "{text}");
        }
    }

    #[test]
    fn parts_keep_a_leading_part_that_is_rounded_correctly() {
        assert_eq!(f64::from_parts(&[]), 0.0);
        let odd = (1_i64 << 53) - 1;
        assert_eq!(f64::from_parts(&[(odd, 0), (1, -1)]), odd as f64);
        assert_eq!(f64::from_parts(&[(odd, 0), (1, -1), (-1, -200)]), odd as f64);
        assert_eq!(f64::from_parts(&[(1, 0), (1, -10), (1, -20)]), 1.0 + f64::exp2(-10.0) + f64::exp2(-20.0));
    }

    #[test]
    fn parts_do_not_overflow_on_the_way() {
        assert_eq!(f64::from_parts(&[(1 << 62, -1130)]), f64::exp2(-1068.0));
        assert_eq!(f64::from_parts(&[(1, -1074)]), f64::from_bits(1));
        assert_eq!(f64::from_parts(&[((1 << 53) - 1, 971)]), f64::MAX);
        assert!(f64::from_parts(&[(1, 1024)]).is_infinite());
        // The remainder of 1e390 is beyond the largest double too, and may have the other sign.
        assert_eq!(f64::from_parts(&[(-1, 1300), (1, 1240)]), f64::NEG_INFINITY);
    }

    #[test]
    fn roots_are_real_roots() {
        assert_eq!(Real::root(-27.0_f64, 3), -3.0);
        assert_eq!(Real::root(243.0_f64, 5), 3.0);
        assert_eq!(Real::root(0.0_f64, 7), 0.0);
        assert!(Real::root(f64::INFINITY, 4).is_infinite());
        assert!(Real::root(2.0_f64, 0).is_nan() && Real::root(-2.0_f64, 6).is_nan());
        for q in 1..40_u32 {
            for x in [1e-300, 3.5e-5, 0.7, 1.0, 12.5, 8.1e20, 1e300] {
                let root = Real::root(x, q);
                // A relative error e of the root becomes q e in its power, itself good to a few units.
                let error = (libm::pow(root, f64::from(q)) / x - 1.0).abs();
                assert!(error <= f64::from(q + 3) * f64::EPSILON, "{x} {q} {error:e}");
            }
        }
    }

    #[test]
    fn signs_and_powers() {
        assert_eq!([Real::sign(-2.0_f64), Real::sign(-0.0), Real::sign(0.5)], [-1.0, 0.0, 1.0]);
        assert!(Real::sign(f64::NAN).is_nan());
        assert_eq!(Real::powi(3.0_f64, 5), 243.0);
        assert_eq!(Real::powi(2.0_f64, -3), 0.125);
        assert_eq!(Real::powi(0.0_f64, 0), 1.0);
        assert_eq!(Real::powi(1.0_f64, i32::MIN), 1.0);
        assert_eq!(Real::powi(f64::exp2(511.0), 2), f64::exp2(1022.0));
    }
}
