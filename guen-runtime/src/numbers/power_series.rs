//! Power series in one variable that are numbers: what any function of reals makes of motions that are series in time.
//!
//! Every function applies its own recurrence, so that the coefficients are those of the composed function to rounding. Up to
//! which order a series is known is part of it, and a result is known as far as what it was made of.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::numbers::lift::Lift;
use crate::numbers::real::Real;
use crate::numbers::rules::assign_operators;

/// The highest order of a Taylor series.
///
/// ```
/// use guen_runtime::{Coefficients, HIGHEST_ORDER};
/// assert_eq!(core::mem::size_of::<Coefficients<f64, 9>>(), 8 * 9 * (HIGHEST_ORDER + 1));
/// ```
pub const HIGHEST_ORDER: usize = 32;

/// A power series `a_0 + a_1 s + .. + a_p s^p` that is a [`Real`], with the order `p` up to which it is known.
///
/// ```text
/// (a b)_k = sum_{j=0}^{k} a_j b_{k-j},     y' = g(a) a'  =>  y_k = (1/k) sum_{j=1}^{k} j a_j g_{k-j}
/// ```
///
/// - Constants are known up to [`HIGHEST_ORDER`]; a result is known up to the lower order of its arguments.
/// - Coefficients are in powers of the variable's unit: with a unit `h` of time, `a_k` is `h^k / k!` of the derivative of order
///   `k`.
/// - Where a function has no series (a root at zero), the coefficients follow the formula: infinite or NaN. `abs` goes on with
///   the sign of the first coefficient that is not zero, `sign` as a constant.
/// - A sum takes `p` additions, a product or a function about `p^2/2` products; fewer where an argument has fewer terms, so that a
///   product with a constant takes `p`. 280 bytes over `f64`, no allocation.
/// - Source of the recurrences: R. E. Moore, *Interval Analysis*, 1966, chapter 11.
///
/// ```
/// use guen_runtime::{PowerSeries, Real};
///
/// // exp(sin s) = 1 + s + s^2/2 - s^4/8 - ..
/// let s = PowerSeries::line(0.0, 1.0);
/// let series = s.sin().exp();
/// let coefficients: [f64; 5] = core::array::from_fn(|k| series.coefficient(k));
/// assert_eq!(coefficients, [1.0, 1.0, 0.5, 0.0, -0.125]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerSeries<R> {
    coefficients: [R; HIGHEST_ORDER + 1],
    /// Coefficients of higher orders are zero.
    degree: usize,
    /// Coefficients of higher orders are not known.
    order: usize,
}

impl<R: Real> PowerSeries<R> {
    /// The series `value`, a constant.
    pub fn constant(value: R) -> Self {
        let mut coefficients = [R::zero(); HIGHEST_ORDER + 1];
        coefficients[0] = value;
        Self { coefficients, degree: 0, order: HIGHEST_ORDER }
    }

    /// The series `value + slope s`.
    pub fn line(value: R, slope: R) -> Self {
        let mut line = Self::constant(value);
        line.coefficients[1] = slope;
        Self { degree: 1, ..line }
    }

    /// The series of these coefficients, known up to the order of the last one; those beyond [`HIGHEST_ORDER`] are left out.
    /// Without any it is the constant zero.
    ///
    /// ```
    /// use guen_runtime::PowerSeries;
    /// let product = PowerSeries::known([1.0, 2.0]) * PowerSeries::known([1.0, 3.0, 9.0]);
    /// assert_eq!((product.coefficient(1), product.order()), (5.0, 1));
    /// ```
    pub fn known(coefficients: impl IntoIterator<Item = R>) -> Self {
        let mut series = Self::constant(R::zero());
        for (k, (place, coefficient)) in series.coefficients.iter_mut().zip(coefficients).enumerate() {
            *place = coefficient;
            (series.degree, series.order) = (k, k);
        }
        series
    }

