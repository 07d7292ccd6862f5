//! The proved properties of a system, as types: markers that an integrator can demand, and the class of its
//! operators.

use core::fmt;

macro_rules! marker {
    ($(#[$doc:meta])* $name:ident: $message:literal, $note:literal) => {
        $(#[$doc])*
        #[diagnostic::on_unimplemented(message = $message, note = $note)]
        pub trait $name {}

        impl<S: $name + ?Sized> $name for &S {}
    };
}

marker! {
    /// Every constraint is integrable: the operators `X_0, X_1 .. X_l` of the possible displacements are closed
    /// under the bracket. The constraints then bind positions, not only velocities.
    Holonomic:
    "`{Self}` is not known to be holonomic",
    "the operators of its displacements are not closed under the bracket, or that could not be proved"
}

marker! {
    /// Some combination of the constraints is not integrable: a bracket of `X_0, X_1 .. X_l` leaves their span.
    Nonholonomic:
    "`{Self}` is not known to be nonholonomic",
    "a holonomic system keeps relations among its coordinates, which methods for nonholonomic ones neglect"
}

marker! {
    /// Holonomic with constant structure coefficients `C_rst`, `r` from 0: the displacements form a Lie group in
    /// the parameters as declared. The coefficients may depend on the physical constants.
    LieGroup:
    "the displacements of `{Self}` do not form a Lie group in its parameters",
    "its structure coefficients vary, or it is nonholonomic; other parameters may help"
}

marker! {
    /// Nonholonomic with constant structure coefficients `C_rst` and `C_rsv`, in the parameters as declared.
    IncompleteLieGroup:
    "the displacements of `{Self}` do not form an incomplete Lie group in its parameters",
    "its structure coefficients vary, or it is holonomic; other parameters may help"
}

marker! {
    /// Time occurs in neither the constraints nor, as functions of coordinates and velocities, the energies.
    Scleronomic:
    "time occurs in the constraints or the energies of `{Self}`",
    "what is demanded here holds for scleronomic systems only"
}

marker! {
    /// Time occurs in the constraints or the energies.
    Rheonomic:
    "time occurs in neither the constraints nor the energies of `{Self}`",
    "what is demanded here holds for rheonomic systems only"
}

marker! {
    /// The constraints are linear in the velocities, without a free term (`a_v0 = 0`): rest is possible in
    /// every position.
    Catastatic:
    "the constraints of `{Self}` have free terms",
    "what is demanded here needs constraints that are linear in the velocities"
}

marker! {
    /// The energy integral of [`Monitored::energy`](crate::Monitored::energy) is constant along every motion.
    Conservative:
    "`{Self}` is not known to be conservative",
    "its energy changes by forces, by constraints that move, or by explicit time"
}

/// The class of a system's operators, in the parameters as declared: whether they are closed, and whether their
/// structure coefficients are constant.
///
/// The class belongs to the forms, not to the motion: other parameters may change whether the coefficients are
/// constant, never whether the system is holonomic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// Closed with constant coefficients: a Lie group.
    HolonomicConstant,
    /// Closed with variable coefficients.
    HolonomicVariable,
    /// Not closed, with constant coefficients: an incomplete Lie group.
    NonholonomicConstant,
    /// Not closed, with variable coefficients.
    NonholonomicVariable,
    /// The zero test could not decide whether the operators are closed: nothing is claimed.
    Undecided,
}

impl Class {
    /// Whether the operators are closed, that is, all constraints integrable.
    pub const fn is_holonomic(self) -> bool {
        matches!(self, Self::HolonomicConstant | Self::HolonomicVariable)
    }

    /// Whether the structure coefficients are constant in time and position.
    pub const fn has_constant_coefficients(self) -> bool {
        matches!(self, Self::HolonomicConstant | Self::NonholonomicConstant)
    }
}

impl fmt::Display for Class {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::HolonomicConstant => "holonomic, a Lie group",
            Self::HolonomicVariable => "holonomic, with variable coefficients",
            Self::NonholonomicConstant => "nonholonomic, an incomplete Lie group",
            Self::NonholonomicVariable => "nonholonomic, with variable coefficients",
            Self::Undecided => "not classified",
        })
    }
}
