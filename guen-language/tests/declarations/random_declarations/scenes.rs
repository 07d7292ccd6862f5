//! Scenes drawn at random for a declaration: what they track, fix and provide.

use guen_language::derive::derive;
use guen_language::diagnostics::collect;
use guen_language::syntax::{Declaration, Item};
use guen_language::{model, parse};

use crate::random_declarations::draw::Draw;

/// The names that a declaration declares.
pub struct Names {
    pub inputs: Vec<String>,
    pub constants: Vec<String>,
    pub coordinates: Vec<String>,
    pub parameters: Vec<String>,
    pub constraints: Vec<String>,
    pub outputs: Vec<String>,
    pub states: Vec<String>,
}

impl Names {
    pub fn of(declaration: &Declaration) -> Self {
        let mut names = Names {
            inputs: Vec::new(),
            constants: Vec::new(),
            coordinates: Vec::new(),
            parameters: Vec::new(),
            constraints: Vec::new(),
            outputs: Vec::new(),
            states: Vec::new(),
        };
        for item in &declaration.items {
            match item {
                Item::Constants(section) => {
                    names.constants.extend(section.entries.iter().map(|e| e.name.text.clone()));
                }
                Item::Inputs(section) => {
                    names.inputs.extend(section.entries.iter().map(|e| e.name.text.clone()));
                }
                Item::Coordinates(section) => {
                    names.coordinates.extend(section.entries.iter().map(|e| e.name.text.clone()));
                }
                Item::Parameters(section) => {
                    names.parameters.extend(section.entries.iter().map(|e| e.name.text.clone()));
                }
                Item::Constraints(section) => {
                    names.constraints.extend(section.entries.iter().map(|e| e.name.text.clone()));
                }
                Item::Holonomic(section) => {
                    names.constraints.extend(section.entries.iter().map(|e| e.name.text.clone()));
                }
                Item::States(section) => {
                    names.states.extend(section.entries.iter().map(|e| e.name.text.clone()));
                }
                Item::Outputs(section) => {
                    names.outputs.extend(section.entries.iter().map(|e| e.name.text.clone()));
                }
                _ => {}
            }
        }
        names
    }
}

/// Some of a list, each once.
pub fn some(draw: &mut Draw, list: &[String], most: usize) -> Vec<String> {
    let count = draw.between(1, most).min(list.len());
    draw.permutation(list.len())[..count].iter().map(|i| list[*i].clone()).collect()
}

/// A scene; whether it can be is not asked: a variable that it fixes may move, a reaction may be unknown.
pub fn scene(draw: &mut Draw, declaration: &Declaration, name: &str) -> String {
    let names = Names::of(declaration);
    let mut text = format!("scene {name} {{ ");
    let variables = [&names.coordinates[..], &names.parameters, &names.states].concat();
    let tracked = if draw.once_in(4) { Vec::new() } else { some(draw, &variables, 3) };
    if !tracked.is_empty() {
        text += &format!("track {}; ", tracked.join(", "));
    }
    if draw.once_in(2) {
        for constant in some(draw, &names.constants, 2) {
            let value = match draw.below(4) {
                0 => "0".to_owned(),
                1 => format!("{}/2", names.constants[draw.below(names.constants.len())]),
                _ => draw.pick(&["1", "2", "3/4", "0.3"]).to_owned(),
            };
            text += &format!("fix {constant} = {value}; ");
        }
    }
    if draw.once_in(8) {
        let held = &variables[draw.below(variables.len())];
        if !tracked.contains(held) {
            text += &format!("fix {held}; ");
        }
    }
    let mut provided = Vec::new();
    for quantity in ["energy", "linearization", "operators", "taylor", "carried"] {
        if draw.once_in(6) {
            provided.push(quantity.to_owned());
        }
    }
    if !names.constraints.is_empty() && draw.once_in(4) {
        provided.push(match draw.below(2) {
            0 => "reactions".to_owned(),
            _ => format!("reactions({})", some(draw, &names.constraints, 2).join(", ")),
        });
    }
    if !names.outputs.is_empty() && draw.once_in(3) {
        provided.extend(some(draw, &names.outputs, 2));
    }
    if !provided.is_empty() {
        text += &format!("provide {}; ", provided.join(", "));
    }
    text + "}"
}

/// A declaration with drawn scenes; what was said of those that cannot be.
pub fn drawn(text: &str, seed: u64, count: usize) -> (String, Vec<String>) {
    let (declaration, _) = parse::parse(text.parse().expect("tokens"));
    let declaration = declaration.expect("a declaration");
    let mut draw = Draw::new(!seed.rotate_left(17));
    let mut scenes: Vec<String> =
        (0..count).map(|k| scene(&mut draw, &declaration, &format!("Scene{k}"))).collect();
    let first = text.trim_end().lines().count();
    let mut refused = Vec::new();
    loop {
        let all = with(text, &scenes);
        let (declaration, faults) = parse::parse(all.parse().expect("tokens"));
        assert!(faults.is_empty(), "{faults}\n{all}");
        let declaration = declaration.expect("a declaration");
        let (_, faults) = collect(|faults| derive(model::resolve(&declaration, faults)?, faults).map(|_| ()));
        let Some(fault) = faults.faults().first() else { return (all, refused) };
        let line = fault.span().start().line;
        assert!((first..first + scenes.len()).contains(&line), "{faults}\n{all}");
        refused.push(format!("{}: {}", scenes.remove(line - first), fault.message()));
    }
}

/// A declaration with scenes before its last brace.
pub fn with(text: &str, scenes: &[String]) -> String {
    let body = text.trim_end().strip_suffix('}').expect("a declaration");
    format!("{body}{}\n}}\n", scenes.join("\n"))
}
