//! Finds the crossings of an event within a step: by checks of the function's sign, then by a root finder.

use crate::numbers::real::Real;
use crate::steppers::driver::events::Event;
use crate::steppers::root::{Bracket, narrow};

/// The sign of a value: zero for NaN, which is no side of anything.
pub(in crate::steppers) fn sign(value: f64) -> i8 {
    i8::from(value > 0.0) - i8::from(value < 0.0)
}

/// Whether `a` comes before `b` in a run that goes `backwards` or not.
pub(in crate::steppers) fn earlier<R: Real>(a: R, b: R, backwards: bool) -> bool {
    a != b && ((b - a).to_f64() < 0.0) == backwards
}

/// A crossing within a step.
#[derive(Clone, Copy)]
pub(in crate::steppers) struct Crossing<R> {
    /// The last time at which the function was found before the crossing.
    pub after: R,
    /// The first time at which it was found past it.
    pub time: R,
    pub rising: bool,
}

impl<R> Crossing<R> {
    /// The side on which the function was before.
    pub(crate) fn side(&self) -> i8 {
        if self.rising { -1 } else { 1 }
    }
}

/// The times within a step at which a function is checked, in the order in which the run goes.
#[derive(Clone, Copy, Default)]
pub(in crate::steppers) struct Checks<R> {
    /// The beginning of the step.
    pub start: R,
    /// The end.
    pub end: R,
    /// Whether a run begins with the step near the function's surface. Then its first part is checked after an eighth, a
    /// 64th and so on as well, as far as the digits of a double go: what leaves the surface there may be back long before the
    /// part ends.
    pub close: bool,
}

impl<R: Real> Checks<R> {
    /// Returns the number of checks in so many parts.
    fn count(&self, parts: u32) -> u32 {
        if self.close { parts.saturating_add(FIRST_DIVISIONS) } else { parts }
    }

    /// The time of a check, counted from one.
    fn time(&self, check: u32, parts: u32) -> R {
        let closer = if self.close { FIRST_DIVISIONS } else { 0 };
        let part = check.saturating_sub(closer);
        if part >= parts {
            return self.end;
        }
        let length = (self.end - self.start) * R::from_ratio(part.max(1).into(), parts.max(1).into());
        let shorter = if part == 0 { libm::exp2(-3.0 * f64::from(FIRST_DIVISIONS + 1 - check)) } else { 1.0 };
        self.start + length * R::from_f64(shorter)
    }
}

/// The number of times that the first part of the first step is divided by eight: `8^-17` is a rounding of `f64`.
const FIRST_DIVISIONS: u32 = 17;

/// Follows the sign of one event's function.
#[derive(Clone, Copy, Default)]
pub(in crate::steppers) struct Tracker {
    /// The side on which the function was last; zero on the surface itself.
    side: i8,
    /// Whether it has crossed since the start of the run.
    crossed: bool,
}

impl Tracker {
    pub(crate) fn new(value: f64) -> Self {
        Self { side: sign(value), crossed: false }
    }

    /// Whether a step that ends with this value has no change of sign between its ends.
    pub(crate) fn stays(self, value: f64) -> bool {
        !value.is_nan() && (self.side == 0 || self.side == sign(value))
    }

    pub(crate) fn side(self) -> i8 {
        self.side
    }

    /// Updates the side by a value that is no crossing.
    pub(crate) fn at(self, value: f64) -> Self {
        if value.is_nan() { self } else { Self { side: sign(value), ..self } }
    }

    /// The next crossing of a step that lies after `from`, where the function has been followed to, of a run that began at
    /// `origin`. `value` is the function within the step, NaN where there is no state, and `end` its value at the end. The tracker then stands
    /// past the crossing, or at the end of the step.
    pub(crate) fn next<R: Real, const N: usize>(
        &mut self,
        event: &Event<'_, R, N>,
        checks: Checks<R>,
        (origin, from): (R, R),
        end: f64,
        value: &mut dyn FnMut(R) -> f64,
    ) -> Option<Crossing<R>> {
        let backwards = (checks.end - checks.start).to_f64() < 0.0;
        let mut before = from;
        let count = checks.count(event.parts());
        for check in 1..=count {
            let after = checks.time(check, event.parts());
            if !earlier(before, after, backwards) {
                continue;
            }
            let (mut after, mut found) = (after, if after == checks.end { end } else { value(after) });
            if found.is_nan() {
                // It may cross before it ends.
                let Some(last) = last_number(before, after, value) else { continue };
                (after, found) = last;
            }
            let (old, new) = (self.side, sign(found));
            self.side = new;
            if old != 0 && new != old {
                let rising = old < 0;
                let first = !self.crossed;
                self.crossed = true;
                if event.wants(rising) {
                    let crossing = if new == 0 {
                        Crossing { after, time: after, rising }
                    } else {
                        root(event, (before, after), found, old, value)
                    };
                    let returns = first && event.may_return(crossing.time, origin);
                    if !returns {
                        return Some(crossing);
                    }
                }
            }
            before = after;
        }
        None
    }
}

/// The last time before `after` at which a function is a number, as halves of the time since `before` find it, and its value there.
fn last_number<R: Real>(mut before: R, mut after: R, value: &mut dyn FnMut(R) -> f64) -> Option<(R, f64)> {
    /// Enough for the digits of a double.
    const HALVES: u32 = 64;

    let mut found = None;
    for _ in 0..HALVES {
        let middle = before + (after - before) * R::from_ratio(1, 2);
        if middle == before || middle == after {
            break;
        }
        let here = value(middle);
        if here.is_nan() {
            after = middle;
        } else {
            (before, found) = (middle, Some((middle, here)));
        }
    }
    found
}

/// A bracket no longer than the event's resolution. The function has the sign `old` at `a`, and the other at `b`, where it
/// is `fb`.
fn root<R: Real, const N: usize>(
    event: &Event<'_, R, N>,
    (a, b): (R, R),
    fb: f64,
    old: i8,
    value: &mut dyn FnMut(R) -> f64,
) -> Crossing<R> {
    let side = f64::from(old);
    let at_start = side * value(a);
    // Where the side was left before `a`, at a point that counts as the surface, the first probe halves.
    let high = if at_start > 0.0 { at_start } else { fb.abs() };
    let bracket = Bracket { before: a, after: b };
    let resolution = |t: R| event.resolution(t);
    let found = narrow(bracket, (high, side * fb), &resolution, &mut |t| side * value(t));
    Crossing { after: found.before, time: found.after, rising: old < 0 }
}
