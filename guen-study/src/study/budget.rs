//! The time of a study, and its progress.

use std::time::Duration;

use super::Stop;
use super::timing::{Deadline, Stopwatch};
use crate::Progress;

/// The parts of a study, with the part of the whole that each begins and ends at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    Scan,
    Reference,
    /// A reference of fewer digits, where the other one took too long.
    Shorter,
    Accuracy,
    Nearby,
    Timing,
}

impl Stage {
    fn part(self) -> (f64, f64) {
        match self {
            Self::Scan => (0.0, 0.1),
            Self::Reference => (0.1, 0.3),
            Self::Shorter => (0.3, 0.45),
            Self::Accuracy => (0.45, 0.6),
            Self::Nearby => (0.6, 0.72),
            Self::Timing => (0.72, 1.0),
        }
    }
}

/// The time of a study, its progress, and whether it was cancelled.
pub(super) struct Budget {
    /// The clock, which also says how long a run takes.
    pub clock: Box<dyn Stopwatch>,
    started: Duration,
    whole: Duration,
    progress: Option<Progress>,
    stop: Stop,
    cancelled: bool,
    late: bool,
}

impl Budget {
    pub fn new(whole: Duration, show: bool, stop: Stop, clock: Box<dyn Stopwatch>) -> Self {
        /// A century: whoever gives all the time that there is means no limit, and no sum of times may overflow.
        const MOST: Duration = Duration::from_secs(100 * 365 * 86_400);
        let progress = show.then(|| Progress::new(0.0, 1.0));
        let started = clock.now();
        let whole = whole.min(MOST);
        Self { clock, started, whole, progress, stop, cancelled: false, late: false }
    }

    /// Shows how far a stage has come, and says whether to go on. A stage may use the time up to its own end and what
    /// the stages before left.
    pub fn goes_on(&mut self, stage: Stage, part: f64) -> bool {
        let (from, to) = stage.part();
        let done = from + (to - from) * part.clamp(0.0, 1.0);
        if let Some(progress) = &mut self.progress {
            progress.at(done);
        }
        self.cancelled |= (self.stop)(done);
        let over = self.deadline(stage).is_over();
        // Of a scan that ends early the report says what it saw, and another reference takes the place of one that does.
        self.late |= over && !matches!(stage, Stage::Scan | Stage::Reference);
        !over && !self.cancelled
    }

    /// Returns the time at which a stage has to be over.
    pub fn deadline(&self, stage: Stage) -> Deadline<'_> {
        Deadline { clock: &*self.clock, at: self.started + self.whole.mul_f64(stage.part().1) }
    }

    /// Returns the time that is so far from now.
    pub fn after(&self, time: Duration) -> Deadline<'_> {
        Deadline { clock: &*self.clock, at: self.clock.now() + time }
    }

    pub fn share(&self, stage: Stage) -> Duration {
        let (from, to) = stage.part();
        self.whole.mul_f64(to - from)
    }

    pub fn seconds(&self) -> f64 {
        (self.clock.now() - self.started).as_secs_f64()
    }

    pub fn is_cancelled(&self) -> bool {
        self.cancelled
    }

    /// Remembers whether something had to end early.
    pub fn be_late(&mut self, late: bool) {
        self.late |= late;
    }

    /// Whether a stage had to end early.
    pub fn is_late(&self) -> bool {
        self.late
    }
}
