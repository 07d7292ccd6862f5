//! The variables that a scene keeps, with the fewest that the holonomic equations allow.

use guen_symbolic::{Dependence, Derivation, ExprId, Workbench};

use super::closure::{Reason, StateEquations};
use super::fixed::Holding;
use super::manifold::Replacement;
use super::parts::replaced;
use super::selection::StateIndex;

/// The variables of a scene.
pub(super) struct Kept {
    /// The reason by place; none for a variable that leaves.
    pub(super) reasons: Vec<Option<Reason>>,
    /// The values of coordinates that left, from holonomic equations.
    pub(super) replacements: Vec<Replacement>,
}

/// The least closed set of variables with those that are tracked and those that something wanted depends on.
pub(super) fn kept(
    bench: &mut Workbench,
    dependence: &mut Dependence,
    (derivation, holding): (&Derivation, &mut Holding),
    written: &StateEquations<'_>,
    tracked: &[StateIndex],
    wanted: &[(Reason, ExprId)],
) -> Kept {
    let mut reasons = written.closure(bench, dependence, tracked, wanted);
    let mut replacements: Vec<Replacement> = Vec::new();
    for candidate in Replacement::all(bench, &derivation.system, holding) {
        if candidate.coordinates.iter().any(|i| reasons[*i].is_none() || tracked.contains(i)) {
            continue;
        }
        replacements.push(candidate);
        let mut image = |e: &ExprId| replaced(bench, &mut replacements, *e);
        let rates: Vec<ExprId> = written.rates.iter().map(&mut image).collect();
        let pressed = written.pressed.iter().map(|list| list.iter().map(&mut image).collect());
        let pressed: Vec<Vec<ExprId>> = pressed.collect();
        let provided = wanted.iter().map(|(reason, e)| (reason.clone(), image(e)));
        let provided: Vec<_> = provided.collect();
        let flow = StateEquations { rates: &rates, pressed: &pressed, ..*written };
        let fewer = flow.closure(bench, dependence, tracked, &provided);
        let count = |reasons: &[Option<Reason>]| reasons.iter().flatten().count();
        if count(&fewer) < count(&reasons) {
            reasons = fewer;
        } else {
            replacements.pop();
        }
    }
    Kept { reasons, replacements }
}
