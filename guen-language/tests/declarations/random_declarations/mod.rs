//! Declarations drawn at random: the programs that are made of them against what they mean.
//!
//! What they mean is computed in numbers, from the tree of the declaration: vectors, rotations and bodies as they are
//! defined, rates by dual numbers, the motion by Lagrange's equations with multipliers. Nothing of it knows the model, the
//! algebra, the derivation or the optimiser.

mod analytic;
mod beside;
mod bodies;
mod compiled;
mod components;
mod contacts;
mod declared;
#[allow(dead_code, reason = "systems drawn over expressions use the rest")]
#[path = "../../../../guen-symbolic/tests/random_systems/draw.rs"]
mod draw;
mod families;
mod formulations;
mod functions;
mod grammar;
mod held;
mod levels;
mod meaning;
mod mechanisms;
mod modes;
#[allow(dead_code, reason = "systems drawn over expressions use the rest")]
#[path = "../../../../guen-symbolic/tests/random_systems/multipliers.rs"]
mod multipliers;
pub mod printed;
#[allow(dead_code, reason = "systems drawn over expressions use the rest")]
#[path = "../../../../guen-symbolic/tests/random_systems/scalar.rs"]
mod scalar;
mod scenes;
mod series;
mod several;
mod space;

use guen_language::derive::{DerivedLevel, DerivedSystem, function};
use guen_language::model::{self, Model};
use guen_symbolic::{ExprId, Graph, SymbolId, evaluate_f64};

use crate::common::{by_two_threads, derived, evaluated, rounds};
use declared::Declared;
use draw::Draw;

/// Largest difference, in units of condition times scale.
const ROUNDING: f64 = 1e-12;
/// Beyond this condition times scale a state is left out: a loop of links that is nearly straight takes digits from everything.
const LARGEST: f64 = 1e6;
/// States of each system.
const STATES: usize = 3;

/// A declaration in numbers, and the symbols of its coordinates and of its constants, inputs and states with their names.
struct Numbers<'a> {
    declared: Declared<'a>,
    coordinates: Vec<(String, SymbolId)>,
    held: Vec<(String, SymbolId)>,
}

impl Numbers<'_> {
    /// The values of time, coordinates, constants, inputs, states and parameters at a point.
    fn values(&self, model: &Model<'_>, point: &[f64], etas: &[f64]) -> Vec<(SymbolId, f64)> {
        let symbol = |e: &ExprId| model.bench.graph.as_symbol(*e).expect("a symbol");
        let time = symbol(&model.mechanics.forms.time);
        let held = self.held.iter().map(|(_, symbol)| *symbol).zip(&point[2 * self.declared.n + 1..]);
        let coordinates = self.coordinates.iter().map(|(_, symbol)| *symbol).zip(&point[1..]);
        let parameters = model.mechanics.etas.iter().map(symbol).zip(etas);
        let all = coordinates.chain(held).chain(parameters).map(|(symbol, value)| (symbol, *value));
        all.chain([(time, point[0])]).collect()
    }

    /// Values of constants, inputs and states; what a scene fixes has the values that it has there.
    fn given(&self, graph: &Graph, level: &DerivedLevel, draw: &mut Draw) -> Vec<f64> {
        let mut given: Vec<f64> = self.held.iter().map(|_| draw.real(0.5, 1.5)).collect();
        for (constant, value) in level.scene.iter().flat_map(|facts| &facts.fixes) {
            let others = |other: SymbolId| {
                given[self.held.iter().position(|(_, known)| *known == other).expect("a constant")]
            };
            given[*constant] = evaluate_f64(graph, &[*value], &others)[0];
        }
        given
    }
}

fn numbers<'a>(derived: &DerivedSystem<'a>) -> Numbers<'a> {
    numbers_of(&derived.model)
}

