//! The straight-line code of a level: the rates in several equal forms, of which the cheapest is taken, and everything else.

use guen_symbolic::{
    Derivation, ExprId, Limits, ProgramBuilder, Programs, Workbench, normal_form, weighted_cost,
};

use super::formulas::Quantity;
use crate::derive::function;
use crate::derive::thresholds::{PROMISING_FORM, SHARED_REACTIONS, WRITTEN_OUT_RATES};
use crate::model::Model;

/// Adds further forms of the first list of rates, and drops those that are too expensive to be looked at.
pub(in crate::derive) fn extend(bench: &mut Workbench, lists: &mut Vec<Vec<ExprId>>) {
    let mut estimates: Vec<u64> = lists.iter().map(|list| weighted_cost(&bench.graph, list)).collect();
    let best = (0..lists.len()).min_by_key(|i| estimates[*i]).unwrap_or_default();
    if estimates[best] <= WRITTEN_OUT_RATES {
        let limits = Limits::default();
        let written_out: Vec<ExprId> =
            lists[best].iter().map(|e| normal_form(&mut bench.graph, *e, &limits).unwrap_or(*e)).collect();
        estimates.insert(1, weighted_cost(&bench.graph, &written_out));
        lists.insert(1, written_out);
    }
    let (times, of) = PROMISING_FORM;
    let most = times * estimates.iter().copied().min().unwrap_or_default() / of;
    let mut estimate = estimates.into_iter();
    lists.retain(|_| estimate.next().is_some_and(|cost| cost <= most));
}

/// The code of the rates, given in several equal forms, and of everything else.
pub(in crate::derive) fn programs(
    bench: &mut Workbench,
    rates: &[Vec<ExprId>],
    quantities: &[Quantity],
) -> Programs {
    let quantity =
        |name: &str| quantities.iter().find(|(known, _)| *known == name).map(|(_, outputs)| outputs);
    // The covector is the reactions times the rows of their constraints: where they are large one program is made, and divided.
    let reactions =
        quantity(function::REACTIONS).filter(|list| weighted_cost(&bench.graph, list) > SHARED_REACTIONS);
    let both = reactions.zip(quantity(function::REACTION_COVECTOR));
    let mut builder = ProgramBuilder::new(&mut bench.graph);
    if !rates.is_empty() {
        builder.add_equal(function::RHS, rates);
    }
    for (name, outputs) in quantities.iter().filter(|(_, outputs)| !outputs.is_empty()) {
        match (*name, both) {
            (function::REACTIONS, Some(_)) => {}
            (function::REACTION_COVECTOR, Some((reactions, covector))) => {
                builder.add_cold(name, &[&covector[..], reactions].concat());
            }
            _ => builder.add_cold(name, outputs),
        }
    }
    let mut programs = builder.finish();
    if let Some((_, covector)) = both {
        programs.divide(function::REACTION_COVECTOR, covector.len(), function::REACTIONS);
    }
    programs
}

/// The mass matrix by itself, out of the equations apart, unless it is diagonal: then it has no condition to measure.
pub(in crate::derive) fn add_mass(programs: &mut Programs, model: &Model<'_>, derivation: &Derivation) {
    let mass = &derivation.equations.mass;
    let l = mass.len();
    let graph = &model.bench.graph;
    let coupled = (0..l).any(|s| (0..s).any(|k| !graph.is_zero(mass[s][k])));
    if coupled {
        programs.add_excerpt(function::MASS, function::MASS_FORM, 0..l * (l + 1) / 2);
    }
}
