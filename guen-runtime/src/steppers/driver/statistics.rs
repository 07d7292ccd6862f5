//! The work that an integration did, as numbers.

use core::ops::AddAssign;

/// The work that an integration did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Statistics {
    /// Evaluations of the right-hand side, those for dense output included. A derivative along one direction counts as
    /// one, a Taylor series of order `p` as `p`.
    pub evaluations: u64,
    /// Evaluations of the Jacobian; none with explicit methods.
    pub jacobians: u64,
    /// Steps that advanced the state.
    pub accepted: u64,
    /// Trial steps that were repeated with a shorter step; none with a fixed step.
    pub rejected: u64,
    /// Switches of piecewise functions that were located, and behind which the run started anew.
    pub switches: u64,
    /// Switches that a method with a fixed step went over without locating them: each costs it an error of the size of the jump
    /// times the step.
    pub switches_passed: u64,
}

impl AddAssign for Statistics {
    /// Adds the work of a further run.
    fn add_assign(&mut self, other: Self) {
        self.evaluations += other.evaluations;
        self.jacobians += other.jacobians;
        self.accepted += other.accepted;
        self.rejected += other.rejected;
        self.switches += other.switches;
        self.switches_passed += other.switches_passed;
    }
}
