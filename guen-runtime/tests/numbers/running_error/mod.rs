//! `RunningError` is a bound: of each function for exact arguments, of ratios, and of programs.
//!
//! ```text
//! cargo test --release -p guen-runtime --test numbers running_error -- --include-ignored --nocapture     # ten million of each
//! ```

mod pair;

use f256::f256;
use guen_runtime::{Real, RunningError};
use pair::Pair;

/// Numbers between zero and one, the same in every run.
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Of either sign, half of them even in their exponents, half of them even.
    fn size(&mut self, least: f64, largest: f64) -> f64 {
        let part = self.next();
        let size = if self.next() < 0.5 { least * (largest / least).powf(part) } else { part * largest };
        if self.next() < 0.5 { -size } else { size }
    }
}

/// One function: its name, the range of its arguments (`least`, `largest`, only positive ones), and its meanings.
struct Function {
    name: &'static str,
    range: (f64, f64, bool),
    double: fn(RunningError<f64>, RunningError<f64>) -> RunningError<f64>,
    single: fn(RunningError<f32>, RunningError<f32>) -> RunningError<f32>,
    exact: fn(Pair, Pair) -> Pair,
    /// In 71 digits, to judge what judges.
    slow: fn(f256, f256) -> f256,
}

macro_rules! function {
    ($name:literal, $range:expr, |$x:ident, $y:ident| $value:expr, $exact:expr, $slow:expr) => {
        Function {
            name: $name,
            range: $range,
            double: |$x, $y| {
                let _ = $y;
                $value
            },
            single: |$x, $y| {
                let _ = $y;
                $value
            },
            exact: |$x, $y| {
                let _ = $y;
                $exact
            },
            slow: |$x, $y| {
                let _ = $y;
                $slow
            },
        }
    };
}

const FAR: (f64, f64, bool) = (1e-12, 1e5, false);
const UNIT: (f64, f64, bool) = (1e-12, 1.0, false);
const LARGE: (f64, f64, bool) = (1e-12, 80.0, false);
const POSITIVE: (f64, f64, bool) = (1e-30, 1e30, true);

#[rustfmt::skip]
fn functions() -> Vec<Function> {
    vec![
        function!("sin", FAR, |x, y| x.sin(), x.sin_cos().0, x.sin()),
        function!("cos", FAR, |x, y| x.cos(), x.sin_cos().1, x.cos()),
        function!("tan", FAR, |x, y| x.tan(), { let (s, c) = x.sin_cos(); s / c }, x.tan()),
        function!("cot", FAR, |x, y| x.cot(), { let (s, c) = x.sin_cos(); c / s }, f256::ONE / x.tan()),
        function!("asin", UNIT, |x, y| x.asin(), x.asin(), x.asin()),
        function!("acos", UNIT, |x, y| x.acos(), x.acos(), x.acos()),
        function!("atan", FAR, |x, y| x.atan(), x.atan2(1.0.into()), x.atan()),
        function!("atan2", FAR, |x, y| x.atan2(y), x.atan2(y), x.atan2(&y)),
        function!("sinh", LARGE, |x, y| x.sinh(), x.sinh(), (x.exp() - (-x).exp()) / f256::TWO),
        function!("cosh", LARGE, |x, y| x.cosh(), x.cosh(), (x.exp() + (-x).exp()) / f256::TWO),
        function!("tanh", LARGE, |x, y| x.tanh(), x.tanh(), (x.exp() - (-x).exp()) / (x.exp() + (-x).exp())),
        function!("exp", LARGE, |x, y| x.exp(), x.exp(), x.exp()),
        function!("ln", POSITIVE, |x, y| x.ln(), x.ln(), x.ln()),
        function!("sqrt", POSITIVE, |x, y| x.sqrt(), x.sqrt(), x.sqrt()),
        function!("cbrt", POSITIVE, |x, y| x.root(3), x.root(3), (x.ln() / f256::from(3)).exp()),
        function!("root of 5", POSITIVE, |x, y| x.root(5), x.root(5), (x.ln() / f256::from(5)).exp()),
        function!("x + y", POSITIVE, |x, y| x + y, x + y, x + y),
        function!("x - y", UNIT, |x, y| x - y, x - y, x - y),
        function!("x * y", UNIT, |x, y| x * y, x * y, x * y),
        function!("x / y", UNIT, |x, y| x / y, x / y, x / y),
        function!("1 / x", UNIT, |x, y| x.recip(), Pair::from(1.0) / x, f256::ONE / x),
    ]
}

