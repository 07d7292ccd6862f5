//! Guards of runs in lanes: every lane ends as it would alone, with the same cause, time and state, whatever its neighbours do.

use guen_runtime::lanes::{Backend, LaneTask, Lanes, Mask, Width, dispatch_on};
use guen_runtime::prelude::*;
use guen_runtime::steppers::InLanes;
use guen_runtime::{CheckCosts, Guarded, Invariants, RunningError, Setting, checks};

/// Something to go wrong in every way that a guard knows, by the first entry of the state, which says how much of it there is.
trait Faulty {
    /// Of its edges, in right-hand sides.
    const PRICE: f64 = 0.0;

    fn rates<R: Real>(t: R, state: &[R; 3]) -> [R; 3];

    fn conserved<R: Real>(_state: &[R; 3]) -> Invariants<R> {
        Invariants::default()
    }

    fn singularities<R: Real>(_state: &[RunningError<R>; 3], _values: &mut [RunningError<R>]) -> usize {
        0
    }

    fn condition<R: Real>(_state: &[R; 3]) -> R {
        R::one()
    }
}

/// One of them. They are one type, because runs in lanes of every width and backend, once for each type, took the compiler half a
/// minute.
#[derive(Clone, Copy)]
enum Fault {
    Pole,
    Fall,
    Oscillator,
    Untold,
    Growth,
}

macro_rules! as_type {
    ($fault:expr, $F:ident => $value:expr) => {
        as_type!($fault, $F => $value, Pole Fall Oscillator Untold Growth)
    };
    ($fault:expr, $F:ident => $value:expr, $($name:ident)*) => {
        match $fault {
            $(Fault::$name => {
                type $F = $name;
                $value
            })*
        }
    };
}

impl<R: Real> System<R, 3> for Fault {
    #[inline]
    fn rhs(&self, t: R, state: &[R; 3]) -> [R; 3] {
        R::vectorize(
            #[inline(always)]
            || as_type!(self, F => F::rates(t, state)),
        )
    }

    fn guarded(&self) -> impl Guarded<R, 3> {
        self
    }
}

impl<R: Real> Guarded<R, 3> for Fault {
    fn conserved(&self, _t: R, state: &[R; 3]) -> Invariants<R> {
        as_type!(self, F => F::conserved(state))
    }

    fn singularities(
        &self,
        _t: RunningError<R>,
        state: &[RunningError<R>; 3],
        values: &mut [RunningError<R>],
    ) -> usize {
        as_type!(self, F => F::singularities(state, values))
    }

    fn condition(&self, _t: R, state: &[R; 3]) -> R {
        as_type!(self, F => F::condition(state))
    }

    fn check_costs(&self) -> CheckCosts {
        CheckCosts { singularities: as_type!(self, F => F::PRICE), ..CheckCosts::default() }
    }
}

/// Past a pole at `t = 1`, at a distance that the run begins with: a step is too long for it, or not.
struct Pole;

impl Faulty for Pole {
    const PRICE: f64 = 2.5;

    fn rates<R: Real>(t: R, &[offset, _, _]: &[R; 3]) -> [R; 3] {
        let late = t - R::one();
        let x = (offset * offset + late * late).sqrt();
        [R::zero(), late / x, offset / (x * x)]
    }

    fn singularities<R: Real>(state: &[RunningError<R>; 3], values: &mut [RunningError<R>]) -> usize {
        values[0] = RunningError::exact(R::from_ratio(3, 1));
        values[1] = state[1];
        2
    }
}

/// Through a function that must not vanish, which it reaches, or not.
struct Fall;

impl Faulty for Fall {
    fn rates<R: Real>(_t: R, &[speed, _, _]: &[R; 3]) -> [R; 3] {
        [R::zero(), -speed, R::zero()]
    }

    fn singularities<R: Real>(state: &[RunningError<R>; 3], values: &mut [RunningError<R>]) -> usize {
        values[0] = state[1];
        1
    }
}

