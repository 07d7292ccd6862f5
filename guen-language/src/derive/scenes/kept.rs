//! The variables that a scene keeps, with the fewest that the holonomic equations allow.

use guen_symbolic::{Dependence, Derivation, ExprId, Workbench};

use crate::derive::contacts::SceneContacts;
use crate::derive::quantities::parts::replaced;
use crate::derive::selections::closure::{Reason, StateEquations};
use crate::derive::selections::fixed::Holding;
use crate::derive::selections::manifold::Replacement;
use crate::derive::selections::selection::StateIndex;

/// The variables of a scene.
pub(super) struct Kept {
    /// The reason by place; none for a variable that leaves.
    pub(super) reasons: Vec<Option<Reason>>,
    /// The values of coordinates that left, from holonomic equations.
    pub(super) replacements: Vec<Replacement>,
}

/// The smallest set of variables that holds the tracked ones and all that the wanted expressions depend on. Coordinates that are tracked or
/// pinned are not replaced.
fn kept(
    bench: &mut Workbench,
    dependence: &mut Dependence,
    (derivation, holding): (&Derivation, &mut Holding),
    written: &StateEquations<'_>,
    (tracked, pinned): (&[StateIndex], &[StateIndex]),
    wanted: &[(Reason, ExprId)],
) -> Kept {
    let mut reasons = written.closure(bench, dependence, tracked, wanted);
    let mut replacements: Vec<Replacement> = Vec::new();
    for candidate in Replacement::all(bench, &derivation.system, holding) {
        let stays = |i: &StateIndex| reasons[*i].is_none() || tracked.contains(i) || pinned.contains(i);
        if candidate.coordinates.iter().any(stays) {
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

/// The smallest set of variables that holds the tracked ones and all that the scene needs, with its switches and resets. Returns the needed
/// expressions beside it.
pub(super) fn closed(
    bench: &mut Workbench,
    dependence: &mut Dependence,
    (derivation, holding): (&Derivation, &mut Holding),
    written: &StateEquations<'_>,
    (tracked, asked): (&[StateIndex], &[(Reason, ExprId)]),
    contacts: &mut Option<SceneContacts<'_, '_>>,
) -> (Vec<(Reason, ExprId)>, Kept) {
    let system = &derivation.system;
    let equations: Vec<ExprId> = system.holonomic.iter().map(|h| holding.of(bench, h.equation)).collect();
    let coordinates = &written.variables[..system.forms.coordinates.len()];
    let pinned = contacts.as_ref().map_or(Vec::new(), |contacts| {
        contacts.reset_coordinates(bench, dependence, (coordinates, &equations))
    });
    loop {
        let watched = contacts.iter().flat_map(SceneContacts::watched);
        let wanted: Vec<(Reason, ExprId)> = asked.iter().cloned().chain(watched).collect();
        let stay = (tracked, &pinned[..]);
        let found = kept(bench, dependence, (derivation, holding), written, stay, &wanted);
        let Some(contacts) = contacts else { return (wanted, found) };
        let is_kept = |place: StateIndex| found.reasons[place].is_some();
        let moving = (0..written.variables.len()).filter(|place| is_kept(*place));
        let moving = moving.flat_map(|place| written.pressed[place].iter().copied());
        let needed: Vec<ExprId> = wanted.iter().map(|(_, e)| *e).chain(moving).collect();
        let has_switches = contacts.take_switches(bench, dependence, &needed);
        let known = (written.variables, &equations[..]);
        if !contacts.take_resets(bench, dependence, known, is_kept) && !has_switches {
            return (wanted, found);
        }
    }
}
