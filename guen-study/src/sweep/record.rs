//! The record of a part: the chunks that are finished, with the digests of their rows and files, and the statistics of all of them. One file
//! says both, so that a kill between two writes cannot count a chunk twice or not at all.

use std::collections::BTreeMap;

use super::plan::Plan;
use super::sha256::Sha256;
use super::statistics::Statistics;

/// A finished chunk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Chunk {
    /// The digest of the bits of its rows.
    pub(super) bits: String,
    /// The digest of its file, where rows are written.
    pub(super) file: Option<String>,
}

/// The chunks that are finished.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Record {
    pub(super) chunks: BTreeMap<u64, Chunk>,
    pub(super) statistics: Statistics,
}

/// The first line.
const VERSION: &str = "guen sweep part, version 2";

impl Record {
    pub(super) fn new(plan: &Plan) -> Self {
        Self { chunks: BTreeMap::new(), statistics: Statistics::new(plan.statistics.clone()) }
    }

    /// The record as text, with its own digest at the end.
    pub(super) fn text(&self, plan: &Plan) -> String {
        let mut text = format!("{VERSION}\nsweep {}\n", plan.digest);
        for (number, chunk) in &self.chunks {
            text += &format!("chunk {number} {} {}\n", chunk.bits, chunk.file.as_deref().unwrap_or("-"));
        }
        text += "statistics\n";
        text += &self.statistics.text();
        let digest = Sha256::of(text.as_bytes());
        text + "sha256 " + &digest + "\n"
    }

    /// Reads what [`text`](Self::text) wrote, or says what is wrong with it.
    pub(super) fn parse(plan: &Plan, text: &str) -> Result<Self, &'static str> {
        const DAMAGED: &str = "its content does not fit its digest";
        let (content, digest) = text.rsplit_once("sha256 ").ok_or("its end is missing")?;
        if digest.strip_suffix('\n') != Some(&Sha256::of(content.as_bytes())) {
            return Err(DAMAGED);
        }
        let (head, statistics) = content.split_once("\nstatistics\n").ok_or(DAMAGED)?;
        let mut lines = head.lines();
        if lines.next() != Some(VERSION) {
            return Err("it has been written by another version");
        }
        if lines.next().and_then(|line| line.strip_prefix("sweep ")) != Some(&plan.digest) {
            return Err("it belongs to another sweep");
        }
        let chunk = |line: &str| {
            let mut words = line.strip_prefix("chunk ")?.split(' ');
            let number = words.next()?.parse().ok()?;
            let (bits, file) = (words.next()?.to_owned(), words.next()?);
            Some((number, Chunk { bits, file: (file != "-").then(|| file.to_owned()) }))
        };
        let chunks = lines.map(chunk).collect::<Option<_>>().ok_or(DAMAGED)?;
        let statistics = Statistics::parse(&plan.statistics, statistics).ok_or(DAMAGED)?;
        Ok(Self { chunks, statistics })
    }

    /// The digest of all rows that are finished, in order: equal rows have equal digests, however they were computed and written.
    pub(super) fn digest(&self) -> String {
        let mut digest = Sha256::default();
        self.chunks.values().for_each(|chunk| digest.update(chunk.bits.as_bytes()));
        digest.finish()
    }
}
