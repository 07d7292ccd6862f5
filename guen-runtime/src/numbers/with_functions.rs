//! Reals with exchanged functions: the platform's, shorter polynomials, fused multiply-add.
//!
//! A [`WithFunctions`] number is the number inside, with the operations of some [`Functions`] in place of its own. As it is a
//! type, a program can hold several at once and compare them, and nobody changes the results of somebody else.

use core::fmt::Debug;
use core::marker::PhantomData;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use crate::numbers::lanes::{Lanes, Mask};
use crate::numbers::lift::Lift;
use crate::numbers::real::Real;

/// A number with the platform's elementary functions, those of `std`: 0.5 to 1 ulp with most C libraries, but other
/// bits on other platforms and in other versions of them. Needs the feature `std`.
///
/// ```
/// # #[cfg(feature = "std")] {
/// use guen_runtime::{Real, Std};
/// assert_eq!(Std::new(0.5).sin().value, 0.5_f64.sin());
/// # }
/// ```
#[cfg(feature = "std")]
pub type Std<R = f64> = WithFunctions<R, StdFunctions>;

/// A number whose `sin_cos` errs by less than 1e-13, absolutely, and takes some 15 operations less.
///
/// ```
/// use guen_runtime::{Approx13, Real};
/// let (sin, cos) = Approx13::new(2.0).sin_cos();
/// assert!((sin.value - 2.0_f64.sin()).abs() < 1e-13 && (cos.value - 2.0_f64.cos()).abs() < 1e-13);
/// ```
pub type Approx13<R = f64> = WithFunctions<R, Approx13Functions>;

/// A number whose `sin_cos` errs by less than 4e-8, absolutely: for games, and where a model is no better than that.
///
/// ```
/// use guen_runtime::{Approx7, Real};
/// let (sin, cos) = Approx7::new(2.0).sin_cos();
/// assert!((sin.value - 2.0_f64.sin()).abs() < 4e-8 && (cos.value - 2.0_f64.cos()).abs() < 4e-8);
/// ```
pub type Approx7<R = f64> = WithFunctions<R, Approx7Functions>;

/// A number that rounds products and sums together where generated code allows it: fewer instructions and fewer
/// roundings, other bits than without. On x86-64 the instruction is chosen at run time; where the processor has none
/// the result is the same, but slow.
///
/// ```
/// use guen_runtime::{Fused, Real};
/// let x = Fused::new(1.0 + f64::EPSILON);
/// // The square of an epsilon is lost, unless product and difference are rounded together.
/// let square = x.times_minus(x, Fused::new(1.0 + 2.0 * f64::EPSILON));
/// assert_eq!(square.value, f64::EPSILON * f64::EPSILON);
/// ```
pub type Fused<R = f64> = WithFunctions<R, FusedOperations>;

/// A real `R` with some operations exchanged by `F`; it lifts constants of base `f64` like `R` itself, nests in
/// duals, and is [`Lanes`] if `R` is.
///
/// ```
/// use guen_runtime::{Approx7, Dual, Fused, Real};
///
/// // The derivative of sin^2, with short polynomials and fused operations.
/// let x = Dual::<Fused<Approx7>, 1>::variable(Fused::new(Approx7::new(0.3)), 0);
/// let square = x.sin().powi(2);
/// assert!((square.tangent[0].to_f64() - 0.6_f64.sin()).abs() < 1e-7);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct WithFunctions<R, F> {
    /// The number.
    pub value: R,
    functions: PhantomData<F>,
}

impl<R, F> WithFunctions<R, F> {
    /// The number, from now on with the other operations.
    #[inline(always)]
    pub const fn new(value: R) -> Self {
        Self { value, functions: PhantomData }
    }
}

impl<R, F> From<R> for WithFunctions<R, F> {
    #[inline(always)]
    fn from(value: R) -> Self {
        Self::new(value)
    }
}

