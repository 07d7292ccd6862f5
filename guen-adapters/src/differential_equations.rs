//! Systems as ordinary differential equations of the crate `differential-equations`.

use ::differential_equations::linalg::Matrix;
use ::differential_equations::ode::ODE;
use guen_runtime::Linearizable;

/// A system with inputs that are held, as an [`ODE`] over arrays `[f64; N]`: `x' = rhs(t, x)` with its exact Jacobian.
///
/// ```
/// use differential_equations::prelude::*;
/// use guen_adapters::differential_equations::Adapted;
/// use guen_adapters::ByDuals;
/// use guen_runtime::{Equations, generic};
///
/// struct Spring;
/// impl Equations<2> for Spring {
///     fn rates<R: guen_runtime::Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
///         [v, -x]
///     }
/// }
///
/// let spring = Adapted::new(ByDuals(generic(Spring)));
/// let method = ExplicitRungeKutta::dop853().rtol(1e-10).atol(1e-10);
/// let done = IVP::ode(&spring, 0.0, std::f64::consts::PI, [1.0, 0.0]).method(method).solve().unwrap();
/// assert!((done.y.last().unwrap()[0] + 1.0).abs() < 1e-8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adapted<S, const M: usize> {
    /// The system.
    pub system: S,
    /// The inputs.
    pub inputs: [f64; M],
}

impl<S> Adapted<S, 0> {
    /// A system without inputs.
    pub fn new(system: S) -> Self {
        Adapted { system, inputs: [] }
    }
}

impl<S, const M: usize> Adapted<S, M> {
    /// A system with these inputs.
    pub fn with_inputs(system: S, inputs: impl Into<[f64; M]>) -> Self {
        Adapted { system, inputs: inputs.into() }
    }
}

impl<S: Linearizable<f64, N, M>, const N: usize, const M: usize> ODE<f64, [f64; N]> for Adapted<S, M> {
    fn diff(&self, t: f64, y: &[f64; N], dydt: &mut [f64; N]) {
        *dydt = self.system.rates(t, y, &self.inputs);
    }

    fn jacobian(&self, t: f64, y: &[f64; N], j: &mut Matrix<f64>) {
        let linear = self.system.linearization(t, y, &self.inputs);
        for (row, entries) in linear.a.iter().enumerate() {
            for (column, entry) in entries.iter().enumerate() {
                j[(row, column)] = *entry;
            }
        }
    }
}
