//! What guards cost: runs with the default guard and with none beyond finiteness, in turn.
//!
//! ```text
//! cargo bench -p guen-benchmarks --bench guards
//! python3 workshop/benches/guard_instructions.py      # the ratio of instructions, which decides; needs valgrind
//! ```
//!
//! Runs of the paper's hoop and sled, of Appell's system, of chains of ten and twenty links, and of the cheapest systems that
//! there are, a particle without forces, a mass on a spring and one that must not come to a point: there a look costs most beside
//! a step. `hoop'` is the hoop's carried form, and `hoop32` the hoop in single precision. With a run and `plain` or `guarded` as
//! arguments that run alone is made, twice as often with a `2` behind, and nothing printed: what callgrind counts. `list`
//! names the runs. `taylor-blind` is Taylor's method without its comparison of rates.

use std::hint::black_box;
use std::time::Instant;

use guen::lanes::{LaneTask, Lanes, Width, dispatch};
use guen::prelude::*;
use guen::steppers::Method;
use guen::{Differentiable, Laned, TaylorSeries};
use guen_benchmarks::systems::{Appell, Chain10, Chain20, appell, chain10, chain20};
use guen_benchmarks::{hoop, sled};

hoop! { guen::mechanical_system; provide taylor, carried; }
sled! { guen::mechanical_system; provide taylor; }

guen::mechanical_system! {
    /// A particle that nothing moves: its rates are no operation at all.
    pub system Free {
        constants { m > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy = m/2*v^2;
    }
}

guen::mechanical_system! {
    /// A mass on a spring: one multiplication.
    pub system Spring {
        constants { m > 0, k > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy   = m/2*v^2;
        potential_energy = k/2*x^2;
        provide taylor;
    }
}

guen::mechanical_system! {
    /// A mass that is repelled from a point: an edge, and little else.
    pub system Well {
        constants { m > 0, k > 0 }
        coordinates { x }
        parameters { v = dot(x); }
        kinetic_energy   = m/2*v^2;
        potential_energy = k/x + k*x;
    }
}

guen::mechanical_system! {
    /// The chain of twenty links, with its series.
    pub system Links {
        constants { m > 0, l > 0, g = 9.81 }
        coordinates {
            q1, q2, q3, q4, q5, q6, q7, q8, q9, q10, q11, q12, q13, q14, q15, q16, q17, q18, q19, q20
        }
        let p1 = vec(l*sin(q1), -l*cos(q1));
        let p2 = p1 + vec(l*sin(q2), -l*cos(q2));
        let p3 = p2 + vec(l*sin(q3), -l*cos(q3));
        let p4 = p3 + vec(l*sin(q4), -l*cos(q4));
        let p5 = p4 + vec(l*sin(q5), -l*cos(q5));
        let p6 = p5 + vec(l*sin(q6), -l*cos(q6));
        let p7 = p6 + vec(l*sin(q7), -l*cos(q7));
        let p8 = p7 + vec(l*sin(q8), -l*cos(q8));
        let p9 = p8 + vec(l*sin(q9), -l*cos(q9));
        let p10 = p9 + vec(l*sin(q10), -l*cos(q10));
        let p11 = p10 + vec(l*sin(q11), -l*cos(q11));
        let p12 = p11 + vec(l*sin(q12), -l*cos(q12));
        let p13 = p12 + vec(l*sin(q13), -l*cos(q13));
        let p14 = p13 + vec(l*sin(q14), -l*cos(q14));
        let p15 = p14 + vec(l*sin(q15), -l*cos(q15));
        let p16 = p15 + vec(l*sin(q16), -l*cos(q16));
        let p17 = p16 + vec(l*sin(q17), -l*cos(q17));
        let p18 = p17 + vec(l*sin(q18), -l*cos(q18));
        let p19 = p18 + vec(l*sin(q19), -l*cos(q19));
        let p20 = p19 + vec(l*sin(q20), -l*cos(q20));
        parameters {
            w1 = dot(q1); w2 = dot(q2); w3 = dot(q3); w4 = dot(q4); w5 = dot(q5);
            w6 = dot(q6); w7 = dot(q7); w8 = dot(q8); w9 = dot(q9); w10 = dot(q10);
            w11 = dot(q11); w12 = dot(q12); w13 = dot(q13); w14 = dot(q14); w15 = dot(q15);
            w16 = dot(q16); w17 = dot(q17); w18 = dot(q18); w19 = dot(q19); w20 = dot(q20);
        }
        particles {
            m at p1; m at p2; m at p3; m at p4; m at p5; m at p6; m at p7;
            m at p8; m at p9; m at p10; m at p11; m at p12; m at p13; m at p14;
            m at p15; m at p16; m at p17; m at p18; m at p19; m at p20;
        }
        gravity = vec(0, -g);
        provide taylor;
    }
}

/// Runs with either guard, by name.
struct Pair {
    name: String,
    run: Box<dyn Fn(Guard)>,
}

fn pair<R, S, M, const N: usize>(
    system: &'static str,
    method: &'static str,
    of: S,
    start: [R; N],
    span: R,
    by: M,
) -> Pair
where
    R: Real,
    S: System<R, N> + 'static,
    M: Method<R, S, N> + 'static,
{
    let run = Box::new(move |guard: Guard| {
        let start = black_box(&start);
        black_box(
            Integration::new(&of, R::zero(), start)
                .guard(guard)
                .run(&by, span)
                .expect("nothing is wrong with it"),
        );
    });
    Pair { name: format!("{system}:{method}"), run }
}

/// Motions that begin next to each other, in as many lanes.
struct InLanes<'a, S, const N: usize> {
    of: &'a S,
    start: &'a [f64; N],
    span: f64,
    guard: Guard,
    /// By RK8 in place of RK4.
    eight: bool,
}

impl<S: Laned<N>, const N: usize> LaneTask for InLanes<'_, S, N> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let Self { of, start, span, guard, eight } = self;
        let system = S::gather::<L>(|_| of);
        let start: [L; N] = std::array::from_fn(|i| L::from_fn(|k| start[i] * (1.0 + 0.01 * k as f64)));
        let ends = if eight {
            Rk8::new(1e-2).guarded_in_lanes(&system, (0.0, &start), &[span], guard, |_, _, _, _| ())
        } else {
            Rk4::new(1e-3).guarded_in_lanes(&system, (0.0, &start), &[span], guard, |_, _, _, _| ())
        };
        ends.failed().is_empty()
    }
}

