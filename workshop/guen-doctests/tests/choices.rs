//! The code that a study writes for its settings, compiled and run.
//!
//! ```text
//! GUEN_BLESS=1 cargo test -p guen-doctests --test choices      # writes the file anew
//! ```
//!
//! `choices/written.rs` has the code of one setting of every variant, each in a function, to the letter. A report that writes
//! anything else fails here, code that is no longer right does not compile, and every function has to end where the
//! report says that its setting does.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::{env, fs};

use guen::prelude::*;
use guen::study::{Digits71, Row, Study, StudyReport};

mod choices {
    pub mod written;
}

use choices::written;

guen::mechanical_system! {
    /// A pendulum with the bob on a rod.
    pub system Pendulum {
        constants   { l > 0, g = 9.81 }
        coordinates { q }
        parameters  { w = dot(q); }
        kinetic_energy   = l^2*w^2/2;
        potential_energy = -g*l*cos(q);
        provide taylor, carried;
    }
}

const PENDULUM: Pendulum = Pendulum { l: 1.0, g: 9.81 };
const SPAN: std::ops::Range<f64> = 0.0..1.0;
const STARTS: [[f64; 2]; 2] = [[0.5, 0.25], [-1.0, 0.5]];

/// A study of the pendulum with every variant that there is, and one of closures that are the same.
fn reports() -> [StudyReport; 2] {
    let prepared = PENDULUM.prepare().unwrap();
    let form = prepared.carried().unwrap();
    // The error is that of the energy, which needs no reference.
    let study = Study::new(PENDULUM, STARTS[0], SPAN).unwrap().starts([STARTS[1]]).energy(1);
    let study = study.with_taylor().unwrap().with_lanes().unwrap().with_form(
        "carried",
        form,
        move |x| pendulum::State::from(*x).carried(&form, 0.0).into(),
        |y| pendulum::State::from(pendulum::carried::State::from(*y)).into(),
    );
    let study = study.count_evaluations().probes(0, 0.4).run().report;
    let closures = Study::of_closures(
        move |t, x| guen::System::rhs(&prepared, t, x),
        |_t, &[q, w]: &[Digits71; 2]| [w, -Digits71::from_ratio(981, 100) * q.sin()],
        STARTS[0],
        0.0..0.25,
    );
    let closures = closures.keep(|method, _| ["Euler", "DOP853", "Bounded Tsit5"].contains(&method));
    [study, closures.count_evaluations().scan(1 << 12).probes(0, 0.4).run().report]
}

/// The coarsest setting of each variant that errs by at most a hundredth, or its most accurate one.
fn chosen(report: &StudyReport) -> Vec<&Row> {
    let errors = |row: &Row| row.error.filter(|_| row.failure.is_none()).unwrap_or(f64::INFINITY);
    let mut rows: Vec<&Row> = Vec::new();
    for row in report.rows.iter().filter(|row| errors(row).is_finite()) {
        match rows.iter_mut().find(|other| other.variant() == row.variant()) {
            Some(other) if errors(other) > 1e-2 && errors(row) < errors(other) => *other = row,
            Some(_) => {}
            None => rows.push(row),
        }
    }
    rows
}

/// A function with the code of a setting, and its name.
fn function(prefix: &str, row: &Row) -> (String, String) {
    let name: String = format!("{prefix}{}", row.variant())
        .chars()
        .map(|c| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { '_' })
        .collect();
    let name = name.replace("__", "_");
    let many = row.real.ends_with("lanes");
    let head = if many {
        format!("pub fn {name}(system: &Pendulum, starts: Vec<[f64; 2]>) -> Ends {{\n")
    } else if prefix.is_empty() && row.form == "declared" {
        format!("pub fn {name}(system: &Pendulum, start: [f64; 2]) -> End<2> {{\n")
    } else {
        format!(
            "pub fn {name}<S: System<f64, N>, const N: usize>(system: &S, start: [f64; N]) -> End<N> {{\n"
        )
    };
    let mut text = head;
    for line in row.code.lines() {
        let _ = writeln!(text, "    {line}");
    }
    text.push_str(if many {
        "    ends.into_iter().map(|end| Ok(end?.state)).collect()\n"
    } else {
        "    Ok(end)\n"
    });
    text.push_str("}\n");
    (name, text)
}

