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
const LEADING_BITS: u32 = 53;
/// Bits of the second part.
const SECOND_BITS: u32 = 62;

/// The decimal `text`, such as `-1.25e-2`, to 115 bits, more than 34 digits: the leading part rounded to nearest,
/// the second the truncated rest.
///
/// At most 36 digits, and no more than 36 places after the point once the exponent is applied, so that the
/// ratio of integers fits `u128` with room for doubling.
pub(crate) const fn decimal(text: &str) -> Parts {
    let (negative, digits, places) = read(text.as_bytes());
    assert!(places >= 0 && places <= 36, "a decimal outside the range of this reader");
    if digits == 0 {
        return [(0, 0), (0, 0)];
    }
    let denominator = 10_u128.pow(places as u32);
    // Long division in binary: quotient 2^-shift, until it has all the bits wanted; as many bits at a time as the remainder has
    // room for, because every crate that names a coefficient evaluates this anew.
    let mut quotient = digits / denominator;
    let mut remainder = digits % denominator;
    let mut shift = 0;
    let mut missing = (LEADING_BITS + SECOND_BITS).saturating_sub(u128::BITS - quotient.leading_zeros());
    while missing > 0 {
        let room = denominator.leading_zeros();
        let bits = if missing < room { missing } else { room };
        remainder <<= bits;
        quotient = (quotient << bits) + remainder / denominator;
        remainder %= denominator;
        shift += bits as i32;
        missing = (LEADING_BITS + SECOND_BITS).saturating_sub(u128::BITS - quotient.leading_zeros());
    }
    let mut leading = (quotient >> SECOND_BITS) as i64;
    let mut rest = (quotient & ((1 << SECOND_BITS) - 1)) as i64;
    if rest >= 1 << (SECOND_BITS - 1) {
        leading += 1;
        rest -= 1 << SECOND_BITS;
    }
    if negative {
        leading = -leading;
        rest = -rest;
    }
    [(leading, SECOND_BITS as i32 - shift), (rest, -shift)]
}

/// Reads a literal: returns its sign, its digits as an integer, and how many of them stand after the point.
const fn read(mut text: &[u8]) -> (bool, u128, i32) {
    let negative = matches!(text, [b'-', ..]);
    if let [b'-', rest @ ..] = text {
        text = rest;
    }
    let mut digits = 0_u128;
    let mut places = 0;
    let mut after_point = 0;
    while let [byte, rest @ ..] = text {
        text = rest;
        match byte {
            b'0'..=b'9' => {
                digits = digits * 10 + (*byte - b'0') as u128;
                places += after_point;
            }
            b'.' => after_point = 1,
            b'e' => {
                places -= exponent(text);
                break;
            }
            _ => panic!("a decimal has digits, a point and an exponent"),
        }
    }
    assert!(digits < 1_u128 << 120, "a decimal with too many digits for this reader");
    (negative, digits, places)
}

/// Reads an exponent.
const fn exponent(mut text: &[u8]) -> i32 {
    let below_one = matches!(text, [b'-', ..]);
    if let [b'-' | b'+', rest @ ..] = text {
        text = rest;
    }
    let mut exponent = 0;
    while let [digit, rest @ ..] = text {
        assert!(digit.is_ascii_digit(), "an exponent has digits");
        exponent = exponent * 10 + (*digit - b'0') as i32;
        text = rest;
    }
    if below_one { -exponent } else { exponent }
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
