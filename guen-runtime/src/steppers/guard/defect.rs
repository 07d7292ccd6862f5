//! The errors of fixed steps, from estimates of single steps that the methods make: see `StepperRun::defect`.
//!
//! For explicit methods up to order four that is [`quadrature`],
//!
//! ```text
//! d = x1 - x0 - h/2 (f(t0 + c1 h, p(c1)) + f(t0 + c2 h, p(c2))),   c = 1/2 -+ sqrt(3)/6
//! ```
//!
//! the difference between the change over a step and Gauss's rule along the cubic `p` through its ends. Both are of order
//! four: with methods up to this order `d` is the error of the step to within a factor of the order of one. Simpson's rule
//! would have the weights of RK4: where the first slope alone is huge, next to a pole, both are wrong by the same. Methods
//! of higher order estimate by themselves: an eighth-order one was right to 1e-7 on a sled where `d` said three times the
//! size of an entry, and implicit ones hold damping at rates beyond their step.

use crate::numbers::real::Real;
use crate::steppers::driver::run::Checkpoint;
use crate::system::System;

/// Estimates so far, each relative to the size of its entry.
#[derive(Clone, Copy)]
pub(in crate::steppers) struct Defects<R, const N: usize> {
    /// Estimated errors of all steps together.
    sum: [R; N],
    /// The estimate of the check before.
    last: Option<[R; N]>,
}

/// The entry of the state with the largest estimate, relative to its size.
pub(in crate::steppers) struct Worst {
    pub entry: usize,
    pub defect: f64,
}

impl<R: Real, const N: usize> Defects<R, N> {
    pub(crate) fn new() -> Self {
        Self { sum: [R::zero(); N], last: None }
    }

    /// Takes the estimated errors of a step for those of `steps` of them, and returns the largest of what every entry is
    /// [`judged`](Defects::judged) by; `negligible` is the part of the largest entry that counts as zero.
    #[inline(always)]
    pub(crate) fn add(&mut self, found: &[R; N], steps: u32, largest: &[R; N], negligible: f64) -> R {
        let defects = relative(found, largest, negligible);
        let last = self.last.replace(defects).unwrap_or(defects);
        let mut most = R::zero();
        for i in 0..N {
            // The smaller of two: a jump of the rates, which one step in many passes, stands for itself alone.
            let smaller = defects[i].where_above(last[i], last[i], defects[i]);
            self.sum[i] += R::from_f64(f64::from(steps)) * smaller;
            let judged = self.sum[i].where_above(defects[i], self.sum[i], defects[i]);
            most = judged.where_above(most, judged, most);
        }
        most
    }

    /// Returns the value that every entry was judged by last, in one lane.
    pub(crate) fn judged(&self, alone: impl Fn(R) -> f64) -> [f64; N] {
        let mut judged = [0.0; N];
        for i in 0..N {
            let (sum, last) = (alone(self.sum[i]), self.last.map_or(0.0, |last| alone(last[i])));
            judged[i] = if sum <= last { last } else { sum };
        }
        judged
    }
}

/// The entry with the largest of these.
pub(in crate::steppers) fn worst<const N: usize>(judged: &[f64; N]) -> Worst {
    let mut worst = Worst { entry: 0, defect: 0.0 };
    for (entry, &defect) in judged.iter().enumerate() {
        if defect > worst.defect || defect.is_nan() {
            worst = Worst { entry, defect };
            if defect.is_nan() {
                break;
            }
        }
    }
    worst
}

/// Relative to the size of each entry. What is below a part of the largest entry counts as zero: an entry that has no size of
/// its own, since by symmetry it is zero, consists of nothing but roundings.
#[inline(always)]
fn relative<R: Real, const N: usize>(defects: &[R; N], largest: &[R; N], negligible: f64) -> [R; N] {
    let mut most = R::zero();
    for size in largest {
        most = size.where_above(most, *size, most);
    }
    let negligible = R::from_f64(negligible) * most;
    let mut relative = *defects;
    for (defect, largest) in relative.iter_mut().zip(largest) {
        *defect = defect.where_above(negligible, *defect / *largest, R::zero());
    }
    relative
}

/// Returns the difference between the change over a step and Gauss's rule with two nodes along the cubic through its
/// ends, where the slopes are `first` and that at the end: three right-hand sides.
#[inline(always)]
pub(in crate::steppers) fn quadrature<R: Real, S, const N: usize>(
    system: &S,
    first: &[R; N],
    before: &Checkpoint<R, N>,
    reached: &Checkpoint<R, N>,
) -> [R; N]
where
    S: System<R, N> + ?Sized,
{
    let h = reached.since(before);
    let last = system.rhs(reached.time, &reached.state);
    // 1/2 -+ sqrt(3)/6
    let nodes = [0.211_324_865_405_187_13, 0.788_675_134_594_812_9];
    let mut slopes = [last; 2];
    for (slope, node) in slopes.iter_mut().zip(nodes) {
        let c = R::from_f64(node);
        let rest = R::one() - c;
        let (ahead, first_part, last_part) =
            (c * c * (R::from_ratio(3, 1) - c - c), h * c * rest * rest, h * c * c * rest);
        let mut state = before.state;
        for i in 0..N {
            let change = reached.state[i] - before.state[i];
            state[i] = state[i] + ahead * change + first_part * first[i] - last_part * last[i];
        }
        *slope = system.rhs(before.time + c * h, &state);
    }
    let mut apart = last;
    for i in 0..N {
        let mean = (slopes[0][i] + slopes[1][i]) * R::from_ratio(1, 2);
        apart[i] = (reached.state[i] - before.state[i] - h * mean).abs();
    }
    apart
}

#[cfg(test)]
mod tests {
    use super::{Checkpoint, quadrature};
    use crate::{System, from_fn};

    /// Compares estimates with the errors of Euler's method and of RK4, which are known for an oscillator.
    #[test]
    fn the_estimate_is_the_error_of_the_step() {
        let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
        let before = Checkpoint::new(0.0, &[1.0, 0.0]);
        for h in [0.1_f64, 0.3] {
            let exact = [h.cos(), -h.sin()];
            for (state, order) in
                [([1.0, -h], 1), ([1.0 - h * h / 2.0 + h.powi(4) / 24.0, -h + h.powi(3) / 6.0], 4)]
            {
                let first = oscillator.rhs(0.0, &before.state);
                let found = quadrature(&oscillator, &first, &before, &Checkpoint::new(h, &state));
                let error = (0..2).map(|i| (state[i] - exact[i]).abs()).fold(0.0, f64::max);
                let estimate = found.iter().fold(0.0_f64, |most, d| most.max(*d));
                assert!(
                    (0.5..2.0).contains(&(estimate / error)),
                    "order {order}: {estimate:e} for {error:e}"
                );
            }
        }
    }
}
