//! A series `p(s)` of order `n` is right if and only if `p'(s) - f(p(s)) = O(s^n)`. Nothing of the recurrences is in that
//! check, only the right-hand side. At `s = 2^-16`, with 71 digits, a wrong coefficient of any order stands out: it leaves
//! its own power of `s`.

use guen::prelude::*;
use guen::{HIGHEST_ORDER, TaylorSeries, mechanical_system};

use guen_study::Digits71;

/// The order up to which coefficients are tested: at `2^-16` the next term is of the order of `1e-63`.
const ORDER: usize = 13;
const FINE: i64 = 1 << 16;

/// The largest of `|p'(s) - f(t + s, p(s))|` over the variables, in units of `s^n`.
fn residual<S, const N: usize>(system: &S, t: f64, state: &[f64; N], scale: f64) -> f64
where
    S: TaylorSeries<Digits71, N>,
{
    let (t, scale) = (Digits71::from_f64(t), Digits71::from_f64(scale));
    let mut coefficients = [[Digits71::zero(); N]; HIGHEST_ORDER + 1];
    system.series(t, &state.map(Digits71::from_f64), scale, ORDER, &mut coefficients);
    assert!(coefficients[ORDER + 1].iter().all(|c| *c == Digits71::zero()), "written beyond the order");
    let s = Digits71::from_ratio(1, FINE);
    let r = s / scale;
    let (mut value, mut rate) = ([Digits71::zero(); N], [Digits71::zero(); N]);
    for k in (0..=ORDER).rev() {
        for i in 0..N {
            value[i] = value[i] * r + coefficients[k][i];
            if k > 0 {
                let order = Digits71::from_ratio(k as i64, 1);
                rate[i] = rate[i] * r + order * coefficients[k][i] / scale;
            }
        }
    }
    let expected = system.rhs(t + s, &value);
    let mut unit = Digits71::one();
    for _ in 0..ORDER {
        unit *= s;
    }
    (0..N).map(|i| ((rate[i] - expected[i]) / unit).abs().to_f64()).fold(0.0, f64::max)
}

/// Declares a point in the plane with a force along `x` that is the expression, and tests its series at some states.
macro_rules! of {
    ($($test:ident $name:ident: { $($force:tt)* })*) => {$(
        #[test]
        fn $test() {
            mechanical_system! {
                system $name {
                    constants { a > 0 }
                    coordinates { x, y }
                    parameters { p = dot(x); q = dot(y); }
                    kinetic_energy = 1/2*(p^2 + q^2);
                    forces { $($force)* along p; -a*x*q along q; }
                    provide taylor;
                }
            }
            let system = $name { a: Digits71::from_ratio(3, 2) }.prepare().unwrap();
            for (scale, state) in [
                (1.0, [0.4, 0.7, 0.5, 0.3]),
                (0.125, [0.2, 0.9, -0.6, 0.8]),
                (4.0, [0.7, 0.3, 0.1, -0.9]),
            ] {
                let residual = residual(&system, 0.25, &state, scale);
                // Coefficients of order 14 of motions on the scale of one: measured 1e-4 to 3e5.
                assert!(residual < 1e8, "{}: {residual:e}", stringify!($($force)*));
            }
        }
    )*};
}

of! {
    sums Sums: { x - y + p - a }
    products Products: { x*y*p - 2*x*q }
    squares Squares: { x^2 - a*y^2 + p^3 }
    quotients Quotients: { x/(y + 2) + 1/(p + 3) - q/(3 + x*y) }
    reciprocals_of_powers Powers: { 1/(x + 2)^3 }
    sines Sines: { sin(x)*y + cos(a*y - x) }
    sines_of_products Turned: { sin(x*y) - cos(p*x + t)*x }
    tangents Tangents: { tan(x) + cot(y*x + 1) }
    inverse_sines Arcs: { asin(x*y/2) + acos(x/2) }
    inverse_tangents Angles: { atan(x*y) - atan(p) }
    angles_of_points Points: { atan2(x + 2, y) + atan2(y, 3) - atan2(2, p) }
    exponentials Exponentials: { exp(-x) + exp(x*y) }
    exponentials_of_time Decay: { exp(-t)*x }
    logarithms Logarithms: { ln(x*y + 2) - ln(x + 1) }
    hyperbolic Hyperbolic: { sinh(x) - cosh(a*y) + sinh(x*y)/4 - cosh(p*q)/4 }
    hyperbolic_tangents Saturated: { tanh(a*x) - tanh(x*y) }
    square_roots Roots: { sqrt(x + 1) + sqrt(1 + x*y) }
    cubic_roots Cubic: { (x + 1)^(1/3) + (2 + x*y)^(2/5) }
    time Timed: { t*x + t^2 - sin(a*t) }
    signs Signs: { -(x*y) - (-p)*q - a*(-x)*(a*y) }
    nothing_that_moves Still: { a }
}

