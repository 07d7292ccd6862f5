//! Guards: what is watched while a run goes on, besides that every state is finite.
//!
//! A check is made after the first step, then every `k` steps, with a `k` that [`Schedule`](schedule::Schedule) chooses, and at the end; where a check
//! finds a fault, the run goes back to the last check that did not, so that what it returns was seen to be in order.
//!
//! A singularity of the chart may be passed twice between two checks, and the functions that must not vanish are then on the side where they
//! were. So they are checked in between, as often as their price allows, and more often while they become smaller: after half of
//! the steps that would lead to zero at this pace, then after half of the rest.

pub(crate) mod defect;
mod known;
pub(crate) mod part;
pub(crate) mod reversal;
mod runs;
mod schedule;
mod watch;

pub(in crate::steppers) use known::{TimeAndState, Watched};
use runs::One;
pub(in crate::steppers) use runs::{Each, MOST};
pub(in crate::steppers) use watch::Watch;

use crate::numbers::lanes::Mask;
use crate::numbers::real::Real;
use crate::steppers::driver::error::{Cause, Setting};
use crate::system::System;

/// The limits that a run must not violate. A stepper checks these by default, on whatever the system tells in
/// [`conserved`](crate::Guarded::conserved), [`singularities`](crate::Guarded::singularities) and
/// [`condition`](crate::Guarded::condition), and methods with a fixed step by estimates of the errors of single steps.
///
/// Every accepted state is tested to be finite. After the first step, then every [`every`](Guard::every) steps, at the end
/// of the run and before an error is returned, the guard checks the rest; the first check includes the start. Where it
/// finds a fault, the run ends with the cause, and with the time and state of the last check that found none; an observer
/// has been shown the steps since then. So a run of one step is checked twice, which can cost as much as the step: a loop
/// of such runs may take [`Guard::FINITE`], and guards of its own.
///
/// With lanes as the real every lane is checked, with limits relative to its own energy and its own largest values, and a fault
/// of one ends the run of all; [`LaneMethod::integrate_in_lanes`](crate::steppers::LaneMethod::integrate_in_lanes) gives each lane an end of its own.
///
/// ```
/// use guen_runtime::steppers::Guard;
///
/// let strict = Guard { energy: 1e-9, every: Some(1), ..Guard::default() };
/// assert!(strict.energy < Guard::default().energy);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guard {
    /// The largest change of the energy since the start, relative to the largest scale `|T| + |U|` at the start and at
    /// the checks until now; for systems that keep their energy. By default 0.01: a run that is off by more is rarely one
    /// that somebody wants, whatever its accuracy was meant to be.
    pub energy: f64,
    /// The largest left side of a constraint on positions, relative to the size of its terms. By default 0.001: what
    /// is typed in with four digits passes.
    pub residual: f64,
    /// The largest distance of functions that are carried as states from their values: the largest of `|w - f|/(1 + |f|)`
    /// and of what is left of `sin^2 + cos^2 - 1` and the like. By default 0.01, as for the energy.
    pub carried: f64,
    /// The distance to a singularity of the chart at which to stop: what is [`left`](crate::RunningError::left) of each function that
    /// must not vanish, given that every entry of the state is uncertain by a rounding of the largest value that it has
    /// had. By default `1e-8`, where a term with its square in the denominator has no digits left in `f64`; in another
    /// real the limit is multiplied by the root of the ratio of the roundings.
    ///
    /// A check that finds another sign than at the start ends the run, whatever the limit. Two changes of sign between two checks
    /// are not seen. An adaptive method checks these functions as often as a 160th of the run pays for, which is after every step
    /// where they cost little beside a right-hand side, and sooner while one becomes smaller. `every: Some(1)` checks after each step.
    ///
    /// A negative limit watches none of it, and neither does [`approach`](Guard::approach) then: for a motion that is meant to pass
    /// such positions, as a linkage whose bars come to lie on one line, where the state at each side is as it should be. Everything else
    /// is watched as before, the condition of the mass matrix included.
    pub singularity: f64,
    /// The largest [`condition`](crate::Guarded::condition) of the mass matrix. By default `1e12`, where accelerations have
    /// four digits left in `f64`; in another real the limit is divided by the ratio of the roundings.
    pub condition: f64,
    /// The largest error of methods with a fixed step, estimated at every check from one step, relative to the largest value
    /// that an entry has had, and summed up as if it stood for all steps since the last check. By default 0.05.
    /// `docs/integrators.md` has the estimate of each method. Within about 160 right-hand sides of the start what is
    /// below this part of the largest entry counts as nothing, since an entry that begins at zero has no size yet.
    pub step: f64,
    /// The largest factor by which a fixed step may change a function that must not vanish. Where it is divided by, there
    /// is a pole, and the step is too long for the motion next to it. By default 2. Not watched where [`singularity`](Guard::singularity) is
    /// negative.
    pub approach: f64,
    /// The number of steps from one check to the next, at least one; if absent, chosen by the costs of a step and of
    /// a check.
    pub every: Option<u32>,
}

