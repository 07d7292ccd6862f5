//! Holonomic equations that follow from others wherever all hold: which they are, and what is said where the count is wrong.

use guen_language::derive::function;
use guen_language::diagnostics::collect;
use guen_language::{model, parse};

use crate::common::derived;

/// A coupler on three parallel cranks of one length: two loops of which one would do, for the coupler cannot turn.
fn cranks(lengths: [&str; 3], parameters: &str) -> String {
    let [a, b, c] = lengths;
    let further = if lengths.contains(&"k") { "k > 0, " } else { "" };
    format!(
        "pub system Cranks {{
            constants {{ m > 0, l > 0, {further}d > 0, g = 9.81 }}
            coordinates {{ q1, q2, q3, turn }}
            let start = {a}*rot_z(q1).x;
            let way = rot_z(turn).x;
            bodies {{ coupler {{ mass: m, inertia: diag(0, 0, m*d^2/3), center: start + d*way, orientation: rot_z(turn) }} }}
            particles {{ m at {b}*rot_z(q2).x; m at {c}*rot_z(q3).x; }}
            gravity = vec(0, -g);
            parameters {{ {parameters} }}
            holonomic {{
                middle: start + d*way = vec(d, 0) + {b}*rot_z(q2).x;
                end: start + 2*d*way = vec(2*d, 0) + {c}*rot_z(q3).x;
            }}
        }}"
    )
}

/// The message of the one fault of a declaration.
fn fault(text: &str) -> String {
    let (declaration, report) = parse::parse(text.parse().unwrap());
    assert!(report.is_empty(), "{}", report.to_compile_errors());
    let declaration = declaration.unwrap();
    let (model, report) = collect(|faults| model::resolve(&declaration, faults));
    assert!(model.is_none());
    report.to_compile_errors().to_string()
}

#[test]
fn three_parallel_cranks_of_one_length_move() {
    derived(&cranks(["l", "l", "l"], "v = dot(q1);"), |derived| {
        let names: Vec<&str> = derived.model.redundant.iter().map(|one| one.entry.name.as_str()).collect();
        assert_eq!(names.len(), 1, "{names:?}");
        assert!(derived.system.program(function::RHS).is_some());
        assert_eq!(derived.model.mechanics.holonomic.len(), 3);
    });
}

#[test]
fn cranks_of_different_lengths_have_one_equation_too_many() {
    let text = fault(&cranks(["l", "l", "k"], "v = dot(q1);"));
    assert!(text.contains("4 coordinates need 4 forms, and 5 are declared"), "{text}");
    assert!(text.contains("as one constant where they are equal"), "{text}");
}

#[test]
fn without_a_parameter_the_mechanism_is_no_system_without_motion() {
    let text = fault(&cranks(["l", "l", "l"], ""));
    assert!(text.contains("4 coordinates need 4 forms, and 3 are declared"), "{text}");
    assert!(
        text.contains(
            "follows from the other holonomic constraints wherever all of them hold, and does not count"
        ),
        "{text}"
    );
}
