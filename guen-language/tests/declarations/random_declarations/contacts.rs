//! Drawn declarations with switches, contacts and resets: the programs that runs through modes are made of, against their meaning.

use guen_language::derive::{Derived, function};
use guen_symbolic::SymbolId;

use super::draw::Draw;
use super::meaning::{Meaning, Touch};
use super::scalar::Dual;
use super::{LARGEST, Numbers, ROUNDING, STATES, grammar, lift, multipliers, numbers};
use crate::common::{by_two_threads, derived, evaluated, rounds};

/// What was looked at.
#[derive(Default)]
struct Seen {
    states: usize,
    rows: usize,
    resets: usize,
    worst: f64,
}

/// The rows of all contacts.
fn rows<R>(meaning: Meaning<R>) -> Vec<R> {
    meaning.contacts.into_iter().flat_map(|touch| touch.rows).collect()
}

/// Free motion, rows and what forces along them do, by the equations with multipliers, in the order of the program; with the unit of
/// rounding.
fn free_motion(declared: &mut super::Declared<'_>, point: &[f64]) -> Option<(Vec<f64>, f64)> {
    let free = multipliers::solve(declared, point)?;
    let unit = free.condition * free.scale;
    if unit > LARGEST {
        return None;
    }
    let meaning = declared.meaning(point);
    let velocities: Vec<f64> = declared.velocities.iter().map(|v| point[*v]).collect();
    let rates = velocities.iter().chain(&free.accelerations).chain(&meaning.state_rates);
    let mut list: Vec<f64> = rates.copied().collect();
    list.extend(meaning.contacts.iter().map(|touch| touch.gap));
    list.extend(meaning.contacts.iter().flat_map(|touch| &touch.rows));
    // The rates of rows along the motion: time, positions and velocities move, constants, inputs and states do not occur in them.
    let n = declared.n;
    let along = |k: usize| match k {
        0 => 1.0,
        k if k <= n => velocities[k - 1],
        k if k <= 2 * n => free.second[k - n - 1],
        _ => 0.0,
    };
    let moving: Vec<Dual<f64>> = rows(declared.meaning(&lift(point, along)));
    list.extend(moving.iter().map(|row| row.du));
    // By row, its derivatives by the velocities.
    let columns: Vec<Vec<Dual<f64>>> = declared
        .velocities
        .iter()
        .map(|v| rows(declared.meaning(&lift(point, |k| if k == *v { 1.0 } else { 0.0 }))))
        .collect();
    let covectors: Vec<Vec<f64>> =
        (0..moving.len()).map(|row| columns.iter().map(|column| column[row].du).collect()).collect();
    let mut responses = Vec::new();
    for covector in &covectors {
        declared.pushed.clone_from(covector);
        responses.push(multipliers::solve(declared, point));
        declared.pushed.fill(0.0);
    }
    let responses: Vec<multipliers::Multipliers> = responses.into_iter().collect::<Option<_>>()?;
    let unit = responses.iter().fold(unit, |most, pushed| most.max(pushed.condition * pushed.scale));
    for (i, covector) in covectors.iter().enumerate() {
        for pushed in &responses[..=i] {
            let second = pushed.second.iter().zip(&free.second).map(|(pushed, free)| pushed - free);
            list.push(second.zip(covector).map(|(second, a)| second * a).sum());
        }
    }
    for pushed in &responses {
        list.extend(pushed.accelerations.iter().zip(&free.accelerations).map(|(pushed, free)| pushed - free));
        // No force acts on the states beside the motion.
        list.extend(meaning.state_rates.iter().map(|_| 0.0));
    }
    let coefficients: [fn(&Touch<f64>) -> f64; 3] =
        [|touch| touch.friction, |touch| touch.stiction, |touch| touch.limit];
    for coefficient in coefficients {
        list.extend(meaning.contacts.iter().map(coefficient));
    }
    Some((list, unit))
}

