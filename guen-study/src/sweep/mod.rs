//! Sweeps: studies of many motions as data. A design says which, an engine computes them in chunks, rows go into files and statistics are
//! kept on the way; parts run on other machines and are merged, with the same bits.
//!
//! A chunk is a fixed range of motions, whatever the parts and threads: it is computed whole by one thread, and its file depends on nothing else.

mod block;
mod design;
mod engine;
mod error;
mod exact_sum;
mod folder;
mod in_lanes;
mod merge;
mod motions;
mod natural;
mod normal;
#[cfg(feature = "parquet")]
mod parquet;
mod part;
mod plan;
mod random;
mod record;
mod rows;
mod run;
mod scaled;
mod sha256;
mod shared;
mod simulated;
mod sketch;
mod statistics;
mod statistics_text;
mod summary;
mod tables;

use std::path::Path;

use guen_runtime::lanes::{Backend, Width};

pub use design::{Design, DesignFault, Grid, Point, Sampling, UnknownAxis, UnknownEntry};
pub use error::SweepError;
pub use motions::Motions;
pub use part::PartReport;
pub use rows::Rows;
pub use shared::{Assignment, Coordinator, Worker};
pub use statistics::{ColumnStatistics, Statistics};
pub use summary::Summary;

use engine::Engine;
use statistics::Bins;

/// A study of many motions: a design, the motions of its points, and what is kept of them.
///
/// - [`run`](Self::run) keeps statistics; [`run_in`](Self::run_in) writes the rows of all motions into a folder, too, and goes on
///   where an earlier run was interrupted, by a kill or a power cut as well.
/// - [`part`](Self::part) is a part of the sweep, for another process or machine; [`merge`](Self::merge) puts parts together. The files have the bits of a run in one
///   part, and so have the statistics: sums are exact, and the motions themselves have the same bits everywhere.
/// - A [`coordinator`](Self::coordinator) hands chunks out to [workers](Self::worker), where machines differ or motions take different times.
/// - A motion that fails is a row with its cause.
/// - Work is shared between threads chunk by chunk. Memory does not depend on the number of motions: a chunk for each thread, and the statistics.
///
/// ```
/// use guen_runtime::lanes::Lanes;
/// use guen_runtime::steppers::Rk4;
/// use guen_runtime::{Laned, Real, Simulate, System};
/// use guen_study::{Design, Sweep};
///
/// /// What the macro generates for a declared system: here `x' = -rate x`.
/// #[derive(Clone, Copy)]
/// struct Decay<R>(R);
/// impl<R: Real> System<R, 1> for Decay<R> {
///     #[inline]
///     fn rhs(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
///         R::vectorize(#[inline(always)] || [-self.0 * x])
///     }
/// }
/// impl Simulate<f64, 1> for Decay<f64> {
///     type State = [f64; 1];
///     const STATES: &'static [&'static str] = &["x"];
/// }
/// impl Laned<1> for Decay<f64> {
///     type Over<L: Lanes> = Decay<L>;
///     fn gather<'a, L: Lanes>(member: impl Fn(usize) -> &'a Self) -> Decay<L> {
///         Decay(L::from_fn(|lane| member(lane).0))
///     }
/// }
///
/// let design = Design::latin_hypercube(4000, 1).uniform("rate", 0.0, 1.0);
/// let sweep = Sweep::over(design, |point| Ok((Decay(point.get("rate")?), [1.0])))
///     .end_states(Rk4::new(0.01), 0.0..2.0);
/// let summary = sweep.run()?;
/// let x = summary.statistics().column("x").unwrap();
/// // The mean of exp(-2 rate).
/// assert!((x.mean().unwrap() - (1.0 - f64::exp(-2.0)) / 2.0).abs() < 1e-5);
///
/// // In three parts, as three machines would have them.
/// let folder = std::env::temp_dir().join(format!("guen-docs-sweep-{}", std::process::id()));
/// for k in 0..3 {
///     sweep.part(k, 3)?.run_in(&folder)?;
/// }
/// assert_eq!(sweep.merge([&folder], folder.join("merged"))?.statistics(), summary.statistics());
/// # std::fs::remove_dir_all(folder).unwrap();
/// # Ok::<(), guen_study::SweepError>(())
/// ```
#[must_use = "a sweep runs when `run` or `run_in` is called"]
pub struct Sweep<'a> {
    design: Design,
    engine: Box<dyn Engine + 'a>,
    name: String,
    chunk: Option<u64>,
    threads: Option<usize>,
    lanes: (Backend, Width),
    rows: Rows,
    selected: Option<Vec<String>>,
    bins: Vec<(String, Bins)>,
    locks: bool,
    progress: bool,
}

impl std::fmt::Debug for Sweep<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Sweep")
            .field("name", &self.name)
            .field("design", &self.design.text())
            .field("kept", &self.engine.text())
            .finish_non_exhaustive()
    }
}

/// A part of a sweep: every so many chunks of motions, for one process.
#[derive(Clone, Copy, Debug)]
#[must_use = "a part runs when `run_in` is called"]
pub struct Part<'s, 'a> {
    sweep: &'s Sweep<'a>,
    part: u64,
    parts: u64,
}