/// An oscillator of some frequency: too fast for the step, or not. It keeps its energy.
struct Oscillator;

impl Faulty for Oscillator {
    fn rates<R: Real>(_t: R, &[omega, x, v]: &[R; 3]) -> [R; 3] {
        [R::zero(), v, -(omega * omega * x)]
    }

    fn conserved<R: Real>(&[omega, x, v]: &[R; 3]) -> Invariants<R> {
        let energy = v * v + omega * omega * x * x;
        Invariants { energy: Some(energy), scale: energy, ..Invariants::default() }
    }
}

/// The same, and nothing is known of its energy.
struct Untold;

impl Faulty for Untold {
    fn rates<R: Real>(t: R, state: &[R; 3]) -> [R; 3] {
        Oscillator::rates(t, state)
    }
}

/// Something that grows until the residual, or what it carries, or the mass matrix is beyond its limit.
struct Growth;

impl Faulty for Growth {
    fn rates<R: Real>(_t: R, &[rate, x, y]: &[R; 3]) -> [R; 3] {
        [R::zero(), rate * x, -(rate * y)]
    }

    fn conserved<R: Real>(&[_, x, y]: &[R; 3]) -> Invariants<R> {
        let gaps = [
            (RunningError::once(x) - RunningError::exact(x)),
            RunningError::once(x) - RunningError::exact(y),
        ];
        let residual = checks::furthest(&gaps) * R::from_ratio(1, 10_000);
        Invariants {
            residual,
            carried: checks::largest(&[y, R::zero(), x]) * R::from_ratio(1, 1_000),
            ..Invariants::default()
        }
    }

    fn condition<R: Real>(&[_, x, y]: &[R; 3]) -> R {
        let one = R::one();
        checks::condition::<R, 2>(&[one, one - x * y * R::from_f64(1e-5) * y, one])
    }
}

struct InEach<'a> {
    system: Fault,
    starts: &'a [[f64; 3]],
    step: f64,
    times: &'a [f64],
    /// By RK8 in place of RK4.
    eight: bool,
    guard: Guard,
}

impl LaneTask for InEach<'_> {
    type Output = Vec<(InLanes<3>, usize)>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let groups = self.starts.chunks_exact(L::COUNT);
        groups
            .map(|group| {
                let start = core::array::from_fn(|i| L::from_fn(|lane| group[lane][i]));
                let mut visits = 0;
                let visit = |_: usize, _: f64, state: &[L; 3], going: Mask| {
                    visits += going.lanes().count();
                    for lane in 0..L::COUNT {
                        let finite = state.iter().all(|entry| entry.lane(lane).is_finite());
                        assert_eq!(going.contains(lane), finite);
                    }
                };
                let Self { system, step, times, guard, .. } = &self;
                let ends = if self.eight {
                    Rk8::new(*step).guarded_in_lanes(system, (0.0, &start), times, *guard, visit)
                } else {
                    Rk4::new(*step).guarded_in_lanes(system, (0.0, &start), times, *guard, visit)
                };
                (ends, visits)
            })
            .collect()
    }
}

/// Miri is some thousand times as slow: it sees every path with fewer starts, in as many as there are lanes, and longer steps.
const SLOW: bool = cfg!(miri);

/// So many starts by their number.
fn starts(count: usize, start: impl Fn(i32) -> [f64; 3]) -> Vec<[f64; 3]> {
    let (count, apart) = if SLOW { (8, 5) } else { (count, 1) };
    (0..count as i32).map(|k| start(apart * k)).collect()
}

/// One lane is a number, of which Miri learns nothing new.
const WIDTHS: &[Width] =
    if SLOW { &[Width::Four, Width::Eight] } else { &[Width::One, Width::Four, Width::Eight] };

/// How many of the starts have to arrive, and how many to fail.
const SOME: usize = if SLOW { 1 } else { 6 };

