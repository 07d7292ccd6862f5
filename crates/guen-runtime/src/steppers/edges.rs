//! The functions that must not vanish, as a guard watches them: how near the edge of the chart is, and whether the steps
//! are short enough for it.

use super::course::Reached;
use crate::error::Cause;
use crate::real::Real;
use crate::rounded::Rounded;
use crate::system::System;

/// As many functions that must not vanish are watched; further ones are not.
pub(super) const EDGES: usize = 16;

/// The functions as the start had them.
#[derive(Clone, Copy)]
pub(super) struct Edges {
    count: usize,
    /// Whether each was negative at the start.
    negative: [bool; EDGES],
}

impl Edges {
    /// Of the values at the start, of which there are so many.
    pub fn new(count: usize, value: impl Fn(usize) -> f64) -> Self {
        let mut negative = [false; EDGES];
        for (function, negative) in negative.iter_mut().enumerate().take(count) {
            *negative = value(function) < 0.0;
        }
        Self { count, negative }
    }

    /// Of the start, with the largest value that each entry of the state has had.
    pub fn of<R: Real, S, const N: usize>(system: &S, start: &Reached<R, N>, largest: &[f64; N]) -> Self
    where
        S: System<R, N> + ?Sized,
    {
        let (count, values) = of_reached(system, start, largest);
        Self::new(count, |function| values.get(function).map_or(0.0, |value| value.value.to_f64()))
    }

    /// Whether there are any.
    pub fn are_there(&self) -> bool {
        self.count > 0
    }

    /// Whether a state is on the same side as the start, and further than the limit from the edge.
    pub fn look<R: Real, S, const N: usize>(
        &self,
        system: &S,
        reached: &Reached<R, N>,
        largest: &[f64; N],
        limit: f64,
    ) -> Result<(), Cause>
    where
        S: System<R, N> + ?Sized,
    {
        if self.count == 0 {
            return Ok(());
        }
        let (_, values) = of_reached(system, reached, largest);
        self.distances(
            values.iter().map(|value| (value.value.to_f64(), value.left().to_f64())),
            reached.time.to_f64(),
            limit,
        )
    }

    /// The same for values and what is left of them.
    pub fn distances(
        &self,
        values: impl Iterator<Item = (f64, f64)>,
        found: f64,
        limit: f64,
    ) -> Result<(), Cause> {
        for (function, ((value, left), negative)) in values.zip(self.negative).take(self.count).enumerate() {
            let distance = if (value < 0.0) == negative { left } else { -left };
            if distance <= limit || distance.is_nan() {
                return Err(Cause::Edge { found, function, distance, limit });
            }
        }
        Ok(())
    }

    /// In how many steps to look again, judged by the step from `before` to `reached`: in half of those after which the
    /// nearest edge would be reached at this pace. An error where one step changed a function by more than the factor
    /// `limit`: what divides by it is a pole that such steps do not resolve.
    pub fn approach<R: Real, S, const N: usize>(
        &self,
        system: &S,
        before: &Reached<R, N>,
        reached: &Reached<R, N>,
        largest: &[f64; N],
        limit: f64,
    ) -> Result<u32, Cause>
    where
        S: System<R, N> + ?Sized,
    {
        if self.count == 0 {
            return Ok(u32::MAX);
        }
        let (_, from) = of_reached(system, before, largest);
        let (_, to) = of_reached(system, reached, largest);
        let values = from.iter().zip(&to).map(|(from, to)| (from.value.to_f64(), to.value.to_f64()));
        self.paces(values, reached.time.to_f64(), limit)
    }

    /// The same for values before and after a step.
    pub fn paces(
        &self,
        values: impl Iterator<Item = (f64, f64)>,
        found: f64,
        limit: f64,
    ) -> Result<u32, Cause> {
        let mut soonest = u32::MAX;
        for (function, (from, to)) in values.take(self.count).enumerate() {
            let (from, to) = (from.abs(), to.abs());
            let ratio = f64::max(from / to, to / from);
            if ratio > limit {
                return Err(Cause::Approach { found, function, ratio, limit });
            }
            if to < from {
                let steps = 0.5 * to / (from - to);
                soonest =
                    soonest.min(if steps < f64::from(u32::MAX) { (steps as u32).max(1) } else { u32::MAX });
            }
        }
        Ok(soonest)
    }
}

fn of_reached<R: Real, S, const N: usize>(
    system: &S,
    reached: &Reached<R, N>,
    largest: &[f64; N],
) -> (usize, [Rounded<R>; EDGES])
where
    S: System<R, N> + ?Sized,
{
    values(system, reached, &largest.map(R::from_f64))
}

/// The functions that must not vanish and how many they are, where every entry is uncertain by a rounding of the largest
/// value it has had.
pub(super) fn values<R: Real, S, const N: usize>(
    system: &S,
    reached: &Reached<R, N>,
    largest: &[R; N],
) -> (usize, [Rounded<R>; EDGES])
where
    S: System<R, N> + ?Sized,
{
    let mut values = [Rounded::exact(R::zero()); EDGES];
    let state = core::array::from_fn(|i| Rounded { value: reached.state[i], error: largest[i] });
    let edges = system.edges(Rounded::once(reached.time), &state, &mut values);
    (edges.min(EDGES), values)
}
