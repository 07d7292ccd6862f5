//! Times of runs that are compared with each other: taken in turn, again and again.

use std::time::Instant;

use guen_study::Progress;

/// A run is repeated until it takes so many seconds, for the clock.
const BATCH: f64 = 5e-5;
/// What takes longer than this is timed in the first rounds only.
const LONG: f64 = 3e-3;
const ROUNDS_OF_LONG: usize = 15;

/// A quantity that was measured repeatedly.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    pub median: f64,
    pub quartiles: (f64, f64),
}

impl Spread {
    fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |quarter: usize| values[(quarter * last + 2) / 4];
        Some(Self { median: at(2), quartiles: (at(1), at(3)) })
    }
}

/// The seconds of runs, round by round.
pub struct Times(Vec<Vec<f64>>);

impl Times {
    /// Takes the times of all runs in turn, forwards and backwards alternately.
    pub fn take(runs: &[&dyn Fn()], rounds: usize) -> Self {
        let repeats: Vec<u32> = runs.iter().map(|run| repeats(run)).collect();
        let mut times: Vec<Vec<f64>> = vec![Vec::with_capacity(rounds); runs.len()];
        let mut progress = Progress::new(0.0, rounds as f64);
        for round in 0..rounds {
            progress.at(round as f64);
            for turn in 0..runs.len() {
                let at = if round % 2 == 0 { turn } else { runs.len() - 1 - turn };
                if round < ROUNDS_OF_LONG || times[at][0] <= LONG {
                    times[at].push(seconds(runs[at], repeats[at]));
                }
            }
        }
        progress.finish();
        Self(times)
    }

    /// The seconds of one run.
    pub fn of(&self, run: usize) -> Option<Spread> {
        Spread::of(self.0[run].clone())
    }

    /// The time of one run divided by that of another one in the same round.
    pub fn ratio(&self, run: usize, to: usize) -> Option<Spread> {
        Spread::of(self.0[run].iter().zip(&self.0[to]).map(|(a, b)| a / b).collect())
    }
}

/// How often a run is repeated to fill a batch, which warms it up too.
fn repeats(run: &dyn Fn()) -> u32 {
    seconds(run, 1);
    (BATCH / seconds(run, 1).max(1e-9)).ceil() as u32
}

fn seconds(run: &dyn Fn(), repeats: u32) -> f64 {
    let start = Instant::now();
    for _ in 0..repeats {
        run();
    }
    start.elapsed().as_secs_f64() / f64::from(repeats)
}
