//! Measured orders of convergence, of the methods and of the estimates.

use core::ops::ControlFlow;

use guen_runtime::steppers::dop853::Tableau;
use guen_runtime::steppers::{Rk4, rk4};
use guen_runtime::{System, from_fn};

/// A problem that is neither linear nor autonomous, with a known solution: `x = exp(sin t)`, `y = 1 / (2 + cos t)`.
fn problem() -> impl System<f64, 2> {
    from_fn(|t: f64, &[x, y]: &[f64; 2]| {
        [x * t.cos() * (y * (2.0 + t.cos())), y * y * t.sin() * x / t.sin().exp()]
    })
}

fn exact(t: f64) -> [f64; 2] {
    [t.sin().exp(), 1.0 / (2.0 + t.cos())]
}

fn distance(a: &[f64; 2], b: &[f64; 2]) -> f64 {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs())
}

/// The exponent of `h` between two errors at `h` and `h / 2`.
fn order(coarse: f64, fine: f64) -> f64 {
    (coarse / fine).log2()
}

#[test]
fn rk4_has_order_four() {
    let error = |steps: f64| {
        let done = Rk4 { step: 2.0 / steps }
            .integrate(&problem(), 0.0, &exact(0.0), 2.0, |_, _| ControlFlow::Continue(()))
            .unwrap();
        assert_eq!(done.statistics.accepted, steps as u64);
        distance(&done.state, &exact(2.0))
    };
    let measured = order(error(64.0), error(128.0));
    assert!((measured - 4.0).abs() < 0.15, "{measured}");
}

#[test]
fn one_step_of_rk4_errs_in_the_fifth_power() {
    let error = |h: f64| distance(&rk4::step(&problem(), 0.3, &exact(0.3), h), &exact(0.3 + h));
    let measured = order(error(0.05), error(0.025));
    assert!((measured - 5.0).abs() < 0.2, "{measured}");
}

/// The distance from the start after one period of Kepler's problem with eccentricity 0.6, in so many equal steps.
fn comet_error(steps: u32) -> f64 {
    let kepler = from_fn(|_t: f64, &[x, y, u, v]: &[f64; 4]| {
        let cube = (x * x + y * y).sqrt().powi(3);
        [u, v, -x / cube, -y / cube]
    });
    // Perihelion at 0.4, where the speed is sqrt((1 + e) / (1 - e)) = 2.
    let start = [0.4, 0.0, 0.0, 2.0];
    let tableau = Tableau::new();
    let h = std::f64::consts::TAU / f64::from(steps);
    let mut x = start;
    for k in 0..steps {
        let t = f64::from(k) * h;
        x = tableau.trial(&kepler, t, &x, &kepler.rhs(t, &x), h).state;
    }
    (0..4).map(|i| (x[i] - start[i]).abs()).fold(0.0, f64::max)
}

#[test]
fn dop853_has_order_eight() {
    let measured = order(comet_error(256), comet_error(512));
    assert!((measured - 8.0).abs() < 0.4, "{measured}");
}

#[test]
fn the_estimates_of_dop853_have_orders_five_and_three() {
    let (tableau, system) = (Tableau::new(), problem());
    let t = 0.3;
    let trial = |h: f64| tableau.trial(&system, t, &exact(t), &system.rhs(t, &exact(t)), h);
    let (coarse, fine) = (trial(0.025), trial(0.0125));
    // As slopes: one power of `h` less than as errors of the state, which are O(h^6) and O(h^4).
    let five = order(distance(&coarse.error5, &[0.0; 2]), distance(&fine.error5, &[0.0; 2]));
    let three = order(distance(&coarse.error3, &[0.0; 2]), distance(&fine.error3, &[0.0; 2]));
    assert!((five - 5.0).abs() < 0.2, "{five}");
    assert!((three - 3.0).abs() < 0.1, "{three}");
}
