//! Comma-separated values: a spreadsheet runs nothing, and numbers stay numbers.

use guen_study::Recording;

/// The cells of a line, as RFC 4180 has them.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut cell, mut quoted) = (Vec::new(), String::new(), false);
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        match (c, quoted) {
            ('"', true) if chars.peek() == Some(&'"') => {
                cell.push('"');
                chars.next();
            }
            ('"', _) => quoted = !quoted,
            (',', false) => cells.push(std::mem::take(&mut cell)),
            _ => cell.push(c),
        }
    }
    cells.push(cell);
    cells
}

/// Whether a spreadsheet would run the cell.
fn runs(cell: &str) -> bool {
    cell.parse::<f64>().is_err()
        && cell.trim_start().starts_with(['=', '+', '-', '@', '＝', '＋', '－', '＠'])
}

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

#[cfg(feature = "study")]
#[test]
fn names_and_failures_in_a_report_are_no_formulas() {
    use guen_runtime::steppers::Rk4;
    use guen_runtime::{Equations, Real, from_fn, generic};
    use guen_study::{Knob, Settings, Study};

    #[derive(Clone)]
    struct Decay;
    impl Equations<1> for Decay {
        fn rates<R: Real>(&self, _t: R, &[x]: &[R; 1]) -> [R; 1] {
            [-x]
        }
    }
    let study = Study::new(generic(Decay), [1.0], 0.0..1.0).unwrap().keep(|_, _| false).count_evaluations();
    let study = study.with_method_on(
        from_fn(|_t: f64, &[x]: &[f64; 1]| [-x]),
        ["=HYPERLINK(\"http://x\")", "@real", "-form"],
        Settings::List(Knob::Step, vec![0.1, -0.1]),
        |step| Rk4 { step },
        |_| "=code".to_owned(),
    );
    let csv = study.run().report.to_csv();
    assert!(csv.lines().count() > 1);
    for line in csv.lines().skip(1) {
        let cells = cells(line);
        assert!(cells.iter().all(|cell| !runs(cell)), "{line}");
        assert_eq!(&cells[..3], ["'=HYPERLINK(\"http://x\")", "'@real", "'-form"]);
    }
}
