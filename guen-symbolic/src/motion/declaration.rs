//! A mechanical system as the derivation takes it: checked names, kinds and shapes, nothing derived yet.

use super::SystemGraph;
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

/// A first-order state beside the motion, such as the current of a motor: `z' = rate`.
#[derive(Clone, Copy, Debug)]
pub struct FirstOrderState {
    /// The symbol `z`.
    pub symbol: ExprId,
    /// The rate, of everything, with the symbols of [`Mechanics::motion_symbols`].
    pub rate: ExprId,
}

/// The meaning of a symbol in an output or in the rate of a state. (The rates of the parameters have symbols of their own,
/// [`Mechanics::accelerations`], and may occur there too.)
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MotionSymbol {
    /// `x_i''`, by the index of the coordinate.
    CoordinateAcceleration(usize),
    /// The rate of a constraint's `eta_v`, which is zero.
    ConstraintRate,
    /// The reaction of a constraint, by the index of its form.
    Reaction(usize),
}

/// A rigid body or a particle of the kinetic energy.
#[derive(Clone, Debug)]
pub struct RigidBody {
    /// The mass; of no matter without a centre.
    pub mass: ExprId,
    /// The centre of mass, in the world's axes.
    pub center: Option<[ExprId; 3]>,
    /// The rotation from body axes to the world's, row by row.
    pub orientation: Option<[[ExprId; 3]; 3]>,
    /// The angular velocity in body axes, linear in the velocities, where the declaration has it: that of a quaternion is
    /// shorter than what follows from its matrix.
    pub spin: Option<[ExprId; 3]>,
    /// The entries `xx, yy, zz, xy, yz, zx` of the inertia about the centre, in body axes; of no matter without an orientation.
    pub inertia: [ExprId; 6],
}

/// The parts of `T°` and `U`, where bodies were declared.
#[derive(Clone, Debug)]
pub struct Multibody {
    /// Bodies and particles.
    pub bodies: Vec<RigidBody>,
    /// The acceleration of gravity, in the world's axes.
    pub gravity: [ExprId; 3],
    /// The part of `T°` beside the energies of the bodies.
    pub other_energy: ExprId,
    /// The part of `U` beside the weight of the bodies.
    pub other_force_function: ExprId,
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
    /// Constraints on positions that follow from the others wherever all of them hold, see [`crate::ZeroTest::redundant`]: they are
    /// no forms, and whoever measures how far a state is from the constraints looks at them, too.
    pub redundant: Vec<ExprId>,
    /// `T°(t, x, x', eta)`, with constraints dropped.
    pub kinetic_energy: ExprId,
    /// Tells for each form whether `T°` speaks of its momentum, so that one that vanishes is truly zero and not left
    /// out because `T` was given on the constraints only.
    pub stated: Vec<bool>,
    /// `U(t, x)`.
    pub force_function: ExprId,
    /// The bodies that both are made of, where the declaration has any.
    pub multibody: Option<Multibody>,
    /// Frames, places and forms as they were declared.
    pub structure: SystemGraph,
    /// The other generalised forces.
    pub forces: Vec<Force>,
    /// The states beside the motion, which forces may depend on.
    pub states: Vec<FirstOrderState>,
    /// Quantities computed on request.
    pub outputs: Vec<ExprId>,
    /// Symbols in the outputs and in the rates of the states for what follows from the motion.
    pub motion_symbols: Vec<(ExprId, MotionSymbol)>,
    /// The velocities whose rates outputs ask for, as forms of a graph with all frames and places that these speak of.
    pub measured: Option<SystemGraph>,
}

impl Multibody {
    fn expressions(&mut self) -> impl Iterator<Item = &mut ExprId> {
        let Multibody { bodies, gravity, other_energy, other_force_function } = self;
        let of_bodies = bodies.iter_mut().flat_map(|body| {
            let RigidBody { mass, center, orientation, spin, inertia } = body;
            let (center, orientation) =
                (center.iter_mut().flatten(), orientation.iter_mut().flatten().flatten());
            center.chain(orientation).chain(spin.iter_mut().flatten()).chain(inertia).chain([mass])
        });
        of_bodies.chain(gravity).chain([other_energy, other_force_function])
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
            .chain(&mut system.redundant)
            .chain(system.forces.iter_mut().flat_map(|force| [&mut force.magnitude, &mut force.along]))
            .chain(system.states.iter_mut().map(|state| &mut state.rate))
            .chain(&mut system.outputs)
            .chain(&mut system.written)
            .chain(system.multibody.iter_mut().flat_map(Multibody::expressions));
        for expression in expressions {
            *expression = values.of(&mut bench.graph, *expression);
        }
        system.structure = self.structure.with_values(&mut bench.graph, &mut values);
        let measured = self.measured.as_ref();
        system.measured = measured.map(|seen| seen.with_values(&mut bench.graph, &mut values));
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
