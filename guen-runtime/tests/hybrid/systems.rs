//! The systems of the reference scenes.

use guen_runtime::Lift;
use guen_runtime::hybrid::{Element, FreeMotion, HybridSystem, Signal};

use crate::bodies::Parts;

fn c<R: Lift<f64>>(value: f64) -> R {
    R::lift(value)
}

#[derive(Clone, Copy, Debug)]
pub struct BouncingBall {
    pub g: f64,
    pub e: f64,
}

impl HybridSystem<2, 1, 1, 0> for BouncingBall {
    const ELEMENTS: [Element; 1] = [Element::smooth("floor", 0)];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 1;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 2], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
        let mut parts = Parts::<R, 1, 1, 1>::nothing().masses([R::one()]);
        parts.forces = [-c::<R>(self.g)];
        parts.rows = [[R::one()]];
        parts.gaps = [x[0]];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [self.e]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 2]) -> [R; 0] {
        []
    }
}

#[derive(Clone, Copy, Debug)]
pub struct PendulumStop;

impl HybridSystem<2, 1, 1, 0> for PendulumStop {
    const ELEMENTS: [Element; 1] = [Element::smooth("stop", 0)];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 1;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 2], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 2, 1, 1> {
        let mut parts = Parts::<R, 1, 1, 1>::nothing().masses([R::one()]);
        parts.forces = [-c::<R>(9.81) * x[0].sin()];
        parts.rows = [[R::one()]];
        parts.gaps = [x[0] + c(0.2)];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.6]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 2]) -> [R; 0] {
        []
    }
}

/// A ball that may roll: `x, z, phi`.
fn ball<R: Lift<f64>>(m: f64, j: f64, a: f64, mu: f64, x: &[R; 6]) -> Parts<R, 3, 2, 1> {
    let mut parts = Parts::<R, 3, 2, 1>::nothing().masses([c(m), c(m), c(j)]);
    parts.forces = [R::zero(), -c::<R>(m) * c(9.81), R::zero()];
    parts.rows = [[R::zero(), R::one(), R::zero()], [R::one(), R::zero(), -c::<R>(a)]];
    parts.gaps = [x[1] - c(a)];
    (parts.friction, parts.stiction) = ([c(mu)], [c(mu)]);
    parts
}

#[derive(Clone, Copy, Debug)]
pub struct ThrownBall;

impl HybridSystem<6, 2, 1, 0> for ThrownBall {
    const ELEMENTS: [Element; 1] = [Element::rough("floor", 0, &[1])];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 3;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 6], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 6, 2, 1> {
        ball(1.0, 0.004, 0.1, 0.2, x).free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.5]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 6]) -> [R; 0] {
        []
    }
}

#[derive(Clone, Copy, Debug)]
pub struct BowlingBall;

impl HybridSystem<6, 2, 1, 1> for BowlingBall {
    const ELEMENTS: [Element; 1] = [Element::rough("lane", 0, &[1])];
    const SIGNALS: [Signal; 1] = [Signal::switch("brake")];
    const COORDINATES: usize = 3;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(
        &self,
        t: R,
        x: &[R; 6],
        brake: &[R; 1],
        _: &[R; 1],
    ) -> FreeMotion<R, 6, 2, 1> {
        let a = 0.108;
        let mut parts = ball(7.0, 0.4 * 7.0 * a * a, a, 0.15, x);
        parts.forces[2] = -c::<R>(4.0) * (t - c(3.0)) * brake[0];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn signals<R: Lift<f64>>(&self, t: R, _x: &[R; 6]) -> [R; 1] {
        [(t - c(3.0)) * (c::<R>(4.5) - t)]
    }
}

#[derive(Clone, Copy, Debug)]
pub struct StickSlipBelt;

impl HybridSystem<4, 2, 1, 0> for StickSlipBelt {
    const ELEMENTS: [Element; 1] = [Element::rough("belt", 0, &[1]).with_friction_of_speed()];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 2;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(
        &self,
        _t: R,
        x: &[R; 4],
        _: &[R; 0],
        speeds: &[R; 1],
    ) -> FreeMotion<R, 4, 2, 1> {
        let mut parts = Parts::<R, 2, 2, 1>::nothing().masses([R::one(), R::one()]);
        parts.forces = [-x[0], -c::<R>(10.0)];
        parts.rows = [[R::zero(), R::one()], [R::one(), R::zero()]];
        parts.drifts = [R::zero(), -c::<R>(0.2)];
        parts.gaps = [x[1]];
        parts.friction = [c::<R>(0.1) / (R::one() + c::<R>(3.0) * speeds[0])];
        parts.stiction = [c(0.1)];
        parts.free_motion(x)
    }