/// The worst of what functions have wrong, as parts of their bounds, and in units of their values: in `f64` and `f32`.
fn worst(function: &Function, count: usize) -> [(f64, f64); 2] {
    let (least, largest, positive) = function.range;
    let mut draws = Draws(99);
    let mut worst = [(0.0_f64, 0.0_f64); 2];
    let mut judge = |place: usize, off: f64, value: f64, bound: f64, unit: f64, x: f64, y: f64| {
        let (part, units) =
            if off == 0.0 { (0.0, 0.0) } else { (off / (unit * bound), off / (unit * value.abs())) };
        assert!(part <= 1.0, "{}({x:e}, {y:e}): {part} of the bound, {units} units", function.name);
        worst[place] = (worst[place].0.max(part), worst[place].1.max(units));
    };
    for _ in 0..count {
        let sizes = [draws.size(least, largest), draws.size(least, largest)];
        let [x, y] = if positive { sizes.map(f64::abs) } else { sizes };
        let found = (function.double)(RunningError::exact(x), RunningError::exact(y));
        let exact = (function.exact)(x.into(), y.into());
        let off = (Pair::from(found.value) - exact).0.abs();
        judge(0, off, found.value, found.error, 0.5 * f64::EPSILON, x, y);
        let [x, y] = [x as f32, y as f32];
        let found = (function.single)(RunningError::exact(x), RunningError::exact(y));
        let exact = (function.exact)(f64::from(x).into(), f64::from(y).into());
        let off = (Pair::from(f64::from(found.value)) - exact).0.abs();
        let unit = 0.5 * f64::from(f32::EPSILON);
        judge(1, off, f64::from(found.value), f64::from(found.error), unit, x.into(), y.into());
    }
    worst
}

fn ask(functions: &[Function], count: usize) {
    println!("{:<10} {:>24} {:>24}", "function", "f64: of the bound, units", "f32: of the bound, units");
    for function in functions {
        let [double, single] = worst(function, count);
        println!(
            "{:<10} {:>15.3} {:>8.3} {:>15.3} {:>8.3}",
            function.name, double.0, double.1, single.0, single.1
        );
    }
}

#[test]
fn functions_stay_within_their_bounds() {
    ask(&functions(), 3_000);
}

/// How many functions of the list are of angles or powers of `e`, which take longer.
const LONG: usize = 12;

#[test]
#[ignore = "ten million arguments of each function: ten minutes in release"]
fn functions_of_angles_stay_within_their_bounds_everywhere() {
    ask(&functions()[..LONG], 10_000_000);
}

#[test]
#[ignore = "ten million arguments of each function: three minutes in release"]
fn other_functions_stay_within_their_bounds_everywhere() {
    ask(&functions()[LONG..], 10_000_000);
}

/// A `Pair` as a number of 71 digits.
fn long(x: Pair) -> f256 {
    f256::from(x.0) + f256::from(x.1)
}

#[test]
fn the_references_are_right() {
    for function in functions() {
        let (least, largest, positive) = function.range;
        let mut draws = Draws(5);
        for _ in 0..60 {
            let sizes = [draws.size(least, largest), draws.size(least, largest)];
            let [x, y] = if positive { sizes.map(f64::abs) } else { sizes };
            let found = long((function.exact)(x.into(), y.into()));
            let exact = (function.slow)(f256::from(x), f256::from(y));
            // Of the hyperbolic ones in 71 digits a small argument leaves fewer.
            let limit = f256::from(1e-22) * exact.abs();
            assert!((found - exact).abs() <= limit, "{}({x:e}, {y:e}): {found} {exact}", function.name);
        }
    }
}

#[test]
fn constants_are_bounded() {
    let unit = 0.5 * f64::from(f32::EPSILON);
    for den in 1..200_i64 {
        for num in [0, 1, 3, -7, 10, 981, 12_345_678, 1 << 24, (1 << 24) + 1, (1 << 40) + 1] {
            let found = <RunningError<f32> as Real>::from_ratio(num, den);
            let off = (f64::from(found.value) - num as f64 / den as f64).abs();
            assert!(off <= unit * f64::from(found.error) * (1.0 + 1e-7), "{num}/{den}: {found:?}");
        }
    }
    assert_eq!(<RunningError<f64> as Real>::from_ratio(1, 3).error, 1.0 / 3.0);
    assert_eq!(<RunningError<f64> as Real>::from_ratio(3, 4).error, 0.0);
    assert_eq!(<RunningError<f64> as Real>::from_ratio(6, 3).error, 0.0);
    assert_eq!(<RunningError<f32> as Real>::from_f64(0.1).error, 0.1_f32);
    assert_eq!(<RunningError<f32> as Real>::from_f64(0.5).error, 0.0);
}

#[test]
fn exact_arguments_move_nothing() {
    let at = |x: f64| RunningError::exact(x);
    assert_eq!(at(0.0).sqrt().error, 0.0);
    assert_eq!(at(0.0).atan2(at(0.0)).error, 0.0);
    assert!(at(1.0).asin().error < 7.0 && at(1.0).acos().error == 0.0);
    assert!(RunningError::once(1.0_f64).asin().error.is_infinite());
    assert!(RunningError { value: 1.0, error: f64::NAN }.exp().error.is_nan());
}
