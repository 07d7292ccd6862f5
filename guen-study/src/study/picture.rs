//! Work against precision as a picture.

use std::collections::BTreeSet;
use std::path::Path;

use super::report::{StudyReport, Unit};
use super::row::Row;
use crate::error::StudyError;
use crate::plot::Plot;

/// The fewest timings of a setting that is shown in a picture.
const FEWEST_TIMINGS: u32 = 3;
/// Points whose interval is wider than they are high are left out.
const NOISY_INTERVAL: f64 = 0.5;

impl StudyReport {
    /// Work against precision: cost over error, both axes logarithmic, a curve for each method over doubles on the
    /// front of all variants, which is a grey band; the other methods are thin grey lines with their names at their ends. Rows that failed, or were timed fewer than three
    /// times, or whose interval is wider than the cost itself, are not there.
    pub fn picture(&self) -> Plot {
        let front = self.front();
        self.draw(&front, |row| row.real == "f64", Row::variant)
    }

    /// Returns the picture of one method: a curve for each real, and the front of all variants.
    pub fn picture_of_reals(&self, method: &str) -> Plot {
        let front = self.front();
        self.draw(&front, |row| row.method == method && row.form == "declared", |row| row.real.clone())
    }

    fn draw(&self, front: &[&Row], wanted: impl Fn(&Row) -> bool, label: impl Fn(&Row) -> String) -> Plot {
        let (factor, unit) = match self.unit {
            Unit::Seconds => (1e6, "microseconds for one initial state"),
            Unit::Evaluations => (1.0, "evaluations for one initial state"),
        };
        let mut curves: Vec<(String, Vec<(f64, f64)>)> = Vec::new();
        for row in self.rows.iter().filter(|row| wanted(row)) {
            let Some((error, cost)) = row.measured() else { continue };
            // A single timing is no median, and one as uncertain as it is large no point.
            if self.unit == Unit::Seconds
                && (cost.repetitions < FEWEST_TIMINGS || cost.noise() > NOISY_INTERVAL)
            {
                continue;
            }
            let label = label(row);
            let point = (error, factor * cost.median);
            match curves.iter_mut().find(|(name, _)| *name == label) {
                Some((_, points)) => points.push(point),
                None => curves.push((label, vec![point])),
            }
        }
        // The rows of the front are drawn strong, because readers choose among them; all others are drawn faint.
        let best: BTreeSet<String> = front.iter().filter(|row| wanted(row)).map(|row| label(row)).collect();
        let front = front.iter().filter_map(|row| row.measured());
        let front: Vec<(f64, f64)> = front.map(|(error, cost)| (error, factor * cost.median)).collect();
        let mut plot = Plot::new(self.title.clone())
            .size(900, 620)
            .axes(format!("error of {}", self.measure), unit)
            .logarithmic(true)
            .band("not beaten by any variant", front);
        for (label, points) in curves {
            plot = if best.contains(&label) { plot.line(label, points) } else { plot.faint(label, points) };
        }
        plot.mark_points(true)
    }

    /// Writes [`picture`](StudyReport::picture) to a file whose parent folders are created.
    ///
    /// # Errors
    ///
    /// Those of [`Plot::save`].
    pub fn save_picture(&self, path: impl AsRef<Path>) -> Result<(), StudyError> {
        self.picture().save(path)
    }
}
