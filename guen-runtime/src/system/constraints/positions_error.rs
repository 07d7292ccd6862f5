//! The reasons why coordinates cannot fulfil constraints on positions.

use core::error::Error;
use core::fmt;

/// The reason why no coordinates were found that fulfil the constraints.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum PositionsError {
    /// A name among the given ones is no coordinate of the system.
    UnknownCoordinate {
        /// The name.
        name: &'static str,
    },
    /// Too many coordinates are given: the others cannot fulfil all constraints.
    TooManyGiven {
        /// Coordinates that are not given.
        left: usize,
        /// Constraints that they have to fulfil.
        constraints: usize,
    },
    /// The gradients of the constraints, by the coordinates that are not given, are dependent where the search
    /// arrived: at a limit of the mechanism's reach, or at a position where it branches.
    Singular {
        /// The largest left side there.
        residual: f64,
    },
    /// The search ended where no step makes the left sides smaller: there is no solution near the guess.
    NotFound {
        /// The largest left side there.
        residual: f64,
    },
    /// A left side or a gradient is infinite or NaN.
    NotFinite,
    /// The system has contacts, and its state is put back by its modes alone: `simulate`, [`Hybrid`](crate::hybrid::Hybrid) or
    /// `in_mode(mode)`.
    Contacts,
}

impl fmt::Display for PositionsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownCoordinate { name } => write!(f, "`{name}` is not a coordinate of this system"),
            Self::TooManyGiven { left, constraints } => {
                write!(f, "{left} coordinates are left to fulfil {constraints} constraints on positions")
            }
            Self::Singular { residual } => {
                write!(
                    f,
                    "the constraints on positions become dependent, {residual:e} away from being fulfilled"
                )
            }
            Self::NotFound { residual } => {
                write!(f, "no coordinates near the guess fulfil the constraints; {residual:e} is left")
            }
            Self::NotFinite => f.write_str("a constraint on positions is not finite"),
            Self::Contacts => f.write_str(
                "the system has contacts or resets, and this run would ignore them: `simulate` and `Hybrid` run through the modes, \
                 and `in_mode(mode)` is a system for every method",
            ),
        }
    }
}

impl Error for PositionsError {}
