//! The formulas of the whole system, function by function: what scenes choose from.

use guen_symbolic::{Derivation, ExprId};

use crate::derive::brackets::commutator::Commutator;
use crate::derive::function;
use crate::model::Model;

/// A function beside the right-hand side, by its name, and what it computes.
pub(crate) type Quantity = (&'static str, Vec<ExprId>);

/// The rates of the whole state in several equal forms: as shown, then as the optimiser may like them better. Where there are some
/// by the spins of bodies, these alone: next to an edge of the parameters, or of their mass matrix, digits are lost by all
/// others.
pub(in crate::derive) fn rates(derivation: &Derivation) -> Vec<Vec<ExprId>> {
    let is_wanted = derivation.formulations.iter().any(|formulated| formulated.is_by_spins);
    let wanted = derivation.formulations.iter().filter(|formulated| formulated.is_by_spins || !is_wanted);
    wanted.map(|formulated| formulated.rates.clone()).collect()
}

/// Returns all other functions, in the order in which they are built.
pub(in crate::derive) fn whole(
    model: &mut Model<'_>,
    derivation: &Derivation,
    brackets: &[Commutator],
    domain: Vec<ExprId>,
    pivots: Vec<ExprId>,
) -> Vec<Quantity> {
    let bench = &mut model.bench;
    let system = &derivation.system;
    let forms = system.forms.forms.iter().map(|form| {
        let linear = bench.dot(&form.row, &system.velocities);
        bench.graph.add(linear, form.offset)
    });
    let forms = forms.collect();
    let energies = &derivation.energies;
    let known = energies.momenta.iter().zip(&derivation.known_momentum);
    let momenta = known.filter(|(_, known)| **known).map(|(e, _)| *e).collect();
    let positions = system.holonomic.iter().map(|h| h.equation).chain(system.redundant.iter().copied());
    let positions: Vec<ExprId> = positions.collect();
    let rows = system.holonomic.iter().flat_map(|h| &system.forms.forms[h.form].row);
    let mut gradients: Vec<ExprId> = positions.iter().chain(rows).copied().collect();
    for equation in &system.redundant {
        gradients.extend(system.forms.coordinates.iter().map(|x| bench.partial(*equation, *x)));
    }
    let mut quantities = vec![
        (function::VELOCITIES, derivation.frame.velocities.clone()),
        (function::FORMS, forms),
        (function::ENERGY, vec![energies.integral]),
        (function::KINETIC_ENERGY, vec![energies.kinetic]),
        (function::FORCE_FUNCTION, vec![system.force_function]),
        (function::MOMENTA, momenta),
        (function::REACTIONS, derivation.reactions.iter().flatten().copied().collect()),
        (function::POWER, vec![derivation.power]),
        (function::OUTPUTS, derivation.outputs.clone()),
        (function::POSITIONS, positions),
    ];
    if !gradients.is_empty() {
        quantities.push((function::GRADIENTS, gradients));
    }
    quantities.push((function::DOMAIN, domain));
    quantities.push((function::PIVOTS, pivots));
    // All operators in one function, and all brackets in another: they share the inverse of the forms.
    quantities.push((function::OPERATORS, derivation.frame.operators.xi.concat()));
    let coefficients = brackets.iter().flat_map(|bracket| &bracket.coefficients);
    quantities.push((function::BRACKETS, coefficients.copied().collect()));
    quantities
}

/// Centers and orientations of the bodies, then the positions of the particles.
pub(in crate::derive) fn placed(model: &Model<'_>) -> Vec<ExprId> {
    let bodies = model.bodies.iter().flat_map(|body| {
        let center = body.center.iter().flatten();
        center.chain(body.orientation.iter().flatten().flatten())
    });
    bodies.chain(model.particles.iter().flat_map(|(_, position)| position)).copied().collect()
}
