//! The equations of contacts: the motion without their forces, and what their forces do to it.

use guen_symbolic::{Derivation, ExprId, Flow, Substitution, Verdict, Workbench, weighted_cost};

use super::super::faults;
use super::rows;
use crate::derive::selections::fixed;
use crate::diagnostics::{Fault, Faults};
use crate::model::{ContactKind, Contacts, Model};

/// The motion without the forces of contacts, and what these forces do to it.
#[derive(Clone)]
pub(in crate::derive) struct FreeMotion {
    /// The rates of the variables without forces of contacts.
    pub(in crate::derive) rates: Vec<ExprId>,
    /// The rates of the rows in that motion.
    pub(in crate::derive) biases: Vec<ExprId>,
    /// The Delassus matrix, its lower triangle row by row.
    pub(in crate::derive) delassus: Vec<ExprId>,
    /// Row by row, what a unit force adds to the rates of the parameters and of the states beside the motion.
    pub(in crate::derive) responses: Vec<Vec<ExprId>>,
}

/// The functions of contacts that no equations have to be solved for, contact by contact and row by row.
#[derive(Clone)]
pub(in crate::derive) struct ContactFunctions {
    pub(in crate::derive) gaps: Vec<ExprId>,
    pub(in crate::derive) rows: Vec<ExprId>,
    /// The rows at rest.
    pub(in crate::derive) drifts: Vec<ExprId>,
    pub(in crate::derive) friction: Vec<ExprId>,
    pub(in crate::derive) stiction: Vec<ExprId>,
    pub(in crate::derive) limits: Vec<ExprId>,
    /// The conditions under which contacts close, and whose rise unlocks latches; `None` where nothing is declared.
    pub(in crate::derive) conditions: [Vec<Option<ExprId>>; 2],
    /// The reactions of permanent constraints that load grips without forces of contacts, each before its derivatives by these.
    pub(in crate::derive) loads: Vec<ExprId>,
    pub(in crate::derive) restitutions: Vec<ExprId>,
    /// The functions of the switches.
    pub(in crate::derive) switches: Vec<ExprId>,
    /// The functions of the resets.
    pub(in crate::derive) resets: Vec<ExprId>,
    /// The new values of all resets, one behind the other.
    pub(in crate::derive) given: Vec<ExprId>,
    /// The outputs with the forces of contacts.
    pub(in crate::derive) outputs: Vec<ExprId>,
}

/// The equations of the contacts of a system.
pub(in crate::derive) struct ContactEquations {
    /// The motion in several equal forms, the cheapest first.
    pub(in crate::derive) motions: Vec<FreeMotion>,
    pub(in crate::derive) functions: ContactFunctions,
}

impl FreeMotion {
    /// All expressions, to be replaced in place.
    pub(in crate::derive) fn expressions(&mut self) -> impl Iterator<Item = &mut ExprId> {
        let lists = [&mut self.rates, &mut self.biases, &mut self.delassus];
        lists.into_iter().chain(&mut self.responses).flatten()
    }

    /// The results of the program of the free motion, in its order.
    pub(super) fn list(&self, functions: &ContactFunctions) -> Vec<ExprId> {
        let ContactFunctions { gaps, rows, friction, stiction, limits, .. } = functions;
        let mut list = [&self.rates[..], gaps, rows, &self.biases, &self.delassus].concat();
        list.extend(self.responses.iter().flatten());
        list.extend([friction, stiction, limits].into_iter().flatten());
        list
    }
}

impl ContactFunctions {
    /// All expressions, to be replaced in place.
    pub(in crate::derive) fn expressions(&mut self) -> impl Iterator<Item = &mut ExprId> {
        let [when, release] = &mut self.conditions;
        let lists = [
            &mut self.gaps,
            &mut self.rows,
            &mut self.drifts,
            &mut self.friction,
            &mut self.stiction,
            &mut self.limits,
            &mut self.loads,
            &mut self.restitutions,
            &mut self.switches,
            &mut self.resets,
            &mut self.given,
            &mut self.outputs,
        ];
        lists.into_iter().flatten().chain(when.iter_mut().chain(release).flatten())
    }
}

/// The lists of equal expressions that the optimiser looks at.
const LISTS: usize = 2;