    /// The coefficient of an order; NaN beyond that up to which the series is known.
    pub fn coefficient(&self, k: usize) -> R {
        let known = self.coefficients.get(k).filter(|_| k <= self.order);
        known.copied().unwrap_or(R::from_f64(f64::NAN))
    }

    /// Makes it known up to an order, at most [`HIGHEST_ORDER`], with that coefficient.
    pub(crate) fn know(&mut self, order: usize, coefficient: R) {
        if let Some(place) = self.coefficients.get_mut(order) {
            *place = coefficient;
            (self.degree, self.order) = (order, order);
        }
    }

    /// The order up to which the series is known.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The coefficients that may differ from zero.
    fn terms(&self) -> &[R] {
        &self.coefficients[..=self.degree.min(self.order)]
    }

    /// The series of a first coefficient and of a rule for each further one from those before.
    fn grown(first: R, degree: usize, order: usize, rule: impl Fn(usize, &[R]) -> R) -> Self {
        let mut grown = Self { degree: degree.min(order), order, ..Self::constant(first) };
        for k in 1..=grown.degree {
            let (before, rest) = grown.coefficients.split_at_mut(k);
            rest[0] = rule(k, before);
        }
        grown
    }

    /// The terms one by one.
    fn each(&self, function: impl Fn(R) -> R) -> Self {
        let mut each = *self;
        each.coefficients[..=self.degree].iter_mut().for_each(|a| *a = function(*a));
        each
    }

    /// Combines two series term by term.
    fn both(&self, other: &Self, combine: impl Fn(R, R) -> R) -> Self {
        let order = self.order.min(other.order);
        let degree = self.degree.max(other.degree).min(order);
        let mut both = Self { degree, order, ..Self::constant(R::zero()) };
        for k in 0..=degree {
            both.coefficients[k] = combine(self.coefficients[k], other.coefficients[k]);
        }
        both
    }

    /// `sum_{j=first}^{last} a_j b_{k-j}` over the terms that there are.
    #[inline]
    fn convolved(a: &[R], b: &[R], k: usize, first: usize, last: usize) -> R {
        let first = first.max((k + 1).saturating_sub(b.len()));
        let end = (last + 1).min(a.len());
        let mut sum = R::zero();
        if let (Some(a), Some(b)) = (a.get(first..end), b.get((k + 1).saturating_sub(end)..=k - first.min(k)))
        {
            for (a, b) in a.iter().zip(b.iter().rev()) {
                sum += *a * *b;
            }
        }
        sum
    }

    /// The terms of `s a'`: `j a_j`.
    fn slopes(&self) -> Self {
        let mut slopes = *self;
        for (j, a) in slopes.coefficients[..=self.degree].iter_mut().enumerate() {
            *a *= count(j);
        }
        slopes
    }

    /// `sum_{j=1}^{k} j a_j g_{k-j}`, the coefficient of `s^k` of `s g a'`, from the slopes of `a`.
    #[inline]
    fn along(slopes: &[R], g: &[R], k: usize) -> R {
        Self::convolved(slopes, g, k, 1, k)
    }

    /// The order up to which a function of the series has terms: a constant stays one.
    fn reach(&self) -> usize {
        if self.degree == 0 { 0 } else { self.order }
    }

    /// The function whose value is given, with the slope `g`, a series, along this one.
    fn integral(&self, value: R, g: &Self) -> Self {
        let order = self.order.min(g.order);
        let slopes = self.slopes();
        Self::grown(value, self.reach(), order, |k, _| Self::along(slopes.terms(), g.terms(), k) / count(k))
    }

    /// Two functions, each the slope of the other, the second with a sign.
    fn coupled(&self, (f, g): (R, R), negative: bool) -> (Self, Self) {
        let (mut first, mut second) = (Self::constant(f), Self::constant(g));
        for series in [&mut first, &mut second] {
            (series.degree, series.order) = (self.reach(), self.order);
        }
        let slopes = self.slopes();
        let along = |g: &Self, k| Self::along(slopes.terms(), &g.coefficients[..k], k) / count(k);
        for k in 1..=self.reach() {
            let slope = along(&first, k);
            first.coefficients[k] = along(&second, k);
            second.coefficients[k] = if negative { -slope } else { slope };
        }
        (first, second)
    }

