//! Numbers, exact: from the text of a literal to decimal digits and an exponent.

use std::fmt;

use crate::limits::{MAX_DECIMAL_ORDER, MAX_DIGITS};

/// A nonnegative decimal number, `digits * 10^exponent`, exactly as written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Number {
    /// Decimal digits without leading or trailing zeros; `0` for zero.
    pub digits: String,
    /// Power of ten; 0 for zero.
    pub exponent: i32,
    /// The literal as written, for messages and documentation.
    pub text: String,
}

/// The reason why the text of a literal is not a number of the language.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NumberProblem {
    /// A string, a character or the like.
    NotANumber,
    /// Hexadecimal, octal or binary.
    NotDecimal,
    /// Digits that run into letters: `2x`, `1.0f64`. The digits and the letters.
    Suffix(String, String),
    /// Greater than 10^400 or less than 10^-400.
    OutOfRange,
    /// More digits than [`MAX_DIGITS`].
    TooManyDigits,
}

impl Number {
    /// Reads the text of a Rust literal.
    pub fn from_literal(text: &str) -> Result<Number, NumberProblem> {
        let bytes = text.as_bytes();
        if !bytes.first().is_some_and(u8::is_ascii_digit) {
            return Err(NumberProblem::NotANumber);
        }
        if bytes[0] == b'0' && matches!(bytes.get(1), Some(b'x' | b'o' | b'b')) {
            return Err(NumberProblem::NotDecimal);
        }
        let digits_end = |from: usize| {
            bytes[from..]
                .iter()
                .position(|b| !b.is_ascii_digit() && *b != b'_')
                .map_or(bytes.len(), |n| from + n)
        };
        let mut end = digits_end(0);
        let mut digits: String = text[..end].replace('_', "");
        let mut fraction = 0i64;
        if bytes.get(end) == Some(&b'.') {
            let after = digits_end(end + 1);
            let places = text[end + 1..after].replace('_', "");
            fraction = places.len() as i64;
            digits.push_str(&places);
            end = after;
        }
        let mut exponent = 0i64;
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = matches!(bytes.get(end + 1), Some(b'+' | b'-'));
            let from = end + 1 + usize::from(sign);
            let after = digits_end(from);
            let value = text[from..after].replace('_', "");
            if !value.is_empty() {
                // More digits than an i64 holds are out of range in any case.
                let size: i64 = value.parse().unwrap_or(i64::MAX / 4).min(i64::MAX / 4);
                exponent = if bytes[end + 1] == b'-' { -size } else { size };
                end = after;
            }
        }
        if end < bytes.len() {
            return Err(NumberProblem::Suffix(text[..end].to_owned(), text[end..].to_owned()));
        }
        let significant = digits.trim_start_matches('0');
        let trimmed = significant.trim_end_matches('0');
        if trimmed.is_empty() {
            return Ok(Number { digits: "0".to_owned(), exponent: 0, text: text.to_owned() });
        }
        exponent = exponent - fraction + (significant.len() - trimmed.len()) as i64;
        let order = exponent + trimmed.len() as i64 - 1;
        let is_in_range = (-MAX_DECIMAL_ORDER..MAX_DECIMAL_ORDER).contains(&order)
            || (order == MAX_DECIMAL_ORDER && trimmed == "1");
        if !is_in_range {
            return Err(NumberProblem::OutOfRange);
        }
        if trimmed.len() > MAX_DIGITS {
            return Err(NumberProblem::TooManyDigits);
        }
        // Order and number of digits are small, hence so is the exponent.
        Ok(Number { digits: trimmed.to_owned(), exponent: exponent as i32, text: text.to_owned() })
    }

    /// Whether the number is zero.
    pub fn is_zero(&self) -> bool {
        self.digits == "0"
    }

    /// Whether the number is one.
    pub fn is_one(&self) -> bool {
        self.digits == "1" && self.exponent == 0
    }
}

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(text: &str) -> (String, i32) {
        let number = Number::from_literal(text).unwrap();
        (number.digits, number.exponent)
    }

    #[test]
    fn literals_are_exact() {
        for (text, digits, exponent) in [
            ("0", "0", 0),
            ("0.000", "0", 0),
            ("0e999999999999999999999", "0", 0),
            ("1", "1", 0),
            ("1.", "1", 0),
            ("120", "12", 1),
            ("0.1", "1", -1),
            ("9.81", "981", -2),
            ("1_000.5_0", "10005", -1),
            ("6.62607015e-34", "662607015", -42),
            ("1e400", "1", 400),
            ("1E+3", "1", 3),
            ("1e-400", "1", -400),
            ("9e-0_2", "9", -2),
        ] {
            assert_eq!(parts(text), (digits.to_owned(), exponent), "{text}");
        }
    }

    #[test]
    fn problems_are_told_apart() {
        use NumberProblem::*;
        let suffix = |digits: &str, letters: &str| Suffix(digits.to_owned(), letters.to_owned());
        for (text, problem) in [
            ("2x", suffix("2", "x")),
            ("2_x", suffix("2_", "x")),
            ("1.0f64", suffix("1.0", "f64")),
            ("2e", suffix("2", "e")),
            ("3é", suffix("3", "é")),
            ("0x10", NotDecimal),
            ("\"a\"", NotANumber),
            ("'a'", NotANumber),
            ("b'a'", NotANumber),
            ("1e401", OutOfRange),
            ("1.5e400", OutOfRange),
            ("1e-401", OutOfRange),
            ("1e99999999999999999999", OutOfRange),
            ("1e-99999999999999999999", OutOfRange),
        ] {
            assert_eq!(Number::from_literal(text), Err(problem), "{text}");
        }
        assert_eq!(Number::from_literal(&format!("0.{}", "7".repeat(501))), Err(TooManyDigits));
    }
}
