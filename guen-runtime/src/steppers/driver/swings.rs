//! Switching functions that swing within a step: the motion may be simple, and take long steps, while they go back and forth.
//!
//! They are looked at along the cubic through the states and rates at the ends of the step, between whose looks their own cubics are to
//! agree with them.

use crate::numbers::real::Real;
use crate::steppers::driver::run::Checkpoint;
use crate::system::{MAX_SWITCHES, System};

/// The places of the first looks, as parts of the step: at no equal distances, so that a swing seldom has the same phase at all of them.
const PLACES: [f64; 2] = [0.3125, 0.71875];
/// The most looks within a step, and the number of times that a part between the first ones is halved.
const MOST_LOOKS: u32 = 1024;
const HALVINGS: u32 = 16;
/// The largest error of a cubic between looks, relative to the least of the values: with more, a zero may be hidden.
const UNSEEN: f64 = 0.25;
/// The error of a cubic that is ignored, relative to the largest of the values.
const NEGLIGIBLE: f64 = 1e-6;
/// The part of a step over which functions are differenced: so long that neither the roundings of values nor those of the time count.
pub(super) fn difference<R: Real>(time: R, step: R) -> f64 {
    const LEAST: f64 = 1.0 / 1_048_576.0;
    const MOST: f64 = 1.0 / 16.0;
    let epsilon = R::epsilon().to_f64();
    let of_time = 64.0 * epsilon * (time.to_f64() / step.to_f64()).abs();
    LEAST.max(libm::pow(epsilon, 0.4)).max(of_time).min(MOST)
}

/// The switching functions at one state.
#[derive(Clone, Copy)]
pub(super) struct Values {
    values: [f64; MAX_SWITCHES],
    count: usize,
}

impl Values {
    /// The functions of a system; those beyond [`MAX_SWITCHES`] are left out.
    pub(super) fn of<R: Real, S: System<R, N> + ?Sized, const N: usize>(
        system: &S,
        place: &Checkpoint<R, N>,
    ) -> Self {
        let mut written = [R::zero(); MAX_SWITCHES];
        let count = system.switches(place.time, &place.state, &mut written).min(MAX_SWITCHES);
        Self { values: written.map(Real::to_f64), count }
    }

    /// The function of an index. Without bounds to check the loops of methods cannot panic.
    pub(super) fn at(&self, k: usize) -> f64 {
        self.values.get(k).copied().unwrap_or(0.0)
    }

    /// The values times a number.
    pub(super) fn times(mut self, factor: f64) -> Self {
        self.values.iter_mut().for_each(|value| *value *= factor);
        self
    }

    /// The number of functions.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Something of each value.
    pub(super) fn map<T>(&self, of: impl FnMut(f64) -> T) -> [T; MAX_SWITCHES] {
        self.values.map(of)
    }

    /// Changes each value with that of others.
    pub(super) fn change(&mut self, others: &Self, changed: impl Fn(f64, f64) -> f64) {
        for (value, other) in self.values.iter_mut().zip(&others.values).take(self.count) {
            *value = changed(*value, *other);
        }
    }

    /// Whether there are any.
    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// The ends of a step, with the rates there.
pub(super) struct Ends<'a, R, const N: usize> {
    pub from: (&'a Checkpoint<R, N>, [R; N]),
    pub to: (&'a Checkpoint<R, N>, [R; N]),
}

/// The functions at a part of the step, with their changes over a whole step at their rates there.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub part: f64,
    pub values: Values,
    pub slopes: Values,
}

/// A search within a step.
pub(super) struct Swings<'a, R, S: ?Sized, const N: usize> {
    system: &'a S,
    ends: &'a Ends<'a, R, N>,
    /// The side on which each function was last.
    sides: &'a [i8],
    left: u32,
    /// The part of the step over which functions are differenced.
    difference: f64,
}

impl<'a, R: Real, S: System<R, N> + ?Sized, const N: usize> Swings<'a, R, S, N> {
    pub(super) fn new(system: &'a S, ends: &'a Ends<'a, R, N>, sides: &'a [i8]) -> Self {
        let ((from, _), (to, _)) = (&ends.from, &ends.to);
        let difference = difference(to.time, to.time - from.time);
        Self { system, ends, sides, left: MOST_LOOKS, difference }
    }

    /// The first part of the step at which a function is past zero, or next to it, of which the ends show nothing.
    pub(super) fn first(&mut self, begin: &Look, end: &Look) -> Option<f64> {
        let [first, second] = PLACES.map(|part| self.look(part));
        if self.is_resolved(begin, &first, end) && self.is_resolved(begin, &second, end) {
            return self.near(begin, end);
        }
        let mut before = begin;
        for after in [&first, &second, end] {
            let found = self.between(before, after, HALVINGS);
            if found.is_some() {
                return found;
            }
            before = after;
        }
        None
    }

