//! Events: functions of the state that cross zero during a run, and how the crossing is found.

use crate::numbers::real::{Ordered, Real};

/// The crossings of zero that count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// Crossings from below zero to above, in the order in which the run goes.
    Rising,
    /// Crossings from above zero to below, in the order in which the run goes.
    Falling,
    /// Crossings in either direction.
    Any,
}

/// A function of the state whose crossing of zero is an event: an impact, a loss of contact, a switching surface.
///
/// - A crossing is seen as a change of sign between the ends of a step, or between the ends of its parts where
///   [`with_checks`](Event::with_checks) asks for some. Two crossings between two checks, such as a short contact or a
///   function that only touches zero, are not seen, unless the run ends between them. A zero at the very end of a step counts
///   as a crossing. In the first step of a run a function that begins near zero is also checked after an eighth of a part, a
///   64th and so on: a ball that bounces is seen to land again, however short its flight.
/// - It is located on the method's dense output by bisection and regula falsi, until the bracket is no longer than the
///   tolerance, and reported at the end of the bracket that is past the crossing. The tolerance bounds the error of the
///   root finder; the dense output adds its own (see [`Integration`](crate::steppers::Integration)).
/// - When an event ends the run, every event that has happened by then is reported, with the same time and state, whatever
///   the order of declaration: several terminal ones at one instant are one set.
/// - A run that continues from an event, with the state given by it or with velocities changed by an impact, reports what
///   has not been reported, and nothing twice: the sign of each function says whether it is past its crossing. Only where both
///   directions count the sign does not tell a return from an arrival. There the first crossing within 64 roundings of the time
///   at the start is taken for a return and not reported, and what would cross so soon after the end of a run is reported with it.
/// - The function counts as zero where it is so after rounding to `f64`; times keep the precision of the real.
/// - A run ends with [`Cause::EventFunction`](crate::Cause::EventFunction) at the end of the first step, or at the start, at which the
///   function is NaN, unless a terminal event ends it in that step. Crossings before are reported.
///
/// ```
/// use guen_runtime::steppers::{Direction, Event};
///
/// let height = |_t: f64, x: &[f64; 2]| x[0];
/// let impact = Event::new(&height).direction(Direction::Falling).terminal().within(1e-9);
/// assert!(impact.is_terminal());
/// ```
#[derive(Clone, Copy)]
pub struct Event<'a, R, const N: usize> {
    function: &'a dyn Fn(R, &[R; N]) -> R,
    direction: Direction,
    terminal: bool,
    tolerance: f64,
    checks: u32,
}

impl<R: core::fmt::Debug, const N: usize> core::fmt::Debug for Event<'_, R, N> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Event")
            .field("direction", &self.direction)
            .field("terminal", &self.terminal)
            .field("tolerance", &self.tolerance)
            .field("checks", &self.checks)
            .finish_non_exhaustive()
    }
}

/// An event that happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence<R, const N: usize> {
    /// The position of the event among those that were asked for.
    pub index: usize,
    /// The time, at most the tolerance past the crossing.
    pub time: R,
    /// The state at that time.
    pub state: [R; N],
    /// Whether the function rises through zero, in the order in which the run goes.
    pub rising: bool,
}

impl<'a, R: Ordered, const N: usize> Event<'a, R, N> {
    /// The event that a function of time and state crosses zero in either direction, located to rounding, after which
    /// the run goes on.
    pub fn new(function: &'a dyn Fn(R, &[R; N]) -> R) -> Self {
        Self { function, direction: Direction::Any, terminal: false, tolerance: 0.0, checks: 1 }
    }

    /// Reports crossings in this direction only.
    #[must_use]
    pub fn direction(self, direction: Direction) -> Self {
        Self { direction, ..self }
    }

    /// Ends the run at the event.
    #[must_use]
    pub fn terminal(self) -> Self {
        Self { terminal: true, ..self }
    }

    /// Locates the event to this duration only. Below four roundings of the time it is those, and for terminal events
    /// in any case, because the run goes on from there.
    #[must_use]
    pub fn within(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Evaluates the function at the ends of this many equal parts of every step, on the dense output: crossings that
    /// lie closer together than a step are seen, at that price. Zero counts as one.
    #[must_use]
    pub fn with_checks(self, parts: u32) -> Self {
        Self { checks: parts.max(1), ..self }
    }
}

impl<R: Real, const N: usize> Event<'_, R, N> {
    /// Whether the event ends the run.
    pub fn is_terminal(&self) -> bool {
        self.terminal
    }

    pub(in crate::steppers) fn is_valid(&self) -> bool {
        self.tolerance >= 0.0 && self.tolerance.is_finite()
    }

    /// Returns the number of parts of a step in which it is checked.
    pub(in crate::steppers) fn parts(&self) -> u32 {
        self.checks
    }

    /// Whether crossings in either direction count.
    pub(in crate::steppers) fn is_for_both(&self) -> bool {
        self.direction == Direction::Any
    }

    /// Whether a crossing in this direction counts.
    pub(in crate::steppers) fn wants(&self, rising: bool) -> bool {
        match self.direction {
            Direction::Any => true,
            Direction::Rising => rising,
            Direction::Falling => !rising,
        }
    }

    /// Whether a crossing, the first of a run, may be the way back of a function that the run before has left past its
    /// crossing. In one direction it is known: what comes back goes in the other.
    pub(in crate::steppers) fn may_return(&self, time: R, origin: R) -> bool {
        self.is_for_both() && (time - origin).to_f64().abs() <= self.returns_within(time)
    }

    /// Returns the longest time of the way back: the way there took four roundings at most, and the way back is no
    /// faster than a sixteenth of it.
    pub(in crate::steppers) fn returns_within(&self, t: R) -> f64 {
        16.0 * roundings(t)
    }

    pub(in crate::steppers) fn value(&self, t: R, x: &[R; N]) -> f64 {
        (self.function)(t, x).to_f64()
    }

    /// The duration to which a root near this time is found. Of terminal events half of what is promised, since overlapping
    /// ones are reported at the end of the last.
    pub(in crate::steppers) fn resolution(&self, t: R) -> f64 {
        if self.terminal { 0.5 * roundings(t) } else { self.tolerance.max(roundings(t)) }
    }
}

/// Four roundings of a time.
fn roundings<R: Real>(t: R) -> f64 {
    4.0 * R::epsilon().to_f64() * t.to_f64().abs()
}