/// Compares the ends in lanes with those alone, of both methods; returns how many arrived, and the causes of the others.
fn compare(system: Fault, starts: &[[f64; 3]], step: f64, times: &[f64]) -> (usize, Vec<Cause>) {
    let mut causes = Vec::new();
    for eight in [false, true] {
        let mut visits = 0;
        let alone: Vec<_> = starts
            .iter()
            .map(|start| {
                let visit = |_: usize, _: f64, _: &[f64; 3]| visits += 1;
                if eight {
                    Rk8::new(step).sample(&system, 0.0, start, times, visit)
                } else {
                    Rk4::new(step).sample(&system, 0.0, start, times, visit)
                }
            })
            .collect();
        // Of Miri only what it can see: registers, where the target has them.
        let again = |backend: &Backend| !SLOW || *backend == Backend::best();
        for backend in Backend::ALL.into_iter().filter(again) {
            for width in WIDTHS.iter().copied() {
                let task = InEach { system, starts, step, times, eight, guard: Guard::default() };
                let ends = dispatch_on(backend, width, task);
                assert_eq!(ends.iter().map(|(_, visits)| visits).sum::<usize>(), visits);
                let ends: Vec<_> = ends.into_iter().flat_map(|(ends, _)| ends).collect();
                // As texts, for NaN is equal to nothing; they have all digits.
                assert_eq!(format!("{ends:?}"), format!("{alone:?}"), "{backend:?} {width:?} {eight}");
            }
        }
        causes.extend(alone.iter().filter_map(|end| Some(end.as_ref().err()?.cause)));
    }
    (2 * starts.len() - causes.len(), causes)
}

#[test]
fn a_pole_that_a_step_passes() {
    let offset = |k: i32| 10.0_f64.powf(-0.5 - 0.2 * f64::from(k % 16));
    let starts = starts(32, |k| [offset(k), (1.0 + offset(k).powi(2)).sqrt(), 0.0]);
    let steps = if SLOW { &[0.05][..] } else { &[0.01, 0.0099, 0.0137] };
    for &step in steps {
        let (arrived, causes) = compare(Fault::Pole, &starts, step, &[0.5, 2.0]);
        assert!(arrived >= SOME && causes.len() >= SOME, "{arrived}");
        assert!(causes.iter().all(|cause| matches!(
            cause,
            Cause::ApproachingSingularity { function: 1, .. } | Cause::Step { .. }
        )));
        assert!(causes.iter().any(|cause| matches!(cause, Cause::ApproachingSingularity { .. })));
    }
}

#[test]
fn an_edge_that_some_come_to() {
    let starts = starts(24, |k| [f64::from(k % 7) * 0.3, 1.0, 0.0]);
    let (arrived, causes) = compare(Fault::Fall, &starts, if SLOW { 0.02 } else { 0.003 }, &[0.4, 0.4, 1.3]);
    assert!(arrived >= SOME && causes.len() >= SOME);
    assert!(
        causes.iter().all(|cause| matches!(
            cause,
            Cause::ChartSingularity { .. } | Cause::ApproachingSingularity { .. }
        )),
        "{causes:?}"
    );
}

