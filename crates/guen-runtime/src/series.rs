//! Taylor series of motions: what a generated system offers, and the sums of products that its recurrences consist of.

use crate::real::Real;
use crate::system::System;

/// The highest order of a Taylor series.
pub const HIGHEST_ORDER: usize = 32;

/// The coefficients of a series by their order.
pub type Coefficients<R, const N: usize> = [[R; N]; HIGHEST_ORDER + 1];

/// A system that expands its motion into a Taylor series, exactly but for rounding: for
/// [`Taylor`](crate::steppers::Taylor).
///
/// A declared system or scene is one that says `provide taylor;`. The recurrences are emitted from the program of its
/// right-hand side, so that one coefficient of all variables costs about as much as one evaluation, and more the higher
/// its order is: see [`PRODUCTS`](TaylorSeries::PRODUCTS).
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Taylor series",
    note = "a declared system or scene has one if it says `provide taylor;`"
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
    const PRODUCTS: usize = S::PRODUCTS;

    #[inline]
    fn series(&self, t: R, state: &[R; N], scale: R, order: usize, coefficients: &mut Coefficients<R, N>) {
        (**self).series(t, state, scale, order, coefficients);
    }
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
/// of the registers, and every sum is formed in one order, whatever that width.
#[derive(Clone, Copy, Debug)]
pub struct Convolutions<R, const A: usize, const B: usize> {
    factors: [[R; KEPT]; A],
    sums: [[R; SUMS]; B],
    order: usize,
}

impl<R: Real, const A: usize, const B: usize> Convolutions<R, A, B> {
    /// For a series up to this order, at most [`HIGHEST_ORDER`].
    #[inline(always)]
    pub fn new(order: usize) -> Self {
        Self { factors: [[R::zero(); KEPT]; A], sums: [[R::zero(); SUMS]; B], order }
    }

    /// The sum at this place, for the coefficient of order `k`.
    #[inline(always)]
    pub fn sum(&self, place: usize, k: usize) -> R {
        self.sums[place][k & 31]
    }

    /// Takes in the coefficients of order `k` of all factors.
    #[inline(always)]
    pub fn push(&mut self, pairs: &[[u16; 2]; B], now: &[R; A], k: usize) {
        // The coefficients of the highest order follow from sums for the order below.
        let last = self.order - 1;
        if k >= last {
            return;
        }
        let (factors, sums) = (&mut self.factors, &mut self.sums);
        R::wide(
            #[inline(always)]
            || spread(factors, sums, pairs, now, k, last),
        );
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
    // Whole blocks where that costs nothing: unknown coefficients are zeros.
    let count = if size_of::<R>() <= 8 { below.next_multiple_of(BLOCK) } else { below };
    for (sum, [a, b]) in sums.iter_mut().zip(pairs) {
        let (a, b) = (usize::from(*a), usize::from(*b));
        let (of_a, of_b) = (now[a], now[b]);
        let ahead = &mut sum[k + 1..][..count];
        let (row_a, row_b) = (&factors[a][..count], &factors[b][..count]);
        if a == b {
            add(ahead, row_a, of_a + of_a);
        } else {
            add_two(ahead, [row_a, row_b], [of_b, of_a]);
        }
        if 2 * k <= last {
            sum[2 * k] += of_a * of_b;
        }
    }
    if k <= KEPT {
        for (row, value) in factors.iter_mut().zip(now) {
            row[k - 1] = *value;
        }
    }
}

/// `sum_i += a_i c`
#[inline(always)]
fn add<R: Real>(sums: &mut [R], row: &[R], c: R) {
    let (blocks, rest) = sums.as_chunks_mut::<BLOCK>();
    let (rows, row_rest) = row.as_chunks::<BLOCK>();
    for (sums, row) in blocks.iter_mut().zip(rows) {
        for i in 0..BLOCK {
            sums[i] += row[i] * c;
        }
    }
    for (sum, a) in rest.iter_mut().zip(row_rest) {
        *sum += *a * c;
    }
}

/// `sum_i += a_i c + b_i d`
#[inline(always)]
fn add_two<R: Real>(sums: &mut [R], [a, b]: [&[R]; 2], [c, d]: [R; 2]) {
    let (blocks, rest) = sums.as_chunks_mut::<BLOCK>();
    let (rows_a, rest_a) = a.as_chunks::<BLOCK>();
    let (rows_b, rest_b) = b.as_chunks::<BLOCK>();
    for ((sums, a), b) in blocks.iter_mut().zip(rows_a).zip(rows_b) {
        for i in 0..BLOCK {
            sums[i] += a[i] * c + b[i] * d;
        }
    }
    for ((sum, a), b) in rest.iter_mut().zip(rest_a).zip(rest_b) {
        *sum += *a * c + *b * d;
    }
}
