//! The systems whose right-hand sides are measured, their constants, and their paths to an edge.
//!
//! Constants are numbers that single precision has too, so that all reals compute with the same.

use std::f64::consts::{FRAC_PI_2, PI};

use guen::{Dual, Real};
use guen_benchmarks::{Random, systems};
use guen_study::Digits71;

use super::Job;
use super::measure::{Bounded, kappa};

/// Systems that the benchmarks declare, but have no items of.
mod declared {
    guen_benchmarks::sled_in_xi!(guen::mechanical_system);
    guen_benchmarks::trailer!(guen::mechanical_system);
    guen_benchmarks::turntable!(guen::mechanical_system);
    guen_benchmarks::cart!(guen::mechanical_system);
    guen_benchmarks::particle_pendulum!(guen::mechanical_system);
    guen_benchmarks::robot!(guen::mechanical_system);
    guen_benchmarks::train!(guen::mechanical_system);
    guen_benchmarks::road_train!(guen::mechanical_system);
    guen_benchmarks::rig!(guen::mechanical_system);
    guen_benchmarks::belt_ball!(guen::mechanical_system);
    guen_benchmarks::quaternion_hoop!(guen::mechanical_system);
    guen_benchmarks::rattleback!(guen::mechanical_system);
    guen_benchmarks::quaternion_rattleback!(guen::mechanical_system);
    guen_benchmarks::rate_rattleback!(guen::mechanical_system);
}

/// The prepared system in one real, driven by held inputs if it has any.
macro_rules! prepared {
    ($from:ident::$module:ident::$System:ident { $($constant:ident: $value:expr),* } $(driven { $($input:ident: $held:expr),* })?) => {
        $from::$System { $($constant: $value),* }.prepare()
            $(.map(|prepared| prepared.driven($from::$module::Inputs { $($input: $held),* })))?
    };
}

/// A job: the system with its constants in all reals, its numbers of parameters, of entries and of constants, its random
/// states, and its path to an edge.
macro_rules! bounded {
    ($name:literal, $from:ident::$module:ident::$System:ident { $($constant:ident: $value:expr),* $(,)? }
        $(driven { $($input:ident: $held:expr),* })?,
        $parameters:literal parameters, $n:literal + $c:literal = $m:literal, $state:expr, $path:expr) => {
        ($name, Box::new(|states| {
            let long = $from::$System { $($constant: From::from(Digits71::from_f64($value))),* }.prepare();
            let long = long.expect("constants in their bounds");
            let double = prepared!($from::$module::$System { $($constant: From::from($value)),* } $(driven { $($input: $held),* })?);
            let mut direction = $n;
            let mut variable = |value: f64| {
                direction += 1;
                Dual::<Digits71, $m>::variable(Digits71::from_f64(value), direction - 1)
            };
            let varied = prepared!($from::$module::$System { $($constant: From::from(variable($value))),* }
                $(driven { $($input: Dual::constant(Digits71::from_f64($held))),* })?);
            let bounded = Bounded::<_, _, _, _, $n, $c> {
                name: $name,
                parameters: $parameters,
                double: double.expect("constants in their bounds"),
                single: prepared!($from::$module::$System { $($constant: From::from($value as f32)),* }
                    $(driven { $($input: $held as f32),* })?).map_err(|error| error.to_string()),
                varied: varied.expect("constants in their bounds"),
                kappa: move |t, x: &[f64; $n]| {
                    let state = $from::$module::State::from(x.map(Digits71::from_f64));
                    let t = Digits71::from_f64(t);
                    $(let held = $from::$module::Inputs { $($input: Digits71::from_f64($held)),* };)?
                    kappa(long.mass_form(t, &state $(, { let _ = stringify!($($input)*); &held })?).mass)
                },
                constants: [$($value),*],
            };
            bounded.measure::<$m>(states, $state, $path)
        }) as Job)
    };
}

fn anywhere<const N: usize>(random: &mut Random) -> [f64; N] {
    std::array::from_fn(|_| random.between(-2.0, 2.0))
}

/// How far from the edge: from one to 1e-12.
fn distance(part: f64) -> f64 {
    10.0_f64.powf(-12.0 * part)
}