macro_rules! functions {
    ($($method:ident)*) => {
        /// Operations to be exchanged in a real; what is not overridden stays the real's own.
        ///
        /// ```
        /// use guen_runtime::{Functions, Real, WithFunctions};
        ///
        /// /// Pendulums of a time when sines were expensive.
        /// #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
        /// struct SmallAngles;
        ///
        /// impl<R: Real> Functions<R> for SmallAngles {
        ///     fn sin_cos(x: R) -> (R, R) {
        ///         (x, R::one())
        ///     }
        /// }
        ///
        /// assert_eq!(WithFunctions::<f64, SmallAngles>::new(0.2).sin().value, 0.2);
        /// ```
        pub trait Functions<R: Real>: Copy + Debug + Default + PartialEq + PartialOrd + 'static {
            /// [`Real::sin_cos`]; [`Real::sin`] and [`Real::cos`] are taken from it.
            #[inline(always)]
            fn sin_cos(x: R) -> (R, R) {
                x.sin_cos()
            }

            /// [`Real::sin_cos_pair`].
            #[inline(always)]
            fn sin_cos_pair(first: R, second: R) -> ((R, R), (R, R)) {
                (Self::sin_cos(first), Self::sin_cos(second))
            }

            $(
                #[doc = concat!("[`Real::", stringify!($method), "`].")]
                #[inline(always)]
                fn $method(x: R) -> R {
                    x.$method()
                }
            )*

            /// [`Real::atan2`].
            #[inline(always)]
            fn atan2(y: R, x: R) -> R {
                y.atan2(x)
            }

            /// [`Real::root`].
            #[inline(always)]
            fn root(x: R, q: u32) -> R {
                x.root(q)
            }

            /// [`Real::times_plus`]; [`Real::times_minus`] and [`Real::minus_times`] are taken from it, with signs
            /// turned.
            #[inline(always)]
            fn times_plus(a: R, b: R, c: R) -> R {
                a.times_plus(b, c)
            }

            /// [`Real::vectorize`].
            #[inline(always)]
            fn vectorize<T>(function: impl FnOnce() -> T) -> T {
                R::vectorize(function)
            }
        }

        impl<R: Real, F: Functions<R>> Real for WithFunctions<R, F> {
            $(
                #[inline(always)]
                fn $method(self) -> Self {
                    Self::new(F::$method(self.value))
                }
            )*

            #[inline(always)]
            fn from_ratio(num: i64, den: i64) -> Self {
                Self::new(R::from_ratio(num, den))
            }

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                Self::new(R::from_f64(value))
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.value.to_f64()
            }

            #[inline(always)]
            fn from_parts(parts: &[(i64, i32)]) -> Self {
                Self::new(R::from_parts(parts))
            }

            #[inline(always)]
            fn zero() -> Self {
                Self::new(R::zero())
            }

            #[inline(always)]
            fn one() -> Self {
                Self::new(R::one())
            }

            #[inline(always)]
            fn pi() -> Self {
                Self::new(R::pi())
            }

            #[inline(always)]
            fn epsilon() -> Self {
                Self::new(R::epsilon())
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                let (sin, cos) = F::sin_cos(self.value);
                (Self::new(sin), Self::new(cos))
            }

            #[inline(always)]
            fn sin_cos_pair(first: Self, second: Self) -> ((Self, Self), (Self, Self)) {
                let ((sin, cos), (next_sin, next_cos)) = F::sin_cos_pair(first.value, second.value);
                ((Self::new(sin), Self::new(cos)), (Self::new(next_sin), Self::new(next_cos)))
            }

            #[inline(always)]
            fn atan2(self, x: Self) -> Self {
                Self::new(F::atan2(self.value, x.value))
            }

            #[inline(always)]
            fn root(self, q: u32) -> Self {
                Self::new(F::root(self.value, q))
            }

            #[inline(always)]
            fn abs(self) -> Self {
                Self::new(self.value.abs())
            }

            #[inline(always)]
            fn sign(self) -> Self {
                Self::new(self.value.sign())
            }

            #[inline(always)]
            fn floor(self) -> Self {
                Self::new(self.value.floor())
            }

            #[inline(always)]
            fn powi(self, n: i32) -> Self {
                Self::new(self.value.powi(n))
            }

            #[inline(always)]
            fn recip(self) -> Self {
                Self::new(self.value.recip())
            }

            #[inline(always)]
            fn times_plus(self, b: Self, c: Self) -> Self {
                Self::new(F::times_plus(self.value, b.value, c.value))
            }

            #[inline(always)]
            fn times_minus(self, b: Self, c: Self) -> Self {
                Self::new(F::times_plus(self.value, b.value, -c.value))
            }

            #[inline(always)]
            fn minus_times(self, b: Self, c: Self) -> Self {
                Self::new(F::times_plus(-b.value, c.value, self.value))
            }

            #[inline(always)]
            fn vectorize<T>(function: impl FnOnce() -> T) -> T {
                F::vectorize(function)
            }

            #[inline(always)]
            fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
                Self::new(self.value.where_above(limit.value, above.value, below.value))
            }

            fn each_alone(function: impl Fn(&dyn Fn(Self) -> f64) -> f64) -> Self {
                Self::new(R::each_alone(|alone| function(&|x| alone(x.value))))
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                self.value.is_finite()
            }
        }
    };
}

functions! { tan asin acos atan sinh cosh tanh exp ln sqrt }

macro_rules! operators {
    ($($trait:ident $method:ident $assign:ident $assign_method:ident $operator:tt;)*) => {
        $(
            impl<R: Real, F: Functions<R>> $trait for WithFunctions<R, F> {
                type Output = Self;

                #[inline(always)]
                fn $method(self, other: Self) -> Self {
                    Self::new(self.value $operator other.value)
                }
            }

            impl<R: Real, F: Functions<R>> $assign for WithFunctions<R, F> {
                #[inline(always)]
                fn $assign_method(&mut self, other: Self) {
                    self.value = self.value $operator other.value;
                }
            }
        )*
    };
}

