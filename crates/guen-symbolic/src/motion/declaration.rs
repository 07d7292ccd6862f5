//! A mechanical system as the derivation takes it: checked names, kinds and shapes, nothing derived yet.

use crate::algebra::ExprId;
use crate::geometry::Forms;

/// A generalised force: it does the work `magnitude * (displacement of along)`.
#[derive(Clone, Debug)]
pub struct Force {
    /// The force, of everything.
    pub magnitude: ExprId,
    /// A form affine in the velocities; its velocity-linear part counts.
    pub along: ExprId,
}

/// A constraint on positions, `f(t, x) = 0`; its rate is one of the forms.
#[derive(Clone, Debug)]
pub struct Holonomic {
    /// The index of the form that is its rate, from 0.
    pub form: usize,
    /// `f(t, x)`.
    pub equation: ExprId,
}

/// A mechanical system.
#[derive(Clone, Debug)]
pub struct Mechanics {
    /// The forms over time and coordinates.
    pub forms: Forms,
    /// The symbols `x_1'..x_n'`.
    pub velocities: Vec<ExprId>,
    /// The symbols `eta_1..eta_n`, parameters first.
    pub etas: Vec<ExprId>,
    /// The symbols `eta_1'..eta_l'`.
    pub accelerations: Vec<ExprId>,
    /// The control inputs.
    pub inputs: Vec<ExprId>,
    /// The constraints on positions.
    pub holonomic: Vec<Holonomic>,
    /// `T°(t, x, x', eta)`, with constraints dropped.
    pub kinetic_energy: ExprId,
    /// For each form whether `T°` speaks of its momentum, so that one that vanishes is truly zero and not left out
    /// because `T` was given on the constraints only.
    pub stated: Vec<bool>,
    /// `U(t, x)`.
    pub force_function: ExprId,
    /// The other generalised forces.
    pub forces: Vec<Force>,
    /// Quantities computed on request.
    pub outputs: Vec<ExprId>,
}

impl Mechanics {
    /// Everything that the equations of motion are made of.
    pub(crate) fn expressions(&self) -> Vec<ExprId> {
        let forms = self.forms.forms.iter().flat_map(|form| form.row.iter().chain([&form.offset]));
        let forces = self.forces.iter().flat_map(|force| [&force.magnitude, &force.along]);
        forms.chain(forces).chain([&self.kinetic_energy, &self.force_function]).copied().collect()
    }
}
