//! Linear algebra on arrays of fixed size: as much of it as the analyses need, over every ordered real.

use crate::numbers::real::{Ordered, Real};

/// `sum a_i b_i`.
pub(crate) fn dot<R: Real, const N: usize>(a: &[R; N], b: &[R; N]) -> R {
    (0..N).fold(R::zero(), |sum, i| sum + a[i] * b[i])
}

/// `A x`.
pub(crate) fn apply<R: Real, const N: usize, const M: usize>(a: &[[R; M]; N], x: &[R; M]) -> [R; N] {
    core::array::from_fn(|i| dot(&a[i], x))
}

/// `A B`.
pub(crate) fn product<R: Real, const N: usize, const K: usize, const M: usize>(
    a: &[[R; K]; N],
    b: &[[R; M]; K],
) -> [[R; M]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| (0..K).fold(R::zero(), |s, k| s + a[i][k] * b[k][j])))
}

/// `A + B`.
pub(crate) fn plus<R: Real, const N: usize, const M: usize>(a: &[[R; M]; N], b: &[[R; M]; N]) -> [[R; M]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| a[i][j] + b[i][j]))
}

/// The transpose: columns as rows.
pub(crate) fn transpose<R: Real, const N: usize, const M: usize>(a: &[[R; M]; N]) -> [[R; N]; M] {
    core::array::from_fn(|j| core::array::from_fn(|i| a[i][j]))
}

/// The unit matrix.
pub(crate) fn unit<R: Real, const N: usize>() -> [[R; N]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| if i == j { R::one() } else { R::zero() }))
}

/// The length of a vector.
pub(crate) fn length<R: Real, const N: usize>(a: &[R; N]) -> R {
    dot(a, a).sqrt()
}

/// The largest absolute value, NaN if there is one.
pub(crate) fn largest<R: Ordered>(values: impl Iterator<Item = R>) -> f64 {
    values.fold(0.0, |most, value| {
        let value = value.to_f64().abs();
        if value > most || value.is_nan() { value } else { most }
    })
}

/// Solves `A X = B` by elimination with row pivots. `None` if a pivot is not above `N eps` times the largest entry of
/// `A`, or nothing is finite.
///
/// ```
/// use guen_runtime::control::solve;
/// let x = solve(&[[0.0, 2.0], [4.0, 0.0]], &[[6.0], [8.0]]).unwrap();
/// assert_eq!(x, [[2.0], [3.0]]);
/// assert!(solve(&[[1.0, 2.0], [2.0, 4.0]], &[[1.0], [1.0]]).is_none());
/// ```
pub fn solve<R: Ordered, const N: usize, const M: usize>(
    a: &[[R; N]; N],
    b: &[[R; M]; N],
) -> Option<[[R; M]; N]> {
    let (mut a, mut b) = (*a, *b);
    let scale = largest(a.iter().flatten().copied());
    let least = scale * R::epsilon().to_f64() * N as f64;
    for k in 0..N {
        let pivot = (k..N).reduce(|best, i| if a[i][k].abs() > a[best][k].abs() { i } else { best })?;
        let size = a[pivot][k].abs().to_f64();
        // Not `size <= least`: a NaN is no pivot either.
        if !(size > least && size.is_finite()) {
            return None;
        }
        a.swap(k, pivot);
        b.swap(k, pivot);
        for i in k + 1..N {
            let factor = a[i][k] / a[k][k];
            let (row, right) = (a[k], b[k]);
            a[i].iter_mut().zip(&row).skip(k).for_each(|(x, y)| *x -= factor * *y);
            b[i].iter_mut().zip(&right).for_each(|(x, y)| *x -= factor * *y);
        }
    }
    for k in (0..N).rev() {
        b[k] = core::array::from_fn(|j| {
            let rest = (k + 1..N).fold(b[k][j], |rest, i| rest - a[k][i] * b[i][j]);
            rest / a[k][k]
        });
    }
    b.iter().flatten().all(|x| x.is_finite()).then_some(b)
}

/// An orthonormal basis of vectors of `N` entries, grown one by one by Gram and Schmidt's method, done twice.
pub(crate) struct Basis<R, const N: usize> {
    pub(crate) vectors: [[R; N]; N],
    pub(crate) count: usize,
}

impl<R: Ordered, const N: usize> Basis<R, N> {
    pub(crate) fn new() -> Self {
        Basis { vectors: [[R::zero(); N]; N], count: 0 }
    }

    /// Returns the remainder of a vector after its projection on the basis.
    pub(crate) fn remainder(&self, vector: &[R; N]) -> [R; N] {
        let mut rest = *vector;
        for _ in 0..2 {
            for q in &self.vectors[..self.count] {
                let part = dot(q, &rest);
                for i in 0..N {
                    rest[i] -= part * q[i];
                }
            }
        }
        rest
    }

    /// Takes in the direction of a vector if more than `least` is left of it; tells whether it was.
    pub(crate) fn add(&mut self, vector: &[R; N], least: f64) -> bool {
        if self.count == N {
            return false;
        }
        let rest = self.remainder(vector);
        let size = length(&rest);
        // Of NaN nothing is left that counts.
        if size.to_f64() <= least || !size.is_finite() {
            return false;
        }
        self.vectors[self.count] = rest.map(|x| x / size);
        self.count += 1;
        true
    }

    /// Takes in the directions of vectors, always the one next of which most is left, as long as that is more than
    /// `least`; tells which they were, in this order.
    pub(crate) fn add_all(
        &mut self,
        count: usize,
        vector: impl Fn(usize) -> Option<[R; N]>,
        least: f64,
    ) -> [usize; N] {
        let mut order = [0; N];
        while self.count < N {
            let left = |j| vector(j).map(|v| (length(&self.remainder(&v)), j, v));
            let longest =
                (0..count).filter_map(left).reduce(|best, other| if other.0 > best.0 { other } else { best });
            let Some((_, j, v)) = longest else { break };
            let place = self.count;
            if !self.add(&v, least) {
                break;
            }
            order[place] = j;
        }
        order
    }
}
