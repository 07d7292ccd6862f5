//! The system that a simulation integrates: kept on its constraints on positions, unless that is not wanted.

use crate::numbers::real::Ordered;
use crate::numbers::running_error::RunningError;
use crate::system::System;
use crate::system::differentiable::Differentiable;
use crate::system::invariants::Invariants;
use crate::system::positions_error::PositionsError;
use crate::system::series::{Coefficients, TaylorSeries};
use crate::system::simulate::Simulate;

/// A system whose states are put back onto its constraints after every step.
#[derive(Clone, Copy, Debug)]
pub struct Settled<S> {
    pub(super) system: S,
    /// Whether that is done.
    pub(super) projects: bool,
}

impl<R: Ordered, S: Simulate<R, N>, const N: usize> System<R, N> for Settled<S> {
    #[inline]
    fn rhs(&self, t: R, state: &[R; N]) -> [R; N] {
        self.system.rhs(t, state)
    }

    #[inline]
    fn restore(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError> {
        if self.projects { self.system.onto_constraints(t, state) } else { self.system.restore(t, state) }
    }

    fn conserved(&self, t: R, state: &[R; N]) -> Invariants<R> {
        self.system.conserved(t, state)
    }

    fn singularities(
        &self,
        t: RunningError<R>,
        state: &[RunningError<R>; N],
        values: &mut [RunningError<R>],
    ) -> usize {
        self.system.singularities(t, state, values)
    }

    fn condition(&self, t: R, state: &[R; N]) -> R {
        self.system.condition(t, state)
    }

    fn check_cost(&self) -> u32 {
        self.system.check_cost()
    }

    fn singularity_check_cost(&self) -> f64 {
        self.system.singularity_check_cost()
    }
}

impl<R: Ordered, S: Simulate<R, N> + Differentiable<R, N>, const N: usize> Differentiable<R, N>
    for Settled<S>
{
    fn jacobian(&self, t: R, state: &[R; N]) -> [[R; N]; N] {
        self.system.jacobian(t, state)
    }

    fn along(&self, t: R, state: &[R; N], dt: R, dx: &[R; N]) -> [R; N] {
        self.system.along(t, state, dt, dx)
    }
}

impl<R: Ordered, S: Simulate<R, N> + TaylorSeries<R, N>, const N: usize> TaylorSeries<R, N> for Settled<S> {
    const PRODUCTS: usize = S::PRODUCTS;

    #[inline]
    fn series(&self, t: R, state: &[R; N], scale: R, order: usize, coefficients: &mut Coefficients<R, N>) {
        self.system.series(t, state, scale, order, coefficients);
    }
}
