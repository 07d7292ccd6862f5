//! Published decimal numbers, turned into [`Real::from_parts`](crate::Real::from_parts)'s form at compile time.

use crate::numbers::real::Real;

/// A number as a sum of two scaled integers, for [`Real::from_parts`](crate::Real::from_parts).
pub(crate) type Parts = [(i64, i32); 2];

/// A row of published numbers in the real `R`.
pub(crate) fn reals<R: Real, const M: usize>(parts: &[Parts; M]) -> [R; M] {
    let mut all = [R::zero(); M];
    for (real, parts) in all.iter_mut().zip(parts) {
        *real = R::from_parts(parts);
    }
    all
}

/// Bits of the leading part: the precision of `f64`, so that an `f64` is the decimal rounded once.
const LEADING: u32 = 53;
/// Bits of the second part.
const REST: u32 = 62;

/// The decimal `text`, such as `-1.25e-2`, to 115 bits, more than 34 digits: the leading part rounded to nearest,
/// the second the truncated rest.
///
/// At most 36 digits, and no more than 36 places after the point once the exponent is applied, so that the
/// ratio of integers fits `u128` with room for doubling.
pub(crate) const fn decimal(text: &str) -> Parts {
    let (negative, digits, places) = read(text.as_bytes());
    assert!(places >= 0 && places <= 36, "a decimal outside the range of this reader");
    let mut denominator = 1_u128;
    let mut place = 0;
    while place < places {
        denominator *= 10;
        place += 1;
    }
    if digits == 0 {
        return [(0, 0), (0, 0)];
    }
    // Long division in binary: quotient 2^-shift, until it has all the bits wanted.
    let mut quotient = digits / denominator;
    let mut remainder = digits % denominator;
    let mut shift = 0;
    while quotient < 1 << (LEADING + REST - 1) {
        remainder *= 2;
        quotient = quotient * 2 + remainder / denominator;
        remainder %= denominator;
        shift += 1;
    }
    let mut leading = (quotient >> REST) as i64;
    let mut rest = (quotient & ((1 << REST) - 1)) as i64;
    if rest >= 1 << (REST - 1) {
        leading += 1;
        rest -= 1 << REST;
    }
    if negative {
        leading = -leading;
        rest = -rest;
    }
    [(leading, REST as i32 - shift), (rest, -shift)]
}

/// Reads a literal: returns its sign, its digits as an integer, and how many of them stand after the point.
const fn read(text: &[u8]) -> (bool, u128, i32) {
    let negative = text[0] == b'-';
    let mut at = if negative { 1 } else { 0 };
    let mut digits = 0_u128;
    let mut places = 0;
    let mut after_point = 0;
    while at < text.len() && text[at] != b'e' {
        if text[at] == b'.' {
            after_point = 1;
        } else {
            assert!(text[at].is_ascii_digit(), "a decimal has digits, a point and an exponent");
            digits = digits * 10 + (text[at] - b'0') as u128;
            places += after_point;
        }
        at += 1;
    }
    if at < text.len() {
        let below_one = text[at + 1] == b'-';
        at += if below_one { 2 } else { 1 };
        let mut exponent = 0;
        while at < text.len() {
            assert!(text[at].is_ascii_digit(), "an exponent has digits");
            exponent = exponent * 10 + (text[at] - b'0') as i32;
            at += 1;
        }
        places += if below_one { exponent } else { -exponent };
    }
    assert!(digits < 1_u128 << 120, "a decimal with too many digits for this reader");
    (negative, digits, places)
}

#[cfg(test)]
mod tests {
    use super::decimal;
    use crate::numbers::real::Real;

    #[test]
    fn decimals_are_read_as_the_language_reads_them() {
        for text in ["0.1", "-43.4898841810699588477366255144", "1.0", "0.0", "-1.7578125e-2", "2.5e1", "3"] {
            let expected: f64 = text.parse().unwrap();
            assert_eq!(f64::from_parts(&decimal(text)), expected, "{text}");
        }
    }

    #[test]
    fn the_rest_continues_the_leading_part() {
        // 0.1 is 0x1.999...p-4, so 53 bits round it up, and the rest is negative.
        let [(leading, e), (rest, f)] = decimal("0.1");
        assert_eq!((leading, e), (0x19_9999_9999_999a, -56));
        assert!(rest < 0);
        let tenfold = 10 * ((i128::from(leading) << (e - f)) + i128::from(rest));
        let error = (1_i128 << -f) - tenfold;
        assert!((0..10).contains(&error), "{error}");
    }
}
