//! The formula of order eight of DOP853, with a fixed step.

use crate::numbers::lanes::Lanes;
use crate::numbers::real::Real;
use crate::steppers::driver::dense::Dense;
use crate::steppers::driver::error::Cause;
use crate::steppers::driver::run::{Checkpoint, Method};
use crate::steppers::driver::statistics::Statistics;
use crate::steppers::explicit::compensated::Compensated;
use crate::steppers::explicit::fixed::{Changes, Fixed, Formula, LastStep, NextStep, Slopes, fixed_step};
use crate::steppers::explicit::lanes::{LaneFormula, Moment, in_lanes};
use crate::steppers::explicit::tableau::{Stages, Tableau, blank};
use crate::steppers::scaled;
use crate::steppers::shifted;
use crate::system::System;

/// A Runge-Kutta method of order eight with a fixed step: the weights of [`Dop853`](crate::steppers::Dop853), without its error
/// estimates.
///
/// - Order 8, 12 evaluations a step; steps, demands and guarantees as of [`Rk4`](crate::steppers::Rk4). On smooth motions it is
///   the cheapest fixed step at every accuracy; `docs/design/work-precision.md` has the figures.
/// - Works for every [`Real`]: lanes, which share their time, included.
/// - Dense output is DOP853's, `O(h^8)`: three evaluations more on steps where it is asked for.
/// - Source: that of [`Dop853`](crate::steppers::Dop853).
///
/// ```
/// use core::ops::ControlFlow;
/// use guen_runtime::{from_fn, steppers::Rk8};
///
/// let oscillator = from_fn(|_t: f64, &[x, v]: &[f64; 2]| [v, -x]);
/// let done = Rk8::new(0.25)
///     .integrate(&oscillator, 0.0, &[0.0, 1.0], 10.0, |_t, _x| ControlFlow::Continue(()))
///     .unwrap();
/// assert_eq!(done.statistics.evaluations, 40 * 12);
/// assert!((done.state[0] - 10.0_f64.sin()).abs() < 1e-10);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rk8<R = f64> {
    /// The step, in units of time: positive and finite.
    pub step: R,
    tableau: Tableau<R>,
}

impl<R: Real> Rk8<R> {
    /// The method with this step.
    pub fn new(step: R) -> Self {
        Self { step, tableau: Tableau::new() }
    }

    /// The method with a sum of its steps that loses no digits: for long runs.
    pub fn compensated(self) -> Compensated<Self> {
        Compensated { method: self }
    }
}

/// The slopes at the ends of a step, and those of its stages where dense output wants them.
#[derive(Clone, Copy, Debug)]
pub struct Memory<R, const N: usize> {
    slopes: Slopes<R, N>,
    stages: Stages<R, N>,
}

impl<R: Real, S: System<R, N> + ?Sized, const N: usize> Formula<R, S, N> for Rk8<R> {
    type Memory = Memory<R, N>;
    const EVALUATIONS: u32 = 12;

    fn step_size(&self) -> R {
        self.step
    }

    fn memory(&self) -> Self::Memory {
        Memory { slopes: Slopes::new(), stages: [[R::zero(); N]; 8] }
    }

    #[inline]
    fn step(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> Result<[R; N], Cause> {
        let (from, h) = (next.from, next.h);
        Ok(shifted(&from.state, h, &self.slope(next)))
    }

    fn dense(
        &self,
        last: LastStep<'_, R, S, &mut Self::Memory, N>,
        h: R,
        statistics: &mut Statistics,
    ) -> Dense<R, N> {
        let LastStep { system, memory, from, to } = last;
        let end = memory.slopes.end(system, to, statistics);
        statistics.evaluations += 3;
        self.tableau.dense(system, &memory.stages, from, to, &end, h)
    }

    fn defect(&self, last: LastStep<'_, R, S, &Self::Memory, N>) -> [R; N] {
        estimate(&self.tableau, &last.memory.stages, last.to.since(last.from))
    }
}

/// DOP853's own estimate of the error of a step, of each entry by itself: `h s5 / sqrt(s5 + s3/100)` with the squares of both
/// differences, of order eight.
#[inline(always)]
fn estimate<R: Real, const N: usize>(tableau: &Tableau<R>, stages: &Stages<R, N>, h: R) -> [R; N] {
    let (h, tenth) = (h.abs(), R::from_ratio(1, 10));
    let [mut five, three] = tableau.errors(stages);
    for i in 0..N {
        let size = five[i].abs();
        // A quotient, for squares of small differences would be zero.
        let ratio = tenth * three[i] / size;
        let error = h * size / (R::one() + ratio * ratio).sqrt();
        five[i] = size.where_above(R::zero(), error, R::zero());
    }
    five
}

impl<R: Real> Rk8<R> {
    /// The mean slope of a step.
    #[inline]
    fn slope<S: System<R, N> + ?Sized, const N: usize>(
        &self,
        next: NextStep<'_, R, S, Memory<R, N>, N>,
    ) -> [R; N] {
        let NextStep { system, memory, from, h, dense, statistics } = next;
        let k1 = memory.slopes.begin(system, from, statistics);
        let mut made = blank();
        self.tableau.late(system, from.time, &from.state, &k1, h, &mut made);
        statistics.evaluations += 11;
        if dense {
            memory.stages = made.stages;
        }
        self.tableau.slope(&made.stages)
    }
}

impl<R: Real, S: System<R, N> + ?Sized, const N: usize> Changes<R, S, N> for Rk8<R> {
    #[inline]
    fn change(&self, next: NextStep<'_, R, S, Self::Memory, N>) -> [R; N] {
        let h = next.h;
        scaled(h, &self.slope(next))
    }
}

fixed_step!(Rk8 over Real, systems System, memory Memory<R, N>);
in_lanes!(Rk8);

impl<L: Lanes, S: System<L, N> + ?Sized, const N: usize> LaneFormula<L, S, N> for Rk8 {
    type Memory = Stages<L, N>;
    type Ready = Tableau<L>;
    const EVALUATIONS: u32 = 12;

    fn ready(&self) -> (Tableau<L>, f64, Stages<L, N>) {
        (self.tableau.over(L::from_f64), self.step, [[L::zero(); N]; 8])
    }

    #[inline(always)]
    fn step(
        tableau: &Tableau<L>,
        system: &S,
        memory: &mut Stages<L, N>,
        (t, x): (L, &[L; N]),
        h: L,
        keep: bool,
    ) -> [L; N] {
        L::vectorize(
            #[inline(always)]
            || {
                let mut made = blank();
                tableau.stepped::<false, S, N>(system, t, x, &system.rhs(t, x), h, &mut made);
                if keep {
                    *memory = made.stages;
                }
                shifted(x, h, &tableau.slope(&made.stages))
            },
        )
    }

    fn defect(
        tableau: &Tableau<L>,
        _system: &S,
        stages: &Stages<L, N>,
        before: &Moment<L, N>,
        now: &Moment<L, N>,
    ) -> [L; N] {
        L::vectorize(
            #[inline(always)]
            || estimate(tableau, stages, L::from_f64(now.time - before.time)),
        )
    }
}