/// Draws one of two angles.
fn either(random: &mut Random, angles: [f64; 2]) -> f64 {
    angles[usize::from(random.bits() & 1 == 1)]
}

/// Paths of states that are anywhere but for some entries, which go to one of two angles each.
fn to<const N: usize, const I: usize>(
    entries: [usize; I],
    angles: [f64; 2],
) -> impl Fn(&mut Random, f64) -> [f64; N] {
    move |random, part| {
        let mut x: [f64; N] = anywhere(random);
        for i in entries {
            // From either side, by up to two distances.
            x[i] = either(random, angles) + x[i] * distance(part);
        }
        x
    }
}

/// The first entries, which are a quaternion, brought to length one.
fn turned<const N: usize>(mut x: [f64; N]) -> [f64; N] {
    let length = x[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
    x[..4].iter_mut().for_each(|q| *q /= length);
    x
}

/// Next to one axis of its own: a turn by a small angle, or by one that is nearly half a turn.
fn nearly_turned<const N: usize>(random: &mut Random, part: f64) -> [f64; N] {
    let mut x: [f64; N] = anywhere(random);
    let kept = (random.bits() % 4) as usize;
    x[..4].iter_mut().enumerate().for_each(|(i, q)| *q = if i == kept { 1.0 } else { *q * distance(part) });
    turned(x)
}

/// Turned by nearly half a turn: the first entry of the quaternion is small.
fn nearly_half_a_turn<const N: usize>(random: &mut Random, part: f64) -> [f64; N] {
    let mut x: [f64; N] = anywhere(random);
    x[0] *= distance(part);
    turned(x)
}

/// The first two entries on a circle of radius `l`, at this angle.
fn on_circle<const N: usize>(mut x: [f64; N], angle: f64, l: f64) -> [f64; N] {
    (x[0], x[1]) = (l * angle.sin(), -l * angle.cos());
    x
}

const FLAT: [f64; 2] = [0.0, PI];
const QUARTERS: [f64; 2] = [FRAC_PI_2, -FRAC_PI_2];

/// The paper's systems, and what rolls.
fn rolling() -> Vec<(&'static str, Job)> {
    vec![
        bounded!("hoop", systems::hoop::Hoop { a: 0.75, A: 0.5, C: 1.25, g: 9.8125 },
            3 parameters, 9 + 4 = 13, anywhere, to([0], FLAT)),
        bounded!("hoop as a body", systems::body_hoop::BodyHoop { a: 0.75, A: 0.5, C: 1.25, g: 9.8125 },
            3 parameters, 9 + 4 = 13, anywhere, to([0], FLAT)),
        bounded!("hoop in velocities", systems::rate_hoop::RateHoop { a: 0.75, A: 0.5, C: 1.25, g: 9.8125 },
            3 parameters, 9 + 4 = 13, anywhere, to([0], FLAT)),
        // Flat where the axle is upright: two entries of the quaternion vanish.
        bounded!("hoop in quaternions", declared::quaternion_hoop::QuaternionHoop { a: 0.75, A: 0.5, C: 1.25, g: 9.8125 },
            3 parameters, 10 + 4 = 14, |random| turned(anywhere(random)), nearly_turned),
        bounded!("appell", systems::appell::Appell { a: 0.75, A: 0.5, C: 1.25, g: 9.8125 },
            3 parameters, 9 + 4 = 13, anywhere, to([0], FLAT)),
        bounded!("turntable", systems::even_turntable::EvenTurntable { m: 1.5, a: 0.125, Omega: 0.75 },
            3 parameters, 8 + 3 = 11, anywhere, to([3], FLAT)),
        bounded!("turntable that swings",
            declared::turntable::Turntable { m: 1.5, a: 0.125, Omega: 0.75, swing: 0.5, nu: 1.25 },
            3 parameters, 8 + 5 = 13, anywhere, to([3], FLAT)),
        bounded!("ball on a belt", declared::belt_ball::BeltBall { m: 1.5, a: 0.125, A: 0.5, B: 0.75, C: 1.0, u: 0.5, nu: 1.25 },
            3 parameters, 9 + 7 = 16, |random| turned(anywhere(random)), nearly_turned),
        bounded!("rattleback",
            declared::rattleback::Rattleback {
                m: 1.5, a: 2.0, b: 0.5, c: 0.375, h: 0.125, A: 0.25, B: 1.5, C: 1.625, D: -0.0625, g: 9.8125
            },
            3 parameters, 9 + 10 = 19, anywhere, to([1], QUARTERS)),
        bounded!("rattleback in quaternions",
            declared::quaternion_rattleback::QuaternionRattleback {
                m: 1.5, a: 2.0, b: 0.5, c: 0.375, h: 0.125, A: 0.25, B: 1.5, C: 1.625, D: -0.0625, g: 9.8125
            },
            3 parameters, 10 + 10 = 20, |random| turned(anywhere(random)), nearly_turned),
        bounded!("rattleback in rates of a quaternion",
            declared::rate_rattleback::RateRattleback {
                m: 1.5, a: 2.0, b: 0.5, c: 0.375, h: 0.125, A: 0.25, B: 1.5, C: 1.625, D: -0.0625, g: 9.8125
            },
            3 parameters, 10 + 10 = 20, |random| turned(anywhere(random)), nearly_half_a_turn),
        bounded!("top", systems::euler_top::EulerTop { I1: 1.0, I2: 2.5, I3: 3.25 },
            3 parameters, 6 + 3 = 9, anywhere, to([1], FLAT)),
    ]
}

/// Sleds and vehicles. Those without an edge go to the headings at which terms of theirs vanish.
fn vehicles() -> Vec<(&'static str, Job)> {
    vec![
        bounded!("sled",
            systems::sled::Sled { m: 1.5, alpha: 0.25, beta: 0.5, k: 0.75, incline: 0.375, g: 9.8125 },
            2 parameters, 5 + 6 = 11, anywhere, to([0], [0.0, FRAC_PI_2])),
        bounded!("sled, gamma^2 - beta^2 = 3e-7",
            systems::sled::Sled { m: 1.5, alpha: 1.0 / 4096.0, beta: 1.0, k: 1.0 / 2048.0, incline: 0.375, g: 9.8125 },
            2 parameters, 5 + 6 = 11, anywhere, to([0], [0.0, FRAC_PI_2])),
        bounded!("sled, gamma^2 - beta^2 = 1e-14",
            systems::sled::Sled {
                m: 1.5, alpha: 5.0 / 134_217_728.0, beta: 1.0, k: 13.0 / 134_217_728.0, incline: 0.375, g: 9.8125
            },
            2 parameters, 5 + 6 = 11, anywhere, to([0], [0.0, FRAC_PI_2])),
        bounded!("sled in xi",
            declared::sled_in_xi::SledInXi { m: 1.5, alpha: 0.25, beta: 0.5, k: 0.75, incline: 0.375, g: 9.8125 },
            2 parameters, 5 + 6 = 11, anywhere, to([0], QUARTERS)),
        bounded!("trailer", declared::trailer::Trailer { m: 1.5, J: 0.75, M: 2.5, K: 0.5, d: 1.25 },
            2 parameters, 6 + 5 = 11, anywhere, to([2, 3], QUARTERS)),
        bounded!("car with 1 trailer",
            systems::car1::Car1 { m: 3.0, J: 2.0, I: 0.125, l: 2.0, M: 1.0, K: 0.5, d: 1.5 },
            2 parameters, 7 + 7 = 14, anywhere, to([3], QUARTERS)),
        bounded!("car with 2 trailers",
            systems::car2::Car2 { m: 3.0, J: 2.0, I: 0.125, l: 2.0, M: 1.0, K: 0.5, d: 1.5 },
            2 parameters, 8 + 7 = 15, anywhere, to([3], QUARTERS)),
        bounded!("car with 3 trailers",
            systems::car3::Car3 { m: 3.0, J: 2.0, I: 0.125, l: 2.0, M: 1.0, K: 0.5, d: 1.5 },
            2 parameters, 9 + 7 = 16, anywhere, to([3], QUARTERS)),
        bounded!("train", declared::train::Train { m: 3.0, I: 2.0, l: 2.0, d: 1.5, k: 0.25 }
            driven { push: 0.5, steering: -0.25 },
            2 parameters, 8 + 5 = 13, anywhere, to([5], QUARTERS)),
        bounded!("road train",
            declared::road_train::RoadTrain {
                m: 3.0, J: 2.0, I: 0.125, l: 2.0, M: 1.0, K: 0.5, d: 1.5, k: 0.25
            },
            2 parameters, 11 + 8 = 19, anywhere, to([3], QUARTERS)),
        bounded!("rig",
            declared::rig::Rig { m: 9.0, I: 7.0, w: 0.5, J: 0.25, r: 0.375, l: 2.5, b: 0.75, d: 3.0 }
            driven { push: 0.5, handle: -0.25 },
            2 parameters, 12 + 8 = 20, anywhere, to([3], QUARTERS)),
        bounded!("robot",
            declared::robot::Robot {
                m: 10.0, mw: 1.0, h: 0.5, b: 0.25, r: 0.125, A: 0.5, B: 0.375, C: 0.25, I: 0.00390625, J: 0.0078125, g: 9.8125
            }
            driven { left_torque: 0.5, right_torque: -0.25 },
            3 parameters, 9 + 11 = 20, anywhere, to([3], FLAT)),
    ]
}

/// Pendulums; chains towards the hanging, the upright and the folded state.
fn chains() -> Vec<(&'static str, Job)> {
    vec![
        bounded!("cart", declared::cart::Cart { M: 2.5, m: 0.75, l: 0.5, I: 0.0625, c: 0.125, g: 9.8125 }
            driven { push: 0.5, wind: -0.25 },
            2 parameters, 4 + 6 = 10, anywhere, to([1], FLAT)),
        bounded!("pendulum on a circle", declared::particle_pendulum::ParticlePendulum { m: 0.75, l: 0.5, g: 9.8125 },
        1 parameters, 3 + 3 = 6,
        |random| { let angle = random.between(-2.0, 2.0); on_circle(anywhere(random), angle, 0.5) },
        |random, part| {
            let angle = either(random, [0.0, FRAC_PI_2]) + distance(part);
            on_circle(anywhere(random), angle, 0.5)
        }),
        bounded!("chain of 2", systems::chain2::Chain2 { m: 0.75, l: 0.5, g: 9.8125 },
            2 parameters, 4 + 3 = 7, anywhere, to([0, 1], FLAT)),
        bounded!("chain of 5", systems::chain5::Chain5 { m: 0.75, l: 0.5, g: 9.8125 },
            5 parameters, 10 + 3 = 13, anywhere, to(std::array::from_fn::<usize, 5, _>(|i| i), FLAT)),
        bounded!("chain of 10", systems::chain10::Chain10 { m: 0.75, l: 0.5, g: 9.8125 },
            10 parameters, 20 + 3 = 23, anywhere, to(std::array::from_fn::<usize, 10, _>(|i| i), FLAT)),
        bounded!("chain of 20", systems::chain20::Chain20 { m: 0.75, l: 0.5, g: 9.8125 },
            20 parameters, 40 + 3 = 43, anywhere, to(std::array::from_fn::<usize, 20, _>(|i| i), FLAT)),
        bounded!("2 relative angles", systems::joints2::Joints2 { m: 0.75, l: 0.5, g: 9.8125 },
            2 parameters, 4 + 3 = 7, anywhere, to([0, 1], FLAT)),
        bounded!("5 relative angles", systems::joints5::Joints5 { m: 0.75, l: 0.5, g: 9.8125 },
            5 parameters, 10 + 3 = 13, anywhere, to(std::array::from_fn::<usize, 5, _>(|i| i), FLAT)),
        bounded!("10 relative angles", systems::joints10::Joints10 { m: 0.75, l: 0.5, g: 9.8125 },
            10 parameters, 20 + 3 = 23, anywhere, to(std::array::from_fn::<usize, 10, _>(|i| i), FLAT)),
        bounded!("20 relative angles", systems::joints20::Joints20 { m: 0.75, l: 0.5, g: 9.8125 },
            20 parameters, 40 + 3 = 43, anywhere, to(std::array::from_fn::<usize, 20, _>(|i| i), FLAT)),
    ]
}

/// All of them.
pub fn jobs() -> Vec<(&'static str, Job)> {
    let mut all = rolling();
    all.extend(vehicles());
    all.extend(chains());
    all
}
