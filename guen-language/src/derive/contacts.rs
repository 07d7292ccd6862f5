//! Contacts: the motion without their forces, what their forces do to it, and their functions.
//!
//! The system is derived once more with a force along every row of the contacts. The rates are affine in these forces, so that
//! their derivatives by a force are `M^-1 W^T`, found by the elimination that solves the system.

mod equations;
mod painleve;
mod programs;
mod rows;
mod scene;

use std::rc::Rc;

use guen_symbolic::{Derivation, ExprId, Programs};

pub(super) use equations::ContactEquations;
pub use painleve::Painleve;
pub(super) use scene::SceneContacts;

use equations::{ContactFunctions, FreeMotion};
use programs::{Level, programs};

use super::branches::Branch;
use crate::diagnostics::Faults;
use crate::model::{Contacts, Model};

/// The facts about contacts that the programs do not tell.
#[derive(Clone, Debug, Default)]
pub struct ContactFacts {
    /// The modes, each with a state of every contact.
    pub modes: Vec<Vec<usize>>,
    /// The switches that the level has, by index.
    pub switches: Vec<usize>,
    /// Whether slipping contacts have one reaction.
    pub painleve: Painleve,
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
        let level = Level {
            modes: &contacts.modes,
            switches: &switches,
            motions: &equations.motions,
            functions: &equations.functions,
            limits: &limits(model),
        };
        let (programs, mut facts) = programs(&mut model.bench, &contacts, &level, name, faults)?;
        facts.changed = changed(model, &contacts);
        Some((programs, facts, Rc::new(equations)))
    });
    model.contacts = Some(contacts);
    derived
}

/// Reports what is wrong in the rows of contacts; nothing else is derived of them.
pub(super) fn check(model: &mut Model<'_>, faults: &mut Faults) {
    if let Some(contacts) = model.contacts.take() {
        let _equations = equations::derive(model, &contacts, None, faults);
        model.contacts = Some(contacts);
    }
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

/// The constants with the limits that they are declared to have.
fn limits(model: &Model<'_>) -> Vec<(ExprId, [ExprId; 2])> {
    model.constants.iter().filter_map(|constant| Some((constant.symbol, constant.limits?))).collect()
}