    /// `1 - a^2` as a product, which keeps its digits near the ends.
    fn one_less_square(self) -> Self {
        (Self::one() - self) * (Self::one() + self)
    }
}

fn count<R: Real>(k: usize) -> R {
    R::from_f64(k as f64)
}

impl<R: Real> Default for PowerSeries<R> {
    /// The constant of the real's own default, zero for floats.
    fn default() -> Self {
        Self::constant(R::default())
    }
}

impl<R: Real> Add for PowerSeries<R> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.both(&other, |a, b| a + b)
    }
}

impl<R: Real> Sub for PowerSeries<R> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.both(&other, |a, b| a - b)
    }
}

impl<R: Real> Neg for PowerSeries<R> {
    type Output = Self;

    fn neg(self) -> Self {
        self.each(|a| -a)
    }
}

impl<R: Real> Mul for PowerSeries<R> {
    type Output = Self;

    #[allow(clippy::suspicious_arithmetic_impl, reason = "the degree of a product is the sum of degrees")]
    fn mul(self, other: Self) -> Self {
        let order = self.order.min(other.order);
        for (constant, series) in [(&self, &other), (&other, &self)] {
            if constant.degree == 0 {
                let factor = constant.coefficients[0];
                return Self { order, ..series.each(|a| factor * a) };
            }
        }
        let (a, b) = (self.terms(), other.terms());
        Self::grown(a[0] * b[0], self.degree + other.degree, order, |k, _| Self::convolved(a, b, k, 0, k))
    }
}

impl<R: Real> Div for PowerSeries<R> {
    type Output = Self;

    // q_k = (a_k - sum_{j=0}^{k-1} q_j b_{k-j}) / b_0
    #[allow(
        clippy::suspicious_arithmetic_impl,
        reason = "the recurrence of a quotient has other operators in it"
    )]
    fn div(self, other: Self) -> Self {
        let b = other.terms();
        let order = self.order.min(other.order);
        let degree = if other.degree == 0 { self.degree } else { order };
        Self::grown(self.coefficients[0] / b[0], degree, order, |k, q| {
            (self.coefficients[k] - Self::convolved(q, b, k, 0, k - 1)) / b[0]
        })
    }
}

assign_operators!(PowerSeries<R>, R: Real);

impl<B, R: Lift<B>> Lift<B> for PowerSeries<R> {
    fn lift(base: B) -> Self {
        Self::constant(R::lift(base))
    }
}

impl<R: Real> Real for PowerSeries<R> {
    fn from_ratio(num: i64, den: i64) -> Self {
        Self::constant(R::from_ratio(num, den))
    }

    fn from_f64(value: f64) -> Self {
        Self::constant(R::from_f64(value))
    }

    fn from_parts(parts: &[(i64, i32)]) -> Self {
        Self::constant(R::from_parts(parts))
    }

    fn to_f64(self) -> f64 {
        self.coefficients[0].to_f64()
    }

    fn pi() -> Self {
        Self::constant(R::pi())
    }

    fn epsilon() -> Self {
        Self::constant(R::epsilon())
    }

    // sin' = cos, cos' = -sin
    fn sin_cos(self) -> (Self, Self) {
        self.coupled(self.coefficients[0].sin_cos(), true)
    }

    // asin' = 1 / sqrt(1 - a^2)
    fn asin(self) -> Self {
        self.integral(self.coefficients[0].asin(), &self.one_less_square().sqrt().recip())
    }

    // acos' = -1 / sqrt(1 - a^2)
    fn acos(self) -> Self {
        self.integral(self.coefficients[0].acos(), &-self.one_less_square().sqrt().recip())
    }

    // atan' = 1 / (1 + a^2)
    fn atan(self) -> Self {
        self.integral(self.coefficients[0].atan(), &(Self::one() + self * self).recip())
    }

