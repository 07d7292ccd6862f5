//! Switches: the functions at whose zeros a right-hand side changes its formula, and the search for the end of a step at one of them.
//!
//! Nothing is read off a polynomial: one over a step with a switch in it is right on neither side. Steps are made again from where the
//! last one ended, each to a time nearer to the crossing. Those that end in front of it are steps as others; those that end past it
//! have the wrong formula for the part behind the crossing, which becomes as short as a rounding of the time.

use crate::numbers::real::Real;
use crate::steppers::driver::crossing::sign;
use crate::steppers::driver::run::Checkpoint;
use crate::steppers::driver::swings::{Ends, Look, Swings, Values, difference};
use crate::system::{MAX_SWITCHES, System};

/// The time of a state past a crossing, and the functions there.
#[derive(Clone, Copy)]
struct Past<R> {
    time: R,
    values: Values,
}

/// The search for crossings of a run.
pub(super) struct Switches<R> {
    /// The side on which each function was last; zero before it was on one.
    sides: [i8; MAX_SWITCHES],
    /// The functions at the end of the last step.
    here: Values,
    past: Option<Past<R>>,
    /// The number of times in turn that the same end of the bracket has moved: in front of the crossing above zero, past it below.
    moved: i32,
    /// The longest step so far.
    longest: f64,
    /// The rates of the functions where a step ended last, with its time.
    slopes: Option<(R, Values)>,
}

/// The kinds of steps, by the sides on which they begin and end.
pub(super) enum Step {
    /// On one side of everything.
    OneSided,
    /// Just past a crossing.
    Located {
        /// The function that crosses.
        switch: usize,
    },
    /// Over a crossing that is still to be located.
    Over,
}

impl<R: Real> Switches<R> {
    /// Begins at the start of a run.
    pub(super) fn new(here: Values) -> Self {
        let sides = here.map(sign);
        Self { sides, here, past: None, moved: 0, longest: 0.0, slopes: None }
    }

    /// The side on which a function was last.
    fn side(&self, k: usize) -> i8 {
        self.sides.get(k).copied().unwrap_or(0)
    }

    /// The time to go to: in a bracket the place where the first function is expected to cross, by regula falsi with the Illinois
    /// rule.
    pub(super) fn goal<const N: usize>(&self, from: &Checkpoint<R, N>, target: R) -> R {
        /// The number of times that one end moves in turn after which the bracket is halved.
        const PATIENCE: i32 = 3;
        let Some(past) = &self.past else { return target };
        let length = past.time - from.time;
        let (ahead, behind) = (self.moved.max(0), (-self.moved).max(0));
        let part = match self.moved.abs() < PATIENCE {
            true => self.crossed(&past.values).map_or(0.5, |k| {
                let a = self.here.at(k).abs() * libm::exp2(f64::from(-(behind - 1).max(0)));
                let b = past.values.at(k).abs() * libm::exp2(f64::from(-(ahead - 1).max(0)));
                if a + b > 0.0 { a / (a + b) } else { 0.5 }
            }),
            false => 0.5,
        };
        let middle = from.time + length * R::from_f64(part);
        // A probe in the last roundings before an end would not close the bracket from the other side, and between two such ends there is none.
        let shortest = 0.5 * resolution(past.time, self.longest);
        if length.to_f64().abs() <= 2.0 * shortest {
            return past.time;
        }
        let near = R::from_f64(shortest);
        let near = if length.to_f64() < 0.0 { -near } else { near };
        let inside = |t: R| (t - from.time - near).to_f64() * length.to_f64() > 0.0;
        let outside = |t: R| (past.time - near - t).to_f64() * length.to_f64() <= 0.0;
        match () {
            () if !inside(middle) => from.time + near,
            () if outside(middle) => past.time - near,
            () => middle,
        }
    }

    /// The crossed function that is expected to have crossed first.
    fn crossed(&self, values: &Values) -> Option<usize> {
        let mut found: Option<(usize, f64)> = None;
        for k in 0..values.count() {
            let (a, b) = (self.here.at(k), values.at(k));
            if self.side(k) * sign(b) < 0 {
                let part = a.abs() / (a.abs() + b.abs());
                if found.is_none_or(|(_, first)| part < first) {
                    found = Some((k, part));
                }
            }
        }
        found.map(|(k, _)| k)
    }

    /// The time within a step at which a function comes near to zero, or goes through it and back, although it has the same sign at the ends.
    /// The evaluations of the search are not in the statistics.
    pub(super) fn nearest<S: System<R, N> + ?Sized, const N: usize>(
        &mut self,
        system: &S,
        ends: &Ends<'_, R, N>,
        values: &Values,
    ) -> Option<R> {
        let Ends { from: (from, leaves), to: (to, arrives) } = ends;
        let step = to.time - from.time;
        let length = step.to_f64().abs();
        let before = match self.slopes {
            Some((time, rates)) if time == from.time => rates.times(length),
            _ => slopes(system, (from, leaves), &self.here, step),
        };
        let after = slopes(system, (to, arrives), values, step);
        self.slopes = Some((to.time, after.times(1.0 / length)));
        let begin = Look { part: 0.0, values: self.here, slopes: before };
        let end = Look { part: 1.0, values: *values, slopes: after };
        let part = Swings::new(system, ends, &self.sides).first(&begin, &end)?;
        let inside = part * length > resolution(to.time, self.longest)
            && (1.0 - part) * length > resolution(to.time, self.longest);
        inside.then(|| from.time + step * R::from_f64(part))
    }

