//! Forward derivatives: numbers that carry the change of their value along `N` directions.
//!
//! A dual is written `u + du`, with `du` a row of `N` tangents whose products vanish. Each function applies its
//! own exact derivative, so what comes out is the derivative of the program to rounding, not a difference
//! quotient. Duals are generic over the real beneath, hence nest: a dual of duals holds second derivatives.

use core::array::from_fn;
use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::numbers::real::{Ordered, Real};
use crate::numbers::rules::{assign_operators, by_slopes};

/// A value and its derivatives along `N` directions.
///
/// ```text
/// f(u + du) = f(u) + f'(u) du
/// ```
///
/// - `value`: the number itself; `tangent[k]`: its derivative along direction `k`, in units of the value by
///   units of the direction.
/// - Equality compares the value and every tangent: two duals are equal if they are the same number *and* vary
///   alike. Order is that of the values; where they are equal and the tangents are not, there is none. So `<`
///   and `>` compare values, and `a <= b` is no substitute for `!(a > b)`.
/// - Where a function has no derivative (`sqrt` and `abs` at zero), the tangent follows the formula: infinite or
///   NaN for the root, zero for `abs` and `sign`.
/// - A product costs `2 N + 1` products; a function costs the function, its derivative and `N` products. No
///   allocation.
///
/// ```
/// use guen_runtime::{Dual, Real};
///
/// // d/dx and d/dy of x sin(y) at (2, 0)
/// let x = Dual::<f64, 2>::variable(2.0, 0);
/// let y = Dual::<f64, 2>::variable(0.0, 1);
/// assert_eq!((x * y.sin()).tangent, [0.0, 2.0]);
///
/// // the second derivative of x^3 at 2 is 12
/// let inner = Dual::<f64, 1>::variable(2.0, 0);
/// let x = Dual::<Dual<f64, 1>, 1>::variable(inner, 0);
/// assert_eq!(x.powi(3).tangent[0].tangent[0], 12.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<R, const N: usize> {
    /// The value.
    pub value: R,
    /// The derivatives of the value along the `N` directions.
    pub tangent: [R; N],
}

impl<R: Real, const N: usize> Dual<R, N> {
    /// A number that varies along no direction.
    #[inline]
    pub fn constant(value: R) -> Self {
        Self { value, tangent: [R::zero(); N] }
    }

    /// The variable whose change is direction `index`: unit tangent there, zero elsewhere.
    ///
    /// # Panics
    ///
    /// If `index` is not below `N`.
    #[inline]
    pub fn variable(value: R, index: usize) -> Self {
        let mut dual = Self::constant(value);
        dual.tangent[index] = R::one();
        dual
    }

    /// `f(u) + f'(u) du`, from the value and the slope of `f` at `u`.
    #[inline]
    fn chain(&self, value: R, slope: R) -> Self {
        whole(|| Self { value, tangent: self.tangent.map(|du| slope * du) })
    }

    /// The tangents of two duals, combined one by one.
    #[inline]
    fn zip(&self, other: &Self, combine: impl Fn(R, R) -> R) -> [R; N] {
        from_fn(|k| combine(self.tangent[k], other.tangent[k]))
    }
}

/// A dual.
///
/// One with more than a few tangents is computed out of line, by one function for each kind of operation: where a long function is
/// evaluated in duals, all tangents of all its operations in one block take rustc minutes.
#[inline(always)]
fn whole<R: Real, const N: usize>(compute: impl FnOnce() -> Dual<R, N>) -> Dual<R, N> {
    /// The number of directions up to which functions are inlined: a call costs as many nanoseconds as so many tangents.
    const INLINED_DIRECTIONS: usize = 8;
    if N > INLINED_DIRECTIONS { apart(compute) } else { compute() }
}

#[inline(never)]
#[allow(
    clippy::redundant_closure,
    reason = "the closure around it is compiled with the instructions of the real"
)]
fn apart<R: Real, const N: usize>(compute: impl FnOnce() -> Dual<R, N>) -> Dual<R, N> {
    R::vectorize(
        #[inline(always)]
        || compute(),
    )
}

impl<R: Real, const N: usize> Default for Dual<R, N> {
    /// The constant of the real's own default, zero for floats.
    #[inline]
    fn default() -> Self {
        Self::constant(R::default())
    }
}

impl<R: Real, const N: usize> Add for Dual<R, N> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        whole(|| Self { value: self.value + other.value, tangent: self.zip(&other, |du, dv| du + dv) })
    }
}

impl<R: Real, const N: usize> Sub for Dual<R, N> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        whole(|| Self { value: self.value - other.value, tangent: self.zip(&other, |du, dv| du - dv) })
    }
}

impl<R: Real, const N: usize> Mul for Dual<R, N> {
    type Output = Self;

    // d(u v) = v du + u dv
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the rule of products has other operators in it")]
    #[inline]
    fn mul(self, other: Self) -> Self {
        whole(|| {
            let (u, v) = (self.value, other.value);
            Self { value: u * v, tangent: self.zip(&other, |du, dv| v.times_plus(du, u * dv)) }
        })
    }
}

impl<R: Real, const N: usize> Div for Dual<R, N> {
    type Output = Self;

