//! Mass matrix, Coriolis and gravity forces, Jacobians and operational inertia: compared with closed forms, and with identities that
//! hold for every system.

use guen::control::operational_inertia;

use crate::jacobians::{Cart, Hoop, Sled, cart, hoop, numbers, sled};
use crate::motion::{Roller, roller};
use crate::vehicles::{robot, small_robot};

guen::mechanical_system! {
    /// Two links with a mass at the end of each; the hip is shaken, the force of the motor is not affine in its input.
    pub system Arm {
        constants { m1 > 0, m2 > 0, l1 > 0, l2 > 0, k >= 0, c >= 0, shaken, g = 9.81 }
        inputs { u }
        coordinates { q1, q2 }
        let hip = vec(shaken*sin(3*t), 0);
        let knee = hip + l1*vec(sin(q1), -cos(q1));
        let hand = knee + l2*vec(sin(q1 + q2), -cos(q1 + q2));
        parameters { w1 = dot(q1); w2 = dot(q2); }
        particles { m1 at knee; m2 at hand; }
        gravity = vec(0, -g);
        potential_energy = k/2*q2^2;
        forces { u + u^3*cos(q1) along w1; -c*w2*abs(w2) along w2; }
        outputs { tip = hand; elbow = q2; }
    }
}

fn arm(shaken: f64) -> arm::Prepared {
    Arm { m1: 1.3, m2: 0.7, l1: 0.5, l2: 0.8, k: 2.0, c: 0.4, shaken, g: 9.81 }.prepare().unwrap()
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((found - expected).abs() <= tolerance * (1.0 + expected.abs()), "{what}: {found} and {expected}");
}

/// The double pendulum of every textbook, in relative angles.
#[test]
fn two_links_in_closed_form() {
    let (system, (m1, m2, l1, l2)) = (arm(0.0), (1.3, 0.7, 0.5, 0.8));
    for seed in 1..6 {
        let [q1, q2, w1, w2] = numbers::<4>(seed).map(|x| 2.0 * x);
        let state = arm::State { q1, q2, w1, w2 };
        let lever = m2 * l1 * l2;
        let coupled = m2 * l2 * l2 + lever * q2.cos();
        let expected =
            [[(m1 + m2) * l1 * l1 + m2 * l2 * l2 + 2.0 * lever * q2.cos(), coupled], [coupled, m2 * l2 * l2]];
        let mass = system.mass_matrix(0.3, &state);
        for s in 0..2 {
            (0..2).for_each(|k| assert_near(mass[s][k], expected[s][k], 1e-14, "M"));
        }
        let lower = m2 * 9.81 * l2 * (q1 + q2).sin();
        let gravity = [(m1 + m2) * 9.81 * l1 * q1.sin() + lower, lower + 2.0 * q2];
        let coriolis = [-lever * q2.sin() * (2.0 * w1 + w2) * w2, lever * q2.sin() * w1 * w1];
        let (own, both) = (system.gravity(0.3, &state), system.coriolis_and_gravity(0.3, &state));
        for s in 0..2 {
            assert_near(own[s], gravity[s], 1e-14, "gravity");
            assert_near(both[s], gravity[s] + coriolis[s], 1e-13, "coriolis and gravity");
        }
        // The hand, and what it feels like: the inverse of the sum of both mobilities.
        let (s1, c1) = q1.sin_cos();
        let (s12, c12) = (q1 + q2).sin_cos();
        let jacobian = [[l1 * c1 + l2 * c12, l2 * c12], [l1 * s1 + l2 * s12, l2 * s12]];
        let found = system.jacobian(0.3, &state, |outputs| [outputs.tip[0], outputs.tip[1]]);
        let bias = system.bias_acceleration(0.3, &state, |outputs| [outputs.tip[0], outputs.tip[1]]);
        let (a, b) = (w1 * w1, (w1 + w2) * (w1 + w2));
        let expected = [-l1 * s1 * a - l2 * s12 * b, l1 * c1 * a + l2 * c12 * b];
        for k in 0..2 {
            (0..2).for_each(|s| assert_near(found[k][s], jacobian[k][s], 1e-14, "J"));
            assert_near(bias[k], expected[k], 1e-13, "J' eta");
        }
        assert_eq!(system.jacobian(0.3, &state, |outputs| [outputs.elbow]), [[0.0, 1.0]]);
        let inertia = operational_inertia(&mass, &found).unwrap();
        // J^T Lambda J = M, since the hand has as many directions as the arm.
        for s in 0..2 {
            for k in 0..2 {
                let sum: f64 =
                    (0..4).map(|i| found[i / 2][s] * inertia[i / 2][i % 2] * found[i % 2][k]).sum();
                assert_near(sum, mass[s][k], 1e-10, "J^T Lambda J");
            }
        }
    }
    let stretched = arm::State { q1: 0.4, ..Default::default() };
    let jacobian = system.jacobian(0.0, &stretched, |outputs| [outputs.tip[0], outputs.tip[1]]);
    assert_eq!(operational_inertia(&system.mass_matrix(0.0, &stretched), &jacobian), None);
}

