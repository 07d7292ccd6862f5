//! A mechanical system as the derivation takes it: checked names, kinds and shapes, nothing derived yet.

use crate::algebra::{ExprId, Substitution};
use crate::geometry::Forms;
use crate::workbench::Workbench;

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

/// What a symbol in an output stands for. (The rates of the parameters have symbols of their own,
/// [`Mechanics::accelerations`], and may occur in outputs too.)
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MotionSymbol {
    /// `x_i''`, by the index of the coordinate.
    CoordinateAcceleration(usize),
    /// The rate of a constraint's `eta_v`, which is zero.
    ConstraintRate,
    /// The reaction of a constraint, by the index of its form.
    Reaction(usize),
}

/// A rigid body whose `1/2 mass |velocity|^2` is a part of `T°`.
#[derive(Clone, Debug)]
pub struct RigidBody {
    /// Its mass.
    pub mass: ExprId,
    /// The velocity of its mass centre in the world's axes, the rate of a position.
    pub velocity: [ExprId; 3],
    /// The matrix from its axes to the world's, row by row.
    pub orientation: [[ExprId; 3]; 3],
    /// Its angular velocity in its own axes.
    pub spin: [ExprId; 3],
}

/// A mechanical system.
#[derive(Clone, Debug)]
pub struct Mechanics {
    /// The forms over time and coordinates.
    pub forms: Forms,
    /// Each form as it was written, over velocities: with the sums that several have in common.
    pub written: Vec<ExprId>,
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
    /// Rigid bodies in it: their velocities may be short in their own axes.
    pub bodies: Vec<RigidBody>,
    /// For each form whether `T°` speaks of its momentum, so that one that vanishes is truly zero and not left out
    /// because `T` was given on the constraints only.
    pub stated: Vec<bool>,
    /// `U(t, x)`.
    pub force_function: ExprId,
    /// The other generalised forces.
    pub forces: Vec<Force>,
    /// Quantities computed on request.
    pub outputs: Vec<ExprId>,
    /// Symbols in the outputs for what follows from the motion.
    pub motion_symbols: Vec<(ExprId, MotionSymbol)>,
}

impl RigidBody {
    fn expressions(&mut self) -> impl Iterator<Item = &mut ExprId> {
        let orientation = self.orientation.iter_mut().flatten();
        self.velocity.iter_mut().chain(orientation).chain(&mut self.spin).chain([&mut self.mass])
    }
}

impl Mechanics {
    /// The system with constants replaced by values, before anything is derived. What vanishes then is dropped, so that
    /// the derivation starts from the smaller system and not from the larger one with numbers in it.
    pub fn with_values(&self, bench: &mut Workbench, values: &[(ExprId, ExprId)]) -> Mechanics {
        let mut values = Substitution::new(values.iter().copied());
        let mut system = self.clone();
        for form in &mut system.forms.forms {
            for entry in form.row.iter_mut().chain([&mut form.offset]) {
                let value = values.of(&mut bench.graph, *entry);
                *entry = bench.tidy(value);
            }
        }
        let expressions = [&mut system.kinetic_energy, &mut system.force_function]
            .into_iter()
            .chain(system.holonomic.iter_mut().map(|h| &mut h.equation))
            .chain(system.forces.iter_mut().flat_map(|force| [&mut force.magnitude, &mut force.along]))
            .chain(&mut system.outputs)
            .chain(&mut system.written)
            .chain(system.bodies.iter_mut().flat_map(RigidBody::expressions));
        for expression in expressions {
            *expression = values.of(&mut bench.graph, *expression);
        }
        system
    }
}

impl Mechanics {
    /// Everything that the equations of motion are made of.
    pub(crate) fn expressions(&self) -> Vec<ExprId> {
        let forms = self.forms.forms.iter().flat_map(|form| form.row.iter().chain([&form.offset]));
        let forces = self.forces.iter().flat_map(|force| [&force.magnitude, &force.along]);
        forms.chain(forces).chain([&self.kinetic_energy, &self.force_function]).copied().collect()
    }
}
