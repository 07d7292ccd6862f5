//! One step of DOP853: from a state and its slope to the next state, two estimates of the error, and the polynomial
//! between, without any decision about them.

use super::course::Reached;
use super::dense::Dense;
use super::dop853_coefficients as published;
use super::{shifted, weighted};
use crate::decimal::reals;
use crate::real::Real;
use crate::system::System;

/// The coefficients of the method in the real `R`, converted once.
///
/// In `f64` they are the published decimals, correctly rounded; longer reals get all of the 30 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau<R = f64> {
    c: [R; 11],
    a2: [R; 1],
    a3: [R; 2],
    a4: [R; 2],
    a5: [R; 3],
    a6: [R; 3],
    a7: [R; 4],
    a8: [R; 5],
    a9: [R; 6],
    a10: [R; 7],
    a11: [R; 8],
    a12: [R; 9],
    b: [R; 8],
    e5: [R; 8],
    b3: [R; 3],
    c_dense: [R; 3],
    a14: [R; 8],
    a15: [R; 8],
    a16: [R; 8],
    d: [[R; 12]; 4],
}

/// A step on trial: the new state, and how far formulas of lower order are from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial<R, const N: usize> {
    /// The state at the end of the step, of order eight.
    pub state: [R; N],
    /// The mean slope of the step less that of the formula of order five: `O(h^5)`.
    pub error5: [R; N],
    /// The mean slope of the step less that of the formula of order three: `O(h^3)`.
    pub error3: [R; N],
}

/// The slopes of stages 1 and 6 to 12, which weights and interpolant are made of.
pub type Stages<R, const N: usize> = [[R; N]; 8];

impl<R: Real> Tableau<R> {
    /// Converts the published decimals.
    pub fn new() -> Self {
        Self {
            c: reals(&published::C),
            a2: reals(&published::A2),
            a3: reals(&published::A3),
            a4: reals(&published::A4),
            a5: reals(&published::A5),
            a6: reals(&published::A6),
            a7: reals(&published::A7),
            a8: reals(&published::A8),
            a9: reals(&published::A9),
            a10: reals(&published::A10),
            a11: reals(&published::A11),
            a12: reals(&published::A12),
            b: reals(&published::B),
            e5: reals(&published::E5),
            b3: reals(&published::B3),
            c_dense: reals(&published::C_DENSE),
            a14: reals(&published::A14),
            a15: reals(&published::A15),
            a16: reals(&published::A16),
            d: [reals(&published::D4), reals(&published::D5), reals(&published::D6), reals(&published::D7)],
        }
    }

