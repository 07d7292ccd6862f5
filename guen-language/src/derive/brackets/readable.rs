//! The written form of a derivation: energies and momenta as polynomials where that is cheaper, the equations as expressions that
//! vanish, sines and cosines of sums.

use guen_symbolic::{
    Contracted, Derivation, ExprId, Graph, Limits, Workbench, normal_coefficients, weighted_cost,
};

use super::commutator::Commutator;
use crate::model::Model;

/// `sum_t M_st eta_t' - f_s`.
pub(in crate::derive) fn equations(bench: &mut Workbench, derivation: &Derivation) -> Vec<ExprId> {
    let rows = derivation.equations.mass.iter().zip(&derivation.equations.forces);
    let rows = rows.map(|(row, force)| {
        let inertia = bench.dot(row, &derivation.system.accelerations);
        bench.graph.sub(inertia, *force)
    });
    rows.collect()
}

/// Returns the notation of a derivation in the report, with sines and cosines of sums.
pub(in crate::derive) fn shown(
    model: &mut Model<'_>,
    derivation: &Derivation,
    brackets: &[Commutator],
    others: &[ExprId],
) -> Contracted {
    let (operators, energies) = (&derivation.frame.operators, &derivation.energies);
    let forms = &derivation.system.forms.forms;
    let lists = operators
        .xi
        .iter()
        .chain(brackets.iter().map(|bracket| &bracket.coefficients))
        .chain(forms.iter().map(|form| &form.row))
        .chain([
            &derivation.frame.velocities,
            &operators.chart,
            &derivation.solution.pivots,
            &energies.momenta,
        ]);
    let single = [energies.kinetic, energies.integral, derivation.system.force_function, derivation.power];
    let offsets = forms.iter().map(|form| form.offset);
    let roots: Vec<ExprId> = lists.flatten().chain(others).copied().chain(single).chain(offsets).collect();
    Contracted::of(&mut model.bench.graph, &roots)
}

/// Energies, momenta and reactions as polynomials in the quasi-velocities, where that is cheaper.
pub(in crate::derive) fn polish(bench: &mut Workbench, derivation: &mut Derivation) {
    let system = &derivation.system;
    let variables: Vec<ExprId> = system.accelerations.iter().chain(&system.etas).copied().collect();
    // A larger expression is read by nobody, and rarely gets cheaper.
    let limits = Limits { nodes: 400, steps: 6_000, ..Limits::default() };
    let in_angles = |graph: &mut Graph, e: ExprId| {
        let Some(coefficients) = normal_coefficients(graph, e, &variables, &limits) else { return e };
        let terms: Vec<ExprId> = coefficients
            .into_iter()
            .map(|(exponents, c)| {
                let factors = variables.iter().zip(exponents).map(|(x, k)| (*x, k as i32));
                let factors: Vec<_> = factors.chain([(c, 1)]).collect();
                graph.product(&factors)
            })
            .collect();
        let sum = graph.sum(terms);
        if weighted_cost(graph, &[sum]) <= weighted_cost(graph, &[e]) { sum } else { e }
    };
    let mut polished = |e: ExprId| {
        let here = in_angles(&mut bench.graph, e);
        if bench.graph.is_in_base_angles(e) {
            return here;
        }
        let own = bench.in_base_angles(&[e], |bench| in_angles(&mut bench.graph, e));
        let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
        if cost(own) < cost(here) { own } else { here }
    };
    let energies = &mut derivation.energies;
    energies.kinetic = polished(energies.kinetic);
    energies.integral = polished(energies.integral);
    for momentum in &mut energies.momenta {
        *momentum = polished(*momentum);
    }
    for reaction in derivation.reactions.iter_mut().flatten() {
        *reaction = polished(*reaction);
    }
    derivation.power = polished(derivation.power);
}
