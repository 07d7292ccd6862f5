//! Recordings of runs: times and states, kept in memory that may be bounded, and written as CSV.

use std::io::{self, Write};
use std::ops::ControlFlow;
use std::path::Path;

use crate::cell;
use crate::error::StudyError;
use crate::file::replace_file;

/// The times and states of a run, with a name for each entry of the state.
///
/// Steppers show accepted steps, not where they start: [`record`](Recording::record) the initial state, then hand
/// [`observe`](Recording::observe) to `integrate` or [`visit`](Recording::visit) to `sample`. The recording is
/// borrowed by the run and not consumed, so what was recorded before a failure is still there.
///
/// # Memory
///
/// Without a limit every sample is kept, in `8 (N + 1)` bytes. With [`with_limit`](Recording::with_limit) at most
/// that many are: whenever the recording is full, every second sample is dropped, and from then on only every
/// second of those that would have been kept is. With a stride of `s`, a power of two, the samples kept are those
/// numbered `0, s, 2 s, ..` and the newest one, whatever its number: first and last are never lost. A recording
/// that was full holds at least half its limit.
///
/// Dropping knows nothing of the motion: what happens between kept samples is not seen. Watch invariants with a
/// [`Monitor`](crate::Monitor) during the run if every step counts.
///
/// ```
/// use guen_runtime::{from_fn, steppers::Rk4};
/// use guen_study::Recording;
///
/// let decay = from_fn(|_t: f64, &[x]: &[f64; 1]| [-x]);
/// let mut recording = Recording::new(&["x"]).with_limit(1000);
/// recording.record(0.0, &[1.0]);
/// Rk4::new(1e-3).integrate(&decay, 0.0, &[1.0], 5.0, recording.observe()).unwrap();
///
/// assert_eq!((recording.seen(), recording.stride()), (5001, 8));
/// assert!(recording.len() <= 1000);
/// assert_eq!(recording.times().first(), Some(&0.0));
/// assert_eq!(recording.last().unwrap().0, 5.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Recording<const N: usize> {
    pub(crate) names: &'static [&'static str],
    pub(crate) units: &'static [&'static str],
    pub(crate) times: Vec<f64>,
    pub(crate) states: Vec<[f64; N]>,
    pub(crate) limit: usize,
    pub(crate) stride: u64,
    pub(crate) seen: u64,
}

