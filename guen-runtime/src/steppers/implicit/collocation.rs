//! The part that implicit methods of collocation share: their equations, and Newton's method for them.
//!
//! With `Z_i = x(t + c_i h) - x(t)` the equations of a step are
//!
//! ```text
//! g_i(Z) = f(t + c_i h, x + Z_i) - h^-1 sum_j (A^-1)_ij Z_j = 0
//! ```
//!
//! and a step of the simplified Newton method solves `(h^-1 A^-1 (x) 1 - 1 (x) J) dZ = g` with one Jacobian `J` for all
//! stages. In the basis `T` that brings `A^-1` to blocks, one real eigenvalue (for three stages) and a complex pair, it
//! falls apart into a real and a complex system of `N` equations.
//!
//! Source: E. Hairer and G. Wanner, *Solving Ordinary Differential Equations II*, second edition, Springer 1996,
//! section IV.8. The residuals are formed with `A^-1` itself and not in the basis, so that the digits of `T` decide how
//! fast Newton's method converges but not to what.

use crate::linear_algebra::lu::{Complex, Lu};
use crate::numbers::real::Real;
use crate::steppers::entries;
use crate::system::System;

/// A method of collocation with `S` stages, two or three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Collocation<R, const S: usize> {
    /// The nodes.
    pub c: [R; S],
    /// `A^-1`.
    inverse: [[R; S]; S],
    /// `b^T A^-1`: the end of the step is `x + sum_i d_i Z_i`.
    pub d: [R; S],
    /// The real eigenvalue of `A^-1`, which three stages have and two have not.
    pub real: Option<R>,
    /// The complex one with a positive imaginary part.
    pair: Complex<R>,
    /// The basis, its columns the real eigenvector and the real and imaginary part of the complex one.
    basis: [[R; S]; S],
    to_basis: [[R; S]; S],
}

impl<R: Real, const S: usize> Collocation<R, S> {
    /// The method with nodes `c`, matrix `a` and weights `b`; the eigenvalues of `A^-1` as far as they are known.
    pub(crate) fn new(
        c: [R; S],
        a: [[R; S]; S],
        b: [R; S],
        real: Option<R>,
        pair: Complex<R>,
    ) -> Option<Self> {
        let inverse = inverse(a)?;
        let d = entries(|j| (0..S).fold(R::zero(), |sum, i| sum + b[i] * inverse[i][j]));
        let mut columns = [[R::zero(); S]; S];
        if let Some(real) = real {
            columns[0] = eigenvector(&inverse, Complex { re: real, im: R::zero() }).map(|entry| entry.re);
        }
        let vector = eigenvector(&inverse, pair);
        columns[S - 2] = vector.map(|entry| entry.re);
        columns[S - 1] = vector.map(|entry| entry.im);
        let basis: [[R; S]; S] = core::array::from_fn(|i| core::array::from_fn(|j| columns[j][i]));
        Some(Self { c, inverse, d, real, pair, basis, to_basis: self::inverse(basis)? })
    }

    /// The factors of both systems at the step `h`; `None` where one is singular or not finite.
    pub(crate) fn factor<const N: usize>(&self, jacobian: &[[R; N]; N], h: R) -> Option<Factors<R, N>> {
        let real = match self.real {
            Some(real) => Some(Lu::new(shifted(jacobian, real / h))?),
            None => None,
        };
        let (re, im) = (self.pair.re / h, self.pair.im / h);
        let matrix: [[Complex<R>; N]; N] = core::array::from_fn(|i| {
            core::array::from_fn(|j| {
                let diagonal =
                    if i == j { Complex { re, im } } else { Complex { re: R::zero(), im: R::zero() } };
                Complex { re: diagonal.re - jacobian[i][j], im: diagonal.im }
            })
        });
        Some(Factors { real, pair: Lu::new(matrix)? })
    }

    /// The step of Newton's method from `z`, with the factors for `h`. `S` evaluations.
    pub(crate) fn newton<F, const N: usize>(
        &self,
        system: &F,
        factors: &Factors<R, N>,
        (t, x, h): (R, &[R; N], R),
        z: &[[R; N]; S],
    ) -> [[R; N]; S]
    where
        F: System<R, N> + ?Sized,
    {
        let mut residual = [[R::zero(); N]; S];
        let recip = R::one() / h;
        for (i, residual) in residual.iter_mut().enumerate() {
            let stage: [R; N] = entries(|k| x[k] + z[i][k]);
            let slope = system.rhs(t + self.c[i] * h, &stage);
            let mean = combined(&self.inverse[i], z);
            *residual = entries(|k| slope[k] - recip * mean[k]);
        }
        let mut parts = products(&self.to_basis, &residual);
        if let Some(real) = &factors.real {
            parts[0] = real.solve(parts[0]);
        }
        // With the columns p, q of the pair, A^-1 (p, q) = (p, q) [[re, im], [-im, re]], so w = w_p - i w_q solves the
        // complex system with re + i im.
        let right = entries(|k| Complex { re: parts[S - 2][k], im: -parts[S - 1][k] });
        let solution = factors.pair.solve(right);
        parts[S - 2] = entries(|k| solution[k].re);
        parts[S - 1] = entries(|k| -solution[k].im);
        products(&self.basis, &parts)
    }

