//! Inputs that a controller finds at equal intervals, and that are held in between.

use crate::steppers::{Cause, Setting};

/// A function of time and state that may have a memory of its own.
pub(super) type Controller<'a, I, const N: usize> = &'a mut dyn FnMut(f64, &[f64; N]) -> I;

/// A controller with its period, on its way.
pub(super) struct Sampler<'a, I, const N: usize> {
    period: f64,
    controller: Controller<'a, I, N>,
    samples: u64,
}

impl<'a, I, const N: usize> Sampler<'a, I, N> {
    pub(super) fn new(period: f64, controller: Controller<'a, I, N>) -> Self {
        Self { period, controller, samples: 0 }
    }

    /// Refuses a period that is no positive number, and one that does not move time.
    pub(super) fn check(&self, (start, end): (f64, f64)) -> Result<(), Cause> {
        if !(self.period.is_finite() && self.period > 0.0) {
            return Err(Cause::Setting(Setting::Period));
        }
        let moves = |time: f64| time + self.period > time;
        if moves(start) && moves(end) { Ok(()) } else { Err(Cause::StepUnderflow) }
    }

    /// The time of the next sample of a run: not summed up, hence without drift. None at the end, within roundings.
    pub(super) fn next(&self, (start, end): (f64, f64)) -> Option<f64> {
        /// Roundings of a span within which a sample is at its end.
        const SAMPLE_ROUNDINGS: f64 = 4.0;

        let time = start + self.samples as f64 * self.period;
        let slack = SAMPLE_ROUNDINGS * f64::EPSILON * f64::max(time.abs(), end.abs());
        (time < end - slack).then_some(time)
    }

    /// Asks for the inputs from this time on.
    pub(super) fn sample(&mut self, t: f64, state: &[f64; N]) -> I {
        self.samples += 1;
        (self.controller)(t, state)
    }
}
