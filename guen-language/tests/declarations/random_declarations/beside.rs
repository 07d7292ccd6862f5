//! What is emitted beside the rates of a drawn declaration, against its meaning: forms, momenta, the energy integral and its rate, slopes of
//! positions, poses, reactions as a covector, operators with their brackets, and linearisations.

use guen_language::derive::{Derived, function};
use guen_symbolic::{Pattern, SymbolId, evaluate_function, evaluate_prepare};

use super::declared::{Declared, lift};
use super::draw::Draw;
use super::multipliers::{self, Multipliers};
use super::scalar::{Dual, Scalar, solve};
use super::{LARGEST, ROUNDING, STATES, grammar, numbers};
use crate::common::{by_two_threads, derived, evaluated, rounds};

/// Largest difference to a difference quotient, in units of condition times scale.
const CLOSE: f64 = 1e-6;
/// The step of difference quotients.
const STEP: f64 = 1e-5;

/// How much was compared, and the largest differences from what is exact and from difference quotients, in units of condition times scale.
#[derive(Default)]
struct Seen {
    states: usize,
    numbers: usize,
    worst: [f64; 2],
}

/// The coefficients of `X_0, X_1..X_n`: the columns of the inverse of the forms, without that of the time.
fn operators<R: Scalar>(forms: &[Vec<R>]) -> Vec<Vec<R>> {
    let n = forms.len();
    let unit = |row: usize, column: usize| R::constant(if row == column { 1.0 } else { 0.0 });
    let right = |row: usize| {
        let offset = forms[row][n].scaled(-1.0);
        [offset].into_iter().chain((0..n).map(|column| unit(row, column))).collect()
    };
    let solved = solve(forms.iter().map(|row| row[..n].to_vec()).collect(), (0..n).map(right).collect());
    (0..=n).map(|s| solved.iter().map(|row| row[s].clone()).collect()).collect()
}

/// `C_rs1 .. C_rsn` by the commutator of the vector fields.
fn bracket(declared: &Declared<'_>, point: &[f64], (r, s): (usize, usize)) -> Vec<f64> {
    let n = declared.n;
    let forms = declared.forms_at(point);
    let fields = operators(&forms);
    // A field with the time's share, and how all fields change along it.
    let along = |field: usize| {
        let moving = lift(point, |k| match k {
            0 => f64::from(u8::from(field == 0)),
            k if k <= n => fields[field][k - 1],
            _ => 0.0,
        });
        operators(&declared.forms_at(&moving))
    };
    let (along_r, along_s): (Vec<Vec<Dual<f64>>>, Vec<Vec<Dual<f64>>>) = (along(r), along(s));
    let commutator: Vec<f64> = (0..n).map(|i| along_r[s][i].du - along_s[r][i].du).collect();
    forms.iter().map(|row| row[..n].iter().zip(&commutator).map(|(a, c)| a * c).sum()).collect()
}

