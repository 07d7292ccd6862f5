//! Guards: what is watched while a run goes on, besides that every state is finite.
//!
//! A look costs about as much as two to four right-hand sides. It is taken every `k` steps, with `k` such that about
//! [`EVALUATIONS_BETWEEN_LOOKS`] right-hand sides lie between two of them; where a look finds a fault, the run goes
//! back to the last look that did not, so that what it returns was seen to be in order.

use super::course::Reached;
use super::defect::Defects;
use crate::error::{Cause, IntegrationError, Setting};
use crate::real::Real;
use crate::rounded::Rounded;
use crate::system::System;

/// With a look at two to four right-hand sides, guards cost about two percent.
const EVALUATIONS_BETWEEN_LOOKS: u32 = 160;
/// A run that ends before its first look is looked at if it has made so many, so that guards cost at most a few percent
/// of it.
const EVALUATIONS_WORTH_A_LOOK: u32 = 100;
/// As many functions that must not vanish are watched; further ones are not.
pub(super) const EDGES: usize = 16;

/// What a run must not violate. A stepper watches these by default, of whatever the system tells in
/// [`System::vitals`], [`System::edges`] and [`System::condition`], and explicit methods of low order with a fixed step by
/// evaluating the right-hand side again.
///
/// Every accepted state is tested to be finite. Every [`every`](Guard::every) steps, at the end of the run and before an
/// error is returned, the guard looks at the rest; the first look looks at the start too. Where it finds a fault, the run
/// ends with the cause, and with the time and state of the last look that found none; an observer has been shown the
/// steps since then. A run of less than about a hundred right-hand sides is tested for finite states only, unless
/// `every` is set.
///
/// With lanes as the real, which have no order among them, the first lane alone is looked at, except that all must be
/// finite; [`Rk4::integrate_in_lanes`](super::Rk4::integrate_in_lanes) looks at the energy, the residual and the edges of
/// every lane.
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
    /// The largest left side of a constraint on positions, relative to the size of its terms. By default 0.001: what
    /// is typed in with four digits passes.
    pub residual: f64,
    /// How far functions that are carried as states may be from what they stand for: the largest of `|w - f|/(1 + |f|)`
    /// and of what is left of `sin^2 + cos^2 - 1` and the like. By default 0.01, as for the energy.
    pub carried: f64,
    /// The distance to the edge of the chart at which to stop: what is [`left`](Rounded::left) of each function that
    /// must not vanish, given that every entry of the state is uncertain by a rounding of the largest value that it has
    /// had. By default `1e-8`, where a term with its square in the denominator has no digits left in `f64`; in another
    /// real the limit is multiplied by the root of the ratio of the roundings. A change of sign always ends the run.
    pub edge: f64,
    /// The largest [`condition`](System::condition) of the mass matrix. By default `1e12`, where accelerations have
    /// four digits left in `f64`; in another real the limit is divided by the ratio of the roundings.
    pub condition: f64,
    /// The largest error of [`Euler`](super::Euler) and [`Rk4`](super::Rk4), estimated at every look from one step: what it
    /// differs from a quadrature of the rates over it, relative to the largest value that an entry has had, summed up as
    /// if it stood for all steps since the last look. By default 0.05. Methods of higher order are better than the
    /// estimate, and implicit ones right where it is not, at rates beyond their step; those are not judged by it.
    pub step: f64,
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
        condition: f64::INFINITY,
        step: f64::INFINITY,
        every: Some(u32::MAX),
    };

    fn is_valid(&self) -> bool {
        [self.energy, self.residual, self.carried, self.edge, self.condition, self.step]
            .iter()
            .all(|limit| *limit >= 0.0)
    }

    /// The limits for a real: those given are meant for `f64`.
    fn for_real<R: Real>(self) -> Self {
        let ratio = R::epsilon().to_f64() / f64::EPSILON;
        // Of a real too long for a ratio of its rounding to be one.
        let ratio = if ratio > 0.0 { ratio } else { f64::MIN_POSITIVE };
        Self { edge: self.edge * libm::sqrt(ratio), condition: self.condition / ratio, ..self }
    }
}

impl Default for Guard {
    fn default() -> Self {
        Self {
            energy: 1e-2,
            residual: 1e-3,
            carried: 1e-2,
            edge: 1e-8,
            condition: 1e12,
            step: 0.05,
            every: None,
        }
    }
}

