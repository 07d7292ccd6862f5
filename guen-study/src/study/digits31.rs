//! A real of two doubles, for references that 71 digits are too slow for.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use std::sync::OnceLock;

use guen_runtime::{Lift, Real};

use super::digits71::Digits71;

/// A real of 106 bits, 31 decimal digits, as the unevaluated sum of two doubles: for references, where [`Digits71`] takes too
/// long.
///
/// - Errors: below 1e-29 of the result for sums, products, quotients, roots and functions, of the argument's size for sine and
///   cosine beyond a quarter turn; measured against `Digits71` at random arguments by a test.
/// - Range: that of doubles; products overflow from 1e300 on, and what is below 1e-290 has fewer digits.
/// - Sources: Dekker, *Numer. Math.* 18 (1971) 224; Hida, Li and Bailey, *Library for Double-Double and Quad-Double
///   Arithmetic* (2007).
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub(super) struct Digits31 {
    high: f64,
    low: f64,
}

const LN_2: Digits31 = Digits31 { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };
const PI: Digits31 = Digits31 { high: std::f64::consts::PI, low: 1.224_646_799_147_353_2e-16 };
/// A quarter turn in three doubles, so that whole turns can be taken off.
const QUARTER: [f64; 3] =
    [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];

/// `a + b` and its rounding error, for any two.
fn two_sum(a: f64, b: f64) -> Digits31 {
    let high = a + b;
    let part = high - a;
    Digits31 { high, low: (a - (high - part)) + (b - part) }
}

/// The sum where `a` is the larger one.
fn quick_two_sum(a: f64, b: f64) -> Digits31 {
    let high = a + b;
    Digits31 { high, low: b - (high - a) }
}

/// `a b` and its rounding error, by halves of 26 bits.
fn two_product(a: f64, b: f64) -> Digits31 {
    const SPLITTER: f64 = 134_217_729.0;
    let halves = |x: f64| {
        let big = SPLITTER * x;
        let high = big - (big - x);
        (high, x - high)
    };
    let high = a * b;
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    Digits31 { high, low: ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2 }
}

impl Digits31 {
    const ONE: Self = Self { high: 1.0, low: 0.0 };

    fn of(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    /// Returns the number in 71 digits, exactly.
    pub fn lengthened(self) -> Digits71 {
        Digits71::from_f64(self.high) + Digits71::from_f64(self.low)
    }

    fn times_power_of_two(self, factor: f64) -> Self {
        Self { high: self.high * factor, low: self.low * factor }
    }

    fn half(self) -> Self {
        self.times_power_of_two(0.5)
    }

    fn square(self) -> Self {
        self * self
    }

    /// `exp(x) - 1` for `|x| <= 1`: of `x/512` by its series, which is then doubled nine times, `(1 + e)^2 - 1 = 2 e + e^2`.
    fn short_exp_m1(self) -> Self {
        const ARGUMENT_HALVINGS: i32 = 9;
        const TERMS: usize = 10;
        let x = self.times_power_of_two(1.0 / 512.0);
        let inverse = inverse_factorials();
        let mut sum = inverse[TERMS];
        for k in (1..TERMS).rev() {
            sum = sum * x + inverse[k];
        }
        let mut e = sum * x;
        for _ in 0..ARGUMENT_HALVINGS {
            e = e.times_power_of_two(2.0) + e.square();
        }
        e
    }

    /// Sine and cosine of an angle of at most an eighth of a turn, by their series.
    fn short_sin_cos(self) -> (Self, Self) {
        const TERMS: usize = 14;
        let square = self.square();
        let inverse = inverse_factorials();
        let (mut sin, mut cos) = (Self::default(), Self::default());
        for k in (0..TERMS).rev() {
            sin = inverse[2 * k + 1] - sin * square;
            cos = inverse[2 * k] - cos * square;
        }
        (sin * self, cos)
    }

    /// The angle of the point `(x, y)`: that of the doubles, and what a rotation by it leaves.
    fn angle(y: Self, x: Self) -> Self {
        let rough = Self::of(y.high.atan2(x.high));
        if y.high == 0.0 && x.high == 0.0 || !rough.high.is_finite() {
            return rough;
        }
        let (sin, cos) = rough.sin_cos();
        let rest = (y * cos - x * sin) / (x * cos + y * sin);
        rough + rest
    }
}

/// `1/k!`.
fn inverse_factorials() -> &'static [Digits31; 30] {
    static TABLE: OnceLock<[Digits31; 30]> = OnceLock::new();
    TABLE.get_or_init(|| {
        let mut table = [Digits31::ONE; 30];
        for k in 1..table.len() {
            table[k] = table[k - 1] / Digits31::of(k as f64);
        }
        table
    })
}

