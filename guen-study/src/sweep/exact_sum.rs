//! Sums of doubles, and of products of two doubles, without any rounding.
//!
//! A sum is a number of fixed point, wide enough for every product of two doubles and for 2^64 of them. Additions commute
//! and associate, so a sum has the same digits whatever the order of its terms and however they were shared out.

use std::fmt::{self, Write as _};

use super::natural::{Integer, Natural};

/// The bits of a digit. Digits are kept in 64 bits, so that carries wait.
const DIGIT: u32 = 32;
/// The exponent of two of the lowest digit's unit: below 2^-2148, the smallest product of two doubles, and a multiple of `DIGIT`.
pub(super) const UNIT: i32 = -2176;
/// The digits: up to 2^2048, the largest product, times 2^64 terms, and a sign.
const DIGITS: usize = 136;
/// The additions before carries have to be taken: each adds less than 2^32 to a digit. Two sums with so many can be added once.
const MOST_PENDING: u32 = 1 << 28;

/// An exact sum.
#[derive(Clone)]
pub(super) struct ExactSum {
    digits: Box<[i64; DIGITS]>,
    pending: u32,
}

impl fmt::Debug for ExactSum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text())
    }
}

impl Default for ExactSum {
    fn default() -> Self {
        Self { digits: Box::new([0; DIGITS]), pending: 0 }
    }
}

/// A finite double taken apart: a whole number, the exponent of two of its unit, and a sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts {
    pub(super) whole: u64,
    pub(super) exponent: i32,
    pub(super) sign: i32,
}

impl Parts {
    /// The least exponent of two.
    pub(super) const LEAST: i32 = -1074;

    #[inline]
    pub(super) fn of(x: f64) -> Self {
        let bits = x.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i32;
        let fraction = bits & ((1 << 52) - 1);
        let sign = 1 - 2 * (bits >> 63) as i32;
        if exponent == 0 {
            Self { whole: fraction, exponent: Self::LEAST, sign }
        } else {
            Self { whole: fraction | 1 << 52, exponent: exponent - 1075, sign }
        }
    }
}

impl ExactSum {
    /// Forgets all terms.
    pub(super) fn clear(&mut self) {
        self.digits.fill(0);
        self.pending = 0;
    }

    /// Adds a finite double.
    #[inline]
    pub(super) fn add(&mut self, x: Parts) {
        let place = (x.exponent - UNIT) as u32;
        let number = u128::from(x.whole) << (place % DIGIT);
        let digits = [number as u32, (number >> 32) as u32, (number >> 64) as u32];
        self.add_digits(digits, (place / DIGIT) as usize, x.sign);
        self.count();
    }

    /// Adds the product of two finite doubles, exactly.
    #[inline]
    pub(super) fn add_product(&mut self, x: Parts, y: Parts) {
        self.add_size(u128::from(x.whole) * u128::from(y.whole), x.exponent + y.exponent, x.sign * y.sign);
    }

    /// Adds a whole number times a power of two that is not below the unit; the highest digits have room for it.
    #[inline]
    pub(super) fn add_whole(&mut self, whole: i128, exponent: i32) {
        self.add_size(whole.unsigned_abs(), exponent, whole.signum() as i32);
    }

    #[inline]
    fn add_size(&mut self, whole: u128, exponent: i32, sign: i32) {
        let place = (exponent - UNIT) as u32;
        let shift = place % DIGIT;
        // 128 bits and up to 31 more: too many for one number.
        let low = u128::from(whole as u64) << shift;
        let high = (whole >> 64 << shift) + (low >> 64);
        let digits = [low as u32, (low >> 32) as u32, high as u32, (high >> 32) as u32, (high >> 64) as u32];
        self.add_digits(digits, (place / DIGIT) as usize, sign);
        self.count();
    }

    /// Adds digits from a place on.
    #[inline]
    fn add_digits<const N: usize>(&mut self, digits: [u32; N], place: usize, sign: i32) {
        if let Some(own) = self.digits.get_mut(place..place + N) {
            own.iter_mut().zip(digits).for_each(|(own, digit)| *own += i64::from(sign) * i64::from(digit));
        }
    }

    #[inline]
    fn count(&mut self) {
        self.pending += 1;
        if self.pending >= MOST_PENDING {
            self.carry();
        }
    }

    /// Takes all carries: then every digit but the highest is in `0 .. 2^32`, and equal sums have equal digits.
    fn carry(&mut self) {
        let mut carry = 0;
        let (top, digits) = self.digits.split_last_mut().expect("there are digits");
        for digit in digits {
            let value = *digit + carry;
            *digit = value & i64::from(u32::MAX);
            carry = value >> DIGIT;
        }
        *top += carry;
        self.pending = 0;
    }

    /// Adds another sum.
    pub(super) fn merge(&mut self, other: &Self) {
        if self.pending + other.pending + 1 >= MOST_PENDING {
            self.carry();
        }
        self.digits.iter_mut().zip(other.digits.iter()).for_each(|(digit, more)| *digit += more);
        // Digits whose carries are taken count like one addition.
        self.pending += other.pending + 1;
    }

    /// The sum in units of 2^[`UNIT`].
    pub(super) fn integer(&self) -> Integer {
        let mut sum = self.clone();
        sum.carry();
        let negative = sum.digits[DIGITS - 1] < 0;
        if negative {
            sum.digits.iter_mut().for_each(|digit| *digit = -*digit);
            sum.carry();
        }
        Integer { negative, size: Natural::new(sum.digits.iter().map(|digit| *digit as u32).collect()) }
    }