fn look_at(text: &str, derived: &Derived<'_>, seed: u64) -> Seen {
    let (model, level) = (&derived.model, &derived.system);
    let graph = &model.bench.graph;
    let symbol = |e| graph.as_symbol(e).expect("a symbol");
    let numbers = numbers(derived);
    let declared = &numbers.declared;
    let (n, l) = (declared.n, declared.degrees);
    let mechanics = &model.mechanics;
    let mut draw = Draw::new(seed.rotate_left(7));
    let mut seen = Seen::default();
    for _ in 0..STATES {
        let Some((point, etas)) = declared.state(&mut draw) else { continue };
        let Some(reference) = multipliers::solve(declared, &point) else { continue };
        let unit = reference.condition * reference.scale;
        if unit > LARGEST {
            continue;
        }
        seen.states += 1;
        let mut values = numbers.values(model, &point, &etas);
        let accelerations = mechanics.accelerations.iter().map(|e| symbol(*e));
        values.extend(accelerations.zip(reference.accelerations.iter().copied()));
        // At a kink rounding decides.
        if point[declared.velocities[0]].abs() < 1e-9 {
            continue;
        }
        let velocities: Vec<SymbolId> = mechanics.velocities.iter().map(|e| symbol(*e)).collect();
        values.extend(velocities.iter().copied().zip(declared.velocities.iter().map(|v| point[*v])));
        let program = |name: &str, moved: &dyn Fn(SymbolId) -> f64| {
            let value = |symbol: SymbolId| {
                let known = values.iter().find(|(known, _)| *known == symbol);
                known.map(|(_, value)| *value).expect("a symbol of the declaration") + moved(symbol)
            };
            evaluated(level, name, value)
        };
        let own = |name: &str| program(name, &|_| 0.0).unwrap_or_default();
        let mut compare = |name: &str, found: Vec<f64>, expected: Vec<f64>, unit: f64, close: f64| {
            assert_eq!(found.len(), expected.len(), "{name} of\n{text}");
            for (place, (a, b)) in found.iter().zip(&expected).enumerate() {
                let ratio = (a - b).abs() / unit;
                assert!(ratio <= close, "{name} {place}: {a}, and not {b}, of\n{text}");
                let kind = usize::from(close == CLOSE);
                seen.worst[kind] = seen.worst[kind].max(ratio);
                seen.numbers += 1;
            }
        };
        let size = |list: &[f64]| list.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
        // Forms at any velocities.
        let mut free = point.clone();
        declared.velocities.iter().for_each(|v| free[*v] += draw.real(-1.0, 1.0));
        let any = declared.meaning(&free);
        let forms: Vec<f64> = model.forms.iter().map(|form| any.forms[&form.name]).collect();
        let change = |s: SymbolId| {
            let place = velocities.iter().position(|known| *known == s);
            place.map_or(0.0, |i| free[declared.velocities[i]] - point[declared.velocities[i]])
        };
        let largest = size(&forms);
        let found = program(function::FORMS, &change).unwrap_or_default();
        compare(function::FORMS, found, forms, largest, ROUNDING);

        let meaning = declared.meaning(&point);
        let slopes: Vec<f64> =
            declared.by_velocities(&point).map(|meaning| meaning.kinetic_energy.du).collect();
        let fields = operators(&declared.forms_at(&point));
        // `h = sum_i x_i' dT°/dx_i' - T° - U`
        let twice: f64 = declared.velocities.iter().zip(&slopes).map(|(v, slope)| point[*v] * slope).sum();
        let energy = twice - meaning.kinetic_energy - meaning.force_function;
        let largest = size(&[twice, meaning.force_function]);
        compare(function::ENERGY, own(function::ENERGY), vec![energy], largest, ROUNDING);
        let momentum =
            |j: usize| slopes.iter().zip(&fields[j + 1]).map(|(slope, xi)| slope * xi).sum::<f64>();
        let known = (0..n).filter(|j| level.derivation.known_momentum[*j]);
        // That of `|q| = 1` depends on what `T` is off it, and so may others beside it.
        if model.quaternions.is_empty() {
            let momenta: Vec<f64> = known.map(momentum).collect();
            compare(
                function::MOMENTA,
                own(function::MOMENTA),
                momenta,
                size(&slopes) * size(&fields.concat()),
                ROUNDING,
            );
            if let Some(covector) = program(function::REACTION_COVECTOR, &|_| 0.0) {
                assert_eq!(covector.len(), n);
                compare(
                    function::REACTION_COVECTOR,
                    own(function::REACTION_COVECTOR),
                    reference.covector.clone(),
                    unit * reference.condition,
                    ROUNDING,
                );
            }
        }
        if level.derivation.system.redundant.is_empty() && !meaning.positions.is_empty() {
            let columns: Vec<Vec<f64>> = (declared.x.iter())
                .map(|x| {
                    let moving = declared.meaning(&lift(&point, |k| if k == *x { 1.0 } else { 0.0 }));
                    moving.positions.iter().map(|e| e.du).collect()
                })
                .collect();
            // A vector in the plane has no third equation.
            let is_there = |row: &usize| columns.iter().any(|column| column[*row] != 0.0);
            let rows: Vec<usize> = (0..meaning.positions.len()).filter(is_there).collect();
            let slopes = rows.iter().flat_map(|row| columns.iter().map(|column| column[*row]));
            let gradients: Vec<f64> = rows.iter().map(|row| meaning.positions[*row]).chain(slopes).collect();
            let largest = size(&gradients);
            compare(function::GRADIENTS, own(function::GRADIENTS), gradients, largest, ROUNDING);
        }
        compare(
            function::OPERATORS,
            own(function::OPERATORS),
            fields.concat(),
            size(&fields.concat()) * reference.condition,
            ROUNDING,
        );
        let brackets = level.brackets.iter().flat_map(|own| bracket(declared, &point, (own.r, own.s)));
        let brackets: Vec<f64> = brackets.collect();
        let largest = size(&brackets) * size(&fields.concat()) * reference.condition;
        compare(function::BRACKETS, own(function::BRACKETS), brackets, largest, ROUNDING);
        // Those that are not emitted vanish.
        for (r, s) in (1..=l).flat_map(|s| (0..s).map(move |r| (r, s))) {
            if !level.brackets.iter().any(|own| (own.r, own.s) == (r, s)) {
                let zero = bracket(declared, &point, (r, s));
                let largest = size(&fields.concat()) * reference.condition;
                assert!(zero.iter().all(|c| c.abs() <= ROUNDING * largest), "({r}, {s}) {zero:?} of\n{text}");
            }
        }

        if let Some(placed) = &level.placed {
            let value = |symbol: SymbolId| {
                values.iter().find(|(known, _)| *known == symbol).map(|(_, value)| *value).expect("a symbol")
            };
            let found = evaluate_function(placed, 0, &evaluate_prepare(placed, &value), &value);
            let expected = meaning.placed();
            let largest = size(&expected);
            compare(function::BODIES, found, expected, largest, ROUNDING);
        }

        let rates = along(derived, declared, &point, &reference, &numbers.values(model, &point, &etas));
        let fastest = rates.iter().fold(1.0_f64, |most, (_, rate)| most.max(rate.abs()));
        let moved = |step: f64| {
            let rate =
                |s: SymbolId| rates.iter().find(|(known, _)| *known == s).map_or(0.0, |(_, rate)| *rate);
            program(function::ENERGY, &|s| step * rate(s)).expect("an energy")[0]
        };
        let step = STEP / fastest;
        let power = (moved(step) - moved(-step)) / (2.0 * step);
        compare(function::POWER, own(function::POWER), vec![power], unit.max(energy.abs()) * fastest, CLOSE);

        let jacobians = [
            (function::LINEARIZATION, function::RHS, &level.jacobians.rates),
            (function::OUTPUT_LINEARIZATION, function::OUTPUTS, &level.jacobians.outputs),
        ];
        for (name, of, pattern) in jacobians {
            let Some(pattern) = pattern else { continue };
            let variables = level.selection.variables.iter().map(|place| model.variable(*place));
            let inputs = model.inputs.iter().map(|input| input.symbol);
            let columns: Vec<SymbolId> = variables.chain(inputs).map(symbol).collect();
            let quotients: Vec<Vec<f64>> = (columns.iter())
                .map(|own| {
                    let at =
                        |step: f64| program(of, &|s| if s == *own { step } else { 0.0 }).expect("a program");
                    at(STEP).iter().zip(at(-STEP)).map(|(a, b)| (a - b) / (2.0 * STEP)).collect()
                })
                .collect();
            let largest = unit.max(size(&quotients.concat())) * reference.condition;
            compare(name, own(name), entries(pattern, &quotients), largest, CLOSE);
            // What is not emitted vanishes.
            for (column, rows) in quotients.iter().enumerate() {
                for (row, quotient) in rows.iter().enumerate() {
                    let is_zero = pattern.contains(&(row, column)) || quotient.abs() <= CLOSE * largest;
                    assert!(is_zero, "{name} ({row}, {column}): 0, and not {quotient}, of\n{text}");
                }
            }
        }
    }
    seen
}