#[test]
fn steps_that_are_too_long_for_some() {
    let starts = starts(32, |k| [1.3_f64.powi(k % 17), 1.0, 0.2 * f64::from(k)]);
    let mut steps = 0;
    let runs = [(0.02, 0.02), (0.1, 0.3), (0.02, 6.0), (0.05, 3.01)];
    for (step, span) in runs.into_iter().take(if SLOW { 2 } else { 4 }) {
        let (_, causes) = compare(Fault::Oscillator, &starts, step, &[span]);
        assert!(causes.iter().any(|cause| matches!(cause, Cause::Energy { .. } | Cause::Step { .. })));
        let (_, causes) = compare(Fault::Untold, &starts, step, &[span / 3.0, span]);
        steps += causes.iter().filter(|cause| matches!(cause, Cause::Step { .. })).count();
        // Back to the start, and nothing at all.
        compare(Fault::Untold, &starts, step, &[span, 0.0]);
        compare(Fault::Untold, &starts, step, &[0.0]);
    }
    assert!(steps > if SLOW { 0 } else { 20 }, "{steps}");
    // Some grow out of range before anybody looks again, and one was no number from the beginning.
    let mut starts = starts;
    starts[5][1] = f64::NAN;
    let (_, causes) = compare(Fault::Untold, &starts, 3e9, &[1.5e11]);
    assert!(causes.contains(&Cause::NotFinite));
}

#[test]
fn residuals_carried_functions_and_conditions_of_every_lane() {
    let starts = starts(32, |k| [0.1 + 0.07 * f64::from(k % 13), 1.0 + f64::from(k % 3), 3.0]);
    let (arrived, causes) = compare(Fault::Growth, &starts, if SLOW { 0.1 } else { 0.01 }, &[3.0, 5.0]);
    assert!(arrived > 0 && causes.len() >= SOME, "{arrived} {causes:?}");
    // The first one that must be seen is that of a lane which is not the first.
    let names = |cause: &Cause| {
        matches!(cause, Cause::Residual { .. } | Cause::Carried { .. } | Cause::Condition { .. })
    };
    assert!(causes.iter().all(names), "{causes:?}");
}

#[test]
fn times_that_are_none() {
    let starts = [[1.0, 1.0, 0.0]; 8];
    let (_, causes) = compare(Fault::Untold, &starts, 0.02, &[1.0, f64::NAN]);
    assert!(causes.iter().all(|cause| matches!(cause, Cause::Setting(Setting::Time))) && causes.len() == 16);
    let (_, causes) = compare(Fault::Untold, &starts, 0.0, &[1.0]);
    assert!(causes.iter().all(|cause| matches!(cause, Cause::Setting(Setting::Step))) && causes.len() == 16);
}

#[test]
fn limits_are_those_of_the_guard() {
    let starts = starts(16, |k| [1.0 + 0.3 * f64::from(k), 1.0, 0.0]);
    let strict = Guard { energy: 1e-12, step: 1e-12, every: Some(3), ..Guard::default() };
    let wrong = Guard { singularity: f64::NAN, ..Guard::default() };
    let system = Fault::Oscillator;
    let times = [2.0];
    let mut failed = Vec::new();
    for guard in [strict, Guard::FINITE, wrong] {
        for eight in [false, true] {
            let alone: Vec<_> = starts
                .iter()
                .map(|start| {
                    let run = Integration::new(&system, 0.0, start).guard(guard);
                    if eight { run.run(&Rk8::new(0.05), 2.0) } else { run.run(&Rk4::new(0.05), 2.0) }
                })
                .collect();
            for width in [Width::Four, Width::Eight] {
                let task = InEach { system, starts: &starts, step: 0.05, times: &times, eight, guard };
                let ends: Vec<_> = dispatch_on(Backend::best(), width, task)
                    .into_iter()
                    .flat_map(|(ends, _)| ends)
                    .collect();
                assert_eq!(ends, alone);
            }
            failed.push(alone.iter().filter(|end| end.is_err()).count());
        }
    }
    assert!(2 * failed[0] > starts.len() && failed[1] > 0 && failed[1] < failed[0], "{failed:?}");
    assert_eq!(failed[2..], [0, 0, starts.len(), starts.len()]);
}

/// With lanes as the real, in a run that has one end for all lanes.
struct Together<'a> {
    system: Fault,
    starts: &'a [[f64; 3]],
    step: f64,
    span: f64,
    eight: bool,
}