mechanical_system! {
    /// A cart with a pole, a wheel of variable drive and a rope: inputs, a mass matrix that moves, constraints.
    system Cart {
        constants { m > 0, M > 0, l > 0, g = 9.81, k }
        inputs { force }
        coordinates { x, theta, phi }
        parameters { v = dot(x); w = dot(theta); }
        constraints { drive: dot(phi) = (1 + k*sin(t)*x^2)*dot(x); }
        kinetic_energy = 1/2*M*dot(x)^2 + 1/2*m*((dot(x) + l*cos(theta)*dot(theta))^2 + (l*sin(theta)*dot(theta))^2)
            + 1/4*dot(phi)^2;
        potential_energy = m*g*l*cos(theta);
        forces { force*cos(phi) - v along v; }
        outputs { height = l*cos(theta); }
        provide taylor;
        scene Upright { track theta; fix k = 0; provide taylor; }
    }
}

#[test]
fn a_driven_system_and_its_scene() {
    let long = |n: i64, d: i64| Digits71::from_ratio(n, d);
    let constants = Cart { m: long(1, 5), M: long(1, 1), l: long(1, 2), g: long(981, 100), k: long(1, 3) };
    let inputs = cart::Inputs { force: long(7, 10) };
    let residual_of_whole =
        residual(&constants.prepare().unwrap().driven(inputs), 0.5, &[0.3, 0.2, 0.1, 0.6, -0.4], 0.5);
    assert!(residual_of_whole < 1e10, "{residual_of_whole:e}");
    let scene = cart::Upright::try_from(Cart { k: long(0, 1), ..constants }).unwrap();
    let driven = scene.prepare().unwrap().driven(cart::upright::Inputs { force: long(7, 10) });
    let residual_of_scene = residual(&driven, 0.5, &[0.2, 0.1, 0.6, -0.4], 0.5);
    assert!(residual_of_scene < 1e10, "{residual_of_scene:e}");
}

mechanical_system! {
    /// A point with inputs in every operation that a series knows.
    system Pushed {
        inputs { push, turn }
        coordinates { x, y }
        parameters { p = dot(x); q = dot(y); }
        kinetic_energy = 1/2*(p^2 + q^2);
        forces {
            push*cos(x + t*turn) + sin(push*y) + x/(2 + push^2) - turn/4 + sqrt(3 + push) + exp(-push) along p;
            push*turn - atan2(push + 3, turn) + tanh(turn) + turn^3 - q*push along q;
        }
        provide taylor;
    }
}

/// A law with every function of reals.
#[derive(Clone, Copy)]
struct Wild;

impl Wild {
    fn pair<R: Real>(t: R, [x, y, p, q]: [R; 4]) -> [R; 2] {
        let part = |n, d| R::from_ratio(n, d);
        let (sin, cos) = (x * p).sin_cos();
        let push = sin * q + (x * y / part(4, 1)).asin() - (p / part(3, 1)).acos() + (x + q).atan() + t.cos()
            - y.atan2(x + part(2, 1))
            + (x - y).tanh();
        let turn = cos + (p / part(4, 1)).tan() + (y + part(3, 1)).ln() - (x + part(2, 1)).sqrt()
            + (q + part(2, 1)).root(3)
            + (-t).exp() * x.sinh()
            - y.cosh().recip()
            + (x - part(3, 1)).abs() * q.sign() / (y + part(2, 1)).powi(2)
            + (x + part(1, 1)).cot();
        [push, turn]
    }
}