    /// The sum as text: a sign, the place of the lowest digit that is not zero, and digits from the highest one, in hexadecimal.
    pub(super) fn text(&self) -> String {
        let Integer { negative, size } = self.integer();
        let digits = size.digits();
        let low = digits.iter().position(|digit| *digit != 0).unwrap_or(0);
        let mut text = format!("{}{low}:", if negative { "-" } else { "+" });
        for digit in digits[low..].iter().rev() {
            let _ = write!(text, "{digit:08x}");
        }
        text
    }

    /// Reads what [`text`](Self::text) wrote.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let sign = if text.starts_with('-') { -1 } else { 1 };
        let (low, digits) = text.strip_prefix(['+', '-'])?.split_once(':')?;
        let low: usize = low.parse().ok()?;
        let mut sum = Self::default();
        let count = digits.len() / 8;
        if !digits.is_ascii() || !digits.len().is_multiple_of(8) || low.checked_add(count)? > DIGITS {
            return None;
        }
        for (place, digit) in digits.as_bytes().chunks(8).rev().enumerate() {
            let digit = u32::from_str_radix(std::str::from_utf8(digit).ok()?, 16).ok()?;
            sum.digits[low + place] = sign * i64::from(digit);
        }
        sum.carry();
        Some(sum)
    }
}

impl PartialEq for ExactSum {
    fn eq(&self, other: &Self) -> bool {
        self.integer() == other.integer()
    }
}

#[cfg(test)]
mod tests {
    use num_bigint::BigInt;

    use super::*;
    use crate::sweep::random::Philox;

    /// The exact value in units of 2^UNIT, by a library for large integers.
    fn unbounded(x: f64) -> BigInt {
        let bits = x.to_bits();
        let (exponent, fraction) = ((bits >> 52 & 0x7ff) as i64, bits & ((1 << 52) - 1));
        let (whole, exponent) = if exponent == 0 { (fraction, 1) } else { (fraction + (1 << 52), exponent) };
        let sign = if x.is_sign_negative() { -1 } else { 1 };
        (BigInt::from(whole) * sign) << (exponent - 1075 - i64::from(UNIT)) as usize
    }

    fn big(sum: &ExactSum) -> BigInt {
        let Integer { negative, size } = sum.integer();
        let sign = if negative { num_bigint::Sign::Minus } else { num_bigint::Sign::Plus };
        BigInt::from_slice(sign, size.digits())
    }

    /// A finite double of any size and sign.
    fn any(random: &Philox, index: u64) -> f64 {
        let x = f64::from_bits(random.bits(index, 0));
        if x.is_finite() { x } else { f64::MAX }
    }

    #[test]
    fn sums_and_products_are_those_of_unbounded_integers() {
        let random = Philox::new(3);
        let (mut sum, mut products) = (ExactSum::default(), ExactSum::default());
        let (mut expected, mut expected_products) = (BigInt::from(0), BigInt::from(0));
        let special = [0.0, -0.0, 5e-324, -5e-324, f64::MIN_POSITIVE, f64::MAX, f64::MIN, 1.0, -1.0];
        for k in 0..3000 {
            let pick = |index| special.get(index as usize).copied().unwrap_or_else(|| any(&random, index));
            let (x, y) = (pick(k), pick(k.wrapping_mul(7) % 3000));
            sum.add(Parts::of(x));
            products.add_product(Parts::of(x), Parts::of(y));
            expected += unbounded(x);
            expected_products += (unbounded(x) * unbounded(y)) >> (-UNIT) as usize;
        }
        assert_eq!(big(&sum), expected);
        assert_eq!(big(&products), expected_products);
    }

    #[test]
    fn every_order_and_every_sharing_has_the_same_digits() {
        let random = Philox::new(4);
        let values: Vec<f64> = (0..900).map(|k| any(&random, k)).collect();
        let mut forwards = ExactSum::default();
        values.iter().for_each(|x| forwards.add(Parts::of(*x)));
        let mut backwards = ExactSum::default();
        values.iter().rev().for_each(|x| backwards.add(Parts::of(*x)));
        let mut shared = ExactSum::default();
        for part in values.chunks(37).rev() {
            let mut own = ExactSum::default();
            part.iter().for_each(|x| own.add(Parts::of(*x)));
            shared.merge(&own);
        }
        assert_eq!(forwards.text(), backwards.text());
        assert_eq!(forwards.text(), shared.text());
        // Doubles do not: the test would not notice otherwise.
        let (a, b): (f64, f64) = ([1e16, 1.0, -1e16].iter().sum(), [1e16, -1e16, 1.0].iter().sum());
        assert_ne!(a, b);
    }

    #[test]
    fn carries_that_wait_do_not_overflow() {
        let mut sum = ExactSum { pending: MOST_PENDING - 3, ..ExactSum::default() };
        (0..10).for_each(|_| sum.add(Parts::of(f64::MAX)));
        assert!(sum.pending < 10);
        let mut both = ExactSum { pending: MOST_PENDING - 1, ..ExactSum::default() };
        both.merge(&sum);
        both.merge(&sum);
        assert_eq!(big(&both), unbounded(f64::MAX) * 20);
        assert_eq!(big(&sum), unbounded(f64::MAX) * 10);
    }

    #[test]
    fn texts_are_read_again() {
        for values in [&[][..], &[0.0], &[1.5], &[-1.5], &[5e-324, 1e300, -3.0], &[-f64::MAX, -f64::MAX]] {
            let mut sum = ExactSum::default();
            values.iter().for_each(|x| sum.add(Parts::of(*x)));
            let read = ExactSum::parse(&sum.text()).unwrap();
            assert_eq!((big(&read), read.text()), (big(&sum), sum.text()));
        }
        for text in ["", "5:00000000", "+x:00000000", "+0:0", "+135:0000000100000000", "+0:0000000g"] {
            assert!(ExactSum::parse(text).is_none(), "{text}");
        }
    }
}
