//! What implicit methods are for: rates of damping far beyond the motion, runs backwards, invariants; and how explicit
//! methods say that they are not.

use core::ops::ControlFlow;

use guen_runtime::prelude::*;
use guen_runtime::steppers::Method;
use guen_runtime::{Equations, Generic, generic};

fn go_on<const N: usize>(_: f64, _: &[f64; N]) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// A velocity that is damped at a rate of a million towards `cos t`, and a position that follows it.
///
/// ```text
/// v' = -D (v - cos t) - sin t      x' = v      v = cos t, x = sin t once the transient is over
/// ```
struct Damped;

const RATE: i64 = 1_000_000;

impl Equations<2> for Damped {
    fn rates<R: Real>(&self, t: R, &[_, v]: &[R; 2]) -> [R; 2] {
        let (sin, cos) = t.sin_cos();
        [v, -R::from_ratio(RATE, 1) * (v - cos) - sin]
    }
}

/// The motion from `x = 0`, `v = 1 + kick`.
fn exact(t: f64, kick: f64) -> [f64; 2] {
    let decay = (-(RATE as f64) * t).exp();
    [t.sin() + kick * (1.0 - decay) / RATE as f64, t.cos() + kick * decay]
}

#[test]
fn damping_of_a_million_is_no_matter_for_radau() {
    for kick in [0.0, 10.0] {
        let mut between = 0.0_f64;
        let times: Vec<f64> = (1..=40).map(|k| 0.25 * f64::from(k)).collect();
        let done = Integration::new(&generic(Damped), 0.0, &[0.0, 1.0 + kick])
            .sample(&times, &mut |_, t, x| {
                let expected = exact(t, kick);
                between = between.max((x[0] - expected[0]).abs()).max((x[1] - expected[1]).abs());
            })
            .run(&Radau5::new(1e-8, 1e-8), 10.0)
            .unwrap();
        println!("kick {kick}: {between:.1e} between, {:?}", done.statistics);
        assert!(between < 1e-6, "kick {kick}: {between:e}");
        // An explicit method needs at least three million evaluations.
        assert!(done.statistics.evaluations < 4000, "{:?}", done.statistics);
        assert!(done.statistics.jacobians < 150, "{:?}", done.statistics);
    }
}

#[test]
fn damping_of_a_million_is_stable_with_gauss() {
    // On the slow motion; steps of 2e4 times the time of the damping. Stiffness costs Gauss's methods some order.
    for error in [
        Gauss4::new(0.02).integrate(&generic(Damped), 0.0, &[0.0, 1.0], 10.0, go_on),
        Gauss6::new(0.02).integrate(&generic(Damped), 0.0, &[0.0, 1.0], 10.0, go_on),
    ] {
        let done = error.unwrap();
        let expected = exact(10.0, 0.0);
        let off = (done.state[0] - expected[0]).abs().max((done.state[1] - expected[1]).abs());
        println!("{off:.1e} {:?}", done.statistics);
        assert!(off < 1e-4, "{off:e}");
    }
}

#[test]
fn explicit_methods_report_that_the_system_is_stiff() {
    let system = generic(Damped);
    let error = Rk4::new(1e-3).integrate(&system, 0.0, &[0.0, 2.0], 10.0, go_on).unwrap_err();
    assert!(matches!(error.cause, Cause::Step { .. }), "{error}");
    assert_eq!((error.time, error.state), (0.0, [0.0, 2.0]));
    let unguarded = Integration::new(&system, 0.0, &[0.0, 2.0]).guard(Guard::FINITE);
    let error = unguarded.run(&Rk4::new(1e-3), 10.0).unwrap_err();
    assert_eq!(error.cause, Cause::NotFinite);
    assert!(error.time > 0.0 && error.state.iter().all(|x| x.is_finite()));
    let error = Dop853::new(1e-8, 1e-8).integrate(&system, 0.0, &[0.0, 2.0], 10.0, go_on).unwrap_err();
    assert_eq!(error.cause, Cause::TooManySteps { limit: Dop853::<f64>::MAX_STEPS });
    // What it did until then is right.
    let expected = exact(error.time, 1.0);
    assert!(error.time > 0.1 && (error.state[1] - expected[1]).abs() < 1e-7);
}

