//! Kinematics from the root to the leaves: velocities, then accelerations at zero rates of the parameters.

mod accelerations;
mod biases;
mod coordinates;
pub(super) mod kinematics;