impl Add for Digits31 {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let sum = quick_two_sum(high.high, high.low + low.high);
        quick_two_sum(sum.high, sum.low + low.low)
    }
}

impl Neg for Digits31 {
    type Output = Self;
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for Digits31 {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Digits31 {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        quick_two_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Digits31 {
    type Output = Self;
    /// Long division, a double at a time.
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        if !first.is_finite() || other.high.is_infinite() {
            return Self::of(first);
        }
        let rest = self - other * Self::of(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::of(second);
        let third = rest.high / other.high;
        quick_two_sum(first, second) + Self::of(third)
    }
}

macro_rules! assigned {
    ($($trait:ident, $method:ident, $operator:tt;)*) => {
        $(impl $trait for Digits31 {
            fn $method(&mut self, other: Self) {
                *self = *self $operator other;
            }
        })*
    };
}

assigned! {
    AddAssign, add_assign, +;
    SubAssign, sub_assign, -;
    MulAssign, mul_assign, *;
    DivAssign, div_assign, /;
}

impl Lift<Digits31> for Digits31 {
    fn lift(base: Self) -> Self {
        base
    }
}

impl Real for Digits31 {
    fn from_ratio(num: i64, den: i64) -> Self {
        let whole = |number: i64| {
            let high = number as f64;
            quick_two_sum(high, (i128::from(number) - high as i128) as f64)
        };
        whole(num) / whole(den)
    }

    fn from_f64(value: f64) -> Self {
        Self::of(value)
    }

    fn to_f64(self) -> f64 {
        self.high
    }

    fn pi() -> Self {
        PI
    }

    fn epsilon() -> Self {
        // 2^-104.
        Self::of(f64::EPSILON * f64::EPSILON)
    }

    fn sin_cos(self) -> (Self, Self) {
        if !self.high.is_finite() {
            return (Self::of(f64::NAN), Self::of(f64::NAN));
        }
        let turns = (self.high / QUARTER[0]).round();
        let mut rest = self;
        for part in QUARTER {
            rest -= two_product(turns, part);
        }
        let (sin, cos) = rest.short_sin_cos();
        match turns.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }

    fn asin(self) -> Self {
        Self::angle(self, ((Self::ONE - self) * (Self::ONE + self)).sqrt())
    }

    fn acos(self) -> Self {
        Self::angle(((Self::ONE - self) * (Self::ONE + self)).sqrt(), self)
    }

    fn atan(self) -> Self {
        Self::angle(self, Self::ONE)
    }

    fn atan2(self, x: Self) -> Self {
        Self::angle(self, x)
    }

    // With `e = exp(x) - 1`, so that small arguments keep their digits.
    fn sinh(self) -> Self {
        if self.high.abs() > 1.0 {
            return (self.exp() - (-self).exp()).half();
        }
        let e = self.short_exp_m1();
        (e + e / (e + Self::ONE)).half()
    }

    fn cosh(self) -> Self {
        (self.exp() + (-self).exp()).half()
    }

    fn tanh(self) -> Self {
        if self.high.abs() > 0.5 {
            // Beyond, the quotient of two infinities would be none.
            let twice = (self + self).exp();
            return if self.high > 40.0 { Self::ONE } else { (twice - Self::ONE) / (twice + Self::ONE) };
        }
        let e = (self + self).short_exp_m1();
        e / (e + Self::of(2.0))
    }

    fn exp(self) -> Self {
        if self.high.is_nan() || self.high > 709.0 {
            return Self::of(self.high.exp());
        }
        if self.high < -740.0 {
            return Self::default();
        }
        let twos = (self.high / LN_2.high).round();
        let rest = self - LN_2 * Self::of(twos);
        // In two factors, for the smallest ones are no normal doubles.
        let half = (0.5 * twos).floor();
        let value = rest.short_exp_m1() + Self::ONE;
        value.times_power_of_two(half.exp2()).times_power_of_two((twos - half).exp2())
    }

    /// The logarithm of the double, and a step of Newton's method.
    fn ln(self) -> Self {
        let rough = self.high.ln();
        if !rough.is_finite() {
            return Self::of(rough);
        }
        let rest = self * Self::of(-rough).exp() - Self::ONE;
        Self::of(rough) + (rest - rest.square().half())
    }

    fn sqrt(self) -> Self {
        let rough = self.high.sqrt();
        if rough == 0.0 || !rough.is_finite() {
            return Self::of(rough);
        }
        let root = Self::of(rough);
        let better = (root + self / root).half();
        (better + self / better).half()
    }

    fn root(self, q: u32) -> Self {
        let negative = self.high < 0.0;
        if q == 0 || negative && q.is_multiple_of(2) {
            return Self::of(f64::NAN);
        }
        if q == 1 || self.high == 0.0 || !self.high.is_finite() {
            return self;
        }
        let size = self.abs();
        let count = Self::of(f64::from(q));
        let mut root = Self::of(size.high.powf(1.0 / f64::from(q)));
        // Two steps of Newton's method: the double has lost what the argument's exponent took.
        for _ in 0..2 {
            let below = root.powi(i32::try_from(q - 1).unwrap_or(i32::MAX));
            root -= (root * below - size) / (count * below);
        }
        if negative { -root } else { root }
    }

    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    fn sign(self) -> Self {
        if self.high == 0.0 || self.high.is_nan() { self } else { Self::of(1.0_f64.copysign(self.high)) }
    }

    fn floor(self) -> Self {
        let high = Real::floor(self.high);
        // Of a whole number the rest decides.
        if high == self.high { Self::of(high) + Self::of(Real::floor(self.low)) } else { Self::of(high) }
    }

    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        if self <= limit { below } else { above }
    }

    fn is_finite(self) -> bool {
        self.high.is_finite() && self.low.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Pair = (&'static str, fn(Digits31) -> Digits31, fn(Digits71) -> Digits71, f64, f64);

    /// Every function at 2,000 numbers of 31 digits between two bounds, with signs where the lower one is negative.
    #[test]
    fn every_function_has_29_digits() {
        let mut state = 1969_u64;
        let mut draw = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let functions: [Pair; 17] = [
            ("inverse", |x| Digits31::ONE / x, |x| Digits71::one() / x, 0.01, 100.0),
            ("square", |x| x * x, |x| x * x, -9.0, 9.0),
            ("sum", |x| x + PI, |x| x + PI.lengthened(), 0.0, 9.0),
            ("sin", Real::sin, Real::sin, -0.78, 0.78),
            ("cos", Real::cos, Real::cos, -0.78, 0.78),
            ("far sin", |x| x.sin() + Digits31::of(2.0), |x| x.sin() + Digits71::from_f64(2.0), -1e4, 1e4),
            ("asin", Real::asin, Real::asin, -0.999, 0.999),
            ("acos", Real::acos, Real::acos, -0.99, 0.99),
            ("atan", Real::atan, Real::atan, -50.0, 50.0),
            ("sinh", Real::sinh, Real::sinh, -20.0, 20.0),
            ("cosh", Real::cosh, Real::cosh, -20.0, 20.0),
            ("tanh", Real::tanh, Real::tanh, -20.0, 20.0),
            ("exp", Real::exp, Real::exp, -200.0, 200.0),
            ("ln", Real::ln, Real::ln, 2.0, 1e9),
            ("sqrt", Real::sqrt, Real::sqrt, 0.0, 1e9),
            ("root3", |x| x.root(3), |x| x.root(3), -1e9, 1e9),
            ("root5", |x| x.root(5), |x| x.root(5), -1e9, 1e9),
        ];
        for (name, short, long, low, high) in functions {
            let mut largest = 0.0_f64;
            for _ in 0..2_000 {
                let value = low + (high - low) * draw();
                let x = two_sum(value, value * 1e-16 * (draw() - 0.5));
                let (found, exact) = (short(x).lengthened(), long(x.lengthened()));
                let error = ((found - exact) / exact).abs().to_f64();
                largest = if error.is_nan() { f64::INFINITY } else { largest.max(error) };
            }
            println!("{name:<8} {largest:.1e}");
            assert!(largest < 1e-29, "{name}: {largest:e}");
        }
        assert!(((PI.lengthened() - Digits71::pi()) / Digits71::pi()).abs().to_f64() < 1e-31);
    }

    #[test]
    fn edges() {
        let number = Digits31::of;
        assert_eq!(Digits31::from_ratio(i64::MAX, 1).lengthened().to_f64(), i64::MAX as f64);
        let third = Digits31::from_ratio(1, 3).lengthened() - Digits71::from_ratio(1, 3);
        assert!(third.abs().to_f64() < 1e-32);
        assert!(!number(-1.0).sqrt().is_finite() && !number(-1.0).root(4).is_finite());
        assert_eq!([-1e9, 1e9].map(|x| number(x).tanh().high), [-1.0, 1.0]);
        assert_eq!(number(-800.0).exp().high, 0.0);
        assert!(!number(1e9).exp().is_finite() && !number(0.0).ln().is_finite());
        assert_eq!(number(0.0).atan2(number(-1.0)).high, std::f64::consts::PI);
    }
}
