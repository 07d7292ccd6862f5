//! Natural numbers without a bound, for the few divisions at the end of exact statistics; and the double nearest to a quotient.

/// A natural number: digits in base 2^32, the lowest first, the highest not zero.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Natural(Vec<u32>);

/// A number with a sign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Integer {
    pub(super) negative: bool,
    pub(super) size: Natural,
}

impl Natural {
    pub(super) fn new(mut digits: Vec<u32>) -> Self {
        while digits.last() == Some(&0) {
            digits.pop();
        }
        Self(digits)
    }

    pub(super) fn digits(&self) -> &[u32] {
        &self.0
    }

    fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    fn bits(&self) -> i32 {
        self.0.last().map_or(0, |top| 32 * self.0.len() as i32 - top.leading_zeros() as i32)
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = vec![0_u32; self.0.len() + other.0.len()];
        for (i, a) in self.0.iter().enumerate() {
            let mut carry = 0_u64;
            for (digit, b) in product[i..].iter_mut().zip(other.0.iter().chain(std::iter::repeat(&0))) {
                let sum = u64::from(*a) * u64::from(*b) + u64::from(*digit) + carry;
                *digit = sum as u32;
                carry = sum >> 32;
            }
        }
        Self::new(product)
    }

    /// The number times 2^32 to a power.
    fn shifted(&self, digits: usize) -> Self {
        Self::new(std::iter::repeat_n(0, digits).chain(self.0.iter().copied()).collect())
    }

    /// The number less a smaller one.
    fn minus(&self, other: &Self) -> Self {
        let mut borrow = false;
        let others = other.0.iter().copied().chain(std::iter::repeat(0));
        let digits = self.0.iter().zip(others).map(|(a, b)| {
            let (difference, first) = a.overflowing_sub(b);
            let (difference, second) = difference.overflowing_sub(u32::from(borrow));
            borrow = first || second;
            difference
        });
        Self::new(digits.collect())
    }

    fn is_less(&self, other: &Self) -> bool {
        self.0.len().cmp(&other.0.len()).then_with(|| self.0.iter().rev().cmp(other.0.iter().rev())).is_lt()
    }

    /// The whole quotient, and whether there is a remainder.
    fn over(&self, divisor: u64) -> (Self, bool) {
        let mut rest = 0_u128;
        let mut quotient = vec![0; self.0.len()];
        for (place, digit) in self.0.iter().enumerate().rev() {
            let part = rest << 32 | u128::from(*digit);
            // Below 2^32, as the rest is below the divisor.
            quotient[place] = (part / u128::from(divisor)) as u32;
            rest = part % u128::from(divisor);
        }
        (Self::new(quotient), rest != 0)
    }

    /// The 32 bits above a place, and whether one below it is set.
    fn bit(&self, place: i32) -> bool {
        place >= 0 && self.0.get(place as usize / 32).is_some_and(|digit| digit >> (place % 32) & 1 == 1)
    }

    /// The double nearest to the number times a power of two, half of a unit to the even one; `more` says that the number is a bit
    /// larger than its digits say.
    fn nearest(&self, exponent: i32, more: bool) -> f64 {
        const PRECISION: i32 = 53;
        if self.is_zero() {
            return 0.0;
        }
        let top = self.bits() - 1 + exponent;
        // The exponent of the last bit of the double.
        let last = (top - PRECISION + 1).max(-1074);
        let dropped = last - exponent;
        let whole = (0..PRECISION).fold(0_u64, |sum, k| sum | u64::from(self.bit(dropped + k)) << k);
        let half = self.bit(dropped - 1);
        let below = more || (0..dropped - 1).any(|place| self.bit(place));
        let up = half && (below || whole & 1 == 1);
        scaled((whole + u64::from(up)) as f64, last)
    }
}

/// A whole number below 2^54 times a power of two; infinite where there is no such double.
fn scaled(whole: f64, exponent: i32) -> f64 {
    let power = |exponent: i32| f64::from_bits(((exponent + 1023) as u64) << 52);
    if exponent > 1000 {
        return f64::INFINITY;
    }
    let first = exponent / 2;
    whole * power(first) * power(exponent - first)
}

impl Integer {
    pub(super) fn times(&self, other: &Self) -> Self {
        Self { negative: self.negative != other.negative, size: self.size.times(&other.size) }
    }

    pub(super) fn times_count(&self, count: u64) -> Self {
        let size = self.size.times(&Natural::new(vec![count as u32, (count >> 32) as u32]));
        Self { negative: self.negative, size }
    }