/// A guard at work.
pub(super) struct Watch<R, const N: usize> {
    guard: Guard,
    every: u32,
    until_look: u32,
    /// Whether a run that ends before its first look is long enough for one.
    worth: u32,
    /// The order of a method whose steps are judged, else zero.
    order: u32,
    /// Where the last look found everything in order.
    good: Reached<R, N>,
    /// What the looks have learned so far.
    known: Option<Known<R, N>>,
}

/// What looks learn, the first one from the initial state.
struct Known<R, const N: usize> {
    energy: Option<R>,
    scale: f64,
    /// The number of functions that must not vanish, and whether each was negative at the start.
    edges: usize,
    negative: [bool; EDGES],
    /// The largest absolute value of each entry of the state.
    largest: [f64; N],
    defects: Defects<N>,
}

impl<R: Real, const N: usize> Watch<R, N> {
    pub fn new(guard: Guard, evaluations: u32, order: u32, start: &Reached<R, N>) -> Result<Self, Cause> {
        if !guard.is_valid() {
            return Err(Cause::Setting(Setting::Guard));
        }
        let guard = guard.for_real::<R>();
        let every = guard.every.unwrap_or(EVALUATIONS_BETWEEN_LOOKS / evaluations.max(1)).max(1);
        let worth = if guard.every.is_some() { 1 } else { EVALUATIONS_WORTH_A_LOOK / evaluations.max(1) };
        let order = if guard.step == f64::INFINITY { 0 } else { order };
        Ok(Self { guard, every, until_look: every, worth, order, good: *start, known: None })
    }

    /// Whether the look after the next step will want to know where that step began; `last` if it is the last one.
    #[inline]
    pub fn wants_before(&self, last: bool) -> bool {
        self.order > 0 && (last || self.until_look == 1)
    }

    /// As many steps can be made before anything has to be told.
    #[inline]
    pub fn patience(&self) -> u32 {
        if self.order > 0 { (self.until_look - 1).max(1) } else { self.until_look }
    }

    /// Counts the steps since `from`, no more than [`patience`](Watch::patience) allowed, and looks if it is time to.
    #[inline]
    pub fn step<S>(
        &mut self,
        system: &S,
        from: u64,
        before: Option<&Reached<R, N>>,
        reached: &Reached<R, N>,
    ) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let made = reached.statistics.accepted.saturating_sub(from);
        self.until_look = self.until_look.saturating_sub(u32::try_from(made).unwrap_or(u32::MAX));
        if self.until_look > 0 {
            return Ok(());
        }
        self.until_look = self.every;
        self.look(system, self.every, before, reached)
    }

    /// Looks at the end of a run, unless it was just looked at or the run was short.
    pub fn finish<S>(
        &mut self,
        system: &S,
        before: Option<&Reached<R, N>>,
        reached: &Reached<R, N>,
    ) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let steps = self.every - self.until_look;
        let due = if self.known.is_some() { steps > 0 } else { steps >= self.worth.max(1) };
        if due && self.every != u32::MAX { self.look(system, steps, before, reached) } else { Ok(()) }
    }

    /// The error of a run that cannot go on from where it stands: for the cause given, unless the steps since the last
    /// look went wrong before.
    pub fn stopped<S>(&mut self, system: &S, reached: &Reached<R, N>, cause: Cause) -> IntegrationError<R, N>
    where
        S: System<R, N> + ?Sized,
    {
        if reached.time == self.good.time || self.every == u32::MAX {
            return reached.failed(cause);
        }
        match self.look(system, 0, None, reached) {
            Ok(()) => reached.failed(cause),
            Err(earlier) => self.good(reached).failed(earlier),
        }
    }

    /// The last time and state that were found in order, with the work done since then counted.
    pub fn good(&self, reached: &Reached<R, N>) -> Reached<R, N> {
        Reached { statistics: reached.statistics, ..self.good }
    }

    /// Looks at a state, which stands for so many steps; `before` is where the last of them began.
    #[inline(never)]
    fn look<S>(
        &mut self,
        system: &S,
        steps: u32,
        before: Option<&Reached<R, N>>,
        reached: &Reached<R, N>,
    ) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let Self { guard, good, known, order, .. } = self;
        let known = match known {
            Some(known) => known,
            None => known.insert(Known::new(system, guard, good)?),
        };
        let found = reached.time.to_f64();
        let vitals = system.vitals(reached.time, &reached.state);
        if let (Some(energy), Some(before)) = (vitals.energy, known.energy) {
            // With the scale of this state, for the start may have none: at rest, where the potential is zero. A state
            // that blew up is no larger than its own energy, so that its change is about one.
            let scale = known.scale.max(vitals.scale.to_f64());
            let change = relative((energy - before).to_f64().abs(), scale);
            if exceeds(change, guard.energy) {
                return Err(Cause::Energy { found, change, limit: guard.energy });
            }
            known.scale = scale;
        }
        in_order(guard, found, vitals.residual.to_f64(), system.condition(reached.time, &reached.state))?;
        for (largest, entry) in known.largest.iter_mut().zip(&reached.state) {
            *largest = largest.max(entry.to_f64().abs());
        }
        known.edges(system, reached, guard.edge)?;
        if let Some(before) = before
            && *order > 0
        {
            let limit = guard.step;
            let worst = known.defects.add(system, steps, before, reached, &known.largest);
            if exceeds(worst.defect, limit) {
                return Err(Cause::Step { found, entry: worst.entry, defect: worst.defect, limit });
            }
        }
        let drift = vitals.carried.to_f64();
        if exceeds(drift, guard.carried) {
            return Err(Cause::Carried { found, drift, limit: guard.carried });
        }
        *good = *reached;
        Ok(())
    }
}

