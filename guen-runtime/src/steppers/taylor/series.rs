//! The motion over one step, as its series.

use super::super::{entries, scaled};
use crate::numbers::power_series::HIGHEST_ORDER;
use crate::numbers::real::Real;
use crate::steppers::driver::dense::Interpolant;
use crate::system::derivatives::series::Coefficients;

/// The motion over one step of [`Taylor`](crate::steppers::Taylor): its series about the beginning, an [`Interpolant`].
#[derive(Clone, Copy, Debug)]
pub struct Series<R, const N: usize> {
    pub(super) start: R,
    pub(super) scale: R,
    pub(super) order: usize,
    pub(super) coefficients: Coefficients<R, N>,
}

impl<R: Real, const N: usize> Series<R, N> {
    /// Creates the series before the first step, which interpolates nothing but the present state.
    pub(super) fn still(start: R, state: &[R; N]) -> Self {
        let mut coefficients = [[R::zero(); N]; HIGHEST_ORDER + 1];
        coefficients[0] = *state;
        Self { start, scale: R::one(), order: 1, coefficients }
    }

    /// `sum_{k>=1} x_k s^k`, by Horner's rule.
    #[inline(always)]
    pub(super) fn change(&self, s: R) -> [R; N] {
        // Within the bounds it is; said again, the compiler knows it too and leaves no panic.
        let order = self.order.clamp(1, HIGHEST_ORDER);
        let mut sum = self.coefficients[order];
        for below in self.coefficients[1..order].iter().rev() {
            for (entry, coefficient) in sum.iter_mut().zip(below) {
                *entry = *entry * s + *coefficient;
            }
        }
        scaled(s, &sum)
    }

    /// The change, to the same bits, and what the rates times the time would make it: `sum_{k>=1} k x_k s^k`.
    #[inline]
    pub(super) fn change_and_slope(&self, s: R) -> ([R; N], [R; N]) {
        let [_, rest @ ..] = &self.coefficients;
        let terms = rest.get(..self.order).unwrap_or(rest);
        R::wide(
            #[inline(always)]
            || {
                // change = s q(s), slope = s (q(s) + s q'(s))
                let (mut change, mut slope) = horner(terms, s);
                for (change, slope) in change.iter_mut().zip(&mut slope) {
                    *slope = (*change + *slope * s) * s;
                    *change *= s;
                }
                (change, slope)
            },
        )
    }

    /// The state of the terms up to an order, and what the rates times the time would make of them.
    #[inline]
    pub(super) fn state_and_slope(&self, order: usize, s: R) -> ([R; N], [R; N]) {
        let terms = self.coefficients.get(..=order).unwrap_or(&self.coefficients);
        R::wide(
            #[inline(always)]
            || {
                let (state, slope) = horner(terms, s);
                (state, scaled(s, &slope))
            },
        )
    }
}

/// `sum_k a_k s^k` and `sum_k k a_k s^(k-1)`.
#[inline(always)]
fn horner<R: Real, const N: usize>(terms: &[[R; N]], s: R) -> ([R; N], [R; N]) {
    let mut slope = [R::zero(); N];
    let Some((highest, lower)) = terms.split_last() else { return (slope, slope) };
    let mut sum = *highest;
    // Two terms at once, which is a tenth of the instructions less.
    let (first, pairs) = lower.as_rchunks::<2>();
    for [lower, higher] in pairs.iter().rev() {
        one_more(&mut sum, &mut slope, higher, s);
        one_more(&mut sum, &mut slope, lower, s);
    }
    for below in first {
        one_more(&mut sum, &mut slope, below, s);
    }
    (sum, slope)
}

/// Horner's rule for one term more, of the polynomial and of its slope.
#[inline(always)]
fn one_more<R: Real, const N: usize>(sum: &mut [R; N], slope: &mut [R; N], below: &[R; N], s: R) {
    for i in 0..N {
        slope[i] = slope[i] * s + sum[i];
        sum[i] = sum[i] * s + below[i];
    }
}

impl<R: Real, const N: usize> Interpolant<R, N> for Series<R, N> {
    fn at(&self, t: R) -> [R; N] {
        let change = self.change((t - self.start) / self.scale);
        entries(|i| self.coefficients[0][i] + change[i])
    }
}
