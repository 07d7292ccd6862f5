//! The threads of a rank that compute. They call nothing of MPI: messages are the first thread's.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{self, Receiver, Sender};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use guen_study::{Assignment, SweepError, Worker};

/// The text of a finished chunk, or its error; or the panic of a closure.
type Computed = thread::Result<Result<String, SweepError>>;

/// Threads that wait for chunks.
pub(crate) struct Pool {
    assignments: Sender<Assignment>,
    results: Receiver<Computed>,
}

impl Pool {
    /// Runs `work` beside the threads of a worker, which end with it. Returns what it returns.
    pub(crate) fn beside<T>(worker: &Worker<'_, '_>, work: impl FnOnce(&Self) -> T) -> T {
        let (assignments, queue) = mpsc::channel();
        let (tell, results) = mpsc::channel();
        let queue = Mutex::new(queue);
        let thread = |tell: Sender<Computed>| {
            loop {
                let next: Result<Assignment, _> = queue.lock().unwrap_or_else(PoisonError::into_inner).recv();
                let Ok(assignment) = next else { break };
                // Nothing of the worker is looked at after a panic, which the first thread passes on.
                let computed = catch_unwind(AssertUnwindSafe(|| worker.compute(assignment)));
                if tell.send(computed).is_err() {
                    break;
                }
            }
        };
        let thread = &thread;
        thread::scope(|scope| {
            for _ in 0..worker.threads() {
                let tell = tell.clone();
                scope.spawn(move || thread(tell));
            }
            let pool = Self { assignments, results };
            let done = work(&pool);
            drop(pool);
            done
        })
    }

    /// Gives a chunk to the next thread that is free.
    pub(crate) fn compute(&self, assignment: Assignment) {
        // The threads wait as long as there is a sender: it cannot fail.
        let _ = self.assignments.send(assignment);
    }

    /// The next result, if there is one before so much time has passed.
    ///
    /// # Panics
    ///
    /// If the closure of the sweep has panicked.
    pub(crate) fn result(&self, pause: Duration) -> Option<Result<String, SweepError>> {
        let computed = self.results.recv_timeout(pause).ok()?;
        Some(computed.unwrap_or_else(|panic| resume_unwind(panic)))
    }
}