    /// The stages of a step that is `ratio` times as long as the one before it, whose stages were `z`, on the
    /// polynomial of the latter.
    pub(crate) fn predicted<const N: usize>(&self, z: &[[R; N]; S], ratio: R) -> [[R; N]; S] {
        // Values of the polynomial through (0, 0) and (c_j, Z_j) at s.
        let value = |s: R| -> [R; N] {
            let weights: [R; S] = entries(|j| {
                let mut weight = s / self.c[j];
                for m in 0..S {
                    if m != j {
                        weight *= (s - self.c[m]) / (self.c[j] - self.c[m]);
                    }
                }
                weight
            });
            combined(&weights, z)
        };
        let end = value(R::one());
        self.c.map(|c| {
            let ahead = value(R::one() + ratio * c);
            entries(|k| ahead[k] - end[k])
        })
    }

    /// The slope with which the polynomial of a step begins.
    pub(crate) fn first_slope<const N: usize>(&self, z: &[[R; N]; S], h: R) -> [R; N] {
        // Of the polynomial through the slopes h^-1 (A^-1 Z)_j at c_j, at zero.
        let weights: [R; S] = entries(|j| {
            (0..S)
                .filter(|m| *m != j)
                .fold(R::one(), |weight, m| weight * self.c[m] / (self.c[m] - self.c[j]))
        });
        let mean = combined(&weights, &products(&self.inverse, z));
        entries(|k| mean[k] / h)
    }

    /// The end of the step less its beginning.
    pub(crate) fn change<const N: usize>(&self, z: &[[R; N]; S]) -> [R; N] {
        combined(&self.d, z)
    }
}

/// The factors of `h^-1 lambda - J` for the eigenvalues of `A^-1`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Factors<R, const N: usize> {
    pub real: Option<Lu<R, N>>,
    pair: Lu<Complex<R>, N>,
}

/// `sum_j w_j z_j`
pub(super) fn combined<R: Real, const N: usize, const S: usize>(weights: &[R; S], z: &[[R; N]; S]) -> [R; N] {
    entries(|k| (0..S).fold(R::zero(), |sum, j| sum + weights[j] * z[j][k]))
}

/// The product of a matrix and the rows `z`.
fn products<R: Real, const N: usize, const S: usize>(matrix: &[[R; S]; S], z: &[[R; N]; S]) -> [[R; N]; S] {
    let mut found = *z;
    for (found, row) in found.iter_mut().zip(matrix) {
        *found = combined(row, z);
    }
    found
}

/// `lambda - J`
pub(super) fn shifted<R: Real, const N: usize>(jacobian: &[[R; N]; N], lambda: R) -> [[R; N]; N] {
    core::array::from_fn(|i| entries(|j| if i == j { lambda - jacobian[i][j] } else { -jacobian[i][j] }))
}

fn inverse<R: Real, const S: usize>(matrix: [[R; S]; S]) -> Option<[[R; S]; S]> {
    let factors = Lu::new(matrix)?;
    let columns: [[R; S]; S] =
        core::array::from_fn(|j| factors.solve(entries(|i| if i == j { R::one() } else { R::zero() })));
    Some(core::array::from_fn(|i| core::array::from_fn(|j| columns[j][i])))
}

/// A vector that `matrix - lambda` annihilates, for an eigenvalue known to rounding: of two rows, orthogonal to the
/// first; of three, to the first two.
fn eigenvector<R: Real, const S: usize>(matrix: &[[R; S]; S], lambda: Complex<R>) -> [Complex<R>; S] {
    let entry = |i: usize, j: usize| {
        let value = Complex { re: matrix[i][j], im: R::zero() };
        if i == j { value - lambda } else { value }
    };
    let minor = |j: usize, k: usize| {
        if S == 2 { entry(0, k) } else { entry(0, j) * entry(1, k) - entry(0, k) * entry(1, j) }
    };
    core::array::from_fn(|i| match (S, i) {
        (2, 0) => minor(0, 1),
        (2, _) => -minor(0, 0),
        (_, 0) => minor(1, 2),
        (_, 1) => minor(2, 0),
        _ => minor(0, 1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::steppers::{Gauss4, Gauss6, Radau5};

    /// `A^-1 T = T Lambda`, with the real eigenvalue and the block of the pair.
    fn check<const S: usize>(method: &Collocation<f64, S>) {
        let mut block = [[0.0; S]; S];
        let next = usize::from(method.real.is_some());
        if let Some(real) = method.real {
            block[0][0] = real;
        }
        let Complex { re, im } = method.pair;
        (block[next][next], block[next][next + 1]) = (re, im);
        (block[next + 1][next], block[next + 1][next + 1]) = (-im, re);
        for i in 0..S {
            let left = combined(&method.inverse[i], &method.basis);
            let right = combined(&method.basis[i], &block);
            let one = combined(&method.to_basis[i], &method.basis);
            for (j, ((left, right), one)) in left.into_iter().zip(right).zip(one).enumerate() {
                assert!((left - right).abs() < 1e-12, "{i} {j}: {left} {right}");
                assert!((one - f64::from(u8::from(i == j))).abs() < 1e-12, "{i} {j}: {one}");
            }
        }
    }

    #[test]
    fn the_basis_brings_the_matrix_to_blocks() {
        check(&Gauss4::<f64>::new(1.0).collocation.unwrap());
        check(&Gauss6::<f64>::new(1.0).collocation.unwrap());
        check(&Radau5::<f64>::new(1.0, 1.0).collocation.unwrap());
    }
}
