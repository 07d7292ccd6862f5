//! The programs of contacts.

use guen_symbolic::{ExprId, Function, Graph, ProgramBuilder, Programs, Rational, Substitution, Workbench};
use proc_macro2::Span;

use super::super::function;
use super::branches::Held;
use super::painleve::{self, Matrix};
use super::{ContactFacts, ContactFunctions, FreeMotion};
use crate::diagnostics::{Fault, Faults};
use crate::limits::MAX_SWITCHES;
use crate::model::Contacts;

/// The contacts of a level.
pub(in crate::derive) struct LevelContacts<'l> {
    pub(super) modes: &'l [Vec<usize>],
    /// The switches by their places.
    pub(super) switches: &'l [usize],
    pub(super) motions: &'l [FreeMotion],
    pub(super) functions: &'l ContactFunctions,
    /// Constants with their limits.
    pub(super) limits: &'l [(ExprId, [ExprId; 2])],
}

/// The programs of the contacts of a level and the facts about them; `None` after a fault, which is reported at `name`.
pub(in crate::derive) fn programs(
    bench: &mut Workbench,
    contacts: &Contacts<'_>,
    level: &LevelContacts<'_>,
    name: Span,
    faults: &mut Faults,
) -> Option<(Programs, ContactFacts)> {
    let LevelContacts { modes, switches, motions, functions, limits } = *level;
    let rows = &functions.rows;
    let lists: Vec<Vec<ExprId>> = motions.iter().map(|motion| motion.list(functions)).collect();
    let mut values = values_by_state(bench, contacts, functions);
    let mut held =
        Held::new(&mut bench.graph, &[lists.concat(), functions.loads.clone()].concat(), &mut values);
    if switches.len() + functions.resets.len() + held.branches.len() > MAX_SWITCHES {
        let text = format!(
            "the motion between contacts changes its formula at the zeros of {} functions, and {MAX_SWITCHES} are allowed",
            switches.len() + functions.resets.len() + held.branches.len()
        );
        let fault = Fault::new(name, text);
        faults.report(fault.help("use fewer of `min`, `max`, `select` and other piecewise functions"));
        return None;
    }
    // Gaps and rows are looked at where no mode is known: there piecewise functions follow the state.
    let moving = motions.first()?.rates.len();
    let following = moving..moving + contacts.entries.len() + rows.len();
    let hold = |graph: &mut Graph, held: &mut Held, list: &[ExprId]| -> Vec<ExprId> {
        let entries = list.iter().enumerate();
        entries.map(|(i, e)| if following.contains(&i) { *e } else { held.of(graph, *e) }).collect()
    };
    let lists: Vec<Vec<ExprId>> = lists.iter().map(|list| hold(&mut bench.graph, &mut held, list)).collect();
    let loads: Vec<ExprId> = functions.loads.iter().map(|e| held.of(&mut bench.graph, *e)).collect();
    let one = bench.graph.one();
    let opposite = bench.graph.neg(one);
    let [when, release] = &functions.conditions;
    let has_conditions = when.iter().chain(release).any(Option::is_some);
    let when = when.iter().map(|when| when.unwrap_or(one));
    let conditions: Vec<ExprId> =
        when.chain(release.iter().map(|release| release.unwrap_or(opposite))).collect();
    let mut signals: Vec<ExprId> = switches.iter().map(|s| functions.switches[*s]).collect();
    signals.extend(&functions.resets);
    signals.extend(held.branches.iter().map(|branch| branch.function));
    let delassus = &motions.first()?.delassus;
    let moves = functions.drifts.iter().any(|drift| !bench.graph.is_zero(*drift));
    let mut builder = ProgramBuilder::new(&mut bench.graph);
    builder.add_equal(function::FREE_MOTION, &lists);
    builder.add_function(function::FREE_RATES, &lists[0][..moving]);
    builder.add_function(function::ROW_RATES, rows);
    if moves {
        builder.add_cold(function::ROW_DRIFTS, &functions.drifts);
    }
    if has_conditions {
        builder.add_cold(function::CONDITIONS, &conditions);
    }
    if !loads.is_empty() {
        builder.add_cold(function::LOADS, &loads);
    }
    builder.add_cold(function::SIGNALS, &signals);
    if !functions.given.is_empty() {
        builder.add_cold(function::RESETS, &functions.given);
    }
    builder.add_cold(function::RESTITUTIONS, &functions.restitutions);
    if !functions.outputs.is_empty() {
        builder.add_cold(function::CONTACT_OUTPUTS, &functions.outputs);
    }
    let programs = builder.finish();
    let matrix = Matrix { delassus, friction: &functions.friction, loads: &loads, limits };
    let facts = ContactFacts {
        modes: modes.to_vec(),
        switches: switches.to_vec(),
        painleve: painleve::prove(bench, contacts, modes, &matrix),
        rows: rows.clone(),
        delassus: delassus.clone(),
        drifts: moves,
        resets: Vec::new(),
        branches: held.branches,
        eliminated: Vec::new(),
    };
    Some((programs, facts))
}

/// The symbols that the state determines: switches by their functions, and the magnitudes of slips by the rows.
fn values_by_state(
    bench: &mut Workbench,
    contacts: &Contacts<'_>,
    functions: &ContactFunctions,
) -> Substitution {
    let graph = &mut bench.graph;
    let half = graph.number(Rational::new(1, 2));
    let mut values = Vec::new();
    for (switch, e) in contacts.switches.iter().zip(&functions.switches) {
        let sign = graph.function(Function::Sign, *e);
        let half_sign = graph.mul(half, sign);
        values.push((switch.symbol, graph.add(half, half_sign)));
    }
    let mut first = 0;
    for entry in &contacts.entries {
        let slips = &functions.rows[first + usize::from(entry.gap.is_some())..first + entry.rows.len()];
        if let Some(speed) = entry.speed {
            let magnitude = match slips {
                [slip] => graph.function(Function::Abs, *slip),
                slips => {
                    let mut sum = graph.zero();
                    for slip in slips {
                        let square = graph.powi(*slip, 2);
                        sum = graph.add(sum, square);
                    }
                    graph.sqrt(sum)
                }
            };
            values.push((speed, magnitude));
        }
        first += entry.rows.len();
    }
    Substitution::new(values)
}
