//! Guards: what is watched while a run goes on, besides that every state is finite.
//!
//! A look costs about as much as one or two right-hand sides. It is taken every `k` steps, with `k` such that about
//! [`EVALUATIONS_BETWEEN_LOOKS`] right-hand sides lie between two of them; where a look finds a fault, the run goes
//! back to the last look that did not, so that what it returns was seen to be in order.

use super::course::Reached;
use crate::error::{Cause, IntegrationError, Setting};
use crate::real::Real;
use crate::system::System;

/// With a look at one to two right-hand sides, guards cost about one percent.
const EVALUATIONS_BETWEEN_LOOKS: u32 = 160;
/// A run that ends before its first look is looked at if it has made so many, so that guards cost at most about three
/// percent of it.
const EVALUATIONS_WORTH_A_LOOK: u32 = 100;
/// As many functions that must not vanish are watched; further ones are not.
const EDGES: usize = 16;

/// What a run must not violate. A stepper watches these by default, of whatever the system tells in
/// [`System::vitals`] and [`System::edges`].
///
/// Every accepted state is tested to be finite. Every [`every`](Guard::every) steps, at the end of the run and before an
/// error is returned, the guard looks at the rest. Where it finds a fault, the run ends with the cause, and with the
/// time and state of the last look that found none; an observer has been shown the steps since then. A run of less than
/// about a hundred right-hand sides is tested for finite states only, unless `every` is set.
///
/// With lanes, which have no order among them, the first lane alone is looked at, except that all must be finite.
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
    /// the looks until now; for systems that keep their energy. By default 0.01: a run that is off by more is rarely one
    /// that somebody wants, whatever its accuracy was meant to be.
    pub energy: f64,
    /// The largest left side of a constraint on positions, in its own unit. By default without limit, since units are
    /// the declaration's.
    pub residual: f64,
    /// How far functions that are carried as states may be from what they stand for: the largest of `|w - f|/(1 + |f|)`
    /// and of what is left of `sin^2 + cos^2 - 1` and the like. By default 0.01, as for the energy.
    pub carried: f64,
    /// The distance to the edge of the chart at which to stop: each function that must not vanish, relative to its
    /// largest value at the start and at the looks before. By default `1e-8`, where a term with its square in the
    /// denominator has no digits left in `f64`. A change of its sign always ends the run.
    pub edge: f64,
    /// Look every so many steps, at least every one; chosen by the method's cost if absent.
    pub every: Option<u32>,
}

impl Guard {
    /// Watches nothing but that every state is finite.
    pub const FINITE: Self = Self {
        energy: f64::INFINITY,
        residual: f64::INFINITY,
        carried: f64::INFINITY,
        edge: 0.0,
        every: Some(u32::MAX),
    };

    fn is_valid(&self) -> bool {
        [self.energy, self.residual, self.carried, self.edge].iter().all(|limit| *limit >= 0.0)
    }
}

impl Default for Guard {
    fn default() -> Self {
        Self { energy: 1e-2, residual: f64::INFINITY, carried: 1e-2, edge: 1e-8, every: None }
    }
}

/// A guard at work.
pub(super) struct Watch<R, const N: usize> {
    guard: Guard,
    every: u32,
    until_look: u32,
    /// Whether a run that ends before its first look is long enough for one.
    worth: u32,
    /// Where the last look found everything in order.
    good: Reached<R, N>,
    /// What the first look learned from the initial state.
    start: Option<Start<R>>,
}

struct Start<R> {
    energy: Option<R>,
    scale: f64,
    edges: usize,
    /// With their sign at the last look.
    largest: [f64; EDGES],
}

impl<R: Real, const N: usize> Watch<R, N> {
    pub fn new(guard: Guard, evaluations: u32, start: &Reached<R, N>) -> Result<Self, Cause> {
        if !guard.is_valid() {
            return Err(Cause::Setting(Setting::Guard));
        }
        let every = guard.every.unwrap_or(EVALUATIONS_BETWEEN_LOOKS / evaluations.max(1)).max(1);
        let worth = if guard.every.is_some() { 1 } else { EVALUATIONS_WORTH_A_LOOK / evaluations.max(1) };
        Ok(Self { guard, every, until_look: every, worth, good: *start, start: None })
    }

