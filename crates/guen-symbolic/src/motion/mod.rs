//! From operators and energies to the equations of motion, (2.1)-(2.10), by two independent routes.

mod between;
mod declaration;
mod dependence;
mod derivation;
mod energy;
mod frame;
mod graph;
mod indispensable;
mod kinetic;
mod linkage;
mod multibody;
mod nested;
mod numerator;
mod poincare;
mod projection;
mod proof;
mod rephrased;
mod restriction;
mod routes;
mod solve;
mod symmetry;
mod tensions;
mod turned;
mod velocity_forms;

pub use declaration::{Force, Holonomic, Mechanics, MotionSymbol, Multibody, RigidBody};
pub use dependence::Dependence;
pub use derivation::{Class, Derivation, DerivationError, Equations};
pub use energy::Energies;
pub use frame::Frame;
pub use graph::{
    BodyNode, Component, FormShape, FrameId, FrameNode, Motion, Place, SystemGraph, Turn, Velocity,
};
pub use kinetic::{KineticTerm, NotQuadratic, decompose};
pub use poincare::equations as equations_by_definition;
pub use solve::Solution;
pub use velocity_forms::{VelocityForm, VelocityPartials};
