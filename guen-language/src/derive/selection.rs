//! The part of a declared system that a level of detail has: all of it, or what a scene keeps.

use guen_symbolic::{CarriedFunction, ExprId};

use crate::model::{FormKind, Model};

/// A variable of the state by its place there: coordinates first, then parameters.
pub type StateIndex = usize;

/// A variable that a scene holds at its initial value: a constant of the scene.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    /// The place in the state of the whole system.
    pub place: StateIndex,
    /// The symbol of the constant.
    pub symbol: ExprId,
}

/// The variables, constants and quantities of a level of detail, by indices into the model.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// The variables of the state, in its order.
    pub variables: Vec<StateIndex>,
    /// The coordinates among them.
    pub coordinates: Vec<usize>,
    /// The parameters among them.
    pub parameters: Vec<usize>,
    /// The physical constants that are given at run time.
    pub constants: Vec<usize>,
    /// Variables that became constants.
    pub held: Vec<Held>,
    /// The inputs.
    pub inputs: Vec<usize>,
    /// The holonomic equations, by their order in the mechanics.
    pub holonomic: Vec<usize>,
    /// The holonomic equations that follow from others, by their order in the mechanics.
    pub redundant: Vec<usize>,
    /// The forms whose momentum is offered.
    pub momenta: Vec<usize>,
    /// The forms whose reaction is offered.
    pub reactions: Vec<usize>,
    /// The outputs.
    pub outputs: Vec<usize>,
    /// Whether the energy integral is offered.
    pub energy: bool,
    /// Whether the linearisation is offered.
    pub linearization: bool,
    /// Whether operators and brackets are offered.
    pub operators: bool,
    /// The elementary functions that are states after the variables.
    pub carried: Vec<CarriedFunction>,
}

impl Model<'_> {
    /// The number of coordinates, and of variables of the whole state.
    pub fn sizes(&self) -> (usize, usize) {
        (self.coordinates.len(), self.coordinates.len() + self.mechanics.forms.degrees)
    }

    /// The variables that a name stands for: one, or the components of a parameter that was written as a vector.
    pub fn places(&self, name: &str) -> Vec<StateIndex> {
        let n = self.coordinates.len();
        let coordinate = self.coordinates.iter().position(|c| c.name.text == name);
        let parameters = self.forms.iter().enumerate().filter(|(_, form)| {
            form.kind == FormKind::Parameter && (form.name == name || form.written.text == name)
        });
        coordinate.into_iter().chain(parameters.map(|(s, _)| n + s)).collect()
    }

    /// The constraints that a name stands for, by the index of their form.
    pub fn constraints(&self, name: &str) -> Vec<usize> {
        let forms = self.forms.iter().enumerate();
        forms
            .filter(|(_, form)| {
                form.kind != FormKind::Parameter && (form.name == name || form.written.text == name)
            })
            .map(|(v, _)| v)
            .collect()
    }

    /// The name of a variable.
    pub fn variable_name(&self, place: StateIndex) -> &str {
        let n = self.coordinates.len();
        match place.checked_sub(n) {
            None => &self.coordinates[place].name.text,
            Some(s) => &self.forms[s].name,
        }
    }

    /// The symbol of a variable.
    pub fn variable(&self, place: StateIndex) -> ExprId {
        let n = self.coordinates.len();
        match place.checked_sub(n) {
            None => self.coordinates[place].symbol,
            Some(s) => self.mechanics.etas[s],
        }
    }
}
