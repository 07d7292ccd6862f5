//! The linearisation of a right-hand side, and the seeds of the duals that it is computed with.

use crate::{Dual, Real};

/// The exact Jacobians of a right-hand side: `d(state)' = A d(state) + B d(inputs)`.
///
/// ```
/// use guen_runtime::Linearization;
/// let oscillator = Linearization { a: [[0.0, 1.0], [-4.0, 0.0]], b: [[0.0], [1.0]] };
/// assert_eq!(oscillator.a[1][0], -4.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearization<R, const N: usize, const M: usize> {
    /// `a[i][j]`, the derivative of the rate `i` by the state `j`: `N` by `N`.
    pub a: [[R; N]; N],
    /// `b[i][j]`, the derivative of the rate `i` by the input `j`: `N` by `M`.
    pub b: [[R; M]; N],
}

/// Each value as the variable with its own index: the duals whose tangents are derivatives by all of them.
///
/// ```
/// use guen_runtime::seeded;
/// let [x, y] = seeded(&[2.0, 3.0]);
/// assert_eq!((x * y).tangent, [3.0, 2.0]);
/// ```
pub fn seeded<R: Real, const N: usize>(values: &[R; N]) -> [Dual<R, N>; N] {
    core::array::from_fn(|i| Dual::variable(values[i], i))
}
