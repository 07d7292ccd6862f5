//! Contacts: the motion without their forces, what their forces do to it, and their functions.
//!
//! The system is derived once more with a force along every row of the contacts. The rates are affine in these forces, so that
//! their derivatives by a force are `M^-1 W^T`, found by the elimination that solves the system.

use guen_symbolic::{
    Derivation, ExprId, Flow, Function, Graph, ProgramBuilder, Programs, Rational, Substitution, Verdict,
    Workbench, weighted_cost,
};

use super::branches::{Branch, Held};
use super::faults;
use super::function;
use crate::diagnostics::{Fault, Faults};
use crate::limits::MAX_SWITCHES;
use crate::model::{ContactKind, Contacts, Model};

/// The facts about contacts that the programs do not tell.
#[derive(Clone, Debug, Default)]
pub struct ContactFacts {
    /// Whether a slipping contact can be proved to have one reaction in every mode.
    pub painleve_free: bool,
    /// Pairs of a contact that slips and one that touches, for which the proof failed.
    pub coupled: Vec<(usize, usize)>,
    /// The rows, on the constraints.
    pub rows: Vec<ExprId>,
    /// The Delassus matrix, its lower triangle row by row.
    pub delassus: Vec<ExprId>,
    /// Whether a row moves by itself.
    pub drifts: bool,
    /// The branches of piecewise functions, which are signals after the switches.
    pub branches: Vec<Branch>,
}

/// The programs of contacts, and the facts about them; `None` after a fault, and where there are neither contacts nor switches.
pub(super) fn derive(model: &mut Model<'_>, faults: &mut Faults) -> Option<(Programs, ContactFacts)> {
    let contacts = model.contacts.take()?;
    let derived = programs(model, &contacts, faults);
    model.contacts = Some(contacts);
    derived
}

