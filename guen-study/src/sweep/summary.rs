//! The result of a sweep.

use super::record::Record;
use super::statistics::Statistics;

/// The result of a sweep: its statistics, and a digest of all rows.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    statistics: Statistics,
    digest: String,
}

impl Summary {
    pub(super) fn new(record: Record) -> Self {
        Self { digest: record.digest(), statistics: record.statistics }
    }

    /// The statistics.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The digest of the bits of all rows: the same on every machine, with any number of threads, lanes and parts, whatever the rows are
    /// written as. Chunks of another size have another digest.
    pub fn digest(&self) -> &str {
        &self.digest
    }
}