fn numbers_of<'a>(model: &Model<'a>) -> Numbers<'a> {
    let symbol = |e: ExprId| model.bench.graph.as_symbol(e).expect("a symbol");
    let name = |entry: &model::SymbolEntry<'_>| (entry.name.text.clone(), symbol(entry.symbol));
    let coordinates: Vec<(String, SymbolId)> = model.coordinates.iter().map(name).collect();
    let constants = model.constants.iter().map(|entry| (entry.name.text.clone(), symbol(entry.symbol)));
    let given = model.inputs.iter().chain(&model.states).map(name);
    let held: Vec<(String, SymbolId)> = constants.chain(given).collect();
    let declared = Declared::new(
        model.declaration,
        coordinates.iter().map(|(name, _)| name.clone()).collect(),
        held.iter().map(|(name, _)| name.clone()).collect(),
        model.forms.iter().map(|form| form.name.clone()).collect(),
        model.mechanics.forms.degrees,
    );
    Numbers { declared, coordinates, held }
}

/// The largest difference between the programs of a declaration and its meaning, and how many states were looked at.
fn difference(text: &str, derived: &DerivedSystem<'_>, seed: u64) -> (f64, usize) {
    let model = &derived.model;
    let graph = &model.bench.graph;
    let symbol = |e: ExprId| graph.as_symbol(e).expect("a symbol");
    let numbers = numbers(derived);
    let declared = &numbers.declared;
    let mut draw = Draw::new(!seed);
    let (mut worst, mut states) = (0.0_f64, 0);
    for _ in 0..STATES {
        let Some((point, etas)) = declared.state_with_zero(&mut draw) else { continue };
        let Some(reference) = multipliers::solve(declared, &point) else { continue };
        let unit = reference.condition * reference.scale;
        if unit > LARGEST {
            continue;
        }
        states += 1;
        let mechanics = &model.mechanics;
        let mut values = numbers.values(model, &point, &etas);
        let speeds = declared.velocities.iter().map(|v| point[*v]);
        values.extend(mechanics.velocities.iter().map(|e| symbol(*e)).zip(speeds.clone()));
        let accelerations = mechanics.accelerations.iter().map(|e| symbol(*e));
        values.extend(accelerations.zip(reference.accelerations.iter().copied()));
        let program = |name: &str| {
            let value = |symbol: SymbolId| {
                let known = values.iter().find(|(known, _)| *known == symbol);
                known.map(|(_, value)| *value).expect("a symbol of the declaration")
            };
            evaluated(&derived.system, name, value)
        };
        equations_apart(text, derived, &values, &declared.generalised_forces(&point), unit);
        let meaning = declared.meaning(&point);
        let mut compare = |what: &str, found: Option<Vec<f64>>, expected: Vec<f64>, unit: f64| {
            let found = found.unwrap_or_default();
            assert_eq!(found.len(), expected.len(), "{what} of\n{text}");
            for (a, b) in found.iter().zip(&expected) {
                let ratio = (a - b).abs() / unit;
                assert!(ratio <= ROUNDING, "{what} {found:?}, and not {expected:?}, of\n{text}");
                worst = worst.max(ratio);
            }
        };
        let rates = speeds.chain(reference.accelerations.iter().copied());
        let rates = rates.chain(meaning.state_rates.iter().copied()).collect();
        compare("rates", program(function::RHS), rates, unit);
        let energies = [
            (function::KINETIC_ENERGY, meaning.kinetic_energy),
            (function::FORCE_FUNCTION, meaning.force_function),
        ];
        for (name, energy) in energies {
            compare(name, program(name), vec![energy], 1.0 + energy.abs());
        }
        let outputs = declared.outputs(&point, &reference);
        if !outputs.is_empty() {
            let size = outputs.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
            let size = if meaning.asked.is_empty() { size } else { size.max(unit * reference.condition) };
            compare("outputs", program(function::OUTPUTS), outputs, size);
        }
        // The reaction of `|q| = 1` depends on what `T` is off it, and so may others beside it.
        if model.quaternions.is_empty() {
            let known = derived.system.derivation.reactions.iter().zip(&reference.reactions);
            let reactions: Vec<f64> = known.filter_map(|(e, value)| e.map(|_| *value)).collect();
            if !reactions.is_empty() {
                // `lambda_v` is formed along `X_v`, which has the inverse of the forms once more.
                let unit = unit * reference.condition;
                compare("reactions", program(function::REACTIONS), reactions, unit);
            }
        }
    }
    (worst, states)
}