impl InputLaw<pushed::Prepared<Digits71>> for Wild {
    fn at<R: Real>(&self, t: R, s: &pushed::State<R>) -> pushed::Inputs<R> {
        let [push, turn] = Self::pair(t, [s.x, s.y, s.p, s.q]);
        pushed::Inputs { push, turn }
    }
}

impl InputLaw<cart::Prepared<Digits71>> for Wild {
    fn at<R: Real>(&self, t: R, s: &cart::State<R>) -> cart::Inputs<R> {
        cart::Inputs { force: Self::pair(t, [s.x, s.theta, s.v, s.w])[0] }
    }
}

#[test]
fn a_series_goes_along_the_series_of_a_law() {
    let system = Pushed::with_defaults::<Digits71>().prepare().unwrap().with_law(Wild);
    for (scale, state) in [(1.0, [0.4, 0.7, 0.5, 0.3]), (0.125, [0.2, 0.9, -0.6, 0.8])] {
        let residual = residual(&system, 0.25, &state, scale);
        // The law's own coefficients of order 14: measured 9e11, the same at half of the distance.
        assert!(residual < 1e13, "{residual:e}");
    }
    let long = |n: i64, d: i64| Digits71::from_ratio(n, d);
    let constants = Cart { m: long(1, 5), M: long(1, 1), l: long(1, 2), g: long(981, 100), k: long(1, 3) };
    let law = constants.prepare().unwrap().with_law(Wild);
    let residual = residual(&law, 0.5, &[0.3, 0.2, 0.1, 0.6, -0.4], 0.5);
    assert!(residual < 1e10, "{residual:e}");
}

mod shared {
    guen_benchmarks::hoop!(guen::mechanical_system; provide taylor;);
    guen_benchmarks::turntable!(guen::mechanical_system; provide taylor;);
    guen_benchmarks::euler_top!(guen::mechanical_system; provide taylor;);
    guen_benchmarks::robot!(guen::mechanical_system; provide taylor;);
    guen_benchmarks::train!(guen::mechanical_system; provide taylor;);
}

/// Several states of a system, drawn at random where its charts are far from their edges.
fn at_random<S, const N: usize>(name: &str, system: &S)
where
    S: TaylorSeries<Digits71, N>,
{
    let mut random = guen_benchmarks::Random::new(7);
    for _ in 0..4 {
        let state = std::array::from_fn(|_| random.between(0.4, 1.1));
        let residual = residual(system, random.between(-1.0, 1.0), &state, 0.25);
        // The next coefficient is some power of the largest rate: of the top it reaches 1e14.
        assert!(residual < 1e17, "{name}: {residual:e}");
    }
}

#[test]
fn systems_of_every_kind() {
    let of = Digits71::from_ratio;
    let one = of(1, 1);
    at_random("hoop", &shared::Hoop { a: one, A: of(1, 2), C: one, g: of(981, 100) }.prepare().unwrap());
    let table = shared::Turntable { m: one, a: of(1, 2), Omega: one, swing: of(1, 3), nu: of(3, 2) };
    at_random("turntable", &table.prepare().unwrap());
    at_random("top", &shared::EulerTop { I1: one, I2: of(3, 2), I3: of(2, 1) }.prepare().unwrap());
    let (m, part) = (one, of(1, 10));
    let robot = shared::Robot {
        m,
        mw: part,
        h: part,
        b: part,
        r: part,
        A: part,
        B: part,
        C: part,
        I: part,
        J: part,
        g: of(981, 100),
    };
    let inputs = shared::robot::Inputs { left_torque: part, right_torque: -part };
    at_random("robot", &robot.prepare().unwrap().driven(inputs));
    let train = shared::Train { m, I: part, l: one, d: one, k: part };
    let inputs = shared::train::Inputs { push: one, steering: part };
    at_random("train", &train.prepare().unwrap().driven(inputs));
}
