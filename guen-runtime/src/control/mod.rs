//! A system as the plant of a controller: equilibria, reduced bases, discrete pairs, controllability, inverse dynamics.
//!
//! Everything works on arrays of fixed size, without allocation, on what [`Linearizable`](crate::Linearizable) and
//! [`Liftable`](crate::Liftable) systems compute; prepared systems offer the same with names. Whatever decides a rank
//! does it with a tolerance that is stated, and reports what it found.
//!
//! | question | answer |
//! | --- | --- |
//! | where does it rest, or turn steadily? | [`steady`] |
//! | how does it deviate, on its leaf? | [`Leaf::reduce`], [`Reduced`] |
//! | what happens over one period? | [`ZeroOrderHold`], [`FlowMap`] |
//! | what can the inputs reach? | [`controllability`] |
//! | which inputs give these accelerations? | [`MassForm`], [`inverse_dynamics`], [`affine_inverse_dynamics`] |

mod controllability;
mod discrete;
mod inverse;
mod reduced;
mod steady;

pub use crate::linear_algebra::dense::solve;
pub use controllability::{Controllability, Uncontrollable, controllability};
pub use discrete::{DiscreteError, FlowMap, ZeroOrderHold};
pub use inverse::{
    InverseDynamicsError, MassForm, affine_inverse_dynamics, inverse_dynamics, inverse_dynamics_from,
};
pub use reduced::{Component, Leaf, Quaternion, ReduceError, Reduced, independent};
pub use steady::{SteadyError, SteadyMotion, named, steady};
