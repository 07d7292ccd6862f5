//! Derives the equations of motion from operators and energies, (2.1)-(2.10), by two independent routes.

mod base_parameters;
mod body_axes;
mod cancellation;
mod composed;
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
