//! The table of linearisations in `docs/control.md`, against what is derived.

use guen_benchmarks::{Subject, Visitor, arms, visit_all};
use guen_language::derive::function::{LINEARIZATION, RHS};

use crate::costs::declared;
use crate::lines::{derived, six};

/// The text of one of the benchmark systems.
struct Text(&'static str, Option<&'static str>);

impl Visitor for Text {
    fn visit<S: Subject<N>, const N: usize>(&mut self, _: S) {
        if S::NAME == self.0 {
            self.1 = Some(S::DECLARATION);
        }
    }
}

fn text(name: &'static str) -> String {
    let mut found = Text(name, None);
    visit_all(&mut found);
    found.1.expect("a benchmark system").to_owned()
}

/// The operations of a program in duals of `n` directions, by the formulas of `Dual`.
fn by_duals([additions, negations, multiplications, divisions, roots, calls]: [u32; 6], n: u32) -> u32 {
    // A product is u v, u dv + v du; a quotient (du - r dv)/v; a root 1/(2 r), then a product; a sine with its cosine changes one sign.
    (additions + negations) * (1 + n)
        + (multiplications + divisions) * (1 + 3 * n)
        + roots * (3 + n)
        + calls * (2 + 2 * n)
}

/// The first columns of a row: operations of the rates, of `A` and `B`, and of both by duals, for the directions of the state and of the inputs.
fn row(name: &str, text: &str) -> String {
    derived(name, text, |derived| {
        let count = |function: &str| derived.system.program(function).map(|program| six(program.cost));
        let rates = count(RHS).unwrap();
        let mechanics = &derived.model.mechanics;
        let forms = &mechanics.forms;
        let directions = [forms.coordinates.len() + forms.degrees, mechanics.inputs.len()];
        let duals: u32 = directions.iter().filter(|n| **n > 0).map(|n| by_duals(rates, *n as u32)).sum();
        let own = count(LINEARIZATION).map(|six| six.iter().sum::<u32>());
        let grouped = |count: u32| match count {
            1000.. => format!("{},{:03}", count / 1000, count % 1000),
            _ => count.to_string(),
        };
        let own = own.map_or_else(|| "-".to_owned(), grouped);
        format!("| {name} | {} | {own} | {} |", grouped(rates.iter().sum()), grouped(duals))
    })
}

#[test]
fn the_page_says_what_linearisations_cost() {
    let bicycle = declared(include_str!("../spatial/bicycle.rs").parse().unwrap(), 0).to_string();
    let rows = [
        row("hoop", &text("hoop")),
        row("sled", &text("sled")),
        row("balancing robot", guen_benchmarks::robot!(stringify)),
        row("car with two trailers", guen_benchmarks::train!(stringify)),
        row("snake of six links", &crate::large_systems::snake(6)),
        row("arm of six joints", &arms::declaration("Arm", &arms::AXES[..6])),
        row("bicycle", &bicycle),
    ];
    let page = include_str!("../../docs/control.md");
    let missing: Vec<&String> =
        rows.iter().filter(|row| page.lines().all(|line| !line.starts_with(row.as_str()))).collect();
    assert!(missing.is_empty(), "not on the page: {missing:#?}");
}
