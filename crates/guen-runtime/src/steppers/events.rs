//! Events: functions of the state that cross zero during a run, and how the crossing is found.

use crate::real::{Ordered, Real};

/// Which crossings of zero count.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// From below zero to above, in the order in which the run goes.
    Rising,
    /// From above zero to below, in the order in which the run goes.
    Falling,
    /// Either.
    Any,
}

/// A function of the state whose crossing of zero is an event: an impact, a loss of contact, a switching surface.
///
/// - A crossing is seen as a change of sign between the ends of a step, or between the ends of its parts where
///   [`with_checks`](Event::with_checks) asks for some. Two crossings between two looks, such as a short contact or a
///   function that only touches zero, are not seen. A zero at the very end of a step counts as a crossing.
/// - It is located on the method's dense output by bisection and regula falsi, until the bracket is no longer than the
///   tolerance, and reported at the end of the bracket that is past the crossing. The tolerance bounds the error of the
///   root finder; the dense output adds its own (see [`Integration`](super::Integration)).
/// - The function counts as zero where it is so after rounding to `f64`; times keep the precision of the real.
/// - Events within sixteen tolerances of the start are not reported, so a run that continues from an event does not
///   find the same one again.
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

    /// The same for crossings in this direction only.
    #[must_use]
    pub fn direction(self, direction: Direction) -> Self {
        Self { direction, ..self }
    }

    /// The same, ending the run.
    #[must_use]
    pub fn terminal(self) -> Self {
        Self { terminal: true, ..self }
    }

    /// The same, located to this duration only. Below four roundings of the time it is those.
    #[must_use]
    pub fn within(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// The same, with the function evaluated at the ends of this many equal parts of every step, on the dense output:
    /// crossings that lie closer together than a step are seen, at that price. Zero counts as one.
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

    pub(super) fn is_valid(&self) -> bool {
        self.tolerance >= 0.0 && self.tolerance.is_finite()
    }

    pub(super) fn needs_dense(&self) -> bool {
        self.checks > 1
    }

    pub(super) fn value(&self, t: R, x: &[R; N]) -> f64 {
        (self.function)(t, x).to_f64()
    }

    /// The duration to which a root near this time is found.
    pub(super) fn resolution(&self, t: R) -> f64 {
        const ROUNDINGS: f64 = 4.0;
        self.tolerance.max(ROUNDINGS * R::epsilon().to_f64() * t.to_f64().abs())
    }
}

/// The sign of a value: zero for NaN, which is no side of anything.
pub(super) fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}

/// A crossing within a step.
#[derive(Clone, Copy)]
pub(super) struct Crossing<R> {
    pub time: R,
    pub rising: bool,
}

/// Follows the sign of one event's function.
#[derive(Clone, Copy, Default)]
pub(super) struct Tracker {
    /// The side on which the function was last; zero on the surface itself.
    side: i8,
}

impl Tracker {
    pub fn new(value: f64) -> Self {
        Self { side: sign(value) }
    }

    /// Whether a step that ends with this value has no change of sign between its ends.
    pub fn stays(self, value: f64) -> bool {
        self.side == 0 || self.side == sign(value) || value.is_nan()
    }

    /// The next crossing of the step from `t0` to `t1` that lies after `from`, where the function has been followed to.
    /// `state` gives the states of the step, `end` is the function's value at its end. The tracker then stands past
    /// the crossing, or at the end of the step.
    pub fn next<R: Real, const N: usize>(
        &mut self,
        event: &Event<'_, R, N>,
        (t0, t1): (R, R),
        from: R,
        end: f64,
        mut state: impl FnMut(R) -> [R; N],
    ) -> Option<Crossing<R>> {
        let span = t1 - t0;
        let done = ((from - t0) / span).to_f64();
        let mut before = from;
        for part in 1..=event.checks {
            let fraction = f64::from(part) / f64::from(event.checks);
            if fraction <= done {
                continue;
            }
            let (after, value) = if part == event.checks {
                (t1, end)
            } else {
                let t = t0 + span * R::from_ratio(part.into(), event.checks.into());
                (t, event.value(t, &state(t)))
            };
            let (old, new) = (self.side, sign(value));
            if value.is_nan() {
                return None;
            }
            self.side = new;
            if old != 0 && new != old {
                let rising = old < 0;
                let wanted = match event.direction {
                    Direction::Any => true,
                    Direction::Rising => rising,
                    Direction::Falling => !rising,
                };
                if wanted {
                    let time =
                        if new == 0 { after } else { root(event, before, after, value, old, &mut state) };
                    return Some(Crossing { time, rising });
                }
            }
            before = after;
        }
        None
    }
}

/// The end past the crossing of a bracket no longer than the event's resolution. The function has the sign `old` at
/// `a`, and the other at `b`, where it is `fb`.
///
/// Regula falsi with the value at an end that stays halved (the Illinois rule; M. Dowell and P. Jarratt, BIT 11
/// (1971) 168-174), and a bisection whenever three steps have not halved the bracket, so that at most four evaluations
/// gain a bit.
fn root<R: Real, const N: usize>(
    event: &Event<'_, R, N>,
    mut a: R,
    mut b: R,
    mut fb: f64,
    old: i8,
    mut state: impl FnMut(R) -> [R; N],
) -> R {
    /// Enough to halve a bracket from one end of the exponents to the other.
    const LIMIT: u32 = 10_000;
    const PATIENCE: u32 = 3;

    let mut fa = event.value(a, &state(a));
    if sign(fa) != old {
        // The side was left before `a`, at a point that counts as the surface: bisect.
        fa = f64::from(old) * fb.abs();
    }
    let mut width = (b - a).to_f64().abs();
    let (mut since, mut last) = (0, 0);
    for _ in 0..LIMIT {
        let present = (b - a).to_f64().abs();
        let resolution = event.resolution(a).max(event.resolution(b));
        if present <= resolution {
            break;
        }
        if present <= width / 2.0 {
            (width, since) = (present, 0);
        }
        let mut part = if since >= PATIENCE { 0.5 } else { fa / (fa - fb) };
        if since >= PATIENCE {
            (width, since) = (present, 0);
        }
        // A probe nearer to an end than the resolution could not close the bracket from the other side.
        let margin = (0.5 * resolution / present).min(0.5);
        part = if part.is_nan() { 0.5 } else { part.max(margin).min(1.0 - margin) };
        since += 1;
        let middle = a + (b - a) * R::from_f64(part);
        if middle == a || middle == b {
            break;
        }
        let value = event.value(middle, &state(middle));
        if value == 0.0 {
            return middle;
        }
        let moved = sign(value);
        if moved == old {
            (a, fa) = (middle, value);
            if last == moved {
                fb /= 2.0;
            }
        } else {
            (b, fb) = (middle, value);
            if last == moved {
                fa /= 2.0;
            }
        }
        last = moved;
    }
    b
}
