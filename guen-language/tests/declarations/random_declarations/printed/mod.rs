//! What reports print, read again: every line in text, LaTeX and MathML against what was derived.
//!
//! The readers know the grammar of the language and of the two markups, and nothing of the printer; what they read
//! becomes an expression, and the zero test compares.

mod expressions;
mod latex;
mod lines;
mod math;
mod mathml;
mod names;
mod pages;
mod report;
pub mod systems;
mod term;
mod text;

use guen_symbolic::{Notation, Rational, Workbench};

use crate::common::by_two_threads;
use crate::random_declarations::draw::Draw;
use crate::random_declarations::{grammar, scenes};
use lines::Format;
use names::Name;
use report::Checked;

/// Systems drawn.
fn rounds() -> u64 {
    crate::common::rounds(6)
}

/// A drawn declaration: every fourth one of bodies, which take longer, the others of forms; every second one with scenes, every
/// third one with names that look like each other.
fn declaration(seed: u64) -> String {
    let mut text = if seed.is_multiple_of(4) {
        grammar::with_functions(seed)
    } else {
        let sparse = crate::scenes::declaration(&mut crate::scenes::Sequence(seed));
        let (text, _) = sparse.split_once(" scene ").expect("scenes");
        format!("{text} }}")
    };
    if seed.is_multiple_of(3) {
        text = names::exchanged(&text, &mut Draw::new(seed));
    }
    if seed.is_multiple_of(2) {
        text = scenes::drawn(&text, seed, 2).0;
    }
    text
}

/// Numbers of declarations beyond the first ones whose reports were wrong once: in a scene, what must not vanish was too long
/// and told by the formula of the whole system, with a coordinate that the scene had eliminated.
const WRONG_ONCE: [u64; 1] = [488];

/// That of one number with `GUEN_ONLY`.
#[test]
fn reports_of_drawn_declarations_say_what_was_derived() {
    let only: Option<u64> = std::env::var("GUEN_ONLY").ok().and_then(|seed| seed.parse().ok());
    let seeds: Vec<u64> = match only {
        Some(seed) => vec![seed],
        None => (0..rounds()).chain(WRONG_ONCE.into_iter().filter(|seed| *seed >= rounds())).collect(),
    };
    let mut all = Checked::default();
    let found = by_two_threads(&seeds, |seed| {
        let text = declaration(*seed);
        report::checked(&text, false).unwrap_or_else(|| panic!("faults in\n{text}"))
    });
    found.into_iter().for_each(|found| all.add(found));
    println!("{all}");
    all.assert();
}

/// All that stand in tests, examples, benchmarks and pages; those with more coordinates with `GUEN_ROUNDS=200` and `500`.
#[test]
fn reports_of_the_systems_of_the_repository_say_what_was_derived() {
    let systems = systems::all();
    let most = match rounds() {
        0..200 => 3,
        200..500 => 5,
        _ => usize::MAX,
    };
    let mut all = Checked::default();
    let mut sound = 0;
    let looked_at: Vec<_> = systems.iter().filter(|(text, _)| systems::coordinates(text) <= most).collect();
    // Of large systems the derivation alone knows what is code and what dual numbers do, and which equations of a loop say nothing.
    let outlined = |text: &str| systems::coordinates(text) <= 9;
    let found = by_two_threads(&looked_at, |(text, _)| report::checked(text, outlined(text)));
    for ((text, file), found) in looked_at.iter().zip(found) {
        match found {
            Some(found) => {
                sound += 1;
                all.add(found);
            }
            // Tests of messages have declarations with faults in them.
            None => assert!(systems::may_be_wrong(file), "{}: {text}", file.display()),
        }
    }
    println!("{} declarations, {sound} of them looked at: {all}", systems.len());
    assert!(sound > 100, "{sound}");
    all.assert();
}

/// Expressions by themselves, and as coefficients of names, in both ways of writing.
#[test]
fn drawn_expressions_are_read_as_they_were() {
    let mut draw = Draw::new(3);
    let mut seen = 0;
    for round in 0..10 * rounds() {
        // Graphs grow; a new one is as quick as a small one.
        let (mut graph, symbols, scope) = expressions::world();
        let mut wanted = || expressions::expression(&mut draw, &mut graph, &symbols, 1 + round as usize % 4);
        let [e, c, rest] = [0; 3].map(|_| wanted());
        let mut bench = Workbench::new(graph);
        let sum = bench.graph.linear(&[(e, Rational::ONE), (rest, Rational::ONE)]);
        let x = symbols[round as usize % symbols.len()];
        let named = names::ALIKE[round as usize % names::ALIKE.len()];
        let by_name = scope.symbol(&Name::Text(named.to_owned())).expect("a name");
        let (first, second) = (bench.graph.mul(e, by_name), bench.graph.mul(c, x));
        let both = bench.graph.sum([first, second, rest]);
        let second_name = bench.graph.text(x);
        let terms = [(e, named), (c, &second_name[..])];
        for format in [Format::Text, Format::Latex, Format::MathMl] {
            let mut notation = match format {
                Format::Text => Notation::text(&bench.graph, 20_000),
                _ => Notation::latex(&bench.graph, 20_000),
            };
            let written = [
                (notation.expression(e), e),
                (notation.expression(sum), sum),
                (notation.affine(&terms, rest), both),
            ];
            for (line, value) in written {
                let Some(line) = line else { continue };
                let found =
                    lines::read(&line, format).and_then(|term| lines::same(&term, value, &mut bench, &scope));
                assert_eq!(found, Ok(()), "round {round}, {format:?}: {line}");
                seen += 1;
            }
        }
    }
    println!("{seen} formulas");
    assert!(seen as u64 > 50 * rounds());
}