impl<'a> Sweep<'a> {
    fn new(design: Design, engine: Box<dyn Engine + 'a>) -> Self {
        let backend = Backend::best();
        Self {
            design,
            engine,
            name: "sweep".to_owned(),
            chunk: None,
            threads: None,
            lanes: (backend, backend.width()),
            rows: Rows::Csv,
            selected: None,
            bins: Vec::new(),
            locks: true,
            progress: true,
        }
    }

    /// Names the sweep, and with it what is swept: a sweep of another name does not go on in its folder. A sweep of another declaration does
    /// not either, whatever its name.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Computes so many motions at a time, and writes them into one file. By default there are 256 chunks, or so many
    /// that each has 512 to 16,384 motions in lanes, and 16 to 16,384 simulations.
    pub fn with_chunk(self, motions: u64) -> Self {
        Self { chunk: Some(motions.max(1)), ..self }
    }

    /// Uses so many threads, one at least; by default as many as there are processors.
    pub fn with_threads(self, threads: usize) -> Self {
        Self { threads: Some(threads.max(1)), ..self }
    }

    /// Uses lanes of a certain kind and number instead of those that suit this processor best. They change no bit.
    pub fn with_lanes(self, backend: Backend, width: Width) -> Self {
        Self { lanes: (backend, width), ..self }
    }

    /// Writes rows in this format: comma-separated values by default.
    pub fn with_rows(self, rows: Rows) -> Self {
        Self { rows, ..self }
    }

    /// Keeps statistics of these columns, axes of the design among them. By default they are of all columns but those of the design. Covariances take
    /// time and memory with the square of their number.
    pub fn with_statistics_of(self, columns: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { selected: Some(columns.into_iter().map(Into::into).collect()), ..self }
    }

    /// Keeps a histogram of a column: equal bins between two ends, a million at most. A column has one histogram.
    pub fn with_histogram(mut self, column: impl Into<String>, low: f64, high: f64, bins: usize) -> Self {
        self.bins.push((column.into(), Bins { column: 0, low, high, count: bins }));
        self
    }

    /// Takes no locks: for file systems that have none. Whoever runs one part twice at a time into one folder computes it twice.
    pub fn without_locks(self) -> Self {
        Self { locks: false, ..self }
    }

    /// Shows no progress.
    pub fn silent(self) -> Self {
        Self { progress: false, ..self }
    }

    /// The design.
    pub fn design(&self) -> &Design {
        &self.design
    }

    /// Part `part` of `parts`, counted from zero: every `parts`-th chunk of motions.
    ///
    /// # Errors
    ///
    /// [`SweepError::Part`] if there is no such part.
    pub fn part(&self, part: u64, parts: u64) -> Result<Part<'_, 'a>, SweepError> {
        if part < parts {
            Ok(Part { sweep: self, part, parts })
        } else {
            Err(SweepError::Part { part, parts })
        }
    }

    /// Computes all motions and keeps their statistics, but no rows.
    ///
    /// # Errors
    ///
    /// A design that makes no sense, or a column that there is not.
    pub fn run(&self) -> Result<Summary, SweepError> {
        let plan = plan::Plan::of(self)?;
        let mut tally = run::Tally::new(record::Record::new(&plan), Vec::new(), None);
        run::run(&plan, &Part { sweep: self, part: 0, parts: 1 }, &mut tally)?;
        Ok(Summary::new(tally.record))
    }

    /// Computes all motions, writes their rows into a folder, and the statistics beside them. Goes on where an earlier run of the same sweep ended.
    ///
    /// | file | content |
    /// | --- | --- |
    /// | `rows/chunk-NUMBER.csv` or `.parquet` | the rows of a chunk of motions |
    /// | `statistics.csv`, `covariance.csv`, `histogram.csv` | statistics |
    /// | `columns.csv` | names and units of the columns |
    /// | `sweep.txt` | the manifest: what was swept |
    /// | `part-K-of-N.txt` | the chunks that a part has finished, with digests and exact sums |
    /// | `SHA256SUMS` | the digests of all files, for `sha256sum -c SHA256SUMS` |
    ///
    /// # Errors
    ///
    /// Those of [`Part::run_in`].
    pub fn run_in(&self, folder: impl AsRef<Path>) -> Result<Summary, SweepError> {
        let folder = folder.as_ref();
        self.part(0, 1)?.run_in(folder)?;
        self.merge([folder], folder)
    }

    /// Puts finished parts together that are in these folders, in the files of a run in one part, to the bit; and checks the digests of all rows.
    /// `into` may be one of the folders: then its rows stay where they are.
    ///
    /// # Errors
    ///
    /// [`SweepError::Unfinished`] if motions are missing, [`SweepError::Overlap`] if some are there twice, [`SweepError::Corrupt`] if a file is damaged,
    /// [`SweepError::OtherDeclaration`] or [`SweepError::OtherSweep`] if a folder has another sweep, and errors of files.
    pub fn merge<P: AsRef<Path>>(
        &self,
        folders: impl IntoIterator<Item = P>,
        into: impl AsRef<Path>,
    ) -> Result<Summary, SweepError> {
        merge::merge(
            self,
            folders.into_iter().map(|folder| folder.as_ref().to_path_buf()).collect(),
            into.as_ref(),
        )
    }
}

#[cfg(test)]
mod tests;
