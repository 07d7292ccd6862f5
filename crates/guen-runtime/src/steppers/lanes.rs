//! Runs with a fixed step in lanes: as many trajectories as there are lanes, each with its own end.
//!
//! All lanes share their times, which are those of a run in plain `f64`, and so are the states, to the bit. A lane that
//! fails is set aside with its error, and the others go on.

use super::course::{Done, Outcome, Statistics};
use super::fixed::Leg;
use super::lane_guard::{Faults, LaneGuard, MOST};
use super::rk4::{Rk4, step};
use crate::error::{Cause, IntegrationError, Setting};
use crate::lanes::{Lanes, Mask};
use crate::system::System;

/// A look at the energy, residuals and edges of all lanes is taken after so many steps, as with a run alone.
const EVERY: u32 = 40;

/// How the trajectories in lanes ended.
#[derive(Clone, Debug, PartialEq)]
pub struct InLanes<const N: usize> {
    ends: [Option<Result<Done<f64, N>, IntegrationError<f64, N>>>; MOST],
}

impl<const N: usize> InLanes<N> {
    /// The end of the trajectory in a lane; none if there is no such lane.
    pub fn lane(&self, lane: usize) -> Option<&Result<Done<f64, N>, IntegrationError<f64, N>>> {
        self.ends.get(lane)?.as_ref()
    }

    /// The lanes whose trajectory failed.
    pub fn failed(&self) -> Mask {
        let failed = |(lane, end): (usize, &Option<_>)| u32::from(matches!(end, Some(Err(_)))) << lane;
        Mask::from_bits(self.ends.iter().enumerate().map(failed).sum())
    }
}

impl<const N: usize> IntoIterator for InLanes<N> {
    type Item = Result<Done<f64, N>, IntegrationError<f64, N>>;
    type IntoIter = core::iter::Flatten<core::array::IntoIter<Option<Self::Item>, MOST>>;

    /// The ends, one for each lane.
    fn into_iter(self) -> Self::IntoIter {
        self.ends.into_iter().flatten()
    }
}

impl Rk4<f64> {
    /// Integrates the states in the lanes of `x0`, all from `t0` through the given times, and calls `visit` with the
    /// index, the time, the states and the lanes still going at each of them. In each lane the result is that of
    /// [`sample`](Rk4::sample) for that lane alone, to the bit; lanes no longer going hold NaN.
    ///
    /// Call it in a [`LaneTask`](crate::lanes::LaneTask).
    pub fn sample_in_lanes<L, S, V, const N: usize>(
        &self,
        system: &S,
        t0: f64,
        x0: &[L; N],
        times: &[f64],
        mut visit: V,
    ) -> InLanes<N>
    where
        L: Lanes,
        S: System<L, N> + ?Sized,
        V: FnMut(usize, f64, &[L; N], Mask),
    {
        const { assert!(L::COUNT <= MOST, "there is no room for the ends of so many lanes") };
        let mut run = Run {
            time: t0,
            state: *x0,
            statistics: Statistics::default(),
            going: Mask::all(L::COUNT),
            ends: InLanes { ends: [const { None }; MOST] },
            guard: None,
            good: (t0, *x0),
            since: 0,
        };
        for (index, &time) in times.iter().enumerate() {
            let outcome = L::vectorize(
                #[inline(always)]
                || run.go(system, time, self.step),
            );
            if let Err(cause) = outcome {
                run.fail(run.going, cause);
            }
            if run.going.is_empty() {
                break;
            }
            visit(index, time, &run.state, run.going);
        }
        if run.since > 0 {
            run.look(system);
        }
        for lane in run.going.lanes() {
            let done = Done {
                time: run.time,
                state: alone(&run.state, lane),
                outcome: Outcome::Arrived,
                statistics: run.statistics,
            };
            run.ends.ends[lane] = Some(Ok(done));
        }
        run.ends
    }

