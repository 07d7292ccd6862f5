//! Definitions of velocities and the equations of the core: a plan as data.

use super::forms::Functional;
use super::variables::Var;

/// The equation from which a variable that stands for its class is computed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::motion) enum Def {
    /// A parameter.
    Known,
    /// The variables from which it is one step outwards.
    Kinematic,
    /// A form, solved for it.
    Row(usize),
    /// The kinematics of another variable, which is a multiple of a known one.
    Link(Var),
    /// The turn of this variable and others into a known one, turned back.
    Back(Var),
    /// The core.
    Core(usize),
}

/// A combination that vanishes.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(in crate::motion) enum Equation {
    /// A form.
    Row(usize),
    /// The kinematics of a variable, without the variable.
    Link(Var),
}

/// The order of elimination: the definition of each variable, and the core of equations that are left.
#[derive(Clone)]
pub(in crate::motion) struct Plan {
    pub(in crate::motion) defs: Vec<Option<Def>>,
    /// The forms, parameters subtracted.
    pub(in crate::motion) rows: Vec<Functional>,
    /// The equations of the core.
    pub(in crate::motion) core: Vec<Equation>,
    /// The unknowns of the core.
    pub(in crate::motion) unknowns: Vec<Var>,
    pub(in crate::motion) used: Vec<bool>,
}
