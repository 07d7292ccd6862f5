//! A run of any method on any system, behind one reference: what the driver and the guard ask is compiled once for a real and a
//! size of the state.

use core::ops::ControlFlow;

use crate::numbers::real::Real;
use crate::steppers::driver::dense::Interpolant;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, Method, StepperRun};
use crate::steppers::driver::statistics::Statistics;
use crate::steppers::driver::swings::{Ends, Values};
use crate::steppers::driver::switches::{Step, Switches};
use crate::steppers::guard::Watched;
use crate::system::System;

/// Is shown every accepted step; ends the run when it breaks.
pub(super) type Observer<'a, R, const N: usize> = &'a mut dyn FnMut(R, &[R; N]) -> ControlFlow<()>;

/// A run with its system, as the driver and the guard see it. Steps are made many at a time where nobody looks between them, so
/// that a call through the reference costs nothing beside them.
pub(in crate::steppers) trait AnyRun<R: Real, const N: usize> {
    /// The system, as a guard asks it.
    fn system(&self) -> &dyn Watched<R, N>;

    /// The evaluations of a step.
    fn evaluations(&self) -> u32;

    /// Whether a guard has to judge the errors of steps.
    fn is_judged(&self) -> bool;

    fn checkpoint(&self) -> &Checkpoint<R, N>;

    /// See [`StepperRun::advance`].
    fn advance(&mut self, target: R, dense: bool) -> Result<(), Cause>;

    /// Makes so many steps, or fewer where [`StepperRun::go_on`] does, and shows each but the last to the observer. Says whether it
    /// broke.
    fn go_on(&mut self, target: R, steps: u32, observer: Option<Observer<'_, R, N>>) -> Result<bool, Cause>;

    /// See [`StepperRun::is_last`].
    fn is_last(&self, target: R) -> bool;

    /// See [`StepperRun::defect`].
    fn defect(&self, before: &Checkpoint<R, N>) -> [R; N];

    /// Writes the state at a time of the last step, on the constraints.
    fn at(&mut self, time: R, state: &mut [R; N]) -> Result<(), Cause>;
}

/// A run, its system, and the polynomial of its last step once somebody has asked for it.
pub(in crate::steppers) struct SystemRun<'a, M, R, S, const N: usize>
where
    M: Method<R, S, N>,
    R: Real,
    S: ?Sized,
{
    method: &'a M,
    run: M::Run<'a>,
    system: &'a S,
    polynomial: Option<<M::Run<'a> as StepperRun<R, S, N>>::Polynomial>,
    switched: Option<Switched<R, N>>,
}

/// The state of a run over switches.
struct Switched<R, const N: usize> {
    switches: Switches<R>,
    /// The place that the run has reached, with the work of all attempts.
    reached: Checkpoint<R, N>,
    /// Whether the next step is the first of a new run.
    restarts: bool,
    /// The rates at the end of the last step, with its time.
    rates: Option<(R, [R; N])>,
}

impl<'a, M, R, S, const N: usize> SystemRun<'a, M, R, S, N>
where
    M: Method<R, S, N>,
    R: Real,
    S: System<R, N> + ?Sized,
{
    pub(crate) fn new(method: &'a M, start: &Checkpoint<R, N>, system: &'a S) -> Self {
        let here = Values::of(system, start);
        let switched = (!here.is_empty()).then(|| Switched {
            switches: Switches::new(here),
            reached: *start,
            restarts: false,
            rates: None,
        });
        Self { method, run: method.start(start), system, polynomial: None, switched }
    }

    /// A step of a system with switches.
    fn advance_over(&mut self, target: R, dense: bool) -> Result<(), Cause> {
        /// Attempts to end a step at a crossing; halves alone take 64.
        const MOST_ATTEMPTS: u32 = 200;
        let Self { method, run, system, switched, .. } = self;
        let Some(Switched { switches, reached, restarts, rates }) = switched else { return Ok(()) };
        let from = *reached;
        let backwards = (target - from.time).to_f64() < 0.0;
        if M::Run::<'a>::JUDGED {
            run.advance(system, target, dense)?;
            let passed = switches.pass(Values::of(*system, run.checkpoint()));
            let before = reached.statistics.switches_passed;
            *reached = *run.checkpoint();
            reached.statistics.switches_passed = before + passed;
            return Ok(());
        }
        let slides = |switches: &Switches<R>, place: &Checkpoint<R, N>, crossed| {
            let found = place.time.to_f64();
            let slides = switches.slides(*system, place, backwards, crossed);
            slides.map_or(Ok(()), |switch| Err(Cause::Sliding { found, switch }))
        };
        if core::mem::take(restarts) {
            method.restart(run, &from);
        } else if from.statistics.accepted == 0 && switches.begins_on_one() {
            slides(switches, &from, None)?;
        }
        // Whether a method could not make steps as short as those to the crossing.
        let mut anyway = false;
        // The time in the step at which a function comes near to zero.
        let mut near = None;
        for _ in 0..MOST_ATTEMPTS {
            let goal = switches
                .past()
                .filter(|_| anyway)
                .unwrap_or_else(|| switches.goal(&from, near.unwrap_or(target)));
            if let Err(cause) = run.advance(system, goal, dense) {
                if anyway || switches.past().is_none() {
                    return Err(cause);
                }
                anyway = true;
                let work = run.checkpoint().statistics;
                method.restart(run, &Checkpoint { statistics: work, ..from });
                continue;
            }
            let to = *run.checkpoint();
            let values = Values::of(*system, &to);
            // A function that went through zero and back within the step has the same sign at its ends.
            if near.is_none() && !anyway && switches.past().is_none() && !switches.crosses(&values) {
                let leaves = match rates {
                    Some((time, known)) if *time == from.time => *known,
                    _ => system.rhs(from.time, &from.state),
                };
                let arrives = system.rhs(to.time, &to.state);
                *rates = Some((to.time, arrives));
                let ends = Ends { from: (&from, leaves), to: (&to, arrives) };
                near = switches.nearest(*system, &ends, &values);
                if near.is_some() {
                    method.restart(run, &again(&from, to.statistics));
                    continue;
                }
            }
            match switches.judge(&from, &to, values, anyway) {
                Step::OneSided => {
                    *reached = to;
                    return Ok(());
                }
                Step::Located { switch } => {
                    slides(switches, &to, Some(switch))?;
                    *reached = to;
                    reached.statistics.switches += 1;
                    *restarts = true;
                    return Ok(());
                }
                Step::Over => method.restart(run, &again(&from, to.statistics)),
            }
        }
        Err(Cause::StepUnderflow)
    }
}