fn look_at(text: &str, derived: &Derived<'_>, seed: u64) -> Seen {
    let model = &derived.model;
    let graph = &model.bench.graph;
    let symbol = |e| graph.as_symbol(e).expect("a symbol");
    let contacts = model.contacts.as_ref().expect("contacts");
    let facts = derived.system.contacts.as_ref().expect("contacts");
    let Numbers { mut declared, coordinates, held } = numbers(derived);
    let mut draw = Draw::new(!seed);
    let mut seen = Seen::default();
    for _ in 0..STATES {
        let Some((point, etas)) = declared.state(&mut draw) else { continue };
        let Some((motion, unit)) = free_motion(&mut declared, &point) else { continue };
        seen.states += 1;
        let meaning = declared.meaning(&point);
        let mechanics = &model.mechanics;
        let mut values: Vec<(SymbolId, f64)> = vec![(symbol(mechanics.forms.time), point[0])];
        values.extend(coordinates.iter().map(|(_, symbol)| *symbol).zip(point[1..].iter().copied()));
        values
            .extend(held.iter().map(|(_, symbol)| *symbol).zip(point[2 * declared.n + 1..].iter().copied()));
        values.extend(mechanics.etas.iter().map(|e| symbol(*e)).zip(etas.iter().copied()));
        let is_on = |function: f64| if function > 0.0 { 1.0 } else { 0.0 };
        let switches = contacts.switches.iter().zip(&meaning.switches);
        values.extend(switches.map(|(switch, function)| (symbol(switch.symbol), is_on(*function))));
        for (entry, touch) in contacts.entries.iter().zip(&meaning.contacts) {
            let slips = &touch.rows[usize::from(entry.gap.is_some())..];
            let speed = slips.iter().fold(0.0_f64, |speed, slip| speed.hypot(*slip));
            values.extend(entry.speed.map(|e| (symbol(e), speed)));
        }
        let program = |name: &str, values: &[(SymbolId, f64)]| {
            let value = |symbol: SymbolId| {
                let known = values.iter().find(|(known, _)| *known == symbol);
                known.map(|(_, value)| *value).unwrap_or_else(|| panic!("{}", graph.symbol_info(symbol).name))
            };
            evaluated(&derived.system, name, value).unwrap_or_default()
        };
        let signals = program(function::SIGNALS, &values);
        let resets = meaning.resets.iter().map(|(function, _)| *function);
        let mut expected: Vec<f64> = meaning.switches.iter().copied().chain(resets).collect();
        // The functions of branches have no meaning of their own: what they decide is seen in the motion.
        let branches = &signals[expected.len()..];
        values.extend(
            facts.branches.iter().zip(branches).map(|(b, function)| (symbol(b.symbol), is_on(*function))),
        );
        expected.extend(branches);
        let mut compare = |what: &str, found: Vec<f64>, expected: Vec<f64>, unit: f64| {
            assert_eq!(found.len(), expected.len(), "{what} of\n{text}");
            for (place, (a, b)) in found.iter().zip(&expected).enumerate() {
                let ratio = (a - b).abs() / unit;
                assert!(
                    ratio <= ROUNDING,
                    "{what} {place}: {a}, and not {b} ({found:?} {expected:?}), of\n{text}"
                );
                seen.worst = seen.worst.max(ratio);
            }
        };
        let size = |list: &[f64]| list.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
        let given: Vec<f64> = meaning.resets.iter().flat_map(|(_, values)| values.iter().copied()).collect();
        let conditions: [fn(&Touch<f64>) -> f64; 2] = [|touch| touch.when, |touch| touch.release];
        let conditions: Vec<f64> = conditions.iter().flat_map(|of| meaning.contacts.iter().map(of)).collect();
        let all_plain = contacts.entries.iter().all(|entry| entry.when.is_none() && entry.release.is_none());
        let conditions = if all_plain { Vec::new() } else { conditions };
        let restitutions = meaning.contacts.iter().map(|touch| touch.restitution).collect();
        seen.rows += contacts.rows().count();
        seen.resets += given.len();
        for (name, expected) in [
            (function::SIGNALS, expected),
            (function::RESETS, given),
            (function::CONDITIONS, conditions),
            (function::RESTITUTIONS, restitutions),
            (function::OUTPUTS, meaning.outputs.clone()),
        ] {
            let unit = size(&expected);
            compare(name, program(name, &values), expected, unit);
        }
        compare(function::FREE_MOTION, program(function::FREE_MOTION, &values), motion, unit);
    }
    seen
}

#[test]
fn contacts_of_drawn_declarations_are_what_they_mean() {
    let rounds = rounds(8);
    let seeds: Vec<u64> = (0..rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let text = grammar::with_contacts(*seed);
        derived(&text, |derived| look_at(&text, derived, *seed))
    });
    let sum = |of: fn(&Seen) -> usize| found.iter().map(of).sum::<usize>();
    let (states, rows, resets) = (sum(|seen| seen.states), sum(|seen| seen.rows), sum(|seen| seen.resets));
    let worst = found.iter().map(|seen| seen.worst).fold(0.0, f64::max);
    println!(
        "{states} states of {rounds} systems, {rows} rows, {resets} new values, at most {worst:.1e} of condition times scale"
    );
    assert!(states as u64 >= 2 * rounds && rows > states && resets > states, "{states} states only");
}
