//! The functions that must not vanish, as a guard watches them: how near the edge of the chart is, and whether the steps
//! are short enough for it.

use crate::numbers::real::Real;
use crate::numbers::running_error::RunningError;
use crate::steppers::driver::error::Cause;
use crate::system::System;

/// As many functions that must not vanish are watched; further ones are not.
pub(in crate::steppers) const MAX_SINGULARITIES: usize = 16;

/// Whether the functions, each beside its value at the start, are on the same side as there and further than the limit from the
/// edge: in every lane, where the real consists of lanes.
#[inline(always)]
pub(in crate::steppers) fn distances<R: Real>(
    functions: impl Iterator<Item = (RunningError<R>, R)>,
    found: f64,
    limit: f64,
) -> Result<(), Cause> {
    let negative = |x: R| (-x).where_above(R::zero(), R::one(), R::zero());
    for (function, (now, start)) in functions.enumerate() {
        let left = now.left();
        let turned = (negative(now.value) - negative(start)).abs();
        // The least of all lanes.
        let distance = -turned.where_above(R::zero(), left, -left).most();
        if distance <= limit || distance.is_nan() {
            return Err(Cause::ChartSingularity { found, function, distance, limit });
        }
    }
    Ok(())
}

/// In how many steps to look again, judged by the values before and after a step: in half of those after which the
/// nearest edge would be reached at this pace. An error where one step changed a function by more than the factor
/// `limit`: what divides by it is a pole that such steps do not resolve.
#[inline(always)]
pub(in crate::steppers) fn paces<R: Real>(
    values: impl Iterator<Item = (R, R)>,
    found: f64,
    limit: f64,
) -> Result<u32, Cause> {
    let (zero, half) = (R::zero(), R::from_ratio(1, 2));
    let mut soonest = R::from_f64(f64::from(u32::MAX));
    for (function, (from, to)) in values.enumerate() {
        let (from, to) = (from.abs(), to.abs());
        let (down, up) = (from / to, to / from);
        let ratio = down.where_above(up, down, up);
        // Of two zeros there is no ratio.
        let ratio = (-ratio).where_above(zero, zero, ratio).most();
        if ratio > limit {
            return Err(Cause::ApproachingSingularity { found, function, ratio, limit });
        }
        let steps = from.where_above(to, half * to / (from - to), soonest);
        soonest = soonest.where_above(steps, steps, soonest);
    }
    // The soonest of all lanes; in the next step where that is no number.
    let soonest = -(-soonest).most();
    Ok(if soonest < f64::from(u32::MAX) || soonest.is_nan() { (soonest as u32).max(1) } else { u32::MAX })
}

/// In how many steps to look again, judged by the values of two looks that are so many steps apart: in half of those after
/// which the nearest edge would be reached at this pace. For steps that are not fixed.
pub(in crate::steppers) fn soonest<R: Real>(values: impl Iterator<Item = (R, R)>, steps: u32) -> u32 {
    let mut soonest = f64::INFINITY;
    for (from, to) in values {
        let (from, to) = (from.to_f64().abs(), to.to_f64().abs());
        if to < from {
            soonest = soonest.min(0.5 * to / (from - to));
        }
    }
    ((soonest * f64::from(steps)) as u32).max(1)
}

/// Writes the functions that must not vanish, where every entry is uncertain by a rounding of the largest value it has had, and
/// returns how many they are. Inside of [`Real::vectorize`], please.
#[inline(always)]
pub(in crate::steppers) fn functions<R: Real, S, const N: usize>(
    system: &S,
    time: R,
    state: &[R; N],
    largest: &[R; N],
    into: &mut [RunningError<R>; MAX_SINGULARITIES],
) -> usize
where
    S: System<R, N> + ?Sized,
{
    let mut rounded = [RunningError::exact(time); N];
    for ((entry, value), error) in rounded.iter_mut().zip(state).zip(largest) {
        *entry = RunningError { value: *value, error: *error };
    }
    system.singularities(RunningError::once(time), &rounded, into).min(MAX_SINGULARITIES)
}
