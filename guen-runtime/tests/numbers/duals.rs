//! Duals against closed forms: every function, first derivatives and second ones by nesting.

use guen_runtime::{Dual, Lift, Real};

type First = Dual<f64, 1>;
type Second = Dual<Dual<f64, 1>, 1>;

fn first(x: f64) -> First {
    Dual::variable(x, 0)
}

fn second(x: f64) -> Second {
    Dual::variable(Dual::variable(x, 0), 0)
}

/// A few roundings, relative to numbers above one.
#[track_caller]
fn assert_close(what: &str, computed: f64, expected: f64) {
    let error = (computed - expected).abs() / expected.abs().max(1.0);
    assert!(error < 32.0 * f64::EPSILON, "{what}: {computed} instead of {expected}");
}

/// Value, slope and curvature of one function at one point.
macro_rules! rule {
    ($name:literal at $x:expr, $f:expr => $value:expr, $slope:expr, $curvature:expr) => {{
        let x: f64 = $x;
        #[allow(clippy::redundant_closure_call)]
        let (one, two) = ($f(first(x)), $f(second(x)));
        assert_close($name, one.value, $value(x));
        assert_close(concat!($name, "'"), one.tangent[0], $slope(x));
        assert_close($name, two.value.value, $value(x));
        assert_close(concat!($name, "', outer"), two.tangent[0].value, $slope(x));
        assert_close(concat!($name, "', inner"), two.value.tangent[0], $slope(x));
        assert_close(concat!($name, "''"), two.tangent[0].tangent[0], $curvature(x));
    }};
}

#[test]
fn every_function_has_its_derivatives() {
    for x in [-2.3, -0.7, 0.4, 1.9] {
        rule!("sin" at x, Real::sin => f64::sin, f64::cos, |x: f64| -x.sin());
        rule!("cos" at x, Real::cos => f64::cos, |x: f64| -x.sin(), |x: f64| -x.cos());
        rule!("tan" at x, Real::tan => f64::tan, |x: f64| x.cos().powi(-2),
            |x: f64| 2.0 * x.sin() * x.cos().powi(-3));
        rule!("cot" at x, Real::cot => |x: f64| x.cos() / x.sin(), |x: f64| -x.sin().powi(-2),
            |x: f64| 2.0 * x.cos() * x.sin().powi(-3));
        rule!("atan" at x, Real::atan => f64::atan, |x: f64| 1.0 / (1.0 + x * x),
            |x: f64| -2.0 * x / (1.0 + x * x).powi(2));
        rule!("sinh" at x, Real::sinh => f64::sinh, f64::cosh, f64::sinh);
        rule!("cosh" at x, Real::cosh => f64::cosh, f64::sinh, f64::cosh);
        rule!("tanh" at x, Real::tanh => f64::tanh, |x: f64| x.cosh().powi(-2),
            |x: f64| -2.0 * x.tanh() * x.cosh().powi(-2));
        rule!("exp" at x, Real::exp => f64::exp, f64::exp, f64::exp);
        rule!("abs" at x, Real::abs => f64::abs, f64::signum, |_| 0.0);
        rule!("sign" at x, Real::sign => f64::signum, |_| 0.0, |_| 0.0);
        rule!("powi 5" at x, |u| Real::powi(u, 5) => |x: f64| x.powi(5), |x: f64| 5.0 * x.powi(4),
            |x: f64| 20.0 * x.powi(3));
        rule!("powi -3" at x, |u| Real::powi(u, -3) => |x: f64| x.powi(-3), |x: f64| -3.0 * x.powi(-4),
            |x: f64| 12.0 * x.powi(-5));
        rule!("recip" at x, Real::recip => |x: f64| 1.0 / x, |x: f64| -x.powi(-2),
            |x: f64| 2.0 * x.powi(-3));
        rule!("cube root" at x, |u| Real::root(u, 3) => f64::cbrt, |x: f64| 1.0 / (3.0 * x.cbrt().powi(2)),
            |x: f64| -2.0 / (9.0 * x.cbrt().powi(5)));
    }
    for x in [0.3, 1.0, 4.2] {
        rule!("ln" at x, Real::ln => f64::ln, |x: f64| 1.0 / x, |x: f64| -1.0 / (x * x));
        rule!("sqrt" at x, Real::sqrt => f64::sqrt, |x: f64| 0.5 / x.sqrt(),
            |x: f64| -0.25 / (x * x.sqrt()));
        rule!("root 4" at x, |u| Real::root(u, 4) => |x: f64| x.sqrt().sqrt(), |x: f64| 0.25 * x.powf(-0.75),
            |x: f64| -0.1875 * x.powf(-1.75));
    }
    for x in [-0.8, 0.1, 0.6] {
        rule!("asin" at x, Real::asin => f64::asin, |x: f64| (1.0 - x * x).powf(-0.5),
            |x: f64| x * (1.0 - x * x).powf(-1.5));
        rule!("acos" at x, Real::acos => f64::acos, |x: f64| -(1.0 - x * x).powf(-0.5),
            |x: f64| -x * (1.0 - x * x).powf(-1.5));
    }
}

