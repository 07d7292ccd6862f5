//! Systems whose Jacobian is computed by dual numbers.

use guen_runtime::{Differentiable, Linearizable, Linearization};

/// A system without code of its own for its linearisation, which dual numbers do instead: exact as well, and one evaluation
/// of the right-hand side in duals of `N` tangents.
///
/// ```
/// use guen_adapters::ByDuals;
/// use guen_runtime::{Equations, Linearizable, Real, generic};
///
/// struct Spring;
/// impl Equations<2> for Spring {
///     fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
///         [v, -x]
///     }
/// }
///
/// let linear = ByDuals(generic(Spring)).linearization(0.0, &[1.0, 2.0], &[]);
/// assert_eq!(linear.a, [[0.0, 1.0], [-1.0, 0.0]]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ByDuals<S>(
    /// The system.
    pub S,
);

impl<S: Differentiable<f64, N>, const N: usize> Linearizable<f64, N, 0> for ByDuals<S> {
    fn rates(&self, t: f64, state: &[f64; N], _inputs: &[f64; 0]) -> [f64; N] {
        self.0.rhs(t, state)
    }

    fn linearization(&self, t: f64, state: &[f64; N], _inputs: &[f64; 0]) -> Linearization<f64, N, 0> {
        Linearization { a: self.0.jacobian(t, state), b: [[]; N] }
    }
}
