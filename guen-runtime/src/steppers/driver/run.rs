//! The interface between a method and the driver: a method starts a run, and a run goes on step by step.

use crate::numbers::real::Real;
use crate::steppers::driver::dense::Interpolant;
use crate::steppers::driver::error::{Cause, IntegrationError};
use crate::steppers::driver::statistics::Statistics;

/// The end of an integration that did not fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Outcome {
    /// The run arrived at the time asked for, exactly.
    Arrived,
    /// The observer, or the receiver of events, stopped it.
    Stopped,
    /// A terminal event ended it: the one at this position among the events, the first one if several happened at that
    /// instant. The receiver of events was told of all.
    Event(usize),
}

/// The result of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegrationResult<R, const N: usize> {
    /// The time reached.
    pub time: R,
    /// The state at that time.
    pub state: [R; N],
    /// Whether that is the time asked for.
    pub outcome: Outcome,
    /// The work done.
    pub statistics: Statistics,
}

/// The last accepted time and state of a run, and the work so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint<R, const N: usize> {
    /// The time.
    pub time: R,
    /// The time by which the state is later than `time`, which is rounded: zero at the end of every step, and no more than half a
    /// spacing of numbers where a run goes on from an event.
    pub time_rest: R,
    /// The state at `time + time_rest`.
    pub state: [R; N],
    /// The work done.
    pub statistics: Statistics,
}

impl<R: Real, const N: usize> Checkpoint<R, N> {
    /// The beginning of a run, before any work.
    pub fn new(time: R, state: &[R; N]) -> Self {
        Self { time, time_rest: R::zero(), state: *state, statistics: Statistics::default() }
    }

    /// The time from an earlier place of the run to this one: exact, but for one rounding of the difference.
    #[inline]
    pub fn since(&self, earlier: &Self) -> R {
        (self.time - earlier.time) + (self.time_rest - earlier.time_rest)
    }

    pub(in crate::steppers) fn done(&self, outcome: Outcome) -> IntegrationResult<R, N> {
        IntegrationResult { time: self.time, state: self.state, outcome, statistics: self.statistics }
    }

    pub(in crate::steppers) fn failed(&self, cause: Cause) -> IntegrationError<R, N> {
        IntegrationError { time: self.time, state: self.state, cause, statistics: self.statistics }
    }
}

/// A method with its settings, as an [`Integration`](crate::steppers::Integration) uses it.
///
/// All methods of this module are one, and a method written elsewhere becomes one by this trait and [`StepperRun`]. The
/// system's type is a parameter because implicit methods ask more of it than explicit ones.
#[diagnostic::on_unimplemented(
    message = "the method `{Self}` cannot integrate `{S}`",
    note = "an implicit method needs a `Differentiable` system, an adaptive one an `Ordered` real"
)]
pub trait Method<R: Real, S: ?Sized, const N: usize> {
    /// A run of the method.
    type Run<'a>: StepperRun<R, S, N>
    where
        Self: 'a;

    /// Begins a run at this time and state, before any work. Nothing is checked yet.
    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_>;

    /// Restarts a run, after a step that is rejected or at a time at which the rates jump. A method that keeps something beside the run, as
    /// the sampling times of a controller, keeps it over the restart.
    fn restart<'a>(&'a self, run: &mut Self::Run<'a>, start: &Checkpoint<R, N>) {
        *run = self.start(start);
    }
}

impl<R: Real, S: ?Sized, M: Method<R, S, N>, const N: usize> Method<R, S, N> for &M {
    type Run<'a>
        = M::Run<'a>
    where
        Self: 'a;

    fn start(&self, start: &Checkpoint<R, N>) -> Self::Run<'_> {
        (**self).start(start)
    }

    fn restart<'a>(&'a self, run: &mut Self::Run<'a>, start: &Checkpoint<R, N>) {
        (**self).restart(run, start);
    }
}

/// A run of one method from one initial state.
pub trait StepperRun<R: Real, S: ?Sized, const N: usize> {
    /// Evaluations of the right-hand side in a usual step, by which a guard chooses how often to check.
    const EVALUATIONS: u32;

    /// Whether a guard judges single steps by [`defect`](StepperRun::defect): so with a fixed step, while a method that chooses
    /// its steps estimates their errors itself.
    const JUDGED: bool = false;

    /// The motion over one step, as [`dense`](StepperRun::dense) returns it: for most methods a [`Dense`](crate::steppers::Dense).
    type Polynomial: Interpolant<R, N>;

    /// Whether the polynomial is less exact than the step itself: what is located on it is then computed once more by a step.
    const COARSE_POLYNOMIAL: bool = true;

    /// Returns the last accepted time and state, and the work so far.
    fn checkpoint(&self) -> &Checkpoint<R, N>;

    /// Makes one accepted step towards `target`, which is not the present time. A step is as long as the difference of
    /// the times at its ends, to the bit, so that the state belongs to the time whatever the clock says; the step that
    /// reaches the target sets the time to it. With `dense`, what [`dense`](StepperRun::dense) needs is kept.
    ///
    /// # Errors
    ///
    /// What made the step impossible; the run stands where it stood.
    fn advance(&mut self, system: &S, target: R, dense: bool) -> Result<(), Cause>;

    /// Sets the size of the step that is tried next, where the method chooses its steps and has not made one yet.
    fn try_first(&mut self, _step: f64) {}

    /// Makes as many accepted steps towards `target` as are given, at least one: fewer if it arrives, and none that is known
    /// to be the last but the first. The same as [`advance`](StepperRun::advance) as often, where nobody looks in between; a
    /// method can keep in registers then what it would leave in memory.
    ///
    /// # Errors
    ///
    /// What made a step impossible; the run stands where it stood before that step.
    fn go_on(&mut self, system: &S, target: R, steps: u32) -> Result<(), Cause> {
        for made in 0..steps.max(1) {
            if made > 0 && (self.checkpoint().time == target || self.is_last(target)) {
                break;
            }
            self.advance(system, target, false)?;
        }
        Ok(())
    }

    /// Whether the next step towards `target` is known to be the last; only methods with a fixed step know.
    #[inline]
    fn is_last(&self, _target: R) -> bool {
        false
    }

    /// The estimated error of the step made last, which began at `before` and was made with `dense`: absolute, for every
    /// entry of the state. None for methods that are not [`JUDGED`](StepperRun::JUDGED). What it evaluates is the guard's and
    /// is not counted.
    fn defect(&self, _system: &S, _before: &Checkpoint<R, N>) -> [R; N] {
        [R::zero(); N]
    }

    /// The motion over the step made last, as a polynomial. To be asked for only after a step that was made with
    /// `dense`. May evaluate the right-hand side, which is counted.
    fn dense(&mut self, system: &S) -> Self::Polynomial;
}
