//! Marks of axes, and their labels.

/// A mark on an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    pub value: f64,
    pub label: String,
}

/// Decimal exponents of the largest mark for which marks are written without an exponent.
const PLAIN: std::ops::RangeInclusive<i32> = -4..=5;

/// Returns at most `most` marks from `low` to `high`, at multiples of 1, 2 or 5 times a power of ten, all with the same
/// count of decimals. None if the range is empty.
pub(super) fn ticks(low: f64, high: f64, most: usize) -> Vec<Tick> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return Vec::new();
    }
    let least = span / most.max(1) as f64;
    // Of the least numbers the part is zero.
    let mut power = (least.log10().floor() as i32).max(f64::MIN_10_EXP - f64::DIGITS as i32 - 2);
    let mut digit = 1;
    loop {
        let found = multiples(low, high, digit, power);
        if let Some(found) = found.filter(|found| found.len() <= most) {
            return labelled(&found, power);
        }
        (digit, power) = match digit {
            1 => (2, power),
            2 => (5, power),
            _ => (1, power + 1),
        };
        // A step beyond the range leaves at most the zero, so the loop ends well before this.
        if power > f64::MAX_10_EXP {
            return Vec::new();
        }
    }
}

/// Returns at most `most` marks at powers of ten between `10^low` and `10^high`: every one of them, every second, third and so on;
/// where there are fewer than two, numbers in between as well.
pub(super) fn decades(low: f64, high: f64, most: usize) -> Vec<Tick> {
    /// Roundings within which an end of the range is a power of ten.
    const SLACK: f64 = 1e-9;
    let (first, last) = ((low - SLACK).ceil() as i32, (high + SLACK).floor() as i32);
    if last - first < 1 {
        // A mark of the values themselves, where it is positive and within the range.
        let (from, to) = (10_f64.powf(low), 10_f64.powf(high));
        return ticks(from, to, most).into_iter().filter(|tick| tick.value > 0.0).collect();
    }
    let every = (1..).find(|every| ((last - first) / every + 1) as usize <= most.max(1)).unwrap_or(1);
    let marked = (first..=last).filter(|power| power.rem_euclid(every) == 0);
    let label = |power: i32| match power {
        0 => "1".to_owned(),
        1 => "10".to_owned(),
        _ => format!("10{}", superscript(power)),
    };
    // An axis with room around it may reach beyond all numbers.
    let marks = marked.map(|power| Tick { value: 10_f64.powi(power), label: label(power) });
    marks.filter(|tick| tick.value.is_finite() && tick.value > 0.0).collect()
}

/// The multiples of `digit * 10^power` in the range; `None` if they are far too many.
fn multiples(low: f64, high: f64, digit: u8, power: i32) -> Option<Vec<f64>> {
    const FAR_TOO_MANY: f64 = 1000.0;
    /// Roundings within which an end of the range is a multiple.
    const SLACK: f64 = 1e-9;
    let step = format!("{digit}e{power}").parse::<f64>().ok()?;
    let (first, last) = ((low / step - SLACK).ceil(), (high / step + SLACK).floor());
    let count = last - first + 1.0;
    if count.is_nan() || count > FAR_TOO_MANY {
        return None;
    }
    let count = count.max(0.0) as usize;
    // Zero is written without a sign.
    Some((0..count).map(|k| (first + k as f64) * step + 0.0).collect())
}

/// Marks at multiples of `10^power`.
fn labelled(values: &[f64], power: i32) -> Vec<Tick> {
    let largest = values.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
    let exponent = if largest > 0.0 { (largest.log10() + 1e-9).floor() as i32 } else { 0 };
    let label = |value: f64| {
        if PLAIN.contains(&exponent) {
            // Zero alone has no digits to be told apart by.
            let decimals = if largest > 0.0 { (-power).max(0) as usize } else { 0 };
            format!("{value:.decimals$}")
        } else if value == 0.0 {
            "0".to_owned()
        } else {
            let decimals = (exponent - power).max(0) as usize;
            // In two steps, for a power of ten may be out of range where the quotient is not.
            let half = exponent / 2;
            let mantissa = value / 10_f64.powi(half) / 10_f64.powi(exponent - half);
            format!("{mantissa:.decimals$}×10{}", superscript(exponent))
        }
    };
    let tick = |&value: &f64| Tick { value, label: label(value).replace('-', "−") };
    values.iter().map(tick).collect()
}

fn superscript(number: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| c.to_digit(10).map_or('⁻', |digit| DIGITS[digit as usize]);
    number.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, most: usize) -> Vec<String> {
        ticks(low, high, most).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn the_ends_of_all_numbers_have_marks_or_none() {
        for (low, high) in [(0.0, 5e-324), (5e-324, 2e-323), (-1e-323, 1e-323), (1.7e308, f64::MAX)] {
            assert!(ticks(low, high, 6).len() <= 6, "{low:e} {high:e}");
        }
        for (low, high) in
            [(261.0, 319.0), (-339.0, -300.0), (-2000.0, 2000.0), (-323.8, -322.8), (307.9, 308.9)]
        {
            let marks = decades(low, high, 6);
            assert!(marks.len() <= 6 && marks.iter().all(|tick| tick.value > 0.0 && tick.value.is_finite()));
        }
    }

    #[test]
    fn steps_are_round() {
        assert_eq!(labels(0.0, 10.0, 6), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(-0.33, 0.71, 6), ["−0.2", "0.0", "0.2", "0.4", "0.6"]);
        assert_eq!(labels(9.8, 9.83, 4), ["9.80", "9.81", "9.82", "9.83"]);
        assert_eq!(labels(0.0, 120_000.0, 4), ["0", "50000", "100000"]);
    }

    #[test]
    fn large_and_small_numbers_have_exponents() {
        assert_eq!(labels(-3e-13, 1.2e-12, 4), ["0", "0.5×10⁻¹²", "1.0×10⁻¹²"]);
        assert_eq!(labels(-4e6, 4e6, 5), ["−4×10⁶", "−2×10⁶", "0", "2×10⁶", "4×10⁶"]);
        assert_eq!(labels(-1e-14, 6e-14, 1), ["0"]);
        assert_eq!(labels(-2e-320, 2e-320, 3), ["−2×10⁻³²⁰", "0", "2×10⁻³²⁰"]);
    }

    #[test]
    fn powers_of_ten_are_marked() {
        let labels = |low, high, most| -> Vec<String> {
            decades(low, high, most).into_iter().map(|tick| tick.label).collect()
        };
        assert_eq!(labels(-2.3, 2.0, 9), ["10⁻²", "10⁻¹", "1", "10", "10²"]);
        assert_eq!(labels(-13.0, -1.0, 5), ["10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³"]);
        assert_eq!(labels(0.1, 0.5, 4), ["1.5", "2.0", "2.5", "3.0"]);
    }

    #[test]
    fn never_more_than_asked_and_always_inside() {
        for most in 1..12 {
            for exponent in -300..300 {
                let (low, high) = (-1.7 * 10_f64.powi(exponent), 4.9 * 10_f64.powi(exponent));
                let found = ticks(low, high, most);
                assert!(found.len() <= most, "{most} {exponent}");
                assert!(found.len() * 3 + 1 >= most, "{most} {exponent}: {}", found.len());
                assert!(found.iter().all(|tick| tick.value >= low && tick.value <= high));
            }
        }
        assert_eq!(ticks(1.0, 1.0, 5), []);
        assert_eq!(ticks(0.0, f64::INFINITY, 5), []);
    }
}
