//! The functions of a scene.

use guen_symbolic::{Contracted, Dependence, Derivation, ExprId, Graph, Substitution, Workbench};

use super::domain::{constant_pivots, domain, reason, written};
use super::formulas::{self, Quantity};
use crate::derive::brackets::commutator::Commutator;
use crate::derive::function;
use crate::derive::selections::fixed::Holding;
use crate::derive::selections::manifold::Replacement;
use crate::derive::selections::selection::{Selection, StatePart};
use crate::model::Model;

/// A function of a scene: its name, the places of its results in the function of the whole system if that has all of them, and
/// the results.
pub(in crate::derive) struct Part {
    pub(in crate::derive) name: &'static str,
    pub(in crate::derive) places: Option<Vec<usize>>,
    pub(in crate::derive) outputs: Vec<ExprId>,
}

/// The functions of a scene.
pub(in crate::derive) struct Functions {
    pub(in crate::derive) parts: Vec<Part>,
    /// The functions that must not vanish, and each of them in words.
    pub(in crate::derive) domain: Vec<ExprId>,
    pub(in crate::derive) domain_names: Vec<String>,
    /// The reason for each of them: what degenerates where it vanishes, and at which states.
    pub(in crate::derive) domain_reasons: Vec<String>,
    /// Expressions of constants that must not vanish.
    pub(in crate::derive) constant_pivots: Vec<ExprId>,
}

impl Functions {
    /// Returns the quantities that the functions compute if these divisors must not vanish either.
    pub(in crate::derive) fn with_divisors(
        &self,
        divisors: &[(ExprId, String)],
        graph: &Graph,
    ) -> Vec<Quantity> {
        let (constants, singularities): (Vec<ExprId>, Vec<ExprId>) =
            divisors.iter().map(|(e, _)| *e).partition(|e| graph.roles(*e).is_constant());
        let mut all: Vec<Quantity> =
            self.parts.iter().map(|part| (part.name, part.outputs.clone())).collect();
        for (name, further) in [(function::DOMAIN, singularities), (function::PIVOTS, constants)] {
            match all.iter_mut().find(|(known, _)| *known == name) {
                Some((_, outputs)) => outputs.extend(further),
                None => all.push((name, further)),
            }
        }
        all
    }
}

/// An expression with several replacements made. One can bring in what another replaces, so that they are made again
/// while that changes something; as often as there are of them, since each is to leave for good.
pub(in crate::derive) fn replaced(
    bench: &mut Workbench,
    replacements: &mut [Replacement],
    mut e: ExprId,
) -> ExprId {
    for _ in 0..replacements.len() {
        let image = replacements.iter_mut().fold(e, |e, replacement| replacement.of(bench, e));
        if image == e {
            break;
        }
        e = image;
    }
    e
}

/// Expressions of the whole system as a scene sees them.
pub(in crate::derive) struct View {
    pub(in crate::derive) holding: Holding,
    pub(in crate::derive) replacements: Vec<Replacement>,
    pub(in crate::derive) dependence: Dependence,
    /// Symbols that left.
    pub(in crate::derive) idle: Vec<ExprId>,
}

impl View {
    /// Returns an expression with held variables as constants and eliminated ones replaced.
    pub(in crate::derive) fn replaced(&mut self, model: &mut Model<'_>, e: ExprId) -> ExprId {
        let e = self.holding.of(&mut model.bench, e);
        replaced(&mut model.bench, &mut self.replacements, e)
    }

    /// Returns an expression without the variables that left.
    pub(in crate::derive) fn of(&mut self, model: &mut Model<'_>, e: ExprId) -> ExprId {
        let e = self.replaced(model, e);
        self.dependence.without_idle(&mut model.bench, e, &self.idle)
    }

    /// Whether an expression depends on something that left.
    pub(in crate::derive) fn is_lost(&mut self, model: &mut Model<'_>, e: ExprId) -> bool {
        self.idle.iter().any(|symbol| self.dependence.depends(&mut model.bench, e, *symbol))
    }
}

