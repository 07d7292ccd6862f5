use guen_runtime::lanes::{Backend, Lanes, Width};
use guen_runtime::steppers::{Integration, Rk4, Rk8};
use guen_runtime::{
    Approx7Functions, Cause, FusedOperations, Laned, Real, Setting, Simulate, SimulationError, System,
    Trajectory, Trigger,
};

use super::{End, Ensemble};

/// `q'' = sqrt(q^2 - 1) - k sin q`: it runs away, or fails where it comes below one.
#[derive(Clone, Copy, Debug)]
struct Oscillator<R>(R);

impl<R: Real> System<R, 2> for Oscillator<R> {
    #[inline]
    fn rhs(&self, _t: R, &[q, w]: &[R; 2]) -> [R; 2] {
        R::vectorize(
            #[inline(always)]
            || [w, (q * q - R::one()).sqrt().minus_times(self.0, q.sin())],
        )
    }
}

impl Simulate<f64, 2> for Oscillator<f64> {
    type State = [f64; 2];
}

impl Laned<2> for Oscillator<f64> {
    type Over<L: Lanes> = Oscillator<L>;

    fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Oscillator<L> {
        Oscillator(L::from_fn(|lane| member(lane).0))
    }
}

const METHOD: Rk4 = Rk4::new(0.03);
const TIMES: [f64; 4] = [0.0, 1.0, 2.5, 2.0];

/// Members of which some fail, at different times.
fn members(count: usize) -> impl Iterator<Item = (Oscillator<f64>, [f64; 2])> {
    (0..count).map(|i| {
        let x = (i as f64 * 0.37).sin();
        (Oscillator(1.0 + 0.5 * x), [2.0 + x, -2.0 * (i as f64 * 0.61).cos()])
    })
}

fn alone(system: &Oscillator<f64>, start: &[f64; 2], t1: f64) -> End<2> {
    Integration::new(system, 0.0, start).run(&METHOD, t1)
}

#[test]
fn ends_are_those_of_single_runs_whatever_the_lanes_and_threads() {
    let ensemble = Ensemble::of_systems(members(67));
    let expected: Vec<_> = members(67).map(|(system, start)| alone(&system, &start, 2.5)).collect();
    let failed = expected.iter().filter(|end| end.is_err()).count();
    assert!(failed > 5 && failed < 60, "{failed} of 67 fail");
    for backend in Backend::ALL {
        for width in [Width::One, Width::Four, Width::Eight] {
            for threads in [1, 2, 5] {
                let ensemble = ensemble.clone().with_threads(threads).with_lanes(backend, width);
                assert_eq!(
                    ensemble.integrate(&METHOD, 0.0, 2.5),
                    expected,
                    "{backend:?} {width:?} {threads}"
                );
            }
        }
    }
    assert_eq!(ensemble.integrate(&METHOD, 0.0, 2.5), expected);
    assert_eq!(ensemble.each(|system, start| alone(system, start, 2.5)), expected);
}

#[test]
fn simulations_are_those_of_single_members() {
    let kept = |run: Result<Trajectory<Oscillator<f64>, 2>, SimulationError<Oscillator<f64>, 2>>| match run {
        Ok(motion) => (motion.end_time(), motion.end(), motion.at(0.4), motion.events().len()),
        // The motion until then is there as well.
        Err(error) => (error.time, error.trajectory.end(), error.trajectory.at(0.4), usize::MAX),
    };
    let passes = |_: f64, &[_, w]: &[f64; 2]| w;
    let expected: Vec<_> = members(23)
        .map(|(system, start)| kept(system.simulation(&start).events([Trigger::new(passes)]).run(0.0..2.5)))
        .collect();
    let failed = expected.iter().filter(|end| end.3 == usize::MAX).count();
    assert!(failed > 2 && failed < 20, "{failed} of 23 fail");
    for threads in [1, 3] {
        let ensemble = Ensemble::of_systems(members(23)).with_threads(threads);
        let found =
            ensemble.simulations(|simulation| kept(simulation.events([Trigger::new(passes)]).run(0.0..2.5)));
        assert_eq!(found, expected, "{threads}");
        let whole = ensemble.simulate(0.0..2.5);
        let ends = whole.into_iter().map(kept).map(|(time, end, ..)| (time, end));
        assert!(ends.eq(expected.iter().map(|(time, end, ..)| (*time, *end))), "{threads}");
    }
}

