//! A sweep whose chunks are handed out one by one, to threads or processes that anything may connect: one coordinator keeps the record,
//! workers compute and write rows.

use std::fs::File;
use std::path::Path;

use super::error::SweepError;
use super::folder::RowsFolder;
use super::part::PartReport;
use super::plan::Plan;
use super::record::Record;
use super::run::{self, Tally};
use super::{Part, Sweep};
use crate::ensemble::processors;
use crate::progress::Progress;

/// One chunk of a sweep, for a [`Worker`] to compute.
///
/// ```
/// use guen_study::Assignment;
///
/// // Sent as a number.
/// let assignment = Assignment::from_bits(6);
/// assert_eq!(assignment.to_bits(), 6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Assignment {
    chunk: u64,
}

impl Assignment {
    /// A number to send.
    pub fn to_bits(self) -> u64 {
        self.chunk
    }

    /// The assignment of a number that was sent.
    pub fn from_bits(bits: u64) -> Self {
        Self { chunk: bits }
    }
}

/// The process or thread that hands out the chunks of a sweep and keeps its record.
///
/// Workers, on whichever machines see the folder, compute chunks and write their rows; the coordinator counts what they tell, so that the folder
/// has the files of a run in one part, to the bit, however many workers there were. The connection is the caller's: an [`Assignment`] is a number, what a worker has
/// finished is a text. The crate `guen-mpi` connects them by MPI. A run that was killed is gone on with by a further coordinator, with any number of workers, or by
/// [`Sweep::run_in`]: it loses the chunks that were at work and those of the last two seconds.
///
/// ```
/// use std::sync::{Mutex, mpsc};
///
/// use guen_runtime::from_fn;
/// use guen_study::{Design, Sweep};
///
/// let sweep = Sweep::over(Design::random(60, 1).uniform("rate", 0.0, 1.0), |point| {
///     let rate = point.get("rate")?;
///     Ok((from_fn(move |_t: f64, &[x]: &[f64; 1]| [-rate * x]), [1.0]))
/// })
/// .simulations([("x", "")], |simulation| simulation.run(0.0..1.0).map(|motion| motion.end()))
/// .with_chunk(10)
/// .silent();
/// let folder = std::env::temp_dir().join(format!("guen-docs-coordinator-{}", std::process::id()));
/// let coordinator = Mutex::new(sweep.coordinator(&folder)?);
/// std::thread::scope(|scope| {
///     for _ in 0..2 {
///         scope.spawn(|| {
///             let worker = sweep.worker(&folder).unwrap();
///             loop {
///                 let Some(assignment) = coordinator.lock().unwrap().assign() else { break };
///                 let finished = worker.compute(assignment).unwrap();
///                 coordinator.lock().unwrap().count(&finished).unwrap();
///             }
///         });
///     }
/// });
/// let report = coordinator.into_inner().unwrap().finish()?;
/// assert_eq!((report.found, report.computed), (0, 6));
/// assert_eq!(sweep.merge([&folder], &folder)?, sweep.run()?);
/// # std::fs::remove_dir_all(folder).unwrap();
/// # Ok::<(), guen_study::SweepError>(())
/// ```
#[must_use = "chunks are computed by workers, and the record is written by `finish`"]
#[derive(Debug)]
pub struct Coordinator {
    plan: Plan,
    tally: Tally,
    report: PartReport,
    todo: std::vec::IntoIter<u64>,
    /// Motions that are finished.
    done: u64,
    progress: Progress,
}

impl Coordinator {
    /// Returns the next chunk for a worker; none when all have been handed out.
    pub fn assign(&mut self) -> Option<Assignment> {
        self.todo.next().map(|chunk| Assignment { chunk })
    }

