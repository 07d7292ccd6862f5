//! `f64` with the sine and cosine of the platform's C library, which is what generated C calls.

use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use guen::{Real, System};

/// An `f64` whose `sin_cos` is that of the platform. All else is that of `f64`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(transparent)]
pub struct Platform(pub f64);

macro_rules! operators {
    ($($trait:ident $method:ident, $assign_trait:ident $assign:ident;)*) => {
        $(
            impl $trait for Platform {
                type Output = Self;

                #[inline]
                fn $method(self, other: Self) -> Self {
                    Self($trait::$method(self.0, other.0))
                }
            }

            impl $assign_trait for Platform {
                #[inline]
                fn $assign(&mut self, other: Self) {
                    *self = $trait::$method(*self, other);
                }
            }
        )*
    };
}

operators! {
    Add add, AddAssign add_assign;
    Sub sub, SubAssign sub_assign;
    Mul mul, MulAssign mul_assign;
    Div div, DivAssign div_assign;
}

impl Neg for Platform {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

macro_rules! unary {
    ($($method:ident)*) => {
        $(
            #[inline]
            fn $method(self) -> Self {
                Self(Real::$method(self.0))
            }
        )*
    };
}

impl Real for Platform {
    #[inline]
    fn from_ratio(num: i64, den: i64) -> Self {
        Self(f64::from_ratio(num, den))
    }

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self(value)
    }

    #[inline]
    fn to_f64(self) -> f64 {
        self.0
    }

    fn from_parts(parts: &[(i64, i32)]) -> Self {
        Self(f64::from_parts(parts))
    }

    #[inline]
    fn pi() -> Self {
        Self(f64::pi())
    }

    #[inline]
    fn epsilon() -> Self {
        Self(f64::epsilon())
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = f64::sin_cos(self.0);
        (Self(sin), Self(cos))
    }

    unary! { tan asin acos atan sinh cosh tanh exp ln sqrt abs sign }

    #[inline]
    fn atan2(self, x: Self) -> Self {
        Self(Real::atan2(self.0, x.0))
    }

    #[inline]
    fn root(self, q: u32) -> Self {
        Self(self.0.root(q))
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

/// A system over [`Platform`] as one over `f64`.
pub struct OnPlatform<S>(pub S);

impl<S: System<Platform, N>, const N: usize> System<f64, N> for OnPlatform<S> {
    #[inline]
    fn rhs(&self, t: f64, state: &[f64; N]) -> [f64; N] {
        self.0.rhs(Platform(t), &state.map(Platform)).map(|rate| rate.0)
    }
}