/// The functions of a scene.
pub(in crate::derive) fn parts(
    model: &mut Model<'_>,
    derivation: &Derivation,
    brackets: &[Commutator],
    selection: &Selection,
    shown: &Contracted,
    view: &mut View,
    determined_values: &[ExprId],
) -> Functions {
    let l = derivation.system.forms.degrees;
    let n = model.coordinates.len();
    let chart = domain(model, derivation, shown);
    let pivots = constant_pivots(derivation);
    let functions = chart.iter().map(|singularity| singularity.function).collect();
    let whole = formulas::whole(model, derivation, brackets, functions, pivots.clone());
    let mut parts = Vec::new();
    let outputs = |name: &str| {
        whole.iter().find(|(known, _)| *known == name).map_or(&[][..], |(_, outputs)| &outputs[..])
    };
    let mut push = |model: &mut Model<'_>, view: &mut View, name: &'static str, places: Vec<usize>| {
        let outputs = places.iter().map(|place| view.of(model, outputs(name)[*place])).collect();
        if !places.is_empty() {
            parts.push(Part { name, places: Some(places), outputs });
        }
    };
    push(model, view, function::ENERGY, selection.energy.then_some(0).into_iter().collect());
    let components = selection.outputs.iter().flat_map(|o| model.outputs[*o].components.clone()).collect();
    push(model, view, function::OUTPUTS, components);
    let holonomic = derivation.system.holonomic.len();
    let count = holonomic + derivation.system.redundant.len();
    let redundant = selection.redundant.iter().map(|r| holonomic + r);
    let equations: Vec<usize> = selection.holonomic.iter().copied().chain(redundant).collect();
    push(model, view, function::POSITIONS, equations.clone());
    let rows = equations.iter().flat_map(|h| selection.coordinates.iter().map(move |i| count + h * n + i));
    let rows: Vec<usize> = rows.collect();
    push(model, view, function::GRADIENTS, [equations, rows].concat());

    // Of the chart's functions those that the scene's variables determine; what became constant is a pivot.
    let (mut determined, mut domain) = (Vec::new(), Vec::new());
    let (mut domain_names, mut domain_reasons) = (Vec::new(), Vec::new());
    let mut constants: Vec<(Option<usize>, ExprId)> = Vec::new();
    for (place, pivot) in pivots.iter().enumerate() {
        constants.push((Some(place), view.holding.of(&mut model.bench, *pivot)));
    }
    for (place, singularity) in chart.into_iter().enumerate() {
        let seen = view.replaced(model, singularity.function);
        if view.is_lost(model, seen) {
            continue;
        }
        let seen = view.of(model, seen);
        // Of squares that add up to one the sum has roundings of its own, which grow with the angle.
        let image = shown.image(seen);
        if model.bench.graph.roles(image).is_constant() {
            constants.push((None, image));
        } else {
            determined.push(place);
            domain.push(seen);
            // The function of the scene differs from that of the whole system, whose formula mentions coordinates that the scene lacks.
            let text = match seen == singularity.function {
                true => singularity.text,
                false => written(model, seen, &singularity.words),
            };
            domain_names.push(text);
            domain_reasons.push(reason(&model.bench.graph, shown.image(seen), &singularity.origin));
        }
    }
    push(model, view, function::DOMAIN, determined);
    constants.retain(|(_, e)| model.bench.graph.as_number(*e).is_none());
    let constant_pivots: Vec<ExprId> = constants.iter().map(|(_, e)| *e).collect();
    if !constants.is_empty() {
        // A function of the chart that became constant in the scene is not among the pivots of the whole system.
        let places = constants.iter().map(|(place, _)| *place).collect();
        parts.push(Part { name: function::PIVOTS, places, outputs: constant_pivots.clone() });
    }
    if !selection.reactions.is_empty() {
        let known: Vec<usize> =
            (0..model.forms.len() - l).filter(|v| derivation.reactions[*v].is_some()).collect();
        let place = |v: &usize| known.iter().position(|other| *other == v - l);
        let places: Vec<usize> = selection.reactions.iter().filter_map(place).collect();
        let outputs = selection.reactions.iter().filter_map(|v| derivation.reactions[v - l]);
        let outputs: Vec<ExprId> = outputs.collect();
        let outputs = outputs.into_iter().map(|e| reaction(model, derivation, selection, view, e)).collect();
        parts.push(Part { name: function::REACTIONS, places: Some(places), outputs });
    }
    if selection.operators {
        // Operators act on functions of all coordinates, whatever the scene's state is.
        for name in [function::OPERATORS, function::BRACKETS] {
            let outputs = outputs(name).to_vec();
            parts.push(Part { name, places: Some((0..outputs.len()).collect()), outputs });
        }
    }
    if !determined_values.is_empty() {
        let outputs = determined_values.iter().map(|e| view.of(model, *e)).collect();
        parts.push(Part { name: function::DETERMINED, places: None, outputs });
    }
    Functions { parts, domain, domain_names, domain_reasons, constant_pivots }
}

/// A reaction with the accelerations of the kept parameters as they are computed, and the others written out.
fn reaction(
    model: &mut Model<'_>,
    derivation: &Derivation,
    selection: &Selection,
    view: &mut View,
    e: ExprId,
) -> ExprId {
    let solved = |parameters: &mut dyn Iterator<Item = usize>| {
        let (symbols, values) = (&derivation.system.accelerations, &derivation.solution.accelerations);
        Substitution::new(parameters.map(|s| (symbols[s], values[s])))
    };
    let l = derivation.system.forms.degrees;
    let held: Vec<usize> = selection
        .held
        .iter()
        .filter_map(|held| match model.part(held.place) {
            StatePart::Parameter(s) => Some(s),
            _ => None,
        })
        .collect();
    let left = |s: &usize| !selection.parameters.contains(s) && !held.contains(s);
    let partly = solved(&mut (0..l).filter(left)).of(&mut model.bench.graph, e);
    let partly = view.of(model, partly);
    if !view.is_lost(model, partly) {
        return partly;
    }
    let wholly = solved(&mut (0..l).filter(|s| !held.contains(s))).of(&mut model.bench.graph, e);
    view.of(model, wholly)
}
