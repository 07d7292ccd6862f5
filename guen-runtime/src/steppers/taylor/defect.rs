//! The defect of the series: the difference between its rate and the rate of the system, at a place within its step.

use super::super::entries;
use super::Series;
use crate::numbers::real::{Ordered, Real};
use crate::system::derivatives::series::TaylorSeries;

/// The place within a step at which the rates are compared, as a part of it. Not the middle, where what is symmetric
/// about it would vanish.
pub(super) const INSIDE: f64 = 0.45;

/// The order up to which the terms of a series of order `p` count there. If at the end of the step they fall to the tolerance like
/// `tol^(k/p)`, at this place those of
///
/// ```text
/// k > p log(tol) / (log(tol) + p log(INSIDE))
/// ```
///
/// are below it, and `k` times as much, which they add to the slope, is below [`DEFECT_LIMIT`].
pub(super) fn order_inside(order: usize, tolerance: f64) -> usize {
    let (order, digits) = (order as f64, libm::log2(tolerance).min(0.0));
    (order * digits / (digits + order * libm::log2(INSIDE))) as usize
}

/// The largest defect over a step, in units of the tolerance. What order `p` leaves out of it is about `(p + 1)/16`, so
/// that a step is not refused because of what its length is chosen by.
const DEFECT_LIMIT: f64 = 64.0;

/// The defect of a series,
///
/// ```text
/// h p'(t + h) - h f(t + h, p(t + h))
/// ```
///
/// It is small where the series is that of the motion, and the change of the error over the step otherwise: coefficients say
/// nothing of a force that is constant to rounding where they were expanded and another one further on.
#[derive(Clone, Copy)]
pub(super) struct Defect<'a, R, const N: usize> {
    pub series: &'a Series<R, N>,
    /// The place, and its distance from the beginning of the series.
    pub time: R,
    pub state: &'a [R; N],
    pub length: R,
    /// `h p'`
    pub slope: &'a [R; N],
    /// The reciprocals of the tolerances.
    pub weights: &'a [f64; N],
}

impl<R: Ordered, const N: usize> Defect<'_, R, N> {
    /// Whether the defect is within the tolerance, or no more than the rounding of the rates. `rates` are `f` at the place.
    #[inline]
    pub(super) fn is_none<S>(&self, system: &S, rates: &[R; N]) -> bool
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        self.is_small(rates) || self.is_rounding(system, rates)
    }

    /// Whether the defect is within the tolerance.
    #[inline(always)]
    pub(super) fn is_small(&self, rates: &[R; N]) -> bool {
        // All of them, without a branch in between.
        let mut small = true;
        for ((slope, rate), weight) in self.slope.iter().zip(rates).zip(self.weights) {
            small &= (*slope - *rate * self.length).to_f64().abs() * weight <= DEFECT_LIMIT;
        }
        small
    }

    /// Whether the rates are no better determined than the defect is large: those of neighbouring states differ as much.
    #[cold]
    #[inline(never)]
    fn is_rounding<S>(&self, system: &S, rates: &[R; N]) -> bool
    where
        S: TaylorSeries<R, N> + ?Sized,
    {
        /// The number of roundings by which neighbouring states differ.
        const NEIGHBOUR_ROUNDINGS: f64 = 2.0;
        /// The defect is allowed to be so many times as large as the difference of the rates: of many roundings a few tell
        /// about the others.
        const ROUNDING_FACTOR: f64 = 8.0;

        let begin = &self.series.coefficients[0];
        let over = self.length / self.series.scale;
        let here = system.rhs(self.time, &neighbour(self.state, NEIGHBOUR_ROUNDINGS));
        let there = system.rhs(self.series.start, &neighbour(begin, NEIGHBOUR_ROUNDINGS));
        // Of the sum: the largest of its terms counts.
        let terms = self.terms(over);
        (0..N).all(|i| {
            let at_end = (here[i] - rates[i]) * self.length;
            let at_begin = there[i] * self.length - self.series.coefficients[1][i] * over;
            let rounding = at_end.to_f64().abs() + at_begin.to_f64().abs() + R::epsilon().to_f64() * terms[i];
            let defect = (self.slope[i] - rates[i] * self.length).to_f64().abs();
            defect < f64::INFINITY
                && defect <= f64::max(DEFECT_LIMIT / self.weights[i], ROUNDING_FACTOR * rounding)
        })
    }

    /// The largest of the terms `k x_k s^k`.
    fn terms(&self, s: R) -> [f64; N] {
        let (mut largest, mut power) = ([0.0; N], 1.0);
        let s = s.to_f64().abs();
        for (k, coefficients) in self.series.coefficients.iter().enumerate().take(self.series.order + 1) {
            for (most, c) in largest.iter_mut().zip(coefficients) {
                *most = f64::max(*most, k as f64 * c.to_f64().abs() * power);
            }
            power *= s;
        }
        largest
    }
}

/// A state whose entries are off by so many roundings, every other one to the other side.
fn neighbour<R: Real, const N: usize>(state: &[R; N], roundings: f64) -> [R; N] {
    let part = R::epsilon() * R::from_f64(roundings);
    entries(|i| {
        let change = state[i] * part;
        if i % 2 == 0 { state[i] + change } else { state[i] - change }
    })
}
