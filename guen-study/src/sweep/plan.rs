//! The plan of a sweep: its columns, chunks and statistics, and the text by which it is told apart from others.

use std::fmt::Write as _;
use std::ops::Range;

use super::Sweep;
use super::block::Column;
use super::design::{Design, PointsAt};
use super::engine::probes;
use super::error::SweepError;
use super::sha256::Sha256;
use super::statistics::{self, Bins};

/// The first line of every manifest.
const VERSION: &str = "guen sweep, version 1";
/// The word of the line with the digest of the declaration: the first, so that nothing else is told of another one.
pub(super) const DECLARATION: &str = "declaration";
/// The most motions of a chunk, and the chunks that there are below that and above what is worth one, unless a sweep says otherwise.
const MOST: u64 = 1 << 14;
const CHUNKS: u64 = 256;
/// The most bins of a histogram.
const MOST_BINS: usize = 1_000_000;

/// The plan of a run: columns, chunks and statistics.
#[derive(Debug)]
pub(super) struct Plan {
    pub(super) design: Design,
    /// The columns of the design, and those that are kept.
    pub(super) axes: Vec<Column>,
    pub(super) kept: Vec<Column>,
    pub(super) statistics: statistics::Plan,
    pub(super) chunk: u64,
    /// The manifest, without its digest and the number of parts.
    pub(super) text: String,
    /// The digest of the text.
    pub(super) digest: String,
    /// The digest of the declaration.
    #[cfg_attr(
        not(feature = "parquet"),
        allow(dead_code, reason = "it goes into files of Parquet; the text has it, too")
    )]
    pub(super) declaration: String,
}

impl Plan {
    /// The names of all columns of a row, with their units.
    pub(super) fn columns(&self) -> Vec<Column> {
        let fixed = |name: &str| Column::new(name, "");
        let mut all = vec![fixed("motion")];
        all.extend(self.axes.iter().chain(&self.kept).cloned());
        all.extend([fixed("fault_time"), fixed("fault")]);
        all
    }

    pub(super) fn of(sweep: &Sweep<'_>) -> Result<Self, SweepError> {
        let design = sweep.design.clone().checked()?;
        let kept = sweep.engine.columns().to_vec();
        let axes = axes(&design, &kept);
        told_apart(&axes, &kept)?;
        let statistics = chosen(sweep, &axes, &kept)?;
        let count = design.len();
        let usual = (count / CHUNKS).clamp(sweep.engine.fewest(), MOST);
        // Full lanes.
        let chunk = sweep.chunk.unwrap_or(usual.next_multiple_of(8));
        let mut digest = Sha256::default();
        design.table().iter().for_each(|value| digest.update(&value.to_bits().to_le_bytes()));
        sweep.engine.probe(&design.points_at(), &probes(&design), &mut digest)?;
        let mut text = format!("{VERSION}\n");
        let names = |columns: &[Column]| {
            let named = |column: &Column| match column.unit.as_str() {
                "" => column.name.clone(),
                unit => format!("{} [{unit}]", column.name),
            };
            columns.iter().map(named).collect::<Vec<String>>().join(", ")
        };
        for (word, value) in [
            (DECLARATION, declaration(sweep.engine.declaration())),
            ("name", one_line(&sweep.name)),
            ("design", one_line(&design.text())),
            ("kept", one_line(&sweep.engine.text())),
            ("columns", one_line(&names(&kept))),
            ("statistics", one_line(&format!("{:?} {:?}", names(&statistics.columns), statistics.bins))),
            ("motions of a chunk", chunk.to_string()),
            ("rows", sweep.rows.text().to_owned()),
            ("systems and starts", digest.finish()),
        ] {
            let _ = writeln!(text, "{word}: {value}");
        }
        let digest = Sha256::of(text.as_bytes());
        let declaration = declaration(sweep.engine.declaration());
        Ok(Self { design, axes, kept, statistics, chunk, text, digest, declaration })
    }

    /// The number of chunks.
    pub(super) fn chunks(&self) -> u64 {
        self.design.len().div_ceil(self.chunk)
    }

