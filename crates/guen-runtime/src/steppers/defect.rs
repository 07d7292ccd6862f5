//! What fixed steps got wrong, from estimates of single steps that the methods make: see `Course::defect`.
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

    /// Takes the estimated errors of a step for those of `steps` of them; `negligible` the part of the largest entry that
    /// counts as zero.
    pub fn add(&mut self, found: &[f64; N], steps: u32, largest: &[f64; N], negligible: f64) -> Worst {
        let defects = relative(found, largest, negligible);
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

/// Relative to the size of each entry. What is below a part of the largest entry counts as zero: an entry that has no size of
/// its own, since by symmetry it is zero, consists of nothing but roundings.
fn relative<const N: usize>(defects: &[f64; N], largest: &[f64; N], negligible: f64) -> [f64; N] {
    let negligible = negligible * largest.iter().fold(0.0_f64, |most, size| most.max(*size));
    core::array::from_fn(|i| if defects[i] <= negligible { 0.0 } else { defects[i] / largest[i] })
}

/// What the change over a step differs from Gauss's rule with two nodes along the cubic through its ends, where the slopes
/// are `first` and that at the end: three right-hand sides.
pub(super) fn quadrature<R: Real, S, const N: usize>(
    system: &S,
    first: &[R; N],
    before: &Reached<R, N>,
    reached: &Reached<R, N>,
) -> [f64; N]
where
    S: System<R, N> + ?Sized,
{
    let h = reached.time - before.time;
    let last = system.rhs(reached.time, &reached.state);
    // 1/2 -+ sqrt(3)/6
    let nodes = [R::from_f64(0.211_324_865_405_187_13), R::from_f64(0.788_675_134_594_812_9)];
    let slopes = nodes.map(|c| {
        let rest = R::one() - c;
        let (ahead, first_part, last_part) =
            (c * c * (R::from_ratio(3, 1) - c - c), h * c * rest * rest, h * c * c * rest);
        let state = core::array::from_fn(|i| {
            let change = reached.state[i] - before.state[i];
            before.state[i] + ahead * change + first_part * first[i] - last_part * last[i]
        });
        system.rhs(before.time + c * h, &state)
    });
    core::array::from_fn(|i| {
        let mean = (slopes[0][i] + slopes[1][i]) * R::from_ratio(1, 2);
        (reached.state[i] - before.state[i] - h * mean).to_f64().abs()
    })
}

#[cfg(test)]
mod tests {
    use super::{Reached, quadrature};
    use crate::{System, from_fn};

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
                let first = oscillator.rhs(0.0, &before.state);
                let found = quadrature(&oscillator, &first, &before, &Reached::new(h, &state));
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
