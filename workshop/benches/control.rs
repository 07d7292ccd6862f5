//! What a controller costs: the linearisation beside the rates and beside dual numbers, and one period of the balancing
//! robot.
//!
//! ```text
//! cargo bench -p guen-benchmarks --bench control
//! python3 workshop/benches/control_instructions.py
//! ```
//!
//! Times are minima over interleaved rounds, so that what else the machine does falls on all of them alike; the ratios
//! are what is to be compared. The script counts instructions, state by state, which no other work disturbs.

use std::hint::black_box;
use std::time::Instant;

use guen::{Cost, Dual, Lift, Liftable, Linearizable, seeded};
use guen_benchmarks::systems::{BodyHoop, body_hoop};

#[path = "../guen-bare/src/controller.rs"]
mod controller;
#[path = "../guen-bare/src/plant.rs"]
mod plant;

use controller::{Gain, OPERATIONS_PER_PERIOD, Reference};
use plant::Robot;
use plant::robot::{Prepared, State};

guen_benchmarks::train!(guen::mechanical_system);

const ROUNDS: usize = 60;
const CALLS: usize = 2_000;

/// The shortest time of a call of each, in nanoseconds, in rounds that take turns.
fn interleaved<const K: usize>(mut works: [&mut dyn FnMut(usize); K]) -> [f64; K] {
    let mut best = [f64::INFINITY; K];
    for _ in 0..ROUNDS {
        for (work, best) in works.iter_mut().zip(&mut best) {
            let begin = Instant::now();
            (0..CALLS).for_each(&mut **work);
            *best = best.min(begin.elapsed().as_secs_f64() * 1e9 / CALLS as f64);
        }
    }
    best
}

/// States within the stated range: angles up to half a turn, rates up to three per second.
fn states<const N: usize>(count: usize) -> Vec<[f64; N]> {
    let mut seed = 1_u64;
    let mut uniform = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    (0..count).map(|_| std::array::from_fn(|_| 3.0 * uniform())).collect()
}

/// `A` and `B` by forward-mode duals, in directions of the state and of the inputs.
fn by_duals<S, const N: usize, const M: usize>(
    system: &S,
    state: &[f64; N],
    inputs: &[f64; M],
) -> ([[f64; N]; N], [[f64; M]; N])
where
    S: Liftable<f64, N, M>,
    Dual<f64, N>: Lift<f64>,
    Dual<f64, M>: Lift<f64>,
{
    let a = system.lifted_rates(Dual::constant(0.0), &seeded(state), &inputs.map(Dual::constant));
    if M == 0 {
        return (a.map(|x| x.tangent), [[0.0; M]; N]);
    }
    let b = system.lifted_rates(Dual::constant(0.0), &state.map(Dual::constant), &seeded(inputs));
    (a.map(|x| x.tangent), b.map(|x| x.tangent))
}

/// One line: rates, linearisation, duals. Returns whether the bound of 0.7 holds.
fn linearisation<S, const N: usize, const M: usize>(
    name: &str,
    system: &S,
    rhs: Cost,
    own: Option<Cost>,
) -> bool
where
    S: Linearizable<f64, N, M> + Liftable<f64, N, M>,
{
    let (states, inputs) = (states::<N>(CALLS), [0.3; M]);
    let [rates, linear, duals] = interleaved([
        &mut |k| {
            black_box(system.rates(0.0, black_box(&states[k]), &inputs));
        },
        &mut |k| {
            black_box(system.linearization(0.0, black_box(&states[k]), &inputs));
        },
        &mut |k| {
            black_box(by_duals(system, black_box(&states[k]), &inputs));
        },
    ]);
    println!(
        "{name:8} {:6} {:8}   {rates:8.1} {linear:8.1} {duals:8.1}   {:8.2} {:9.3}",
        rhs.total(),
        own.map_or(0, Cost::total),
        linear / rates,
        linear / duals
    );
    linear / duals <= 0.7
}

fn robot() -> Prepared {
    let robot = Robot {
        m: 10.0,
        mw: 1.0,
        h: 0.5,
        b: 0.3,
        r: 0.1,
        A: 0.5,
        B: 0.4,
        C: 0.2,
        I: 0.003,
        J: 0.005,
        c: 0.01,
        torque_max: 3.0,
        g: 9.81,
    };
    robot.prepare().expect("these constants are inside of their bounds")
}

const GAIN: Gain = [[-2.495, -20.99, -3.041, -1.054, -4.426], [2.495, -20.99, -3.041, 1.054, -4.426]];

/// One period, out of line and by name, for the script that counts its instructions.
#[inline(never)]
fn control_period(robot: &Prepared, reference: &Reference, state: &State) -> ([f64; 3], State) {
    let (torques, next) = controller::period(robot, &GAIN, reference, state, 0.005);
    (torques.into(), next)
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let (robot, reference) = (robot(), Reference { heading: 0.3, speed: 0.8, turn: 0.1, torque: 0.08 });
    if let Some(place) = arguments.iter().position(|word| word == "--periods") {
        let count = arguments.get(place + 1).and_then(|word| word.parse().ok()).unwrap_or(1);
        for state in states::<9>(count) {
            black_box(control_period(black_box(&robot), &reference, &state.into()));
        }
        return;
    }
    println!("             operations             ns, shortest of {ROUNDS}          ratio of times");
    println!("system    rates  A and B      rates  A and B    duals    to rates  to duals");
    let hoop =
        BodyHoop { a: 0.5, A: 0.125, C: 0.25, g: 9.81 }.prepare().expect("they are inside of their bounds");
    let train =
        Train { m: 3.0, I: 1.3, l: 1.1, d: 0.9, k: 0.3 }.prepare().expect("they are inside of their bounds");
    let held = [
        linearisation::<_, 9, 0>("hoop", &hoop, body_hoop::COST, body_hoop::LINEARIZATION_COST),
        linearisation::<_, 9, 3>("robot", &robot, plant::robot::COST, plant::robot::LINEARIZATION_COST),
        linearisation::<_, 8, 2>("train", &train, train::COST, train::LINEARIZATION_COST),
    ];
    let states = states::<9>(CALLS);
    let [rates, step, period] = interleaved([
        &mut |k| {
            black_box(robot.rhs(0.0, black_box(&states[k].into()), &Default::default()));
        },
        &mut |k| {
            let driven = robot.driven(Default::default());
            black_box(guen::steppers::rk4::step(&driven, 0.0, black_box(&states[k]), 0.005));
        },
        &mut |k| {
            black_box(control_period(&robot, &reference, black_box(&states[k].into())));
        },
    ]);
    println!("\nbalancing robot, ns: right-hand side {rates:.1}, RK4 {step:.1}, one period {period:.1}");
    println!("one period: {OPERATIONS_PER_PERIOD}");
    if held.contains(&false) {
        eprintln!("a linearisation costs more than 0.7 of duals");
        std::process::exit(1);
    }
}
