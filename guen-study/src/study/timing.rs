//! Times on a machine that has other work to do: medians, their intervals, and when two of them are a tie.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use crate::median::median_with_interval;

/// A clock that measures how long a run takes. The default is the machine's clock; another one makes a study
/// repeatable, or tells it times that were recorded elsewhere.
pub trait Stopwatch {
    /// Does the work, as often as it takes to tell how long it takes, and returns the seconds of doing it once. `row` is the
    /// position of the setting in the report.
    fn seconds(&mut self, row: usize, work: &mut dyn FnMut()) -> f64;

    /// The time by which the limits of the study are kept, from whatever beginning: the machine's, unless a clock says
    /// otherwise.
    fn now(&self) -> Duration {
        static FIRST: OnceLock<Instant> = OnceLock::new();
        FIRST.get_or_init(Instant::now).elapsed()
    }
}

/// A time at which to give up, by the clock of a study.
#[derive(Clone, Copy)]
pub(super) struct Deadline<'a> {
    pub clock: &'a dyn Stopwatch,
    pub at: Duration,
}

impl Deadline<'_> {
    pub fn is_over(self) -> bool {
        self.clock.now() >= self.at
    }
}

/// A timing lasts at least this long: some thousand times what reading the clock takes.
const SHORTEST_TIMING: Duration = Duration::from_micros(50);
/// The time above which a run is not repeated: it warms itself up.
const WARM_RUN: Duration = Duration::from_millis(1);

/// The machine's clock.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wall;

impl Stopwatch for Wall {
    fn seconds(&mut self, _row: usize, work: &mut dyn FnMut()) -> f64 {
        let first = Instant::now();
        work();
        let first = first.elapsed();
        if first >= WARM_RUN {
            return first.as_secs_f64();
        }
        // Another setting ran before: the first run found neither its code in the cache nor its branches predicted,
        // which costs more than some of the settings.
        let start = Instant::now();
        let mut done = 0_u32;
        loop {
            // As often as before, so that the clock is read seldom.
            let further = done.max(1);
            for _ in 0..further {
                work();
            }
            done += further;
            let elapsed = start.elapsed();
            if elapsed >= SHORTEST_TIMING {
                return elapsed.as_secs_f64() / f64::from(done);
            }
        }
    }
}

/// The cost of a setting: the median over repetitions with its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Cost {
    /// The median: seconds for one initial state, or evaluations in a study that counts them.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub median: f64,
    /// The lower end of the interval in which the median lies with 95 percent.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub low: f64,
    /// The upper end.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub high: f64,
    /// The number of measurements.
    pub repetitions: u32,
}

impl Cost {
    /// A cost that is no measurement but a count.
    pub(super) fn exact(value: f64) -> Self {
        Self { median: value, low: value, high: value, repetitions: 1 }
    }

    /// The median of these; none if there are none.
    pub(super) fn of(values: &mut [f64]) -> Option<Self> {
        let repetitions = u32::try_from(values.len()).unwrap_or(u32::MAX);
        let (median, (low, high)) = median_with_interval(values)?;
        Some(Self { median, low, high, repetitions })
    }

    /// Whether the order of two costs is not certain: their intervals overlap. The counts of a study that counts
    /// evaluations never do, unless they are equal.
    pub fn ties_with(&self, other: &Self) -> bool {
        self.low <= other.high && other.low <= self.high
    }

    /// Half the interval over the median: how noisy it was.
    pub fn noise(&self) -> f64 {
        if self.median == 0.0 { 0.0 } else { (self.high - self.low) / (2.0 * self.median) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlapping_intervals_are_ties_both_ways() {
        let cost = |low, high| Cost { median: (low + high) / 2.0, low, high, repetitions: 9 };
        for (a, b, tie) in [
            (cost(1.0, 2.0), cost(1.9, 3.0), true),
            (cost(1.0, 2.0), cost(2.1, 3.0), false),
            (cost(1.0, 9.0), cost(2.0, 3.0), true),
            (Cost::exact(2.0), Cost::exact(2.0), true),
            (Cost::exact(2.0), Cost::exact(3.0), false),
        ] {
            assert_eq!((a.ties_with(&b), b.ties_with(&a)), (tie, tie));
        }
    }
}
