//! The balance of the energy integral: `power`, integrated along a run, is what `energy` changes by.

use guen::prelude::*;

cart!(guen::mechanical_system);
turntable!(guen::mechanical_system);

/// Integrates rates and power together; the change of energy and the work.
fn balance<const N: usize, const M: usize>(
    start: [f64; N],
    until: f64,
    rates: impl Fn(f64, &[f64; N]) -> [f64; N],
    power: impl Fn(f64, &[f64; N]) -> f64,
    energy: impl Fn(f64, &[f64; N]) -> f64,
) -> (f64, f64) {
    const { assert!(M == N + 1) };
    let head = |x: &[f64; M]| -> [f64; N] { std::array::from_fn(|i| x[i]) };
    let both = from_fn(|t, x: &[f64; M]| {
        let (rates, power) = (rates(t, &head(x)), power(t, &head(x)));
        std::array::from_fn(|i| if i < N { rates[i] } else { power })
    });
    let begin: [f64; M] = std::array::from_fn(|i| if i < N { start[i] } else { 0.0 });
    let end = Integration::new(&both, 0.0, &begin).run(&Dop853::new(1e-13, 1e-13), until).unwrap().state;
    (energy(until, &head(&end)) - energy(0.0, &start), end[N])
}

/// A table that moves its ball: `-lambda_v a_v0`, with explicit time in the constraints.
#[test]
fn moving_constraints_do_work() {
    let system = Turntable::new(0.7, 0.25, 1.5, 0.8, 1.3).prepare().unwrap();
    let start = [0.4, -0.2, 0.3, 1.2, -0.5, 0.6, -0.9, 0.5];
    let (change, work) = balance::<8, 9>(
        start,
        6.0,
        |t, x| system.rhs(t, &(*x).into()).into(),
        |t, x| system.power(t, &(*x).into()),
        |t, x| system.energy(t, &(*x).into()),
    );
    assert!((change - work).abs() < 1e-11, "{change} and {work}");
    assert!(change.abs() > 0.01, "{change}");
    // The formula with reactions, at one state: a_v0 is the table's speed times y and -x.
    let (t, state) = (0.7, turntable::State::from(start));
    let speed = 1.5 + 0.8 * (1.3_f64 * t).sin();
    let reactions = system.reactions(t, &state);
    let expected = -reactions.east * speed * state.y + reactions.north * speed * state.x;
    assert!((system.power(t, &state) - expected).abs() < 1e-14, "{expected}");
}

/// Inputs, friction and wind on the cart.
#[test]
fn forces_do_work() {
    let inputs = cart::Inputs { push: 1.7, wind: -0.6 };
    let system = Cart::new(2.0, 0.6).prepare().unwrap();
    let (change, work) = balance::<4, 5>(
        [0.3, 0.7, -0.4, 1.3],
        3.0,
        |t, x| system.rhs(t, &(*x).into(), &inputs).into(),
        |t, x| system.power(t, &(*x).into(), &inputs),
        |t, x| system.energy(t, &(*x).into()),
    );
    assert!((change - work).abs() < 1e-11, "{change} and {work}");
    assert!(change.abs() > 0.01, "{change}");
}
