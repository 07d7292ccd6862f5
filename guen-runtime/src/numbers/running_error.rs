//! A real that counts roundings: how much of a value is left where terms cancel.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::numbers::lift::Lift;
use crate::numbers::real::Real;
use crate::numbers::rules::{assign_operators, by_slopes};

/// A value beside a bound of its error, in units of the unit roundoff `u`, half of [`epsilon`](Real::epsilon).
///
/// ```text
/// e(a + b) = e(a) + e(b) + |a + b|,   e(a b) = |a| e(b) + |b| e(a) + |a b|,   e(f(a)) = |f'(a)| e(a) + c_f |f(a)|
/// ```
///
/// - `value`: what the real below computes, to the bit; `error`: by how much, times the unit roundoff, arguments that
///   are off by their own errors and every rounding on the way can have moved it.
/// - What an operation adds is bounded for all arguments whose results neither overflow nor underflow. Errors of arguments count to first
///   order: terms with `u^2` are left out, and slopes are those at the value, so that next to a singularity of `f`, as of the arc sine
///   at one, an argument that is not exact has to be nearer to its value than to the singularity.
/// - `|value| / error` is one where nothing cancels, and the part that is left where something does: a function that
///   must not vanish is at that *relative distance* from its zero. See [`Guarded::singularities`](crate::Guarded::singularities).
/// - A running error analysis (Wilkinson): errors that cancel each other are not seen, so that the bound grows along
///   long programs. A product costs three further products and three sums. Of lanes, each counts its own.
///
/// What a function adds, in units `u |f|`, for `f64`, `f32` and lanes. An error of one ulp, the spacing of numbers at the result, is
/// at most two of these units. The last columns are the worst that were found over ten million arguments of each
/// (`cargo test --release -p guen-runtime --test numbers running_error -- --include-ignored --nocapture`).
///
/// | functions | `c_f` | why | `f64` | `f32` |
/// | --- | --- | --- | --- | --- |
/// | `+ - * /`, `sqrt`, `recip`, `pi`, ratios | 1 | rounded once; a ratio that is a short number is exact | 1.00 | 1.00 |
/// | `sin`, `cos`, `sin_cos` | 2 | our own are below 0.8 ulp, 1.6 units; those of `f32` are rounded from `f64` | 1.15 | 1.00 |
/// | `tan` | 6 | as `sin/cos` 2 + 2 + 1; libm's, in `f64` and `f32`, is below 1 ulp | 1.25 | 1.30 |
/// | `cot` | 6 | `1/tan` adds one to it | 1.83 | 1.79 |
/// | `exp`, `ln` | 2 | libm states below 1 ulp for both | 1.35 | 1.35 |
/// | `atan` | 3 | a table's angle and a reduced argument `t`, of at most a third of it, with two roundings: 1 + 2/3 + 1/3 | 1.42 | 1.36 |
/// | `atan2` | 5 | the quotient 1, `atan` 3, the difference from pi 1 | 2.28 | 2.08 |
/// | `asin`, `acos` | 4 | a polynomial of a root: the root 1, the product 1, twice of it a sum 1; near zero 1 + a twentieth | 1.67 | 1.74 |
/// | `sinh` | 5 | of `t = expm1(x)`, below 1 ulp, with slope at most one: 2; `t + 1`, quotient and sum 3 | 2.31 | 2.31 |
/// | `cosh` | 5 | of `exp`: 2; reciprocal and sum 2 | 1.98 | 2.00 |
/// | `tanh` | 5 | libm states up to 2 ulp between 0.1 and 0.2554, and less elsewhere | 2.81 | 2.79 |
/// | `root` | 3 | of order 3 libm's is below 0.667 ulp; others end with a step of Newton's method, of a power below 0.7 ulp: 1 + (1.4 + 1)/4 | 1.20 | 1.00 |
///
/// Of reals whose functions have other errors, as [`WithFunctions`](crate::WithFunctions) with thirteen digits, the bound is too small by as much.
///
/// ```
/// use guen_runtime::{Real, RunningError};
///
/// let angle = RunningError::once(3.0);
/// assert!(angle.sin().left() > 0.03);
/// // Next to its zero at pi a sine is as uncertain as the angle, and small.
/// let angle = RunningError::once(f64::pi() - 1e-9);
/// assert!(angle.sin().left() < 1e-9);
/// // Next to its zero at zero it is not: a small angle has all its digits.
/// assert!(RunningError::once(1e-9_f64).sin().left() > 0.3);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunningError<R> {
    /// The value.
    pub value: R,
    /// The bound of its error, in units of the unit roundoff; not negative.
    pub error: R,
}

// Always: an operation of lanes that is a call loses their instructions.
impl<R: Real> RunningError<R> {
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

    /// Returns how certain the value is: `|value| / error`, at most one for anything that was rounded; infinite for
    /// an exact number that is not zero.
    #[inline(always)]
    pub fn left(self) -> R {
        self.value.abs() / self.error
    }

    /// `f(a)`, from its value, its slope and what the function adds, in units of its value.
    #[inline(always)]
    fn chain(self, value: R, slope: R, own: i64) -> Self {
        // An exact argument moves nothing, even where the slope is infinite; an error that is NaN stays that.
        let moved = self.error.where_above(R::zero(), slope.abs() * self.error, self.error);
        Self { value, error: moved + R::from_ratio(own, 1) * value.abs() }
    }
}