    /// The motions of a chunk.
    pub(super) fn motions(&self, chunk: u64) -> Range<u64> {
        let first = chunk * self.chunk;
        first..self.design.len().min(first + self.chunk)
    }

    /// The number of motions of a chunk.
    pub(super) fn count(&self, chunk: u64) -> u64 {
        let range = self.motions(chunk);
        range.end - range.start
    }

    pub(super) fn points(&self) -> PointsAt<'_> {
        self.design.points_at()
    }
}

/// The digest of a declaration in words.
pub(super) fn declaration(digest: u64) -> String {
    if digest == 0 { "none".to_owned() } else { format!("{digest:016x}") }
}

/// A text without line breaks. Long ones, as reports are, become their first words and a digest.
fn one_line(text: &str) -> String {
    const LONG: usize = 400;
    let line = text.split_whitespace().collect::<Vec<&str>>().join(" ");
    match line.char_indices().nth(LONG) {
        None => line,
        Some((end, _)) => format!("{}.. {}", &line[..end], Sha256::of(text.as_bytes())),
    }
}

/// The columns that every row has beside those of the design and what is kept.
pub(super) const FIXED: [&str; 3] = ["motion", "fault_time", "fault"];

/// Refuses two columns of one name.
fn told_apart(axes: &[Column], kept: &[Column]) -> Result<(), SweepError> {
    let own = axes.iter().chain(kept).map(|column| column.name.as_str());
    let all: Vec<&str> = FIXED.into_iter().chain(own).collect();
    let twice = all.iter().enumerate().find(|(place, name)| all[..*place].contains(*name));
    twice.map_or(Ok(()), |(_, name)| Err(SweepError::DuplicateColumn { name: (*name).to_owned() }))
}

/// The columns of the axes: those with the name of something kept are told apart from it.
fn axes(design: &Design, kept: &[Column]) -> Vec<Column> {
    let taken = |name: &str| FIXED.contains(&name) || kept.iter().any(|column| column.name == name);
    let unit = |name: &str| {
        let same = kept.iter().find(|column| column.name == name);
        same.map_or(String::new(), |column| column.unit.clone())
    };
    let column = |name: &String| {
        let own = if taken(name) { format!("design_{name}") } else { name.clone() };
        Column::new(own, unit(name))
    };
    design.names().iter().map(column).collect()
}

/// The columns that statistics are of.
fn chosen(sweep: &Sweep<'_>, axes: &[Column], kept: &[Column]) -> Result<statistics::Plan, SweepError> {
    let all: Vec<&Column> = axes.iter().chain(kept).collect();
    let known = || all.iter().map(|column| column.name.clone()).collect();
    let place = |name: &String| {
        let place = all.iter().position(|column| column.name == *name);
        place.ok_or_else(|| SweepError::UnknownColumn { name: name.clone(), known: known() })
    };
    let mut places: Vec<usize> = match &sweep.selected {
        Some(names) => names.iter().map(place).collect::<Result<_, _>>()?,
        None => (axes.len()..all.len()).collect(),
    };
    let mut seen = Vec::new();
    places.retain(|place| {
        !seen.contains(place) && {
            seen.push(*place);
            true
        }
    });
    let mut bins = Vec::new();
    for (name, own) in &sweep.bins {
        let place = place(name)?;
        let is_range = own.low < own.high && (own.high - own.low).is_finite();
        if !is_range || !(1..=MOST_BINS).contains(&own.count) {
            return Err(SweepError::Histogram { column: name.clone() });
        }
        let column = places.iter().position(|own| *own == place).unwrap_or_else(|| {
            places.push(place);
            places.len() - 1
        });
        if bins.iter().any(|other: &Bins| other.column == column) {
            return Err(SweepError::Histogram { column: name.clone() });
        }
        bins.push(Bins { column, ..own.clone() });
    }
    let columns = places.iter().map(|place| all[*place].clone()).collect();
    Ok(statistics::Plan { columns, places, bins, groups: sweep.engine.groups().max(1) })
}
