//! Systems as problems of the crate `diffsol`.

use std::cell::RefCell;

use ::diffsol::{Matrix, OdeBuilder, OdeEquationsImplicit, OdeSolverProblem, error::DiffsolError};
use guen_runtime::Linearizable;

/// A system with inputs that are held, its initial state and tolerances as a problem that every solver of `diffsol` takes:
/// `x' = rhs(t, x)` with its exact Jacobian. `M` is the solver's matrix, such as `diffsol::NalgebraMat<f64>`.
///
/// The solver asks for products of the Jacobian with one vector after the other; the linearisation is computed once for all
/// of them.
///
/// ```
/// use diffsol::{NalgebraLU, NalgebraMat, OdeSolverMethod};
/// use guen_adapters::{ByDuals, diffsol::problem};
/// use guen_runtime::{Equations, Real, generic};
///
/// #[derive(Clone)]
/// struct Spring;
/// impl Equations<2> for Spring {
///     fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
///         [v, -x]
///     }
/// }
///
/// let tolerances = [1e-9, 1e-9];
/// let problem =
///     problem::<NalgebraMat<f64>, _, 2, 0>(ByDuals(generic(Spring)), [], 0.0, [1.0, 0.0], tolerances).unwrap();
/// let mut solver = problem.bdf::<NalgebraLU<f64>>().unwrap();
/// let (states, times, _) = solver.solve(std::f64::consts::PI).unwrap();
/// # use diffsol::MatrixCommon;
/// let end = states.inner().column(times.len() - 1);
/// assert!((end[0] + 1.0).abs() < 1e-5);
/// ```
///
/// # Errors
///
/// What the builder of `diffsol` refuses, such as tolerances that are not positive.
pub fn problem<M, S, const N: usize, const K: usize>(
    system: S,
    inputs: impl Into<[f64; K]>,
    t0: f64,
    start: [f64; N],
    [relative, absolute]: [f64; 2],
) -> Result<OdeSolverProblem<impl OdeEquationsImplicit<M = M, V = M::V, T = f64, C = M::C>>, DiffsolError>
where
    M: Matrix<T = f64>,
    S: Linearizable<f64, N, K> + Clone + 'static,
{
    let inputs = inputs.into();
    let (of_rates, of_products) = (system.clone(), system);
    // The last time and state at which the Jacobian was asked for, and the Jacobian.
    let known: RefCell<Option<(f64, [f64; N], [[f64; N]; N])>> = RefCell::new(None);
    OdeBuilder::<M>::new()
        .t0(t0)
        .rtol(relative)
        .atol([absolute])
        .rhs_implicit(
            move |x, _, t, rates| rates.copy_from_slice(&of_rates.rates(t, &state(x), &inputs)),
            move |x, _, t, v, product| {
                let x = state(x);
                let mut known = known.borrow_mut();
                let is_known = known.as_ref().is_some_and(|(time, state, _)| *time == t && *state == x);
                if !is_known {
                    *known = Some((t, x, of_products.linearization(t, &x, &inputs).a));
                }
                let Some((_, _, rows)) = known.as_ref() else { return };
                for (entry, row) in product.iter_mut().zip(rows) {
                    *entry = row.iter().zip(v).map(|(a, v)| a * v).sum();
                }
            },
        )
        .init(move |_, _, x| x.copy_from_slice(&start), N)
        .build()
}

/// The slice of a solver as a state.
fn state<const N: usize>(x: &[f64]) -> [f64; N] {
    std::array::from_fn(|i| x[i])
}
