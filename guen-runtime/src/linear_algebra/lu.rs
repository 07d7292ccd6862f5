//! Small dense linear systems for implicit methods: elimination with row exchanges, over reals and complex numbers.
//!
//! Of our own, and not `nalgebra`'s, because implicit methods are to work without any feature and for every ordered
//! real, duals and extended precision included, which `nalgebra`'s decompositions do not take; it is forty lines.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::numbers::real::Real;

/// The operations on numbers that elimination needs.
pub(crate) trait Field:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A size, for the choice of pivots.
    fn size(self) -> f64;
}

impl<R: Real> Field for R {
    #[inline]
    fn size(self) -> f64 {
        self.to_f64().abs()
    }
}

/// `re + i im`
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Complex<R> {
    pub re: R,
    pub im: R,
}

impl<R: Real> Add for Complex<R> {
    type Output = Self;

    #[inline]
    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl<R: Real> Sub for Complex<R> {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

impl<R: Real> Mul for Complex<R> {
    type Output = Self;

    #[inline]
    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl<R: Real> Div for Complex<R> {
    type Output = Self;

    #[inline]
    fn div(self, other: Self) -> Self {
        let square = other.re * other.re + other.im * other.im;
        Self {
            re: (self.re * other.re + self.im * other.im) / square,
            im: (self.im * other.re - self.re * other.im) / square,
        }
    }
}

impl<R: Real> Neg for Complex<R> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { re: -self.re, im: -self.im }
    }
}

impl<R: Real> Field for Complex<R> {
    #[inline]
    fn size(self) -> f64 {
        self.re.to_f64().abs() + self.im.to_f64().abs()
    }
}

/// `P A = L U`, with `L` below the diagonal and `U` from it on, in one matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lu<F, const N: usize> {
    entries: [[F; N]; N],
    /// The row exchanged with row `k` in step `k`.
    exchanged: [usize; N],
}

impl<F: Field, const N: usize> Lu<F, N> {
    /// Factors `a` with partial pivoting; `None` where it is singular or not finite. `2/3 N^3` operations.
    pub(crate) fn new(mut a: [[F; N]; N]) -> Option<Self> {
        let mut exchanged = [0; N];
        for k in 0..N {
            let (mut pivot, mut size) = (k, a[k][k].size());
            for (row, entries) in a.iter().enumerate().skip(k + 1) {
                let found = entries[k].size();
                if found > size {
                    (pivot, size) = (row, found);
                }
            }
            if !(size > 0.0 && size.is_finite()) {
                return None;
            }
            a.swap(k, Self::row(pivot));
            exchanged[k] = pivot;
            let above = a[k];
            for row in &mut a[k + 1..] {
                let factor = row[k] / above[k];
                row[k] = factor;
                for (entry, above) in row.iter_mut().zip(above).skip(k + 1) {
                    *entry = *entry - factor * above;
                }
            }
        }
        Some(Self { entries: a, exchanged })
    }

    /// The number of a row, in a form of which the compiler sees that it is one: so that nothing here can panic.
    #[inline(always)]
    fn row(row: usize) -> usize {
        row.min(N.saturating_sub(1))
    }

    /// The solution of `A x = b`.
    pub(crate) fn solve(&self, mut b: [F; N]) -> [F; N] {
        // Rows were exchanged as a whole, with what stood left of the pivot: all exchanges come first.
        for (k, row) in self.exchanged.into_iter().enumerate() {
            b.swap(k, Self::row(row));
        }
        for k in 0..N {
            for row in k + 1..N {
                b[row] = b[row] - self.entries[row][k] * b[k];
            }
        }
        for k in (0..N).rev() {
            for column in k + 1..N {
                b[k] = b[k] - self.entries[k][column] * b[column];
            }
            b[k] = b[k] / self.entries[k][k];
        }
        b
    }
}

#[cfg(test)]
mod tests {
    use super::{Complex, Field, Lu};

    fn product<F: Field, const N: usize>(a: &[[F; N]; N], x: &[F; N]) -> [F; N] {
        a.map(|row| {
            let mut terms = row.into_iter().zip(*x).map(|(a, x)| a * x);
            let first = terms.next().unwrap();
            terms.fold(first, |sum, term| sum + term)
        })
    }

    #[test]
    fn real_and_complex_systems_are_solved() {
        // Rows must be exchanged: the first pivot is zero.
        let a = [[0.0, 2.0, 1.0], [1.0, -1.0, 3.0], [4.0, 1.0, -2.0]];
        let x: [f64; 3] = [1.0, -2.0, 0.5];
        let found = Lu::new(a).unwrap().solve(product(&a, &x));
        assert!(found.iter().zip(x).all(|(a, b)| (a - b).abs() < 1e-15), "{found:?}");
        let c = |re: f64, im: f64| Complex { re, im };
        let a = [[c(0.0, 0.0), c(1.0, 2.0)], [c(3.0, -1.0), c(0.5, 0.25)]];
        let x = [c(1.0, 1.0), c(-2.0, 0.5)];
        let found = Lu::new(a).unwrap().solve(product(&a, &x));
        assert!(found.iter().zip(x).all(|(a, b)| (*a - b).size() < 1e-14), "{found:?}");
    }

    #[test]
    fn a_singular_matrix_has_no_factors() {
        assert!(Lu::new([[1.0, 2.0], [2.0, 4.0]]).is_none());
        assert!(Lu::new([[f64::NAN]]).is_none());
    }
}
