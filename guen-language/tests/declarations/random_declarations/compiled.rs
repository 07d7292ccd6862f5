//! Some drawn declarations with their scenes as a file of `tests/scenes`, where the compiler sees what is emitted for them.

use guen_language::derive::DerivedSystem;
use guen_symbolic::evaluate_f64;

use super::draw::Draw;
use super::{Numbers, levels, numbers};
use crate::common::derived;

/// Numbers of declarations: three of bodies, the others of sparse forms.
const NUMBERS: [u64; 8] = [1, 2, 3, 5, 6, 104, 116, 168];
/// States of each scene.
const STATES: usize = 3;

const HEAD: &str = "//! Written by `GUEN_BLESS=1 cargo test -p guen-language --test declarations random_declarations::compiled`.\n";

/// The scenes of a declaration, each with its constants and some states of the whole system.
fn compared(derived: &DerivedSystem<'_>, seed: u64) -> String {
    let model = &derived.model;
    let Numbers { declared, held, .. } = numbers(derived);
    let mut draw = Draw::new(seed.rotate_left(5));
    let mut text = String::new();
    for level in &derived.scenes {
        let facts = level.scene.as_ref().expect("a scene");
        let mut given: Vec<f64> = held.iter().map(|_| draw.real(0.5, 1.5)).collect();
        for (constant, value) in &facts.fixes {
            let others =
                |other| given[held.iter().position(|(_, known)| *known == other).expect("a constant")];
            given[*constant] = evaluate_f64(&model.bench.graph, &[*value], &others)[0];
        }
        let mut fields: Vec<String> = (level.selection.constants.iter())
            .map(|c| format!("{}: {:?}", model.constants[*c].name.text, given[*c]))
            .collect();
        for held in &level.selection.held {
            fields.push(format!("{}: {:?}", model.variable_name(held.place), draw.real(-1.0, 1.0)));
        }
        let states: Vec<String> = (0..STATES)
            .filter_map(|_| declared.state_of(&mut draw, given.clone()))
            .map(|(point, etas)| {
                // The states beside the motion are the last of what is held.
                let states = &point[point.len() - model.states.len()..];
                format!("{:?}", [&point[1..=declared.n], &etas[..declared.degrees], states].concat())
            })
            .collect();
        let module = model.declaration.name.text.to_lowercase();
        let scene = &model.scenes[facts.index].scene.name;
        let value = match &fields[..] {
            [] => format!("{module}::{scene}::<f64>::default()"),
            _ => format!("{module}::{scene} {{ {} }}", fields.join(", ")),
        };
        text += &format!("{value},\n    [{}];\n", states.join(",\n    "));
    }
    text
}

#[test]
fn the_file_of_scenes_is_what_is_drawn() {
    let mut text = HEAD.to_owned();
    for seed in NUMBERS {
        let declaration = levels::declaration(seed);
        let compared = derived(&declaration, |derived| {
            let model = &derived.model;
            assert!(model.inputs.is_empty() && model.mechanics.holonomic.is_empty(), "number {seed}");
            compared(derived, seed)
        });
        text += &format!(
            "\nmod number_{seed} {{\n    guen::mechanical_system! {{ {} }}\n\n    same! {{\n{compared}}}\n}}\n",
            declaration.trim()
        );
    }
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/scenes/random_scenes/systems.rs");
    if std::env::var_os("GUEN_BLESS").is_some() {
        std::fs::write(file, &text).expect("a folder");
    }
    let found = std::fs::read_to_string(file).unwrap_or_default();
    assert!(found == text, "write `{file}` anew with `GUEN_BLESS=1`");
}
