//! Taylor series of motions: what a generated system offers, and the sums of products that its recurrences consist of.

use crate::numbers::power_series::HIGHEST_ORDER;
use crate::numbers::real::Real;
use crate::system::System;
use crate::system::forward::forward;

/// The coefficients of a series by their order, `coefficients[k][i]` of the variable `i`: see
/// [`TaylorSeries::series`].
pub type Coefficients<R, const N: usize> = [[R; N]; HIGHEST_ORDER + 1];

/// A system that expands its motion into a Taylor series, exactly but for rounding: for
/// [`Taylor`](crate::steppers::Taylor).
///
/// A declared system or scene is one that says `provide taylor;`. The recurrences are emitted from the program of its
/// right-hand side, so that one coefficient of all variables costs about as much as one evaluation, and more the higher
/// its order is: see [`PRODUCTS`](TaylorSeries::PRODUCTS).
///
/// ```
/// use guen_runtime::{Coefficients, Convolutions, HIGHEST_ORDER, System, TaylorSeries};
///
/// /// `x' = x^2`, written by hand: `x(s) = 1/(1 - s)` from one.
/// struct Growth;
/// impl System<f64, 1> for Growth {
///     fn rhs(&self, _t: f64, &[x]: &[f64; 1]) -> [f64; 1] {
///         [x * x]
///     }
/// }
/// impl TaylorSeries<f64, 1> for Growth {
///     const PRODUCTS: usize = 1;
///     fn series(&self, _t: f64, state: &[f64; 1], scale: f64, order: usize, to: &mut Coefficients<f64, 1>) {
///         let mut sums = Convolutions::<f64, 1, 1>::new(order);
///         let mut rate = state[0] * state[0];
///         to[0] = *state;
///         for k in 1..=order {
///             to[k] = [scale * rate / k as f64];
///             let x = to[k][0];
///             rate = sums.sum(0, k) + 2.0 * state[0] * x;
///             sums.push(&[[0, 0]], &[x], k);
///         }
///     }
/// }
///
/// let mut coefficients = [[0.0]; HIGHEST_ORDER + 1];
/// Growth.series(0.0, &[1.0], 1.0, 20, &mut coefficients);
/// assert!(coefficients[..=20].iter().all(|[c]| (c - 1.0).abs() < 1e-14));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Taylor series",
    note = "a declared system or scene has one if it says `provide taylor;`",
    note = "inputs that are a closure have none: write them as an `InputLaw`, `.law(..)`, or hold them, `.hold(period, controller)`",
    note = "constants are prepared before, with `.prepare()?`; a prepared system with inputs gets them by `.driven(..)`"
)]
pub trait TaylorSeries<R: Real, const N: usize>: System<R, N> {
    /// The sums of products `sum_j a_j b_{k-j}` that a coefficient of order `k` takes: each is about `k` products, half as
    /// many for squares. All else is independent of `k`.
    const PRODUCTS: usize;

    /// The coefficients `x_0 .. x_order` of the motion through a state,
    ///
    /// ```text
    /// x(t + s) = sum_k x_k (s / scale)^k
    /// ```
    ///
    /// - `scale`: a time of the size of the steps to be made, so that the coefficients neither overflow nor underflow.
    ///   With a power of two it changes no digit.
    /// - `order`: at most [`HIGHEST_ORDER`]; a larger one counts as that. Entries beyond are left as they are.
    /// - Where the right-hand side is not finite or not smooth at the state, the coefficients are not finite either.
    fn series(&self, t: R, state: &[R; N], scale: R, order: usize, coefficients: &mut Coefficients<R, N>);
}

impl<R: Real, S: TaylorSeries<R, N> + ?Sized, const N: usize> TaylorSeries<R, N> for &S {
    forward!(self -> (**self); TaylorSeries<R, N>);
}

/// A system with `M` inputs that expands its motion into a Taylor series along series of its inputs: with an
/// [`InputLaw`](crate::InputLaw) it is a [`TaylorSeries`].
///
/// A declared system or scene is one that has inputs and says `provide taylor;`, unless a rate has `abs` or `sign` of an input.
///
/// ```
/// use guen_runtime::{Coefficients, DrivenSeries, HIGHEST_ORDER};
///
/// /// `x' = u`, written by hand.
/// struct Sum;
/// impl DrivenSeries<f64, 1, 1> for Sum {
///     const PRODUCTS: usize = 0;
///     fn series_along(
///         &self, _t: f64, state: &[f64; 1], inputs: &mut dyn FnMut(usize, &Coefficients<f64, 1>) -> [f64; 1], scale: f64,
///         order: usize, to: &mut Coefficients<f64, 1>,
///     ) {
///         to[0] = *state;
///         for k in 1..=order {
///             let [u] = inputs(k - 1, to);
///             to[k] = [u * scale / k as f64];
///         }
///     }
/// }
///
/// // x' = -x
/// let mut coefficients = [[0.0]; HIGHEST_ORDER + 1];
/// Sum.series_along(0.0, &[1.0], &mut |k, x| [-x[k][0]], 1.0, 3, &mut coefficients);
/// assert_eq!(coefficients[3], [-1.0 / 6.0]);
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Taylor series along series of its inputs",
    note = "a declared system or scene with inputs has one if it says `provide taylor;` and none of its rates has `abs` or `sign` of an input"
)]
pub trait DrivenSeries<R: Real, const N: usize, const M: usize> {
    /// The sums of products that a coefficient takes: see [`TaylorSeries::PRODUCTS`].
    const PRODUCTS: usize;