    /// One step on trial from the state `x` at `t`, where the slope is `k1 = f(t, x)`.
    ///
    /// ```text
    /// k_i = f(t + c_i h, x + h sum_j a_ij k_j)      i = 2 .. 12, j < i
    /// x(t + h) = x + h sum_i b_i k_i + O(h^9)
    /// ```
    ///
    /// `h` may be negative. Nothing is checked. Eleven evaluations, about `150 N` further operations, no
    /// allocation. The slope at the end, if the step is accepted, is `k1` of the next step.
    ///
    /// ```
    /// use guen_runtime::{System, from_fn, steppers::dop853::Tableau};
    ///
    /// let growth = from_fn(|_t: f64, &[x]: &[f64; 1]| [x]);
    /// let trial = Tableau::new().trial(&growth, 0.0, &[1.0], &growth.rhs(0.0, &[1.0]), 0.25);
    /// assert!((trial.state[0] - 0.25_f64.exp()).abs() < 1e-11);
    /// assert!(trial.error5[0].abs() < 1e-6 && trial.error3[0].abs() < 1e-3);
    /// ```
    #[inline]
    pub fn trial<S, const N: usize>(&self, system: &S, t: R, x: &[R; N], k1: &[R; N], h: R) -> Trial<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        let stages = self.stages(system, t, x, k1, h);
        let slope = self.slope(&stages);
        Trial {
            state: shifted(x, h, &slope),
            error5: self.error5(&stages),
            error3: self.error3(&stages, &slope),
        }
    }

    /// The slopes of the stages, by eleven evaluations.
    #[inline]
    pub(super) fn stages<S, const N: usize>(
        &self,
        system: &S,
        t: R,
        x: &[R; N],
        k1: &[R; N],
        h: R,
    ) -> Stages<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        let c = &self.c;
        // The slope at node `c_(i+2)`, with `slope` the mean slope until there.
        let at = |i: usize, slope: [R; N]| system.rhs(t + c[i] * h, &shifted(x, h, &slope));
        let k2 = at(0, weighted(&self.a2, [k1]));
        let k3 = at(1, weighted(&self.a3, [k1, &k2]));
        let k4 = at(2, weighted(&self.a4, [k1, &k3]));
        let k5 = at(3, weighted(&self.a5, [k1, &k3, &k4]));
        let k6 = at(4, weighted(&self.a6, [k1, &k4, &k5]));
        let k7 = at(5, weighted(&self.a7, [k1, &k4, &k5, &k6]));
        let k8 = at(6, weighted(&self.a8, [k1, &k4, &k5, &k6, &k7]));
        let k9 = at(7, weighted(&self.a9, [k1, &k4, &k5, &k6, &k7, &k8]));
        let k10 = at(8, weighted(&self.a10, [k1, &k4, &k5, &k6, &k7, &k8, &k9]));
        let k11 = at(9, weighted(&self.a11, [k1, &k4, &k5, &k6, &k7, &k8, &k9, &k10]));
        let k12 = at(10, weighted(&self.a12, [k1, &k4, &k5, &k6, &k7, &k8, &k9, &k10, &k11]));
        [*k1, k6, k7, k8, k9, k10, k11, k12]
    }

    /// The mean slope of order eight.
    #[inline]
    pub(super) fn slope<const N: usize>(&self, stages: &Stages<R, N>) -> [R; N] {
        weighted(&self.b, stages.each_ref())
    }

    /// The mean slope less that of the formula of order five.
    #[inline]
    pub(super) fn error5<const N: usize>(&self, stages: &Stages<R, N>) -> [R; N] {
        weighted(&self.e5, stages.each_ref())
    }

    /// The mean slope less that of the formula of order three.
    #[inline]
    pub(super) fn error3<const N: usize>(&self, stages: &Stages<R, N>, slope: &[R; N]) -> [R; N] {
        let slope3 = weighted(&self.b3, [&stages[0], &stages[4], &stages[7]]);
        core::array::from_fn(|i| slope[i] - slope3[i])
    }

    /// The interpolant of order seven over the step from `from` to `to` with these stages, and the slope `end` at its
    /// end: three evaluations.
    ///
    /// ```text
    /// r4 .. r7 = h sum_i d_i k_i      i = 1, 6 .. 16
    /// ```
    pub(super) fn dense<S, const N: usize>(
        &self,
        system: &S,
        stages: &Stages<R, N>,
        from: &Reached<R, N>,
        to: &Reached<R, N>,
        end: &[R; N],
        h: R,
    ) -> Dense<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        let at = |i: usize, slope: [R; N]| {
            system.rhs(from.time + self.c_dense[i] * h, &shifted(&from.state, h, &slope))
        };
        let [k1, k6, k7, k8, k9, k10, k11, k12] = stages;
        let k14 = at(0, weighted(&self.a14, [k1, k7, k8, k9, k10, k11, k12, end]));
        let k15 = at(1, weighted(&self.a15, [k1, k6, k7, k8, k11, k12, end, &k14]));
        let k16 = at(2, weighted(&self.a16, [k1, k6, k7, k8, k9, end, &k14, &k15]));
        let further = self.d.map(|d| {
            let slope = weighted(&d, [k1, k6, k7, k8, k9, k10, k11, k12, end, &k14, &k15, &k16]);
            slope.map(|slope| h * slope)
        });
        Dense::hermite(from.time, h, &from.state, k1, &to.state, end).with_terms(further)
    }
}

impl<R: Real> Default for Tableau<R> {
    fn default() -> Self {
        Self::new()
    }
}