/// Van der Pol's oscillator with `mu = 1000`, in Hairer and Wanner's scaling: relaxation between two slow branches.
struct VanDerPol;

impl Equations<2> for VanDerPol {
    fn rates<R: Real>(&self, _t: R, &[x, v]: &[R; 2]) -> [R; 2] {
        [v, R::from_ratio(1_000_000, 1) * ((R::one() - x * x) * v - x)]
    }
}

#[test]
fn relaxation_oscillations_are_followed() {
    // The state at t = 2, as printed in Hairer and Wanner's book for epsilon = 1e-6, to eleven digits.
    let done =
        Radau5::new(1e-10, 1e-10).integrate(&generic(VanDerPol), 0.0, &[2.0, 0.0], 2.0, go_on).unwrap();
    println!("{:?} {:?}", done.state, done.statistics);
    assert!((done.state[0] - 1.706_167_732_170_469).abs() < 1e-7, "{:?}", done.state);
    assert!((done.state[1] + 0.892_809_701_024_797_6).abs() < 1e-6, "{:?}", done.state);
}

/// A pendulum, for runs there and back.
struct Pendulum;

impl Equations<2> for Pendulum {
    fn rates<R: Real>(&self, _t: R, &[angle, speed]: &[R; 2]) -> [R; 2] {
        [speed, -angle.sin()]
    }
}

#[test]
fn runs_go_back_to_where_they_came_from() {
    fn check<M: Method<f64, Generic<Pendulum>, 2>>(name: &str, method: &M, bound: f64) {
        let start = [1.0, 0.5];
        let there = Integration::new(&generic(Pendulum), 0.0, &start).run(method, 20.0).unwrap();
        let back = Integration::new(&generic(Pendulum), 20.0, &there.state).run(method, 0.0).unwrap();
        let off = (back.state[0] - start[0]).abs().max((back.state[1] - start[1]).abs());
        println!("{name}: {off:.1e}");
        assert!(back.time == 0.0 && off < bound, "{name}: {off:e}");
    }
    check("RK4", &Rk4::new(0.01), 1e-7);
    check("RK8", &Rk8::new(0.1), 1e-9);
    check("DOP853", &Dop853::new(1e-13, 1e-13), 1e-10);
    check("Tsit5", &Tsit5::new(1e-13, 1e-13), 1e-10);
    check("Radau 5", &Radau5::new(1e-12, 1e-12), 1e-9);
    // Symmetric methods retrace their steps, however coarse: what is left is rounding.
    check("Gauss 4", &Gauss4::new(0.25), 1e-12);
    check("Gauss 6", &Gauss6::new(0.25), 1e-12);
}

#[test]
fn gauss_keeps_quadratic_invariants_and_runge_and_kutta_do_not() {
    /// A free top in body axes: energy and momentum are quadratic.
    struct Top;
    impl Equations<3> for Top {
        fn rates<R: Real>(&self, _t: R, &[p, q, r]: &[R; 3]) -> [R; 3] {
            let ratio = |n| R::from_ratio(n, 6);
            // Moments of inertia 1, 2, 3.
            [-q * r, r * p, -ratio(2) * p * q]
        }
    }
    let momentum = |[p, q, r]: [f64; 3]| p * p + 4.0 * q * q + 9.0 * r * r;
    let start = [1.0, 0.2, 0.5];
    let drift = |end: [f64; 3]| (momentum(end) / momentum(start) - 1.0).abs();
    let four = Gauss4::new(0.2).integrate(&generic(Top), 0.0, &start, 1000.0, go_on).unwrap();
    let six = Gauss6::new(0.2).integrate(&generic(Top), 0.0, &start, 1000.0, go_on).unwrap();
    let rk4 = Rk4::new(0.2).integrate(&generic(Top), 0.0, &start, 1000.0, go_on).unwrap();
    println!("{:.1e} {:.1e} {:.1e}", drift(four.state), drift(six.state), drift(rk4.state));
    assert!(drift(four.state) < 1e-12 && drift(six.state) < 1e-12);
    assert!(drift(rk4.state) > 1e-6, "the comparison says nothing");
}

