//! Exact rational numbers: two machine words while they fit, a big integer ratio beyond.
//!
//! Numbers of a declaration are exact (`0.1` is one tenth), and determinants of decimal constants
//! overflow 128 bits, so both representations occur; almost all values stay small.

use core::cmp::Ordering;
use core::fmt;
use core::ops::{Add, Div, Mul, Neg, Sub};

use num_bigint::{BigInt, BigUint, Sign};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive};

use super::id::mix;

/// An exact rational number in lowest terms with a positive denominator.
///
/// ```
/// use guen_symbolic::Rational;
/// let tenth = Rational::new(1, 10);
/// assert_eq!(tenth + Rational::new(1, 15), Rational::new(1, 6));
/// ```
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Rational(Repr);

#[derive(Clone, PartialEq, Eq, Hash)]
enum Repr {
    Small(i64, i64),
    // Only values that do not fit the small form, so that equality and hashing stay structural.
    Big(Box<BigRational>),
}
use Repr::{Big, Small};

fn gcd(a: u128, b: u128) -> u128 {
    let (mut a, mut b) = (a, b);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

/// The greatest common divisor of two words: a division of wide integers would be a call.
fn gcd_of_words(a: u64, b: u64) -> u64 {
    let (mut a, mut b) = (a, b);
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a
}

impl Rational {
    /// Zero.
    pub const ZERO: Rational = Rational(Small(0, 1));
    /// One.
    pub const ONE: Rational = Rational(Small(1, 1));
    /// Minus one.
    pub const MINUS_ONE: Rational = Rational(Small(-1, 1));

    /// `numerator / denominator`; a zero denominator is a mistake of the caller.
    pub fn new(numerator: i64, denominator: i64) -> Self {
        Self::reduce(numerator.into(), denominator.into())
    }

    /// The integer `n`.
    pub fn integer(n: i64) -> Self {
        Rational(Small(n, 1))
    }

    /// The ratio of two big integers.
    pub(crate) fn from_big(numerator: BigInt, denominator: BigInt) -> Self {
        Self::from_ratio(BigRational::new(numerator, denominator))
    }

    /// `digits * 10^exponent`, from the text of a decimal literal.
    ///
    /// Returns `None` if `digits` is not a string of decimal digits.
    pub fn from_decimal(digits: &str, exponent: i32) -> Option<Self> {
        let mantissa = BigInt::parse_bytes(digits.as_bytes(), 10)?;
        let scale = num_traits::pow(BigInt::from(10), exponent.unsigned_abs() as usize);
        Some(if exponent >= 0 {
            Self::from_big(mantissa * scale, BigInt::one())
        } else {
            Self::from_big(mantissa, scale)
        })
    }

    fn reduce(numerator: i128, denominator: i128) -> Self {
        debug_assert!(denominator != 0, "a rational number with a zero denominator");
        let negative = (numerator < 0) != (denominator < 0);
        let (n, d) = (numerator.unsigned_abs(), denominator.unsigned_abs());
        let (n, d) = match (u64::try_from(n), u64::try_from(d)) {
            (Ok(n), Ok(d)) => {
                let g = gcd_of_words(n, d).max(1);
                ((n / g) as u128, (d / g) as u128)
            }
            _ => {
                let g = gcd(n, d).max(1);
                (n / g, d / g)
            }
        };
        match (i64::try_from(n), i64::try_from(d)) {
            (Ok(n), Ok(d)) => Rational(Small(if negative { -n } else { n }, d)),
            _ => {
                let n =
                    BigInt::from_biguint(if negative { Sign::Minus } else { Sign::Plus }, BigUint::from(n));
                Rational(Big(Box::new(BigRational::new_raw(n, BigInt::from(d)))))
            }
        }
    }

    fn from_ratio(value: BigRational) -> Self {
        match (value.numer().to_i64(), value.denom().to_i64()) {
            (Some(n), Some(d)) if n != i64::MIN => Rational(Small(n, d)),
            _ => Rational(Big(Box::new(value))),
        }
    }

    fn to_ratio(&self) -> BigRational {
        match &self.0 {
            Small(n, d) => BigRational::new_raw(BigInt::from(*n), BigInt::from(*d)),
            Big(value) => (**value).clone(),
        }
    }

    /// Whether this is zero.
    pub fn is_zero(&self) -> bool {
        matches!(self.0, Small(0, _))
    }

    /// Whether this is one.
    pub fn is_one(&self) -> bool {
        matches!(self.0, Small(1, 1))
    }

    /// Whether this is minus one.
    pub fn is_minus_one(&self) -> bool {
        matches!(self.0, Small(-1, 1))
    }

    /// Whether this is below zero.
    pub fn is_negative(&self) -> bool {
        match &self.0 {
            Small(n, _) => *n < 0,
            Big(value) => value.is_negative(),
        }
    }

    /// Whether the denominator is one.
    pub(crate) fn is_integer(&self) -> bool {
        match &self.0 {
            Small(_, d) => *d == 1,
            Big(value) => value.is_integer(),
        }
    }

    /// The value as a pair of machine integers, if both fit.
    pub fn to_i64_pair(&self) -> Option<(i64, i64)> {
        match &self.0 {
            Small(n, d) => Some((*n, *d)),
            Big(_) => None,
        }
    }

    /// The value as a machine integer, if it is one.
    pub fn to_i64(&self) -> Option<i64> {
        match &self.0 {
            Small(n, 1) => Some(*n),
            _ => None,
        }
    }

    /// A fixed mixing of the value, for keys and tables.
    pub(crate) fn hash64(&self) -> u64 {
        match &self.0 {
            Small(n, d) => mix(*n as u64) ^ mix(*d as u64).rotate_left(1),
            Big(value) => {
                let digits = value.numer().iter_u64_digits().chain(value.denom().iter_u64_digits());
                digits.fold(u64::from(value.is_negative()), |hash, digit| mix(hash ^ digit))
            }
        }
    }

    /// Numerator and denominator as big integers.
    pub fn to_big_pair(&self) -> (BigInt, BigInt) {
        let value = self.to_ratio();
        (value.numer().clone(), value.denom().clone())
    }

    /// The nearest double, for printing and heuristics only.
    pub fn to_f64(&self) -> f64 {
        match &self.0 {
            Small(n, d) => *n as f64 / *d as f64,
            Big(value) => value.to_f64().unwrap_or(f64::NAN),
        }
    }

    /// The absolute value.
    pub fn abs(&self) -> Self {
        if self.is_negative() { -self.clone() } else { self.clone() }
    }

    /// `1 / self`, or `None` for zero.
    pub fn recip(&self) -> Option<Self> {
        match &self.0 {
            Small(0, _) => None,
            Small(1 | -1, 1) => Some(self.clone()),
            Small(n, d) => Some(Self::reduce((*d).into(), (*n).into())),
            Big(value) => Some(Self::from_ratio(value.recip())),
        }
    }

    /// `self^n`, or `None` for a negative power of zero.
    pub fn powi(&self, n: i32) -> Option<Self> {
        if n == 1 || self.is_one() && n >= 0 {
            return Some(self.clone());
        }
        let mut base = if n < 0 { self.recip()? } else { self.clone() };
        let mut exponent = n.unsigned_abs();
        let mut result = Rational::ONE;
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = &result * &base;
            }
            exponent >>= 1;
            if exponent > 0 {
                base = &base * &base;
            }
        }
        Some(result)
    }

    /// The bits of the larger of numerator and denominator: what limits on numbers are stated in.
    pub fn bits(&self) -> u64 {
        match &self.0 {
            Small(n, d) => 64 - u64::from(n.unsigned_abs().leading_zeros().min(d.leading_zeros())),
            Big(value) => value.numer().bits().max(value.denom().bits()),
        }
    }

    /// The greatest common divisor in the sense of contents: gcd of numerators over lcm of denominators, not negative.
    pub(crate) fn content_gcd(&self, other: &Self) -> Self {
        use num_integer::Integer;
        if let (Small(a, b), Small(c, d)) = (&self.0, &other.0) {
            if *b == 1 && *d == 1 && (a.unsigned_abs() == 1 || c.unsigned_abs() == 1) {
                return Rational::ONE;
            }
            let numerator = gcd_of_words(a.unsigned_abs(), c.unsigned_abs());
            if *b == 1 && *d == 1 && numerator <= i64::MAX as u64 {
                return Rational(Small(numerator as i64, 1));
            }
            let lcm = i128::from(*b / gcd_of_words(*b as u64, *d as u64) as i64) * i128::from(*d);
            return Self::reduce(numerator.into(), lcm);
        }
        let (a, b) = self.to_big_pair();
        let (c, d) = other.to_big_pair();
        Self::from_big(a.gcd(&c), b.lcm(&d))
    }

    /// `r` with `r^q` the value, if the value is an exact `q`-th power of a rational number.
    pub(crate) fn exact_root(&self, q: u32) -> Option<Self> {
        if self.is_negative() && q.is_multiple_of(2) {
            return None;
        }
        let (n, d) = self.to_big_pair();
        let root = |x: &BigInt| {
            let r = x.nth_root(q);
            (num_traits::pow(r.clone(), q as usize) == *x).then_some(r)
        };
        Some(Self::from_big(root(&n)?, root(&d)?))
    }
}

