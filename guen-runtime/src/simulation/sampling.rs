//! The inputs of a simulation: as they are at every time, or held between the samples of a controller.

use crate::numbers::real::{Ordered, Real};
use crate::simulation::optional_projection::OptionalProjection;
use crate::simulation::recorder::Recorder;
use crate::steppers::{Interpolant, Method, StepperRun};
use crate::system::simulate::Simulate;

/// A way to run a method `M` with dense output `P` where inputs may be sampled.
pub(super) trait Sampling<R: Real, S, M, P, const N: usize> {
    /// The memory that the inputs of a sample take, in bytes.
    const MEMORY: usize;

    /// The method with this sampling.
    type Method<'m>: Method<R, OptionalProjection<S>, N>
    where
        Self: 'm,
        M: 'm,
        P: 'm;

    /// The recorded method with this sampling.
    fn method<'m>(&'m mut self, recorder: &'m Recorder<'m, M, R, P>) -> Self::Method<'m>;

    /// The system with the inputs that were sampled on the way.
    fn finished(self, system: S) -> S;
}

/// No sampling: the inputs are those of the system at every time.
#[derive(Clone, Copy, Debug)]
pub struct Continuous;

impl<R, S, M, P, const N: usize> Sampling<R, S, M, P, N> for Continuous
where
    R: Ordered,
    S: Simulate<R, N>,
    P: Interpolant<R, N>,
    M: Method<R, OptionalProjection<S>, N>,
    for<'r> M::Run<'r>: StepperRun<R, OptionalProjection<S>, N, Polynomial = P>,
{
    const MEMORY: usize = 0;
    type Method<'m>
        = &'m Recorder<'m, M, R, P>
    where
        M: 'm,
        P: 'm;

    fn method<'m>(&'m mut self, recorder: &'m Recorder<'m, M, R, P>) -> Self::Method<'m> {
        recorder
    }

    fn finished(self, system: S) -> S {
        system
    }
}
