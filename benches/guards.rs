//! What guards cost: runs with the default guard and with none beyond finiteness, in turn.
//!
//! ```text
//! cargo bench --bench guards
//! python3 benches/guard_instructions.py      # the ratio of instructions, which decides; needs valgrind
//! ```
//!
//! Runs of the paper's hoop and sled, of a chain of ten links, and of the cheapest systems that there are, a particle
//! without forces and a mass on a spring: there a look costs most beside a step. With a run and `plain` or `guarded` as
//! arguments that run alone is made, twice as often with a `2` behind, and nothing printed: what callgrind counts. `list`
//! names the runs.

use std::hint::black_box;
use std::time::Instant;

use guen::lanes::{LaneTask, Lanes, Width, dispatch};
use guen::prelude::*;
use guen::steppers::Method;
use guen::{Differentiable, Laned, TaylorSeries};
use guen_benchmarks::systems::{Chain10, chain10};
use guen_benchmarks::{hoop, sled};

hoop! { guen::mechanical_system; provide taylor; }
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

/// Runs with either guard, by name.
struct Pair {
    name: String,
    run: Box<dyn Fn(Guard)>,
}

fn pair<S, M, const N: usize>(
    system: &'static str,
    method: &'static str,
    of: S,
    start: [f64; N],
    span: f64,
    by: M,
) -> Pair
where
    S: System<f64, N> + 'static,
    M: Method<f64, S, N> + 'static,
{
    let run = Box::new(move |guard: Guard| {
        let start = black_box(&start);
        black_box(
            Integration::new(&of, 0.0, start).guard(guard).run(&by, span).expect("nothing is wrong with it"),
        );
    });
    Pair { name: format!("{system}:{method}"), run }
}

/// Four motions that begin next to each other, in as many lanes.
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
            Rk4 { step: 1e-3 }.guarded_in_lanes(&system, (0.0, &start), &[span], guard, |_, _, _, _| ())
        };
        ends.failed().is_empty()
    }
}

fn in_lanes<S, const N: usize>(system: &'static str, of: S, start: [f64; N], span: f64, eight: bool) -> Pair
where
    S: Laned<N> + 'static,
{
    let run = Box::new(move |guard: Guard| {
        let task = InLanes { of: &of, start: black_box(&start), span, guard, eight };
        assert!(black_box(dispatch(Width::Four, task)), "nothing is wrong with it");
    });
    Pair { name: format!("{system}:{}", if eight { "rk8-lanes" } else { "rk4-lanes" }), run }
}

/// Every method over a span. Steps are such that none is refused; those of a particle without forces grow without limit,
/// so that an observer's course is not what is measured there: adaptive methods are left out of it.
fn pairs_of<S, const N: usize>(name: &'static str, system: S, start: [f64; N], span: f64) -> Vec<Pair>
where
    S: Laned<N> + Differentiable<f64, N> + Copy + 'static,
{
    let mut pairs = vec![
        pair(name, "euler", system, start, span / 4.0, Euler { step: 1e-5 }),
        pair(name, "rk4", system, start, 4.0 * span, Rk4 { step: 1e-3 }),
        pair(name, "rk8", system, start, 20.0 * span, Rk8::new(1e-2)),
        in_lanes(name, system, start, 2.0 * span, false),
        in_lanes(name, system, start, 10.0 * span, true),
        pair(name, "gauss4", system, start, span, Gauss4::new(1e-3)),
        pair(name, "gauss6", system, start, span, Gauss6::new(1e-3)),
    ];
    if name != "free" {
        pairs.extend([
            pair(name, "tsit5", system, start, 20.0 * span, Tsit5::new(1e-9, 1e-9)),
            pair(name, "dop853", system, start, 40.0 * span, Dop853::new(1e-9, 1e-9)),
            pair(name, "radau5", system, start, 4.0 * span, Radau5::new(1e-9, 1e-9)),
        ]);
    }
    pairs
}

/// The same with Taylor's method, for systems that provide their series.
fn with_taylor<S, const N: usize>(name: &'static str, system: S, start: [f64; N], span: f64) -> Vec<Pair>
where
    S: Laned<N> + Differentiable<f64, N> + TaylorSeries<f64, N> + Copy + 'static,
{
    let mut pairs = pairs_of(name, system, start, span);
    pairs.push(pair(name, "taylor", system, start, 20.0 * span, Taylor::new(1e-12)));
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
    let hanging = Chain10 { m: 1.0, l: 0.5, g: 9.81 }.prepare().expect("positive constants");
    let angles: [f64; 20] =
        chain10::State { q1: 0.3, q2: 0.2, q3: -0.1, q4: 0.4, q5: 0.3, ..Default::default() }.into();
    let free = Free { m: 1.5 }.prepare().expect("a positive mass");
    let spring = Spring { m: 1.5, k: 2.0 }.prepare().expect("positive constants");
    let mut pairs = pairs_of("free", free, [0.5, 1.0], 10.0);
    pairs.extend(with_taylor("spring", spring, [0.5, 1.0], 10.0));
    pairs.extend(with_taylor("sled", sliding.expect("positive constants"), sled, 5.0));
    pairs.extend(with_taylor("hoop", rolling, start, 5.0));
    pairs.extend(pairs_of("chain10", hanging, angles, 1.0));
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
