//! A step of an explicit formula for long states, one stage after the other in place.
//!
//! Without optimisation every array that an expression returns has a place of its own in the frame of its function: with 2,000
//! entries a step of DOP853 by expressions takes 1.7 MB of the stack, one in place 0.1.

use crate::numbers::real::Real;
use crate::steppers::explicit::tableau::{Made, Tableau};
use crate::system::System;

/// The slopes, by the numbers of their stages, that the weights of stages 2 to 12 belong to.
const SLOPES: [&[usize]; 11] = [
    &[1],
    &[1, 2],
    &[1, 3],
    &[1, 3, 4],
    &[1, 4, 5],
    &[1, 4, 5, 6],
    &[1, 4, 5, 6, 7],
    &[1, 4, 5, 6, 7, 8],
    &[1, 4, 5, 6, 7, 8, 9],
    &[1, 4, 5, 6, 7, 8, 9, 10],
    &[1, 4, 5, 6, 7, 8, 9, 10, 11],
];

impl<R: Real> Tableau<R> {
    /// Makes the step that [`stepped`](Tableau::stepped) makes, to the bit: sums of slopes are taken in the same order.
    #[inline(always)]
    pub(in crate::steppers) fn stepped_in_place<const EARLY: bool, S, const N: usize>(
        &self,
        system: &S,
        t: R,
        x: &[R; N],
        k1: &[R; N],
        h: R,
        made: &mut Made<R, N>,
    ) where
        S: System<R, N> + ?Sized,
    {
        let Made { state, guess, stages, errors, end } = made;
        let mut early = [[R::zero(); N]; 4];
        stages[0] = *k1;
        let [rows @ .., ends] = self.rows();
        for (i, ((weights, numbers), node)) in rows.into_iter().zip(SLOPES).zip(self.nodes()).enumerate() {
            // The number of slopes that `stepped` adds one by one.
            let late = match i {
                0 => 0,
                1..6 => 1,
                _ => 2,
            };
            let slope = |j: usize| match numbers[j] {
                number @ 2..=5 => &early[number - 2],
                number => &stages[number.saturating_sub(5)],
            };
            argument::<EARLY, _, _>(guess, (x, h), weights, late, slope);
            let slope = system.rhs(t + *node * h, guess);
            match i {
                0..4 => early[i] = slope,
                _ => stages[i - 3] = slope,
            }
        }
        argument::<EARLY, _, _>(state, (x, h), ends, 2, |j| &stages[j]);
        for (error, weights) in errors.iter_mut().zip(self.error_weights()) {
            combine(error, weights, |j| &stages[j]);
        }
        *end = None;
    }
}

/// Writes `x + h sum_j w_j k_j`, with the last slopes, `late` of them, added one by one.
#[inline(always)]
pub(super) fn argument<'a, const EARLY: bool, R: Real + 'a, const N: usize>(
    at: &mut [R; N],
    (x, h): (&[R; N], R),
    weights: &[R],
    late: usize,
    slope: impl Fn(usize) -> &'a [R; N],
) {
    let (sum, rest) = weights.split_at(weights.len() - late);
    combine(at, sum, &slope);
    if EARLY || late == 0 {
        for (entry, x) in at.iter_mut().zip(x) {
            *entry = *x + h * *entry;
        }
    }
    for (j, weight) in rest.iter().enumerate() {
        let slope = slope(sum.len() + j);
        if EARLY {
            let weight = h * *weight;
            for (entry, slope) in at.iter_mut().zip(slope) {
                *entry += weight * *slope;
            }
        } else {
            for (entry, slope) in at.iter_mut().zip(slope) {
                *entry = weight.times_plus(*slope, *entry);
            }
        }
    }
    if !EARLY && late > 0 {
        for (entry, x) in at.iter_mut().zip(x) {
            *entry = h.times_plus(*entry, *x);
        }
    }
}

/// Writes `sum_j w_j k_j`.
#[inline(always)]
pub(super) fn combine<'a, R: Real + 'a, const N: usize>(
    sum: &mut [R; N],
    weights: &[R],
    slope: impl Fn(usize) -> &'a [R; N],
) {
    for (j, weight) in weights.iter().enumerate() {
        for (entry, slope) in sum.iter_mut().zip(slope(j)) {
            let term = *weight * *slope;
            if j == 0 {
                *entry = term;
            } else {
                *entry += term;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::numbers::real::Real;
    use crate::steppers::explicit::tableau::{Tableau, blank};
    use crate::{Fused, from_fn};

    /// Compares a step of a pendulum with a damper in place with one by expressions.
    fn both_ways<const EARLY: bool, R: Real>() {
        let pendulum = from_fn(|t: R, &[q, w, z]: &[R; 3]| [w, z * t - q.sin(), q * w - z]);
        let tableau = Tableau::new();
        for k in 1..50 {
            let part = |numerator: i64| R::from_ratio(numerator, 97);
            let (t, x, h) = (part(k), [part(3 * k), part(40 - k), part(7 - 2 * k)], part(2 * k - 51));
            let k1 = crate::System::rhs(&pendulum, t, &x);
            let (mut here, mut there) = (blank(), blank());
            tableau.stepped::<EARLY, _, 3>(&pendulum, t, &x, &k1, h, &mut here);
            tableau.stepped_in_place::<EARLY, _, 3>(&pendulum, t, &x, &k1, h, &mut there);
            assert!(here.state == there.state && here.guess == there.guess, "step {k}");
            assert!(here.stages == there.stages && here.errors == there.errors, "step {k}");
        }
    }

    #[test]
    fn steps_in_place_are_those_by_expressions() {
        both_ways::<true, f64>();
        both_ways::<false, f64>();
        both_ways::<true, Fused>();
        both_ways::<false, Fused>();
    }
}