fn programs(
    model: &mut Model<'_>,
    contacts: &Contacts<'_>,
    faults: &mut Faults,
) -> Option<(Programs, ContactFacts)> {
    model.bench.begin_another();
    let mut derivation = match Derivation::new(&mut model.bench, contacts.mechanics.clone()) {
        Ok(derivation) => derivation,
        Err(error) => {
            faults::report(model, error, faults);
            return None;
        }
    };
    let bench = &mut model.bench;
    let (n, l) = (model.coordinates.len(), derivation.system.forms.degrees);
    let etas: Vec<ExprId> = derivation.system.etas[..l].to_vec();
    let zero = bench.graph.zero();
    let forces: Vec<ExprId> = contacts.rows().map(|row| row.force).collect();
    let written: Vec<ExprId> = contacts.rows().map(|row| row.form).collect();
    let rows: Vec<ExprId> = written
        .into_iter()
        .map(|form| {
            let row = derivation.frame.constrain.of(&mut bench.graph, form);
            bench.tidy(row)
        })
        .collect();
    let before = faults.count();
    let mut first = 0;
    // In a component the first instance is named.
    let mut places = Vec::new();
    for entry in &contacts.entries {
        let place = format!("{:?}", entry.gap_span);
        if entry.gap.is_some()
            && !places.contains(&place)
            && bench.verdict_on_manifold(rows[first]) == Verdict::Zero
        {
            let what = if entry.kind == ContactKind::Latch { "latch" } else { "gap" };
            let text = format!("the {what} of `{}` never changes", entry.name);
            faults.report(Fault::new(entry.gap_span, text).note("its rate vanishes on the constraints"));
            places.push(place);
        }
        first += entry.rows.len();
    }
    if faults.count() > before {
        return None;
    }
    let columns: Vec<Vec<ExprId>> = rows
        .iter()
        .map(|row| {
            etas.iter()
                .map(|eta| {
                    let slope = bench.partial(*row, *eta);
                    bench.tidy(slope)
                })
                .collect()
        })
        .collect();
    let mut at_rest = Substitution::new(etas.iter().map(|eta| (*eta, zero)));
    let drifts: Vec<ExprId> = rows
        .iter()
        .map(|row| {
            let drift = at_rest.of(&mut bench.graph, *row);
            bench.tidy(drift)
        })
        .collect();
    // In an impact a contact force is an impulse, so that a rate that depends on it has no value there.
    for (state, rate) in model.states.iter().zip(&derivation.formulations[0].rates[n + l..]) {
        let pressed = forces.iter().any(|force| {
            let slope = Flow::partial(&bench.graph, *force).of(&mut bench.graph, *rate);
            bench.verdict_on_manifold(slope) != Verdict::Zero
        });
        if pressed {
            let text = format!("the rate of state `{}` depends on forces of contacts", state.name);
            let fault = Fault::new(state.name.span(), text);
            let fault = fault.note(
                "accelerations and reactions are infinite in an impact, and a state goes on through it",
            );
            faults.report(fault.help("write the rate by positions, velocities, inputs and states"));
        }
    }
    if faults.count() > before {
        return None;
    }
    let mut lists: Vec<(u64, Vec<ExprId>, Vec<ExprId>)> = Vec::new();
    for formulated in &derivation.formulations {
        let mut unpressed = Substitution::new(forces.iter().map(|force| (*force, zero)));
        let rates: Vec<ExprId> = formulated
            .rates
            .iter()
            .map(|rate| {
                let rate = unpressed.of(&mut bench.graph, *rate);
                bench.keep_large(rate)
            })
            .collect();
        let responses: Vec<Vec<ExprId>> = forces
            .iter()
            .map(|force| {
                let mut by = Flow::partial(&bench.graph, *force);
                let slopes = formulated.rates[n..].iter();
                slopes
                    .map(|rate| {
                        let slope = by.of(&mut bench.graph, *rate);
                        let slope = unpressed.of(&mut bench.graph, slope);
                        let slope = bench.tidy(slope);
                        bench.keep_large(slope)
                    })
                    .collect()
            })
            .collect();
        let moving = model.mechanics.forms.coordinates.iter().copied().chain(etas.iter().copied());
        let moving =
            moving.zip(rates.iter().copied()).chain([(model.mechanics.forms.time, bench.graph.one())]);
        let mut along = Flow::new(&bench.graph, moving.collect::<Vec<_>>());
        let biases: Vec<ExprId> = rows.iter().map(|row| along.of(&mut bench.graph, *row)).collect();
        let mut delassus = Vec::new();
        for (w, response) in responses.iter().enumerate() {
            for column in &columns[..=w] {
                let entry = bench.dot(column, &response[..l]);
                delassus.push(bench.tidy(entry));
            }
        }
        let mut list = rates.clone();
        list.extend(contacts.entries.iter().map(|entry| match entry.kind {
            ContactKind::Grip => zero,
            _ => entry.gap.unwrap_or(zero),
        }));
        list.extend(&rows);
        list.extend(biases);
        list.extend(&delassus);
        list.extend(responses.into_iter().flatten());
        let or_zero = |e: Option<ExprId>| e.unwrap_or(zero);
        list.extend(contacts.entries.iter().map(|entry| match entry.kind {
            ContactKind::Grip if entry.loaded_by.is_none() => zero,
            _ => or_zero(entry.friction),
        }));
        list.extend(contacts.entries.iter().map(|entry| match entry.kind {
            ContactKind::Grip if entry.loaded_by.is_none() => zero,
            _ => or_zero(entry.stiction),
        }));
        list.extend(contacts.entries.iter().map(|entry| or_zero(entry.limit)));
        let constrain = &mut derivation.frame.constrain;
        list.iter_mut().for_each(|e| *e = constrain.of(&mut bench.graph, *e));
        lists.push((weighted_cost(&bench.graph, &list), list, delassus));
    }
    lists.sort_by_key(|(cost, ..)| *cost);
    lists.truncate(LISTS);
    let (_, best, delassus) = lists.first()?;
    let (best, delassus) = (best.clone(), delassus.clone());
    let lists: Vec<Vec<ExprId>> = lists.into_iter().map(|(_, list, _)| list).collect();
    let mut values = values_by_state(bench, contacts, &rows);
    let mut held = Held::new(&mut bench.graph, &lists.concat(), &mut values);
    if contacts.switches.len() + held.branches.len() > MAX_SWITCHES {
        let text = format!(
            "the motion between contacts changes its formula at the zeros of {} functions, and {MAX_SWITCHES} are allowed",
            contacts.switches.len() + held.branches.len()
        );
        let fault = Fault::new(model.declaration.name.span(), text);
        faults.report(fault.help("use fewer of `min`, `max`, `select` and other piecewise functions"));
        return None;
    }
    // Gaps and rows are looked at where no mode is known: there piecewise functions follow the state.
    let moving = n + l + model.states.len();
    let following = moving..moving + contacts.entries.len() + rows.len();
    let hold = |graph: &mut Graph, held: &mut Held, list: &[ExprId]| -> Vec<ExprId> {
        let entries = list.iter().enumerate();
        entries.map(|(i, e)| if following.contains(&i) { *e } else { held.of(graph, *e) }).collect()
    };
    let lists: Vec<Vec<ExprId>> = lists.iter().map(|list| hold(&mut bench.graph, &mut held, list)).collect();
    let best = hold(&mut bench.graph, &mut held, &best);
    let one = bench.graph.one();
    let opposite = bench.graph.neg(one);
    let mut conditions: Vec<ExprId> =
        contacts.entries.iter().map(|entry| entry.when.unwrap_or(one)).collect();
    conditions.extend(contacts.entries.iter().map(|entry| entry.release.unwrap_or(opposite)));
    let constrain = &mut derivation.frame.constrain;
    conditions.iter_mut().for_each(|e| *e = constrain.of(&mut bench.graph, *e));
    let mut signals: Vec<ExprId> =
        contacts.switches.iter().map(|switch| constrain.of(&mut bench.graph, switch.function)).collect();
    signals.extend(held.branches.iter().map(|branch| branch.function));
    let restitutions: Vec<ExprId> = contacts.entries.iter().map(|entry| entry.restitution).collect();
    let (painleve_free, coupled) = painleve(bench, contacts, &delassus);
    let moves = drifts.iter().any(|drift| !bench.graph.is_zero(*drift));
    let has_conditions = contacts.entries.iter().any(|entry| entry.when.is_some() || entry.release.is_some());
    let mut builder = ProgramBuilder::new(&mut bench.graph);
    builder.add_equal(function::FREE_MOTION, &lists);
    builder.add_function(function::FREE_RATES, &best[..moving]);
    builder.add_function(function::ROW_RATES, &rows);
    if moves {
        builder.add_cold(function::ROW_DRIFTS, &drifts);
    }
    if has_conditions {
        builder.add_cold(function::CONDITIONS, &conditions);
    }
    builder.add_cold(function::SIGNALS, &signals);
    builder.add_cold(function::RESTITUTIONS, &restitutions);
    if !derivation.outputs.is_empty() {
        builder.add_cold(function::CONTACT_OUTPUTS, &derivation.outputs);
    }
    let facts =
        ContactFacts { painleve_free, coupled, rows, delassus, drifts: moves, branches: held.branches };
    Some((builder.finish(), facts))
}