    /// Judges a step, which has ended with these values. With `anyway` a crossing counts as located however long the step was.
    pub(super) fn judge<const N: usize>(
        &mut self,
        from: &Checkpoint<R, N>,
        to: &Checkpoint<R, N>,
        values: Values,
        anyway: bool,
    ) -> Step {
        let length = to.since(from).to_f64().abs();
        self.longest = self.longest.max(length);
        let Some(switch) = self.crossed(&values) else {
            let reaches =
                |past: Past<R>| (to.time - past.time).to_f64() * (past.time - from.time).to_f64() >= 0.0;
            if self.past.is_some_and(reaches) {
                self.past = None;
            }
            self.moved = if self.past.is_some() { self.moved.max(0) + 1 } else { 0 };
            self.enter(values);
            return Step::OneSided;
        };
        if length > resolution(to.time, self.longest) && !anyway {
            self.past = Some(Past { time: to.time, values });
            self.moved = self.moved.min(0) - 1;
            return Step::Over;
        }
        (self.past, self.moved) = (None, 0);
        self.enter(values);
        Step::Located { switch }
    }

    /// The time past the crossing that is being located.
    pub(super) fn past(&self) -> Option<R> {
        self.past.map(|past| past.time)
    }

    /// Whether a step has ended past a crossing.
    pub(super) fn crosses(&self, values: &Values) -> bool {
        self.crossed(values).is_some()
    }

    /// The function that leads a motion back to its zero, of those that it stands on or has just crossed: on the side where it
    /// is, the rates point to the other. `None` if it can go on.
    pub(super) fn slides<S: System<R, N> + ?Sized, const N: usize>(
        &self,
        system: &S,
        place: &Checkpoint<R, N>,
        backwards: bool,
        crossed: Option<usize>,
    ) -> Option<usize> {
        /// The distance of the place that is looked at, in longest steps.
        const AHEAD: f64 = 1e-6;
        let distance = if self.longest > 0.0 { AHEAD * self.longest } else { AHEAD };
        let ahead = R::from_f64(if backwards { -distance } else { distance });
        let next = |place: &Checkpoint<R, N>| {
            let rates = system.rhs(place.time, &place.state);
            let state = core::array::from_fn(|i| place.state[i] + ahead * rates[i]);
            Checkpoint { time: place.time + ahead, state, ..*place }
        };
        let first = next(place);
        let values = Values::of(system, &first);
        match crossed {
            Some(k) => {
                let side = self.side(k);
                let returns = side * sign(values.at(k)) < 0;
                // From the other side it has to be led back as well: a function of time alone may only be uncertain.
                let comes = || Values::of(system, &next(&first)).at(k) - values.at(k);
                (returns && comes() * f64::from(side) > 0.0).then_some(k)
            }
            None => {
                let second = Values::of(system, &next(&first));
                let leads_back = |k: &usize| {
                    let side = sign(values.at(*k));
                    self.side(*k) == 0 && side != 0 && (second.at(*k) - values.at(*k)) * f64::from(side) < 0.0
                };
                (0..values.count()).find(leads_back)
            }
        }
    }

    /// Whether some function vanishes at the start.
    pub(super) fn begins_on_one(&self) -> bool {
        self.sides.iter().take(self.here.count()).any(|side| *side == 0)
    }

    /// Takes the values at the end of a step that counts. Whoever stands on zero stays on the side from which it came.
    fn enter(&mut self, values: Values) {
        for k in 0..values.count() {
            let side = sign(values.at(k));
            if let Some(own) = self.sides.get_mut(k).filter(|_| side != 0) {
                *own = side;
            }
        }
        self.here = values;
    }

    /// Counts the functions that a step has carried to their other side, and takes its end as it is.
    pub(super) fn pass(&mut self, values: Values) -> u64 {
        let crossed = (0..values.count()).filter(|k| self.side(*k) * sign(values.at(*k)) < 0).count();
        self.enter(values);
        crossed as u64
    }
}

/// The changes of the functions over a step, at the rates that they have at a place.
fn slopes<R: Real, S: System<R, N> + ?Sized, const N: usize>(
    system: &S,
    (place, rates): (&Checkpoint<R, N>, &[R; N]),
    here: &Values,
    step: R,
) -> Values {
    let part = difference(place.time, step);
    let ahead = step * R::from_f64(part);
    let state = core::array::from_fn(|i| place.state[i] + ahead * rates[i]);
    let mut slopes = Values::of(system, &Checkpoint { time: place.time + ahead, state, ..*place });
    slopes.change(here, |slope, value| (slope - value) / part);
    slopes
}

/// The duration to which a crossing is located: four roundings of the time, or of the longest step.
fn resolution<R: Real>(t: R, longest: f64) -> f64 {
    4.0 * R::epsilon().to_f64() * t.to_f64().abs().max(longest)
}