impl From<i64> for Rational {
    fn from(n: i64) -> Self {
        Rational::integer(n)
    }
}

/// The size below which integers, almost all coefficients, are computed with directly: their products fit.
const SMALL_INTEGERS: i64 = 1 << 31;

fn are_short(a: i64, b: i64) -> bool {
    -SMALL_INTEGERS < a && a < SMALL_INTEGERS && -SMALL_INTEGERS < b && b < SMALL_INTEGERS
}

macro_rules! operator {
    ($trait:ident, $method:ident, |$a:ident, $b:ident, $c:ident, $d:ident| $integers:expr, $small:expr) => {
        impl $trait<&Rational> for &Rational {
            type Output = Rational;
            fn $method(self, other: &Rational) -> Rational {
                if let (Small($a, $b), Small($c, $d)) = (&self.0, &other.0) {
                    if *$b == 1 && *$d == 1 && are_short(*$a, *$c) {
                        let ($a, $c) = (*$a, *$c);
                        if let Some(result) = $integers {
                            return Rational(Small(result, 1));
                        }
                    }
                    let ($a, $b, $c, $d) =
                        (i128::from(*$a), i128::from(*$b), i128::from(*$c), i128::from(*$d));
                    // Products of two 63-bit numbers fit; their sum may need one bit more, which i128 has.
                    let (n, d) = $small;
                    return Rational::reduce(n, d);
                }
                Rational::from_ratio($trait::$method(self.to_ratio(), other.to_ratio()))
            }
        }
        impl $trait for Rational {
            type Output = Rational;
            fn $method(self, other: Rational) -> Rational {
                $trait::$method(&self, &other)
            }
        }
    };
}
operator!(Add, add, |a, b, c, d| Some(a + c), (a * d + c * b, b * d));
operator!(Sub, sub, |a, b, c, d| Some(a - c), (a * d - c * b, b * d));
operator!(Mul, mul, |a, b, c, d| Some(a * c), (a * c, b * d));
// Division by zero is the caller's mistake: every caller asks first.
operator!(Div, div, |a, b, c, d| if c == 1 { Some(a) } else { None }, (a * d, b * c));

