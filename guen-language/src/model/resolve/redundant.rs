//! Rows that follow from others wherever all holonomic equations hold: no forms. Equations on positions are watched with the others.

use guen_symbolic::{ExprId, Form, Redundant};

use crate::diagnostics::Fault;
use crate::model::RedundantEntry;
use crate::model::evaluate::Evaluator;
use crate::model::forms::RawForm;
use crate::names::quoted;

/// A row that is no form.
pub(super) struct Taken<'a> {
    pub(super) entry: RedundantEntry<'a>,
    /// `f(t, x)` of a holonomic one.
    pub(super) equation: Option<ExprId>,
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
    let found = found.into_iter().map(|Redundant { equation, beside }| Redundant {
        equation: places[equation],
        beside: beside.into_iter().map(|k| places[k]).collect(),
    });
    let taken = removed(eval, raw, found.collect(), degrees);
    let positions: Vec<ExprId> = raw.iter().filter_map(|form| form.position).collect();
    let bench = &mut eval.bench;
    bench.zero.set_manifold(&mut bench.graph, &positions);
    bench.begin_another();
    taken
}

/// Takes rows of velocities that follow from others on the manifold out of the forms.
pub(super) fn taken_rows<'a>(
    eval: &mut Evaluator<'_>,
    raw: &mut Vec<RawForm<'a>>,
    forms: &mut Vec<(Form, ExprId)>,
    degrees: usize,
) -> Vec<Taken<'a>> {
    let places: Vec<usize> = (degrees..raw.len()).collect();
    let stays: Vec<bool> = places.iter().map(|form| raw[*form].position.is_some()).collect();
    if stays.iter().all(|stays| *stays) || !stays.contains(&true) {
        return Vec::new();
    }
    let rows: Vec<(Vec<ExprId>, ExprId)> =
        places.iter().map(|form| (forms[*form].0.row.clone(), forms[*form].0.offset)).collect();
    let bench = &mut eval.bench;
    let mut found = bench.zero.redundant_rows(&mut bench.graph, &rows, &stays);
    // The steps of this search do not count towards the limit of the derivation.
    bench.begin_another();
    if found.is_empty() {
        return Vec::new();
    }
    for Redundant { equation, beside } in &mut found {
        *equation += degrees;
        beside.iter_mut().for_each(|k| *k += degrees);
    }
    for Redundant { equation, .. } in found.iter().rev() {
        forms.remove(*equation);
    }
    removed(eval, raw, found, degrees)
}

/// Takes redundant forms out, each with its equation.
fn removed<'a>(
    eval: &mut Evaluator<'_>,
    raw: &mut Vec<RawForm<'a>>,
    found: Vec<Redundant>,
    degrees: usize,
) -> Vec<Taken<'a>> {
    let gone: Vec<usize> = found.iter().map(|redundant| redundant.equation).collect();
    // The place of a form when those before it are gone.
    let now = |form: usize| form - gone.iter().filter(|gone| **gone < form).count();
    let asked = &eval.motion.reactions;
    for Redundant { beside, equation: form } in &found {
        let symbol = raw[*form].symbol;
        if let Some((.., span)) = asked.iter().find(|(eta, ..)| *eta == symbol) {
            let names = quoted(beside.iter().map(|k| raw[*k].entry.name.as_str()));
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
    let besides = found.iter().map(|redundant| redundant.beside.iter().map(|k| now(*k)).collect());
    let besides: Vec<Vec<usize>> = besides.collect();
    let mut taken = Vec::new();
    for (form, beside) in gone.iter().zip(besides).rev() {
        let form = raw.remove(*form);
        let rate = (form.symbol, eval.expanded(form.definition));
        let entry = RedundantEntry { entry: form.entry, beside };
        taken.push(Taken { entry, equation: form.position, rate });
    }
    taken.reverse();
    taken
}
