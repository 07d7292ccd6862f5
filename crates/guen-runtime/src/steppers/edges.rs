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
pub(super) struct Edges {
    count: usize,
    /// Whether each was negative at the start.
    negative: [bool; EDGES],
}

impl Edges {
    /// Of the start, with the largest value that each entry of the state has had.
    pub fn new<R: Real, S, const N: usize>(system: &S, start: &Reached<R, N>, largest: &[f64; N]) -> Self
    where
        S: System<R, N> + ?Sized,
    {
        let (count, values) = values(system, start, largest);
        Self { count, negative: values.map(|value| value.value.to_f64() < 0.0) }
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
        let (_, values) = values(system, reached, largest);
        for (function, (value, negative)) in values.iter().zip(self.negative).take(self.count).enumerate() {
            let left = value.left().to_f64();
            let distance = if (value.value.to_f64() < 0.0) == negative { left } else { -left };
            if distance <= limit || distance.is_nan() {
                let found = reached.time.to_f64();
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
        let mut soonest = u32::MAX;
        if self.count == 0 {
            return Ok(soonest);
        }
        let (_, from) = values(system, before, largest);
        let (_, to) = values(system, reached, largest);
        for (function, (from, to)) in from.iter().zip(to).take(self.count).enumerate() {
            let (from, to) = (from.value.to_f64().abs(), to.value.to_f64().abs());
            let ratio = f64::max(from / to, to / from);
            if ratio > limit {
                return Err(Cause::Approach { found: reached.time.to_f64(), function, ratio, limit });
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
