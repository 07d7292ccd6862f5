//! A real of 71 digits, to take differences in: `f256` behind the runtime's trait.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use f256::f256;
use guen::{Lift, Ordered, Real};

/// A number of 237 bits: a real to take references in. No ordinary run needs it.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Long(pub f256);

impl Default for Long {
    fn default() -> Self {
        Long(f256::ZERO)
    }
}

macro_rules! operators {
    ($($trait:ident, $method:ident, $assign:ident, $assigned:ident;)*) => {
        $(impl $trait for Long {
            type Output = Long;
            fn $method(self, other: Long) -> Long {
                Long(self.0.$method(other.0))
            }
        }
        impl $assign for Long {
            fn $assigned(&mut self, other: Long) {
                self.0 = self.0.$method(other.0);
            }
        })*
    };
}

operators! {
    Add, add, AddAssign, add_assign;
    Sub, sub, SubAssign, sub_assign;
    Mul, mul, MulAssign, mul_assign;
    Div, div, DivAssign, div_assign;
}

impl Neg for Long {
    type Output = Long;
    fn neg(self) -> Long {
        Long(-self.0)
    }
}

impl Long {
    fn sign_bit(self) -> f64 {
        if self.0.is_sign_negative() { -1.0 } else { 1.0 }
    }
}

impl Lift<Long> for Long {
    fn lift(base: Long) -> Long {
        base
    }
}

impl Ordered for Long {}

impl Real for Long {
    fn from_ratio(num: i64, den: i64) -> Self {
        Long(f256::from(num) / f256::from(den))
    }
    fn from_f64(value: f64) -> Self {
        Long(f256::from(value))
    }
    fn to_f64(self) -> f64 {
        // There is no conversion to `f64`: the parts of the format, of which the leading 53 bits are rounded.
        const BIAS: i32 = 262_143;
        if !self.0.is_finite() {
            return if self.0.is_nan() { f64::NAN } else { f64::INFINITY.copysign(self.sign_bit()) };
        }
        let high = self.0.to_bits().0;
        let exponent = ((high >> 108) & 0x7_ffff) as i32 - BIAS;
        let fraction = ((high & ((1 << 108) - 1)) >> 45) as u64;
        // Of 63 bits the conversion to `f64` rounds once.
        let mantissa = ((1_u64 << 63) | fraction) as f64;
        let scale = |e: i32| 2.0_f64.powi(e.clamp(-1020, 1020));
        let exponent = exponent - 63;
        let value = if exponent < -3000 {
            0.0
        } else {
            mantissa * scale(exponent / 2) * scale(exponent - exponent / 2)
        };
        value.copysign(self.sign_bit())
    }
    fn pi() -> Self {
        Long(::f256::consts::PI)
    }
    fn epsilon() -> Self {
        Long(f256::EPSILON)
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Long(sin), Long(cos))
    }
    fn asin(self) -> Self {
        Long(self.0.asin())
    }
    fn acos(self) -> Self {
        Long(self.0.acos())
    }
    fn atan(self) -> Self {
        Long(self.0.atan())
    }
    fn atan2(self, x: Self) -> Self {
        Long(self.0.atan2(&x.0))
    }
    fn sinh(self) -> Self {
        (self.exp() - (-self).exp()) / Long::from_ratio(2, 1)
    }
    fn cosh(self) -> Self {
        (self.exp() + (-self).exp()) / Long::from_ratio(2, 1)
    }
    fn tanh(self) -> Self {
        self.sinh() / self.cosh()
    }
    fn exp(self) -> Self {
        Long(self.0.exp())
    }
    fn ln(self) -> Self {
        Long(self.0.ln())
    }
    fn sqrt(self) -> Self {
        Long(self.0.sqrt())
    }
    fn root(self, q: u32) -> Self {
        (self.ln() / Long::from_ratio(i64::from(q), 1)).exp()
    }
    fn abs(self) -> Self {
        Long(self.0.abs())
    }
    fn sign(self) -> Self {
        if self.0 == f256::ZERO { self } else { Long(f256::ONE.copysign(self.0)) }
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}
