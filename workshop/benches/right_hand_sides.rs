//! Right-hand sides that the macro made against the same written by hand, side by side.
//!
//! ```text
//! cargo bench -p guen-benchmarks --bench right_hand_sides             # all systems
//! cargo bench -p guen-benchmarks --bench right_hand_sides -- hoop     # those with `hoop` in their name
//! RUSTFLAGS="-C target-cpu=native" cargo bench -p guen-benchmarks --bench right_hand_sides
//! ```
//!
//! Both sides are generic over the real and run in `f64`, so they call the same elementary functions. A ratio below one
//! says that the declared system is the faster one. Chains are compared twice: with elimination in the mass matrix, and
//! with the forces in the links as unknowns, a program whose work grows in proportion to the number of links.

use std::env;
use std::io::{Write, stdout};

use guen::System;
use guen_benchmarks::timing::{Latency, STATES, Throughput, compare, conditions};
use guen_benchmarks::{ByHand, Random, Subject, Visitor, visit_all};

/// Pairs of batches for each comparison.
const PAIRS: usize = 41;
/// As many where nothing is measured, as under `cargo test --benches`.
const PAIRS_OF_A_TEST: usize = 1;

struct Table {
    filters: Vec<String>,
    pairs: usize,
}

impl Table {
    fn is_wanted(&self, name: &str) -> bool {
        self.filters.is_empty() || self.filters.iter().any(|filter| name.contains(filter.as_str()))
    }
}

impl Visitor for Table {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        if !self.is_wanted(S::NAME) {
            return;
        }
        let mut random = Random::new(1);
        let states: Vec<[f64; N]> = (0..STATES).map(|_| S::state(&mut random)).collect();
        S::all_by_hand(&mut Row {
            name: S::NAME,
            operations: S::COST.total(),
            pairs: self.pairs,
            states: &states,
            declared: S::declared(),
        });
    }
}

/// A system, to be compared with programs of it.
struct Row<'a, D, const N: usize> {
    name: &'a str,
    operations: u32,
    pairs: usize,
    states: &'a [[f64; N]],
    declared: D,
}

impl<D: System<f64, N>, const N: usize> ByHand<N> for Row<'_, D, N> {
    fn program(&mut self, note: &str, program: impl System<f64, N>) {
        let name = if note.is_empty() { self.name.to_owned() } else { format!("{}, {note}", self.name) };
        print!("{name:20} {:5}  ", self.operations);
        flush();
        let throughput = compare(
            &mut Throughput { system: &self.declared, states: self.states },
            &mut Throughput { system: &program, states: self.states },
            self.pairs,
        );
        print!("{throughput}  ");
        flush();
        let start = self.states[0];
        let latency = compare(
            &mut Latency { system: &self.declared, start },
            &mut Latency { system: &program, start },
            self.pairs,
        );
        println!("{latency}");
    }
}

fn flush() {
    // A table that nobody reads is no reason to stop.
    let _ = stdout().flush();
}

fn main() {
    let mut filters: Vec<String> = env::args().skip(1).collect();
    let measured = filters.iter().any(|argument| argument == "--bench");
    filters.retain(|argument| !argument.starts_with("--"));
    let pairs = if measured { PAIRS } else { PAIRS_OF_A_TEST };
    println!("{}", conditions());
    println!(
        "{pairs} interleaved pairs each; nanoseconds are the shortest, ratios medians with their 95 percent interval"
    );
    println!("throughput over {STATES} states, latency with the state fed back\n");
    println!("{:20} {:>5}  {:^41}  {:^41}", "", "", "throughput", "latency");
    let columns = format!("{:>8} {:>8}   {:>21}", "declared", "by hand", "ratio");
    println!("{:20} {:>5}  {columns}  {columns}", "system", "ops");
    visit_all(&mut Table { filters, pairs });
}
