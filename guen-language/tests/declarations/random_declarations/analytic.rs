//! Elementary functions of numbers that carry derivatives.

use std::f64::consts::FRAC_PI_2;

use super::scalar::{Dual, Scalar};

/// Numbers that functions are applied to.
pub trait Analytic: Scalar {
    /// A function by its derivatives, of a number and the order, which begins at `order`.
    fn applied(&self, derivative: &dyn Fn(f64, u32) -> f64, order: u32) -> Self;

    /// A function of the language of one argument; `None` if there is none of that name.
    fn function(&self, name: &str) -> Option<Self> {
        let of = |derivative: &dyn Fn(f64, u32) -> f64| Some(self.applied(derivative, 0));
        let one = Self::constant(1.0);
        match name {
            "sin" => of(&|x, k| (x + f64::from(k) * FRAC_PI_2).sin()),
            "cos" => of(&|x, k| (x + f64::from(k + 1) * FRAC_PI_2).sin()),
            "tan" => Some(self.function("sin")?.times(&self.function("cos")?.reciprocal())),
            "cot" => Some(self.function("cos")?.times(&self.function("sin")?.reciprocal())),
            "exp" => of(&|x, _| x.exp()),
            "ln" => of(&|x, k| match k {
                0 => x.ln(),
                _ => (1..k).fold(1.0, |slope, j| -slope * f64::from(j) / x) / x,
            }),
            "sqrt" => of(&|x, k| (0..k).fold(x.sqrt(), |slope, j| slope * (0.5 - f64::from(j)) / x)),
            "sinh" => of(&|x, k| if k % 2 == 0 { x.sinh() } else { x.cosh() }),
            "cosh" => of(&|x, k| if k % 2 == 0 { x.cosh() } else { x.sinh() }),
            "tanh" => Some(self.function("sinh")?.times(&self.function("cosh")?.reciprocal())),
            "atan" => of(&arc_tangent),
            // By the half angle, which is never beyond what `atan` gives.
            "asin" => {
                let rest = one.minus(&self.times(self)).function("sqrt")?;
                Some(self.times(&one.plus(&rest).reciprocal()).function("atan")?.scaled(2.0))
            }
            "acos" => Some(Self::constant(FRAC_PI_2).minus(&self.function("asin")?)),
            "abs" => Some(self.scaled(self.value().signum())),
            "sign" => Some(Self::constant(self.value().signum())),
            "floor" => Some(Self::constant(self.value().floor())),
            _ => None,
        }
    }

    /// `atan2(self, x)`: the derivatives are those of `atan(self/x)`, and of `-atan(x/self)`.
    fn arc_tangent_2(&self, x: &Self) -> Self {
        let (quotient, sign) = if self.value().abs() < x.value().abs() {
            (self.times(&x.reciprocal()), 1.0)
        } else {
            (x.times(&self.reciprocal()), -1.0)
        };
        let angle = quotient.applied(&arc_tangent, 0).times(&Self::constant(sign));
        let turn = self.value().atan2(x.value()) - angle.value();
        angle.plus(&Self::constant(turn))
    }
}

fn arc_tangent(x: f64, order: u32) -> f64 {
    let w = 1.0 / (1.0 + x * x);
    match order {
        0 => x.atan(),
        1 => w,
        2 => -2.0 * x * w * w,
        3 => (6.0 * x * x - 2.0) * w * w * w,
        // Two directions and a rate are all that is asked for.
        _ => f64::NAN,
    }
}

impl Analytic for f64 {
    fn applied(&self, derivative: &dyn Fn(f64, u32) -> f64, order: u32) -> Self {
        derivative(*self, order)
    }
}

impl<R: Analytic> Analytic for Dual<R> {
    fn applied(&self, derivative: &dyn Fn(f64, u32) -> f64, order: u32) -> Self {
        let slope = self.re.applied(derivative, order + 1);
        Dual { re: self.re.applied(derivative, order), du: self.du.times(&slope) }
    }
}
