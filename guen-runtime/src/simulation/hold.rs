//! Sample and hold: a controller looks at equal intervals, and its inputs are held in between.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::cell::RefCell;

use crate::numbers::real::{Ordered, Real};
use crate::simulation::optional_projection::OptionalProjection;
use crate::simulation::recorder::Recorder;
use crate::simulation::sampling::Sampling;
use crate::steppers::{Cause, Checkpoint, Interpolant, Method, Setting, Statistics, StepperRun};
use crate::system::inputs::actuated::{Actuated, StateOf, WithInputs};
use crate::system::inputs::input_values::InputSamples;

/// A function of time and state that may have a memory of its own.
type Controller<'a, S, R, const N: usize> =
    Box<dyn FnMut(R, &StateOf<S, R, N>) -> <S as Actuated<R, N>>::Inputs + 'a>;

/// A controller with its period, and the inputs that it has held.
pub struct Hold<'a, S: Actuated<R, N>, R: Real, const N: usize> {
    period: R,
    controller: Controller<'a, S, R, N>,
    samples: Vec<(R, S::Inputs)>,
}

impl<S: Actuated<R, N>, R: Real, const N: usize> core::fmt::Debug for Hold<'_, S, R, N> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Hold").field("period", &self.period).finish_non_exhaustive()
    }
}

impl<'a, S: Actuated<R, N>, R: Real, const N: usize> Hold<'a, S, R, N> {
    pub(super) fn new(period: R, controller: impl FnMut(R, &StateOf<S, R, N>) -> S::Inputs + 'a) -> Self {
        Self { period, controller: Box::new(controller), samples: Vec::new() }
    }

    /// Asks for the inputs from this time on, and keeps them.
    fn sample(&mut self, t: R, state: &[R; N]) -> Result<S::Inputs, Cause> {
        let inputs = (self.controller)(t, &(*state).into());
        // A step takes more memory, and is refused first if there is a limit.
        self.samples.try_reserve(1).map_err(|_| Cause::Memory { limit: usize::MAX })?;
        self.samples.push((t, inputs));
        Ok(inputs)
    }
}

/// A system whose inputs were held.
pub(super) type Sampled<S, R, const N: usize> =
    WithInputs<S, InputSamples<R, <S as Actuated<R, N>>::Inputs>, R, N>;

impl<'a, S, R, M, P, const N: usize> Sampling<R, Sampled<S, R, N>, M, P, N> for Hold<'a, S, R, N>
where
    R: Ordered,
    S: Actuated<R, N>,
    P: Interpolant<R, N>,
    M: Method<R, OptionalProjection<S::Driven>, N>,
    for<'r> M::Run<'r>: StepperRun<R, OptionalProjection<S::Driven>, N, Polynomial = P>,
{
    const MEMORY: usize = size_of::<(R, S::Inputs)>();
    type Method<'m>
        = Holding<'m, 'a, S, Recorder<'m, M, R, P>, R, N>
    where
        Self: 'm,
        M: 'm,
        P: 'm;

    fn method<'m>(&'m mut self, recorder: &'m Recorder<'m, M, R, P>) -> Self::Method<'m> {
        Holding { method: recorder, hold: RefCell::new(self) }
    }

    fn finished(self, system: Sampled<S, R, N>) -> Sampled<S, R, N> {
        WithInputs::new(system.system, InputSamples::of(self.samples))
    }
}

/// The method, begun anew at every sample.
pub(super) struct Holding<'h, 'a, S: Actuated<R, N>, M, R: Real, const N: usize> {
    method: &'h M,
    hold: RefCell<&'h mut Hold<'a, S, R, N>>,
}

impl<'h, 'a, S, M, R, const N: usize> Method<R, OptionalProjection<Sampled<S, R, N>>, N>
    for Holding<'h, 'a, S, M, R, N>
where
    R: Ordered,
    S: Actuated<R, N>,
    M: Method<R, OptionalProjection<S::Driven>, N>,
{
    type Run<'r>
        = Held<'r, 'h, 'a, S, M, M::Run<'r>, R, N>
    where
        Self: 'r;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        Held {
            method: self.method,
            hold: &self.hold,
            run: self.method.start(start),
            system: None,
            origin: start.time,
            samples: 0,
            next: start.time,
            before: Statistics::default(),
            reached: *start,
        }
    }

    /// The samples go on: the controller is asked at its own times.
    fn restart<'r>(&'r self, run: &mut Self::Run<'r>, start: &Checkpoint<R, N>) {
        self.method.restart(&mut run.run, &Checkpoint { statistics: Statistics::default(), ..*start });
        run.before = start.statistics;
        run.reached = *start;
    }
}