/// The equations apart at the accelerations of a state: nothing is left of them, and the forces in them are those that are declared,
/// `by_velocities`, along the displacements.
fn equations_apart(
    text: &str,
    derived: &DerivedSystem<'_>,
    values: &[(SymbolId, f64)],
    by_velocities: &[f64],
    unit: f64,
) {
    let model = &derived.model;
    let symbol = |e: ExprId| model.bench.graph.as_symbol(e).expect("a symbol");
    let at = |s: SymbolId| values.iter().find(|(known, _)| *known == s).map_or(f64::NAN, |(_, value)| *value);
    let mechanics = &model.mechanics;
    let l = mechanics.forms.degrees;
    let inputs: Vec<f64> = model.inputs.iter().map(|input| at(symbol(input.symbol))).collect();
    let accelerations: Vec<f64> = mechanics.accelerations[..l].iter().map(|e| at(symbol(*e))).collect();
    let form = evaluated(&derived.system, function::MASS_FORM, at).unwrap_or_default();
    let (triangle, rest) = form.split_at(l * (l + 1) / 2);
    let (bias, input) = rest.split_at(l);
    let coasting = evaluated(&derived.system, function::COASTING, at).unwrap_or_else(|| bias.to_vec());
    let velocities = |moved: Option<usize>| {
        let one = moved.map(|s| symbol(mechanics.etas[s]));
        evaluated(&derived.system, function::VELOCITIES, |s| at(s) + f64::from(u8::from(one == Some(s))))
            .expect("velocities")
    };
    let still = velocities(None);
    for s in 0..l {
        let entry = |k: usize| triangle[s.max(k) * (s.max(k) + 1) / 2 + s.min(k)];
        let inertia: f64 = (0..l).map(|k| entry(k) * accelerations[k]).sum();
        let row = &input[s * inputs.len()..][..inputs.len()];
        let made: f64 = row.iter().zip(&inputs).map(|(slope, input)| slope * input).sum();
        let displaced = velocities(Some(s)).into_iter().zip(&still).map(|(moved, still)| moved - still);
        let force: f64 = displaced.zip(by_velocities).map(|(xi, force)| xi * force).sum();
        let largest = (0..l).fold(1.0_f64, |most, k| most.max(entry(k).abs()));
        let unit = unit * largest * (1.0 + force.abs() + bias[s].abs());
        for (what, left) in [
            ("an equation of motion", inertia + bias[s] - made),
            ("a generalised force", made - (bias[s] - coasting[s]) - force),
        ] {
            assert!(left.abs() <= ROUNDING * unit, "{what}: {left:e} is left in row {s} of\n{text}");
        }
    }
}

#[test]
fn programs_of_drawn_declarations_are_what_they_mean() {
    let rounds = rounds(12);
    let seeds: Vec<u64> = (0..rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let text = grammar::with_functions(*seed);
        derived(&text, |derived| difference(&text, derived, *seed))
    });
    let states: usize = found.iter().map(|(_, states)| states).sum();
    let worst = found.iter().map(|(worst, _)| *worst).fold(0.0, f64::max);
    println!("{states} states of {rounds} systems, at most {worst:.1e} of condition times scale");
    assert!(states as u64 >= 2 * rounds, "{states} states only");
}

/// Rates in other words are equal here only beyond what points modulo a prime see, and the derivatives that would prove it are a
/// thousand times as large as the equations: they are left alone, and the equations derived.
#[test]
fn what_cannot_be_proved_cheaply_is_left_alone() {
    let (_, states) = derived(NESTED, |derived| difference(NESTED, derived, 1));
    assert!(states > 0);
}

