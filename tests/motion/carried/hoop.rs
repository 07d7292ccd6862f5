//! The hoop of the paper with its sines and cosines as states, against the reference in 25 digits.

use guen::prelude::*;
use guen::{AuxiliaryStates, Cost, renormalized};

use guen_study::Digits71;

guen_benchmarks::hoop!(guen::mechanical_system; provide carried; scene Tilt { track theta; provide carried; });

/// The constants of the first case of the reference, in any real.
fn prepared<R: Real>() -> hoop::Prepared<R> {
    let ratio = R::from_ratio;
    Hoop { a: ratio(1, 1), A: ratio(1, 2), C: ratio(1, 1), g: ratio(981, 100) }.prepare().unwrap()
}

/// Times and states of the first case of the reference.
fn reference() -> Vec<(f64, [f64; 9])> {
    let text = include_str!("../../data/01_hoop_rolling.json");
    let file: serde_json::Value = serde_json::from_str(text).unwrap();
    let case = &file["cases"][0];
    let number = |value: &serde_json::Value| value.as_str().unwrap().parse::<f64>().unwrap();
    let states = case["states"].as_array().unwrap().iter();
    let states = states.map(|state| std::array::from_fn(|i| number(&state[i])));
    case["times"].as_array().unwrap().iter().map(number).zip(states).collect()
}

fn distance<const N: usize, const M: usize>(x: &[f64; N], y: &[f64; M]) -> f64 {
    x.iter().zip(y).fold(0.0, |most, (x, y)| most.max((x - y).abs()))
}

fn go_on<R, const N: usize>(_: R, _: &[R; N]) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

#[test]
fn no_call_is_left_and_what_comes_in_is_named() {
    assert_eq!(hoop::State::NAMES, hoop::carried::State::NAMES[..9]);
    assert_eq!(hoop::carried::State::NAMES[9..], ["sin_theta", "cos_theta", "sin_psi", "cos_psi"]);
    assert_eq!(hoop::carried::FUNCTIONS[3], "cos_psi = cos(psi)");
    assert_eq!((hoop::COST.calls, hoop::carried::COST.calls, hoop::carried::COST.roots), (2, 0, 0));
    // Two multiplications and a change of sign for a pair, what is shared shared.
    let Cost { additions, negations, multiplications, divisions, .. } = hoop::carried::COST;
    assert!((additions, divisions) == (6, 1) && multiplications <= 20 && negations <= 2);
    assert_eq!(hoop::tilt::carried::State::NAMES[4..], ["sin_theta", "cos_theta"]);
    assert_eq!(hoop::tilt::carried::COST.calls, 0);
}

#[test]
fn the_motion_is_that_of_the_reference() {
    let system = prepared::<f64>();
    let carried = system.carried().unwrap();
    let reference = reference();
    let times: Vec<f64> = reference.iter().map(|(t, _)| *t).collect();
    let start = hoop::State::from(reference[0].1);
    let lifted = start.carried(&carried, 0.0);
    assert_eq!(hoop::State::from(lifted), start);
    let method = Dop853::new(1e-13, 1e-13);
    let (mut own, mut full) = (0.0_f64, 0.0_f64);
    Integration::new(&carried, 0.0, &lifted.into())
        .sample(&times, &mut |k, t, x| {
            own = own.max(distance(&reference[k].1, x));
            let state = hoop::carried::State::from(*x);
            assert!(carried.drift(t, &state) < 1e-10);
            assert!(carried.invariants(t, &state).iter().all(|left| left.abs() < 1e-12));
        })
        .guard(Guard { carried: 1e-9, every: Some(1), ..Guard::default() })
        .run(&method, times[times.len() - 1])
        .unwrap();
    method
        .sample(&system, 0.0, &start.into(), &times, |k, _, x| full = full.max(distance(&reference[k].1, x)))
        .unwrap();
    println!("carried {own:e}, whole {full:e}");
    assert!(own < 1e-10 && own < 20.0 * full.max(1e-12));
}

#[test]
fn every_stepper_takes_it() {
    let carried = prepared::<f64>().carried().unwrap();
    let reference = reference();
    let (t, expected) = reference.iter().find(|(t, _)| *t >= 1.0).copied().unwrap();
    let start = hoop::State::from(reference[0].1).carried(&carried, 0.0).into();
    let ends = [
        ("Rk4", Rk4::new(1e-3).integrate(&carried, 0.0, &start, t, go_on).unwrap().state, 1e-8),
        ("Rk8", Rk8::new(1e-2).integrate(&carried, 0.0, &start, t, go_on).unwrap().state, 1e-10),
        ("Tsit5", Tsit5::new(1e-10, 1e-10).integrate(&carried, 0.0, &start, t, go_on).unwrap().state, 1e-7),
        ("Gauss4", Gauss4::new(2e-3).integrate(&carried, 0.0, &start, t, go_on).unwrap().state, 1e-7),
        ("Gauss6", Gauss6::new(5e-3).integrate(&carried, 0.0, &start, t, go_on).unwrap().state, 1e-9),
        ("Radau5", Radau5::new(1e-9, 1e-9).integrate(&carried, 0.0, &start, t, go_on).unwrap().state, 1e-7),
        ("Euler", Euler::new(1e-5).integrate(&carried, 0.0, &start, t, go_on).unwrap().state, 1e-2),
        (
            "Renormalized",
            Rk8::new(1e-2).integrate(&renormalized(carried), 0.0, &start, t, go_on).unwrap().state,
            1e-10,
        ),
    ];
    for (name, end, tolerance) in ends {
        let error = distance(&expected, &end);
        assert!(error < tolerance, "{name}: {error:e}");
    }
}

