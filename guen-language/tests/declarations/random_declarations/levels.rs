//! Scenes drawn at random for drawn declarations: their rates, energies, outputs and reactions are those of the whole system,
//! they have all that their items read, and their right-hand sides never cost more.

use guen_language::derive::{DerivedLevel, DerivedSystem, function};
use guen_symbolic::{ExprId, Role, SymbolId};

use super::draw::Draw;
use super::{beside, grammar, multipliers, numbers, scenes};
use crate::common::{by_two_threads, derived, evaluated};

/// Largest difference, in units of condition times scale.
const ROUNDING: f64 = 1e-11;
/// States of each scene.
const STATES: usize = 2;

/// What was found.
#[derive(Default)]
struct Seen {
    scenes: usize,
    states: usize,
    smaller: usize,
    parts: usize,
    faults: Vec<String>,
}

impl Seen {
    fn add(&mut self, other: Seen) {
        self.scenes += other.scenes;
        self.states += other.states;
        self.smaller += other.smaller;
        self.parts += other.parts;
        self.faults.extend(other.faults);
    }
}

/// Every fourth one of bodies, the others of sparse forms.
pub fn declaration(seed: u64) -> String {
    let text = if seed.is_multiple_of(4) {
        grammar::drawn(seed)
    } else {
        let sparse = crate::scenes::declaration(&mut crate::scenes::Sequence(seed.wrapping_mul(77)));
        let (text, _) = sparse.split_once(" scene ").expect("scenes");
        format!("{text} }}")
    };
    scenes::drawn(&text, seed, 4).0
}

/// Whether a level has what its items read: a result for every name.
fn missing(level: &DerivedLevel) -> Option<String> {
    let count = |name: &str| level.program(name).map_or(0, |program| program.outputs.len());
    let selection = &level.selection;
    let wanted = [
        (function::RHS, selection.variables.len()),
        (function::PIVOTS, level.constant_pivots.len()),
        (function::DOMAIN, level.domain_names.len()),
        (function::ENERGY, usize::from(selection.energy)),
        (function::POSITIONS, selection.holonomic.len()),
        (function::REACTIONS, selection.reactions.len()),
    ];
    let mut wrong = wanted.iter().filter(|(name, wanted)| count(name) != *wanted);
    wrong.next().map(|(name, wanted)| format!("{} of {wanted} results of `{name}`", count(name)))
}

