//! Statistics as tables for people and programs: a row for each column of the rows, for each two of them, and for each bin.

use std::fmt::Write as _;

use super::plan::Plan;
use super::statistics::Statistics;
use crate::cell;

/// The parts at which quantiles are written.
const QUANTILES: [f64; 7] = [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99];

/// The names and contents of all tables.
pub(super) fn all(plan: &Plan, statistics: &Statistics) -> Vec<(String, String)> {
    let mut all = vec![
        ("columns.csv".to_owned(), of_columns(plan)),
        ("statistics.csv".to_owned(), of_statistics(statistics)),
        ("covariance.csv".to_owned(), of_covariance(statistics)),
    ];
    if !statistics.plan.bins.is_empty() {
        all.push(("histogram.csv".to_owned(), of_bins(statistics)));
    }
    all
}

/// A number, or an empty cell.
fn number(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!("{value:?}"))
}

fn of_columns(plan: &Plan) -> String {
    let mut text = "column,unit\n".to_owned();
    for column in plan.columns() {
        let _ = writeln!(text, "{},{}", cell::text(&column.name), cell::text(&column.unit));
    }
    text
}

/// Rows at one place of their motions are told apart by that place.
fn places(statistics: &Statistics) -> std::ops::Range<usize> {
    0..statistics.groups.len()
}

fn of_statistics(statistics: &Statistics) -> String {
    let mut text = "place,column,unit,count,not_finite,mean,standard_deviation,minimum,maximum".to_owned();
    for part in QUANTILES {
        let _ = write!(text, ",quantile_{part}");
    }
    text.push('\n');
    for place in places(statistics) {
        for column in statistics.names() {
            let Some(of) = statistics.at(place, column) else { continue };
            let _ = write!(text, "{place},{},{}", cell::text(column), cell::text(of.unit()));
            let _ = write!(text, ",{},{}", of.count(), of.not_finite());
            for value in [of.mean(), of.standard_deviation(), of.minimum(), of.maximum()] {
                let _ = write!(text, ",{}", number(value));
            }
            for part in QUANTILES {
                let _ = write!(text, ",{}", number(of.quantile(part)));
            }
            text.push('\n');
        }
    }
    text
}

fn of_covariance(statistics: &Statistics) -> String {
    let names: Vec<&str> = statistics.names().collect();
    let head: Vec<String> = names.iter().map(|name| cell::text(name)).collect();
    let mut text = format!("place,column,{}\n", head.join(","));
    for place in places(statistics) {
        for (first, cell) in names.iter().zip(&head) {
            let _ = write!(text, "{place},{cell}");
            for second in &names {
                let _ = write!(text, ",{}", number(statistics.covariance_at(place, first, second)));
            }
            text.push('\n');
        }
    }
    text
}

fn of_bins(statistics: &Statistics) -> String {
    let mut text = "place,column,low,high,count\n".to_owned();
    for place in places(statistics) {
        for column in statistics.names() {
            let bins = statistics.at(place, column).map(|of| of.histogram()).unwrap_or_default();
            for (low, high, count) in bins {
                let _ = writeln!(text, "{place},{},{low:?},{high:?},{count}", cell::text(column));
            }
        }
    }
    text
}
