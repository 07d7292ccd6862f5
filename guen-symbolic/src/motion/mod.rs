//! Derives the equations of motion from operators and energies, (2.1)-(2.10).
//!
//! In the order of the data, which is the order of reading:
//!
//! 1. `declaration`, `graph`: a system as it was declared; frames, places, bodies, forms and loads as a graph.
//! 2. `derivation`: the whole, from the operators on; `frame`, `kinetic`, `velocity_forms`: velocities and energies along the operators.
//! 3. `stated`: the equations by the definition (`poincare`) and by projection (`projection`), compared; `large` where they would be too long.
//! 4. `formulations`: the list of ways to the rates. Of bodies: `multibody`, with a plan of its own, outwards and inwards. Of equations as they are
//!    stated: `solve`, `symmetry`, `recursive`, `body_axes`, `constraint_forces`. In other parameters, where a system is stated again
//!    (`restated`): `spins`, `headings`, `base_parameters`.
//! 5. `proof`, `lagrange`: whatever was found, held against (2.7) at points modulo p.
//! 6. `energy`, `freed`, `state_rates`: what follows beside the rates.

mod base_parameters;
mod body_axes;
mod cancellation;
mod composed;
mod constancy;
mod constraint_forces;
mod declaration;
mod dependence;
mod derivation;
mod energy;
mod equations;
mod fault;
mod forces;
mod formulations;
mod frame;
mod freed;
mod graph;
mod headings;
mod indispensable;
mod kinetic;
mod lagrange;
mod large;
mod multibody;
mod poincare;
mod projection;
mod proof;
mod recursive;
mod relative_angles;
mod restated;
mod restriction;
mod solve;
mod sparse;
mod spins;
mod state_rates;
mod stated;
mod symmetry;
mod thresholds;
mod velocity_forms;
mod weightless;

pub use declaration::{FirstOrderState, Force, Holonomic, Mechanics, MotionSymbol, Multibody, RigidBody};
pub use dependence::Dependence;
pub use derivation::{Class, Derivation};
pub use energy::Energies;
pub use equations::Equations;
pub use fault::DerivationError;
pub use formulations::{Formulated, REFUTED, formulation_names};
pub use frame::Frame;
pub use graph::{
    BodyNode, Component, FormShape, FrameId, FrameNode, Motion, Place, SystemGraph, Turn, Velocity,
};
pub use kinetic::{KineticTerm, NotQuadratic, decompose};
pub use multibody::elimination_text;
pub use poincare::equations as equations_by_definition;
pub use solve::Solution;
pub use thresholds::{COUPLED_COORDINATES, WRITTEN_OUT_PARAMETERS};
pub use velocity_forms::{VelocityForm, VelocityPartials};
