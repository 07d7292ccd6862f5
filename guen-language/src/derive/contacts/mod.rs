//! Contacts: the motion without their forces, what their forces do to it, and their functions.
//!
//! The system is derived once more with a force along every row of the contacts. The rates are affine in these forces, so that
//! their derivatives by a force are `M^-1 W^T`, found by the elimination that solves the system.
//!
//! `branches` of piecewise functions are held within a mode. `one_mode` derives scenes in a single mode anew, with its `friction` as forces; `eliminated`
//! gives modes of other scenes rates of their own.

pub(super) mod branches;
pub(super) mod eliminated;
mod equations;
pub(super) mod friction;
pub(super) mod one_mode;
mod painleve;
mod programs;
mod rows;
mod scene;

use std::rc::Rc;

use guen_symbolic::{Derivation, ExprId, Programs};

pub(super) use equations::{ContactEquations, affine};
pub use painleve::Painleve;
pub(super) use scene::SceneContacts;

use crate::diagnostics::Faults;
use crate::model::{Contacts, Model};
use branches::Branch;
use equations::{ContactFunctions, FreeMotion};
use programs::{LevelContacts, programs};

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
    /// The resets that the level has, in order.
    pub resets: Vec<ResetFacts>,
    /// The branches of piecewise functions, which are signals after the switches and resets.
    pub branches: Vec<Branch>,
    /// The modes whose rates have a program of their own, by their places.
    pub eliminated: Vec<usize>,
}

/// A reset of a level.
#[derive(Clone, Debug)]
pub struct ResetFacts {
    /// The reset by its index.
    pub reset: usize,
    /// The assignments of variables that the level has: the index of each, and the place of its variable in the state.
    pub assignments: Vec<(usize, usize)>,
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
        let level = LevelContacts {
            modes: &contacts.modes,
            switches: &switches,
            motions: &equations.motions,
            functions: &equations.functions,
            limits: &limits(model),
        };
        let (programs, mut facts) = programs(&mut model.bench, &contacts, &level, name, faults)?;
        facts.resets = resets(model, &contacts);
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

/// Every reset, with the places of its variables in the whole state.
fn resets(model: &Model<'_>, contacts: &Contacts<'_>) -> Vec<ResetFacts> {
    let (_, size) = model.sizes();
    let variables: Vec<ExprId> = (0..size).map(|place| model.variable(place)).collect();
    let place = |variable: ExprId| variables.iter().position(|known| *known == variable);
    let resets = contacts.resets.iter().enumerate();
    resets
        .map(|(reset, entry)| {
            let given = entry.assignments.iter().enumerate();
            let assignments =
                given.filter_map(|(given, (variable, _))| Some((given, place(*variable)?))).collect();
            ResetFacts { reset, assignments }
        })
        .collect()
}

/// The constants with the limits that they are declared to have.
fn limits(model: &Model<'_>) -> Vec<(ExprId, [ExprId; 2])> {
    model.constants.iter().filter_map(|constant| Some((constant.symbol, constant.limits?))).collect()
}
