//! A system as the plant of a controller: equilibria, reduced bases, discrete pairs, controllability, optimal feedback and estimation,
//! poles, inverse dynamics.
//!
//! Everything works on arrays of fixed size, without allocation, on what [`Linearizable`](crate::Linearizable) and
//! [`Liftable`](crate::Liftable) systems compute; prepared systems offer the same with names. Whatever decides a rank
//! does it with a tolerance that is stated, and reports what it found.
//!
//! | question | answer |
//! | --- | --- |
//! | where does it rest, or turn steadily? | [`steady`], [`steady_on_constraints`] |
//! | how does it deviate, on its leaf? | [`Leaf::reduce`], [`Reduced`] |
//! | what happens over one period? | [`c2d`], [`ZeroOrderHold`], [`FlowMap`] |
//! | what can the inputs reach? | [`controllability`] |
//! | is it stable, how quick, how damped? | [`poles`] |
//! | which feedback? | [`lqr`], [`dlqr`], of a single input [`place`] |
//! | which estimate of the state? | [`kalman`], [`dkalman`] |
//! | what does a point feel like? | [`operational_inertia`] |
//! | which inputs give these accelerations? | [`MassForm`], [`inverse_dynamics`], [`affine_inverse_dynamics`] |

mod controllability;
mod discrete;
mod held;
mod inverse;
mod operational;
mod poles;
mod reduced;
mod riccati;
mod steady;
#[cfg(test)]
mod tests;

pub use crate::linear_algebra::dense::solve;
pub use controllability::{Controllability, Uncontrollable, controllability};
pub use discrete::{DiscreteError, FlowMap, ZeroOrderHold, c2d};
pub use held::steady_on_constraints;
pub use inverse::{
    InverseDynamicsError, MassForm, affine_inverse_dynamics, inverse_dynamics, inverse_dynamics_from,
};
pub use operational::operational_inertia;
pub use poles::{PlaceError, Pole, place, poles};
pub use reduced::{Component, ComponentName, Leaf, Quaternion, ReduceError, Reduced, independent};
pub use riccati::{Observer, Regulator, RiccatiError, diagonal, dkalman, dlqr, kalman, lqr};
pub use steady::{SteadyError, SteadyMotion, named, steady};
