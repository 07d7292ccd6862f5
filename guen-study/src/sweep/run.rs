//! Chunks on threads: each thread takes the next chunk, computes and writes it, and tells what it has done.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::block::Block;
use super::error::SweepError;
use super::folder::PartFolder;
use super::part::Part;
use super::plan::Plan;
use super::record::{Chunk, Record};
use super::statistics::Statistics;
use crate::ensemble::processors;
use crate::progress::Progress;

/// The shortest time between two writes of a record, in wall time and in multiples of what a write takes: a run that is killed computes at
/// most so much again.
const PAUSE: Duration = Duration::from_secs(2);
const WRITES: u32 = 50;

/// All that threads have done so far.
pub(super) struct Tally<'a> {
    pub(super) record: Record,
    pub(super) folder: Option<&'a PartFolder<'a>>,
    /// Chunks that are in the record but whose files have to be written anew.
    pub(super) lost: Vec<u64>,
    /// Chunks that this run has computed.
    pub(super) computed: u64,
    written: Instant,
    pause: Duration,
    failed: Option<SweepError>,
}

impl<'a> Tally<'a> {
    pub(super) fn new(record: Record, lost: Vec<u64>, folder: Option<&'a PartFolder<'a>>) -> Self {
        Self { record, folder, lost, computed: 0, written: Instant::now(), pause: PAUSE, failed: None }
    }

    /// Counts a chunk, and writes the record if it is time to.
    fn add(
        &mut self,
        plan: &Plan,
        number: u64,
        done: Chunk,
        statistics: &Statistics,
    ) -> Result<(), SweepError> {
        self.computed += 1;
        if let Some(known) = self.record.chunks.get_mut(&number) {
            // Its statistics are counted already: the rows have to be the same again. How a library writes them may have changed.
            if known.bits != done.bits {
                return Err(SweepError::NotReproducible { first: plan.motions(number).start });
            }
            *known = done;
            return Ok(());
        }
        self.record.chunks.insert(number, done);
        self.record.statistics.merge(statistics);
        if self.written.elapsed() >= self.pause {
            self.write(plan)?;
        }
        Ok(())
    }

    fn write(&mut self, plan: &Plan) -> Result<(), SweepError> {
        if let Some(folder) = self.folder {
            let start = Instant::now();
            folder.write_record(&self.record, plan)?;
            self.pause = PAUSE.max(start.elapsed() * WRITES);
        }
        self.written = Instant::now();
        Ok(())
    }
}

/// Computes the chunks of a part that are not in the record, or whose files are lost.
pub(super) fn run(plan: &Plan, part: &Part<'_, '_>, tally: &mut Tally<'_>) -> Result<(), SweepError> {
    let Part { sweep, part, parts } = *part;
    let chunks = || (part..plan.chunks()).step_by(parts as usize);
    let todo: Vec<u64> = chunks()
        .filter(|chunk| !tally.record.chunks.contains_key(chunk) || tally.lost.contains(chunk))
        .collect();
    let motions = |chunk: u64| {
        let range = plan.motions(chunk);
        range.end - range.start
    };
    let total: u64 = chunks().map(motions).sum();
    let before = total - todo.iter().copied().map(motions).sum::<u64>();
    let progress = Progress::new(before as f64, total as f64);
    let progress = if sweep.progress { progress } else { progress.silent() };
    let (lost, folder) = (std::mem::take(&mut tally.lost), tally.folder);
    let threads = sweep.threads.unwrap_or_else(processors).min(todo.len());
    let queue = Mutex::new(todo.into_iter());
    let shared = Mutex::new((tally, before, progress));
    let worker = || {
        let points = plan.points();
        loop {
            if locked(&shared).0.failed.is_some() {
                break;
            }
            let Some(chunk) = locked(&queue).next() else { break };
            let range = plan.motions(chunk);
            let count = range.end - range.start;
            let mut block = Block::new(plan.axes.len(), plan.kept.len());
            sweep.engine.fill(&points, range, sweep.lanes, &mut block);
            let mut statistics = Statistics::new(plan.statistics.clone());
            if !lost.contains(&chunk) {
                statistics.take(&block, count);
            }
            let bits = block.digest();
            let file = folder.map_or(Ok(None), |folder| folder.write_rows(plan, chunk, &block));
            drop(block);
            let (tally, done, progress) = &mut *locked(&shared);
            let added = file.and_then(|file| tally.add(plan, chunk, Chunk { bits, file }, &statistics));
            if let Err(error) = added {
                tally.failed.get_or_insert(error);
                break;
            }
            *done += count;
            progress.at(*done as f64);
        }
    };
    thread::scope(|scope| {
        (1..threads).for_each(|_| {
            scope.spawn(worker);
        });
        worker();
    });
    let (tally, ..) = shared.into_inner().unwrap_or_else(PoisonError::into_inner);
    // A failure loses none of the chunks that are finished, if the record can be written.
    let written = tally.write(plan);
    tally.failed.take().map_or(written, Err)
}

/// Locks a mutex. A panic of a thread goes on in the caller, which then looks at nothing.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
