//! [`Real`] for registers of lanes: every lane computes what an `f64` would.

use crate::numbers::elementary;
use crate::numbers::lanes::register::{Register, Vector};
use crate::numbers::lanes::{Lanes, Mask};
use crate::numbers::lift::Lift;
use crate::numbers::real::Real;
use crate::numbers::rules::assign_operators;

impl<V: Register> Vector<V> {
    /// A function lane by lane, where there is none for all at once.
    #[inline(always)]
    fn each(self, function: impl Fn(f64) -> f64) -> Self {
        Self::from_fn(|i| function(self.lane(i)))
    }
}

assign_operators!(Vector<V>, V: Register);

impl<V: Register> Default for Vector<V> {
    #[inline(always)]
    fn default() -> Self {
        Self::splat(0.0)
    }
}

macro_rules! lane_by_lane {
    ($($method:ident)*) => {
        $(
            #[inline(always)]
            fn $method(self) -> Self {
                self.each(Real::$method)
            }
        )*
    };
}

impl<V: Register> Real for Vector<V> {
    #[inline(always)]
    fn from_ratio(num: i64, den: i64) -> Self {
        Self::splat(f64::from_ratio(num, den))
    }

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Self::splat(value)
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.lane(0)
    }

    #[inline(always)]
    fn from_parts(parts: &[(i64, i32)]) -> Self {
        Self::splat(f64::from_parts(parts))
    }

    #[inline(always)]
    fn zero() -> Self {
        Self::splat(0.0)
    }

    #[inline(always)]
    fn one() -> Self {
        Self::splat(1.0)
    }

    #[inline(always)]
    fn pi() -> Self {
        Self::splat(f64::pi())
    }

    #[inline(always)]
    fn epsilon() -> Self {
        Self::splat(f64::EPSILON)
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        elementary::sin_cos(self)
    }

    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }

    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }

    lane_by_lane! { tan cot asin acos atan sinh cosh tanh exp ln sign floor }

    #[inline(always)]
    fn atan2(self, x: Self) -> Self {
        Self::from_fn(|i| Real::atan2(self.lane(i), x.lane(i)))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn root(self, q: u32) -> Self {
        if q == 2 { self.sqrt() } else { self.each(|x| x.root(q)) }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        self.magnitude()
    }

    /// Repeated squaring as for numbers, but lane by lane: out of line it would lack the lanes' instructions.
    #[inline(always)]
    fn powi(self, n: i32) -> Self {
        self.each(|x| Real::powi(x, n))
    }

    #[inline(always)]
    fn recip(self) -> Self {
        Self::one() / self
    }

    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        V::vectorize(function)
    }

    #[inline(always)]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        Self(self.0.where_above(limit.0, above.0, below.0))
    }

    fn each_alone(function: impl Fn(&dyn Fn(Self) -> f64) -> f64) -> Self {
        Self::from_fn(|i| function(&|x| x.lane(i)))
    }

    /// Whether all lanes are.
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.finite() == Mask::all(V::COUNT)
    }
}

impl<V: Register> Lift<f64> for Vector<V> {
    #[inline(always)]
    fn lift(base: f64) -> Self {
        Self::splat(base)
    }
}

impl<V: Register> Lift<Self> for Vector<V> {
    #[inline(always)]
    fn lift(base: Self) -> Self {
        base
    }
}

impl<V: Register> Lanes for Vector<V> {
    const COUNT: usize = V::COUNT;

    #[inline(always)]
    fn from_fn(lane: impl FnMut(usize) -> f64) -> Self {
        Self(V::from_fn(lane))
    }

    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        self.0.lane(index)
    }

    #[inline(always)]
    fn finite(self) -> Mask {
        Mask::from_bits(self.0.finite())
    }

    #[inline(always)]
    fn sin_cos_13(self) -> (Self, Self) {
        elementary::sin_cos_13(self)
    }

    #[inline(always)]
    fn sin_cos_7(self) -> (Self, Self) {
        elementary::sin_cos_7(self)
    }

    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        Self(self.0.fused(b.0, c.0))
    }

    // Every longer register has the instruction; arrays are no better than numbers.
    #[inline(always)]
    fn vectorize_fused<T>(function: impl FnOnce() -> T) -> T {
        V::vectorize(function)
    }
}

impl Lanes for f64 {
    const COUNT: usize = 1;

    #[inline(always)]
    fn from_fn(mut lane: impl FnMut(usize) -> f64) -> Self {
        lane(0)
    }

    #[inline(always)]
    fn lane(self, _index: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn finite(self) -> Mask {
        Mask::from_bits(u32::from(self.is_finite()))
    }

    #[inline(always)]
    fn sin_cos_13(self) -> (Self, Self) {
        let (sin, cos) = elementary::sin_cos_13(Vector(self));
        (sin.0, cos.0)
    }

    #[inline(always)]
    fn sin_cos_7(self) -> (Self, Self) {
        let (sin, cos) = elementary::sin_cos_7(Vector(self));
        (sin.0, cos.0)
    }

    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        elementary::fused(self, b, c)
    }

    #[inline(always)]
    fn vectorize_fused<T>(function: impl FnOnce() -> T) -> T {
        #[cfg(target_arch = "x86_64")]
        {
            crate::numbers::lanes::x86::fused(function)
        }
        #[cfg(not(target_arch = "x86_64"))]
        {
            function()
        }
    }
}