    fn row_drifts(&self, _t: f64, _x: &[f64; 4]) -> [f64; 2] {
        [0.0, -0.2]
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 4]) -> [R; 0] {
        []
    }
}

#[derive(Clone, Copy, Debug)]
pub struct PuckIncline;

impl HybridSystem<6, 3, 1, 0> for PuckIncline {
    const ELEMENTS: [Element; 1] = [Element::rough("plane", 0, &[1, 2])];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 3;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 6], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 6, 3, 1> {
        let (zero, one) = (R::zero(), R::one());
        let mut parts = Parts::<R, 3, 3, 1>::nothing().masses([one; 3]);
        let g = c::<R>(9.81);
        parts.forces = [g * R::from_ratio(5, 13), zero, -g * R::from_ratio(12, 13)];
        parts.rows = [[zero, zero, one], [one, zero, zero], [zero, one, zero]];
        parts.gaps = [x[2]];
        let mu = R::from_ratio(5, 6);
        (parts.friction, parts.stiction) = ([mu], [mu]);
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 6]) -> [R; 0] {
        []
    }
}

#[derive(Clone, Copy, Debug)]
pub struct PainleveRod;

impl HybridSystem<6, 2, 1, 0> for PainleveRod {
    const ELEMENTS: [Element; 1] = [Element::rough("end", 0, &[1])];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 3;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 6], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 6, 2, 1> {
        let (zero, one) = (R::zero(), R::one());
        let mut parts = Parts::<R, 3, 2, 1>::nothing().masses([one, one, R::from_ratio(1, 3)]);
        parts.forces = [zero, -c::<R>(9.81), zero];
        let ((sin, cos), omega) = (x[2].sin_cos(), x[5]);
        parts.rows = [[zero, one, -cos], [one, zero, sin]];
        parts.biases = [sin * omega * omega, cos * omega * omega];
        parts.gaps = [x[1] - sin];
        (parts.friction, parts.stiction) = ([c(2.0)], [c(2.0)]);
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.0]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 6]) -> [R; 0] {
        []
    }
}

#[derive(Clone, Copy, Debug)]
pub struct TwoBalls {
    pub e: f64,
}

impl HybridSystem<4, 2, 2, 0> for TwoBalls {
    const ELEMENTS: [Element; 2] = [Element::smooth("wall", 0), Element::smooth("pair", 1)];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 2;
    crate::without_inputs!(2 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 4], _: &[R; 0], _: &[R; 2]) -> FreeMotion<R, 4, 2, 2> {
        let mut parts = Parts::<R, 2, 2, 2>::nothing().masses([R::one(), c(2.0)]);
        parts.rows = [[R::zero(), R::one()], [R::one(), -R::one()]];
        parts.gaps = [x[1], x[0] - x[1]];
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 2] {
        [self.e; 2]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 4]) -> [R; 0] {
        []
    }
}

#[derive(Clone, Copy, Debug)]
pub struct KaneImpact {
    /// The height at which the tip touches.
    pub h: f64,
}

impl HybridSystem<4, 2, 1, 0> for KaneImpact {
    const ELEMENTS: [Element; 1] = [Element::rough("floor", 0, &[1])];
    const SIGNALS: [Signal; 0] = [];
    const COORDINATES: usize = 2;
    crate::without_inputs!(1 elements);

    fn free_motion<R: Lift<f64>>(&self, _t: R, x: &[R; 4], _: &[R; 0], _: &[R; 1]) -> FreeMotion<R, 4, 2, 1> {
        let mut parts = Parts::<R, 2, 2, 1>::nothing();
        let ((sp, cp), (sq, cq)) = (x[0].sin_cos(), x[1].sin_cos());
        let (u, w) = (x[2], x[3]);
        let (s, c1) = (x[0] - x[1]).sin_cos();
        let half = R::from_ratio(1, 2);
        let (a, b, d) = (R::from_ratio(4, 3), half * c1, R::from_ratio(1, 3));
        let det = (a * d - b * b).recip();
        parts.inverse = [[d * det, -b * det], [-b * det, a * det]];
        parts.forces = [-half * s * w * w, half * s * u * u];
        parts.rows = [[sp, sq], [cp, cq]];
        parts.biases = [cp * u * u + cq * w * w, -(sp * u * u + sq * w * w)];
        parts.gaps = [c::<R>(self.h) - cp - cq];
        (parts.friction, parts.stiction) = ([c(0.5)], [c(0.5)]);
        parts.free_motion(x)
    }

    fn restitutions(&self) -> [f64; 1] {
        [0.7]
    }

    fn signals<R: Lift<f64>>(&self, _t: R, _x: &[R; 4]) -> [R; 0] {
        []
    }
}