fn entries(pattern: &Pattern, columns: &[Vec<f64>]) -> Vec<f64> {
    pattern.iter().map(|(row, column)| columns[*column][*row]).collect()
}

/// The rates of the time, the coordinates, the parameters and the states, by symbol.
fn along(
    derived: &Derived<'_>,
    declared: &Declared<'_>,
    point: &[f64],
    reference: &Multipliers,
    values: &[(SymbolId, f64)],
) -> Vec<(SymbolId, f64)> {
    let model = &derived.model;
    let symbol = |e| model.bench.graph.as_symbol(e).expect("a symbol");
    let velocities = declared.velocities.iter().map(|v| point[*v]);
    let rates = velocities.chain(reference.accelerations.iter().copied());
    let rates = rates.chain(declared.meaning(point).state_rates);
    let (_, size) = model.sizes();
    let variables = (0..size).map(|place| symbol(model.variable(place)));
    let found: Vec<(SymbolId, f64)> =
        variables.zip(rates).chain([(symbol(model.mechanics.forms.time), 1.0)]).collect();
    assert!(found.iter().all(|(own, _)| values.iter().any(|(known, _)| known == own)));
    found
}

#[test]
fn programs_of_drawn_declarations_beside_the_rates() {
    let rounds = rounds(8);
    let seeds: Vec<u64> = (0..rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let text = grammar::with_functions(*seed);
        derived(&text, |derived| look_at(&text, derived, *seed))
    });
    let states: usize = found.iter().map(|seen| seen.states).sum();
    let numbers: usize = found.iter().map(|seen| seen.numbers).sum();
    let worst = [0, 1].map(|kind| found.iter().map(|seen| seen.worst[kind]).fold(0.0, f64::max));
    println!(
        "{states} states of {rounds} systems, {numbers} numbers, at most {:.1e} of condition times scale, {:.1e} from difference quotients",
        worst[0], worst[1]
    );
    assert!(states as u64 >= rounds && numbers > 50 * states, "{states} states, {numbers} numbers");
}