const NESTED: &str = "
system Nested {
constants { k4 > 0, k5 > 0, k6 > 0, k7 > 0, k10 > 0, k21 > 0, k22 > 0, k23 > 0, k25 > 0, k29 > 0, k30 > 0, k31 > 0, k32 > 0, k33 > 0, k35 > 0, k36 > 0, k39 > 0, k40 > 0, k41 > 0, k42 > 0, g = 9.81 }
inputs { u24, u34 }
coordinates { q1, r2, r3, e11, e12, e13, e14, s17, s18, s19, q26, q27, s37 }
let arm8 = k4*(cos(q1)*vec(1, 0) + sin(q1)*vec(0, 1)) + k5*(cos(r2)*vec(1, 0) + sin(r2)*vec(0, 1));
let RB20 = rot_z(2/3*t)*quaternion(e11, e12, e13, e14);
let oB20 = vec(sin(t)/2, 0, 0) + rot_z(2/3*t)*vec(3/10, k10, 2/3) + vec(s17, s18, s19);
let RB28 = rot_z(2/3*t)*rot_x(q26)*rot_y(q27);
let oB28 = vec(sin(t)/2, 0, 0) + rot_z(2/3*t)*vec(0, 1/2, 0.7);
let RB38 = RB28;
let oB38 = oB28 + RB28*vec(1/2, 5/4, k36) + s37*RB28*vec(3/5, 0, -4/5);
parameters { spin16 = angular_velocity_body(quaternion(e11, e12, e13, e14)); v45 = (5 + tanh(atan2(-1 - e14^2, q1)))*dot(q27); v46 = dot(s17) - 5/4*t; v47 = dot(s18) - 2/3*t; v48 = dot(s19 + s19^3/5 + t*2/3); v49 = dot(s37);  }
holonomic { closed9: arm8 = 2*vec(1, 0) + k6*(cos(r3)*vec(1, 0) + sin(r3)*vec(0, 1)); length15: e11^2 + e12^2 + e13^2 + e14^2 = 1;  }
bodies { B28 { mass: k30, inertia: sym(3 + k31, 3 + k32, 3 + k33, 0.2, -0.3, 0.7/4), center: oB28 + RB28*vec(2/3, k29, 0), orientation: RB28 }
B38 { mass: k39, inertia: sym(3 + k40, 3 + k41, 3 + k42, 0.2, -0.3, 1.5/4), center: oB38 + RB38*vec(0, 0, 0), orientation: RB38 }
 }
constraints { c43: dot(q26) = q1*dot(s37) - s37*dot(q1); c44: dot(q1) = 0.7*cos(s17)*dot(s19);  }
particles { k7 at arm8; k21 at oB20 + RB20*vec(0.3, 0.4, 0.5); k22 at oB20 + RB20*vec(-0.3, 0.7, 0.2); k23 at oB20 + RB20*vec(0.9, -0.2, -0.6);  }
forces { u24*vec(1, 5/4, 0) along dot(oB20 + q1*vec(0, 7/5, 0)); -k25*norm(dot(oB20) + vec(0.1, 0.2, 0.3))*dot(oB20) along dot(oB20 + q1*vec(7/5, 1, 0)); u34*vec(1, 0.7, 0) along dot(oB28 + q1*vec(0, 7/5, 0)); -k35*norm(dot(oB28) + vec(0.1, 0.2, 0.3))*dot(oB28) along dot(oB28 + q1*vec(7/5, 1, 0)); (cot(3/2 + e11/8))*abs(dot(q1)) along dot(q1);  }
kinetic_energy = dot(q1)^2/20 + dot(r2)^2/20 + dot(r3)^2/20 + dot(e11)^2/20 + dot(e12)^2/20 + dot(e13)^2/20 + dot(e14)^2/20 + dot(s17)^2/20 + dot(s18)^2/20 + dot(s19)^2/20 + dot(q26)^2/20 + dot(q27)^2/20 + dot(s37)^2/20 + c43*dot(q1)/7 + c43^2/9;
potential_energy = 3/4*q27^2 + inner(vec(tanh(asin(e14/9)), 1, r2), unit(vec(1, r2, 2)));
gravity = vec(0, 1/5, -g);
}
";
