//! The equations of motion without coordinates that they do not depend on, where that makes them shorter: see `symmetry`.

use super::restated::{Restated, flattened, forms, solutions, unflattened};
use crate::algebra::ExprId;
use crate::geometry::Operators;
use crate::motion::coordinates::symmetry::Symmetry;
use crate::motion::thresholds::ALL_FORMS;
use crate::motion::{Frame, Mechanics, MotionEquations};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The result of solving the equations without headings.
pub(in crate::motion) struct WithoutHeadings {
    /// The rates of the state, one list for each set of expressions that is worth a program.
    pub(in crate::motion) rates: Vec<Vec<ExprId>>,
    /// The directions along which the equations do not change.
    pub(in crate::motion) symmetry: Symmetry,
    /// The equations without that, generalised forces not included.
    pub(in crate::motion) equations: Option<MotionEquations>,
}

/// Looks for coordinates that the equations do not depend on; `None` where there are none.
pub(in crate::motion) fn without(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    (shown, raw): (&MotionEquations, &MotionEquations),
    generalised_forces: &[ExprId],
) -> Option<WithoutHeadings> {
    let (mut symmetry, reduced) = symmetry(bench, system, shown, raw);
    if symmetry.is_empty() {
        return None;
    }
    let sums = bench.graph.base_angles().iter().any(|angle| !bench.graph.is_monomial(*angle));
    bench.choose_base_angles(&symmetry.heads, &reduced);
    let velocities = symmetry.reduced_each(bench, &frame.velocities);
    let reduced = unflattened(reduced, system.forms.degrees);
    let found = forms(bench, system, &reduced, &reduced);
    let equations = found.first().cloned();
    let mut rates = solutions(bench, found, generalised_forces, &velocities);
    // Once more, for the base angles that have changed.
    let operators = Operators::new(bench, &system.forms).ok();
    let restated = operators.and_then(|operators| Restated::new(bench, system.clone(), operators));
    if let Some(mut restated) = restated {
        rates.extend(restated.rates(bench, &mut symmetry));
    }
    if sums && rates.iter().all(|rates| weighted_cost(&bench.graph, rates) <= ALL_FORMS) {
        bench.choose_base_angles(&[], &system.expressions());
    }
    Some(WithoutHeadings { rates, symmetry, equations })
}

/// Symmetries, looked for where the equations have coordinates that the force function does not have, and what is
/// left of the equations.
fn symmetry(
    bench: &mut Workbench,
    system: &Mechanics,
    shown: &MotionEquations,
    raw: &MotionEquations,
) -> (Symmetry, Vec<ExprId>) {
    let l = system.forms.degrees;
    let written: Vec<ExprId> = shown.mass.iter().flatten().chain(&shown.forces).copied().collect();
    let occurring = bench.graph.symbols_in(&written);
    let bound = bench.graph.symbols_in(&[system.force_function]);
    let coordinates = system.forms.coordinates.iter().copied();
    let free: Vec<ExprId> = coordinates
        .filter(|x| bench.graph.as_symbol(*x).is_some_and(|s| occurring.contains(&s) && !bound.contains(&s)))
        .collect();
    // Zero is no point of a manifold.
    if free.is_empty() || !system.holonomic.is_empty() {
        return Default::default();
    }
    Symmetry::new(bench, &free, &flattened(raw, l))
}