/// The beginning of a step that is made again, with the work done: the steps that were made from it were trials.
fn again<R: Real, const N: usize>(from: &Checkpoint<R, N>, work: Statistics) -> Checkpoint<R, N> {
    let accepted = from.statistics.accepted;
    let rejected = work.rejected + work.accepted.saturating_sub(accepted);
    Checkpoint { statistics: Statistics { accepted, rejected, ..work }, ..*from }
}

// A function of its own, so that the room for what is not there is not in the frame of the caller in a build without optimisation.
#[inline]
fn forget<P>(polynomial: &mut Option<P>) {
    *polynomial = None;
}

impl<'a, M, R, S, const N: usize> AnyRun<R, N> for SystemRun<'a, M, R, S, N>
where
    M: Method<R, S, N>,
    R: Real,
    S: System<R, N> + ?Sized,
{
    fn system(&self) -> &dyn Watched<R, N> {
        &self.system
    }

    fn evaluations(&self) -> u32 {
        M::Run::<'a>::EVALUATIONS
    }

    fn is_judged(&self) -> bool {
        M::Run::<'a>::JUDGED
    }

    fn checkpoint(&self) -> &Checkpoint<R, N> {
        match &self.switched {
            Some(switched) => &switched.reached,
            None => self.run.checkpoint(),
        }
    }

    fn advance(&mut self, target: R, dense: bool) -> Result<(), Cause> {
        forget(&mut self.polynomial);
        match self.switched {
            Some(_) => self.advance_over(target, dense),
            None => self.run.advance(self.system, target, dense),
        }
    }

    fn go_on(
        &mut self,
        target: R,
        steps: u32,
        mut observer: Option<Observer<'_, R, N>>,
    ) -> Result<bool, Cause> {
        forget(&mut self.polynomial);
        if observer.is_none() && self.switched.is_none() {
            return self.run.go_on(self.system, target, steps).map(|()| false);
        }
        for made in 0..steps.max(1) {
            if made > 0 {
                let reached = self.checkpoint();
                if reached.time == target || self.run.is_last(target) {
                    break;
                }
                if observer.as_mut().is_some_and(|observer| observer(reached.time, &reached.state).is_break())
                {
                    return Ok(true);
                }
            }
            self.advance(target, false)?;
        }
        Ok(false)
    }

    fn is_last(&self, target: R) -> bool {
        self.run.is_last(target)
    }

    fn defect(&self, before: &Checkpoint<R, N>) -> [R; N] {
        self.run.defect(self.system, before)
    }

    fn at(&mut self, time: R, state: &mut [R; N]) -> Result<(), Cause> {
        let reached = self.checkpoint();
        if time == reached.time {
            *state = reached.state;
            return Ok(());
        }
        let Self { run, system, polynomial, .. } = self;
        let polynomial = match polynomial {
            Some(known) => known,
            none => none.insert(run.dense(system)),
        };
        *state = polynomial.at(time);
        system.restore(time, state).map_err(Cause::of_positions)
    }
}