/// The symbols that the state determines: switches by their functions, and the magnitudes of slips by the rows.
fn values_by_state(bench: &mut Workbench, contacts: &Contacts<'_>, rows: &[ExprId]) -> Substitution {
    let graph = &mut bench.graph;
    let half = graph.number(Rational::new(1, 2));
    let mut values = Vec::new();
    for switch in &contacts.switches {
        let sign = graph.function(Function::Sign, switch.function);
        let half_sign = graph.mul(half, sign);
        values.push((switch.symbol, graph.add(half, half_sign)));
    }
    let mut first = 0;
    for entry in &contacts.entries {
        let slips = &rows[first + usize::from(entry.gap.is_some())..first + entry.rows.len()];
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

/// The lists of equal expressions that the optimiser looks at.
const LISTS: usize = 2;

/// Whether no slip changes how a gap answers to its own force: the entries of `D` between slips with friction and gaps vanish. The
/// pairs for which they do not.
fn painleve(
    bench: &mut Workbench,
    contacts: &Contacts<'_>,
    delassus: &[ExprId],
) -> (bool, Vec<(usize, usize)>) {
    let mut normal = Vec::new();
    let mut tangential = Vec::new();
    let mut row = 0;
    for (place, entry) in contacts.entries.iter().enumerate() {
        let is_rough = entry.friction.is_some_and(|friction| !bench.graph.is_zero(friction));
        for i in 0..entry.rows.len() {
            match entry.kind {
                ContactKind::Grip => {}
                _ if i == 0 => normal.push((place, row)),
                _ if is_rough => tangential.push((place, row)),
                _ => {}
            }
            row += 1;
        }
    }
    let mut coupled = Vec::new();
    for (slipping, t) in &tangential {
        for (touching, n) in &normal {
            let (high, low) = (*t.max(n), *t.min(n));
            let entry = delassus[high * (high + 1) / 2 + low];
            if bench.verdict_on_manifold(entry) != Verdict::Zero {
                coupled.push((*slipping, *touching));
            }
        }
    }
    coupled.dedup();
    (coupled.is_empty(), coupled)
}