    /// The number times 2^32 to a power.
    pub(super) fn shifted(&self, digits: usize) -> Self {
        Self { negative: self.negative, size: self.size.shifted(digits) }
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        let (a, b) = (&self.size, &other.size);
        if self.negative != other.negative {
            // a + b, as a - (-b): by digits.
            let mut carry = 0_u64;
            let length = a.0.len().max(b.0.len()) + 1;
            let digit = |of: &Natural, place: usize| u64::from(of.0.get(place).copied().unwrap_or(0));
            let sum = (0..length).map(|place| {
                let sum = digit(a, place) + digit(b, place) + carry;
                carry = sum >> 32;
                sum as u32
            });
            return Self { negative: self.negative, size: Natural::new(sum.collect()) };
        }
        if a.is_less(b) {
            Self { negative: !self.negative, size: b.minus(a) }
        } else {
            Self { negative: self.negative, size: a.minus(b) }
        }
    }

    /// The double nearest to the number times a power of two, divided by counts one after the other.
    pub(super) fn quotient(&self, exponent: i32, divisors: &[u64]) -> f64 {
        /// Digits that leave every quotient more bits than a double has.
        const ROOM: usize = 6;
        let mut size = self.size.shifted(ROOM);
        let mut more = false;
        for divisor in divisors {
            let (quotient, rest) = size.over(*divisor);
            (size, more) = (quotient, more || rest);
        }
        let nearest = size.nearest(exponent - 32 * ROOM as i32, more);
        if self.negative { -nearest } else { nearest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integer(value: i128) -> Integer {
        let size = value.unsigned_abs();
        let digits = (0..4).map(|place| (size >> (32 * place)) as u32).collect();
        Integer { negative: value < 0, size: Natural::new(digits) }
    }

    #[test]
    fn arithmetic_is_that_of_integers() {
        let values = [0, 1, -1, 5, -77, 1 << 32, -(1 << 40), 0xffff_ffff_ffff, -0x1234_5678_9abc];
        for a in values {
            for b in values {
                assert_eq!(integer(a).minus(&integer(b)).size, integer(a - b).size, "{a} - {b}");
                assert_eq!(integer(a).times(&integer(b)).size, integer(a * b).size, "{a} * {b}");
                if a != b {
                    assert_eq!(integer(a).minus(&integer(b)).negative, a < b, "{a} - {b}");
                }
            }
            assert_eq!(integer(a).times_count(u64::from(u32::MAX) + 7).size, integer(a * 0x1_0000_0006).size);
            assert_eq!(integer(a).shifted(1).size, integer(a << 32).size);
        }
    }

    #[test]
    fn quotients_are_the_nearest_doubles() {
        // A cast rounds to nearest, half to even; so does a division of doubles.
        for value in [1_i128, -3, (1 << 53) + 1, (1 << 53) + 3, (1 << 54) + 2, (1 << 100) + 1, i128::MAX] {
            assert_eq!(integer(value).quotient(0, &[1]), value as f64, "{value}");
            assert_eq!(integer(value).quotient(-1080, &[1]).to_bits(), exact_small(value), "{value}");
        }
        for (a, b) in [(1_i64, 3_u64), (-2, 3), (355, 113), (1 << 52, 7), (-9_007_199_254_740_991, 10)] {
            assert_eq!(integer(a.into()).quotient(0, &[b]), a as f64 / b as f64);
            assert_eq!(integer(a.into()).quotient(0, &[b, 4]), a as f64 / b as f64 / 4.0);
        }
        assert_eq!(integer(1).quotient(-1075, &[1]), 0.0);
        assert_eq!(integer(3).quotient(-1076, &[1]), 5e-324);
        assert_eq!(integer(1).quotient(1023, &[1]), f64::from_bits(0x7fe0_0000_0000_0000));
        assert_eq!(integer(1).quotient(1024, &[1]), f64::INFINITY);
        assert_eq!(integer(-1).quotient(5000, &[1]), f64::NEG_INFINITY);
        assert_eq!(integer(0).quotient(5000, &[9]), 0.0);
    }

    /// `value * 2^-1080` to the nearest double, by integers of 128 bits.
    fn exact_small(value: i128) -> u64 {
        let (sign, size) = (u64::from(value < 0) << 63, value.unsigned_abs());
        let top = 127 - size.leading_zeros() as i32;
        // The place of the last bit: of a subnormal it is that of 2^-1074, six places up.
        let last = (top - 52).max(6);
        let (whole, rest, half) = (size >> last, size & ((1 << last) - 1), 1_u128 << (last - 1));
        let whole = whole + u128::from(rest > half || rest == half && whole & 1 == 1);
        let subnormal = top - 1080 < -1022;
        let exponent = if subnormal { 0 } else { (last - 1080 + 1075 - 1) as u64 };
        sign | ((exponent << 52) + whole as u64)
    }
}
