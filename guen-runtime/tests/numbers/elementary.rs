//! The errors of the elementary functions, measured against 71 digits.
//!
//! ```text
//! cargo test --release -p guen-runtime --test numbers elementary -- --include-ignored --nocapture     # all, printed
//! ```

use f256::f256;
use guen_runtime::Real;

/// A linear congruential generator's upper bits: the tests draw the same numbers in every run.
fn draws() -> impl Iterator<Item = u64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    std::iter::repeat_with(move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state >> 11
    })
}

/// Numbers of either sign up to a limit, evenly.
fn even(limit: f64) -> impl Iterator<Item = f64> {
    draws().map(move |draw| (draw as f64 / (1_u64 << 52) as f64 - 1.0) * limit)
}

/// Numbers between two positive ones, evenly in their exponents, of either sign.
fn logarithmic(low: f64, high: f64) -> impl Iterator<Item = f64> {
    let span = high.log2() - low.log2();
    draws().map(move |draw| {
        let part = (draw >> 1) as f64 / (1_u64 << 52) as f64;
        let size = (low.log2() + span * part).exp2();
        if draw & 1 == 1 { -size } else { size }
    })
}

/// The two numbers around each multiple of `pi/2`.
fn near_multiples(range: impl Iterator<Item = u32>) -> impl Iterator<Item = f64> {
    range.flat_map(|n| {
        let multiple = f256::from(n) * ::f256::consts::PI / f256::TWO;
        let nearest = f64::from(n) * std::f64::consts::FRAC_PI_2;
        let other = if f256::from(nearest) < multiple { nearest.next_up() } else { nearest.next_down() };
        [nearest, other]
    })
}

/// The distance to the next number, at the size of a reference.
fn ulp(reference: f64) -> f64 {
    let size = reference.abs();
    size.next_up() - size
}

fn error(got: f64, exact: f256) -> f64 {
    let rounded = nearest(exact);
    // The difference has few digits, and those are kept.
    nearest(f256::from(got) - exact).abs() / ulp(rounded)
}

/// The leading 64 bits of binary256: sign, 19 bits of exponent, and the fraction.
fn nearest(x: f256) -> f64 {
    let (high, _) = x.to_bits();
    let exponent = (high >> 108) as i32 & 0x7_ffff;
    let leading = 1_u64 << 63 | (high << 20 >> 65) as u64;
    let size = if exponent == 0 { 0.0 } else { leading as f64 * f64::from(exponent - 262_143 - 63).exp2() };
    if high >> 127 == 1 { -size } else { size }
}

/// The largest errors of sine and cosine, in ulp.
fn largest(arguments: impl Iterator<Item = f64>) -> [(f64, f64); 2] {
    let mut worst = [(0.0, 0.0); 2];
    for x in arguments {
        let (sin, cos) = Real::sin_cos(x);
        let (exact_sin, exact_cos) = f256::from(x).sin_cos();
        for (worst, (got, exact)) in worst.iter_mut().zip([(sin, exact_sin), (cos, exact_cos)]) {
            let error = error(got, exact);
            if error > worst.0 {
                *worst = (error, x);
            }
        }
    }
    worst
}

/// What the accurate sine and cosine promise.
const PROMISED: f64 = 0.8;
/// Where the straight line ends.
const RANGE: f64 = 262_144.0;

/// Prints the largest errors, and refuses more than is promised.
fn check(what: &str, arguments: impl Iterator<Item = f64>) {
    let [sin, cos] = largest(arguments);
    println!("{what:<36} sin {:.3} ulp at {:e}, cos {:.3} ulp at {:e}", sin.0, sin.1, cos.0, cos.1);
    assert!(sin.0 < PROMISED && cos.0 < PROMISED);
}

/// The kinds of arguments, so many of each; of the multiples of `pi/2` one in so many.
fn check_all(count: usize, stride: usize) {
    check("evenly in one turn", even(3.2).take(count));
    check("evenly in the range", even(RANGE).take(count));
    // Far below the reference itself is no longer exact: it reduces in fixed point.
    check("logarithmically below", logarithmic(1e-120, RANGE).take(count));
    check("logarithmically beyond", logarithmic(RANGE, f64::MAX / 2.0).take(count));
    check("next to multiples of pi/2", near_multiples((1..166_887).step_by(stride)));
    check("next to multiples beyond the range", near_multiples((166_887..1_000_000).step_by(7 * stride)));
}

