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
///             rate = sums.sum(0) + 2.0 * state[0] * x;
///             sums.push(&[[x, x]], k);
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

/// Orders whose coefficients are kept: sums are asked for up to the order before the highest, and need those below.
const KEPT: usize = HIGHEST_ORDER - 2;

/// The sums `S_k(a, b) = sum_{j=1}^{k-1} a_j b_{k-j}` of a series program while it runs, by their place: `A` sums, in rows
/// of `B` places. Rows are at least as long, and fill registers if their length is 1, 2, 4 or a multiple of 8.
///
/// The coefficients of an order are kept as two rows, the first factors of all sums and the second ones. So eight sums are formed
/// side by side, one in each place of a register, and every sum is formed in one order, whatever the width of the registers. Those
/// of an odd order are formed together with those of the order before, from the same rows, but for their last term.
/// [`TaylorSeries`] has an example.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Convolutions<R, const A: usize, const B: usize> {
    /// From order one on.
    rows: [[[R; B]; 2]; KEPT],
    sums: [R; B],
    /// The sums of the order after that, without their last term.
    next: [R; B],
    order: usize,
}

impl<R: Real, const A: usize, const B: usize> Convolutions<R, A, B> {
    /// Creates empty sums for a series up to this order, at most [`HIGHEST_ORDER`].
    #[inline(always)]
    pub fn new(order: usize) -> Self {
        const { assert!(A <= B, "rows have a place for every sum") };
        let empty = [R::zero(); B];
        Self { rows: [[empty; 2]; KEPT], sums: empty, next: empty, order: order.min(HIGHEST_ORDER) }
    }

    /// The sum at this place, for the order of the coefficients that are taken in next.
    #[inline(always)]
    pub fn sum(&self, place: usize) -> R {
        self.sums[place]
    }

    /// Takes in the coefficients of order `k` of both factors of each sum: of order one first, then of two, and so on. In a
    /// closure for [`Real::wide`] this is done in the longest registers of the processor, as generated systems do.
    #[inline(always)]
    pub fn push(&mut self, factors: &[[R; 2]; A], k: usize) {
        // The coefficients of the highest order follow from sums for the order below.
        if k + 1 >= self.order {
            return;
        }
        let Some([first, second]) = self.rows.get_mut(k.wrapping_sub(1)) else { return };
        for ((first, second), [a, b]) in first.iter_mut().zip(second).zip(factors) {
            (*first, *second) = (*a, *b);
        }
        let (mut place, long) = (0, size_of::<R>() > size_of::<f64>());
        while place < A {
            place += match B - place {
                8.. if !long => self.form::<8>(k, place),
                4.. if !long => self.form::<4>(k, place),
                2.. if !long => self.form::<2>(k, place),
                _ => self.form::<1>(k, place),
            };
        }
    }

    /// Forms `W` sums of order `k + 1` from a place on; returns `W`.
    #[inline(always)]
    fn form<const W: usize>(&mut self, k: usize, place: usize) -> usize {
        let row =
            |[first, second]: &[[R; B]; 2]| [part::<R, B, W>(first, place), part::<R, B, W>(second, place)];
        let (mut sum, mut next) = ([R::zero(); W], [R::zero(); W]);
        // Of what is always there nothing is asked in a way that leaves a panic.
        if k.is_multiple_of(2) {
            let [first, ..] = &self.rows;
            let Some(last) = self.rows.get(k - 1) else { return W };
            sum = part(&self.next, place);
            add(&mut sum, row(first), row(last));
        } else {
            let half = k / 2;
            let (Some(middle), Some(later), Some(earlier)) =
                (self.rows.get(half), self.rows.get(half + 1..k), self.rows.get(..half))
            else {
                return W;
            };
            let mut before = row(middle);
            for i in 0..W {
                sum[i] += before[0][i] * before[1][i];
            }
            for (later, earlier) in later.iter().zip(earlier.iter().rev()) {
                let (later, earlier) = (row(later), row(earlier));
                add(&mut sum, earlier, later);
                add(&mut next, before, later);
                before = earlier;
            }
        }
        put(&mut self.sums, place, sum);
        put(&mut self.next, place, next);
        W
    }
}

/// Adds `a_j b_k + b_j a_k`.
#[inline(always)]
fn add<R: Real, const W: usize>(sum: &mut [R; W], earlier: [[R; W]; 2], later: [[R; W]; 2]) {
    for i in 0..W {
        sum[i] += earlier[0][i] * later[1][i] + earlier[1][i] * later[0][i];
    }
}

/// `W` numbers of a row from a place on.
#[inline(always)]
fn part<R: Real, const B: usize, const W: usize>(row: &[R; B], place: usize) -> [R; W] {
    row.get(place..).and_then(|row| row.first_chunk::<W>()).copied().unwrap_or([R::zero(); W])
}

/// Puts `W` numbers into a row from a place on.
#[inline(always)]
fn put<R, const B: usize, const W: usize>(row: &mut [R; B], place: usize, values: [R; W]) {
    if let Some(places) = row.get_mut(place..).and_then(|row| row.first_chunk_mut::<W>()) {
        *places = values;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Dual;

    /// Compares with sums term by term, of integers: both are exact.
    fn sums_are_those_of_the_terms<R: Real, const A: usize, const B: usize>() {
        let coefficient = |place: usize, k: usize| ((place * 7 + k * 5) % 11) as f64 - 4.0;
        let mut sums = Convolutions::<R, A, B>::new(HIGHEST_ORDER);
        for k in 1..HIGHEST_ORDER - 1 {
            let factors = core::array::from_fn(|p| [p, p + A].map(|p| R::from_f64(coefficient(p, k))));
            sums.push(&factors, k);
            for place in 0..A {
                let expected: f64 =
                    (1..=k).map(|j| coefficient(place, j) * coefficient(place + A, k + 1 - j)).sum();
                assert_eq!(sums.sum(place).to_f64(), expected, "sum {place} of {A}, order {}", k + 1);
            }
        }
    }

    #[test]
    fn rows_of_any_length_have_the_sums_of_the_terms() {
        sums_are_those_of_the_terms::<f64, 1, 1>();
        sums_are_those_of_the_terms::<f64, 2, 2>();
        sums_are_those_of_the_terms::<f64, 3, 4>();
        sums_are_those_of_the_terms::<f64, 13, 16>();
        sums_are_those_of_the_terms::<f64, 15, 15>();
        sums_are_those_of_the_terms::<f32, 5, 8>();
        sums_are_those_of_the_terms::<Dual<f64, 2>, 13, 16>();
    }
}
