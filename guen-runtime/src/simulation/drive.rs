//! The way from a method to the steps of a simulation: straight, or with inputs that are held between the samples of a controller.

use alloc::vec::Vec;

use crate::numbers::real::Ordered;
use crate::simulation::recorder::{Recorder, Step};
use crate::simulation::settled::Settled;
use crate::steppers::{Integration, IntegrationError, IntegrationResult, Interpolant, Method, StepperRun};
use crate::system::simulate::Simulate;

/// The result of a run, and its steps.
pub type Steps<R, P, const N: usize> =
    (Result<IntegrationResult<R, N>, IntegrationError<R, N>>, Vec<Step<R, P>>);

/// The way in which a method `M` makes the steps of a system.
pub trait Drive<R, S, M, P, const N: usize> {
    /// Runs to a time, with no more memory for the steps than is given.
    fn run<const E: usize>(
        &mut self,
        integration: Integration<'_, R, Settled<S>, N, E>,
        method: &M,
        end: R,
        memory: usize,
    ) -> Steps<R, P, N>;

    /// The system with what is known of it after the run.
    fn finished(self, system: S) -> S;
}

/// The method itself makes the steps.
#[derive(Clone, Copy, Debug)]
pub struct Direct;

impl<R, S, M, P, const N: usize> Drive<R, S, M, P, N> for Direct
where
    R: Ordered,
    S: Simulate<R, N>,
    P: Interpolant<R, N>,
    M: Method<R, Settled<S>, N>,
    for<'r> M::Run<'r>: StepperRun<R, Settled<S>, N, Polynomial = P>,
{
    fn run<const E: usize>(
        &mut self,
        integration: Integration<'_, R, Settled<S>, N, E>,
        method: &M,
        end: R,
        memory: usize,
    ) -> Steps<R, P, N> {
        let recorder = Recorder::new(method, memory, 0);
        let result = integration.run(&recorder, end);
        (result, recorder.into_steps())
    }

    fn finished(self, system: S) -> S {
        system
    }
}
