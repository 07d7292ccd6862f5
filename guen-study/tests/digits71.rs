//! The long real against values that another program computed: `tests/data/digits71.py` says which and how.
//!
//! ```text
//! cargo test -p guen-study --features study --test digits71 -- --nocapture     # prints the largest errors
//! ```

#![cfg(feature = "study")]

use std::collections::BTreeMap;

use guen_runtime::Real;
use guen_study::Digits71;

/// The bound on every relative error: 30 digits were asked for, and 69 are there.
const BOUND: f64 = 1e-69;

/// A sum of `mantissa:exponent`, exactly.
fn argument(text: &str) -> Digits71 {
    let parts: Vec<(i64, i32)> = text
        .split(',')
        .map(|part| {
            let (mantissa, exponent) = part.split_once(':').expect("a mantissa and an exponent");
            (mantissa.parse().unwrap(), exponent.parse().unwrap())
        })
        .collect();
    Digits71::from_parts(&parts)
}

/// A decimal number, from its digits by integers alone: the crate's own reading of decimals is not relied upon.
fn decimal(text: &str) -> Digits71 {
    let (digits, exponent) = text.split_once('e').unwrap_or((text, "0"));
    let exponent: i32 = exponent.parse().unwrap();
    let negative = digits.starts_with('-');
    let ten = Digits71::from_ratio(10, 1);
    let mut sum = Digits71::zero();
    let mut count = 0;
    for digit in digits.chars().filter_map(|c| c.to_digit(10)) {
        sum = sum * ten + Digits71::from_ratio(i64::from(digit), 1);
        count += 1;
    }
    let power = exponent - (count - 1);
    let scale = ten.powi(power.abs());
    let value = if power < 0 { sum / scale } else { sum * scale };
    if negative { -value } else { value }
}

fn computed(name: &str, x: &[Digits71]) -> Digits71 {
    match name {
        "pi" => Digits71::pi(),
        "add" => x[0] + x[1],
        "subtract" => x[0] - x[1],
        "multiply" => x[0] * x[1],
        "divide" => x[0] / x[1],
        "atan2" => x[0].atan2(x[1]),
        "sqrt" => x[0].sqrt(),
        "root3" => x[0].root(3),
        "root5" => x[0].root(5),
        "exp" => x[0].exp(),
        "ln" => x[0].ln(),
        "sin" => x[0].sin(),
        "cos" => x[0].cos(),
        "tan" => x[0].tan(),
        "asin" => x[0].asin(),
        "acos" => x[0].acos(),
        "atan" => x[0].atan(),
        "sinh" => x[0].sinh(),
        "cosh" => x[0].cosh(),
        "tanh" => x[0].tanh(),
        _ => unreachable!("no function {name}"),
    }
}

#[test]
fn every_operation_and_function_has_69_digits() {
    let mut largest: BTreeMap<&str, (usize, f64)> = BTreeMap::new();
    for line in include_str!("data/digits71.txt").lines() {
        let (call, value) = line.split_once(" ; ").unwrap_or_else(|| line.split_once("; ").unwrap());
        let mut words = call.split_whitespace();
        let name = words.next().unwrap();
        let arguments: Vec<Digits71> = words.map(argument).collect();
        let expected = decimal(value);
        let error = ((computed(name, &arguments) - expected) / expected).abs().to_f64();
        let (count, size) = largest.entry(name).or_insert((0, 0.0));
        *count += 1;
        *size = if error.is_nan() { f64::INFINITY } else { size.max(error) };
    }
    assert_eq!(largest.len(), 20);
    for (name, (count, error)) in &largest {
        println!("{name:<9} {count:>3} values, largest relative error {error:.1e}");
        assert!(*error < BOUND, "{name}: {error:e}");
    }
}
