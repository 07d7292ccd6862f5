//! The part of a declared system that a level of detail has: all of it, or what a scene keeps.

use guen_symbolic::{CarriedFunction, ExprId};

use crate::model::{FormEntry, FormKind, Model};

/// A variable of the state by its place there: coordinates first, then parameters, then states beside the motion.
pub type StateIndex = usize;

/// A variable by the part of the state that it belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum StatePart {
    /// A coordinate.
    Coordinate(usize),
    /// A parameter.
    Parameter(usize),
    /// A state beside the motion.
    State(usize),
}

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
    /// The states beside the motion among them.
    pub states: Vec<usize>,
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

impl Selection {
    /// Takes these variables, in the order of the state.
    pub fn take(&mut self, model: &Model<'_>, variables: Vec<StateIndex>) {
        for place in &variables {
            match model.part(*place) {
                StatePart::Coordinate(i) => self.coordinates.push(i),
                StatePart::Parameter(s) => self.parameters.push(s),
                StatePart::State(k) => self.states.push(k),
            }
        }
        self.variables = variables;
    }
}

impl Model<'_> {
    /// The number of coordinates, and of variables of the whole state.
    pub fn sizes(&self) -> (usize, usize) {
        let n = self.coordinates.len();
        (n, n + self.mechanics.forms.degrees + self.states.len())
    }

    /// The variables that a name stands for: one, or the components of a parameter that was written as a vector.
    pub fn places(&self, name: &str) -> Vec<StateIndex> {
        let (n, l) = (self.coordinates.len(), self.mechanics.forms.degrees);
        let state = self.states.iter().position(|state| state.name.text == name);
        let coordinate = self.coordinates.iter().position(|c| c.name.text == name);
        // A rate that the macro has chosen is written nowhere: its place is that of the coordinate.
        let is_written = |form: &FormEntry<'_>| coordinate.is_none() && form.written.text == name;
        let parameters =
            self.forms.iter().enumerate().filter(|(_, form)| {
                form.kind == FormKind::Parameter && (form.name == name || is_written(form))
            });
        let parameters = parameters.map(|(s, _)| n + s);
        coordinate.into_iter().chain(parameters).chain(state.map(|k| n + l + k)).collect()
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

    /// The part of the state that a variable belongs to, with its place there.
    pub fn part(&self, place: StateIndex) -> StatePart {
        let (n, l) = (self.coordinates.len(), self.mechanics.forms.degrees);
        match place.checked_sub(n) {
            None => StatePart::Coordinate(place),
            Some(s) if s < l => StatePart::Parameter(s),
            Some(s) => StatePart::State(s - l),
        }
    }

    /// The name of a variable.
    pub fn variable_name(&self, place: StateIndex) -> &str {
        match self.part(place) {
            StatePart::Coordinate(i) => &self.coordinates[i].name.text,
            StatePart::Parameter(s) => &self.forms[s].name,
            StatePart::State(k) => &self.states[k].name.text,
        }
    }

    /// The symbol of a variable.
    pub fn variable(&self, place: StateIndex) -> ExprId {
        match self.part(place) {
            StatePart::Coordinate(i) => self.coordinates[i].symbol,
            StatePart::Parameter(s) => self.mechanics.etas[s],
            StatePart::State(k) => self.states[k].symbol,
        }
    }
}
