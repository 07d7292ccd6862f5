//! Comma-separated values: a spreadsheet runs nothing, and numbers stay numbers.

use guen_study::Recording;

use crate::cells::{cells, runs};

#[test]
fn names_of_a_recording_are_no_formulas() {
    let names = &["=1+1", "+x", "-x", "@SUM(A1:A9)", "\t=2", "plain", "＝3"];
    let mut recording = Recording::new(names);
    recording.record(0.0, &[-1.5, 1e-300, f64::NEG_INFINITY, f64::NAN, -0.0, 2.0, 3.0]);
    let mut text = Vec::new();
    recording.write_csv(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let (head, samples) = text.split_once('\n').unwrap();
    let head = cells(head);
    assert_eq!(head.len(), 8);
    for (cell, name) in head[1..].iter().zip(names) {
        assert!(!runs(cell) && cell.ends_with(name), "{cell:?}");
    }
    assert_eq!(samples, "0.0,-1.5,1e-300,-inf,NaN,-0.0,2.0,3.0\n");
}
