//! Runs with a fixed step in lanes: as many trajectories as there are lanes, each with its own end.
//!
//! All lanes share their times, which are those of a run in plain `f64`, and so are the states, to the bit. A lane that
//! fails is set aside with its error, and the others go on.

use crate::numbers::lanes::{Lanes, Mask};
use crate::steppers::driver::error::{Cause, IntegrationError, Setting};
use crate::steppers::driver::run::{Checkpoint, IntegrationResult, Outcome};
use crate::steppers::driver::statistics::Statistics;
use crate::steppers::entries;
use crate::steppers::explicit::fixed::Leg;
use crate::steppers::guard::{Each, Guard, MOST, TimeAndState, Watch};
use crate::system::System;

/// A time and the states in all lanes.
#[derive(Clone, Copy)]
pub(in crate::steppers) struct Moment<L, const N: usize> {
    pub time: f64,
    pub state: [L; N],
}

impl<L: Lanes, const N: usize> Moment<L, N> {
    pub(crate) fn checkpoint(&self) -> Checkpoint<L, N> {
        Checkpoint::new(L::from_f64(self.time), &self.state)
    }

    fn place(&self) -> TimeAndState<'_, L, N> {
        TimeAndState { time: L::from_f64(self.time), state: &self.state }
    }
}

/// A formula that makes steps in lanes, of a method whose settings are those of all lanes.
pub(in crate::steppers) trait LaneFormula<L: Lanes, S: ?Sized, const N: usize> {
    /// The memory of a step, for the estimate of its error.
    type Memory;

    /// The formula over lanes.
    type Ready;

    /// Evaluations of the right-hand side in a step.
    const EVALUATIONS: u32;

    /// The formula with its numbers in lanes, the step, and an empty memory.
    fn ready(&self) -> (Self::Ready, f64, Self::Memory);

    /// The states one step further. With `keep` the memory is written.
    fn step(
        ready: &Self::Ready,
        system: &S,
        memory: &mut Self::Memory,
        from: (L, &[L; N]),
        h: L,
        keep: bool,
    ) -> [L; N];

    /// The estimated errors of the step that was made last, and kept.
    fn defect(
        ready: &Self::Ready,
        system: &S,
        memory: &Self::Memory,
        before: &Moment<L, N>,
        now: &Moment<L, N>,
    ) -> [L; N];
}

/// The ends of the trajectories in lanes.
#[derive(Clone, Debug, PartialEq)]
pub struct InLanes<const N: usize> {
    ends: [Option<Result<IntegrationResult<f64, N>, IntegrationError<f64, N>>>; MOST],
}

impl<const N: usize> InLanes<N> {
    fn none() -> Self {
        Self { ends: [const { None }; MOST] }
    }

    /// The end of the trajectory in a lane; none if there is no such lane.
    pub fn lane(&self, lane: usize) -> Option<&Result<IntegrationResult<f64, N>, IntegrationError<f64, N>>> {
        self.ends.get(lane)?.as_ref()
    }

    /// The lanes whose trajectory failed.
    pub fn failed(&self) -> Mask {
        let failed = |(lane, end): (usize, &Option<_>)| u32::from(matches!(end, Some(Err(_)))) << lane;
        Mask::from_bits(self.ends.iter().enumerate().map(failed).sum())
    }
}

impl<const N: usize> IntoIterator for InLanes<N> {
    type Item = Result<IntegrationResult<f64, N>, IntegrationError<f64, N>>;
    type IntoIter = core::iter::Flatten<core::array::IntoIter<Option<Self::Item>, MOST>>;

    /// The ends, one for each lane.
    fn into_iter(self) -> Self::IntoIter {
        self.ends.into_iter().flatten()
    }
}

/// A method that integrates in lanes: [`Rk4`](crate::steppers::Rk4) and [`Rk8`](crate::steppers::Rk8).
///
/// All lanes have the same times; in each the result is that of a run for that lane alone, to the bit, errors included. Call it
/// in a [`LaneTask`](crate::numbers::lanes::LaneTask).
///
/// ```
/// use guen_runtime::lanes::{LaneTask, Lanes, Width, dispatch};
/// use guen_runtime::steppers::{Guard, InLanes, LaneMethod, Rk4, Rk8};
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
/// struct Roots<M>(M, Guard);
/// impl<M: LaneMethod> LaneTask for Roots<M> {
///     type Output = InLanes<1>;
///     fn run<L: Lanes>(self) -> InLanes<1> {
///         let start = [L::from_fn(|i| i as f64)];
///         self.0.guarded_in_lanes(&Root, (0.0, &start), &[1.5], self.1, |_, _, _, _| ())
///     }
/// }
///
/// let ends = dispatch(Width::Four, Roots(Rk4::new(0.01), Guard::default()));
/// assert_eq!(ends.failed().lanes().collect::<Vec<_>>(), [0]);
/// // x^2 = x0^2 + 2 t
/// assert!((ends.lane(1).unwrap().unwrap().state[0] - 2.0).abs() < 1e-8);
///
/// let ends = dispatch(Width::Four, Roots(Rk8::new(0.01), Guard::default()));
/// assert!((ends.lane(1).unwrap().unwrap().state[0] - 2.0).abs() < 1e-12);
///
/// let strict = Guard { step: 1e-16, ..Guard::default() };
/// assert_eq!(dispatch(Width::Four, Roots(Rk4::new(0.01), strict)).failed().lanes().count(), 4);
/// ```
pub trait LaneMethod {
    /// The step, in units of time.
    fn step(&self) -> f64;

