//! The time of a study, and its progress.

use std::time::{Duration, Instant};

use super::Stop;
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
    started: Instant,
    whole: Duration,
    progress: Option<Progress>,
    stop: Stop,
    cancelled: bool,
    late: bool,
}

impl Budget {
    pub fn new(whole: Duration, show: bool, stop: Stop) -> Self {
        let progress = show.then(|| Progress::new(0.0, 1.0));
        Self { started: Instant::now(), whole, progress, stop, cancelled: false, late: false }
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
        let over = Instant::now() >= self.deadline(stage);
        // Of a scan that ends early the report says what it saw, and another reference takes the place of one that does.
        self.late |= over && !matches!(stage, Stage::Scan | Stage::Reference);
        !over && !self.cancelled
    }

    /// Returns the instant at which a stage has to be over.
    pub fn deadline(&self, stage: Stage) -> Instant {
        self.started + self.whole.mul_f64(stage.part().1)
    }

    pub fn share(&self, stage: Stage) -> Duration {
        let (from, to) = stage.part();
        self.whole.mul_f64(to - from)
    }

    pub fn seconds(&self) -> f64 {
        self.started.elapsed().as_secs_f64()
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
