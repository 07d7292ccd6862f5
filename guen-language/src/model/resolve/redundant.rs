//! Holonomic equations that follow from others wherever all of them hold: no forms, and watched with the others.

use guen_symbolic::{ExprId, Redundant};

use crate::diagnostics::Fault;
use crate::model::RedundantEntry;
use crate::model::evaluate::Evaluator;
use crate::model::forms::RawForm;
use crate::names::quoted;

/// An equation that is no form.
pub(super) struct Taken<'a> {
    pub(super) entry: RedundantEntry<'a>,
    pub(super) equation: ExprId,
    /// The symbol of its rate, which energies, forces and outputs may mention, and what it is in velocities.
    pub(super) rate: (ExprId, ExprId),
}

/// Takes what follows from others out of the forms, each with its equation, and makes the manifold that of the others.
pub(super) fn taken<'a>(
    eval: &mut Evaluator<'_>,
    raw: &mut Vec<RawForm<'a>>,
    coordinates: &[ExprId],
    degrees: usize,
) -> Vec<Taken<'a>> {
    let places: Vec<usize> = (0..raw.len()).filter(|form| raw[*form].position.is_some()).collect();
    let positions: Vec<ExprId> = raw.iter().filter_map(|form| form.position).collect();
    let bench = &mut eval.bench;
    let found = bench.zero.redundant(&mut bench.graph, &positions, coordinates);
    // The steps of this search do not count towards the limit of the derivation.
    bench.begin_another();
    if found.is_empty() {
        return Vec::new();
    }
    let gone: Vec<usize> = found.iter().map(|redundant| places[redundant.equation]).collect();
    // The place of a form when those before it are gone.
    let now = |form: usize| form - gone.iter().filter(|gone| **gone < form).count();
    let asked = &eval.motion.reactions;
    for (Redundant { beside, .. }, form) in found.iter().zip(&gone) {
        let symbol = raw[*form].symbol;
        if let Some((.., span)) = asked.iter().find(|(eta, ..)| *eta == symbol) {
            let names = quoted(beside.iter().map(|k| raw[places[*k]].entry.name.as_str()));
            let name = &raw[*form].entry.name;
            let fault = Fault::new(*span, format!("the reaction of `{name}` is not determined"));
            let note = format!(
                "where all hold, `{name}` follows from {names}: only the sum of their reactions is determined"
            );
            eval.faults.report(fault.note(note));
        }
    }
    // Vectors of forms know their components by their places among the constraints.
    eval.vectors.retain(|(parameters, places)| {
        *parameters || places.iter().flatten().all(|own| !gone.contains(&(own + degrees)))
    });
    for (_, places) in eval.vectors.iter_mut().filter(|(parameters, _)| !parameters) {
        places.iter_mut().flatten().for_each(|own| *own = now(*own + degrees) - degrees);
    }
    let besides = found.iter().map(|redundant| redundant.beside.iter().map(|k| now(places[*k])).collect());
    let besides: Vec<Vec<usize>> = besides.collect();
    let mut taken = Vec::new();
    for (form, beside) in gone.iter().zip(besides).rev() {
        let form = raw.remove(*form);
        let equation = form.position.expect("what follows from positions is one");
        let rate = (form.symbol, eval.expanded(form.definition));
        taken.push(Taken { entry: RedundantEntry { entry: form.entry, beside }, equation, rate });
    }
    taken.reverse();
    let positions: Vec<ExprId> = raw.iter().filter_map(|form| form.position).collect();
    let bench = &mut eval.bench;
    bench.zero.set_manifold(&mut bench.graph, &positions);
    bench.begin_another();
    taken
}
