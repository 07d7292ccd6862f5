//! Derives the equations of motion from operators and energies, (2.1)-(2.10).
//!
//! In the order of the data, which is the order of reading:
//!
//! 1. `declaration`, `graph`: a system as it was declared; frames, places, bodies, forms and loads as a graph.
//! 2. `quasi_velocities`: velocities, kinetic energy and forces along the operators; `derivation` is the whole, and begins with these.
//! 3. `definition`: the equations (2.7) as a mass matrix and forces, in two ways, and the proof of whatever is found at points modulo p.
//! 4. `coordinates`, `mass_matrix`: what depends on which coordinates; `M eta' = f` solved for the accelerations.
//! 5. `formulations`: the list of ways to the rates, the equations as they are stated among them. Of bodies: `multibody`, with a plan of its own,
//!    outwards and inwards. Of equations as they are stated: `recursive`, `body_axes`, `constraint_forces`, and `large` where these would be too long.
//!    In `other_parameters`: `spins`, `headings`, `base_parameters`.
//! 6. `results`: energies, momenta, reactions and further rates.
//!
//! `fault` has the reasons why there are no equations, `thresholds` the costs from which on something is not tried.

mod coordinates;
mod declaration;
mod definition;
mod derivation;
mod fault;
mod formulations;
mod graph;
mod mass_matrix;
mod quasi_velocities;
mod results;
mod thresholds;

pub use coordinates::dependence::Dependence;
pub use declaration::{FirstOrderState, Force, Holonomic, Mechanics, MotionSymbol, Multibody, RigidBody};
pub use definition::equations::MotionEquations;
pub use definition::poincare::equations as equations_by_definition;
pub use derivation::{Class, Derivation};
pub use fault::DerivationError;
pub use formulations::multibody::elimination_text;
pub use formulations::{Formulated, REFUTED, formulation_names};
pub use graph::{
    BodyNode, FormShape, FrameId, FrameNode, Motion, Place, SystemGraph, Turn, Velocity, VelocityComponent,
};
pub use mass_matrix::solve::Solution;
pub use quasi_velocities::frame::Frame;
pub use quasi_velocities::kinetic::{KineticTerm, NotQuadratic, decompose};
pub use quasi_velocities::velocity_forms::{VelocityForm, VelocityPartials};
pub use results::energy::Energies;
pub use thresholds::{COUPLED_COORDINATES, WRITTEN_OUT_PARAMETERS};