/// Grams beside tons: the units of a mass matrix are no reason to call it singular.
#[test]
fn units_do_not_count() {
    let mass = [[1e-12, 0.0], [0.0, 1e12]];
    let inertia = operational_inertia(&mass, &[[1.0, 0.0], [0.0, 1e3]]).unwrap();
    assert_near(inertia[0][0] / 1e-12, 1.0, 1e-12, "light");
    assert_near(inertia[1][1] / 1e6, 1.0, 1e-12, "heavy");
}

/// What holds of every system at a state: `forces` are those of the declaration without inputs, by hand.
macro_rules! hold {
    ($module:ident, $system:expr, $n:literal, $l:literal, $state:expr, $forces:expr $(, $inputs:expr)?) => {{
        let (t, system) = (0.3, $system);
        let s: [f64; $n + $l] = $state;
        let state = $module::State::from(s);
        let mass = system.mass_matrix(t, &state);
        // The momenta are affine in the quasi-velocities, and the kinetic energy is what they carry.
        for k in 0..$l {
            let mut more = s;
            more[$n + k] += 1.0;
            const COUNT: usize = $module::Momenta::<f64>::NAMES.len();
            let momenta = |s: [f64; $n + $l]| <[f64; COUNT]>::from(system.momenta(t, &s.into()));
            let (before, after) = (momenta(s), momenta(more));
            for i in 0..$l {
                assert_near(mass[i][k], after[i] - before[i], 1e-11, "a momentum");
            }
        }
        // The force function along the velocities that each quasi-velocity makes.
        let gravity = system.gravity(t, &state);
        let velocities = |s: [f64; $n + $l]| <[f64; $n]>::from(system.velocities(t, &s.into()));
        let mut none = s;
        none[$n..].fill(0.0);
        for k in 0..$l {
            let mut one = none;
            one[$n + k] = 1.0;
            let (along, rest) = (velocities(one), velocities(none));
            let h = 1e-5;
            let at = |by: f64| {
                let mut moved = s;
                (0..$n).for_each(|i| moved[i] += by * (along[i] - rest[i]));
                system.force_function(t, &moved.into())
            };
            assert_near(gravity[k], -(at(h) - at(-h)) / (2.0 * h), 1e-7, "a slope of the force function");
        }
        // With the accelerations of the right-hand side nothing is left of the equations.
        let rates: [f64; $n + $l] = system.rhs(t, &state $(, &$inputs)?).into();
        let both = system.coriolis_and_gravity(t, &state);
        let forces: [f64; $l] = $forces;
        for i in 0..$l {
            let inertia: f64 = (0..$l).map(|k| mass[i][k] * rates[$n + k]).sum();
            let size = both[i].abs() + inertia.abs();
            assert_near((inertia + both[i] - forces[i]) / (1.0 + size), 0.0, 1e-10, "an equation");
        }
    }};
}

fn rolling(seed: u64) -> [f64; 9] {
    let mut s = numbers::<9>(seed);
    let norm = s[2..6].iter().map(|q| q * q).sum::<f64>().sqrt();
    s[2..6].iter_mut().for_each(|q| *q /= norm);
    s
}

fn ball() -> roller::Prepared {
    Roller { m: 1.2, r: 0.3, c: 0.05, rate: 0.4 }.prepare().unwrap()
}

