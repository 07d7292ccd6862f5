//! The settings that methods which choose their steps have in common.

use crate::numbers::real::Ordered;
use crate::steppers::all_finite;
use crate::steppers::driver::error::{Cause, Setting};
use crate::steppers::driver::run::Checkpoint;
use crate::steppers::step_size::Tolerance;
use crate::system::System;

/// The settings of a method that chooses its steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings {
    pub(in crate::steppers) tolerance: Tolerance,
    pub(in crate::steppers) max_steps: u64,
    pub(in crate::steppers) first_step: Option<f64>,
}

impl Settings {
    /// Checks the settings and the state at the beginning of a run, and returns the slope there and the first step, if one is set.
    pub(in crate::steppers) fn begin<R, S, const N: usize>(
        &self,
        system: &S,
        reached: &mut Checkpoint<R, N>,
    ) -> Result<([R; N], Option<f64>), Cause>
    where
        R: Ordered,
        S: System<R, N> + ?Sized,
    {
        self.tolerance.check()?;
        let Checkpoint { time, state, .. } = *reached;
        if !time.is_finite() || !all_finite(&state) {
            return Err(Cause::NotFinite);
        }
        let slope = system.rhs(time, &state);
        reached.statistics.evaluations += 1;
        if !all_finite(&slope) {
            return Err(Cause::NotFinite);
        }
        match self.first_step {
            Some(step) if !(step > 0.0 && step.is_finite()) => Err(Cause::Setting(Setting::Step)),
            step => Ok((slope, step)),
        }
    }
}

/// The settings `max_steps` and `first_step` of a method with tolerances.
macro_rules! adaptive_settings {
    ($Method:ident) => {
        impl<R: Ordered> $Method<R> {
            /// The number of trial steps allowed unless another one is set.
            pub const MAX_STEPS: u64 = 100_000;

            /// Limits the number of trial steps.
            pub fn with_max_steps(self, max_steps: u64) -> Self {
                Self { max_steps, ..self }
            }

            /// Sets the first step.
            pub fn with_first_step(self, first_step: f64) -> Self {
                Self { first_step: Some(first_step), ..self }
            }

            fn settings(&self) -> crate::steppers::settings::Settings {
                let tolerance = Tolerance { relative: self.rtol, absolute: self.atol };
                let (max_steps, first_step) = (self.max_steps, self.first_step);
                crate::steppers::settings::Settings { tolerance, max_steps, first_step }
            }
        }
    };
}
pub(in crate::steppers) use adaptive_settings;
