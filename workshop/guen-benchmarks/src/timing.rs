//! A clock for pairs of programs on a machine that has other work to do.
//!
//! Batches of two programs are timed in turn, each pair in the other order than the one before, and every pair gives
//! one ratio. The median of the ratios with the interval of its order statistics says more than two times that were
//! taken one after the other, because what slows the machine slows both.

use std::fmt;
use std::hint::black_box;
use std::time::{Duration, Instant};

use guen::System;
use guen_study::median_with_interval;

pub use crate::processor::processor_time;

/// The states that throughput is measured over: more than a branch predictor remembers, and in the cache.
pub const STATES: usize = 1024;
/// How long a batch lasts, at least.
const BATCH: Duration = Duration::from_micros(1500);

/// A program to time, as a number of repetitions of something.
pub trait Timed {
    /// Repeats the work.
    fn repeat(&mut self, times: usize);
    /// How many evaluations one repetition is.
    fn evaluations(&self) -> usize;
}

/// Evaluations of different states, one after the other, none depending on the one before.
pub struct Throughput<'a, S, const N: usize> {
    /// What is evaluated.
    pub system: S,
    /// Where.
    pub states: &'a [[f64; N]],
}

/// A call like that of generated code in another language, through a function of its own.
#[inline(never)]
fn evaluate<S: System<f64, N>, const N: usize>(system: &S, state: &[f64; N]) -> [f64; N] {
    system.rhs(0.0, state)
}

impl<S: System<f64, N>, const N: usize> Timed for Throughput<'_, S, N> {
    fn repeat(&mut self, times: usize) {
        for _ in 0..times {
            for state in self.states {
                black_box(evaluate(&self.system, state));
            }
        }
    }

    fn evaluations(&self) -> usize {
        self.states.len()
    }
}

/// A chain of evaluations, the state fed back: Euler's method with a step that changes nothing much.
pub struct Latency<S, const N: usize> {
    /// What is evaluated.
    pub system: S,
    /// Where the chain begins.
    pub start: [f64; N],
}

impl<S, const N: usize> Latency<S, N> {
    /// The evaluations of one chain. Short enough for the state to stay where it is.
    const LINKS: usize = 512;
    const STEP: f64 = 1e-9;
}

impl<S: System<f64, N>, const N: usize> Timed for Latency<S, N> {
    fn repeat(&mut self, times: usize) {
        for _ in 0..times {
            let mut state = self.start;
            for _ in 0..Self::LINKS {
                let rates = evaluate(&self.system, &state);
                for (x, rate) in state.iter_mut().zip(&rates) {
                    // One number at a time: paired by the vectoriser, the loads of the next evaluation would wait for
                    // stores of another width, in whichever program happens to be paired.
                    *x = black_box(*x + Self::STEP * rate);
                }
            }
            black_box(state);
        }
    }

    fn evaluations(&self) -> usize {
        Self::LINKS
    }
}

/// Two programs compared.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The shortest time of one evaluation of each, in nanoseconds.
    pub nanoseconds: [f64; 2],
    /// The median of the first one's time divided by the second's, pair by pair.
    pub ratio: f64,
    /// An interval that contains the median of such pairs with a probability of 95 percent at least.
    pub interval: (f64, f64),
}

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, second] = self.nanoseconds;
        write!(
            f,
            "{first:8.2} {second:8.2}   {:5.3} [{:5.3}, {:5.3}]",
            self.ratio, self.interval.0, self.interval.1
        )
    }
}

/// How often a program is repeated to fill a batch.
#[derive(Clone, Copy, Debug)]
pub struct Batch(usize);

impl Batch {
    /// Finds the repetitions, which warms the program up as well.
    pub fn of(program: &mut dyn Timed) -> Self {
        let mut times = 1;
        loop {
            let taken = seconds(program, times);
            if taken >= BATCH.as_secs_f64() {
                return Batch(times);
            }
            let factor = (1.2 * BATCH.as_secs_f64() / taken.max(1e-9)).clamp(1.5, 100.0);
            times = (times as f64 * factor).ceil() as usize;
        }
    }

    /// The time of one evaluation in one batch.
    pub fn nanoseconds(self, program: &mut dyn Timed) -> f64 {
        seconds(program, self.0) * 1e9 / (self.0 * program.evaluations()) as f64
    }
}

fn seconds(program: &mut dyn Timed, times: usize) -> f64 {
    let start = Instant::now();
    program.repeat(times);
    start.elapsed().as_secs_f64()
}

/// Times pairs of batches.
pub fn compare(first: &mut dyn Timed, second: &mut dyn Timed, pairs: usize) -> Comparison {
    let batches = [Batch::of(first), Batch::of(second)];
    let mut shortest = [f64::INFINITY; 2];
    let mut ratios: Vec<f64> = (0..pairs)
        .map(|pair| {
            let mut times = [0.0; 2];
            for turn in 0..2 {
                let which = (pair + turn) % 2;
                let program: &mut dyn Timed = if which == 0 { first } else { second };
                times[which] = batches[which].nanoseconds(program);
                shortest[which] = shortest[which].min(times[which]);
            }
            times[0] / times[1]
        })
        .collect();
    let (ratio, interval) = median_with_interval(&mut ratios).expect("a pair at least");
    Comparison { nanoseconds: shortest, ratio, interval }
}

/// Seconds that processes started and waited for by this one have spent on processors, in steps of a hundredth; NaN
/// where the system does not tell.
pub fn processor_time_of_children() -> f64 {
    /// The clock of `/proc`, the same on all architectures of Linux.
    const TICKS_PER_SECOND: f64 = 100.0;
    let text = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // Behind the name, which may contain spaces, `cutime` and `cstime` are the fourteenth and fifteenth field.
    let fields = text.rsplit(") ").next().unwrap_or_default();
    let ticks = fields.split(' ').skip(13).take(2).map(|field| field.parse::<f64>().unwrap_or(f64::NAN));
    let ticks: Vec<f64> = ticks.collect();
    if ticks.len() == 2 { ticks.iter().sum::<f64>() / TICKS_PER_SECOND } else { f64::NAN }
}

/// What the figures of a run depend on, one fact per line.
pub fn conditions() -> String {
    let cpu = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        })
        .unwrap_or_else(|| "unknown".to_owned());
    let threads = std::thread::available_parallelism().map_or(0, usize::from);
    let features: Vec<&str> = env!("GUEN_TARGET_FEATURES")
        .split(',')
        .filter(|name| ["sse4.2", "avx", "avx2", "fma", "avx512f", "neon"].contains(name))
        .collect();
    let features = if features.is_empty() { "of the target alone".to_owned() } else { features.join(" ") };
    format!(
        "processor        {cpu}, {threads} threads\n\
         target           {}, features {features}\n\
         build            opt-level {}, lto {}, debug assertions {}\n\
         rustflags        {}\n",
        env!("GUEN_TARGET"),
        env!("GUEN_OPT_LEVEL"),
        env!("GUEN_LTO"),
        if cfg!(debug_assertions) { "on" } else { "off" },
        env!("GUEN_RUSTFLAGS"),
    )
}
