//! Registers of several `f64`: the operations that lanes and elementary functions consist of.
//!
//! In goes a register, out comes a register; [`Vector`] gives it operators. Everything is written for any register,
//! and one number is a register too: that is how scalar code and lanes get the same bits. Only operations are here
//! that IEEE 754 defines to the bit, and operations on the bits themselves.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// The sign bit.
const SIGN: f64 = -0.0;

/// A register of one or several `f64` that are computed with at once.
///
/// Every method is always inlined: a register that needs certain instructions has to be used by functions that are
/// compiled for them, never passed to one that is not.
pub(crate) trait Register: Copy + 'static {
    /// The number of numbers in a register.
    const COUNT: usize;

    fn splat(x: f64) -> Self;
    fn from_fn(lane: impl FnMut(usize) -> f64) -> Self;
    /// The number in a lane below [`COUNT`](Self::COUNT).
    fn lane(self, index: usize) -> f64;

    fn add(self, other: Self) -> Self;
    fn sub(self, other: Self) -> Self;
    fn mul(self, other: Self) -> Self;
    fn div(self, other: Self) -> Self;
    fn sqrt(self) -> Self;
    /// `self * b + c`, rounded once.
    fn fused(self, b: Self, c: Self) -> Self;

    /// The bits set in both.
    fn and(self, other: Self) -> Self;
    /// The bits set in this one and not in the other.
    fn without(self, other: Self) -> Self;
    fn xor(self, other: Self) -> Self;
    /// The bits moved towards the sign by `BY` places.
    fn raised<const BY: i32>(self) -> Self;
    /// `set` in the lanes where the sign bit is set, else `clear`.
    fn by_sign(self, set: Self, clear: Self) -> Self;
    /// `above` in the lanes where this is above the limit or one of both is NaN, else `below`.
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self;
    /// Whether some lane is above the limit. NaN is not.
    fn some_above(self, limit: f64) -> bool;

    /// A bit for each lane, the first lowest: whether the number is neither infinite nor NaN.
    fn finite(self) -> u32;

    /// Calls a function, which is inlined where the register's instructions may be used.
    fn vectorize<T>(function: impl FnOnce() -> T) -> T;
}

/// A register with operators.
#[derive(Clone, Copy)]
pub(crate) struct Vector<V>(pub(crate) V);

impl<V: Register> Vector<V> {
    #[inline(always)]
    pub(crate) fn splat(x: f64) -> Self {
        Self(V::splat(x))
    }

    #[inline(always)]
    pub(crate) fn from_fn(lane: impl FnMut(usize) -> f64) -> Self {
        Self(V::from_fn(lane))
    }

    #[inline(always)]
    pub(crate) fn lane(self, index: usize) -> f64 {
        self.0.lane(index)
    }

    #[inline(always)]
    pub(crate) fn magnitude(self) -> Self {
        Self(self.0.without(V::splat(SIGN)))
    }

    /// The number with its sign turned where the sign bit of the other is set.
    #[inline(always)]
    pub(crate) fn signed_by(self, sign: Self) -> Self {
        Self(self.0.xor(sign.0.and(V::splat(SIGN))))
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident;)*) => {
        $(impl<V: Register> $trait for Vector<V> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }

        /// Operators with the same number in all lanes.
        impl<V: Register> $trait<f64> for Vector<V> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self(self.0.$method(V::splat(other)))
            }
        })*
    };
}

operators! {
    Add add;
    Sub sub;
    Mul mul;
    Div div;
}

impl<V: Register> Neg for Vector<V> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.xor(V::splat(SIGN)))
    }
}

impl<V: Register> Debug for Vector<V> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_list().entries((0..V::COUNT).map(|i| self.lane(i))).finish()
    }
}

impl<V: Register> PartialEq for Vector<V> {
    /// Whether all lanes are equal.
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        (0..V::COUNT).all(|i| self.lane(i) == other.lane(i))
    }
}

impl Register for f64 {
    const COUNT: usize = 1;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn from_fn(mut lane: impl FnMut(usize) -> f64) -> Self {
        lane(0)
    }

    #[inline(always)]
    fn lane(self, _index: usize) -> f64 {
        self
    }

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self - other
    }

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self * other
    }

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self / other
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        crate::numbers::elementary::correctly_rounded::sqrt(self)
    }

    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        crate::numbers::elementary::correctly_rounded::fused(self, b, c)
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        f64::from_bits(self.to_bits() & other.to_bits())
    }

    #[inline(always)]
    fn without(self, other: Self) -> Self {
        f64::from_bits(self.to_bits() & !other.to_bits())
    }

    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        f64::from_bits(self.to_bits() ^ other.to_bits())
    }

    #[inline(always)]
    fn raised<const BY: i32>(self) -> Self {
        f64::from_bits(self.to_bits() << BY)
    }

    // By bits and not by `if`, of which the compiler might make a branch that nobody can predict.
    #[inline(always)]
    fn by_sign(self, set: Self, clear: Self) -> Self {
        let mask = ((self.to_bits() as i64) >> 63) as u64;
        f64::from_bits((set.to_bits() & mask) | (clear.to_bits() & !mask))
    }

    #[inline(always)]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        if self <= limit { below } else { above }
    }

    #[inline(always)]
    fn some_above(self, limit: f64) -> bool {
        self > limit
    }

    #[inline(always)]
    fn finite(self) -> u32 {
        u32::from(self.is_finite())
    }

    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        function()
    }
}

/// Two registers as one: halves of a wide one, or plain numbers where nothing better is known.
///
/// Not an array: the compiler keeps the entries of an array in memory where it handles them in loops.
#[derive(Clone, Copy)]
pub(crate) struct Pair<V>(V, V);

macro_rules! both {
    ($($method:ident)*) => {
        $(
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0), self.1.$method(other.1))
            }
        )*
    };
}

impl<V: Register> Register for Pair<V> {
    const COUNT: usize = 2 * V::COUNT;

    both! { add sub mul div and without xor }

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self(V::splat(x), V::splat(x))
    }

    #[inline(always)]
    fn from_fn(mut lane: impl FnMut(usize) -> f64) -> Self {
        Self(V::from_fn(&mut lane), V::from_fn(|i| lane(V::COUNT + i)))
    }

    #[inline(always)]
    fn lane(self, index: usize) -> f64 {
        if index < V::COUNT { self.0.lane(index) } else { self.1.lane(index - V::COUNT) }
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt(), self.1.sqrt())
    }

    #[inline(always)]
    fn fused(self, b: Self, c: Self) -> Self {
        Self(self.0.fused(b.0, c.0), self.1.fused(b.1, c.1))
    }

    #[inline(always)]
    fn raised<const BY: i32>(self) -> Self {
        Self(self.0.raised::<BY>(), self.1.raised::<BY>())
    }

    #[inline(always)]
    fn by_sign(self, set: Self, clear: Self) -> Self {
        Self(self.0.by_sign(set.0, clear.0), self.1.by_sign(set.1, clear.1))
    }

    #[inline(always)]
    fn where_above(self, limit: Self, above: Self, below: Self) -> Self {
        Self(self.0.where_above(limit.0, above.0, below.0), self.1.where_above(limit.1, above.1, below.1))
    }

    #[inline(always)]
    fn some_above(self, limit: f64) -> bool {
        self.0.some_above(limit) | self.1.some_above(limit)
    }

    #[inline(always)]
    fn finite(self) -> u32 {
        self.0.finite() | self.1.finite() << V::COUNT
    }

    #[inline(always)]
    fn vectorize<T>(function: impl FnOnce() -> T) -> T {
        V::vectorize(function)
    }
}