    /// The first such part between two looks, in halves as long as a function swings between them.
    fn between(&mut self, before: &Look, after: &Look, halvings: u32) -> Option<f64> {
        if halvings == 0 || self.left == 0 {
            return self.near(before, after);
        }
        self.left -= 1;
        let middle = self.look(before.part + 0.5 * (after.part - before.part));
        if self.is_resolved(before, &middle, after) {
            return self.near(before, &middle).or_else(|| self.near(&middle, after));
        }
        self.between(before, &middle, halvings - 1).or_else(|| self.between(&middle, after, halvings - 1))
    }

    /// The functions at a part of the step.
    fn look(&self, part: f64) -> Look {
        let difference = self.difference;
        let [values, mut slopes] = [part, part + difference].map(|part| self.values(part));
        slopes.change(&values, |slope, value| (slope - value) / difference);
        Look { part, values, slopes }
    }

    fn values(&self, part: f64) -> Values {
        let Ends { from: (from, leaves), to: (to, arrives) } = self.ends;
        let step = to.time - from.time;
        let rest = 1.0 - part;
        let of_begin = R::from_f64(rest * rest * (1.0 + 2.0 * part));
        let of_end = R::from_f64(part * part * (3.0 - 2.0 * part));
        let of_leaving = step * R::from_f64(part * rest * rest);
        let of_arriving = step * R::from_f64(part * part * rest);
        let state = core::array::from_fn(|i| {
            of_begin * from.state[i] + of_end * to.state[i] + of_leaving * leaves[i]
                - of_arriving * arrives[i]
        });
        Values::of(self.system, &Checkpoint { time: from.time + step * R::from_f64(part), state, ..**from })
    }

    /// Whether the cubics of all functions through two looks agree with the values and rates at one between them, or are off by too little to
    /// hide a zero.
    fn is_resolved(&self, before: &Look, middle: &Look, after: &Look) -> bool {
        let negligible = NEGLIGIBLE.max(self.difference);
        let length = after.part - before.part;
        let s = (middle.part - before.part) / length;
        let r = 1.0 - s;
        (0..before.values.count()).all(|k| {
            let [a, m, b] = [before, middle, after].map(|look| look.values.at(k));
            let [leaves, passes, arrives] = [before, middle, after].map(|look| length * look.slopes.at(k));
            let value =
                r * r * ((1.0 + 2.0 * s) * a + s * leaves) + s * s * ((3.0 - 2.0 * s) * b - r * arrives);
            let change = 6.0 * s * r * (b - a) + r * (1.0 - 3.0 * s) * leaves + s * (3.0 * s - 2.0) * arrives;
            let missed = (m - value).abs().max((passes - change).abs() / 8.0);
            let least = a.abs().min(m.abs()).min(b.abs());
            let largest = a.abs().max(m.abs()).max(b.abs());
            !(missed > UNSEEN * least && missed > negligible * largest)
        })
    }

    /// The part of the step at which a function is past zero at the second of two looks, or where its cubic between them is least, and less
    /// than half of what it is at either.
    fn near(&self, before: &Look, after: &Look) -> Option<f64> {
        let length = after.part - before.part;
        let mut soonest: Option<f64> = None;
        let mut found = |part: f64| soonest = Some(soonest.map_or(part, |first| first.min(part)));
        for (k, side) in self.sides.iter().enumerate().take(before.values.count()) {
            let side = f64::from(*side);
            let [a, b] = [before, after].map(|look| side * look.values.at(k));
            let [falls, rises] = [before, after].map(|look| length * side * look.slopes.at(k));
            if b < 0.0 && after.part < 1.0 {
                found(after.part);
            } else if a > 0.0 && b > 0.0 && falls < 0.0 && rises > 0.0 {
                let part = least_of_cubic([a, b], [falls, rises]);
                let rest = 1.0 - part;
                // The cubic in Hermite's form.
                let least = rest * rest * (a * (1.0 + 2.0 * part) + part * falls)
                    + part * part * (b * (3.0 - 2.0 * part) - rest * rises);
                if least < 0.5 * a.min(b) {
                    found(before.part + length * part);
                }
            }
        }
        soonest
    }
}

/// The part of an interval at which a cubic is least that falls at its beginning and rises at its end.
fn least_of_cubic([a, b]: [f64; 2], [falls, rises]: [f64; 2]) -> f64 {
    // The derivative `falls + 2 q s + 3 p s^2` has one zero in between, by the form that loses no digits.
    let q = 3.0 * (b - a) - 2.0 * falls - rises;
    let p = falls + rises - 2.0 * (b - a);
    let root = libm::sqrt((q * q - 3.0 * p * falls).max(0.0));
    let part = if q >= 0.0 { -falls / (q + root) } else { (root - q) / (3.0 * p) };
    if part > 0.0 && part < 1.0 { part } else { 0.5 }
}
