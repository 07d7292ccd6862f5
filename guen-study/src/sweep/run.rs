//! Chunks on threads: each thread takes the next chunk, computes and writes it, and tells what it has done.

use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::block::Block;
use super::design::PointsAt;
use super::error::SweepError;
use super::folder::{PartFolder, RowsFolder};
use super::plan::Plan;
use super::record::{Chunk, Record};
use super::statistics::Statistics;
use super::{Part, Sweep};
use crate::ensemble::processors;
use crate::progress::Progress;

/// The shortest time between two writes of a record, in wall time and in multiples of what a write takes: a run that is killed computes at
/// most so much again.
const PAUSE: Duration = Duration::from_secs(2);
const WRITES: u32 = 50;

/// All that threads have done so far.
#[derive(Debug)]
pub(super) struct Tally {
    pub(super) record: Record,
    pub(super) folder: Option<PartFolder>,
    /// Chunks that are in the record but whose files have to be written anew.
    pub(super) lost: Vec<u64>,
    /// Chunks that this run has computed.
    pub(super) computed: u64,
    written: Instant,
    pause: Duration,
    failed: Option<SweepError>,
}

impl Tally {
    pub(super) fn new(record: Record, lost: Vec<u64>, folder: Option<PartFolder>) -> Self {
        Self { record, folder, lost, computed: 0, written: Instant::now(), pause: PAUSE, failed: None }
    }

    /// Counts a chunk, and writes the record if it is time to.
    pub(super) fn add(
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

    pub(super) fn write(&mut self, plan: &Plan) -> Result<(), SweepError> {
        if let Some(folder) = &self.folder {
            let start = Instant::now();
            folder.write_record(&self.record, plan)?;
            self.pause = PAUSE.max(start.elapsed() * WRITES);
        }
        self.written = Instant::now();
        Ok(())
    }
}

/// The chunks of a part that are not in the record, or whose files are lost; and how far that is, in motions, with what is shown of it.
pub(super) fn todo(plan: &Plan, part: &Part<'_, '_>, tally: &Tally) -> (Vec<u64>, u64, Progress) {
    let chunks = || (part.part..plan.chunks()).step_by(part.parts as usize);
    let todo: Vec<u64> = chunks()
        .filter(|chunk| !tally.record.chunks.contains_key(chunk) || tally.lost.contains(chunk))
        .collect();
    let total: u64 = chunks().map(|chunk| plan.count(chunk)).sum();
    let before = total - todo.iter().map(|chunk| plan.count(*chunk)).sum::<u64>();
    let progress = Progress::new(before as f64, total as f64);
    (todo, before, if part.sweep.progress { progress } else { progress.silent() })
}

/// One thread's work: chunk by chunk in the same memory.
pub(super) struct Thread<'p, 's, 'a> {
    sweep: &'s Sweep<'a>,
    plan: &'p Plan,
    points: PointsAt<'p>,
    block: Block,
    /// Statistics of the last chunk.
    pub(super) statistics: Statistics,
}

impl<'p, 's, 'a> Thread<'p, 's, 'a> {
    pub(super) fn new(sweep: &'s Sweep<'a>, plan: &'p Plan) -> Self {
        Self {
            sweep,
            plan,
            points: plan.points(),
            block: Block::new(plan.axes.len(), plan.kept.len()),
            statistics: Statistics::new(plan.statistics.clone()),
        }
    }

    /// Computes a chunk and writes its rows. Statistics of one that is counted already are empty.
    pub(super) fn compute(
        &mut self,
        folder: Option<&RowsFolder>,
        chunk: u64,
        counted: bool,
    ) -> Result<Chunk, SweepError> {
        let Self { sweep, plan, points, block, statistics } = self;
        block.clear();
        sweep.engine.fill(points, plan.motions(chunk), sweep.lanes, block);
        statistics.clear();
        if !counted {
            statistics.take(block, plan.count(chunk));
        }
        let bits = block.digest();
        let file = folder.map_or(Ok(None), |folder| folder.write_rows(plan, chunk, block))?;
        Ok(Chunk { bits, file })
    }
}

/// Computes the chunks of a part that are not in the record, or whose files are lost.
pub(super) fn run(plan: &Plan, part: &Part<'_, '_>, tally: &mut Tally) -> Result<(), SweepError> {
    let (todo, before, progress) = todo(plan, part, tally);
    let sweep = part.sweep;
    let lost = std::mem::take(&mut tally.lost);
    let folder = tally.folder.as_ref().map(|folder| folder.rows.clone());
    let threads = sweep.threads.unwrap_or_else(processors).min(todo.len());
    let queue = Mutex::new(todo.into_iter());
    let shared = Mutex::new((tally, before, progress));
    let worker = || {
        let mut thread = Thread::new(sweep, plan);
        loop {
            if locked(&shared).0.failed.is_some() {
                break;
            }
            let Some(chunk) = locked(&queue).next() else { break };
            let computed = thread.compute(folder.as_ref(), chunk, lost.contains(&chunk));
            let (tally, done, progress) = &mut *locked(&shared);
            let added = computed.and_then(|done| tally.add(plan, chunk, done, &thread.statistics));
            if let Err(error) = added {
                tally.failed.get_or_insert(error);
                break;
            }
            *done += plan.count(chunk);
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
