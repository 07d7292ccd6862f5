//! The runs that a guard judges: one, whatever its real consists of, or one in every lane.

use crate::numbers::choices::most;
use crate::numbers::lanes::{Lanes, Mask};
use crate::numbers::real::Real;

/// A way to read single runs out of the reals that they have in common.
pub(in crate::steppers) trait Runs<R: Real> {
    /// The number of runs.
    const COUNT: usize;

    /// A number of steps for each run.
    type Steps: Copy + Default + AsMut<[u32]>;

    /// The number of one run; of a run of several lanes the largest, and NaN if one is.
    fn alone(x: R, run: usize) -> f64;

    /// The runs in which a number is neither infinite nor NaN.
    fn finite(x: R) -> Mask;
}

/// A run alone, not in lanes.
pub(in crate::steppers) struct One;

impl<R: Real> Runs<R> for One {
    const COUNT: usize = 1;

    type Steps = [u32; 1];

    #[inline(always)]
    fn alone(x: R, _run: usize) -> f64 {
        most(x)
    }

    #[inline(always)]
    fn finite(x: R) -> Mask {
        Mask::all(usize::from(x.is_finite()))
    }
}

/// The most lanes that there are.
pub(in crate::steppers) const MOST: usize = 8;

/// A run in every lane.
pub(in crate::steppers) struct Each;

impl<L: Lanes> Runs<L> for Each {
    const COUNT: usize = L::COUNT;

    type Steps = [u32; MOST];

    #[inline(always)]
    fn alone(x: L, run: usize) -> f64 {
        x.lane(run)
    }

    #[inline(always)]
    fn finite(x: L) -> Mask {
        x.finite()
    }
}
