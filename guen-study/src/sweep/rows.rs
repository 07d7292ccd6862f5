//! Formats of rows, and rows as comma-separated values.

use std::fmt::Write as _;

use super::block::Block;
use super::error::SweepError;
use super::plan::Plan;
use crate::cell;

/// The format in which a sweep writes its rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Rows {
    /// Comma-separated values, in as many digits as tell doubles apart. A faulty motion has empty cells; units are in `columns.csv`.
    #[default]
    Csv,
    /// Apache Parquet, which pandas and polars read: uncompressed columns of doubles, null for faulty motions, with the units and the digest
    /// of the sweep in the metadata of every file.
    #[cfg(feature = "parquet")]
    #[cfg_attr(docsrs, doc(cfg(feature = "parquet")))]
    Parquet,
    /// None: statistics and digests alone.
    Nothing,
}

impl Rows {
    pub(super) fn text(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            #[cfg(feature = "parquet")]
            Self::Parquet => "parquet",
            Self::Nothing => "nothing",
        }
    }

    /// The file of a chunk below the folder of the sweep; none if there are no rows.
    pub(super) fn file(self, chunk: u64) -> Option<String> {
        (self != Self::Nothing).then(|| format!("rows/chunk-{chunk:08}.{}", self.text()))
    }

    /// The content of the file of a block.
    pub(super) fn content(self, plan: &Plan, block: &Block) -> Result<Vec<u8>, SweepError> {
        match self {
            Self::Csv => Ok(csv(plan, block).into_bytes()),
            #[cfg(feature = "parquet")]
            Self::Parquet => super::parquet::content(plan, block),
            Self::Nothing => Ok(Vec::new()),
        }
    }
}

fn csv(plan: &Plan, block: &Block) -> String {
    let names: Vec<String> = plan.columns().iter().map(|column| cell::text(&column.name)).collect();
    let mut text = names.join(",") + "\n";
    for (row, fault) in block.faults().enumerate() {
        let _ = write!(text, "{}", block.motions[row]);
        for column in &block.points {
            let _ = write!(text, ",{:?}", column[row]);
        }
        for column in &block.kept {
            text.push(',');
            if fault.is_none() {
                let _ = write!(text, "{:?}", column[row]);
            }
        }
        text.push(',');
        if let Some(time) = fault.and_then(|fault| fault.time) {
            let _ = write!(text, "{time:?}");
        }
        text.push(',');
        if let Some(fault) = fault {
            text += &cell::text(&fault.cause);
        }
        text.push('\n');
    }
    text
}
