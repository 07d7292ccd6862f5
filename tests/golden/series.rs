//! What the Taylor series of the benchmark systems consist of are golden values, as their operations are: `tests/series.txt`.
//! A recurrence that is lost or split, and a product that is no longer shared, changes that file.
//!
//! ```text
//! GUEN_BLESS=1 cargo test -p guen-tests --test golden      # writes the file anew
//! ```

use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

use guen_benchmarks::{Subject, Visitor, visit_all};
use guen_language::diagnostics::collect;
use guen_language::{derive, model, parse};
use guen_symbolic::{SeriesProgram, SeriesStep};

const HEADER: &str = "\
# Taylor series of the benchmark systems, written by `GUEN_BLESS=1 cargo test -p guen-tests --test golden`.
# Sums of products and how many of them are squares, series that are factors, functions carried along; linear operations
# and others for each order.
";

/// The recurrences of a declaration.
fn series(declaration: &str) -> SeriesProgram {
    let end = declaration.rfind('}').unwrap();
    let text = format!("{} provide taylor; }}", &declaration[..end]);
    let (declaration, report) = parse::parse(text.parse().unwrap());
    assert!(report.is_empty(), "{report}");
    let declaration = declaration.unwrap();
    let (model, report) = collect(|faults| model::resolve(&declaration, faults));
    assert!(report.is_empty(), "{report}");
    let (derived, report) = collect(|faults| derive::derive(model.unwrap(), faults));
    assert!(report.is_empty(), "{report}");
    derived.unwrap().system.series.unwrap().held
}

fn counts(series: &SeriesProgram) -> String {
    let squares = series.sums.iter().filter(|[a, b]| a == b).count();
    let count = |what: fn(&SeriesStep) -> bool| series.steps.iter().filter(|step| what(step)).count();
    let linear = count(|step| {
        matches!(step, SeriesStep::Add(..) | SeriesStep::Sub(..) | SeriesStep::Neg(_) | SeriesStep::Scale(..))
    });
    let others = count(|step| {
        matches!(
            step,
            SeriesStep::Product(..)
                | SeriesStep::Along(..)
                | SeriesStep::Quotient(..)
                | SeriesStep::SquareRoot(..)
                | SeriesStep::Derivative(_)
                | SeriesStep::Integral(..)
        )
    });
    [series.sums.len(), squares, series.factors().len(), series.carried.len(), linear, others]
        .map(|count| format!("{count:5}"))
        .concat()
}

struct Lines(String);

impl Visitor for Lines {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        let _ = writeln!(self.0, "{:11} {}", S::NAME, counts(&series(S::DECLARATION)));
    }
}

#[test]
fn series_are_those_of_the_file() {
    let mut lines = Lines(HEADER.to_owned());
    visit_all(&mut lines);
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("series.txt");
    if env::var_os("GUEN_BLESS").is_some() {
        guen_study::replace_file(&file, |out| out.write_all(lines.0.as_bytes())).unwrap();
        return;
    }
    let golden = fs::read_to_string(&file).unwrap();
    assert!(
        golden == lines.0,
        "found\n{}\nif this is meant, write tests/series.txt anew with `GUEN_BLESS=1 cargo test -p guen-tests --test golden`",
        lines.0
    );
}

/// A declaration of a point with a force, and its series.
fn of_force(force: &str) -> SeriesProgram {
    series(&format!(
        "system S {{ constants {{ k }} coordinates {{ x, y }} parameters {{ p = dot(x); q = dot(y); }}
         kinetic_energy = (p^2 + q^2)/2; forces {{ {force} along p; }} }}"
    ))
}

#[test]
fn what_is_linear_costs_no_sum_and_what_is_equal_is_one() {
    let sums = |force: &str| of_force(force).sums.len();
    assert_eq!(sums("k*x - 3*y + k^2*p"), 0);
    // A factor and a sign do not make another product.
    assert_eq!(sums("x*y"), 1);
    assert_eq!(sums("(k*x)*y - x*(-y)*p + x*y"), 2);
    // Sine and cosine of what is linear: one product each, whatever asks for them.
    assert_eq!(sums("sin(x)"), 2);
    assert_eq!(sums("sin(x) + p*cos(x)"), 2);
    assert_eq!(of_force("sin(x)").carried.len(), 2);
    // Of what is not: the product, and one for each.
    assert_eq!((sums("sin(x*y)"), of_force("sin(x*y)").carried.len()), (3, 0));
    assert_eq!(sums("exp(x)"), 1);
    assert_eq!(sums("x/y"), 1);
    assert_eq!(sums("sqrt(x)"), 1);
    assert_eq!(of_force("x^2").sums, [[of_force("x^2").sums[0][0]; 2]]);
}