/// The system with these inputs held.
fn held<S, R, const N: usize>(
    system: &OptionalProjection<Sampled<S, R, N>>,
    inputs: S::Inputs,
) -> OptionalProjection<S::Driven>
where
    R: Real,
    S: Actuated<R, N>,
{
    OptionalProjection { system: system.system.system.held(inputs), projects: system.projects }
}

/// A run whose inputs are held from sample to sample.
pub(super) struct Held<'r, 'h, 'a, S: Actuated<R, N>, M, C, R: Real, const N: usize> {
    method: &'r M,
    hold: &'r RefCell<&'h mut Hold<'a, S, R, N>>,
    /// The run since the last sample.
    run: C,
    /// The system with the inputs of the last sample; none before the first.
    system: Option<OptionalProjection<S::Driven>>,
    origin: R,
    samples: u64,
    /// The time of the next sample.
    next: R,
    /// The work until the last sample.
    before: Statistics,
    reached: Checkpoint<R, N>,
}

impl<S, M, C, R, const N: usize> Held<'_, '_, '_, S, M, C, R, N>
where
    R: Ordered,
    S: Actuated<R, N>,
    C: StepperRun<R, OptionalProjection<S::Driven>, N>,
{
    /// Takes a sample where the run stands, on the way to a time.
    fn sample(&mut self, system: &OptionalProjection<Sampled<S, R, N>>, target: R) -> Result<(), Cause> {
        /// Roundings of a span within which a sample is at its end.
        const SAMPLE_ROUNDINGS: f64 = 4.0;

        let time = self.reached.time;
        let mut hold = self.hold.borrow_mut();
        if !(hold.period.is_finite() && hold.period.to_f64() > 0.0) {
            return Err(Cause::Setting(Setting::Period));
        }
        if (target - time).to_f64() < 0.0 {
            return Err(Cause::Setting(Setting::Backwards));
        }
        // Not summed up, hence without drift.
        let next = self.origin + R::from_f64((self.samples + 1) as f64) * hold.period;
        if (next - time).to_f64() <= 0.0 {
            return Err(Cause::StepUnderflow);
        }
        let inputs = hold.sample(time, &self.reached.state)?;
        let rest = (target - next).to_f64();
        let slack =
            SAMPLE_ROUNDINGS * R::epsilon().to_f64() * f64::max(target.to_f64().abs(), next.to_f64().abs());
        self.next = if rest > 0.0 && rest <= slack { target } else { next };
        self.samples += 1;
        self.system = Some(held(system, inputs));
        Ok(())
    }

    /// The place of the run, with the work since its start.
    fn stand(&mut self) {
        self.reached = *self.run.checkpoint();
        self.reached.statistics += self.before;
    }
}

impl<'r, S, M, C, R, const N: usize> StepperRun<R, OptionalProjection<Sampled<S, R, N>>, N>
    for Held<'r, '_, '_, S, M, C, R, N>
where
    R: Ordered,
    S: Actuated<R, N>,
    M: Method<R, OptionalProjection<S::Driven>, N, Run<'r> = C>,
    C: StepperRun<R, OptionalProjection<S::Driven>, N>,
{
    const EVALUATIONS: u32 = C::EVALUATIONS;
    const JUDGED: bool = C::JUDGED;
    type Polynomial = C::Polynomial;

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        &self.reached
    }

    fn advance(
        &mut self,
        system: &OptionalProjection<Sampled<S, R, N>>,
        target: R,
        dense: bool,
    ) -> Result<(), Cause> {
        if self.system.is_none() || self.reached.time == self.next {
            self.sample(system, target)?;
            self.before = self.reached.statistics;
            self.run = self.method.start(&Checkpoint::new(self.reached.time, &self.reached.state));
        }
        let Some(held) = &self.system else { return Ok(()) };
        let end = if (target - self.next).to_f64() > 0.0 { self.next } else { target };
        let made = self.run.advance(held, end, dense);
        self.stand();
        made
    }

    fn is_last(&self, target: R) -> bool {
        (target - self.next).to_f64() <= 0.0 && self.run.is_last(target)
    }

    fn defect(&self, system: &OptionalProjection<Sampled<S, R, N>>, before: &Checkpoint<R, N>) -> [R; N] {
        match &self.system {
            Some(system) => self.run.defect(system, before),
            None => self.run.defect(&held(system, S::Inputs::default()), before),
        }
    }

    fn dense(&mut self, system: &OptionalProjection<Sampled<S, R, N>>) -> C::Polynomial {
        let polynomial = match &self.system {
            Some(system) => self.run.dense(system),
            None => self.run.dense(&held(system, S::Inputs::default())),
        };
        self.stand();
        polynomial
    }
}
