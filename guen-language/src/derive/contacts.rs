//! Contacts: the motion without their forces, what their forces do to it, and their functions.
//!
//! The system is derived once more with a force along every row of the contacts. The rates are affine in these forces, so that
//! their derivatives by a force are `M^-1 W^T`, found by the elimination that solves the system.

mod equations;
mod programs;
mod scene;

use std::rc::Rc;

use guen_symbolic::{Derivation, ExprId, Programs, Verdict, Workbench};

pub(super) use equations::ContactEquations;
pub(super) use scene::SceneContacts;

use equations::{ContactFunctions, FreeMotion};
use programs::programs;

use super::branches::Branch;
use crate::diagnostics::Faults;
use crate::model::{ContactKind, Contacts, Model};

/// The facts about contacts that the programs do not tell.
#[derive(Clone, Debug, Default)]
pub struct ContactFacts {
    /// The modes, each with a state of every contact.
    pub modes: Vec<Vec<usize>>,
    /// The switches that the level has, by index.
    pub switches: Vec<usize>,
    /// Whether a slipping contact can be proved to have one reaction in every mode.
    pub painleve_free: bool,
    /// Pairs of a contact that slips and one that touches, for which the proof failed.
    pub coupled: Vec<(usize, usize)>,
    /// The rows, on the constraints.
    pub rows: Vec<ExprId>,
    /// The Delassus matrix, its lower triangle row by row.
    pub delassus: Vec<ExprId>,
    /// Whether a row moves by itself.
    pub drifts: bool,
    /// The places in the state that each reset changes, in the order in which they are written.
    pub changed: Vec<Vec<usize>>,
    /// The branches of piecewise functions, which are signals after the switches and resets.
    pub branches: Vec<Branch>,
    /// The modes whose rates have a program of their own, by their places.
    pub eliminated: Vec<usize>,
}

/// The programs of contacts, the facts about them, and the equations that scenes are made of; `None` after a fault, and where there are
/// neither contacts, nor switches, nor resets.
pub(super) fn derive(
    model: &mut Model<'_>,
    faults: &mut Faults,
) -> Option<(Programs, ContactFacts, Rc<ContactEquations>)> {
    let contacts = model.contacts.take()?;
    let derived = equations::derive(model, &contacts, None, faults).and_then(|equations| {
        let switches: Vec<usize> = (0..contacts.switches.len()).collect();
        let name = model.declaration.name.span();
        let level = (&equations.motions[..], &equations.functions);
        let (programs, mut facts) = programs(&mut model.bench, &contacts, &switches, level, name, faults)?;
        facts.modes = contacts.modes.clone();
        facts.changed = changed(model, &contacts);
        Some((programs, facts, Rc::new(equations)))
    });
    model.contacts = Some(contacts);
    derived
}

/// The equations at the values that a scene fixes; `None` after a fault.
pub(super) fn at_values(
    model: &mut Model<'_>,
    contacts: &Contacts<'_>,
    fixed: (&Derivation, &[(ExprId, ExprId)]),
    faults: &mut Faults,
) -> Option<Rc<ContactEquations>> {
    equations::derive(model, contacts, Some(fixed), faults).map(Rc::new)
}

/// The places in the state that each reset changes.
fn changed(model: &Model<'_>, contacts: &Contacts<'_>) -> Vec<Vec<usize>> {
    let mechanics = &model.mechanics;
    let parameters = &mechanics.etas[..mechanics.forms.degrees];
    let states = mechanics.states.iter().map(|state| state.symbol);
    let variables: Vec<ExprId> =
        mechanics.forms.coordinates.iter().chain(parameters).copied().chain(states).collect();
    let place = |variable: ExprId| variables.iter().position(|known| *known == variable);
    let resets = contacts.resets.iter();
    resets
        .map(|reset| reset.assignments.iter().filter_map(|(variable, _)| place(*variable)).collect())
        .collect()
}

/// Whether no slip changes how a gap answers to its own force: the entries of `D` between slips with friction and gaps vanish. The
/// pairs for which they do not.
fn painleve(
    bench: &mut Workbench,
    contacts: &Contacts<'_>,
    delassus: &[ExprId],
) -> (bool, Vec<(usize, usize)>) {
    let mut normal = Vec::new();
    let mut tangential = Vec::new();
    let mut row = 0;
    for (place, entry) in contacts.entries.iter().enumerate() {
        let is_rough = entry.friction.is_some_and(|friction| !bench.graph.is_zero(friction));
        for i in 0..entry.rows.len() {
            match entry.kind {
                ContactKind::Grip => {}
                _ if i == 0 => normal.push((place, row)),
                _ if is_rough => tangential.push((place, row)),
                _ => {}
            }
            row += 1;
        }
    }
    let mut coupled = Vec::new();
    for (slipping, t) in &tangential {
        for (touching, n) in &normal {
            let (high, low) = (*t.max(n), *t.min(n));
            let entry = delassus[high * (high + 1) / 2 + low];
            if bench.verdict_on_manifold(entry) != Verdict::Zero {
                coupled.push((*slipping, *touching));
            }
        }
    }
    coupled.dedup();
    (coupled.is_empty(), coupled)
}