impl Guard {
    /// Watches nothing but that every state is finite.
    pub const FINITE: Self = Self {
        energy: f64::INFINITY,
        residual: f64::INFINITY,
        carried: f64::INFINITY,
        singularity: 0.0,
        condition: f64::INFINITY,
        step: f64::INFINITY,
        approach: f64::INFINITY,
        every: Some(u32::MAX),
    };

    /// Checks a run that was made without a guard at its start and at some later states, in their order: all that a check looks at, but for
    /// the errors of steps and the paces of functions that must not vanish. A fault that is over at the next of the states is not found.
    ///
    /// ```
    /// use guen_runtime::{Cause, Guarded, Invariants, System, steppers::Guard};
    ///
    /// struct Oscillator;
    /// impl System<f64, 2> for Oscillator {
    ///     fn rhs(&self, _t: f64, &[x, v]: &[f64; 2]) -> [f64; 2] {
    ///         [v, -x]
    ///     }
    ///     fn guarded(&self) -> impl Guarded<f64, 2> {
    ///         self
    ///     }
    /// }
    /// impl Guarded<f64, 2> for Oscillator {
    ///     fn conserved(&self, _t: f64, &[x, v]: &[f64; 2]) -> Invariants<f64> {
    ///         let energy = (v * v + x * x) / 2.0;
    ///         Invariants { energy: Some(energy), scale: energy, residual: 0.0, carried: 0.0 }
    ///     }
    /// }
    /// let check = |states| Guard::default().check_states(&Oscillator, (0.0, &[1.0, 0.0]), states);
    /// assert!(check([(2.0, [0.6, 0.8]), (9.0, [-0.8, 0.6])]).is_ok());
    /// assert!(matches!(check([(2.0, [0.6, 0.9]), (9.0, [0.6, 0.8])]), Err(Cause::Energy { found: 2.0, .. })));
    /// ```
    ///
    /// # Errors
    ///
    /// The cause with which a run would have ended that was checked at these states.
    pub fn check_states<S, const N: usize>(
        self,
        system: &S,
        start: (f64, &[f64; N]),
        states: impl IntoIterator<Item = (f64, [f64; N])>,
    ) -> Result<(), Cause>
    where
        S: System<f64, N> + ?Sized,
    {
        self.check()?;
        // Every state is as the end of a step.
        let every = self.every.filter(|steps| *steps == u32::MAX).or(Some(1));
        let start = TimeAndState { time: start.0, state: start.1 };
        let mut watch = Watch::<f64, One, N>::new(Self { every, ..self }, system, 1, true, start);
        let mut found = Ok(());
        for (time, state) in states {
            if watch.counts(1) {
                let (none, now) = (|| [0.0; N], TimeAndState { time, state: &state });
                watch.check(system, (None, none), now, Mask::all(1), |_, cause, _| found = Err(cause));
            }
            found?;
        }
        Ok(())
    }

    /// Refuses limits that make no sense.
    pub(super) fn check(&self) -> Result<(), Cause> {
        let Self { energy, residual, carried, singularity, condition, step, approach, .. } = *self;
        let valid = !singularity.is_nan()
            && [energy, residual, carried, condition, step, approach].iter().all(|limit| *limit >= 0.0);
        if valid { Ok(()) } else { Err(Cause::Setting(Setting::Guard)) }
    }

    /// The limits for a real: those given are meant for `f64`.
    pub(super) fn for_real<R: Real>(self) -> Self {
        let ratio = R::epsilon().to_f64() / f64::EPSILON;
        // Of a real too long for a ratio of its rounding to be one.
        let ratio = if ratio > 0.0 { ratio } else { f64::MIN_POSITIVE };
        Self { singularity: self.singularity * libm::sqrt(ratio), condition: self.condition / ratio, ..self }
    }
}

impl Default for Guard {
    fn default() -> Self {
        Self {
            energy: 1e-2,
            residual: 1e-3,
            carried: 1e-2,
            singularity: 1e-8,
            condition: 1e12,
            step: 0.05,
            approach: 2.0,
            every: None,
        }
    }
}