fn looked_at(text: &str, derived: &DerivedSystem<'_>, seed: u64) -> Seen {
    let model = &derived.model;
    let graph = &model.bench.graph;
    let symbol = |e: ExprId| graph.as_symbol(e).expect("a symbol");
    let numbers = numbers(derived);
    let declared = &numbers.declared;
    let cost = |level: &DerivedLevel| level.program(function::RHS).map_or(0, |rhs| rhs.cost.weighted());
    let mut draw = Draw::new(seed.rotate_left(9));
    let mut seen = Seen::default();
    let written =
        |name: &str| text.lines().find(|line| line.contains(&format!("scene {name} "))).unwrap_or("");
    for level in &derived.scenes {
        let facts = level.scene.as_ref().expect("a scene");
        let title = &model.scenes[facts.index].scene.name;
        let mut fault =
            |what: String| seen.faults.push(format!("number {seed}, {}: {what}", written(&title.text)));
        seen.scenes += 1;
        seen.smaller +=
            usize::from(level.selection.variables.len() < derived.system.selection.variables.len());
        seen.parts += usize::from(facts.is_part);
        if let Some(missing) = missing(level) {
            fault(missing);
            continue;
        }
        if cost(level) > cost(&derived.system) {
            let (own, whole) = (level.program(function::RHS), derived.system.program(function::RHS));
            fault(format!(
                "{} of {}: {:?} of {:?}",
                cost(level),
                cost(&derived.system),
                own.map(|p| &p.cost),
                whole.map(|p| &p.cost)
            ));
        }
        for _ in 0..STATES {
            let given = numbers.given(graph, level, &mut draw);
            let Some((point, etas)) = declared.state_of(&mut draw, given) else { continue };
            let Some(reference) = multipliers::solve(declared, &point) else { continue };
            let unit = reference.condition * reference.scale;
            if unit.is_nan() || unit > super::LARGEST {
                continue;
            }
            let mechanics = &model.mechanics;
            let mut values = numbers.values(model, &point, &etas);
            let accelerations = mechanics.accelerations.iter().map(|e| symbol(*e));
            values.extend(accelerations.zip(reference.accelerations.iter().copied()));
            let value_of = |symbol: SymbolId| {
                values.iter().find(|(known, _)| *known == symbol).map(|(_, value)| *value).expect("a symbol")
            };
            let selection = &level.selection;
            let kept: Vec<SymbolId> =
                (selection.variables.iter().map(|place| symbol(model.variable(*place))))
                    .chain(selection.parameters.iter().map(|s| symbol(mechanics.accelerations[*s])))
                    .chain(selection.inputs.iter().map(|i| symbol(model.inputs[*i].symbol)))
                    .chain(selection.constants.iter().map(|c| symbol(model.constants[*c].symbol)))
                    .collect();
            let mut lost = None;
            let moved = |lost: &mut Option<String>, name: &str, by: &dyn Fn(SymbolId) -> f64| {
                let lost = std::cell::RefCell::new(lost);
                evaluated(level, name, |symbol| {
                    if let Some(own) =
                        selection.held.iter().find(|held| graph.as_symbol(held.symbol) == Some(symbol))
                    {
                        return value_of(graph.as_symbol(model.variable(own.place)).expect("a symbol"));
                    }
                    let info = graph.symbol_info(symbol);
                    if info.role != Role::Time && !kept.contains(&symbol) {
                        **lost.borrow_mut() = Some(format!("`{name}` reads `{}`, which left", info.name));
                        return f64::NAN;
                    }
                    value_of(symbol) + by(symbol)
                })
                .unwrap_or_default()
            };
            let run = |lost: &mut Option<String>, name: &str| moved(lost, name, &|_| 0.0);
            let meaning = declared.meaning(&point);
            let outputs = declared.outputs(&point, &reference);
            let all: Vec<f64> = (declared.velocities.iter().map(|v| point[*v]))
                .chain(reference.accelerations.iter().copied())
                .chain(meaning.state_rates.iter().copied())
                .collect();
            let mut compare = |name: &str, found: Vec<f64>, expected: Vec<f64>, unit: f64| {
                let close = |(a, b): (&f64, &f64)| (a - b).abs() <= ROUNDING * unit;
                let wrong = found.len() != expected.len() || !found.iter().zip(&expected).all(close);
                if wrong {
                    fault(format!("`{name}` {found:?}, and not {expected:?}"));
                }
            };
            let expected = selection.variables.iter().map(|place| all[*place]).collect();
            compare(function::RHS, run(&mut lost, function::RHS), expected, unit);
            if !selection.outputs.is_empty() {
                let wanted = selection.outputs.iter().flat_map(|o| &model.outputs[*o].components);
                let wanted: Vec<f64> = wanted.map(|c| outputs[*c]).collect();
                let size = wanted.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
                let size = if meaning.asked.is_empty() { size } else { size.max(unit * reference.condition) };
                compare(function::OUTPUTS, run(&mut lost, function::OUTPUTS), wanted, size);
            }
            if selection.energy {
                let whole = evaluated(&derived.system, function::ENERGY, value_of).expect("the energy");
                let size = 1.0 + whole[0].abs() + meaning.kinetic_energy.abs() + meaning.force_function.abs();
                compare(function::ENERGY, run(&mut lost, function::ENERGY), whole, size);
            }
            if !selection.reactions.is_empty() && model.quaternions.is_empty() {
                let l = declared.degrees;
                let wanted = selection.reactions.iter().map(|v| reference.reactions[v - l]).collect();
                compare(
                    function::REACTIONS,
                    run(&mut lost, function::REACTIONS),
                    wanted,
                    unit * reference.condition,
                );
            }
            for (name, of, pattern) in beside::jacobians(level) {
                let at = |own: SymbolId, step: f64| {
                    moved(&mut None, of, &|symbol| if symbol == own { step } else { 0.0 })
                };
                let quotients = beside::quotients(&beside::columns(model, level), &at);
                let largest = quotients.iter().flatten().fold(unit, |most, e| most.max(e.abs()));
                let found = beside::matrix(pattern, &run(&mut lost, name), &quotients);
                let size = largest * reference.condition * beside::CLOSE / ROUNDING;
                compare(name, found, quotients.concat(), size);
            }
            for name in [function::DOMAIN, function::PIVOTS] {
                if run(&mut lost, name).iter().any(|value| !value.is_finite()) {
                    fault(format!("`{name}` is not finite"));
                }
            }
            seen.states += 1;
            if let Some(lost) = lost {
                fault(lost);
            }
        }
    }
    seen
}

/// More of them with `GUEN_ROUNDS`; that of one number with `GUEN_ONLY`.
#[test]
fn scenes_of_drawn_declarations_are_those_of_the_whole_system() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let rounds = number("GUEN_ROUNDS").unwrap_or(6);
    let seeds: Vec<u64> = number("GUEN_ONLY").map_or_else(|| (0..rounds).collect(), |seed| vec![seed]);
    let mut all = Seen::default();
    let found = by_two_threads(&seeds, |seed| {
        let text = declaration(*seed);
        derived(&text, |derived| looked_at(&text, derived, *seed))
    });
    found.into_iter().for_each(|found| all.add(found));
    let Seen { scenes, states, smaller, parts, faults } = all;
    println!("{scenes} scenes, {smaller} smaller, {parts} parts of their systems; {states} states");
    for fault in &faults {
        println!("{fault}");
    }
    assert!(faults.is_empty(), "{} faults in {scenes} scenes", faults.len());
    assert!(seeds.len() < 8 || (scenes > seeds.len() && states > scenes && smaller > scenes / 4));
}
