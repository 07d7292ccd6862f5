//! Runs there and back return to their starts within a hundred roundings of their growth, or say that they cannot be undone.

#![allow(clippy::result_large_err, reason = "an error keeps the state that was reached")]

use guen::prelude::*;
use guen::steppers::{Method, Reversible, Varied, reversible};
use guen::{Dual, Liftable};
use guen_benchmarks::systems::{Chain2, EulerTop, Hoop, Sled, chain2, euler_top, hoop, sled};
use proptest::prelude::*;

/// Rounding errors of the states, relative to the largest of the start.
fn off<const N: usize>(found: &[f64; N], start: &[f64; N]) -> f64 {
    let size = start.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    (0..N).map(|i| (found[i] - start[i]).abs()).fold(0.0, f64::max) / size
}

const UNIT: f64 = f64::EPSILON / 2.0;
/// The largest growth of roundings for which the way back is asked for.
const LIMIT: f64 = 1e-8;
/// There and back is right to so many roundings of the growth.
const FACTOR: f64 = 100.0;

fn tight() -> Dop853<Dual<f64, 9>> {
    Dop853::new(1e-15, 1e-16).with_max_steps(1_000_000)
}

#[test]
fn there_and_back_returns_within_a_hundred_roundings_of_the_growth() {
    let system = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
    for (theta, span) in [(1.2_f64, 1.0), (1.2, 5.0), (0.6, 2.0), (1.2, -3.0)] {
        let start: [f64; 9] =
            hoop::State { theta, zeta: theta.sin(), eta1: 0.1, eta2: 1.5, eta3: 2.0, ..Default::default() }
                .into();
        let there = reversible(&system, &[], &tight(), 0.0, &start, span, LIMIT).unwrap();
        let back =
            Integration::new(&system, span, &there.done.state).run(&Dop853::new(1e-15, 1e-16), 0.0).unwrap();
        let (found, allowed) = (off(&back.state, &start), FACTOR * UNIT * there.growth);
        println!("hoop, {span} s: off by {found:.1e}, {allowed:.1e} allowed; growth {:.1e}", there.growth);
        assert!(found <= allowed);
        // The matrix against a difference of runs.
        let moved: [f64; 9] = std::array::from_fn(|i| start[i] + if i == 0 { 1e-6 } else { 0.0 });
        let end = Integration::new(&system, 0.0, &moved).run(&Dop853::new(1e-15, 1e-16), span).unwrap();
        for i in 0..9 {
            let slope = (end.state[i] - there.done.state[i]) / 1e-6;
            assert!((slope - there.matrix[i][0]).abs() < 1e-3 * there.growth, "entry {i}");
        }
    }
}

#[test]
fn the_sled_on_an_incline_says_when_it_cannot_be_undone() {
    let system = Sled { m: 1.0, alpha: 0.2, beta: 0.3, k: 0.4, incline: 0.3, g: 9.81 }.prepare().unwrap();
    let start: [f64; 5] = sled::State { phi: 0.3, eta1: 0.7, eta2: 0.5, ..Default::default() }.into();
    let method = Dop853::<Dual<f64, 5>>::new(1e-15, 1e-16).with_max_steps(1_000_000);
    let back = |from: f64, state: &[f64; 5]| {
        let run = Integration::new(&system, from, state).run(&Dop853::new(1e-15, 1e-16), 0.0);
        run.map_or(f64::INFINITY, |done| off(&done.state, &start))
    };
    let mut refused = 0;
    for span in [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0] {
        match reversible(&system, &[], &method, 0.0, &start, span, LIMIT) {
            Ok(there) => {
                let (found, allowed) = (back(span, &there.done.state), FACTOR * UNIT * there.growth);
                println!("{span} s: off by {found:.1e}, {allowed:.1e} allowed");
                assert!(found <= allowed && UNIT * there.growth <= LIMIT);
            }
            Err(error) => {
                println!("{span} s: {error}");
                assert!(matches!(error.cause, Cause::Irreversible { .. }) && error.time < span);
                // What is returned can be undone.
                assert!(back(error.time, &error.state) < 100.0 * LIMIT);
                refused += 1;
            }
        }
    }
    assert!(refused >= 1, "after a minute the sled slides as if it had never turned");
}

/// There by a method on duals and back by another one: whether the run can be undone. Where it says so, it is checked.
fn there_and_back<S, M, B, const N: usize>(
    system: &S,
    [there, back]: [&str; 2],
    forwards: &M,
    backwards: &B,
    start: &[f64; N],
    span: f64,
) -> bool
where
    S: System<f64, N> + Liftable<f64, N, 0>,
    M: for<'a> Method<Dual<f64, N>, Varied<'a, S, f64, 0>, N>,
    B: Method<f64, S, N>,
{
    let returned = |time: f64, state: &[f64; N]| {
        let run = Integration::new(system, time, state).run(backwards, 0.0);
        off(&run.unwrap_or_else(|error| panic!("{there}, {back}: {error}")).state, start)
    };
    match reversible(system, &[], forwards, 0.0, start, span, LIMIT) {
        Ok(Reversible { done, growth, .. }) => {
            let (found, allowed) = (returned(done.time, &done.state), FACTOR * UNIT * growth);
            assert!(
                found <= allowed,
                "{there}, {back}: {found:e}, allowed are {allowed:e} from {start:?}, {span}"
            );
            assert!(UNIT * growth <= LIMIT);
            true
        }
        Err(error) => {
            assert!(matches!(error.cause, Cause::Irreversible { .. }), "{there}: {error}");
            // What it returns can be undone.
            let found = returned(error.time, &error.state);
            assert!(found <= FACTOR * LIMIT, "{there}, {back}: {found:e} from {start:?}, {span}");
            false
        }
    }
}