    /// Counts a step, and looks if it is time to.
    #[inline]
    pub fn step<S>(&mut self, system: &S, reached: &Reached<R, N>) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        self.until_look -= 1;
        if self.until_look > 0 {
            return Ok(());
        }
        self.until_look = self.every;
        self.look(system, reached)
    }

    /// Looks at the end of a run, unless it was just looked at or the run was short.
    pub fn finish<S>(&mut self, system: &S, reached: &Reached<R, N>) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let steps = self.every - self.until_look;
        let due = if self.start.is_some() { steps > 0 } else { steps >= self.worth.max(1) };
        if due && self.every != u32::MAX { self.look(system, reached) } else { Ok(()) }
    }

    /// The error of a run that cannot go on from where it stands: for the cause given, unless the steps since the last
    /// look went wrong before.
    pub fn stopped<S>(&mut self, system: &S, reached: &Reached<R, N>, cause: Cause) -> IntegrationError<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        if reached.time == self.good.time {
            return reached.failed(cause);
        }
        match self.look(system, reached) {
            Ok(()) => reached.failed(cause),
            Err(earlier) => self.good(reached).failed(earlier),
        }
    }

    /// The last time and state that were found in order, with the work done since then counted.
    pub fn good(&self, reached: &Reached<R, N>) -> Reached<R, N> {
        Reached { statistics: reached.statistics, ..self.good }
    }

    /// Looks at a state.
    #[inline(never)]
    pub fn look<S>(&mut self, system: &S, reached: &Reached<R, N>) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let Self { guard, good, start, .. } = self;
        let start = start.get_or_insert_with(|| Start::new(system, good));
        let found = reached.time.to_f64();
        let vitals = system.vitals(reached.time, &reached.state);
        if let (Some(energy), Some(before)) = (vitals.energy, start.energy) {
            // With the scale of this state, for the start may have none: at rest, where the potential is zero. A state
            // that blew up is no larger than its own energy, so that its change is about one.
            let scale = start.scale.max(vitals.scale.to_f64());
            let change = relative((energy - before).to_f64().abs(), scale);
            if exceeds(change, guard.energy) {
                return Err(Cause::Energy { found, change, limit: guard.energy });
            }
            start.scale = scale;
        }
        let residual = vitals.residual.to_f64();
        if exceeds(residual, guard.residual) {
            return Err(Cause::Residual { found, residual, limit: guard.residual });
        }
        let drift = vitals.carried.to_f64();
        if exceeds(drift, guard.carried) {
            return Err(Cause::Carried { found, drift, limit: guard.carried });
        }
        start.edges(system, reached, guard.edge)?;
        *good = *reached;
        Ok(())
    }
}

impl<R: Real> Start<R> {
    fn new<S, const N: usize>(system: &S, reached: &Reached<R, N>) -> Self
    where
        S: System<R, N> + ?Sized,
    {
        let vitals = system.vitals(reached.time, &reached.state);
        let (edges, values) = values(system, reached);
        Self { energy: vitals.energy, scale: vitals.scale.to_f64(), edges, largest: values }
    }

    fn edges<S, const N: usize>(
        &mut self,
        system: &S,
        reached: &Reached<R, N>,
        limit: f64,
    ) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        if self.edges == 0 {
            return Ok(());
        }
        let (_, values) = values(system, reached);
        for (function, (largest, value)) in self.largest.iter_mut().zip(values).take(self.edges).enumerate() {
            let distance = if *largest == value { 1.0 } else { value / *largest };
            // A function that starts at zero has no sign to change and no size to compare with.
            if *largest != 0.0 && (distance <= limit || distance.is_nan()) {
                let found = reached.time.to_f64();
                return Err(Cause::Edge { found, function, distance, limit });
            }
            if value.abs() > largest.abs() {
                *largest = value;
            }
        }
        Ok(())
    }
}

fn values<R: Real, S, const N: usize>(system: &S, reached: &Reached<R, N>) -> (usize, [f64; EDGES])
where
    S: System<R, N> + ?Sized,
{
    let mut values = [R::zero(); EDGES];
    let edges = system.edges(reached.time, &reached.state, &mut values);
    (edges.min(EDGES), values.map(R::to_f64))
}

/// A change in units of a scale; what does not change at all is no change even of nothing.
fn relative(change: f64, scale: f64) -> f64 {
    if change == 0.0 { 0.0 } else { change / scale }
}

/// Whether a value is above its limit, or none at all.
fn exceeds(value: f64, limit: f64) -> bool {
    value > limit || value.is_nan()
}
