//! A real that counts roundings: how much of a value is left where terms cancel.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::real::Real;
use crate::rules::{assign_operators, by_slopes};

/// A value beside a first-order bound of its error, in units of the unit roundoff.
///
/// ```text
/// e(a + b) = e(a) + e(b) + |a + b|,   e(a b) = |a| e(b) + |b| e(a) + |a b|,   e(f(a)) = |f'(a)| e(a) + |f(a)|
/// ```
///
/// - `value`: what the real below computes, to the bit; `error`: by how much, times the unit roundoff, arguments that
///   are off by their own errors and every rounding on the way can have moved it.
/// - `|value| / error` is one where nothing cancels, and the part that is left where something does: a function that
///   must not vanish is at that *relative distance* from its zero. See [`System::edges`](crate::System::edges).
/// - A running error analysis (Wilkinson): errors that cancel each other are not seen, so that the bound grows along
///   long programs. A product costs three further products and three sums. Of lanes, each counts its own.
///
/// ```
/// use guen_runtime::{Real, Rounded};
///
/// let angle = Rounded::once(3.0);
/// assert!(angle.sin().left() > 0.03);
/// // Next to its zero at pi a sine is as uncertain as the angle, and small.
/// let angle = Rounded::once(f64::pi() - 1e-9);
/// assert!(angle.sin().left() < 1e-9);
/// // Next to its zero at zero it is not: a small angle has all its digits.
/// assert!(Rounded::once(1e-9_f64).sin().left() > 0.4);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rounded<R> {
    /// The value.
    pub value: R,
    /// The bound of its error, in units of the unit roundoff; not negative.
    pub error: R,
}

// Always: an operation of lanes that is a call loses their instructions.
impl<R: Real> Rounded<R> {
    /// A number that is exact.
    #[inline(always)]
    pub fn exact(value: R) -> Self {
        Self { value, error: R::zero() }
    }

    /// A number that was rounded once.
    #[inline(always)]
    pub fn once(value: R) -> Self {
        Self { value, error: value.abs() }
    }

    /// What is left of the value: `|value| / error`, at most one for anything that was rounded; infinite for an exact
    /// number that is not zero.
    #[inline(always)]
    pub fn left(self) -> R {
        self.value.abs() / self.error
    }

    /// `f(a)`, from its value and slope.
    #[inline(always)]
    fn chain(self, value: R, slope: R) -> Self {
        Self { value, error: slope.abs() * self.error + value.abs() }
    }
}

impl<R: Real> Add for Rounded<R> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + value.abs() }
    }
}

impl<R: Real> Sub for Rounded<R> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let value = self.value - other.value;
        Self { value, error: self.error + other.error + value.abs() }
    }
}

impl<R: Real> Mul for Rounded<R> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error + other.value.abs() * self.error + value.abs();
        Self { value, error }
    }
}

impl<R: Real> Div for Rounded<R> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let error = (self.error + value.abs() * other.error) / other.value.abs() + value.abs();
        Self { value, error }
    }
}

impl<R: Real> Neg for Rounded<R> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

assign_operators!(Rounded<R>, R: Real);

impl<R: Real> Real for Rounded<R> {
    #[inline(always)]
    fn from_ratio(num: i64, den: i64) -> Self {
        Self::exact(R::from_ratio(num, den))
    }

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::exact(R::from_f64(value))
    }

    // As by default, but always inlined: of lanes a call would lose their instructions.
    #[inline(always)]
    fn zero() -> Self {
        Self::exact(R::zero())
    }

    #[inline(always)]
    fn one() -> Self {
        Self::exact(R::one())
    }

    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    #[inline(always)]
    fn tan(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        sine / cosine
    }

    #[inline(always)]
    fn cot(self) -> Self {
        let (sine, cosine) = self.sin_cos();
        cosine / sine
    }

    #[inline(always)]
    fn recip(self) -> Self {
        Self::one() / self
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }

    #[inline]
    fn from_parts(parts: &[(i64, i32)]) -> Self {
        Self::once(R::from_parts(parts))
    }

    #[inline]
    fn pi() -> Self {
        Self::once(R::pi())
    }

    #[inline]
    fn epsilon() -> Self {
        Self::exact(R::epsilon())
    }

    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        R::vectorize(function)
    }

    by_slopes!(inline(always));

    // d atan2(y, x) = (x dy - y dx) / (x^2 + y^2)
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        let square = x.value * x.value + self.value * self.value;
        let moved = (x.value.abs() * self.error + self.value.abs() * x.error) / square;
        Self { value, error: moved + value.abs() }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self { value: self.value.abs(), error: self.error }
    }

    #[inline(always)]
    fn sign(self) -> Self {
        Self::exact(self.value.sign())
    }

    #[inline(always)]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        let choose = |above: R, below: R| self.value.where_above(limit.value, above, below);
        Self { value: choose(above.value, below.value), error: choose(above.error, below.error) }
    }

    #[inline(always)]
    fn most(self) -> f64 {
        self.value.most()
    }

    fn each_alone(function: impl Fn(&dyn Fn(Self) -> f64) -> f64) -> Self {
        Self::exact(R::each_alone(|alone| function(&|x| alone(x.value))))
    }

    /// Whether the value is finite; its error may be too large for the real.
    #[inline]
    fn is_finite(self) -> bool {
        self.value.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::Rounded;
    use crate::real::Real;

    /// The errors of single precision, of programs that cancel, against the same programs in doubles.
    #[test]
    fn the_bound_holds_and_is_not_idle() {
        fn program<R: Real>(x: R, y: R) -> [R; 6] {
            let (s, c) = (x * y).sin_cos();
            [
                x * x - y * y,
                s * s + c * c - R::one(),
                (x - y) / (x + y),
                (R::one() - c).sqrt() - s,
                x.atan2(y) - R::one(),
                (x + y).exp() - x.exp() * y.exp(),
            ]
        }
        let unit = f64::from(f32::EPSILON) / 2.0;
        let mut tightest = [0.0_f64; 6];
        for k in 1..2000 {
            let (x, y) = (1.0 + (k as f32 * 0.37).sin() * 0.5, 1.0 + (k as f32 * 0.71).cos() * 0.4);
            let bounds = program(Rounded::exact(x), Rounded::exact(y));
            let exact = program(f64::from(x), f64::from(y));
            for (i, (bound, exact)) in bounds.iter().zip(exact).enumerate() {
                let off = (f64::from(bound.value) - exact).abs();
                // Functions are right to 0.8 ulp, that is 1.6 units; second-order terms are a thousandth.
                let ratio = off / (1.7 * unit * f64::from(bound.error));
                assert!(ratio <= 1.0, "program {i} at {x}, {y}: {ratio}");
                tightest[i] = tightest[i].max(ratio);
            }
        }
        assert!(tightest.iter().all(|ratio| *ratio > 0.03), "{tightest:?}");
    }
}
