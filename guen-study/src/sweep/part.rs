//! A part of a sweep.

use std::path::Path;

use super::Part;
use super::error::SweepError;
use super::folder::PartFolder;
use super::plan::Plan;
use super::run::{Tally, run};

/// The work of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartReport {
    /// The chunks that earlier runs had finished.
    pub found: u64,
    /// The chunks that this run has computed.
    pub computed: u64,
    /// The finished chunks whose files had been lost or damaged, and are written again.
    pub rewritten: u64,
    /// Whether the record of the part had been damaged, so that all of it was computed anew.
    pub record_was_damaged: bool,
    /// The motions of the part that have failed.
    pub faults: u64,
}

impl Part<'_, '_> {
    /// Computes the motions of this part and writes their rows into a folder, which the other parts may share: see [`Sweep::run_in`](super::Sweep::run_in).
    ///
    /// A run that was killed at any instant, or that an error has ended, is gone on with by calling this again: finished chunks are looked at, and
    /// computed anew where their files are lost or damaged; nothing is lost, and nothing counted twice.
    ///
    /// # Errors
    ///
    /// - [`SweepError::Io`]: the disk is full, the folder cannot be written, or its file system has no locks.
    /// - [`SweepError::Busy`]: another process is at work on this part.
    /// - [`SweepError::OtherDeclaration`], [`SweepError::OtherSweep`], [`SweepError::OtherParts`]: the folder belongs to something else.
    /// - [`SweepError::NotReproducible`]: a chunk that had to be computed again has other bits.
    /// - What is wrong with the design or the columns.
    pub fn run_in(&self, folder: impl AsRef<Path>) -> Result<PartReport, SweepError> {
        let plan = Plan::of(self.sweep)?;
        let (mut tally, mut report) = self.begin(&plan, folder.as_ref())?;
        run(&plan, self, &mut tally)?;
        report.computed = tally.computed;
        report.faults = tally.record.statistics.faults();
        Ok(report)
    }

    /// Takes the folder, and looks at what earlier runs have finished.
    pub(super) fn begin(&self, plan: &Plan, folder: &Path) -> Result<(Tally, PartReport), SweepError> {
        let (rows, locks) = (self.sweep.rows, self.sweep.locks);
        let folder = PartFolder::open(folder, plan, (self.part, self.parts), rows, locks)?;
        let (record, record_was_damaged) = folder.record(plan)?;
        let lost = folder.lost(&record)?;
        let report = PartReport {
            found: record.chunks.len() as u64,
            computed: 0,
            rewritten: lost.len() as u64,
            record_was_damaged,
            faults: record.statistics.faults(),
        };
        Ok((Tally::new(record, lost, Some(folder)), report))
    }
}