/// The whole file.
fn file(study: &[&Row], closures: &[&Row]) -> String {
    let mut text = String::from(HEAD);
    let mut lists: [Vec<String>; 3] = Default::default();
    let rows = study.iter().map(|row| ("", row)).chain(closures.iter().map(|row| ("closures ", row)));
    for (prefix, row) in rows {
        let (name, function) = function(prefix, row);
        let list = match (row.real.ends_with("lanes"), prefix.is_empty() && row.form == "declared") {
            (true, _) => 2,
            (false, true) => 0,
            (false, false) => 1,
        };
        lists[list].push(name);
        let _ = write!(text, "\n{function}");
    }
    for (list, (name, kind)) in lists.iter().zip([
        ("DECLARED", "fn(&Pendulum, [f64; 2]) -> End<2>"),
        ("GIVEN", "fn(&pendulum::Carried<f64>, [f64; 4]) -> End<4>"),
        ("LANES", "fn(&Pendulum, Vec<[f64; 2]>) -> Ends"),
    ]) {
        let _ = writeln!(text, "\npub const {name}: &[(&str, {kind})] = &[");
        for name in list {
            let _ = writeln!(text, "    (\"{name}\", {name}),");
        }
        text.push_str("];\n");
    }
    text
}

const HEAD: &str = "\
//! The code of a study's settings, written by `GUEN_BLESS=1 cargo test -p guen-doctests --test choices`.

#![allow(clippy::all, reason = \"the settings are written as the report writes them\")]
#![cfg_attr(rustfmt, rustfmt_skip)]

use std::error::Error;

use guen::System;

use crate::{Pendulum, pendulum};

type End<const N: usize> = Result<[f64; N], Box<dyn Error>>;
type Ends = Result<Vec<[f64; 2]>, Box<dyn Error>>;
";

const WRITTEN: &str = include_str!("choices/written.rs");

#[test]
fn the_code_of_every_variant_is_what_was_compiled() {
    let [study, closures] = reports();
    let text = file(&chosen(&study), &chosen(&closures));
    if env::var_os("GUEN_BLESS").is_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/choices/written.rs");
        fs::write(path, text).unwrap();
        return;
    }
    // Every variant of the study is in it: one that always failed has no code that could be compiled.
    let variants: BTreeSet<String> = study.rows.iter().map(|row| row.variant()).collect();
    assert_eq!(variants.len(), chosen(&study).len(), "{variants:?}");
    assert!(
        text == WRITTEN,
        "reports write other code than `tests/choices/written.rs` has; if this is meant, write it anew with \
         `GUEN_BLESS=1 cargo test -p guen-doctests --test choices`:\n{text}"
    );
}

#[test]
fn the_code_ends_where_the_motion_does() {
    let prepared = PENDULUM.prepare().unwrap();
    let end = |start: &[f64; 2], t1: f64| {
        let method = Dop853::new(1e-13, 1e-13);
        Integration::new(&prepared, 0.0, start).run(&method, t1).unwrap().state
    };
    let near = |name: &str, found: &[f64], expected: &[f64; 2]| {
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 0.1, "{name}: {found} instead of {expected}");
        }
    };
    let expected = STARTS.map(|start| end(&start, SPAN.end));
    assert!(written::DECLARED.len() > 30 && written::GIVEN.len() > 6 && written::LANES.len() == 4);
    for (name, run) in written::DECLARED {
        near(name, &run(&PENDULUM, STARTS[0]).unwrap(), &expected[0]);
    }
    let form = prepared.carried().unwrap();
    let start: [f64; 4] = pendulum::State::from(STARTS[0]).carried(&form, 0.0).into();
    for (name, run) in written::GIVEN {
        let t1 = if name.starts_with("closures") { 0.25 } else { SPAN.end };
        near(name, &run(&form, start).unwrap(), &end(&STARTS[0], t1));
    }
    for (name, run) in written::LANES {
        for (found, expected) in run(&PENDULUM, STARTS.to_vec()).unwrap().iter().zip(&expected) {
            near(name, found, expected);
        }
    }
}

#[test]
fn lanes_err_as_the_same_method_does_apart_and_cost_as_much_to_count() {
    let away = (0..6).map(|k| [0.2 * f64::from(k), -0.3]);
    let study = Study::new(PENDULUM, STARTS[0], SPAN).unwrap().starts(away).with_lanes().unwrap();
    let study = study.keep(|method, real| method == "RK4" && real != "Fused" && real != "Std");
    let report = study.energy(1).count_evaluations().probes(0, 0.4).run().report;
    let rows = |real: &str| -> Vec<&Row> { report.rows.iter().filter(|row| row.real == real).collect() };
    for (lanes, apart) in [("f64 lanes", "f64"), ("Approx7 lanes", "Approx7")] {
        let (lanes, apart) = (rows(lanes), rows(apart));
        assert!(lanes.len() > 8 && apart.len() > 8);
        for (lanes, apart) in lanes.iter().zip(&apart) {
            assert_eq!((lanes.setting, lanes.evaluations), (apart.setting, apart.evaluations));
            assert_eq!((lanes.error, &lanes.failure), (apart.error, &apart.failure), "{}", lanes.name());
        }
    }
}