    // atan2(y, x)' = (x y' - y x') / (x^2 + y^2)
    fn atan2(self, x: Self) -> Self {
        let square = x * x + self * self;
        let (by_y, by_x) = (x / square, self / square);
        let first = self.integral(self.coefficients[0].atan2(x.coefficients[0]), &by_y);
        first - x.integral(R::zero(), &by_x)
    }

    // sinh' = cosh, cosh' = sinh
    fn sinh(self) -> Self {
        self.coupled((self.coefficients[0].sinh(), self.coefficients[0].cosh()), false).0
    }

    fn cosh(self) -> Self {
        self.coupled((self.coefficients[0].sinh(), self.coefficients[0].cosh()), false).1
    }

    // tanh' = g with g = 1 / cosh^2, whose further coefficients are those of -tanh^2
    fn tanh(self) -> Self {
        let sech = self.coefficients[0].cosh().recip();
        let mut g = [R::zero(); HIGHEST_ORDER + 1];
        g[0] = sech * sech;
        let mut tanh =
            Self { degree: self.reach(), order: self.order, ..Self::constant(self.coefficients[0].tanh()) };
        let slopes = self.slopes();
        for k in 1..=self.reach() {
            tanh.coefficients[k] = Self::along(slopes.terms(), &g[..k], k) / count(k);
            let known = &tanh.coefficients[..=k];
            g[k] = -Self::convolved(known, known, k, 0, k);
        }
        tanh
    }

    // exp' = exp
    fn exp(self) -> Self {
        let (first, slopes) = (self.coefficients[0].exp(), self.slopes());
        Self::grown(first, self.reach(), self.order, |k, y| Self::along(slopes.terms(), y, k) / count(k))
    }

    // a y' = a'
    fn ln(self) -> Self {
        let a = self.coefficients;
        let slopes = self.slopes();
        Self::grown(a[0].ln(), self.reach(), self.order, |k, y| {
            let mut sum = R::zero();
            for j in 1..k {
                sum += count::<R>(j) * y[j] * a[k - j];
            }
            (slopes.coefficients[k] - sum) / (count::<R>(k) * a[0])
        })
    }

    // r r = a
    fn sqrt(self) -> Self {
        let root = self.coefficients[0].sqrt();
        Self::grown(root, self.reach(), self.order, |k, r| {
            (self.coefficients[k] - Self::convolved(r, r, k, 1, k - 1)) / (root + root)
        })
    }

    // q a y' = y a'
    fn root(self, q: u32) -> Self {
        let a = self.terms();
        let parts = R::from_ratio(i64::from(q), 1);
        Self::grown(a[0].root(q), self.reach(), self.order, |k, y| {
            let mut sum = R::zero();
            for (j, a) in a.iter().enumerate().take(k + 1).skip(1) {
                sum += (count::<R>(j) * (R::one() + parts) - count::<R>(k) * parts) * *a * y[k - j];
            }
            sum / (count::<R>(k) * parts * a[0])
        })
    }

    fn abs(self) -> Self {
        let first = self.terms().iter().find(|a| **a != R::zero()).copied().unwrap_or_default();
        let sign = first.sign();
        self.each(|a| sign * a)
    }

    fn sign(self) -> Self {
        Self { order: self.order, ..Self::constant(self.coefficients[0].sign()) }
    }