operators! {
    Add add AddAssign add_assign +;
    Sub sub SubAssign sub_assign -;
    Mul mul MulAssign mul_assign *;
    Div div DivAssign div_assign /;
}

impl<R: Real, F: Functions<R>> Neg for WithFunctions<R, F> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.value)
    }
}

impl<L: Lanes, F: Functions<L>> Lift<f64> for WithFunctions<L, F> {
    #[inline(always)]
    fn lift(base: f64) -> Self {
        Self::new(L::lift(base))
    }
}

impl<F: Functions<f32>> Lift<f32> for WithFunctions<f32, F> {
    #[inline(always)]
    fn lift(base: f32) -> Self {
        Self::new(base)
    }
}

impl<R: Real, F: Functions<R>> Lift<Self> for WithFunctions<R, F> {
    #[inline(always)]
    fn lift(base: Self) -> Self {
        base
    }
}

impl<L: Lanes, F: Functions<L>> Lanes for WithFunctions<L, F> {
    const COUNT: usize = L::COUNT;

    #[inline(always)]
    fn from_fn(lane: impl FnMut(usize) -> f64) -> Self {
        Self::new(L::from_fn(lane))
    }

    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.value.lane(index)
    }

    #[inline(always)]
    fn finite(self) -> Mask {
        self.value.finite()
    }

    #[inline(always)]
    fn sin_cos_13(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos_13();
        (Self::new(sin), Self::new(cos))
    }

    #[inline(always)]
    fn sin_cos_7(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos_7();
        (Self::new(sin), Self::new(cos))
    }

    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        Self::new(self.value.fused(b.value, c.value))
    }

    #[inline(always)]
    fn vectorize_fused<T>(function: impl FnOnce() -> T) -> T {
        L::vectorize_fused(function)
    }
}

/// The functions of [`Approx13`].
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Approx13Functions;

impl<L: Lanes> Functions<L> for Approx13Functions {
    #[inline(always)]
    fn sin_cos(x: L) -> (L, L) {
        x.sin_cos_13()
    }
}

/// The functions of [`Approx7`].
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Approx7Functions;

impl<L: Lanes> Functions<L> for Approx7Functions {
    #[inline(always)]
    fn sin_cos(x: L) -> (L, L) {
        x.sin_cos_7()
    }
}

/// The operations of [`Fused`].
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct FusedOperations;

impl<L: Lanes> Functions<L> for FusedOperations {
    #[inline(always)]
    fn sin_cos_pair(first: L, second: L) -> ((L, L), (L, L)) {
        L::sin_cos_pair(first, second)
    }

    #[inline(always)]
    fn times_plus(a: L, b: L, c: L) -> L {
        a.fused(b, c)
    }

    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        L::vectorize_fused(function)
    }
}

/// The functions of [`Std`].
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct StdFunctions;

#[cfg(feature = "std")]
macro_rules! std_functions {
    ($float:ident: $($method:ident)*) => {
        impl Functions<$float> for StdFunctions {
            #[inline(always)]
            fn sin_cos(x: $float) -> ($float, $float) {
                $float::sin_cos(x)
            }

            $(
                #[inline(always)]
                fn $method(x: $float) -> $float {
                    $float::$method(x)
                }
            )*

            #[inline(always)]
            fn atan2(y: $float, x: $float) -> $float {
                $float::atan2(y, x)
            }
        }
    };
}

#[cfg(feature = "std")]
std_functions!(f64: tan asin acos atan sinh cosh tanh exp ln sqrt);
#[cfg(feature = "std")]
std_functions!(f32: tan asin acos atan sinh cosh tanh exp ln sqrt);

/// A choice of real over lanes of every kind, for code that makes lanes itself.
///
/// [`PlainLanes`] is the lanes as they are; [`Approx13Functions`], [`Approx7Functions`] and [`FusedOperations`] exchange
/// operations, and a pair does both.
pub trait LaneScalar: 'static {
    /// The real over the lanes `L`.
    type Of<L: Lanes>: Lanes;
}

/// The functions and operations that a real has by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct PlainLanes;

impl LaneScalar for PlainLanes {
    type Of<L: Lanes> = L;
}

impl LaneScalar for Approx13Functions {
    type Of<L: Lanes> = Approx13<L>;
}

impl LaneScalar for Approx7Functions {
    type Of<L: Lanes> = Approx7<L>;
}

impl LaneScalar for FusedOperations {
    type Of<L: Lanes> = Fused<L>;
}

impl<A: LaneScalar, B: LaneScalar> LaneScalar for (A, B) {
    type Of<L: Lanes> = A::Of<B::Of<L>>;
}
