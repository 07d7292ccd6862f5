//! Events of a simulation: functions of time and named state.

use alloc::boxed::Box;

use crate::numbers::real::Ordered;
use crate::steppers::{Direction, Event};

/// A function of time and state.
type Function<'a, R, X> = Box<dyn Fn(R, &X) -> R + 'a>;

/// A function of a system's own states whose crossing of zero is an event of a [`Simulation`](crate::Simulation). How a
/// crossing is seen and located is said at [`Event`].
pub struct Trigger<'a, R, X> {
    function: Function<'a, R, X>,
    direction: Direction,
    terminal: bool,
    tolerance: f64,
    checks: u32,
}

impl<R, X> core::fmt::Debug for Trigger<'_, R, X> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Trigger")
            .field("direction", &self.direction)
            .field("terminal", &self.terminal)
            .finish_non_exhaustive()
    }
}

impl<'a, R: Ordered, X> Trigger<'a, R, X> {
    /// The event that the function crosses zero in either direction, after which the run goes on.
    pub fn new(function: impl Fn(R, &X) -> R + 'a) -> Self {
        let function = Box::new(function);
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

    /// Locates the event to this duration only, as [`Event::within`] does.
    #[must_use]
    pub fn within(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Evaluates the function at the ends of so many equal parts of every step, as [`Event::with_checks`] does.
    #[must_use]
    pub fn with_checks(self, parts: u32) -> Self {
        Self { checks: parts, ..self }
    }

    /// The function of a state as an array.
    pub(super) fn of_array<const N: usize>(&self) -> Function<'_, R, [R; N]>
    where
        X: From<[R; N]>,
    {
        Box::new(|t, x| (self.function)(t, &X::from(*x)))
    }

    /// The event of the function of an array.
    pub(super) fn event<'f, const N: usize>(
        &self,
        function: &'f (dyn Fn(R, &[R; N]) -> R + 'f),
    ) -> Event<'f, R, N> {
        let event = Event::new(function).direction(self.direction).with_checks(self.checks);
        let event = if self.terminal { event.terminal() } else { event };
        event.within(self.tolerance)
    }
}