impl<const N: usize> Recording<N> {
    /// An empty recording without a limit. Entries without names go by their numbers, from zero on.
    ///
    /// # Panics
    ///
    /// If there are names, and not as many as entries in a state.
    pub fn new(names: &'static [&'static str]) -> Self {
        let fit = names.is_empty() || names.len() == N;
        assert!(fit, "a recording needs one name for each entry of the state, or none");
        Self {
            names,
            units: &[],
            times: Vec::new(),
            states: Vec::new(),
            limit: usize::MAX,
            stride: 1,
            seen: 0,
        }
    }

    /// Sets the units of the entries, which stand in the headers of tables and at the axes of plots; time is in seconds then. An
    /// entry without one has an empty text.
    ///
    /// ```
    /// use guen_study::Recording;
    ///
    /// let mut recording = Recording::new(&["height", "turns"]).with_units(&["m", ""]);
    /// recording.record(0.0, &[1.0, 2.0]);
    /// let mut text = Vec::new();
    /// recording.write_csv(&mut text)?;
    /// assert_eq!(text, b"t [s],height [m],turns\n0.0,1.0,2.0\n");
    /// # Ok::<(), std::io::Error>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If there are units, and not as many as entries in a state.
    pub fn with_units(mut self, units: &'static [&'static str]) -> Self {
        let fit = units.is_empty() || units.len() == N;
        assert!(fit, "a recording needs one unit for each entry of the state, or none");
        self.units = units;
        self
    }

    /// The units of the entries; empty where none is known.
    ///
    /// ```
    /// use guen_study::Recording;
    /// assert!(Recording::<2>::new(&["x", "v"]).units().is_empty());
    /// ```
    pub fn units(&self) -> &'static [&'static str] {
        self.units
    }

    /// A name with the unit of the entry, as a table has it.
    pub(crate) fn with_unit(&self, name: &str, entry: usize) -> String {
        match self.units.get(entry) {
            Some(unit) if !unit.is_empty() => format!("{name} [{unit}]"),
            _ => name.to_owned(),
        }
    }

    /// Sets the largest number of samples; less than two are taken as two, the first and the newest.
    ///
    /// To be set before anything is recorded: later it bounds only what is still to come.
    pub fn with_limit(mut self, samples: usize) -> Self {
        self.limit = samples.max(2);
        self
    }

    /// Takes a sample.
    pub fn record(&mut self, t: f64, state: &[f64; N]) {
        let number = self.seen;
        self.seen += 1;
        // The newest sample holds its place only until the next one, unless its number is one to be kept.
        if number > 0 && !(number - 1).is_multiple_of(self.stride) {
            self.times.pop();
            self.states.pop();
        }
        if self.times.len() >= self.limit {
            self.halve();
        }
        self.reserve();
        self.times.push(t);
        self.states.push(*state);
    }

    /// An observer for `integrate` that records every step and never stops the run.
    pub fn observe(&mut self) -> impl FnMut(f64, &[f64; N]) -> ControlFlow<()> {
        |t, state| {
            self.record(t, state);
            ControlFlow::Continue(())
        }
    }

    /// A visitor for `sample` that records every visited time.
    ///
    /// ```
    /// use guen_runtime::{from_fn, steppers::Dop853};
    /// use guen_study::Recording;
    ///
    /// let decay = from_fn(|_t: f64, &[x]: &[f64; 1]| [-x]);
    /// let mut recording = Recording::new(&["x"]);
    /// Dop853::new(1e-9, 1e-9).sample(&decay, 0.0, &[1.0], &[0.0, 0.5, 1.0], recording.visit()).unwrap();
    /// assert_eq!(recording.times(), [0.0, 0.5, 1.0]);
    /// ```
    pub fn visit(&mut self) -> impl FnMut(usize, f64, &[f64; N]) {
        |_index, t, state| self.record(t, state)
    }

    /// Keeps the samples at even positions. All that are there now have numbers that the stride divides, so
    /// position and number differ by that factor alone.
    fn halve(&mut self) {
        fn keep_even<T: Copy>(items: &mut Vec<T>) {
            let kept = items.len().div_ceil(2);
            for position in 0..kept {
                items[position] = items[2 * position];
            }
            items.truncate(kept);
        }
        // One halving is enough unless the limit was lowered below what is there.
        while self.times.len() >= self.limit {
            keep_even(&mut self.times);
            keep_even(&mut self.states);
            self.stride *= 2;
        }
    }

    /// Grows as a vector does by itself, but not beyond the limit.
    fn reserve(&mut self) {
        const FIRST_ALLOCATION: usize = 64;
        let len = self.times.len();
        if len == self.times.capacity() {
            let more = len.max(FIRST_ALLOCATION).min(self.limit - len);
            self.times.reserve_exact(more);
            self.states.reserve_exact(more);
        }
    }

    /// The names of the entries of the state.
    pub fn names(&self) -> &'static [&'static str] {
        self.names
    }

    /// The number of samples kept.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether nothing was recorded.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// The number of samples taken, kept or not.
    pub fn seen(&self) -> u64 {
        self.seen
    }

    /// The difference between the numbers of samples kept: one until the recording was full for the first time.
    pub fn stride(&self) -> u64 {
        self.stride
    }

    /// The times of the samples kept.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The states of the samples kept.
    pub fn states(&self) -> &[[f64; N]] {
        &self.states
    }

    /// The samples kept, as times with states.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, &[f64; N])> + Clone {
        self.times.iter().copied().zip(&self.states)
    }

    /// The first sample taken.
    pub fn first(&self) -> Option<(f64, &[f64; N])> {
        Some((*self.times.first()?, self.states.first()?))
    }

    /// The newest sample taken.
    pub fn last(&self) -> Option<(f64, &[f64; N])> {
        Some((*self.times.last()?, self.states.last()?))
    }

    /// The position of the entry with this name; where entries have no names, with this number.
    pub fn position(&self, name: &str) -> Option<usize> {
        if self.names.is_empty() {
            return name.parse().ok().filter(|number| *number < N);
        }
        self.names.iter().position(|known| *known == name)
    }

    /// Entry `i` of the states, over the samples kept.
    ///
    /// # Panics
    ///
    /// If a state has no entry `i`.
    pub fn column(&self, i: usize) -> impl ExactSizeIterator<Item = f64> + Clone {
        assert!(i < N, "no column {i} in a recording of {N}");
        self.states.iter().map(move |state| state[i])
    }

    /// Entry `i` over time: a curve for a [`Plot`](crate::Plot).
    ///
    /// # Panics
    ///
    /// If a state has no entry `i`.
    pub fn curve(&self, i: usize) -> impl ExactSizeIterator<Item = (f64, f64)> + Clone {
        self.times.iter().copied().zip(self.column(i))
    }

    /// Entry `j` over entry `i`: a track on a plane for a [`Plot`](crate::Plot).
    ///
    /// # Panics
    ///
    /// If a state has no entry `i` or `j`.
    pub fn track(&self, i: usize, j: usize) -> impl ExactSizeIterator<Item = (f64, f64)> + Clone {
        self.column(i).zip(self.column(j))
    }

    /// Returns at most `count` samples, the nearest to times at equal distances from the first to the last; each at most
    /// once, and first and last among them if `count` is two or more. For the rows of a [`Table`](crate::Table).
    ///
    /// The times must rise or fall throughout.
    pub fn spread(&self, count: usize) -> impl Iterator<Item = (f64, &[f64; N])> {
        let mut wanted: Vec<usize> = match (self.times.first(), self.times.last()) {
            (Some(&from), Some(&to)) => (0..count)
                .map(|k| self.nearest(from + (to - from) * k as f64 / count.saturating_sub(1).max(1) as f64))
                .collect(),
            _ => Vec::new(),
        };
        wanted.dedup();
        wanted.into_iter().map(|index| (self.times[index], &self.states[index]))
    }

    /// The position of the sample nearest in time, of a recording that is not empty.
    fn nearest(&self, time: f64) -> usize {
        let last = self.times.len() - 1;
        let backwards = self.times[last] < self.times[0];
        let after = self.times.partition_point(|&t| if backwards { t > time } else { t < time }).min(last);
        let before = after.saturating_sub(1);
        if (self.times[after] - time).abs() <= (self.times[before] - time).abs() { after } else { before }
    }

    /// Writes the samples as comma-separated values: a line with `t` and the names, then a line for each sample.
    /// Every number is the shortest decimal that reads back as the same `f64`, bit for bit, except that NaNs read
    /// back as some NaN; lines end with a line feed. A name that a spreadsheet would run as a formula, such as `=1+1`, has an
    /// apostrophe before it.
    ///
    /// ```
    /// use guen_study::Recording;
    ///
    /// let mut recording = Recording::new(&["theta", "p"]);
    /// recording.record(0.1, &[1.0 / 3.0, 1e-300]);
    /// let mut text = Vec::new();
    /// recording.write_csv(&mut text)?;
    /// assert_eq!(text, b"t,theta,p\n0.1,0.3333333333333333,1e-300\n");
    /// # Ok::<(), std::io::Error>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of the writer.
    pub fn write_csv(&self, mut out: impl Write) -> io::Result<()> {
        write!(out, "{}", if self.units.is_empty() { "t" } else { "t [s]" })?;
        for (entry, name) in self.names.iter().enumerate() {
            write!(out, ",{}", cell::text(&self.with_unit(name, entry)))?;
        }
        let unnamed = if self.names.is_empty() { 0..N } else { 0..0 };
        for number in unnamed {
            write!(out, ",{number}")?;
        }
        writeln!(out)?;
        for (t, state) in self.iter() {
            // `Debug` of a float is its shortest decimal, with an exponent where that is shorter.
            write!(out, "{t:?}")?;
            for x in state {
                write!(out, ",{x:?}")?;
            }
            writeln!(out)?;
        }
        out.flush()
    }

    /// Writes the samples as [`write_csv`](Recording::write_csv) does, to a file that is written whole or not at all: see
    /// [`replace_file`].
    ///
    /// # Errors
    ///
    /// [`StudyError::Io`] with the path.
    pub fn save_csv(&self, path: impl AsRef<Path>) -> Result<(), StudyError> {
        replace_file(path, |out| self.write_csv(out))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use guen_runtime::steppers::{Dop853, Rk4};
    use guen_runtime::{Cause, from_fn};

    fn counted(limit: usize, samples: u32) -> Recording<1> {
        let mut recording = Recording::new(&["x"]).with_limit(limit);
        for k in 0..samples {
            recording.record(f64::from(k), &[-f64::from(k)]);
        }
        recording
    }

    #[test]
    fn memory_stays_bounded_and_both_ends_stay() {
        for limit in [0, 2, 3, 7, 64, 100, 1000] {
            let bound = limit.max(2);
            let mut recording = Recording::new(&["x"]).with_limit(limit);
            for k in 0..5000_u32 {
                recording.record(f64::from(k), &[-f64::from(k)]);
                assert!(recording.len() <= bound, "limit {limit}, sample {k}");
                assert!(recording.times.capacity() <= bound && recording.states.capacity() <= bound);
                assert_eq!(recording.last(), Some((f64::from(k), &[-f64::from(k)])));
                assert_eq!(recording.first(), Some((0.0, &[-0.0])));
            }
            assert!(recording.len() >= bound / 2, "limit {limit} keeps only {}", recording.len());
        }
    }

    #[test]
    fn samples_kept_are_multiples_of_the_stride_and_the_newest() {
        for samples in 1..300 {
            let recording = counted(10, samples);
            let stride = recording.stride() as f64;
            let (newest, others) = recording.times().split_last().unwrap();
            assert_eq!(*newest, f64::from(samples - 1));
            for (position, &time) in others.iter().enumerate() {
                assert_eq!(time, position as f64 * stride, "of {samples}");
            }
            assert!(newest - others.last().unwrap_or(newest) <= stride);
            assert!(recording.iter().all(|(t, x)| x[0] == -t));
        }
    }

    #[test]
    fn a_limit_lowered_late_is_reached() {
        let mut recording = counted(usize::MAX, 1000).with_limit(10);
        recording.record(1000.0, &[-1000.0]);
        assert!(recording.len() <= 10);
        assert_eq!(recording.last().unwrap().0, 1000.0);
    }

    #[test]
    fn a_failed_run_leaves_its_samples() {
        let explosion = from_fn(|_t: f64, &[x]: &[f64; 1]| [x * x]);
        let mut recording = Recording::new(&["x"]);
        recording.record(0.0, &[1.0]);
        let error = Dop853::new(1e-9, 1e-9)
            .with_max_steps(50)
            .integrate(&explosion, 0.0, &[1.0], 2.0, recording.observe())
            .unwrap_err();
        assert_eq!(error.cause, Cause::TooManySteps { limit: 50 });
        assert!(recording.len() > 10);
        assert_eq!(recording.last(), Some((error.time, &error.state)));
    }

    #[test]
    fn both_steppers_take_both_kinds_of_observer() {
        let clock = from_fn(|_t: f64, _x: &[f64; 1]| [1.0]);
        let mut recording = Recording::new(&["x"]);
        let fixed = Rk4::new(0.5);
        let adaptive = Dop853::new(1e-9, 1e-9);
        fixed.integrate(&clock, 0.0, &[0.0], 1.0, recording.observe()).unwrap();
        adaptive.integrate(&clock, 1.0, &[1.0], 2.0, recording.observe()).unwrap();
        fixed.sample(&clock, 2.0, &[2.0], &[3.0], recording.visit()).unwrap();
        adaptive.sample(&clock, 3.0, &[3.0], &[4.0], recording.visit()).unwrap();
        assert!(recording.iter().all(|(t, x)| (t - x[0]).abs() < 1e-12));
        assert_eq!(recording.last().unwrap().0, 4.0);
    }

    #[test]
    fn csv_reads_back_to_the_bit() {
        let values =
            [0.1, -0.0, 1.0 / 3.0, f64::MIN_POSITIVE, 5e-324, f64::MAX, 1e16, 123_456_789.123_456_78];
        let mut recording = Recording::new(&["a", "b,\"c\""]);
        for (k, pair) in values.windows(2).enumerate() {
            recording.record(k as f64 / 7.0, &[pair[0], pair[1]]);
        }
        recording.record(f64::NEG_INFINITY, &[f64::INFINITY, f64::NAN]);
        let mut text = Vec::new();
        recording.write_csv(&mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("t,a,\"b,\"\"c\"\"\""));
        for (t, state) in recording.iter() {
            let read: Vec<f64> =
                lines.next().unwrap().split(',').map(|field| field.parse().unwrap()).collect();
            let expected = [t, state[0], state[1]];
            for (read, expected) in read.iter().zip(expected) {
                assert!(read.to_bits() == expected.to_bits() || read.is_nan() && expected.is_nan());
            }
        }
        assert_eq!(lines.next(), None);
    }

    #[test]
    fn a_file_in_a_new_folder() {
        let folder = std::env::temp_dir().join(format!("guen-study-csv-{}", std::process::id()));
        let path = folder.join("deep/run.csv");
        counted(10, 3).save_csv(&path).unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "t,x\n0.0,-0.0\n1.0,-1.0\n2.0,-2.0\n");
        assert!(matches!(counted(10, 3).save_csv(&folder), Err(StudyError::Io { .. })));
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn spread_takes_the_ends_and_repeats_nothing() {
        let recording = counted(usize::MAX, 101);
        let times: Vec<f64> = recording.spread(5).map(|(t, _)| t).collect();
        assert_eq!(times, [0.0, 25.0, 50.0, 75.0, 100.0]);
        assert_eq!(recording.spread(1).count(), 1);
        assert_eq!(recording.spread(0).count(), 0);
        assert_eq!(recording.spread(1000).count(), 101);
        assert_eq!(Recording::<1>::new(&["x"]).spread(3).count(), 0);
        let mut backwards = Recording::new(&["x"]);
        for k in 0..11 {
            backwards.record(-f64::from(k), &[0.0]);
        }
        assert_eq!(backwards.spread(3).map(|(t, _)| t).collect::<Vec<_>>(), [0.0, -5.0, -10.0]);
    }

    #[test]
    #[should_panic(expected = "one name for each entry")]
    fn names_must_be_as_many_as_entries() {
        let _ = Recording::<2>::new(&["x"]);
    }
}
