//! Declared systems in lanes: every function of a state, and ensembles of systems whose constants and inputs differ.
#![allow(clippy::result_large_err, reason = "an error keeps the state that was reached")]

use guen::Laned;
use guen::lanes::{Backend, LaneTask, Lanes, Width, dispatch_on};
use guen::prelude::*;
use guen_study::Ensemble;

hoop!(guen::mechanical_system);
cart!(guen::mechanical_system);

fn part(i: usize, k: usize) -> f64 {
    ((i + 1) as f64 * (0.618 + 0.21 * k as f64)).fract()
}

fn hoops() -> Vec<(hoop::Prepared, hoop::State)> {
    (0..19)
        .map(|i| {
            let hoop = Hoop { a: 1.0 + part(i, 1), A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
            let state = std::array::from_fn(|k| 0.2 + part(i, k));
            (hoop, hoop::State::from(state))
        })
        .collect()
}

/// What a prepared hoop computes of a state, in order.
fn everything<R: Real>(hoop: &hoop::Prepared<R>, state: &hoop::State<R>) -> Vec<R> {
    let t = R::from_f64(0.5);
    let mut values = <[R; 9]>::from(hoop.rhs(t, state)).to_vec();
    values.extend([hoop.energy(t, state), hoop.kinetic_energy(t, state), hoop.force_function(t, state)]);
    values.extend(<[R; 6]>::from(hoop.velocities(t, state)));
    values.extend(<[R; 6]>::from(hoop.momenta(t, state)));
    values.extend(<[R; 3]>::from(hoop.reactions(t, state)));
    values.extend(<[R; 3]>::from(hoop.residuals(t, state)));
    values
}

struct Hoops;

impl LaneTask for Hoops {
    type Output = ();

    fn run<L: Lanes>(self) {
        let hoops = hoops();
        for first in 0..hoops.len() - L::COUNT {
            let gathered = <hoop::Prepared as Laned<9>>::gather::<L>(|lane| &hoops[first + lane].0);
            let states: Vec<[f64; 9]> = hoops[first..].iter().map(|(_, state)| (*state).into()).collect();
            let state: [L; 9] = std::array::from_fn(|k| L::from_fn(|lane| states[lane][k]));
            let values = everything(&gathered, &hoop::State::from(state));
            for lane in 0..L::COUNT {
                let (hoop, state) = &hoops[first + lane];
                let expected = everything(hoop, state);
                let got: Vec<f64> = values.iter().map(|value| value.lane(lane)).collect();
                assert_eq!(got, expected);
            }
        }
    }
}

#[test]
fn every_function_of_a_declared_system_has_the_bits_of_numbers() {
    for backend in Backend::ALL {
        for width in [Width::One, Width::Four, Width::Eight] {
            dispatch_on(backend, width, Hoops);
        }
    }
}

#[test]
fn inputs_are_gathered_with_their_systems() {
    let carts: Vec<(cart::Driven, cart::State)> = (0..11)
        .map(|i| {
            let cart = Cart::new(1.0 + part(i, 0), 0.5).prepare().unwrap();
            let inputs = cart::Inputs { push: part(i, 2), wind: part(i, 3) };
            (cart.driven(inputs), cart::State { phi: part(i, 1), ..Default::default() })
        })
        .collect();
    let method = Rk4::new(0.01);
    let ends = Ensemble::of_systems(carts.iter().copied()).integrate(&method, 0.0, 1.0);
    for ((cart, start), end) in carts.iter().zip(ends) {
        let alone = Integration::new(cart, 0.0, &(*start).into()).run(&method, 1.0);
        assert_eq!(end, alone);
        assert!(alone.is_ok());
    }
}

/// Hoops in lanes, each to its end.
struct Rolling<'a> {
    hoop: &'a hoop::Prepared,
    starts: &'a [[f64; 9]; 8],
    step: f64,
    guard: Guard,
}

impl LaneTask for Rolling<'_> {
    type Output = Vec<Result<IntegrationResult<f64, 9>, IntegrationError<f64, 9>>>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let hoop = <hoop::Prepared as Laned<9>>::gather::<L>(|_| self.hoop);
        let ends = self.starts.chunks_exact(L::COUNT).flat_map(|starts| {
            let start = std::array::from_fn(|i| L::from_fn(|lane| starts[lane][i]));
            let method = Rk4::new(self.step);
            method.guarded_in_lanes(&hoop, (0.0, &start), &[1.0], self.guard, |_, _, _, _| ())
        });
        ends.collect()
    }
}

/// A hoop that falls flat, and one that turns too fast for the step, among others that roll.
#[test]
fn a_falling_hoop_ends_as_it_would_alone() {
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().unwrap();
    let mut starts: [[f64; 9]; 8] = std::array::from_fn(|k| {
        let theta = 1.0 + 0.05 * k as f64;
        hoop::State { theta, zeta: theta.sin(), eta1: 0.1, eta2: 0.5, eta3: 2.0, ..Default::default() }.into()
    });
    let still = |theta: f64| hoop::State { theta, zeta: theta.sin(), ..Default::default() };
    starts[2] = still(0.5).into();
    starts[7] = hoop::State { eta2: 300.0, eta3: -900.0, ..still(0.3) }.into();
    let infinity = f64::INFINITY;
    // Edges alone, at every step with everything else.
    let edges =
        Guard { every: Some(1), energy: infinity, step: infinity, approach: infinity, ..Guard::default() };
    let mut causes = Vec::new();
    for (step, guard, expected) in [
        (1e-3, Guard::default(), &[2, 7][..]),
        (7e-3, Guard::default(), &[2, 7]),
        (2e-2, Guard::default(), &[2, 7]),
        (1e-3, edges, &[2]),
    ] {
        let alone =
            starts.map(|start| Integration::new(&hoop, 0.0, &start).guard(guard).run(&Rk4::new(step), 1.0));
        for backend in Backend::ALL {
            for width in [Width::One, Width::Four, Width::Eight] {
                let rolling = Rolling { hoop: &hoop, starts: &starts, step, guard };
                assert_eq!(dispatch_on(backend, width, rolling), alone, "{backend:?} {width:?}");
            }
        }
        let failed: Vec<usize> = (0..8).filter(|k| alone[*k].is_err()).collect();
        assert_eq!(failed, expected);
        causes.extend(alone.iter().filter_map(|end| Some(end.as_ref().err()?.cause)));
    }
    for (cause, name) in
        causes.iter().zip(["approach", "energy", "approach", "energy", "edge", "energy", "edge"])
    {
        let found = match cause {
            Cause::ApproachingSingularity { .. } => "approach",
            Cause::ChartSingularity { .. } => "edge",
            Cause::Energy { .. } => "energy",
            _ => "something else",
        };
        assert_eq!(found, name);
    }
}