    /// Integrates the states in the lanes of `x0` from `t0` to `t1`; in each lane as [`integrate`](Rk4::integrate).
    ///
    /// ```
    /// use guen_runtime::lanes::{LaneTask, Lanes, Width, dispatch};
    /// use guen_runtime::steppers::{InLanes, Rk4};
    /// use guen_runtime::{Real, System};
    ///
    /// /// `x' = 1 / x`: it fails where it starts at zero.
    /// struct Root;
    /// impl<R: Real> System<R, 1> for Root {
    ///     fn rhs(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
    ///         [x.recip()]
    ///     }
    /// }
    ///
    /// struct Roots;
    /// impl LaneTask for Roots {
    ///     type Output = InLanes<1>;
    ///     fn run<L: Lanes>(self) -> InLanes<1> {
    ///         Rk4 { step: 0.01 }.integrate_in_lanes(&Root, 0.0, &[L::from_fn(|i| i as f64)], 1.5)
    ///     }
    /// }
    ///
    /// let ends = dispatch(Width::Four, Roots);
    /// assert_eq!(ends.failed().lanes().collect::<Vec<_>>(), [0]);
    /// // x^2 = x0^2 + 2 t
    /// let one = ends.lane(1).unwrap().unwrap();
    /// assert!((one.state[0] - 2.0).abs() < 1e-8);
    /// ```
    pub fn integrate_in_lanes<L, S, const N: usize>(
        &self,
        system: &S,
        t0: f64,
        x0: &[L; N],
        t1: f64,
    ) -> InLanes<N>
    where
        L: Lanes,
        S: System<L, N> + ?Sized,
    {
        self.sample_in_lanes(system, t0, x0, &[t1], |_, _, _, _| ())
    }
}

/// A run of all lanes.
struct Run<L, const N: usize> {
    time: f64,
    state: [L; N],
    /// The work of each lane still going.
    statistics: Statistics,
    going: Mask,
    ends: InLanes<N>,
    guard: Option<LaneGuard<L, N>>,
    /// Time and states of the last look, and the steps since then.
    good: (f64, [L; N]),
    since: u32,
}

impl<L: Lanes, const N: usize> Run<L, N> {
    /// Goes to `target`, or until no lane is going.
    #[inline(always)]
    fn go<S: System<L, N> + ?Sized>(&mut self, system: &S, target: f64, size: f64) -> Result<(), Cause> {
        if !target.is_finite() {
            return Err(Cause::Setting(Setting::Time));
        }
        if self.time == target {
            return Ok(());
        }
        let mut leg = Leg::new(self.time, target, size)?;
        while self.time != target && !self.going.is_empty() {
            let (next, h) = leg.next(self.time)?;
            let mut state = step(system, L::from_f64(self.time), &self.state, L::from_f64(h));
            self.statistics.evaluations += 4;
            let mut finite = self.going;
            for entry in &state {
                finite = finite & entry.finite();
            }
            let failed = self.going - finite;
            if !failed.is_empty() {
                self.fail(failed, Cause::NotFinite);
                // Infinity would take the slow path of sine and cosine in every further step.
                for entry in &mut state {
                    let all = *entry;
                    *entry = L::from_fn(|i| if self.going.contains(i) { all.lane(i) } else { f64::NAN });
                }
            }
            system.restore(L::from_f64(next), &mut state).map_err(|_| Cause::Positions)?;
            self.statistics.accepted += 1;
            self.time = next;
            self.state = state;
            self.since += 1;
            if self.since == EVERY {
                self.look(system);
            }
        }
        Ok(())
    }

    /// Sets lanes aside that are found out of order, with the state of the last look that found them in order.
    #[cold]
    #[inline(never)]
    fn look<S: System<L, N> + ?Sized>(&mut self, system: &S) {
        let (time, state) = self.good;
        if self.guard.is_none() {
            let (guard, faults) = LaneGuard::new(system, time, &state);
            self.guard = Some(guard);
            self.drop_faulty(&faults);
        }
        if let Some(guard) = &mut self.guard {
            let faults = guard.look(system, self.time, &self.state, self.going);
            self.drop_faulty(&faults);
        }
        self.good = (self.time, self.state);
        self.since = 0;
    }

    fn drop_faulty(&mut self, faults: &Faults) {
        let (time, state) = self.good;
        for lane in (faults.lanes & self.going).lanes() {
            let Some(cause) = faults.causes[lane] else { continue };
            let error =
                IntegrationError { time, state: alone(&state, lane), cause, statistics: self.statistics };
            self.ends.ends[lane] = Some(Err(error));
            self.going = self.going - Mask::from_bits(1 << lane);
        }
    }

    /// Sets lanes aside, with the last state that they accepted.
    #[cold]
    #[inline(never)]
    fn fail(&mut self, failed: Mask, cause: Cause) {
        for lane in failed.lanes() {
            let state = alone(&self.state, lane);
            let error = IntegrationError { time: self.time, state, cause, statistics: self.statistics };
            self.ends.ends[lane] = Some(Err(error));
        }
        self.going = self.going - failed;
    }
}

/// The state in one lane.
fn alone<L: Lanes, const N: usize>(state: &[L; N], lane: usize) -> [f64; N] {
    state.map(|entry| entry.lane(lane))
}