/// Every explicit method there, and back by it and by others; steps and tolerances at which methods err by roundings.
#[test]
fn every_method_returns_and_so_does_another_one() {
    let rolling = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
    let hanging = Chain2 { m: 1.0, l: 0.5, g: 9.81 }.prepare().unwrap();
    let upright: [f64; 9] = hoop::State {
        theta: 1.2,
        zeta: 1.2_f64.sin(),
        eta1: 0.1,
        eta2: 1.5,
        eta3: 2.0,
        ..Default::default()
    }
    .into();
    let bent: [f64; 4] = chain2::State { q1: 0.4, q2: -0.7, w1: 0.5, ..Default::default() }.into();
    fn check<S, const N: usize>(system: &S, start: &[f64; N], span: f64)
    where
        S: System<f64, N> + Liftable<f64, N, 0> + guen::Differentiable<f64, N>,
    {
        let dop853 = Dop853::new(1e-15, 1e-16);
        let (rk8, rk4, gauss) = (Rk8::new(5e-3), Rk4::new(1e-4), Gauss6::new(2e-3));
        let tsit5 = Tsit5::new(1e-14, 1e-15).with_max_steps(1_000_000);
        let on_duals = Dop853::new(1e-15, 1e-16).with_max_steps(1_000_000);
        assert!(there_and_back(system, ["DOP853", "RK8"], &on_duals, &rk8, start, span));
        assert!(there_and_back(system, ["DOP853", "Gauss 6"], &on_duals, &gauss, start, span));
        assert!(there_and_back(system, ["DOP853", "Tsit5"], &on_duals, &tsit5, start, span));
        let on_duals = Rk8::new(Dual::constant(5e-3));
        assert!(there_and_back(system, ["RK8", "RK8"], &on_duals, &rk8, start, span));
        assert!(there_and_back(system, ["RK8", "DOP853"], &on_duals, &dop853, start, span));
        let on_duals = Rk4::new(Dual::constant(1e-4));
        assert!(there_and_back(system, ["RK4", "RK4"], &on_duals, &rk4, start, span));
    }
    check(&rolling, &upright, 0.5);
    check(&rolling, &upright, -0.5);
    check(&hanging, &bent, 0.5);
}

/// Enough for a light and a heavy build alike.
const CASES: u32 = if cfg!(debug_assertions) { 12 } else { 100 };

fn tightly<const N: usize>() -> Dop853<Dual<f64, N>> {
    Dop853::new(1e-15, 1e-16).with_max_steps(1_000_000)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: CASES, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn hoops_return(
        theta in 0.6_f64..2.5, rates in prop::array::uniform3(-1.5_f64..1.5), span in -1.0_f64..1.0
    ) {
        let [eta1, eta2, eta3] = rates;
        let system = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
        let start = hoop::State { theta, zeta: theta.sin(), eta1, eta2, eta3, ..Default::default() }.into();
        let back = Dop853::new(1e-15, 1e-16);
        there_and_back(&system, ["DOP853"; 2], &tightly(), &back, &start, span);
    }

    /// Short spans can be undone, long ones cannot: both occur.
    #[test]
    fn sleds_return(
        phi in -3.0_f64..3.0, eta1 in -2.0_f64..2.0, eta2 in -2.0_f64..2.0, span in 0.2_f64..20.0, incline in 0.0_f64..0.6
    ) {
        let system = Sled { m: 1.0, alpha: 0.2, beta: 0.3, k: 0.4, incline, g: 9.81 }.prepare().unwrap();
        let start = sled::State { phi, eta1, eta2, ..Default::default() }.into();
        let back = Dop853::new(1e-15, 1e-16).with_max_steps(1_000_000);
        there_and_back(&system, ["DOP853"; 2], &tightly(), &back, &start, span);
    }

    #[test]
    fn tops_return(
        theta in 0.6_f64..2.5, rates in prop::array::uniform3(-1.5_f64..1.5), span in -1.0_f64..1.0
    ) {
        let [p, q, r] = rates;
        let system = EulerTop { I1: 1.0, I2: 1.5, I3: 2.0 }.prepare().unwrap();
        let start = euler_top::State { theta, p, q, r, ..Default::default() }.into();
        let back = Dop853::new(1e-15, 1e-16).with_max_steps(1_000_000);
        there_and_back(&system, ["DOP853"; 2], &tightly(), &back, &start, span);
    }

    #[test]
    fn chains_return(angles in prop::array::uniform2(-3.0_f64..3.0), span in -2.0_f64..2.0) {
        let [q1, q2] = angles;
        let system = Chain2 { m: 1.0, l: 0.5, g: 9.81 }.prepare().unwrap();
        let start = chain2::State { q1, q2, ..Default::default() }.into();
        let back = Dop853::new(1e-15, 1e-16).with_max_steps(1_000_000);
        there_and_back(&system, ["DOP853"; 2], &tightly(), &back, &start, span);
    }
}