    /// Integrates the states in the lanes of `x0`, all from `t0` through the given times, and calls `visit` with the index, the
    /// time, the states and the lanes still going at each of them. In each lane the result is that of an
    /// [`Integration`](crate::steppers::Integration) with this guard that [lands](crate::steppers::Integration::run_through) on the
    /// same times; lanes no longer going hold NaN.
    fn guarded_in_lanes<L, S, V, const N: usize>(
        &self,
        system: &S,
        start: (f64, &[L; N]),
        times: &[f64],
        guard: Guard,
        visit: V,
    ) -> InLanes<N>
    where
        L: Lanes,
        S: System<L, N> + ?Sized,
        V: FnMut(usize, f64, &[L; N], Mask);

    /// Integrates through the given times with the default guard, as [`guarded_in_lanes`](LaneMethod::guarded_in_lanes).
    fn sample_in_lanes<L, S, V, const N: usize>(
        &self,
        system: &S,
        t0: f64,
        x0: &[L; N],
        times: &[f64],
        visit: V,
    ) -> InLanes<N>
    where
        L: Lanes,
        S: System<L, N> + ?Sized,
        V: FnMut(usize, f64, &[L; N], Mask),
    {
        self.guarded_in_lanes(system, (t0, x0), times, Guard::default(), visit)
    }

