//! A real that counts its operations.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use guen::{Cost, Lift, Real};

thread_local! {
    static COUNT: Cell<Cost> = const { Cell::new(Cost::ZERO) };
}

/// What a calculation gives, and the operations that it took.
pub fn counted<T>(work: impl FnOnce() -> T) -> (T, Cost) {
    COUNT.set(Cost::ZERO);
    let result = work();
    (result, COUNT.get())
}

fn count(one: Cost) {
    COUNT.set(COUNT.get() + one);
}

/// An `f64` whose operations are counted. Constants are free.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Counted(pub f64);

macro_rules! operators {
    ($($trait:ident, $method:ident, $assign:ident, $assigned:ident, $field:ident;)*) => {
        $(impl $trait for Counted {
            type Output = Counted;
            fn $method(self, other: Counted) -> Counted {
                count(Cost { $field: 1, ..Cost::ZERO });
                Counted(self.0.$method(other.0))
            }
        }
        impl $assign for Counted {
            fn $assigned(&mut self, other: Counted) {
                *self = (*self).$method(other);
            }
        })*
    };
}

operators! {
    Add, add, AddAssign, add_assign, additions;
    Sub, sub, SubAssign, sub_assign, additions;
    Mul, mul, MulAssign, mul_assign, multiplications;
    Div, div, DivAssign, div_assign, divisions;
}

impl Neg for Counted {
    type Output = Counted;
    fn neg(self) -> Counted {
        count(Cost { negations: 1, ..Cost::ZERO });
        Counted(-self.0)
    }
}

impl Lift<Counted> for Counted {
    fn lift(base: Counted) -> Counted {
        base
    }
}

macro_rules! calls {
    ($field:ident: $($method:ident)*) => {
        $(fn $method(self) -> Self {
            count(Cost { $field: 1, ..Cost::ZERO });
            Counted(Real::$method(self.0))
        })*
    };
}

impl Real for Counted {
    fn from_ratio(num: i64, den: i64) -> Self {
        Counted(f64::from_ratio(num, den))
    }
    fn from_f64(value: f64) -> Self {
        Counted(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn pi() -> Self {
        Counted(<f64 as Real>::pi())
    }
    fn epsilon() -> Self {
        Counted(<f64 as Real>::epsilon())
    }
    fn sin_cos(self) -> (Self, Self) {
        count(Cost { calls: 1, ..Cost::ZERO });
        let (sin, cos) = Real::sin_cos(self.0);
        (Counted(sin), Counted(cos))
    }
    fn atan2(self, x: Self) -> Self {
        count(Cost { calls: 1, ..Cost::ZERO });
        Counted(Real::atan2(self.0, x.0))
    }
    fn root(self, q: u32) -> Self {
        count(Cost { roots: 1, ..Cost::ZERO });
        Counted(Real::root(self.0, q))
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    calls! { calls: asin acos atan sinh cosh tanh exp ln abs sign }
    calls! { roots: sqrt }
}
