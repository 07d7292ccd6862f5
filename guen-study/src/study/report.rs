//! Reports of studies: the rows, which of them are worth choosing, and what may be said of them.

use std::fmt;

use super::front::pareto_front;
use super::known::ScanReport;
use super::reference::ReferenceReport;
use super::row::{Nearby, Row};
use crate::significant;

/// The unit of costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Unit {
    /// Seconds for one initial state.
    Seconds,
    /// Evaluations of the right-hand side for one initial state; a Jacobian counts as many as the system has variables.
    Evaluations,
}

impl Unit {
    /// A cost for people, with its unit.
    pub(super) fn show(self, cost: f64) -> String {
        match self {
            Self::Seconds if cost < 1e-3 => format!("{} us", significant(1e6 * cost, 3)),
            Self::Seconds if cost < 1.0 => format!("{} ms", significant(1e3 * cost, 3)),
            Self::Seconds => format!("{} s", significant(cost, 3)),
            Self::Evaluations => format!("{} ev", significant(cost, 6)),
        }
    }
}

/// The end of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Ending {
    /// Everything was measured.
    Complete,
    /// The time for the study was over: what was measured is there.
    OutOfTime,
    /// The study was cancelled: the rows that were measured are there.
    Cancelled,
}

/// The result of a study. Displays as a table of the settings worth choosing, with everything that qualifies them;
/// [`table`](StudyReport::table) has every row.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct StudyReport {
    /// The title of the study.
    pub title: String,
    /// The measure of error, in words.
    pub measure: String,
    /// Beginning and end of the span.
    pub span: (f64, f64),
    /// The number of initial states.
    pub starts: usize,
    /// The unit of costs.
    pub unit: Unit,
    /// The reference; none where the measure needs none.
    pub reference: Option<ReferenceReport>,
    /// The search for features that methods might step over; none where the measure needs no reference.
    pub scan: Option<ScanReport>,
    /// Every setting that was tried and is worth showing, in the order of the variants, from coarse to fine.
    pub rows: Vec<Row>,
    /// The end of the study.
    pub ending: Ending,
    /// The number of states nearby that settings were tried from.
    pub probes: usize,
    /// The median over the rows of half the interval of the median cost, relative.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub noise: f64,
    /// The seconds that the study took.
    #[cfg_attr(feature = "serde", serde(with = "crate::exact"))]
    pub seconds: f64,
    /// Machine and build, as far as they are known.
    pub conditions: String,
}

impl StudyReport {
    fn points(&self) -> Vec<(f64, f64)> {
        let point = |row: &Row| row.measured().map_or((f64::NAN, f64::NAN), |(e, cost)| (e, cost.median));
        self.rows.iter().map(point).collect()
    }

    /// The rows that no other one beats in both error and median cost, from coarse to fine. Neighbours whose costs tie
    /// are both there.
    pub fn front(&self) -> Vec<&Row> {
        pareto_front(&self.points()).into_iter().map(|i| &self.rows[i]).collect()
    }

    /// Whether the motions were looked at closely.
    pub(super) fn is_scanned(&self) -> bool {
        self.scan.as_ref().is_some_and(|scan| scan.width.is_some())
    }

    pub(super) fn front_indices(&self) -> Vec<usize> {
        pareto_front(&self.points())
    }

    /// The neighbours on the front whose costs cannot be told apart, and the number of neighbours.
    pub fn ties_on_front(&self) -> (usize, usize) {
        let front = self.front();
        let tied = |pair: &&[&Row]| match (&pair[0].cost, &pair[1].cost) {
            (Some(a), Some(b)) => a.ties_with(b),
            _ => false,
        };
        (front.windows(2).filter(tied).count(), front.len().saturating_sub(1))
    }

    /// Every row as a text table.
    pub fn table(&self) -> String {
        self.show(self.rows.iter())
    }