#[test]
fn rk8_in_lanes_is_that_alone() {
    let method = Rk8::new(0.1);
    let ends = Ensemble::of_systems(members(35)).integrate(&method, 0.0, 2.5);
    for ((system, start), end) in members(35).zip(&ends) {
        let alone = Integration::new(&system, 0.0, &start).run(&method, 2.5);
        assert_eq!(*end, alone);
    }
    let failed = ends.iter().filter(|end| end.is_err()).count();
    assert!(failed > 5 && failed < 30, "{failed} of 35 fail");
}

#[test]
fn samples_are_those_of_single_runs() {
    let sampled = Ensemble::of_systems(members(21)).sample(&METHOD, 0.0, &TIMES);
    for ((system, start), sampled) in members(21).zip(&sampled) {
        let mut states = Vec::new();
        let end = METHOD.sample(&system, 0.0, &start, &TIMES, |_, _, state| states.push(*state));
        assert_eq!(sampled.states, states);
        assert_eq!(sampled.end, end);
        if let Err(error) = end {
            assert_eq!(error.cause, Cause::NotFinite);
        }
    }
    assert!(sampled.iter().any(|one| one.states.len() == 2), "one fails on the way");
    assert!(sampled.iter().any(|one| one.states.len() == 4), "one arrives");
}

#[test]
fn bad_settings_are_errors_of_every_member() {
    let ensemble = Ensemble::of_states(Oscillator(1.0), (0..5).map(|i| [2.0 + f64::from(i), 0.0]));
    for (step, t1, setting) in
        [(0.0, 1.0, Setting::Step), (f64::NAN, 1.0, Setting::Step), (0.1, f64::INFINITY, Setting::Time)]
    {
        let ends = ensemble.integrate(&Rk4::new(step), 0.0, t1);
        assert_eq!(ends.len(), 5);
        for (i, end) in ends.into_iter().enumerate() {
            let error = end.unwrap_err();
            assert_eq!((error.cause, error.state), (Cause::Setting(setting), [2.0 + i as f64, 0.0]));
        }
    }
}

#[test]
fn nothing_to_do_is_done() {
    let ensemble = Ensemble::of_systems(members(0));
    assert!(ensemble.is_empty() && ensemble.member(0).is_none());
    assert!(ensemble.integrate(&METHOD, 0.0, 1.0).is_empty());
    assert!(ensemble.with_threads(0).each(|_, _| ()).is_empty());
}

#[test]
fn functions_are_exchanged_on_request() {
    // Steps so long that a rounding of the rate shows in the state.
    let method = Rk4::new(0.5);
    let ensemble = Ensemble::of_states(Oscillator(1.1), (0..60).map(|i| [2.0 + 0.01 * f64::from(i), 1.0]));
    let own = ensemble.integrate(&method, 0.0, 3.0);
    let short = ensemble.clone().with_scalar::<Approx7Functions>().integrate(&method, 0.0, 3.0);
    let fused = ensemble.with_scalar::<(FusedOperations, Approx7Functions)>().integrate(&method, 0.0, 3.0);
    let state = |ends: &[End<2>], i: usize| ends[i].as_ref().unwrap().state[1];
    for i in 0..60 {
        let (own, short, fused) = (state(&own, i), state(&short, i), state(&fused, i));
        assert!(own != short && (own - short).abs() < 1e-5 && (fused - short).abs() < 1e-10);
    }
    assert!((0..60).any(|i| state(&short, i) != state(&fused, i)));
}