// A constant is as exact as a parameter of a declared system: rounded once.
impl<B, R: Lift<B>> Lift<B> for RunningError<R> {
    #[inline(always)]
    fn lift(base: B) -> Self {
        Self::once(R::lift(base))
    }
}

impl<R: Real> Add for RunningError<R> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + value.abs() }
    }
}

impl<R: Real> Sub for RunningError<R> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let value = self.value - other.value;
        Self { value, error: self.error + other.error + value.abs() }
    }
}

impl<R: Real> Mul for RunningError<R> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        let error = self.value.abs() * other.error + other.value.abs() * self.error + value.abs();
        Self { value, error }
    }
}

impl<R: Real> Div for RunningError<R> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let error = (self.error + value.abs() * other.error) / other.value.abs() + value.abs();
        Self { value, error }
    }
}

impl<R: Real> Neg for RunningError<R> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: -self.value, error: self.error }
    }
}

assign_operators!(RunningError<R>, R: Real);

/// The errors that functions add, in units of their values: see [`RunningError`].
mod own {
    pub(super) const SINE: i64 = 2;
    pub(super) const TANGENT: i64 = 6;
    pub(super) const EXPONENTIAL: i64 = 2;
    pub(super) const ARC_TANGENT: i64 = 3;
    pub(super) const ANGLE: i64 = 5;
    pub(super) const INVERSE: i64 = 4;
    pub(super) const HYPERBOLIC: i64 = 5;
    pub(super) const SQUARE_ROOT: i64 = 1;
    pub(super) const ROOT: i64 = 3;
}

/// Whether a ratio is a number of at most 24 bits, as every real keeps it.
#[inline(always)]
fn is_short(num: i64, den: i64) -> bool {
    const MANTISSA_LIMIT: u64 = 1 << 24;
    let (num, den) = (num.unsigned_abs(), den.unsigned_abs());
    den != 0
        && if den.is_power_of_two() {
            num <= MANTISSA_LIMIT
        } else {
            num % den == 0 && num / den <= MANTISSA_LIMIT
        }
}

impl<R: Real> Real for RunningError<R> {
    /// Exact where the ratio is a number of few bits, by its denominator: one, or a power of two, in any form. Others
    /// are rounded once.
    #[inline(always)]
    fn from_ratio(num: i64, den: i64) -> Self {
        let value = R::from_ratio(num, den);
        if is_short(num, den) { Self::exact(value) } else { Self::once(value) }
    }

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        let real = R::from_f64(value);
        if real.to_f64() == value { Self::exact(real) } else { Self::once(real) }
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

    // tan' = 1 + tan^2
    #[inline(always)]
    fn tan(self) -> Self {
        let tan = self.value.tan();
        self.chain(tan, R::one() + tan * tan, own::TANGENT)
    }

    // cot' = -1 - cot^2
    #[inline(always)]
    fn cot(self) -> Self {
        let cot = self.value.cot();
        self.chain(cot, R::one() + cot * cot, own::TANGENT)
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

    by_slopes!(inline(always), own);

    // d atan2(y, x) = (x dy - y dx) / (x^2 + y^2)
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        let square = x.value * x.value + self.value * self.value;
        let turned = x.value.abs() * self.error + self.value.abs() * x.error;
        let moved = turned.where_above(R::zero(), turned / square, turned);
        Self { value, error: moved + R::from_ratio(own::ANGLE, 1) * value.abs() }
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
    fn floor(self) -> Self {
        Self::exact(self.value.floor())
    }

    #[inline(always)]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        let choose = |above: R, below: R| self.value.where_above(limit.value, above, below);
        Self { value: choose(above.value, below.value), error: choose(above.error, below.error) }
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

/// Values that were rounded once.
///
/// ```
/// use guen_runtime::{RunningError, checks::rounded};
/// assert_eq!(rounded(&[1.5, -2.0])[1], RunningError { value: -2.0, error: 2.0 });
/// ```
#[inline(always)]
pub fn rounded<R: Real, const N: usize>(values: &[R; N]) -> [RunningError<R>; N] {
    let mut rounded = [RunningError::exact(R::zero()); N];
    // A loop where the instructions of lanes are at hand: `map` is a call for each entry.
    R::vectorize(
        #[inline(always)]
        || {
            for (rounded, value) in rounded.iter_mut().zip(values) {
                *rounded = RunningError { value: *value, error: value.abs() };
            }
        },
    );
    rounded
}

#[cfg(test)]
mod tests {
    use super::RunningError;
    use crate::numbers::real::Real;

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
            let bounds = program(RunningError::exact(x), RunningError::exact(y));
            let exact = program(f64::from(x), f64::from(y));
            for (i, (bound, exact)) in bounds.iter().zip(exact).enumerate() {
                let off = (f64::from(bound.value) - exact).abs();
                // Second-order terms are a thousandth.
                let ratio = off / (1.001 * unit * f64::from(bound.error));
                assert!(ratio <= 1.0, "program {i} at {x}, {y}: {ratio}");
                tightest[i] = tightest[i].max(ratio);
            }
        }
        assert!(tightest.iter().all(|ratio| *ratio > 0.03), "{tightest:?}");
    }
}