#[test]
fn sin_cos_agrees_with_sin_and_cos() {
    let x = second(0.9);
    assert_eq!(x.sin_cos(), (x.sin(), x.cos()));
}

#[test]
fn operators_have_the_rules_of_sums_products_and_quotients() {
    let (x, y) = (1.7, -0.6);
    let [u, v] = [Dual::<f64, 2>::variable(x, 0), Dual::variable(y, 1)];
    assert_eq!((u + v).tangent, [1.0, 1.0]);
    assert_eq!((u - v).tangent, [1.0, -1.0]);
    assert_eq!((-u).tangent, [-1.0, 0.0]);
    assert_eq!((u * v).tangent, [y, x]);
    let ratio = u / v;
    assert_close("d(u/v)/du", ratio.tangent[0], 1.0 / y);
    assert_close("d(u/v)/dv", ratio.tangent[1], -x / (y * y));
    let mut w = u;
    w += v;
    w -= Dual::one();
    w *= v;
    w /= u;
    assert_eq!(w, (u + v - Dual::one()) * v / u);
}

#[test]
fn the_angle_of_a_point_turns_in_all_four_quadrants() {
    for (x, y) in [(0.6_f64, 0.8_f64), (-0.6, 0.8), (-0.6, -0.8), (0.6, -0.8), (0.0, 2.0)] {
        let angle = Dual::<f64, 2>::variable(y, 1).atan2(Dual::variable(x, 0));
        let square = x * x + y * y;
        assert_close("atan2", angle.value, y.atan2(x));
        assert_close("d atan2/dx", angle.tangent[0], -y / square);
        assert_close("d atan2/dy", angle.tangent[1], x / square);
    }
}

#[test]
fn mixed_derivatives_by_nesting() {
    // f = x^2 sin y: f_xy = 2 x cos y, in both orders
    let f = |x: Dual<Dual<f64, 2>, 2>, y: Dual<Dual<f64, 2>, 2>| x * x * y.sin();
    let (x, y) = (1.3, 0.4);
    let result = f(Dual::variable(Dual::variable(x, 0), 0), Dual::variable(Dual::variable(y, 1), 1));
    assert_close("f_xy", result.tangent[0].tangent[1], 2.0 * x * y.cos());
    assert_close("f_yx", result.tangent[1].tangent[0], 2.0 * x * y.cos());
    assert_close("f_yy", result.tangent[1].tangent[1], -x * x * y.sin());
}

#[test]
fn the_power_zero_does_not_vary_even_at_zero() {
    assert_eq!(first(0.0).powi(0), First::one());
    assert_eq!(first(0.0).powi(1), first(0.0));
    assert_eq!(first(0.0).root(1), first(0.0));
}

#[test]
fn equality_compares_tangents_and_order_compares_values() {
    let (a, b) = (First::constant(1.0), first(1.0));
    assert_ne!(a, b);
    assert_eq!(a.partial_cmp(&b), None);
    assert!(first(0.5) < a && a > first(0.5));
}

#[test]
fn a_dual_is_finite_if_all_of_it_is() {
    assert!(first(1.0).is_finite());
    assert!(!first(0.0).sqrt().is_finite());
    assert!(!First::constant(f64::NAN).is_finite());
}

#[test]
fn constants_are_lifted_to_any_depth() {
    let deep: Dual<Dual<Dual<f32, 1>, 2>, 3> = Lift::lift(0.5_f32);
    assert_eq!(deep, Dual::from_ratio(1, 2));
    assert_eq!(deep.to_f64(), 0.5);
    assert_eq!(Second::from_parts(&[(3, -1)]), Second::from_f64(1.5));
    assert_eq!(Second::pi().value.value, std::f64::consts::PI);
}

/// Many tangents are computed out of line, few in line, and each is what it is alone.
#[test]
fn the_bits_of_a_tangent_do_not_depend_on_how_many_there_are() {
    fn along<const N: usize>(first: usize) -> Vec<u64> {
        let variable = |j: usize| {
            let value = 0.3 + 0.17 * j as f64;
            if (first..first + N).contains(&j) {
                Dual::<f64, N>::variable(value, j - first)
            } else {
                Dual::constant(value)
            }
        };
        let x: [_; 12] = core::array::from_fn(variable);
        let (sin, cos) = (x[0] * x[1]).sin_cos();
        let ((s, c), (t, d)) = Real::sin_cos_pair(x[2] / x[3], -x[4]);
        let sum = sin.times_plus(x[5], cos).times_minus(x[6], x[7]).minus_times(x[8], x[9] - s * c);
        let value = (sum + t.atan2(x[10]) * d).sqrt() + x[11].powi(3);
        value.tangent.map(f64::to_bits).to_vec()
    }
    let together = along::<12>(0);
    assert_eq!(together, [along::<4>(0), along::<4>(4), along::<4>(8)].concat());
    assert!(together.iter().all(|bits| f64::from_bits(*bits) != 0.0));
}