/// Holonomic and not, moving, by bodies, in quaternions, with friction and with forces that are not affine.
#[test]
fn equations_of_every_kind() {
    for seed in 1..4 {
        let tilted = |mut s: [f64; 9]| {
            s[0] += 1.5;
            s
        };
        let system = Hoop { a: 0.7, A: 0.4, C: 0.6, g: 9.81 }.prepare().unwrap();
        hold!(hoop, system, 6, 3, tilted(numbers(seed)), [0.0; 3]);
        let system = Sled { m: 2.0, alpha: 0.4, beta: 0.3, k: 0.6, g: 9.81, incline: 0.2 }.prepare().unwrap();
        hold!(sled, system, 3, 2, numbers(seed), [0.0; 2]);
        let wheels = cart::State::from(numbers::<4>(seed));
        let system = Cart { M: 2.0, m: 0.6, l: 0.5, I: 0.05.into(), c: 0.1, g: 9.81 }.prepare().unwrap();
        let friction = [0.0, -0.1 * wheels.omega];
        hold!(cart, system, 2, 2, wheels.into(), friction, cart::Inputs::default());
        hold!(robot, small_robot(), 6, 3, numbers(seed), [0.0; 3], robot::Inputs::default());
        let s = numbers::<4>(seed).map(|x| 2.0 * x);
        hold!(arm, arm(0.2), 2, 2, s, [0.0, -0.4 * s[3] * s[3].abs()], arm::Inputs::default());
        let s = rolling(seed);
        let friction = [-0.05 * s[6], -0.05 * s[7], -0.05 * s[8]];
        hold!(roller, ball(), 6, 3, s, friction, roller::Inputs::default());
    }
}

/// The place of a ball that rolls on a slope which is moved: along a path with constant quasi-velocities its slope is `J eta` and
/// what the slope adds, its second difference the bias; the columns of `J` are those of single quasi-velocities.
#[test]
fn places_along_paths() {
    let (system, t, h) = (ball(), 0.3, 1e-3);
    for seed in 1..4 {
        let s = rolling(seed);
        let path = guen::from_fn(|t: f64, x: &[f64; 6]| {
            let mut moved = s;
            moved[..6].copy_from_slice(x);
            <[f64; 6]>::from(system.velocities(t, &moved.into()))
        });
        let inputs = roller::Inputs::default();
        let at = |by: f64| {
            let mut moved = s;
            let start = std::array::from_fn(|i| s[i]);
            moved[..6].copy_from_slice(&guen::steppers::rk4::step(&path, t, &start, by));
            system.outputs(t + by, &moved.into(), &inputs).place
        };
        let (before, here, after) = (at(-h), at(0.0), at(h));
        let jacobian = system.jacobian(t, &s.into(), |outputs| outputs.place);
        let bias = system.bias_acceleration(t, &s.into(), |outputs| outputs.place);
        for k in 0..3 {
            let turned: f64 = (0..3).map(|i| jacobian[k][i] * s[6 + i]).sum();
            // z = rate sin(t) x, of which the slope's own part is rate cos(t) x.
            let moved = if k == 2 { 0.4 * t.cos() * s[0] } else { 0.0 };
            assert_near(turned + moved, (after[k] - before[k]) / (2.0 * h), 1e-5, "a velocity");
            let second = (after[k] - 2.0 * here[k] + before[k]) / (h * h);
            assert_near(bias[k], second, 1e-5, "a bias");
        }
    }
}

guen::mechanical_system! {
    /// A weight on a turning spoke, held by a spring that is stiff beyond measure.
    pub system Stiff {
        constants { k = 1e15 }
        coordinates { x, q }
        parameters { v = dot(x); w = dot(q); }
        kinetic_energy = (2 + cos(x))*w^2/2 + v^2/2;
        forces { -k*x along v; }
    }
}

guen::mechanical_system! {
    /// The same inertia, with forces that are NaN or infinite at some states.
    pub system Rough {
        inputs { u }
        coordinates { x, q }
        parameters { v = dot(x); w = dot(q); }
        kinetic_energy = (2 + cos(x))*w^2/2 + v^2/2;
        forces { sqrt(u)*w - v/abs(v) along v; ln(w) along w; }
    }
}

/// Declared forces have no part in what inertia asks for, however large they are, and where they are no numbers.
#[test]
fn inertia_without_the_declared_forces() {
    let expected = |x: f64, v: f64, w: f64| [x.sin() * w * w / 2.0, -x.sin() * v * w];
    let stiff = Stiff::default().prepare().unwrap();
    let found = stiff.coriolis_and_gravity(0.0, &stiff::State { x: 0.3, q: 0.0, v: 0.5, w: 0.7 });
    let rough = Rough::default().prepare().unwrap();
    let at_rest = rough.coriolis_and_gravity(0.0, &rough::State { x: 0.3, q: 0.0, v: 0.0, w: -0.7 });
    for (found, expected) in [(found, expected(0.3, 0.5, 0.7)), (at_rest, expected(0.3, 0.0, -0.7))] {
        assert_near(found[0], expected[0], 1e-14, "along the spoke");
        assert_near(found[1], expected[1], 1e-14, "about the hub");
    }
}
