//! The battery: what is asked, what comes back, and the verdict.
//!
//! A [`Task`] asks one thing and makes a [`Line`] of it, with an [`Answer`] for every method. An answer is *right to* an
//! error that was measured against a reference in 71 digits, or a *typed error*. Anything else fails the battery: a number
//! further off than the method promises (a silent failure), or a typed error where a method has to arrive.

pub mod chains;
pub mod constants;
pub mod growth;
pub mod hoop;
pub mod methods;
pub mod motion;
pub mod reals;
pub mod reference;
pub mod sled;
pub mod starts;
pub mod stiff;
pub mod systems;
pub mod table;
pub mod tops;
pub mod turntable;
pub mod units;

use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::threads::on_threads;

/// What became of a question.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// The answer differs from the reference by so much, and may by so much.
    Right { error: f64, allowed: f64 },
    /// A typed error, in short and as it displays.
    Refused { short: String, text: String },
    /// An answer that is further off than promised.
    Silent { error: f64, allowed: f64 },
    /// A typed error where an answer is due.
    Failed { text: String },
}

impl Verdict {
    /// An error against what is allowed; what is no number is infinitely wrong.
    pub fn of(error: f64, allowed: f64) -> Self {
        if error <= allowed { Self::Right { error, allowed } } else { Self::Silent { error, allowed } }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Right { error: 0.0, .. } => f.write_str("right to the bit"),
            Self::Right { error, allowed } => write!(f, "right to {error:.0e}, {allowed:.0e} allowed"),
            Self::Refused { text, .. } => write!(f, "typed error: {text}"),
            Self::Silent { error, allowed } => {
                write!(f, "SILENT FAILURE: off by {error:.1e}, allowed are {allowed:.0e}")
            }
            Self::Failed { text } => write!(f, "FAILED where an answer is due: {text}"),
        }
    }
}

/// The answer of one method, or to one part of a question.
#[derive(Clone, Debug)]
pub struct Answer {
    pub by: &'static str,
    pub verdict: Verdict,
}

/// A question and its answers.
#[derive(Clone, Debug)]
pub struct Line {
    pub system: &'static str,
    pub asked: String,
    /// What the answers were compared with.
    pub against: String,
    pub answers: Vec<Answer>,
}

/// Something to ask.
pub struct Task {
    pub system: &'static str,
    /// Whether the shortened battery asks it.
    pub quick: bool,
    pub ask: Box<dyn FnOnce() -> Line + Send>,
}

impl Task {
    pub fn new(system: &'static str, quick: bool, ask: impl FnOnce() -> Line + Send + 'static) -> Self {
        Self { system, quick, ask: Box::new(ask) }
    }
}

/// Everything that there is to ask.
pub fn tasks() -> Vec<Task> {
    let mut all = Vec::new();
    all.extend(hoop::tasks());
    all.extend(sled::tasks());
    all.extend(stiff::tasks());
    all.extend(turntable::tasks());
    all.extend(tops::tasks());
    all.extend(chains::tasks());
    all.extend(units::tasks());
    all.extend(starts::tasks());
    all.extend(reals::tasks());
    all.extend(constants::tasks());
    all
}

/// Asks everything on so many threads; the lines are in the order of the tasks. `progress` is told how many of how many
/// are done, the last of them, and how many seconds it took.
pub fn run(
    tasks: Vec<Task>,
    threads: usize,
    progress: impl Fn(usize, usize, &Line, f64) + Sync,
) -> Vec<Line> {
    let count = tasks.len();
    let queue: Vec<Mutex<Option<Task>>> = tasks.into_iter().map(|task| Mutex::new(Some(task))).collect();
    let lines: Vec<Mutex<Option<Line>>> = queue.iter().map(|_| Mutex::new(None)).collect();
    let (next, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
    on_threads(threads.clamp(1, count.max(1)), || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(task) = queue.get(index) else { break };
            let Some(task) = task.lock().ok().and_then(|mut task| task.take()) else { break };
            let start = std::time::Instant::now();
            let line = (task.ask)();
            let seconds = start.elapsed().as_secs_f64();
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, count, &line, seconds);
            if let Ok(mut place) = lines[index].lock() {
                *place = Some(line);
            }
        }
    });
    lines.into_iter().filter_map(|line| line.into_inner().ok().flatten()).collect()
}
