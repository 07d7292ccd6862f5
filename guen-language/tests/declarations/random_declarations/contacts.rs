//! Drawn declarations with switches, contacts and resets: the programs that runs through modes are made of, against their meaning.

use guen_language::derive::{DerivedLevel, DerivedSystem, function};
use guen_language::model::ContactEntry;
use guen_symbolic::SymbolId;

use super::declared::Declared;
use super::draw::Draw;
use super::meaning::{Asked, Meaning, Touch};
use super::multipliers::{self, Multipliers};
use super::scalar::Dual;
use super::{LARGEST, ROUNDING, STATES, grammar, numbers, scenes};
use crate::common::{by_two_threads, derived, evaluated, rounds};

/// How much was compared, and the largest difference in units of rounding.
#[derive(Default)]
pub struct Seen {
    pub states: usize,
    pub rows: usize,
    pub resets: usize,
    loads: usize,
    pub worst: f64,
}

/// The rows of all contacts.
fn rows<R>(meaning: Meaning<R>) -> Vec<R> {
    meaning.contacts.into_iter().flat_map(|touch| touch.rows).collect()
}

/// The motion without the forces of contacts, and what these do to it, by the equations with multipliers.
struct Motion {
    /// Of the whole state.
    rates: Vec<f64>,
    /// Gaps, rows, their rates, and the lower triangle of the Delassus matrix.
    own: Vec<f64>,
    /// By row, what a force of one adds to the rates of the parameters and of the states beside the motion.
    responses: Vec<Vec<f64>>,
    /// Of friction and stiction, and limits.
    coefficients: Vec<f64>,
    /// By contact that a reaction of the declaration loads, that reaction, and what a force of each row adds to it.
    loads: Vec<f64>,
    /// Without forces of contacts, and what a force of each row adds.
    outputs: Vec<Vec<f64>>,
    /// Condition times scale.
    unit: f64,
    condition: f64,
}

impl Motion {
    fn new(declared: &Declared<'_>, point: &[f64]) -> Option<Self> {
        let free = multipliers::solve(declared, point)?;
        let unit = free.condition * free.scale;
        if unit > LARGEST {
            return None;
        }
        let meaning = declared.meaning(point);
        let velocities: Vec<f64> = declared.velocities.iter().map(|v| point[*v]).collect();
        let rates =
            velocities.iter().chain(&free.accelerations).chain(&meaning.state_rates).copied().collect();
        let mut own: Vec<f64> = meaning.contacts.iter().map(|touch| touch.gap).collect();
        own.extend(meaning.contacts.iter().flat_map(|touch| &touch.rows));
        own.extend(rows(declared.along_motion(point, &free.second)).iter().map(|row| row.du));
        let columns: Vec<Vec<Dual<f64>>> = declared.by_velocities(point).map(rows).collect();
        let count = columns.first().map_or(0, Vec::len);
        let covectors: Vec<Vec<f64>> =
            (0..count).map(|row| columns.iter().map(|column| column[row].du).collect()).collect();
        let pushed = covectors.iter().map(|covector| multipliers::pushed(declared, point, covector));
        let pushed: Vec<Multipliers> = pushed.collect::<Option<_>>()?;
        let added = |pushed: &[f64], free: &[f64]| -> Vec<f64> {
            pushed.iter().zip(free).map(|(pushed, free)| pushed - free).collect()
        };
        for (i, covector) in covectors.iter().enumerate() {
            for pushed in &pushed[..=i] {
                let second = added(&pushed.second, &free.second);
                own.push(second.iter().zip(covector).map(|(second, a)| second * a).sum());
            }
        }
        let responses = pushed.iter().map(|pushed| {
            let mut response = added(&pushed.accelerations, &free.accelerations);
            // No force acts on the states beside the motion.
            response.extend(meaning.state_rates.iter().map(|_| 0.0));
            response
        });
        let loading = meaning.contacts.iter().filter_map(|touch| declared.reaction(touch.load.as_ref()?));
        let loads = loading.flat_map(|place| {
            let own = free.reactions[place];
            let changes = pushed.iter().map(move |pushed| pushed.reactions[place] - own);
            [own].into_iter().chain(changes)
        });
        let outputs = [&free].into_iter().chain(&pushed).map(|motion| declared.outputs(point, motion));
        let mut outputs: Vec<Vec<f64>> = outputs.collect();
        let (without, with) = outputs.split_at_mut(1);
        for (row, with) in with.iter_mut().enumerate() {
            with.iter_mut().zip(&without[0]).for_each(|(with, without)| *with -= without);
            // The force along the gap of a contact is its reaction.
            for (place, asked) in &meaning.asked {
                if let Asked::Reaction(name) = asked
                    && meaning.contact_of_row(row) == Some(name)
                {
                    with[*place] = 1.0;
                }
            }
        }
        let [friction, stiction, limits]: [fn(&Touch<f64>) -> f64; 3] =
            [|touch| touch.friction, |touch| touch.stiction, |touch| touch.limit];
        let of_all = |of: fn(&Touch<f64>) -> f64| meaning.contacts.iter().map(of);
        Some(Motion {
            rates,
            own,
            responses: responses.collect(),
            loads: loads.collect(),
            outputs,
            condition: free.condition,
            coefficients: of_all(friction).chain(of_all(stiction)).chain(of_all(limits)).collect(),
            unit: pushed.iter().fold(unit, |most, pushed| most.max(pushed.condition * pushed.scale)),
        })
    }
}

