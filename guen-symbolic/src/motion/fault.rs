//! The reason why a derivation ends without equations of motion.

use super::thresholds::COUPLED_COORDINATES;
use super::{Mechanics, NotQuadratic};
use crate::algebra::ExprId;
use crate::geometry::SingularForms;
use crate::workbench::Workbench;

/// The reason why a system has no equations of motion.
#[derive(Clone, Debug)]
pub enum DerivationError {
    /// The forms are dependent, in these ways.
    SingularForms(Vec<SingularForms>),
    /// The kinetic energy is not quadratic in the velocities.
    NotQuadratic(NotQuadratic),
    /// The mass matrix is singular as a function: a motion with these values of these parameters, by index, and all
    /// others zero is without inertia; values where they are known.
    SingularMass(Vec<(usize, Option<ExprId>)>),
    /// The derivation is more work than [`crate::MAX_WORK`].
    TooLarge,
    /// The system has more coordinates than [`crate::COUPLED_COORDINATES`], and constraints, bodies that turn, or an energy that couples
    /// too many of them.
    TooManyCoordinates,
    /// Two routes gave different equations: a mistake of ours.
    RoutesDisagree {
        /// The equation, from 0.
        equation: usize,
    },
}

/// Refuses a system that has too many coordinates for anything but sparse equations between particles.
pub(super) fn few_or_uncoupled(system: &Mechanics) -> Result<(), DerivationError> {
    let has_constraints = system.forms.len() > system.forms.degrees;
    let turns = system.structure.frames().len() > 1;
    match system.forms.len() > COUPLED_COORDINATES && (has_constraints || turns) {
        true => Err(DerivationError::TooManyCoordinates),
        false => Ok(()),
    }
}

/// Gives a derivation up that has become more work than a compiler should do.
pub(super) fn affordable(bench: &Workbench) -> Result<(), DerivationError> {
    if bench.is_exhausted() { Err(DerivationError::TooLarge) } else { Ok(()) }
}