impl LaneTask for Together<'_> {
    /// How many lanes, and for each group of starts the time and cause of its error, if it has one.
    type Output = (usize, Vec<Option<(f64, Cause)>>);

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let Self { system, starts, step, span, eight } = self;
        let groups = starts.chunks_exact(L::COUNT).map(|group| {
            let start = core::array::from_fn(|i| L::from_fn(|lane| group[lane][i]));
            let run = Integration::new(&system, L::zero(), &start);
            let (step, end) = (L::from_f64(step), L::from_f64(span));
            let end = if eight { run.run(&Rk8::new(step), end) } else { run.run(&Rk4::new(step), end) };
            end.err().map(|error| (error.time.to_f64(), error.cause))
        });
        (L::COUNT, groups.collect())
    }
}

/// A run of all lanes ends with the first fault of one of them, and returns the last look at which all were in order.
fn compare_together(system: Fault, starts: &[[f64; 3]], step: f64, span: f64) -> usize {
    let mut failed = 0;
    for eight in [false, true] {
        let alone: Vec<_> = starts
            .iter()
            .map(|start| {
                let run = Integration::new(&system, 0.0, start);
                let end = if eight { run.run(&Rk8::new(step), span) } else { run.run(&Rk4::new(step), span) };
                end.err().map(|error| (error.time, error.cause))
            })
            .collect();
        for width in WIDTHS.iter().copied() {
            let task = Together { system, starts, step, span, eight };
            let (lanes, ends) = dispatch_on(Backend::best(), width, task);
            for (group, end) in alone.chunks_exact(lanes).zip(ends) {
                let faults = || group.iter().flatten();
                let first = faults().map(|(time, _)| *time).fold(f64::INFINITY, f64::min);
                match end {
                    None => assert_eq!(faults().count(), 0, "{width:?} {eight} {group:?}"),
                    // As texts, for NaN is equal to nothing.
                    Some((time, cause)) => {
                        let expected = faults()
                            .filter(|(time, _)| *time == first)
                            .map(|(_, cause)| format!("{cause:?}"));
                        let expected: Vec<_> = expected.collect();
                        assert_eq!(time, first, "{width:?} {eight}: {cause:?}");
                        assert!(
                            expected.contains(&format!("{cause:?}")),
                            "{width:?} {eight}: {cause:?} {expected:?}"
                        );
                        failed += usize::from(group[0].is_none());
                    }
                }
            }
        }
    }
    // Those in which the first lane was in order.
    failed
}

#[test]
fn with_lanes_as_the_real_a_fault_of_any_lane_ends_the_run() {
    // Of every eight and every four one is at fault, and never the first one.
    let oscillators = starts(32, |k| [if k % 4 == 3 { 30.0 } else { 1.0 }, 1.0, 0.2 * f64::from(k)]);
    let found = compare_together(Fault::Oscillator, &oscillators, 0.03, 1.5);
    assert!(found >= SOME, "{found}");
    let found = compare_together(Fault::Untold, &oscillators, 0.1, 6.0);
    assert!(found >= SOME, "{found}");
    let growing = starts(32, |k| [if k % 4 == 1 { 0.9 } else { 0.1 }, 1.0 + f64::from(k % 3), 3.0]);
    let found = compare_together(Fault::Growth, &growing, if SLOW { 0.1 } else { 0.01 }, 3.0);
    assert!(found >= SOME, "{found}");
    let falls = starts(32, |k| [if k % 4 == 2 { 1.1 } else { 0.1 }, 1.0, 0.0]);
    let found = compare_together(Fault::Fall, &falls, if SLOW { 0.02 } else { 0.003 }, 1.3);
    assert!(found >= SOME, "{found}");
    let mut missing = oscillators;
    missing.iter_mut().for_each(|start| start[0] = 1.0);
    missing[5][1] = f64::NAN;
    // One of them, in one group of either width, by both methods.
    assert_eq!(compare_together(Fault::Untold, &missing, 0.05, 1.5), 4);
}