#[test]
fn equations_that_cannot_be_solved_are_reported() {
    // x' = x^2 from 1 has its pole at 1; a step of 3 beyond it has no real solution of the method's equations.
    struct Pole;
    impl Equations<1> for Pole {
        fn rates<R: Real>(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
            [x * x]
        }
    }
    let error = Gauss4::new(3.0).integrate(&generic(Pole), 0.0, &[1.0], 3.0, go_on).unwrap_err();
    assert_eq!((error.cause, error.time, error.state), (Cause::NoConvergence, 0.0, [1.0]));
    let error = Radau5::new(1e-8, 1e-8).integrate(&generic(Pole), 0.0, &[1.0], 3.0, go_on).unwrap_err();
    assert!(
        matches!(error.cause, Cause::NoConvergence | Cause::StepUnderflow | Cause::NotFinite),
        "{:?}",
        error.cause
    );
    assert!((error.time - 1.0).abs() < 1e-3 && error.state[0].is_finite());
}

#[test]
fn bounded_work_never_exceeds_its_bound_and_says_what_it_left() {
    let system = generic(Pendulum);
    let start = [1.0, 0.5];
    let reference = Dop853::new(1e-14, 1e-14).integrate(&system, 0.0, &start, 0.5, go_on).unwrap().state;
    let mut last = f64::INFINITY;
    for (evaluations, steps) in [(12, 1), (23, 1), (24, 2), (100, 8)] {
        let bounded = Bounded::dop853(evaluations);
        let found = bounded.advance(&system, 0.0, &start, 0.5).unwrap();
        assert_eq!((found.statistics.accepted, bounded.steps()), (steps, steps as u32));
        assert!(found.statistics.evaluations <= u64::from(evaluations));
        let error = found.error.unwrap();
        for ((x, expected), error) in found.state.iter().zip(reference).zip(error) {
            let off = (x - expected).abs();
            // The bound is of truncation: of states of about one each step leaves a rounding, here and in the reference.
            let rounding = f64::EPSILON * (steps + 1) as f64;
            assert!(off <= error + rounding, "{evaluations}: {off:e} {error:e}");
        }
        assert!(error[0] <= last);
        last = error[0];
    }
    for (evaluations, steps) in [(7, 1), (12, 1), (13, 2), (100, 16)] {
        let found = Bounded::tsit5(evaluations).advance(&system, 0.0, &start, 0.5).unwrap();
        assert_eq!(found.statistics.accepted, steps);
        assert_eq!(found.statistics.evaluations, 6 * steps + 1);
        for ((x, expected), error) in found.state.iter().zip(reference).zip(found.error.unwrap()) {
            let off = (x - expected).abs();
            assert!(off <= error + 4e-16, "{evaluations}: {off:e} {error:e}");
            // A bound that is far too large is no help either.
            assert!(error <= 1e-3);
        }
    }
    for bounded in [Bounded::dop853(11), Bounded::tsit5(6)] {
        let error = bounded.advance(&system, 0.0, &start, 0.5).unwrap_err();
        assert_eq!(error.cause, Cause::Setting(guen_runtime::Setting::Budget));
    }
    // Half a period in one step: what its estimates are worth is not known.
    assert_eq!(Bounded::tsit5(7).advance(&system, 0.0, &start, 3.0).unwrap().error, None);
    let still = Bounded::tsit5(7).advance(&system, 1.0, &start, 1.0).unwrap();
    assert_eq!((still.state, still.statistics), (start, Statistics::default()));
}