/// Derives the equations, with constants at the values that a scene fixes; `None` after a fault.
pub(in crate::derive) fn derive(
    model: &mut Model<'_>,
    contacts: &Contacts<'_>,
    fixed: Option<(&Derivation, &[(ExprId, ExprId)])>,
    faults: &mut Faults,
) -> Option<ContactEquations> {
    model.bench.begin_another();
    let mechanics = match fixed {
        Some((whole, values)) => fixed::at_values(&mut model.bench, &contacts.mechanics, whole, values),
        None => contacts.mechanics.clone(),
    };
    let mut derivation = match Derivation::new(&mut model.bench, mechanics) {
        Ok(derivation) => derivation,
        Err(error) => {
            faults::report(model, error, faults);
            return None;
        }
    };
    let bench = &mut model.bench;
    let l = derivation.system.forms.degrees;
    let etas: Vec<ExprId> = derivation.system.etas[..l].to_vec();
    let zero = bench.graph.zero();
    let values = fixed.map_or(&[][..], |(_, values)| values);
    let mut at_values = Substitution::new(values.iter().copied());
    let written: Vec<ExprId> = contacts.rows().map(|row| row.form).collect();
    let rows: Vec<ExprId> = written
        .into_iter()
        .map(|form| {
            let form = at_values.of(&mut bench.graph, form);
            let row = derivation.frame.constrain.of(&mut bench.graph, form);
            bench.tidy(row)
        })
        .collect();
    check(model, contacts, &derivation, &rows, faults)?;
    let bench = &mut model.bench;
    let mut at_rest = Substitution::new(etas.iter().map(|eta| (*eta, zero)));
    let drifts: Vec<ExprId> = rows
        .iter()
        .map(|row| {
            let drift = at_rest.of(&mut bench.graph, *row);
            bench.tidy(drift)
        })
        .collect();
    let or_zero = |e: Option<ExprId>| e.unwrap_or(zero);
    // A limit that is written out needs no coefficient.
    let coefficients = |of: fn(&crate::model::ContactEntry<'_>) -> Option<ExprId>| {
        let entries = contacts.entries.iter().map(move |entry| match entry.kind {
            ContactKind::Grip if entry.loaded_by.is_none() && entry.load_reaction.is_none() => zero,
            _ => or_zero(of(entry)),
        });
        entries.collect::<Vec<ExprId>>()
    };
    let entries = || contacts.entries.iter();
    let gap = |entry: &crate::model::ContactEntry<'_>| match entry.kind {
        ContactKind::Grip => zero,
        _ => or_zero(entry.gap),
    };
    let loading = contacts.entries.iter().filter(|entry| entry.load_reaction.is_some()).count();
    // They come after the outputs.
    let reactions = derivation.outputs.split_off(derivation.outputs.len() - loading);
    let forces: Vec<ExprId> = contacts.rows().map(|row| row.force).collect();
    let loads = affine(bench, &forces, &reactions);
    let mut functions = ContactFunctions {
        gaps: entries().map(gap).collect(),
        rows: rows.clone(),
        drifts,
        friction: coefficients(|entry| entry.friction),
        stiction: coefficients(|entry| entry.stiction),
        limits: entries().map(|entry| or_zero(entry.limit)).collect(),
        conditions: [
            entries().map(|entry| entry.when).collect(),
            entries().map(|entry| entry.release).collect(),
        ],
        loads,
        restitutions: entries().map(|entry| entry.restitution).collect(),
        switches: contacts.switches.iter().map(|switch| switch.function).collect(),
        resets: contacts.resets.iter().map(|reset| reset.function).collect(),
        given: contacts.resets.iter().flat_map(|reset| &reset.assignments).map(|(_, value)| *value).collect(),
        outputs: derivation.outputs.clone(),
    };
    let constrain = &mut derivation.frame.constrain;
    for e in functions.expressions() {
        let value = at_values.of(&mut bench.graph, *e);
        *e = constrain.of(&mut bench.graph, value);
    }
    let mut motions: Vec<(u64, FreeMotion)> = Vec::new();
    for place in 0..derivation.formulations.len() {
        let rates = derivation.formulations[place].rates.clone();
        let mut motion = free_motion(model, contacts, &derivation, &rows, &rates);
        let constrain = &mut derivation.frame.constrain;
        let bench = &mut model.bench;
        motion.expressions().for_each(|e| *e = constrain.of(&mut bench.graph, *e));
        motions.push((weighted_cost(&bench.graph, &motion.list(&functions)), motion));
    }
    motions.sort_by_key(|(cost, _)| *cost);
    motions.truncate(LISTS);
    let motions = motions.into_iter().map(|(_, motion)| motion).collect();
    Some(ContactEquations { motions, functions })
}

