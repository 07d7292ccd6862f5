//! What is studied here. Systems of one size are one type, because every type that is studied takes the compiler two seconds.

use guen_runtime::{Equations, Real};

use crate::Oscillator;
use crate::budget::Slow;
use crate::forecasts::Two;
use crate::kicks::Kicked;
use crate::uncertain_errors::{Free, Spring};

/// A system of one variable.
#[derive(Clone)]
pub enum Scalar {
    /// `x' = x^2`, which has a pole at t = 1 from 1.
    Pole,
    /// `x' = 3 x`: over 4 seconds every error grows by 1e5.
    Growing,
}

impl Equations<1> for Scalar {
    fn rates<R: Real>(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
        match self {
            Self::Pole => [x * x],
            Self::Growing => [x * R::from_ratio(3, 1)],
        }
    }
}

/// A system of two variables.
#[derive(Clone)]
pub enum Planar {
    Oscillator,
    Spring,
    Free,
    Slow,
    Kicked(Kicked),
    Battery(Two),
}

impl Equations<2> for Planar {
    fn rates<R: Real>(&self, t: R, x: &[R; 2]) -> [R; 2] {
        match self {
            Self::Oscillator => Oscillator.rates(t, x),
            Self::Spring => Spring.rates(t, x),
            Self::Free => Free.rates(t, x),
            Self::Slow => Slow.rates(t, x),
            Self::Kicked(kicked) => kicked.rates(t, x),
            Self::Battery(one) => one.rates(t, x),
        }
    }
}
