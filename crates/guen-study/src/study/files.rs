//! A report as CSV, in a file, and as a picture.

use std::fs;
use std::path::Path;

use super::report::Report;
use super::row::Nearby;
use crate::error::{StudyError, at_path, create_parents};

impl Report {
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
                quoted(&row.method),
                quoted(&row.real),
                quoted(&row.form),
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
                quoted(failure),
            ];
            text.push_str(&cells.join(","));
            text.push('\n');
        }
        text
    }

    /// Writes the rows as CSV to a file whose parent folders are created.
    ///
    /// # Errors
    ///
    /// The file or a folder cannot be written.
    pub fn save_csv(&self, path: impl AsRef<Path>) -> Result<(), StudyError> {
        let path = path.as_ref();
        create_parents(path)?;
        fs::write(path, self.to_csv()).map_err(at_path(path))
    }
}

/// A cell, in quotation marks if it has to be.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
