//! Measured orders of convergence, of the methods and of the estimates.

use guen_runtime::steppers::dop853::Tableau;
use guen_runtime::steppers::{
    Dop853, Euler, Gauss4, Gauss6, Guard, Integration, Method, Radau5, Rk4, Rk8, Tsit5, rk4,
};
use guen_runtime::{Equations, Generic, Real, System, from_fn, generic};

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
        let done = Integration::new(&problem(), 0.0, &exact(0.0)).run(&Rk4::new(2.0 / steps), 2.0).unwrap();
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
    let step = std::f64::consts::TAU / f64::from(steps);
    // Compensated: with the finer steps the method errs by no more than plain sums lose.
    let run = Integration::new(&kepler, 0.0, &start);
    let done = run.run(&Rk8::new(step).compensated(), std::f64::consts::TAU).unwrap();
    assert_eq!(done.statistics.evaluations, 12 * u64::from(steps));
    let x = done.state;
    (0..4).map(|i| (x[i] - start[i]).abs()).fold(0.0, f64::max)
}

#[test]
fn rk8_and_with_it_dop853_have_order_eight() {
    let measured = order(comet_error(256), comet_error(512));
    assert!((measured - 8.0).abs() < 0.4, "{measured}");
    // Between the ends; at the end of the other problem this formula happens to be of order ten.
    let between = order(errors(&Rk8::new(0.4)).1, errors(&Rk8::new(0.2)).1);
    assert!((between - 8.0).abs() < 0.4, "{between}");
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

/// The problem above for every real, so that implicit methods have its Jacobian.
struct Problem;

impl Equations<2> for Problem {
    fn rates<R: Real>(&self, t: R, &[x, y]: &[R; 2]) -> [R; 2] {
        let two = R::from_ratio(2, 1);
        [x * t.cos() * (y * (two + t.cos())), y * y * t.sin() * x / t.sin().exp()]
    }
}

type Smooth = Generic<Problem>;

/// The largest error of the end and of 64 samples between, over `0 .. 2`.
fn errors<M: Method<f64, Smooth, 2>>(method: &M) -> (f64, f64) {
    let times: Vec<f64> = (1..=64).map(|k| 2.0 * f64::from(k) / 65.0).collect();
    let mut between = 0.0_f64;
    let done = Integration::new(&generic(Problem), 0.0, &exact(0.0))
        .sample(&times, &mut |_, t, x| between = between.max(distance(x, &exact(t))))
        .guard(Guard::FINITE)
        .run(method, 2.0)
        .unwrap();
    (distance(&done.state, &exact(2.0)), between)
}

/// Measures the order at the ends of steps and that of the dense output, from `steps` to twice as many.
fn check_orders<M: Method<f64, Smooth, 2>>(
    name: &str,
    steps: f64,
    (at_ends, between): (f64, f64),
    method: impl Fn(f64) -> M,
) {
    let (coarse, fine) = (errors(&method(2.0 / steps)), errors(&method(1.0 / steps)));
    let (ends, dense) = (order(coarse.0, fine.0), order(coarse.1, fine.1));
    println!("{name}: order {ends:.2} at the ends, {dense:.2} between; errors {fine:?}");
    assert!((ends - at_ends).abs() < 0.4, "{name}: {ends}");
    // An error of the polynomial that is still below that of the steps shows the steps' order: never less.
    assert!(dense > between - 0.4, "{name}: {dense}");
}

#[test]
fn methods_with_a_fixed_step_have_their_orders_at_the_ends_and_between() {
    check_orders("Euler", 256.0, (1.0, 1.0), Euler::new);
    check_orders("RK4", 32.0, (4.0, 4.0), Rk4::new);
    check_orders("Gauss 4", 16.0, (4.0, 4.0), Gauss4::new);
    check_orders("Gauss 6", 8.0, (6.0, 6.0), Gauss6::new);
}

/// The dense output alone: the largest error over one step of size `h` from exact values, at nine points.
fn within_one_step<M: Method<f64, Smooth, 2>>(method: &M, h: f64) -> f64 {
    let t0 = 0.3;
    let times: Vec<f64> = (1..10).map(|k| t0 + h * f64::from(k) / 10.0).collect();
    let mut worst = 0.0_f64;
    let done = Integration::new(&generic(Problem), t0, &exact(t0))
        .sample(&times, &mut |_, t, x| worst = worst.max(distance(x, &exact(t))))
        .run(method, t0 + h)
        .unwrap();
    assert_eq!(done.statistics.accepted, 1, "one step");
    worst
}

#[test]
fn interpolants_err_as_documented_within_one_step() {
    // Tolerances so loose that the first step is the whole span.
    let wide = |h: f64| (1e9, 1e9, h);
    let check = |name: &str, power: f64, h: f64, error: &dyn Fn(f64) -> f64| {
        let measured = order(error(h), error(h / 2.0));
        println!("{name}: O(h^{measured:.2}) within a step");
        assert!((measured - power).abs() < 0.35, "{name}: {measured}");
    };
    check("RK4", 4.0, 0.1, &|h| within_one_step(&Rk4::new(h), h));
    check("RK8", 8.0, 0.4, &|h| within_one_step(&Rk8::new(h), h));
    check("Gauss 4", 4.0, 0.1, &|h| within_one_step(&Gauss4::new(h), h));
    check("Gauss 6", 6.0, 0.2, &|h| within_one_step(&Gauss6::new(h), h));
    check("DOP853", 8.0, 0.4, &|h| {
        let (rtol, atol, first) = wide(h);
        within_one_step(&Dop853::new(rtol, atol).with_first_step(first), h)
    });
    check("Tsit5", 5.0, 0.1, &|h| {
        let (rtol, atol, first) = wide(h);
        within_one_step(&Tsit5::new(rtol, atol).with_first_step(first), h)
    });
}

#[test]
fn adaptive_methods_follow_their_tolerance() {
    fn check<M: Method<f64, Smooth, 2>>(name: &str, method: impl Fn(f64) -> M) {
        let mut last = f64::INFINITY;
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let (end, between) = errors(&method(tolerance));
            println!("{name} at {tolerance:e}: {end:.1e} at the end, {between:.1e} between");
            assert!(end < 50.0 * tolerance, "{name} at {tolerance:e}: {end:e}");
            // The polynomials are of lower order than the steps; their error may exceed the tolerance.
            assert!(between < 1e3 * tolerance, "{name} at {tolerance:e}: {between:e} between");
            assert!(end < last, "{name}: a smaller tolerance gives {end:e} after {last:e}");
            last = end;
        }
    }
    check("DOP853", |tolerance| Dop853::new(tolerance, tolerance));
    check("Tsit5", |tolerance| Tsit5::new(tolerance, tolerance));
    check("Radau 5", |tolerance| Radau5::new(tolerance, tolerance));
}

/// Radau's order through its tolerance: the estimate falls as `h^4`, the error of the ends as `h^5` and that of the
/// polynomial as `h^4`.
#[test]
fn radau_has_order_five_and_its_polynomial_three() {
    let at = |tolerance: f64| errors(&Radau5::new(tolerance, tolerance));
    let (coarse, fine) = (at(1e-5), at(1e-9));
    let (ends, between) = ((coarse.0 / fine.0).log10() / 4.0, (coarse.1 / fine.1).log10() / 4.0);
    println!("Radau 5: error as the power {ends:.2} of the tolerance at the ends, {between:.2} between");
    assert!((ends - 1.25).abs() < 0.1, "{ends}");
    assert!((between - 1.0).abs() < 0.1, "{between}");
}