    // d(u / v) = (du - (u / v) dv) / v
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the rule of quotients has other operators in it")]
    #[inline]
    fn div(self, other: Self) -> Self {
        whole(|| {
            let ratio = self.value / other.value;
            Self { value: ratio, tangent: self.zip(&other, |du, dv| (du - ratio * dv) / other.value) }
        })
    }
}

impl<R: Real, const N: usize> Neg for Dual<R, N> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        whole(|| Self { value: -self.value, tangent: self.tangent.map(|du| -du) })
    }
}

assign_operators!(Dual<R, N>, R: Real, const N: usize);

impl<R: Ordered, const N: usize> PartialOrd for Dual<R, N> {
    /// Compares by value; duals are equal only if the tangents are, too.
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.value.partial_cmp(&other.value) {
            Some(Ordering::Equal) if self != other => None,
            order => order,
        }
    }
}

impl<R: Real, const N: usize> Real for Dual<R, N> {
    #[inline]
    fn from_ratio(num: i64, den: i64) -> Self {
        Self::constant(R::from_ratio(num, den))
    }

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self::constant(R::from_f64(value))
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self.value.to_f64()
    }

    #[inline]
    fn from_parts(parts: &[(i64, i32)]) -> Self {
        Self::constant(R::from_parts(parts))
    }

    #[inline]
    fn pi() -> Self {
        Self::constant(R::pi())
    }

    #[inline]
    fn epsilon() -> Self {
        Self::constant(R::epsilon())
    }

    // d(u v + w) = (v du + u dv) + dw
    #[inline]
    fn times_plus(self, b: Self, c: Self) -> Self {
        whole(|| {
            let (u, v) = (self.value, b.value);
            let product = |k: usize| v.times_plus(self.tangent[k], u * b.tangent[k]);
            Self { value: u.times_plus(v, c.value), tangent: from_fn(|k| product(k) + c.tangent[k]) }
        })
    }

    #[inline]
    fn times_minus(self, b: Self, c: Self) -> Self {
        whole(|| {
            let (u, v) = (self.value, b.value);
            let product = |k: usize| v.times_plus(self.tangent[k], u * b.tangent[k]);
            Self { value: u.times_minus(v, c.value), tangent: from_fn(|k| product(k) - c.tangent[k]) }
        })
    }

    #[inline]
    fn minus_times(self, b: Self, c: Self) -> Self {
        whole(|| {
            let (u, v) = (b.value, c.value);
            let product = |k: usize| v.times_plus(b.tangent[k], u * c.tangent[k]);
            Self { value: self.value.minus_times(u, v), tangent: from_fn(|k| self.tangent[k] - product(k)) }
        })
    }

    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        R::vectorize(function)
    }

    by_slopes!(inline);

    #[inline]
    fn sin_cos_pair(first: Self, second: Self) -> ((Self, Self), (Self, Self)) {
        let ((sin, cos), (next_sin, next_cos)) = R::sin_cos_pair(first.value, second.value);
        (
            (first.chain(sin, cos), first.chain(cos, -sin)),
            (second.chain(next_sin, next_cos), second.chain(next_cos, -next_sin)),
        )
    }

    #[inline]
    fn sin(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(sin, cos)
    }

    #[inline]
    fn cos(self) -> Self {
        let (sin, cos) = self.value.sin_cos();
        self.chain(cos, -sin)
    }

    // tan' = 1 + tan^2
    #[inline]
    fn tan(self) -> Self {
        let tan = self.value.tan();
        self.chain(tan, R::one() + tan * tan)
    }

    // cot' = -(1 + cot^2)
    #[inline]
    fn cot(self) -> Self {
        let cot = self.value.cot();
        self.chain(cot, -(R::one() + cot * cot))
    }

    // d atan2(y, x) = (x dy - y dx) / (x^2 + y^2)
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let square = x.value * x.value + self.value * self.value;
        let (along_y, along_x) = (x.value / square, self.value / square);
        Self { value: self.value.atan2(x.value), tangent: self.zip(&x, |dy, dx| along_y * dy - along_x * dx) }
    }

    // |u|' = sign u
    #[inline]
    fn abs(self) -> Self {
        self.chain(self.value.abs(), self.value.sign())
    }

    // constant on both sides of zero
    #[inline]
    fn sign(self) -> Self {
        Self::constant(self.value.sign())
    }

    // constant between whole numbers
    #[inline]
    fn floor(self) -> Self {
        Self::constant(self.value.floor())
    }

    // (u^n)' = n u^(n - 1), and u^0 does not vary
    #[inline(never)]
    fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::one();
        }
        let slope = R::from_ratio(i64::from(n), 1) * self.value.powi(n.saturating_sub(1));
        self.chain(self.value.powi(n), slope)
    }

    // (1 / u)' = -1 / u^2
    #[inline]
    fn recip(self) -> Self {
        let recip = self.value.recip();
        self.chain(recip, -(recip * recip))
    }

    #[inline]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        let choose = |above: R, below: R| self.value.where_above(limit.value, above, below);
        Self { value: choose(above.value, below.value), tangent: above.zip(&below, choose) }
    }

    fn each_alone(function: impl Fn(&dyn Fn(Self) -> f64) -> f64) -> Self {
        Self::constant(R::each_alone(|alone| function(&|x| alone(x.value))))
    }

    /// Whether the value and every tangent is finite.
    #[inline]
    fn is_finite(self) -> bool {
        self.value.is_finite() && self.tangent.iter().all(|du| du.is_finite())
    }
}
