//! What a fixed step got wrong: a monitor for explicit methods up to order four, which estimate no error of their own.
//!
//! ```text
//! d = x1 - x0 - h/6 (f(t0, x0) + 4 f(t0 + h/2, m) + f(t1, x1)),   m = (x0 + x1)/2 + h/8 (f(t0, x0) - f(t1, x1))
//! ```
//!
//! the difference between the change over a step and Simpson's rule along the cubic through its ends. Both are of order
//! four: with methods up to this order `d` is the error of the step to within a factor of the order of one. Methods of
//! higher order are not judged by it: Gauss of order six holds damping at 2e4 times the inverse of its step, and a method of
//! order eight was right to 1e-7 on a sled where `d` said three times the size of an entry.

use super::course::Reached;
use crate::real::Real;
use crate::system::System;

/// Estimates so far.
pub(super) struct Defects<const N: usize> {
    /// Estimated errors of all steps together.
    sum: [f64; N],
    /// The estimate of the look before.
    last: Option<[f64; N]>,
}

/// The entry of the state with the largest estimate, relative to its size.
pub(super) struct Worst {
    pub entry: usize,
    pub defect: f64,
}

impl<const N: usize> Defects<N> {
    pub fn new() -> Self {
        Self { sum: [0.0; N], last: None }
    }

    /// Takes the step that leads from `before` to `reached` for `steps` of them. Three right-hand sides.
    pub fn add<R: Real, S>(
        &mut self,
        system: &S,
        steps: u32,
        before: &Reached<R, N>,
        reached: &Reached<R, N>,
        largest: &[f64; N],
    ) -> Worst
    where
        S: System<R, N> + ?Sized,
    {
        let defects = relative(&defect(system, before, reached), largest, R::epsilon().to_f64());
        let last = self.last.replace(defects).unwrap_or(defects);
        let mut worst = Worst { entry: 0, defect: 0.0 };
        for i in 0..N {
            // The smaller of two: a jump of the rates, which one step in many passes, stands for itself alone.
            self.sum[i] += f64::from(steps) * defects[i].min(last[i]);
            let found = defects[i].max(self.sum[i]);
            if found > worst.defect || found.is_nan() {
                worst = Worst { entry: i, defect: found };
                if found.is_nan() {
                    break;
                }
            }
        }
        worst
    }
}

/// Relative to the size of each entry. What is below the root of a rounding of the largest entry counts as zero: an entry
/// that has no size of its own, since by symmetry it is zero, consists of nothing but roundings.
fn relative<const N: usize>(defects: &[f64; N], largest: &[f64; N], epsilon: f64) -> [f64; N] {
    let most = largest.iter().fold(0.0_f64, |most, size| most.max(*size));
    let negligible = libm::sqrt(epsilon) * most;
    core::array::from_fn(|i| if defects[i] <= negligible { 0.0 } else { defects[i] / largest[i] })
}

fn defect<R: Real, S, const N: usize>(system: &S, before: &Reached<R, N>, reached: &Reached<R, N>) -> [f64; N]
where
    S: System<R, N> + ?Sized,
{
    let h = reached.time - before.time;
    let half = h * R::from_ratio(1, 2);
    let first = system.rhs(before.time, &before.state);
    let last = system.rhs(reached.time, &reached.state);
    let middle = core::array::from_fn(|i| {
        (before.state[i] + reached.state[i]) * R::from_ratio(1, 2)
            + h * R::from_ratio(1, 8) * (first[i] - last[i])
    });
    let middle = system.rhs(before.time + half, &middle);
    core::array::from_fn(|i| {
        let mean = (first[i] + R::from_ratio(4, 1) * middle[i] + last[i]) * R::from_ratio(1, 6);
        (reached.state[i] - before.state[i] - h * mean).to_f64().abs()
    })
}

#[cfg(test)]
mod tests {
    use super::{Reached, defect};
    use crate::from_fn;

    /// Of an oscillator the errors of Euler's method and of RK4 are known.
    #[test]
    fn the_estimate_is_the_error_of_the_step() {
        let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
        let before = Reached::new(0.0, &[1.0, 0.0]);
        for h in [0.1_f64, 0.3] {
            let exact = [h.cos(), -h.sin()];
            for (state, order) in
                [([1.0, -h], 1), ([1.0 - h * h / 2.0 + h.powi(4) / 24.0, -h + h.powi(3) / 6.0], 4)]
            {
                let found = defect(&oscillator, &before, &Reached::new(h, &state));
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
