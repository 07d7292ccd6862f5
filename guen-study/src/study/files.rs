//! A report as CSV, in a file, and as a picture.

use std::path::Path;

use super::report::StudyReport;
use super::row::Nearby;
use crate::cell;
use crate::error::StudyError;
use crate::file::replace_file;

impl StudyReport {
    /// The rows as CSV (RFC 4180, lines end with a line feed): a head, then a line for each row. Numbers have as many
    /// digits as identify the double; what was not measured is empty.
    ///
    /// The columns are `method, real, form, knob, setting, error, limited, nearby, cost, low, high, repetitions,
    /// evaluations, jacobians, front, failure`; `nearby` is `failed` where a run from a state nearby failed.
    pub fn to_csv(&self) -> String {
        let mut text = "method,real,form,knob,setting,error,limited,nearby,cost,low,high,repetitions,\
                        evaluations,jacobians,front,failure\n"
            .to_owned();
        let front = self.front_indices();
        for (index, row) in self.rows.iter().enumerate() {
            let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:?}"));
            let nearby = match row.nearby {
                Some(Nearby::Failed) => "failed".to_owned(),
                Some(Nearby::Error(error)) => number(Some(error)),
                None => String::new(),
            };
            let cost = row.cost;
            let failure = row.failure.as_ref().map_or("", |failure| &failure.message);
            let cells = [
                cell::text(&row.method),
                cell::text(&row.real),
                cell::text(&row.form),
                row.knob.symbol().to_owned(),
                number(Some(row.setting)),
                number(row.error),
                row.limited.to_string(),
                nearby,
                number(cost.map(|cost| cost.median)),
                number(cost.map(|cost| cost.low)),
                number(cost.map(|cost| cost.high)),
                cost.map_or_else(String::new, |cost| cost.repetitions.to_string()),
                number(Some(row.evaluations)),
                number(Some(row.jacobians)),
                front.contains(&index).to_string(),
                cell::text(failure),
            ];
            text.push_str(&cells.join(","));
            text.push('\n');
        }
        text
    }

    /// Writes the rows as CSV to a file, whole or not at all: see [`replace_file`].
    ///
    /// # Errors
    ///
    /// The file or a folder cannot be written.
    pub fn save_csv(&self, path: impl AsRef<Path>) -> Result<(), StudyError> {
        replace_file(path, |out| out.write_all(self.to_csv().as_bytes()))
    }
}

#[cfg(feature = "serde")]
impl StudyReport {
    /// Writes the report as JSON to a file, whole or not at all: see [`replace_file`].
    ///
    /// # Errors
    ///
    /// The file or a folder cannot be written.
    pub fn save_json(&self, path: impl AsRef<Path>) -> Result<(), StudyError> {
        replace_file(path, |out| Ok(serde_json::to_writer_pretty(out, self)?))
    }

    /// Reads a report that [`save_json`](StudyReport::save_json) wrote, every number to the bit.
    ///
    /// # Errors
    ///
    /// [`StudyError::Read`] with the path: there is no such file, or it is no report.
    pub fn load_json(path: impl AsRef<Path>) -> Result<Self, StudyError> {
        use crate::error::from_path;
        let path = path.as_ref();
        let text = std::fs::read(path).map_err(from_path(path))?;
        serde_json::from_slice(&text).map_err(from_path(path))
    }
}
