//! How accurate right-hand sides are, beside what they cost.
//!
//! ```text
//! cargo run --release -p guen-measure --bin accuracy
//! ```
//!
//! For every benchmark system: the largest error of the rates, relative to the largest rate and in units of `2^-53`, over
//! random states and over states near a singularity. The reference has 71 digits, the raw program is (2.7) before any
//! simplification: see `measure`.

use guen_benchmarks::{Subject, Visitor, visit_all};

mod measure;
#[cfg(test)]
mod tests;

/// States of either kind for each system.
const STATES: usize = 400;
/// Larger systems get fewer: the reference evaluates (2.7) without sharing the work of a program.
const STATES_OF_LARGE: usize = 20;
const LARGE: u32 = 500;

struct Table;

impl Visitor for Table {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        let operations = S::COST.total();
        let states = if operations > LARGE { STATES_OF_LARGE } else { STATES };
        let cells = measure::errors::<S, N>(states).map(|errors| {
            let units =
                [errors.declared, errors.by_hand, errors.raw].map(|error| error / (0.5 * f64::EPSILON));
            units.map(|units| format!("{units:11.3e}")).concat()
        });
        println!("{:11} {operations:5} {states:5}  {}  {}", S::NAME, cells[0], cells[1]);
    }
}

fn main() {
    let columns = format!("{:>11}{:>11}{:>11}", "declared", "by hand", "raw");
    println!("{:24} {:^33}  {:^33}", "", "random states", "near a singularity");
    println!("{:11} {:>5} {:>5}  {columns}  {columns}", "system", "ops", "states");
    visit_all(&mut Table);
}
