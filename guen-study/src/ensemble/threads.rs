//! Work in portions, which threads take in turn.

use std::num::NonZero;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread;

use crate::progress::Progress;

/// Portions for each thread: enough for those that have light ones to help out at the end.
const PORTIONS: usize = 16;

/// Returns the number of threads that can run at once, one at least. Asked for once: the answer is read from several
/// files, which takes as long as a short ensemble.
pub(crate) fn processors() -> usize {
    static FOUND: OnceLock<usize> = OnceLock::new();
    *FOUND.get_or_init(|| thread::available_parallelism().map_or(1, NonZero::get))
}

/// The results of `work` on the parts of `0 .. count`, in order. Parts begin at multiples of `unit`.
///
/// The calling thread works, too. A panic in `work` goes on in the caller, once all threads have ended.
pub(super) fn in_turn<T: Send>(
    count: usize,
    unit: usize,
    threads: usize,
    progress: Progress,
    work: impl Fn(Range<usize>) -> Vec<T> + Sync,
) -> Vec<T> {
    let units = count.div_ceil(unit);
    let size = unit * units.div_ceil(threads.saturating_mul(PORTIONS)).max(1);
    let mut results: Vec<Vec<T>> = (0..count.div_ceil(size)).map(|_| Vec::new()).collect();
    let queue = Mutex::new(results.iter_mut().enumerate());
    let progress = Mutex::new((0, progress));
    let worker = || {
        loop {
            let Some((portion, slot)) = locked(&queue).next() else { break };
            let range = portion * size..count.min((portion + 1) * size);
            let length = range.len();
            *slot = work(range);
            let (done, progress) = &mut *locked(&progress);
            *done += length;
            progress.at(*done as f64);
        }
    };
    thread::scope(|scope| {
        let helpers = NonZero::new(threads).map_or(0, |threads| threads.get() - 1).min(count.div_ceil(size));
        for _ in 0..helpers {
            scope.spawn(worker);
        }
        worker();
    });
    results.into_iter().flatten().collect()
}

/// Locks a mutex, poisoned or not: its content is whole even if a thread panicked, since no change to it is done by
/// halves.
fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