    fn floor(self) -> Self {
        Self { order: self.order, ..Self::constant(self.coefficients[0].floor()) }
    }

    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        above.both(&below, |above, below| {
            self.coefficients[0].where_above(limit.coefficients[0], above, below)
        })
    }

    fn each_alone(function: impl Fn(&dyn Fn(Self) -> f64) -> f64) -> Self {
        Self::constant(R::each_alone(|alone| function(&|series: Self| alone(series.coefficients[0]))))
    }

    /// Whether every known coefficient is finite.
    fn is_finite(self) -> bool {
        self.terms().iter().all(|a| a.is_finite())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    type Second = Dual<Dual<f64, 1>, 1>;

    /// A function of every kind, at an argument that suits all of them.
    fn of_all<R: Real>(x: R) -> [R; 24] {
        let (sin, cos) = x.sin_cos();
        let half = R::from_ratio(1, 2);
        [
            sin,
            cos,
            x.tan(),
            x.cot(),
            x.asin(),
            x.acos(),
            x.atan(),
            (x + half).atan2(x * x),
            x.atan2(half),
            half.atan2(x),
            x.sinh(),
            x.cosh(),
            x.tanh(),
            (x * x - half).exp(),
            x.ln(),
            x.sqrt(),
            x.root(3),
            (-x).root(5),
            (-x * x).abs(),
            x.powi(5),
            x.powi(-3),
            x.recip(),
            (x - half).times_plus(x, half) / (x + half),
            (x - half * half).sign() * x.minus_times(x, x),
        ]
    }

    /// Compares with duals of duals: another derivation of the first two derivatives.
    #[test]
    fn coefficients_are_those_of_nested_duals() {
        // x(s) = 0.6 + 0.3 s - 0.2 s^2
        let x = PowerSeries::known([0.6, 0.3, -0.2, 0.0, 0.0]);
        let inner = Dual { value: 0.6, tangent: [0.3] };
        let outer = Second { value: inner, tangent: [Dual { value: 0.3, tangent: [-0.4] }] };
        for (place, (series, dual)) in of_all(x).into_iter().zip(of_all(outer)).enumerate() {
            let expected = [dual.value.value, dual.tangent[0].value, dual.tangent[0].tangent[0] / 2.0];
            for (k, expected) in expected.into_iter().enumerate() {
                let off = (series.coefficient(k) - expected).abs();
                assert!(off <= 2e-14 * (1.0 + expected.abs()), "{place}, order {k}: {off}");
            }
            assert_eq!(series.order(), 4, "{place}");
        }
    }

    /// Sums high orders up to the function at another place of the line.
    #[test]
    fn high_orders_sum_up_to_the_function() {
        let along = PowerSeries::line(0.6, 0.05);
        for (place, (series, expected)) in of_all(along).into_iter().zip(of_all(0.65)).enumerate() {
            let sum = (0..=HIGHEST_ORDER).rev().fold(0.0, |sum, k| sum + series.coefficient(k));
            assert!((sum - expected).abs() < 4e-15 * (1.0 + expected.abs()), "{place}: {sum} {expected}");
        }
    }

    #[test]
    fn a_result_is_known_as_far_as_its_arguments() {
        let short = PowerSeries::known([1.0_f64, 2.0]);
        let long = PowerSeries::line(1.0, 1.0);
        for series in [short + long, short * long, long / short, (long * short).exp(), long.atan2(short)] {
            assert_eq!(series.order(), 1);
            assert!(series.coefficient(2).is_nan() && series.is_finite());
        }
        assert_eq!((short.sign().order(), PowerSeries::<f64>::known([]).order()), (1, HIGHEST_ORDER));
        assert_eq!(PowerSeries::known([1.0; 50]).order(), HIGHEST_ORDER);
        assert_eq!(PowerSeries::constant(2.0).exp().coefficient(5), 0.0);
    }

    #[test]
    fn kinks_and_ends_follow_their_formulas() {
        let from_zero = PowerSeries::line(0.0, -2.0);
        assert_eq!(from_zero.abs().coefficient(1), 2.0);
        assert_eq!(from_zero.sign().coefficient(0), 0.0);
        assert!(
            !from_zero.sqrt().is_finite() && !from_zero.ln().is_finite() && !from_zero.recip().is_finite()
        );
        let steep = PowerSeries::line(800.0, 1.0);
        assert_eq!((steep.tanh().coefficient(0), steep.tanh().coefficient(3)), (1.0, 0.0));
        let chosen = PowerSeries::line(2.0, 0.0).where_above(PowerSeries::one(), steep, from_zero);
        assert_eq!(chosen, steep);
    }
}
