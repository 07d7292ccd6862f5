//! The functions that must not vanish, as a guard watches them: how near the edge of the chart is, and whether the steps
//! are short enough for it.

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

    /// Whether there are any.
    pub fn are_there(&self) -> bool {
        self.count > 0
    }

    /// Whether values, and what is left of them, are on the same side as at the start and further than the limit from the edge.
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

    /// In how many steps to look again, judged by the values before and after a step: in half of those after which the
    /// nearest edge would be reached at this pace. An error where one step changed a function by more than the factor
    /// `limit`: what divides by it is a pole that such steps do not resolve.
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

/// Writes the functions that must not vanish, where every entry is uncertain by a rounding of the largest value it has had, and
/// returns how many they are.
pub(super) fn functions<R: Real, S, const N: usize>(
    system: &S,
    time: R,
    state: &[R; N],
    largest: &[R; N],
    into: &mut [Rounded<R>; EDGES],
) -> usize
where
    S: System<R, N> + ?Sized,
{
    let mut rounded = [Rounded::exact(time); N];
    for ((entry, value), error) in rounded.iter_mut().zip(state).zip(largest) {
        *entry = Rounded { value: *value, error: *error };
    }
    system.edges(Rounded::once(time), &rounded, into).min(EDGES)
}