    fn show<'a>(&self, rows: impl Iterator<Item = &'a Row>) -> String {
        let mut lines = vec![["error", "nearby", "cost", "+-", "evaluations", "setting"].map(str::to_owned)];
        for row in rows {
            let error = match (&row.failure, row.error) {
                (Some(_), _) => "failed".to_owned(),
                (None, Some(error)) if row.limited => format!("~{error:.1e}"),
                (None, Some(error)) => format!("{error:.1e}"),
                (None, None) => "-".to_owned(),
            };
            let nearby = match row.nearby {
                Some(Nearby::Error(error)) => format!("{error:.1e}"),
                Some(Nearby::Failed) => "failed".to_owned(),
                None => "-".to_owned(),
            };
            let cost = row.cost.map_or("-".to_owned(), |cost| self.unit.show(cost.median));
            let noise = row.cost.map_or("-".to_owned(), |cost| format!("{:.1}%", 100.0 * cost.noise()));
            let reason = row.failure.as_ref().map_or(String::new(), |failure| match failure.time {
                Some(time) => format!(": at t = {} {}", significant(time, 4), failure.message),
                None => format!(": {}", failure.message),
            });
            let evaluations =
                if row.evaluations > 0.0 { format!("{:.0}", row.evaluations) } else { "-".into() };
            lines.push([error, nearby, cost, noise, evaluations, row.name() + &reason]);
        }
        aligned(&lines)
    }
}

/// Columns under each other: the last one to the left, all others to the right.
fn aligned(lines: &[[String; 6]]) -> String {
    let width = |k: usize| lines.iter().map(|line| line[k].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..5).map(width).collect();
    let mut text = String::new();
    for line in lines {
        for (cell, width) in line.iter().zip(&widths) {
            text.push_str(&format!("{cell:>width$}  "));
        }
        text.push_str(&line[5]);
        text.push('\n');
    }
    text
}

impl fmt::Display for StudyReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (t0, t1) = self.span;
        let states = if self.starts == 1 { "1 state".to_owned() } else { format!("{} states", self.starts) };
        writeln!(f, "{}, t = {t0} .. {t1}, from {states}", self.title)?;
        writeln!(f, "error: {}", self.measure)?;
        if let Some(reference) = &self.reference {
            writeln!(f, "reference: {}", reference.method)?;
            match (reference.error, &reference.failure) {
                (Some(error), _) => {
                    writeln!(f, "           differs by {error:.1e} from {}", reference.check)?
                }
                (None, Some(failure)) => writeln!(f, "           none: {failure}")?,
                (None, None) => writeln!(f, "           not checked")?,
            }
        }
        if let Some(scan) = &self.scan {
            writeln!(f, "{scan}")?;
        }
        writeln!(f, "{} settings; those that no other one beats:\n", self.rows.len())?;
        f.write_str(&self.show(self.front().into_iter()))?;
        let limited = self.rows.iter().filter(|row| row.limited).count();
        if limited > 0 {
            writeln!(f, "~ of the size of the reference's own error, or near it: {limited} settings")?;
        }
        let failed = self.rows.iter().filter(|row| row.failure.is_some()).count();
        if failed > 0 {
            writeln!(f, "{failed} settings failed, see the table of all")?;
        }
        if self.unit == Unit::Seconds {
            let (tied, neighbours) = self.ties_on_front();
            writeln!(
                f,
                "medians are uncertain by {:.1} percent in the median over all rows",
                100.0 * self.noise
            )?;
            if tied > 0 {
                writeln!(
                    f,
                    "too noisy to rank {tied} of {neighbours} pairs of neighbours: their intervals overlap"
                )?;
            }
        }
        match self.ending {
            Ending::Complete => {}
            Ending::OutOfTime => {
                writeln!(f, "the time for the study was over before everything was measured")?
            }
            Ending::Cancelled => writeln!(f, "cancelled before everything was measured")?,
        }
        write!(f, "{}", self.conditions)
    }
}