/// The programs of a system, or of a scene that runs through modes, at states that are drawn of these numbers.
pub fn look_at(
    derived: &DerivedSystem<'_>,
    level: &DerivedLevel,
    on: &Declared<'_>,
    draw: &mut Draw,
) -> Seen {
    let model = &derived.model;
    let graph = &model.bench.graph;
    let symbol = |e| graph.as_symbol(e).expect("a symbol");
    let contacts = model.contacts.as_ref().expect("contacts");
    let facts = level.contacts.as_ref().expect("contacts");
    let selection = &level.selection;
    let numbers = numbers(derived);
    let mut seen = Seen::default();
    for _ in 0..STATES {
        let given = numbers.given(graph, level, draw);
        let declared = &numbers.declared;
        let Some((point, _)) = on.state_of(draw, given) else { continue };
        let Some(motion) = Motion::new(declared, &point) else { continue };
        let Motion { rates, own, responses, coefficients, loads, outputs, unit, condition } = motion;
        let meaning = declared.meaning(&point);
        let parameters = &model.forms[..model.mechanics.forms.degrees];
        let etas: Vec<f64> = parameters.iter().map(|form| meaning.forms[&form.name]).collect();
        let mut values = numbers.values(model, &point, &etas);
        let is_on = |function: f64| if function > 0.0 { 1.0 } else { 0.0 };
        let switches = contacts.switches.iter().zip(&meaning.switches);
        values.extend(switches.map(|(switch, function)| (symbol(switch.symbol), is_on(*function))));
        for (entry, touch) in contacts.entries.iter().zip(&meaning.contacts) {
            let speed = touch.slips().iter().fold(0.0_f64, |speed, slip| speed.hypot(*slip));
            values.extend(entry.speed.map(|e| (symbol(e), speed)));
        }
        let program = |name: &str, values: &[(SymbolId, f64)]| {
            let value = |s: SymbolId| {
                // A scene holds a variable that it fixes as a constant.
                let fixed = selection.held.iter().find(|fixed| graph.as_symbol(fixed.symbol) == Some(s));
                let s = fixed.map_or(s, |fixed| symbol(model.variable(fixed.place)));
                let known = values.iter().find(|(known, _)| *known == s);
                known.map(|(_, value)| *value).unwrap_or_else(|| panic!("{}", graph.symbol_info(s).name))
            };
            evaluated(level, name, value).unwrap_or_default()
        };
        let signals = program(function::SIGNALS, &values);
        let mut expected: Vec<f64> = facts.switches.iter().map(|s| meaning.switches[*s]).collect();
        expected.extend(facts.resets.iter().map(|own| meaning.resets[own.reset].0));
        // The functions of branches have no meaning of their own: what they decide is seen in the motion.
        let branches = signals.get(expected.len()..).unwrap_or_default();
        // Where two branches meet, either may be taken, and their slopes differ.
        if branches.iter().any(|function| function.abs() < 1e-9) {
            continue;
        }
        seen.states += 1;
        let decided = facts.branches.iter().zip(branches);
        values.extend(decided.map(|(branch, function)| (symbol(branch.symbol), is_on(*function))));
        expected.extend(branches);
        let mut compare = |name: &str, values: &[(SymbolId, f64)], expected: Vec<f64>, unit: f64| {
            let found = program(name, values);
            assert_eq!(found.len(), expected.len(), "{name} of\n{}", model.declaration);
            for (place, (a, b)) in found.iter().zip(&expected).enumerate() {
                let ratio = (a - b).abs() / unit;
                assert!(ratio <= ROUNDING, "{name} {place}: {a}, and not {b}, of\n{}", model.declaration);
                seen.worst = seen.worst.max(ratio);
            }
        };
        let given: Vec<f64> = facts
            .resets
            .iter()
            .flat_map(|own| own.assignments.iter().map(|(given, _)| meaning.resets[own.reset].1[*given]))
            .collect();
        let is_plain = contacts.entries.iter().all(|entry| entry.when.is_none() && entry.release.is_none());
        let when = meaning.contacts.iter().map(|touch| touch.when);
        let release = meaning.contacts.iter().map(|touch| touch.release);
        let mut conditions = if is_plain { Vec::new() } else { when.chain(release).collect::<Vec<f64>>() };
        // What is never open in a scene needs no condition to close.
        let found = program(function::CONDITIONS, &values);
        let never_open = |place: usize| facts.modes.iter().all(|mode| mode[place] > 0);
        let has_condition = |(place, entry): (usize, &ContactEntry<'_>)| {
            entry.release.is_some() || entry.when.is_some() && !never_open(place)
        };
        if found.is_empty() && !contacts.entries.iter().enumerate().any(has_condition) {
            conditions.clear();
        }
        let lost = conditions.iter_mut().take(contacts.entries.len()).zip(&found).enumerate();
        let lost = lost.filter(|(place, (_, found))| never_open(*place) && **found == 1.0);
        lost.for_each(|(_, (when, _))| *when = 1.0);
        let components = selection.outputs.iter().flat_map(|output| &model.outputs[*output].components);
        let components: Vec<usize> = components.copied().collect();
        seen.rows += contacts.rows().count();
        seen.resets += given.len();
        for (name, expected) in [
            (function::SIGNALS, expected),
            (function::RESETS, given),
            (function::CONDITIONS, conditions),
            (function::RESTITUTIONS, meaning.contacts.iter().map(|touch| touch.restitution).collect()),
        ] {
            let unit = expected.iter().fold(1.0_f64, |most, e| most.max(e.abs()));
            compare(name, &values, expected, unit);
        }
        // With accelerations and reactions, at forces of contacts that are drawn.
        let forces: Vec<f64> = contacts.rows().map(|_| draw.real(-1.0, 1.0)).collect();
        let component = |at: &dyn Fn(usize) -> f64| components.iter().map(|c| at(*c)).collect::<Vec<f64>>();
        let free = component(&|c| outputs[0][c]);
        let pressed = component(&|c| {
            outputs[0][c]
                + forces.iter().zip(&outputs[1..]).map(|(force, added)| force * added[c]).sum::<f64>()
        });
        let size = free.iter().fold(unit * condition, |most, e| most.max(e.abs()));
        compare(function::OUTPUTS, &values, free, size);
        values.extend(contacts.rows().map(|row| symbol(row.force)).zip(forces));
        compare(function::CONTACT_OUTPUTS, &values, pressed, size);
        let places = &selection.variables;
        let pressed = places.iter().filter_map(|place| place.checked_sub(declared.n));
        let rates = places.iter().map(|place| rates[*place]).chain(own);
        compare(function::FREE_RATES, &values, rates.clone().take(places.len()).collect(), unit);
        let now = rows(meaning);
        let largest = now.iter().fold(1.0_f64, |most, row| most.max(row.abs()));
        compare(function::ROW_RATES, &values, now, largest);
        // Scenes need no parts of rows that rest.
        if facts.drifts && level.scene.is_none() {
            let resting = rows(declared.meaning(&declared.at_rest(&point)));
            compare(function::ROW_DRIFTS, &values, resting, largest * condition);
        }
        let responses = responses.iter().flat_map(|response| pressed.clone().map(|place| response[place]));
        seen.loads += loads.len();
        // A reaction is formed along `X_v`, which has the inverse of the forms once more.
        compare(function::LOADS, &values, loads, unit * condition);
        compare(function::FREE_MOTION, &values, rates.chain(responses).chain(coefficients).collect(), unit);
    }
    seen
}