impl<R: Real, const N: usize> Known<R, N> {
    /// Looks at the start.
    fn new<S>(system: &S, guard: &Guard, start: &Reached<R, N>) -> Result<Self, Cause>
    where
        S: System<R, N> + ?Sized,
    {
        let vitals = system.vitals(start.time, &start.state);
        let found = start.time.to_f64();
        in_order(guard, found, vitals.residual.to_f64(), system.condition(start.time, &start.state))?;
        let largest = core::array::from_fn(|i| start.state[i].to_f64().abs());
        let (edges, values) = values(system, start, &largest);
        let mut known = Self {
            energy: vitals.energy,
            scale: vitals.scale.to_f64(),
            edges,
            negative: values.map(|value| value.value.to_f64() < 0.0),
            largest,
            defects: Defects::new(),
        };
        known.edges(system, start, guard.edge)?;
        Ok(known)
    }

    fn edges<S>(&mut self, system: &S, reached: &Reached<R, N>, limit: f64) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        if self.edges == 0 {
            return Ok(());
        }
        let (_, values) = values(system, reached, &self.largest);
        for (function, (value, negative)) in values.iter().zip(self.negative).take(self.edges).enumerate() {
            let left = value.left().to_f64();
            let distance = if (value.value.to_f64() < 0.0) == negative { left } else { -left };
            if distance <= limit || distance.is_nan() {
                let found = reached.time.to_f64();
                return Err(Cause::Edge { found, function, distance, limit });
            }
        }
        Ok(())
    }
}

/// The functions that must not vanish, where every entry is uncertain by a rounding of the largest value it has had.
fn values<R: Real, S, const N: usize>(
    system: &S,
    reached: &Reached<R, N>,
    largest: &[f64; N],
) -> (usize, [Rounded<R>; EDGES])
where
    S: System<R, N> + ?Sized,
{
    let mut values = [Rounded::exact(R::zero()); EDGES];
    let state = core::array::from_fn(|i| Rounded { value: reached.state[i], error: R::from_f64(largest[i]) });
    let edges = system.edges(Rounded::once(reached.time), &state, &mut values);
    (edges.min(EDGES), values)
}

/// Tests of one state that need nothing of the states before.
fn in_order(guard: &Guard, found: f64, residual: f64, condition: f64) -> Result<(), Cause> {
    if exceeds(residual, guard.residual) {
        return Err(Cause::Residual { found, residual, limit: guard.residual });
    }
    if exceeds(condition, guard.condition) {
        return Err(Cause::Condition { found, condition, limit: guard.condition });
    }
    Ok(())
}

/// A change in units of a scale; what does not change at all is no change even of nothing.
pub(super) fn relative(change: f64, scale: f64) -> f64 {
    if change == 0.0 { 0.0 } else { change / scale }
}

/// Whether a value is above its limit, or none at all.
pub(super) fn exceeds(value: f64, limit: f64) -> bool {
    value > limit || value.is_nan()
}
