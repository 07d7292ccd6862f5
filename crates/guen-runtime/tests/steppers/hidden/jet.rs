//! Power series as a real, so that the Taylor series of equations come of the equations as they are written.

use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use guen_runtime::prelude::*;
use guen_runtime::{Coefficients, Equations, HIGHEST_ORDER};

const TERMS: usize = HIGHEST_ORDER + 1;

/// The coefficients by their order, of as many as are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet {
    terms: [f64; TERMS],
    known: usize,
}

impl Default for Jet {
    fn default() -> Self {
        Self { terms: [0.0; TERMS], known: TERMS }
    }
}

impl Jet {
    fn number(value: f64) -> Self {
        let mut jet = Self::default();
        jet.terms[0] = value;
        jet
    }

    fn by(self, other: Self, term: impl Fn(usize, &[f64; TERMS]) -> f64) -> Self {
        let known = self.known.min(other.known);
        let mut jet = Self { terms: [0.0; TERMS], known };
        for k in 0..known {
            jet.terms[k] = term(k, &jet.terms);
        }
        jet
    }

    /// `f(u)` from `f(u_0)` and `f' = slope u'`, where the slope of order `k` follows from the lower ones of `f`.
    fn integral(self, first: f64, slope: impl Fn(&[f64; TERMS], usize) -> f64) -> Self {
        let u = self.terms;
        self.by(self, |k, f| {
            if k == 0 {
                return first;
            }
            (1..=k).map(|j| j as f64 * u[j] * slope(f, k - j)).sum::<f64>() / k as f64
        })
    }
}

/// The series of equations through a state.
pub fn series<E: Equations<2>>(
    equations: &E,
    t: f64,
    state: &[f64; 2],
    scale: f64,
    order: usize,
    to: &mut Coefficients<f64, 2>,
) {
    let mut time = Jet::number(t);
    time.terms[1] = scale;
    let mut jets = state.map(Jet::number);
    to[0] = *state;
    for (k, to) in to.iter_mut().enumerate().take(order + 1).skip(1) {
        time.known = k;
        jets.iter_mut().for_each(|jet| jet.known = k);
        let rates = equations.rates(time, &jets);
        *to = rates.map(|rate| rate.terms[k - 1] * scale / k as f64);
        jets.iter_mut().zip(*to).for_each(|(jet, term)| jet.terms[k] = term);
    }
}

macro_rules! operators {
    ($($Trait:ident $method:ident $Assign:ident $assign:ident: |$a:ident, $b:ident, $k:ident, $r:ident| $term:expr;)*) => {$(
        impl $Trait for Jet {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self.terms, other.terms);
                self.by(other, |$k, $r| {
                    let _ = $r;
                    $term
                })
            }
        }
        impl $Assign for Jet {
            fn $assign(&mut self, other: Self) {
                *self = $Trait::$method(*self, other);
            }
        }
    )*};
}

operators! {
    Add add AddAssign add_assign: |a, b, k, r| a[k] + b[k];
    Sub sub SubAssign sub_assign: |a, b, k, r| a[k] - b[k];
    Mul mul MulAssign mul_assign: |a, b, k, r| (0..=k).map(|j| a[j] * b[k - j]).sum();
    Div div DivAssign div_assign: |a, b, k, r| (a[k] - (1..=k).map(|j| b[j] * r[k - j]).sum::<f64>()) / b[0];
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self { terms: self.terms.map(|x| -x), known: self.known }
    }
}

impl Real for Jet {
    fn from_ratio(num: i64, den: i64) -> Self {
        Self::number(f64::from_ratio(num, den))
    }
    fn from_f64(value: f64) -> Self {
        Self::number(value)
    }
    fn to_f64(self) -> f64 {
        self.terms[0]
    }
    fn pi() -> Self {
        Self::number(f64::pi())
    }
    fn epsilon() -> Self {
        Self::number(f64::EPSILON)
    }
    fn exp(self) -> Self {
        self.integral(self.terms[0].exp(), |exp, k| exp[k])
    }
    fn tanh(self) -> Self {
        // As generated recurrences have it: the slope is one less the square.
        let one = |k: usize| if k == 0 { 1.0 } else { 0.0 };
        self.integral(self.terms[0].tanh(), |tanh, k| {
            one(k) - (0..=k).map(|j| tanh[j] * tanh[k - j]).sum::<f64>()
        })
    }
    fn is_finite(self) -> bool {
        self.terms.iter().all(|x| x.is_finite())
    }
    fn sin_cos(self) -> (Self, Self) {
        unimplemented!("no equation here has it")
    }
    fn asin(self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn acos(self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn atan(self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn atan2(self, _x: Self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn sinh(self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn cosh(self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn ln(self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn sqrt(self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn root(self, _q: u32) -> Self {
        unimplemented!("no equation here has it")
    }
    fn abs(self) -> Self {
        unimplemented!("no equation here has it")
    }
    fn sign(self) -> Self {
        unimplemented!("no equation here has it")
    }
}
