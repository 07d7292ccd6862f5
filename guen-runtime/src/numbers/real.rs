//! The numbers that everything here is generic over.
//!
//! In goes nothing but arithmetic; out comes one trait, [`Real`], small enough that a new scalar (a lane, an
//! extended-precision number, a [`Dual`](crate::Dual)) can be written in an afternoon, and large enough that
//! every expression of the language has a method, unless it follows from others for every real alike, as
//! [`select`](crate::select) does. Comparison is kept apart in [`Ordered`], because a right-hand
//! side is straight-line code and never compares, and because a register of lanes has no single order.

use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A real number: the scalar of generated equations, of operators and of steppers.
///
/// `f32` and `f64` implement it, and so does [`Dual<R, N>`](crate::Dual) over every `R: Real`.
///
/// - **Constants** enter as exact ratios ([`from_ratio`](Real::from_ratio)) or as sums of scaled integers
///   ([`from_parts`](Real::from_parts)), never as `f64` literals: a run in extended precision must solve the
///   system that was written, and `0.1_f64` is not one tenth.
/// - **Elementary functions** of `f32` and `f64` are our own (sine and cosine, straight-line code with errors below
///   0.8 ulp for `f64`) or those of the crate `libm`, with or without `std`. `std`'s functions may come from the
///   platform, and which ones a dependency calls can change with the features of the build; here the same input
///   gives the same bits in every build. Other functions are other types: see [`WithFunctions`](crate::WithFunctions).
/// - **Domains** are those of IEEE arithmetic: outside of them the result is NaN or infinite, never a panic.
///   Whether a value is usable is asked once per step, with [`is_finite`](Real::is_finite).
///
/// ```
/// use guen_runtime::Real;
///
/// fn pendulum<R: Real>(angle: R) -> R {
///     -R::from_ratio(981, 100) * angle.sin()
/// }
/// assert_eq!(pendulum(0.0_f64), 0.0);
/// assert!((pendulum(f64::pi() / 6.0) + 4.905).abs() < 1e-15);
/// ```
pub trait Real:
    Copy
    + Clone
    + Debug
    + PartialEq
    + Default
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// The number `num / den`, correctly rounded by `f32` and `f64` for all arguments.
    ///
    /// With literal arguments below `2^53` it folds to a constant. `den` is meant to be positive; zero gives
    /// what dividing by zero gives.
    ///
    /// ```
    /// use guen_runtime::Real;
    /// assert_eq!(f64::from_ratio(1, 10), 0.1);
    /// assert_eq!(f64::from_ratio(i64::MIN, i64::MAX), -1.0);
    /// ```
    fn from_ratio(num: i64, den: i64) -> Self;

    /// The real nearest to an `f64`: for settings such as step sizes and tolerances, not for the constants of
    /// a model.
    fn from_f64(value: f64) -> Self;

    /// The nearest `f64`: for messages, step control and plots. Derived reals answer with their value; lanes,
    /// which share their time, with the first lane: [`each_alone`](Real::each_alone) asks all of them.
    fn to_f64(self) -> f64;

    /// The number `sum m 2^e` over `parts = [(m, e), ..]`, in descending order of magnitude.
    ///
    /// This is how constants that do not fit a ratio of two `i64` are written: each part is what the parts
    /// before it leave over, so that the sum is as precise as the longest real needs, and a shorter real drops
    /// the end. Summation runs from the smallest part. If the leading part is the number rounded to the
    /// precision of `f64` (or `f32`), that is the result, exactly. The scaling is done in steps, so that no
    /// intermediate overflows unless the result does. No parts give zero.
    ///
    /// ```
    /// use guen_runtime::Real;
    /// // Planck's constant: 53 bits, and what they leave over.
    /// let h = f64::from_parts(&[(7_747_209_898_635_537, -163), (7_344_971_895_625_565_100, -228)]);
    /// assert_eq!(h, 6.62607015e-34);
    /// ```
    #[inline(never)]
    fn from_parts(parts: &[(i64, i32)]) -> Self {
        let mut sum = Self::zero();
        for &(mantissa, exponent) in parts.iter().rev() {
            sum += scaled(Self::from_ratio(mantissa, 1), exponent);
        }
        sum
    }

    /// Zero.
    #[inline]
    fn zero() -> Self {
        Self::from_ratio(0, 1)
    }

    /// One.
    #[inline]
    fn one() -> Self {
        Self::from_ratio(1, 1)
    }

    /// The ratio of a circle's circumference to its diameter.
    fn pi() -> Self;

    /// The distance from one to the next larger number.
    fn epsilon() -> Self;

    /// Sine and cosine together; the angle is in radians. Generated code calls this once per angle.
    fn sin_cos(self) -> (Self, Self);

    /// Sines and cosines of two angles. Generated code calls this where two angles are known at the same time:
    /// registers of two lanes have them for little more than the price of one.
    ///
    /// ```
    /// use guen_runtime::Real;
    /// assert_eq!(Real::sin_cos_pair(0.5, 2.0), (Real::sin_cos(0.5), Real::sin_cos(2.0)));
    /// ```
    #[inline(always)]
    fn sin_cos_pair(first: Self, second: Self) -> ((Self, Self), (Self, Self)) {
        (first.sin_cos(), second.sin_cos())
    }

    // Reals that are made of lanes, where a call would lose their instructions, have these inlined always. For all reals it cost
    // DOP853 on the hoop 3.5 percent: other functions were inlined no longer.
    /// Sine.
    #[inline]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    /// Cosine.
    #[inline]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    /// Tangent.
    #[inline]
    fn tan(self) -> Self {
        let (sin, cos) = self.sin_cos();
        sin / cos
    }

    /// Cotangent, `cos x / sin x`.
    #[inline]
    fn cot(self) -> Self {
        let (sin, cos) = self.sin_cos();
        cos / sin
    }

    /// Inverse sine, in `[-pi/2, pi/2]`.
    fn asin(self) -> Self;

    /// Inverse cosine, in `[0, pi]`.
    fn acos(self) -> Self;

    /// Inverse tangent, in `(-pi/2, pi/2)`.
    fn atan(self) -> Self;

    /// The angle of the point `(x, self)` of the plane, in `[-pi, pi]`: `y.atan2(x)`.
    fn atan2(self, x: Self) -> Self;

    /// Hyperbolic sine.
    fn sinh(self) -> Self;

    /// Hyperbolic cosine.
    fn cosh(self) -> Self;

    /// Hyperbolic tangent.
    fn tanh(self) -> Self;

    /// Exponential function.
    fn exp(self) -> Self;

    /// Natural logarithm.
    fn ln(self) -> Self;

    /// Nonnegative square root.
    fn sqrt(self) -> Self;

    /// The real `q`-th root, `q >= 1`. An odd root of a negative number is negative, an even one NaN; `q = 0`
    /// gives NaN.
    ///
    /// ```
    /// use guen_runtime::Real;
    /// assert_eq!((-32.0_f64).root(5), -2.0);
    /// assert!((-1.0_f64).root(4).is_nan());
    /// ```
    fn root(self, q: u32) -> Self;

    /// Absolute value.
    fn abs(self) -> Self;

    /// The sign: -1, 0 or 1. Unlike `f64::signum`, the sign of either zero is 0.
    fn sign(self) -> Self;

    /// The largest integer that is not larger.
    ///
    /// ```
    /// use guen_runtime::Real;
    /// assert_eq!((Real::floor(2.5_f64), Real::floor(-2.5_f64)), (2.0, -3.0));
    /// ```
    #[inline]
    fn floor(self) -> Self {
        Self::each_alone(|alone| libm::floor(alone(self)))
    }

    /// The power `self^n`, by repeated squaring: at most `2 log2 |n|` products, and a reciprocal for negative
    /// `n`. `x^0` is 1 for every `x`.
    ///
    /// Kept out of line: inlined loops in long straight-line programs cost more compile time than they save.
    #[inline(never)]
    fn powi(self, n: i32) -> Self {
        let mut rest = n.unsigned_abs();
        let mut square = self;
        let mut product = Self::one();
        while rest > 0 {
            if rest & 1 == 1 {
                product *= square;
            }
            rest >>= 1;
            // Not squared after the last bit: that could overflow for nothing.
            if rest > 0 {
                square *= square;
            }
        }
        if n < 0 { product.recip() } else { product }
    }

    /// The reciprocal, `1 / self`.
    #[inline]
    fn recip(self) -> Self {
        Self::one() / self
    }

    /// `self * b + c`. With one rounding where the real is [`Fused`](crate::Fused); every other real rounds twice, as
    /// if it were written so. Generated code calls this and the next two for products that are used in one sum.
    ///
    /// Not named `mul_add`, because `f64` has a method of that name, which rounds once.
    ///
    /// ```
    /// use guen_runtime::Real;
    /// assert_eq!(2.0_f64.times_plus(3.0, 4.0), 10.0);
    /// ```
    #[inline(always)]
    fn times_plus(self, b: Self, c: Self) -> Self {
        self * b + c
    }

    /// `self * b - c`, as [`times_plus`](Real::times_plus).
    #[inline(always)]
    fn times_minus(self, b: Self, c: Self) -> Self {
        self * b - c
    }

    /// `self - b * c`, as [`times_plus`](Real::times_plus).
    #[inline(always)]
    fn minus_times(self, b: Self, c: Self) -> Self {
        self - b * c
    }

    /// Calls a function, with the instructions that the real consists of at hand.
    ///
    /// For numbers this is the call and nothing else. For [`Lanes`](crate::numbers::lanes::Lanes), whose instructions a
    /// default build must not use everywhere, it is a function compiled for them into which the argument is inlined:
    /// so the argument should be a closure marked `#[inline(always)]`, around straight-line code. Calls nest.
    ///
    /// ```
    /// use guen_runtime::Real;
    ///
    /// fn square<R: Real>(x: R) -> R {
    ///     R::vectorize(#[inline(always)] || x * x)
    /// }
    /// assert_eq!(square(3.0), 9.0);
    /// ```
    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        function()
    }

    /// Calls a function where the longest registers of the processor may be used for arrays of the real: for loops over
    /// adjacent numbers. As of [`vectorize`](Real::vectorize), the argument should be a closure marked
    /// `#[inline(always)]`. The bits do not depend on the registers. For `f32` and `f64` the processor is asked when the
    /// program runs (with the feature `std`); every other real calls and nothing else.
    ///
    /// ```
    /// use guen_runtime::Real;
    ///
    /// fn double<R: Real>(numbers: &mut [R; 16]) {
    ///     R::wide(#[inline(always)] || numbers.iter_mut().for_each(|x| *x += *x));
    /// }
    /// let mut numbers = [1.5; 16];
    /// double(&mut numbers);
    /// assert_eq!(numbers, [3.0; 16]);
    /// ```
    #[inline(always)]
    fn wide<T>(function: impl FnOnce() -> T) -> T {
        function()
    }

    /// `above` where this is above the limit or cannot be compared with it, `below` elsewhere: in every lane by itself, where
    /// the real consists of [`Lanes`](crate::numbers::lanes::Lanes).
    ///
    /// ```
    /// use guen_runtime::Real;
    /// assert_eq!(2.0_f64.where_above(1.0, 10.0, 20.0), 10.0);
    /// assert_eq!(1.0_f64.where_above(1.0, 10.0, 20.0), 20.0);
    /// assert_eq!(f64::NAN.where_above(1.0, 10.0, 20.0), 10.0);
    /// ```
    #[inline(always)]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        if self.to_f64() <= limit.to_f64() { below } else { above }
    }

    /// Applies a function of doubles in every lane by itself, where the real consists of
    /// [`Lanes`](crate::numbers::lanes::Lanes): it is given the function that takes the number of its lane out of a
    /// real.
    ///
    /// ```
    /// use guen_runtime::Real;
    /// let (x, y) = (3.0_f64, 4.0);
    /// assert_eq!(f64::each_alone(|alone| alone(x).hypot(alone(y))), 5.0);
    /// ```
    fn each_alone(function: impl Fn(&dyn Fn(Self) -> f64) -> f64) -> Self {
        Self::from_f64(function(&Self::to_f64))
    }

    /// Whether the number is neither infinite nor NaN; of a composed number, whether all its parts are finite.
    fn is_finite(self) -> bool;
}

/// A real with an order, as adaptive step control needs it: every real that is `PartialOrd`. Lanes are not, since each has its own
/// error.
pub trait Ordered: Real + PartialOrd {}

impl<R: Real + PartialOrd> Ordered for R {}

/// `value * 2^exponent` in factors of at most `2^60`, which every real represents exactly.
fn scaled<R: Real>(value: R, exponent: i32) -> R {
    const STRIDE: u32 = 60;
    let mut scaled = value;
    let mut rest = exponent.unsigned_abs();
    while rest > 0 {
        let stride = rest.min(STRIDE);
        let power = 1_i64 << stride;
        scaled *= if exponent < 0 { R::from_ratio(1, power) } else { R::from_ratio(power, 1) };
        rest -= stride;
    }
    scaled
}