    /// Integrates the states in the lanes of `x0` from `t0` to `t1` with the default guard.
    fn integrate_in_lanes<L, S, const N: usize>(
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

/// Makes a method with a formula for lanes a [`LaneMethod`].
macro_rules! in_lanes {
    ($Method:ident) => {
        impl $crate::steppers::LaneMethod for $Method {
            fn step(&self) -> f64 {
                self.step
            }

            fn guarded_in_lanes<L, S, V, const N: usize>(
                &self,
                system: &S,
                start: (f64, &[L; N]),
                times: &[f64],
                guard: $crate::steppers::Guard,
                visit: V,
            ) -> $crate::steppers::InLanes<N>
            where
                L: Lanes,
                S: System<L, N> + ?Sized,
                V: FnMut(usize, f64, &[L; N], $crate::numbers::lanes::Mask),
            {
                $crate::steppers::explicit::lanes::run(self, system, start, times, guard, visit)
            }
        }
    };
}
pub(in crate::steppers) use in_lanes;

/// Runs a method in lanes: see [`LaneMethod::guarded_in_lanes`].
pub(in crate::steppers) fn run<M, L, S, V, const N: usize>(
    method: &M,
    system: &S,
    (t0, x0): (f64, &[L; N]),
    times: &[f64],
    guard: Guard,
    mut visit: V,
) -> InLanes<N>
where
    M: LaneFormula<L, S, N>,
    L: Lanes,
    S: System<L, N> + ?Sized,
    V: FnMut(usize, f64, &[L; N], Mask),
{
    const { assert!(L::COUNT <= MOST, "there is no room for the ends of so many lanes") };
    let start = Moment { time: t0, state: *x0 };
    let mut lanes =
        Going { lanes: Mask::all(L::COUNT), statistics: Statistics::default(), ends: InLanes::none() };
    if let Err(cause) = guard.check() {
        lanes.fail_all(cause, start.place());
        return lanes.ends;
    }
    let watch = Watch::new(guard, system, M::EVALUATIONS, true, start.place());
    let (formula, step, memory) = method.ready();
    let mut run: Run<'_, M, L, S, N> =
        Run { system, formula, memory, now: start, before: start, kept: false, lanes, watch };
    for (index, &time) in times.iter().enumerate() {
        if !t0.is_finite() || !time.is_finite() {
            run.lanes.fail_all(Cause::Setting(Setting::Time), run.now.place());
        }
        let outcome = L::vectorize(
            #[inline(always)]
            || run.go(time, step, index + 1 == times.len()),
        );
        if let Err(cause) = outcome {
            run.stop(run.lanes.lanes, cause);
        }
        if run.lanes.lanes.is_empty() {
            break;
        }
        visit(index, time, &run.now.state, run.lanes.lanes);
    }
    run.finish()
}

/// The lanes that are going, and the ends of the others.
struct Going<const N: usize> {
    lanes: Mask,
    /// The work of each of them.
    statistics: Statistics,
    ends: InLanes<N>,
}

impl<const N: usize> Going<N> {
    /// Sets a lane aside, with the last place at which it was in order.
    #[cold]
    fn fail<L: Lanes>(&mut self, lane: usize, cause: Cause, good: TimeAndState<'_, L, N>) {
        let state = entries(|i| good.state[i].lane(lane));
        let error = IntegrationError { time: good.time.to_f64(), state, cause, statistics: self.statistics };
        self.ends.ends[lane] = Some(Err(error));
        self.lanes = self.lanes - Mask::from_bits(0).with(lane);
    }

    fn fail_all<L: Lanes>(&mut self, cause: Cause, good: TimeAndState<'_, L, N>) {
        for lane in self.lanes.lanes() {
            self.fail(lane, cause, good);
        }
    }
}

/// A run of all lanes.
struct Run<'a, M: LaneFormula<L, S, N>, L: Lanes, S: ?Sized, const N: usize> {
    system: &'a S,
    formula: M::Ready,
    memory: M::Memory,
    now: Moment<L, N>,
    /// The beginning of the last step, if it was `kept`.
    before: Moment<L, N>,
    kept: bool,
    lanes: Going<N>,
    watch: Watch<L, Each, N>,
}

impl<M, L, S, const N: usize> Run<'_, M, L, S, N>
where
    M: LaneFormula<L, S, N>,
    L: Lanes,
    S: System<L, N> + ?Sized,
{
    /// Goes to `target`, or until no lane is going.
    #[inline(always)]
    fn go(&mut self, target: f64, size: f64, last: bool) -> Result<(), Cause> {
        if self.now.time == target || self.lanes.lanes.is_empty() {
            return Ok(());
        }
        let mut leg = Leg::new(self.now.time, target, size)?;
        while self.now.time != target && !self.lanes.lanes.is_empty() {
            self.kept = last && leg.is_last() || self.watch.is_next();
            if self.kept {
                self.before = self.now;
            }
            let (next, h) = leg.next(self.now.time)?;
            let from = (L::from_f64(self.now.time), &self.now.state);
            let mut state =
                M::step(&self.formula, self.system, &mut self.memory, from, L::from_f64(h), self.kept);
            self.lanes.statistics.evaluations += u64::from(M::EVALUATIONS);
            let mut finite = self.lanes.lanes;
            for entry in &state {
                finite = finite & entry.finite();
            }
            let failed = self.lanes.lanes - finite;
            if !failed.is_empty() {
                self.stop(failed, Cause::NotFinite);
                bury(&mut state, self.lanes.lanes);
            }
            self.system.restore(L::from_f64(next), &mut state).map_err(Cause::of_positions)?;
            self.lanes.statistics.accepted += 1;
            self.now = Moment { time: next, state };
            if self.watch.counts(1) {
                self.check();
            }
        }
        Ok(())
    }

    #[inline(never)]
    fn check(&mut self) {
        let Self { system, formula, memory, now, before, lanes, watch, .. } = self;
        let going = lanes.lanes;
        let defects = || M::defect(formula, *system, memory, before, now);
        let left = L::vectorize(
            #[inline(always)]
            || {
                let (step, now) = ((Some(before.place()), defects), now.place());
                watch.check(*system, step, now, going, |lane, cause, good| lanes.fail(lane, cause, good))
            },
        );
        if left != going {
            bury(&mut now.state, left);
        }
    }

    /// The ends of all lanes, once the last check has found them in order.
    fn finish(mut self) -> InLanes<N> {
        let Self { system, formula, memory, now, before, kept, lanes, watch } = &mut self;
        let going = lanes.lanes;
        if !going.is_empty() {
            let defects = || M::defect(formula, *system, memory, before, now);
            let step = (kept.then_some(before.place()), defects);
            watch
                .finish(*system, step, now.place(), going, |lane, cause, good| lanes.fail(lane, cause, good));
        }
        for lane in lanes.lanes.lanes() {
            let done = IntegrationResult {
                time: now.time,
                state: entries(|i| now.state[i].lane(lane)),
                outcome: Outcome::Arrived,
                statistics: lanes.statistics,
            };
            lanes.ends.ends[lane] = Some(Ok(done));
        }
        self.lanes.ends
    }

    /// Ends lanes that cannot go on from the last state that they accepted.
    #[cold]
    #[inline(never)]
    fn stop(&mut self, stopped: Mask, cause: Cause) {
        let Self { system, now, lanes, watch, .. } = self;
        watch
            .stopped(*system, now.place(), stopped, cause, |lane, cause, good| lanes.fail(lane, cause, good));
    }
}

/// Makes NaN of lanes that are no longer going: of infinity and large numbers sine and cosine would take a longer path in every
/// further step.
#[cold]
fn bury<L: Lanes, const N: usize>(state: &mut [L; N], going: Mask) {
    for entry in state {
        let all = *entry;
        *entry = L::from_fn(|i| if going.contains(i) { all.lane(i) } else { f64::NAN });
    }
}
