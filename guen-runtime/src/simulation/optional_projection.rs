//! The system that a simulation integrates: kept on its constraints on positions, unless that is not wanted.

use crate::numbers::real::Ordered;
use crate::system::System;
use crate::system::constraints::positions_error::PositionsError;
use crate::system::derivatives::differentiable::Differentiable;
use crate::system::derivatives::series::{Coefficients, TaylorSeries};
use crate::system::forward::forward;
use crate::system::simulate::Simulate;

/// A system whose states are put back onto its constraints after every step.
#[derive(Clone, Copy, Debug)]
pub struct OptionalProjection<S> {
    pub(super) system: S,
    /// Whether they are.
    pub(super) projects: bool,
}

impl<R: Ordered, S: Simulate<R, N>, const N: usize> System<R, N> for OptionalProjection<S> {
    forward!(self -> self.system; System<R, N>, guarded);

    #[inline]
    fn restore(&self, t: R, state: &mut [R; N]) -> Result<(), PositionsError> {
        if self.projects { self.system.onto_constraints(t, state) } else { self.system.restore(t, state) }
    }
}

impl<R: Ordered, S: Simulate<R, N> + Differentiable<R, N>, const N: usize> Differentiable<R, N>
    for OptionalProjection<S>
{
    forward!(self -> self.system; Differentiable<R, N>);
}

impl<R: Ordered, S: Simulate<R, N> + TaylorSeries<R, N>, const N: usize> TaylorSeries<R, N>
    for OptionalProjection<S>
{
    forward!(self -> self.system; TaylorSeries<R, N>);
}