#[test]
fn in_lanes_as_alone_and_in_single_precision() {
    let carried = prepared::<f64>().carried().unwrap();
    let start = hoop::State::from(reference()[0].1);
    let starts: Vec<[f64; 13]> = (0..13)
        .map(|k| hoop::State { eta3: start.eta3 + 0.1 * f64::from(k), ..start }.carried(&carried, 0.0).into())
        .collect();
    let method = Rk4::new(2e-3);
    let ends = guen_study::Ensemble::of_states(carried, starts.iter().copied()).integrate(&method, 0.0, 2.0);
    for (start, end) in starts.iter().zip(&ends) {
        let alone = method.integrate(&carried, 0.0, start, 2.0, go_on).unwrap().state;
        assert_eq!(alone, end.as_ref().unwrap().state);
    }
    let single = prepared::<f32>().carried().unwrap();
    let begin = hoop::State::from(reference()[0].1.map(|x| x as f32)).carried(&single, 0.0);
    let end = Rk4::new(2e-3_f32).integrate(&single, 0.0, &begin.into(), 1.0, go_on).unwrap().state;
    let double = method.integrate(&carried, 0.0, &starts[0], 1.0, go_on).unwrap().state;
    assert!(distance(&end.map(f64::from), &double) < 1e-4);
}

/// With 71 digits the rates of both forms agree to the last ones, so that no number in the program is rounded.
#[test]
fn in_extended_precision() {
    let system = prepared::<Digits71>();
    let carried = system.carried().unwrap();
    let state = hoop::State::from(reference()[3].1.map(Digits71::from_f64));
    let (full, own) = (
        system.rhs(Digits71::zero(), &state),
        carried.rhs(Digits71::zero(), &state.carried(&carried, Digits71::zero())),
    );
    let (full, own): ([Digits71; 9], [Digits71; 13]) = (full.into(), own.into());
    for (x, y) in full.iter().zip(&own) {
        assert!((*x - *y).abs().to_f64() < 1e-66);
    }
}

#[test]
fn a_guard_sees_a_state_that_is_none() {
    let carried = prepared::<f64>().carried().unwrap();
    let start = hoop::State::from(reference()[0].1).carried(&carried, 0.0);
    let guard = Guard { every: Some(1), ..Guard::default() };
    let run = |start: hoop::carried::State| {
        Integration::new(&carried, 0.0, &start.into()).guard(guard).run(&Rk8::new(0.02), 1.0)
    };
    assert!(run(start).is_ok());
    // Off the circle, and on it at another angle.
    let (sine, cosine) = 0.1_f64.sin_cos();
    let turned = hoop::carried::State {
        sin_psi: start.sin_psi * cosine + start.cos_psi * sine,
        cos_psi: start.cos_psi * cosine - start.sin_psi * sine,
        ..start
    };
    for wrong in [hoop::carried::State { sin_theta: 1.05 * start.sin_theta, ..start }, turned] {
        let Err(error) = run(wrong) else { panic!("not seen") };
        assert!(matches!(error.cause, Cause::Carried { drift, .. } if drift > 0.01), "{error}");
        assert!(error.to_string().contains("a carried function was off by"));
    }
}

/// What a step leaves of the circle is its square after renormalizing, and the drift of the phase stays.
#[test]
fn renormalizing_keeps_the_circle() {
    let carried = prepared::<f64>().carried().unwrap();
    let start = hoop::State::from(reference()[0].1).carried(&carried, 0.0).into();
    let method = Rk4::new(0.02);
    let left = |state: [f64; 13]| {
        let left = carried.invariants(0.0, &state.into());
        left.iter().fold(0.0_f64, |most, left| most.max(left.abs()))
    };
    let free = left(method.integrate(&carried, 0.0, &start, 10.0, go_on).unwrap().state);
    let held = left(method.integrate(&renormalized(carried), 0.0, &start, 10.0, go_on).unwrap().state);
    assert!(free > 1e-6 && held < 1e-14, "{free:e} and {held:e}");
    let mut state: [f64; 13] = start;
    state[9] *= 1.0 + 1e-6;
    carried.renormalize(0.0, &mut state);
    assert!(left(state) < 1e-11);
}
