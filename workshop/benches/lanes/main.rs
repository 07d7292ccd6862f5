//! Right-hand sides in lanes: derived against written by hand over the same lanes, and lanes against plain `f64`.
//!
//! ```text
//! cargo bench -p guen-benchmarks --bench lanes                                    # a default build: instructions chosen at run time
//! RUSTFLAGS="-C target-cpu=native" cargo bench -p guen-benchmarks --bench lanes
//! ```
//!
//! Throughput over 1024 states, in nanoseconds for each. Every figure is the median of [`PAIRS`] rounds in which the
//! candidates take turns; a ratio is the median of the ratios of the rounds.

mod chain;
mod ensemble;
mod hoop;

use std::hint::black_box;
use std::time::Instant;

use guen::System;
use guen::lanes::{Backend, LaneTask, Lanes, Width, dispatch_on};
use guen_benchmarks::systems::{Chain10, Hoop, chain10, hoop as declared_hoop};

/// The number of states.
const STATES: usize = 1024;
/// Rounds, and passes over all states in each.
const PAIRS: usize = 61;
const PASSES: usize = 20;

/// What can be timed in any lanes: a right-hand side derived and one by hand.
trait Subject<const N: usize>: Copy {
    fn state(&self, index: usize) -> [f64; N];
    fn derived<L: Lanes>(&self) -> impl Fn(&[L; N]) -> [L; N] + Copy;
    fn by_hand<L: Lanes>(&self) -> impl Fn(&[L; N]) -> [L; N] + Copy;
}

#[derive(Clone, Copy)]
struct HoopSubject(declared_hoop::Prepared);

impl Subject<9> for HoopSubject {
    fn state(&self, i: usize) -> [f64; 9] {
        let x = i as f64 / STATES as f64;
        [0.5 + x, 6.0 * x, 1.0, 0.0, 0.0, 0.8, x - 0.4, 3.0 - x, 0.9 + x]
    }

    fn derived<L: Lanes>(&self) -> impl Fn(&[L; 9]) -> [L; 9] + Copy {
        let system: declared_hoop::Prepared<L> = self.0.lift();
        #[inline(always)]
        move |state| System::rhs(&system, L::zero(), state)
    }

    fn by_hand<L: Lanes>(&self) -> impl Fn(&[L; 9]) -> [L; 9] + Copy {
        let hoop::ByHand { a, k } = hoop::ByHand::new(1.0, 0.5, 1.0, 9.81);
        let program = hoop::ByHand { a: L::from_f64(a), k: k.map(L::from_f64) };
        #[inline(always)]
        move |state| program.rhs(state)
    }
}

#[derive(Clone, Copy)]
struct ChainSubject(chain10::Prepared);

impl Subject<20> for ChainSubject {
    fn state(&self, i: usize) -> [f64; 20] {
        let x = i as f64 / STATES as f64;
        std::array::from_fn(|k| (x + k as f64 * 0.7).sin())
    }

    fn derived<L: Lanes>(&self) -> impl Fn(&[L; 20]) -> [L; 20] + Copy {
        let system: chain10::Prepared<L> = self.0.lift();
        #[inline(always)]
        move |state| System::rhs(&system, L::zero(), state)
    }

    fn by_hand<L: Lanes>(&self) -> impl Fn(&[L; 20]) -> [L; 20] + Copy {
        let constants = self.0.constants();
        let program = chain::ByHand { ratio: L::from_f64(constants.g / constants.l) };
        #[inline(always)]
        move |state| program.rhs(state)
    }
}

/// Both right-hand sides of a subject over all states; gives seconds for a state of both and the largest difference.
struct Timed<S, const N: usize>(S);

impl<S: Subject<N>, const N: usize> LaneTask for Timed<S, N> {
    type Output = [Vec<f64>; 2];

    fn run<L: Lanes>(self) -> Self::Output {
        let states: Vec<[L; N]> = (0..STATES / L::COUNT)
            .map(|group| {
                let lanes: Vec<[f64; N]> =
                    (0..L::COUNT).map(|lane| self.0.state(group * L::COUNT + lane)).collect();
                std::array::from_fn(|i| L::from_fn(|lane| lanes[lane][i]))
            })
            .collect();
        let mut rates = states.clone();
        let (derived, by_hand) = (self.0.derived::<L>(), self.0.by_hand::<L>());
        passes(&states, &mut rates, derived);
        let first = rates.clone();
        passes(&states, &mut rates, by_hand);
        agree(&first, &rates);
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..PAIRS {
            times[0].push(passes(&states, &mut rates, derived));
            times[1].push(passes(&states, &mut rates, by_hand));
        }
        times
    }
}

/// Nanoseconds for a state.
#[inline(never)]
fn passes<L: Lanes, const N: usize>(
    states: &[[L; N]],
    rates: &mut [[L; N]],
    rhs: impl Fn(&[L; N]) -> [L; N] + Copy,
) -> f64 {
    let begin = Instant::now();
    for _ in 0..PASSES {
        let states = black_box(states);
        // Both candidates are compiled for the lanes, in one loop over the states.
        L::vectorize(
            #[inline(always)]
            || {
                for (state, rates) in states.iter().zip(rates.iter_mut()) {
                    *rates = rhs(state);
                }
            },
        );
        black_box(&rates);
    }
    begin.elapsed().as_secs_f64() * 1e9 / (PASSES * STATES) as f64
}

fn agree<L: Lanes, const N: usize>(first: &[[L; N]], second: &[[L; N]]) {
    for (first, second) in first.iter().flatten().zip(second.iter().flatten()) {
        for lane in 0..L::COUNT {
            let (x, y) = (first.lane(lane), second.lane(lane));
            assert!((x - y).abs() <= 1e-9 * (1.0 + x.abs()), "{x} {y}");
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn table<S: Subject<N>, const N: usize>(name: &str, subject: S) {
    println!("\n{name}, ns for a state        derived   by hand   ratio   gain over f64");
    let mut scalar = 0.0;
    for backend in Backend::ALL.into_iter().filter(|backend| backend.is_available()) {
        for width in [Width::One, Width::Four, Width::Eight] {
            if width == Width::One && backend != Backend::Portable {
                continue;
            }
            let [derived, by_hand] = dispatch_on(backend, width, Timed(subject));
            let ratio = median(derived.iter().zip(&by_hand).map(|(d, h)| d / h).collect());
            let (derived, by_hand) = (median(derived), median(by_hand));
            if width == Width::One {
                scalar = derived;
            }
            println!(
                "  {:<9} {:>2} lanes {derived:>18.2} {by_hand:>9.2} {ratio:>7.3} {:>10.2}",
                format!("{backend:?}"),
                width.lanes(),
                scalar / derived,
            );
        }
    }
}

fn main() {
    let hoop = Hoop { a: 1.0, A: 0.5, C: 1.0, g: 9.81 }.prepare().expect("constants are in order");
    let chain = Chain10 { m: 0.7, l: 0.4, g: 9.81 }.prepare().expect("constants are in order");
    println!("built for AVX2: {}, run with: {:?}", cfg!(target_feature = "avx2"), Backend::best());
    table("hoop", HoopSubject(hoop));
    table("chain of 10", ChainSubject(chain));
    ensemble::table(hoop);
}