#[test]
fn contacts_of_drawn_declarations_are_what_they_mean() {
    let rounds = rounds(8);
    let seeds: Vec<u64> = (0..rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let text = grammar::with_contacts(*seed);
        derived(&text, |derived| {
            look_at(derived, &derived.system, &numbers(derived).declared, &mut Draw::new(!seed))
        })
    });
    report(found, rounds);
}

#[test]
fn contacts_of_drawn_scenes_are_those_of_the_whole_system() {
    let rounds = rounds(4);
    let seeds: Vec<u64> = (0..rounds).collect();
    let found = by_two_threads(&seeds, |seed| {
        let (text, _) = scenes::drawn(&grammar::with_contacts(*seed), *seed, 2);
        derived(&text, |derived| {
            let levels = derived.scenes.iter().filter(|level| level.contacts.is_some());
            let mut draw = Draw::new(seed.rotate_left(9));
            let whole = numbers(derived).declared;
            levels.map(|level| look_at(derived, level, &whole, &mut draw)).collect::<Vec<Seen>>()
        })
    });
    report(found.into_iter().flatten().collect(), rounds);
}

fn report(found: Vec<Seen>, rounds: u64) {
    let sum = |of: fn(&Seen) -> usize| found.iter().map(of).sum::<usize>();
    let (states, rows, resets) = (sum(|seen| seen.states), sum(|seen| seen.rows), sum(|seen| seen.resets));
    let loads = sum(|seen| seen.loads);
    let worst = found.iter().map(|seen| seen.worst).fold(0.0, f64::max);
    println!(
        "{states} states of {rounds} systems, {rows} rows, {resets} new values, {loads} numbers of loads, at most {worst:.1e} of condition times scale"
    );
    assert!(states as u64 >= 2 * rounds && rows > states && resets > states, "{states} states only");
}