/// Each of some expressions without forces, before its derivatives by them, in which it is linear.
pub(in crate::derive) fn affine(
    bench: &mut Workbench,
    forces: &[ExprId],
    expressions: &[ExprId],
) -> Vec<ExprId> {
    let zero = bench.graph.zero();
    let mut unpressed = Substitution::new(forces.iter().map(|force| (*force, zero)));
    let mut found = Vec::new();
    for e in expressions {
        let free = unpressed.of(&mut bench.graph, *e);
        found.push(bench.keep_large(free));
        for force in forces {
            let slope = Flow::partial(&bench.graph, *force).of(&mut bench.graph, *e);
            let slope = unpressed.of(&mut bench.graph, slope);
            let slope = bench.tidy(slope);
            found.push(bench.keep_large(slope));
        }
    }
    found
}

/// Reports rows that no force can hold, and states whose rates depend on forces of contacts.
fn check(
    model: &mut Model<'_>,
    contacts: &Contacts<'_>,
    derivation: &Derivation,
    rows: &[ExprId],
    faults: &mut Faults,
) -> Option<()> {
    let bench = &mut model.bench;
    let (n, l) = (model.coordinates.len(), derivation.system.forms.degrees);
    let before = faults.count();
    // Those of an outline have one coordinate for gap and slip, because no mode of it is ever solved.
    if !model.declaration.is_outline {
        let instances = &model.declaration.instances;
        rows::check(bench, contacts, instances, (rows, &derivation.system.etas[..l]), faults);
    }
    if faults.count() > before {
        return None;
    }
    // In an impact a contact force is an impulse, so that a rate that depends on it has no value there.
    for (state, rate) in model.states.iter().zip(&derivation.formulations[0].rates[n + l..]) {
        let pressed = contacts.rows().any(|row| {
            let slope = Flow::partial(&bench.graph, row.force).of(&mut bench.graph, *rate);
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
    (faults.count() == before).then_some(())
}

/// The motion of which some rates with the forces of contacts tell.
fn free_motion(
    model: &mut Model<'_>,
    contacts: &Contacts<'_>,
    derivation: &Derivation,
    rows: &[ExprId],
    pressed: &[ExprId],
) -> FreeMotion {
    let bench = &mut model.bench;
    let (n, l) = (model.coordinates.len(), derivation.system.forms.degrees);
    let etas = &derivation.system.etas[..l];
    let zero = bench.graph.zero();
    let forces: Vec<ExprId> = contacts.rows().map(|row| row.force).collect();
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
    let mut unpressed = Substitution::new(forces.iter().map(|force| (*force, zero)));
    let rates: Vec<ExprId> = pressed
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
            pressed[n..]
                .iter()
                .map(|rate| {
                    let slope = by.of(&mut bench.graph, *rate);
                    let slope = unpressed.of(&mut bench.graph, slope);
                    let slope = bench.tidy(slope);
                    bench.keep_large(slope)
                })
                .collect()
        })
        .collect();
    let coordinates = model.mechanics.forms.coordinates.iter();
    let moving = coordinates.chain(etas).copied().zip(rates.iter().copied());
    let moving = moving.chain([(model.mechanics.forms.time, bench.graph.one())]);
    let mut along = Flow::new(&bench.graph, moving.collect::<Vec<_>>());
    let biases: Vec<ExprId> = rows.iter().map(|row| along.of(&mut bench.graph, *row)).collect();
    let mut delassus = Vec::new();
    for (w, response) in responses.iter().enumerate() {
        for column in &columns[..=w] {
            let entry = bench.dot(column, &response[..l]);
            delassus.push(bench.tidy(entry));
        }
    }
    FreeMotion { rates, biases, delassus, responses }
}