/// In lanes, four by both methods and eight by one.
fn in_lanes<S, const N: usize>(system: &'static str, of: S, start: [f64; N], span: f64) -> Vec<Pair>
where
    S: Laned<N> + Copy + 'static,
{
    let runs = [
        ("rk4-lanes", Width::Four, false),
        ("rk4-8-lanes", Width::Eight, false),
        ("rk8-lanes", Width::Four, true),
    ];
    runs.map(|(method, width, eight)| {
        let run = Box::new(move |guard: Guard| {
            let span = if eight { 5.0 * span } else { span };
            let task = InLanes { of: &of, start: black_box(&start), span, guard, eight };
            assert!(black_box(dispatch(width, task)), "nothing is wrong with it");
        });
        Pair { name: format!("{system}:{method}"), run: run as _ }
    })
    .into()
}

/// Explicit methods with a fixed step.
fn fixed<S, const N: usize>(name: &'static str, system: S, start: [f64; N], span: f64) -> Vec<Pair>
where
    S: Laned<N> + Copy + 'static,
{
    let mut pairs = vec![
        pair(name, "euler", system, start, span / 4.0, Euler::new(1e-5)),
        pair(name, "rk4", system, start, 4.0 * span, Rk4::new(1e-3)),
        pair(name, "rk8", system, start, 20.0 * span, Rk8::new(1e-2)),
    ];
    pairs.extend(in_lanes(name, system, start, 2.0 * span));
    pairs
}

/// Every method over a span. Steps are such that none is refused; those of a particle without forces grow without limit,
/// so that an observer's course is not what is measured there: adaptive methods are left out of it.
fn pairs_of<S, const N: usize>(name: &'static str, system: S, start: [f64; N], span: f64) -> Vec<Pair>
where
    S: Laned<N> + Differentiable<f64, N> + Copy + 'static,
{
    let mut pairs = fixed(name, system, start, span);
    pairs.extend([
        pair(name, "gauss4", system, start, span, Gauss4::new(1e-3)),
        pair(name, "gauss6", system, start, span, Gauss6::new(1e-3)),
    ]);
    if name != "free" {
        pairs.extend([
            pair(name, "tsit5", system, start, 20.0 * span, Tsit5::new(1e-9, 1e-9)),
            pair(name, "dop853", system, start, 40.0 * span, Dop853::new(1e-9, 1e-9)),
            pair(name, "radau5", system, start, 4.0 * span, Radau5::new(1e-9, 1e-9)),
        ]);
    }
    pairs
}

/// Taylor's method, and what it is without the comparison of rates.
fn by_taylor<S, const N: usize>(name: &'static str, system: S, start: [f64; N], span: f64) -> [Pair; 2]
where
    S: TaylorSeries<f64, N> + Copy + 'static,
{
    let method = Taylor::new(1e-12, 1e-12);
    [("taylor", method), ("taylor-blind", method.without_comparison())]
        .map(|(word, method)| pair(name, word, system, start, span, method))
}

/// The same with Taylor's method, for systems that provide their series.
fn with_taylor<S, const N: usize>(name: &'static str, system: S, start: [f64; N], span: f64) -> Vec<Pair>
where
    S: Laned<N> + Differentiable<f64, N> + TaylorSeries<f64, N> + Copy + 'static,
{
    let mut pairs = pairs_of(name, system, start, span);
    pairs.extend(by_taylor(name, system, start, 20.0 * span));
    pairs
}

fn pairs() -> Vec<Pair> {
    let rolling = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().expect("positive constants");
    let start: [f64; 9] = hoop::State {
        theta: 1.1,
        zeta: 1.1_f64.sin(),
        eta1: 0.4,
        eta2: 0.9,
        eta3: 2.5,
        ..Default::default()
    }
    .into();
    let sliding = Sled { m: 1.0, alpha: 0.2, beta: 0.3, k: 0.4, incline: 0.3, g: 9.81 }.prepare();
    let sled: [f64; 5] = sled::State { phi: 0.3, eta1: 0.7, eta2: 0.5, ..Default::default() }.into();
    let single = Hoop { a: 1.0_f32, A: 0.5, C: 1.0, g: 9.81 }.prepare().expect("positive constants");
    let carried = rolling.carried().expect("nothing is infinite");
    let lifted: [f64; 13] = hoop::State::from(start).carried(&carried, 0.0).into();
    let crank = Appell { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().expect("positive constants");
    let pushed: [f64; 9] =
        appell::State { theta: 1.1, eta1: 0.4, eta2: 0.9, eta3: 2.5, ..Default::default() }.into();
    let long = Chain20 { m: 1.0, l: 0.5, g: 9.81 }.prepare().expect("positive constants");
    let bent: [f64; 40] = chain20::State { q1: 0.3, q5: 0.2, q9: -0.1, ..Default::default() }.into();
    let hanging = Chain10 { m: 1.0, l: 0.5, g: 9.81 }.prepare().expect("positive constants");
    let angles: [f64; 20] =
        chain10::State { q1: 0.3, q2: 0.2, q3: -0.1, q4: 0.4, q5: 0.3, ..Default::default() }.into();
    let free = Free { m: 1.5 }.prepare().expect("a positive mass");
    let spring = Spring { m: 1.5, k: 2.0 }.prepare().expect("positive constants");
    let well = Well { m: 1.5, k: 2.0 }.prepare().expect("positive constants");
    let mut pairs = pairs_of("free", free, [0.5, 1.0], 10.0);
    pairs.extend(pairs_of("well", well, [0.5, 1.0], 10.0));
    pairs.extend(with_taylor("spring", spring, [0.5, 1.0], 10.0));
    pairs.extend(with_taylor("sled", sliding.expect("positive constants"), sled, 5.0));
    pairs.extend(fixed("appell", crank, pushed, 1.0));
    pairs.extend(with_taylor("hoop", rolling, start, 5.0));
    // Not in lanes, whose starts would no longer be sines and cosines.
    pairs.push(pair("hoop'", "euler", carried, lifted, 1.25, Euler::new(1e-5)));
    pairs.push(pair("hoop'", "rk4", carried, lifted, 20.0, Rk4::new(1e-3)));
    pairs.push(pair("hoop'", "rk8", carried, lifted, 100.0, Rk8::new(1e-2)));
    let short = start.map(|x| x as f32);
    pairs.push(pair("hoop32", "euler", single, short, 1.0, Euler::new(1e-4)));
    pairs.push(pair("hoop32", "rk4", single, short, 10.0, Rk4::new(1e-3)));
    pairs.push(pair("hoop32", "rk8", single, short, 100.0, Rk8::new(1e-2)));
    pairs.extend(pairs_of("chain10", hanging, angles, 1.0));
    pairs.extend(fixed("chain20", long, bent, 1.0));
    let linked = Links { m: 1.0, l: 0.5, g: 9.81 }.prepare().expect("positive constants");
    pairs.extend(by_taylor("chain20", linked, bent, 20.0));
    pairs
}

fn seconds(run: &dyn Fn(Guard), guard: Guard) -> f64 {
    let start = Instant::now();
    run(guard);
    start.elapsed().as_secs_f64()
}

fn main() {
    const ROUNDS: usize = 61;
    let arguments: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with("--")).collect();
    match &arguments[..] {
        [] => {}
        [word] => {
            if word == "list" {
                pairs().iter().for_each(|pair| println!("{}", pair.name));
            }
            return;
        }
        [name, guard, times @ ..] => {
            let guard = if guard == "plain" { Guard::FINITE } else { Guard::default() };
            for pair in pairs().iter().filter(|pair| pair.name == *name) {
                (0..=times.len()).for_each(|_| (pair.run)(guard));
            }
            return;
        }
    }
    println!("{:<16} {:>10} {:>18}", "run", "us", "guarded to plain");
    for Pair { name, run } in pairs() {
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..ROUNDS {
            times[0].push(seconds(&run, Guard::FINITE));
            times[1].push(seconds(&run, Guard::default()));
        }
        let [plain, guarded] = times.map(|mut times| {
            times.sort_by(f64::total_cmp);
            times[ROUNDS / 2]
        });
        println!("{name:<16} {:>10.1} {:>18.3}", 1e6 * plain, guarded / plain);
    }
}