    /// Counts what a worker has finished; and writes the record, where the last time is two seconds ago, and fifty times as long as it took.
    ///
    /// # Errors
    ///
    /// [`SweepError::Message`] if the text is damaged or belongs to another sweep, [`SweepError::NotReproducible`] if a chunk has other bits than
    /// before, and errors of files.
    pub fn count(&mut self, finished: &str) -> Result<(), SweepError> {
        let refuse = |reason| SweepError::Message { reason };
        let Record { chunks, statistics } = Record::parse(&self.plan, finished).map_err(refuse)?;
        let mut chunks = chunks.into_iter();
        let (Some((chunk, done)), None) = (chunks.next(), chunks.next()) else {
            return Err(refuse("it is not about one chunk"));
        };
        if chunk >= self.plan.chunks() {
            return Err(refuse("the sweep has no such chunk"));
        }
        let motions = self.plan.count(chunk);
        if statistics.motions() != motions {
            return Err(refuse("its statistics are not those of its chunk"));
        }
        self.tally.add(&self.plan, chunk, done, &statistics)?;
        self.done += motions;
        self.progress.at(self.done as f64);
        Ok(())
    }

    /// Writes the record, and returns what this run has done. If chunks are missing, [`Sweep::merge`] says so.
    ///
    /// # Errors
    ///
    /// [`SweepError::Io`] if the record cannot be written.
    pub fn finish(mut self) -> Result<PartReport, SweepError> {
        self.tally.write(&self.plan)?;
        let faults = self.tally.record.statistics.faults();
        Ok(PartReport { computed: self.tally.computed, faults, ..self.report })
    }
}

/// A process that computes the chunks which a [`Coordinator`] hands out; its threads may share it.
#[derive(Debug)]
pub struct Worker<'s, 'a> {
    sweep: &'s Sweep<'a>,
    plan: Plan,
    rows: RowsFolder,
    /// Held as long as it may write rows.
    _lock: Option<File>,
}

impl Worker<'_, '_> {
    /// Computes a chunk, writes its rows into the folder, and returns the text that is to be sent to [`Coordinator::count`].
    ///
    /// # Errors
    ///
    /// [`SweepError::Message`] if the sweep has no such chunk; [`SweepError::Io`] if its file cannot be written.
    pub fn compute(&self, assignment: Assignment) -> Result<String, SweepError> {
        let Assignment { chunk } = assignment;
        if chunk >= self.plan.chunks() {
            return Err(SweepError::Message { reason: "the sweep has no such chunk" });
        }
        let mut thread = run::Thread::new(self.sweep, &self.plan);
        let done = thread.compute(Some(&self.rows), chunk, false)?;
        Ok(Record { chunks: [(chunk, done)].into(), statistics: thread.statistics }.text(&self.plan))
    }

    /// The number of threads that the sweep asks for, or of processors that this process may use.
    pub fn threads(&self) -> usize {
        self.sweep.threads.unwrap_or_else(processors)
    }
}

impl<'a> Sweep<'a> {
    /// Takes a folder to hand out the chunks that are missing there, and to keep the record: see [`Coordinator`].
    ///
    /// # Errors
    ///
    /// Those of [`Part::run_in`]; [`SweepError::Busy`] also where workers of an earlier coordinator are still at work.
    pub fn coordinator(&self, folder: impl AsRef<Path>) -> Result<Coordinator, SweepError> {
        let plan = Plan::of(self)?;
        let part = Part { sweep: self, part: 0, parts: 1 };
        let (tally, report) = part.begin(&plan, folder.as_ref())?;
        let (todo, done, progress) = run::todo(&plan, &part, &tally);
        Ok(Coordinator { plan, tally, report, todo: todo.into_iter(), done, progress })
    }

    /// Joins a folder in which a [`Coordinator`] is at work, to compute chunks for it.
    ///
    /// # Errors
    ///
    /// [`SweepError::Io`] if the folder is not there: workers see the same files as the coordinator. [`SweepError::OtherDeclaration`], [`SweepError::OtherSweep`] and
    /// [`SweepError::OtherParts`] if it belongs to something else.
    pub fn worker(&self, folder: impl AsRef<Path>) -> Result<Worker<'_, 'a>, SweepError> {
        let plan = Plan::of(self)?;
        let (rows, lock) = RowsFolder::of_worker(folder.as_ref(), &plan, self.rows, self.locks)?;
        Ok(Worker { sweep: self, plan, rows, _lock: lock })
    }
}