impl Neg for Rational {
    type Output = Rational;
    fn neg(self) -> Rational {
        if let Small(n, d) = self.0
            && n != i64::MIN
        {
            return Rational(Small(-n, d));
        }
        &Rational::MINUS_ONE * &self
    }
}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> Ordering {
        let difference = self - other;
        if difference.is_zero() {
            Ordering::Equal
        } else if difference.is_negative() {
            Ordering::Less
        } else {
            Ordering::Greater
        }
    }
}

impl fmt::Display for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Small(n, 1) => write!(f, "{n}"),
            Small(n, d) => write!(f, "{n}/{d}"),
            Big(value) => write!(f, "{value}"),
        }
    }
}

impl fmt::Debug for Rational {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Default for Rational {
    fn default() -> Self {
        Rational::ZERO
    }
}

impl core::iter::Sum for Rational {
    fn sum<I: Iterator<Item = Rational>>(iter: I) -> Self {
        iter.fold(Rational::ZERO, |a, b| a + b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spills_and_returns() {
        let big = Rational::from_decimal("662607015", -42).unwrap();
        assert!(big.to_i64_pair().is_none());
        let back = &big * &Rational::from_decimal("1", 42).unwrap();
        assert_eq!(back.to_i64(), Some(662607015));
        assert_eq!(Rational::integer(i64::MAX) + Rational::ONE - Rational::ONE, Rational::integer(i64::MAX));
        let least = Rational::integer(i64::MIN + 1);
        assert_eq!(&least - &Rational::ONE + Rational::ONE, least);
        assert_eq!(
            Rational::integer(i64::MAX) * Rational::integer(2) / Rational::integer(2),
            Rational::integer(i64::MAX)
        );
        assert_eq!(Rational::integer(6) / Rational::integer(4), Rational::new(3, 2));
    }

    #[test]
    fn roots_and_contents() {
        assert_eq!(Rational::new(9, 4).exact_root(2), Some(Rational::new(3, 2)));
        assert_eq!(Rational::new(2, 1).exact_root(2), None);
        assert_eq!(Rational::new(4, 3).content_gcd(&Rational::new(2, 9)), Rational::new(2, 9));
        assert_eq!(Rational::new(-8, 27).exact_root(3), Some(Rational::new(-2, 3)));
    }
}