    /// The coefficients of the motion through a state, as [`TaylorSeries::series`] gives them.
    ///
    /// - `inputs`: called with `k = 0, 1, .. order - 1`, in order, and the coefficients of the motion, of which those up to `k`
    ///   are known; returns the coefficients of order `k` of the inputs, with the same `scale`.
    fn series_along(
        &self,
        t: R,
        state: &[R; N],
        inputs: &mut dyn FnMut(usize, &Coefficients<R, N>) -> [R; M],
        scale: R,
        order: usize,
        coefficients: &mut Coefficients<R, N>,
    );
}

/// Numbers that are added to at once.
const BLOCK: usize = 8;
/// Coefficients of a factor that meet another one of the same order or more: of orders 1 to 15.
const KEPT: usize = 16;
/// Sums up to the highest order but one, and what is written beyond while adding whole blocks.
const SUMS: usize = HIGHEST_ORDER + BLOCK;

/// The sums `S_k(a, b) = sum_{j=1}^{k-1} a_j b_{k-j}` of a series program while it runs, by their place: `A` factors,
/// `B` sums.
///
/// A coefficient, once known, is multiplied at once with all that are known before, and the products are added to the
/// sums of all higher orders where they belong. So the work is the same as that of summing when a sum is needed, but it
/// lies beside the path from one coefficient to the next, adjacent numbers are added to adjacent sums, whatever the width
/// of the registers, and every sum is formed in one order, whatever that width. [`TaylorSeries`] has an example.
#[derive(Clone, Copy, Debug)]
pub struct Convolutions<R, const A: usize, const B: usize> {
    factors: [[R; KEPT]; A],
    sums: [[R; SUMS]; B],
    order: usize,
}

impl<R: Real, const A: usize, const B: usize> Convolutions<R, A, B> {
    /// Creates empty sums for a series up to this order, at most [`HIGHEST_ORDER`].
    #[inline(always)]
    pub fn new(order: usize) -> Self {
        Self {
            factors: [[R::zero(); KEPT]; A],
            sums: [[R::zero(); SUMS]; B],
            order: order.min(HIGHEST_ORDER),
        }
    }

    /// The sum at this place, for the coefficient of order `k` below the highest.
    #[inline(always)]
    pub fn sum(&self, place: usize, k: usize) -> R {
        self.sums[place][k & 31]
    }

    /// Takes in the coefficients of order `k` of all factors; `pairs` are the two factors of each sum, always the same. In a
    /// closure for [`Real::wide`] this is done in the longest registers of the processor, as generated systems do.
    #[inline(always)]
    pub fn push(&mut self, pairs: &[[u16; 2]; B], now: &[R; A], k: usize) {
        // The coefficients of the highest order follow from sums for the order below.
        let last = self.order.saturating_sub(1);
        if k >= last {
            return;
        }
        spread(&mut self.factors, &mut self.sums, pairs, now, k, last);
    }
}

/// Adds the products of the coefficients of order `k` to the sums of orders `k + 1 .. 2 k`, up to `last`.
#[inline(always)]
fn spread<R: Real>(
    factors: &mut [[R; KEPT]],
    sums: &mut [[R; SUMS]],
    pairs: &[[u16; 2]],
    now: &[R],
    k: usize,
    last: usize,
) {
    let below = (k - 1).min(last - k);
    if size_of::<R>() > size_of::<f64>() {
        one_by_one(factors, sums, pairs, now, k, below);
    } else if below == 0 {
    } else if below <= BLOCK {
        in_blocks::<R, 1>(factors, sums, pairs, now, k);
    } else {
        in_blocks::<R, 2>(factors, sums, pairs, now, k);
    }
    if 2 * k <= last {
        for (sum, [a, b]) in sums.iter_mut().zip(pairs) {
            if let Some(square) = sum.get_mut(2 * k) {
                *square += now[usize::from(*a)] * now[usize::from(*b)];
            }
        }
    }
    for (row, value) in factors.iter_mut().zip(now) {
        if let Some(place) = row.get_mut(k - 1) {
            *place = *value;
        }
    }
}

/// `sum_{k+j} += a_k b_j + b_k a_j` for `B` blocks of `j`, from one. Coefficients that are not known yet are zeros.
#[inline(always)]
fn in_blocks<R: Real, const B: usize>(
    factors: &[[R; KEPT]],
    sums: &mut [[R; SUMS]],
    pairs: &[[u16; 2]],
    now: &[R],
    k: usize,
) {
    for (sum, [a, b]) in sums.iter_mut().zip(pairs) {
        let (a, b) = (usize::from(*a), usize::from(*b));
        let (of_a, of_b) = (now[a], now[b]);
        let (ahead, _) = sum[k + 1..].as_chunks_mut::<BLOCK>();
        let (row_a, row_b) = (factors[a].as_chunks::<BLOCK>().0, factors[b].as_chunks::<BLOCK>().0);
        for ((ahead, row_a), row_b) in ahead.iter_mut().zip(row_a).zip(row_b).take(B) {
            // Read as a whole, then written as a whole: so it is clear that nothing is written that is still to be read.
            let mut block = *ahead;
            let (row_a, row_b) = (*row_a, *row_b);
            for i in 0..BLOCK {
                block[i] += row_a[i] * of_b + row_b[i] * of_a;
            }
            *ahead = block;
        }
    }
}

/// Adds the products for exactly so many `j`: of long reals every product counts.
fn one_by_one<R: Real>(
    factors: &[[R; KEPT]],
    sums: &mut [[R; SUMS]],
    pairs: &[[u16; 2]],
    now: &[R],
    k: usize,
    below: usize,
) {
    for (sum, [a, b]) in sums.iter_mut().zip(pairs) {
        let (a, b) = (usize::from(*a), usize::from(*b));
        for j in 1..=below {
            sum[k + j] += factors[a][j - 1] * now[b] + factors[b][j - 1] * now[a];
        }
    }
}