#[test]
fn sine_and_cosine_to_four_fifths_of_an_ulp() {
    check_all(2000, 101);
    // The nearest that doubles come to multiples of pi/2: J.-M. Muller, Elementary Functions, gives the last one.
    let nearest = [1.831077278144811e5, 2.2917447169039503e5, 4.1344144719405076e5, 5.319372648326541e255];
    check("nearest to multiples of pi/2", nearest.into_iter());
    let ends = [RANGE, -RANGE, RANGE.next_up(), RANGE.next_down(), f64::MAX, -f64::MAX];
    check("both ends", ends.into_iter());
}

#[test]
#[ignore = "ten seconds in a release build, in which `.ci/run` runs it"]
fn sine_and_cosine_of_many_more() {
    check_all(500_000, 1);
}

#[test]
fn zeros_keep_their_sign_and_what_is_not_finite_has_no_sine() {
    assert_eq!(Real::sin_cos(0.0_f64), (0.0, 1.0));
    assert!(Real::sin(0.0_f64).is_sign_positive() && Real::sin(-0.0_f64).is_sign_negative());
    assert_eq!(Real::sin(5e-324_f64), 5e-324);
    assert_eq!(Real::sin(f64::MIN_POSITIVE), f64::MIN_POSITIVE);
    for x in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let (sin, cos) = Real::sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan(), "{x}");
    }
}

#[test]
fn sine_is_odd_and_cosine_is_even_to_the_bit() {
    for x in logarithmic(1e-300, 1e300).take(20_000) {
        let ((sin, cos), (mirrored, same)) = (Real::sin_cos(x), Real::sin_cos(-x));
        assert_eq!((sin, cos), (-mirrored, same), "{x}");
    }
}

#[test]
fn single_precision_is_rounded_once_more() {
    for x in logarithmic(1e-30, 1e30).take(20_000).map(|x| x as f32) {
        let (sin, cos) = Real::sin_cos(x);
        let exact = Real::sin_cos(f64::from(x));
        assert_eq!((sin, cos), (exact.0 as f32, exact.1 as f32));
    }
}

#[test]
fn a_lone_sine_or_cosine_has_the_bits_of_the_pair() {
    let special =
        [0.0, -0.0, RANGE, -RANGE, RANGE.next_up(), f64::NAN, f64::INFINITY, f64::MIN_POSITIVE, 5e-324];
    let drawn = even(10.0).take(20_000).chain(logarithmic(1e-300, 1e300).take(20_000));
    for x in drawn.chain(near_multiples((1..2000).step_by(7))).chain(special) {
        let (sin, cos) = Real::sin_cos(x);
        // NaN has many patterns of bits: any of them will do.
        let same = |alone: f64, paired: f64| {
            alone.to_bits() == paired.to_bits() || (alone.is_nan() && paired.is_nan())
        };
        assert!(same(Real::sin(x), sin) && same(Real::cos(x), cos), "{x:e}");
        let single = x as f32;
        let (sin, cos) = Real::sin_cos(single);
        assert!(
            same(Real::sin(single).into(), sin.into()) && same(Real::cos(single).into(), cos.into()),
            "{x:e}"
        );
    }
}

#[test]
fn two_angles_at_once_give_the_bits_of_each() {
    let bits = |(sin, cos): (f64, f64)| [sin.to_bits(), cos.to_bits()];
    // Of every two neighbours one may be out of range.
    for (x, y) in logarithmic(1e-300, 1e9).zip(even(1e6)).take(20_000) {
        let (first, second) = f64::sin_cos_pair(x, y);
        assert_eq!((bits(first), bits(second)), (bits(Real::sin_cos(x)), bits(Real::sin_cos(y))), "{x} {y}");
        let (x, y) = (x as f32, y as f32);
        assert_eq!(f32::sin_cos_pair(x, y), (Real::sin_cos(x), Real::sin_cos(y)));
    }
    let ((sin, _), (other, _)) = f64::sin_cos_pair(f64::NAN, -0.0);
    assert!(sin.is_nan() && other == 0.0 && other.is_sign_negative());
}
