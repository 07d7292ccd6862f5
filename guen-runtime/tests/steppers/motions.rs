//! Motions that every method can follow, with what is known of them.

use guen_runtime::prelude::*;
use guen_runtime::{Coefficients, Differentiable, Equations, Generic, System, TaylorSeries, generic};

/// `x'' = -x`
#[derive(Clone, Copy)]
pub struct Oscillator;

impl Equations<2> for Oscillator {
    fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, -x]
    }
}

/// The oscillator with its Taylor series.
#[derive(Clone, Copy)]
pub struct Series(pub Generic<Oscillator>);

impl Series {
    pub fn new() -> Self {
        Self(generic(Oscillator))
    }
}

impl System<f64, 2> for Series {
    fn rhs(&self, t: f64, state: &[f64; 2]) -> [f64; 2] {
        self.0.rhs(t, state)
    }
}

impl Differentiable<f64, 2> for Series {
    fn jacobian(&self, t: f64, state: &[f64; 2]) -> [[f64; 2]; 2] {
        self.0.jacobian(t, state)
    }

    fn along(&self, t: f64, state: &[f64; 2], dt: f64, dx: &[f64; 2]) -> [f64; 2] {
        self.0.along(t, state, dt, dx)
    }
}

impl TaylorSeries<f64, 2> for Series {
    const PRODUCTS: usize = 0;

    fn series(&self, _t: f64, state: &[f64; 2], scale: f64, order: usize, to: &mut Coefficients<f64, 2>) {
        to[0] = *state;
        for k in 1..=order {
            let [x, v] = to[k - 1];
            to[k] = [v, -x].map(|rate| rate * scale / k as f64);
        }
    }
}

/// A pendulum that is driven, whose rates know how late it is since `since`: `x'' = -sin x + (t - since)/20 cos(t - since)`.
#[derive(Clone, Copy)]
pub struct Driven {
    pub since: f64,
}

impl Equations<2> for Driven {
    fn rates<R: Real>(&self, t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        let late = t - R::from_f64(self.since);
        [v, -x.sin() + late * R::from_ratio(1, 20) * late.cos()]
    }
}
