//! Finds the parameters and combinations without inertia.

use crate::algebra::ExprId;
use crate::geometry::dependence;
use crate::motion::fault::{DerivationError, affordable};
use crate::motion::{MotionEquations, Solution};
use crate::workbench::Workbench;

/// The equations solved, or what of them is without inertia.
pub(in crate::motion) fn solved(
    bench: &mut Workbench,
    equations: &MotionEquations,
) -> Result<Solution, DerivationError> {
    let solution = Solution::new(bench, &equations.mass, &equations.forces);
    affordable(bench)?;
    solution.map_err(|rows| DerivationError::SingularMass(weightless(bench, &equations.mass, &rows)))
}

/// The motion without inertia of a singular mass matrix, from a smallest set of rows that is dependent: by symmetry
/// the coefficients of the rows are the motion.
fn weightless(bench: &mut Workbench, mass: &[Vec<ExprId>], rows: &[usize]) -> Vec<(usize, Option<ExprId>)> {
    let Some((last, support)) = rows.split_last() else { return Vec::new() };
    let others: Vec<&[ExprId]> = support.iter().map(|s| &mass[*s][..]).collect();
    let Some(coefficients) = dependence(bench, &others, &mass[*last]) else {
        return rows.iter().map(|s| (*s, None)).collect();
    };
    let negative = coefficients.into_iter().map(|c| bench.graph.neg(c)).collect::<Vec<_>>();
    let one = bench.graph.one();
    support.iter().copied().chain([*last]).zip(negative.into_iter().chain([one]).map(Some)).collect()
}
