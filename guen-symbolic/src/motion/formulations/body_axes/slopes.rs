//! Components of velocities in normal form, and their rates from their derivatives along the operators.
//!
//! Along the motion the rates of angles next to a pole are huge, and cancel in sums that no program finds. Along each operator,
//! in normal form, they are not there.

use crate::algebra::ExprId;
use crate::motion::coordinates::restriction::{Restriction, written_out};
use crate::motion::thresholds::{COMPONENT_TERMS, COMPONENTS_DIFFERENTIATED};
use crate::normal::{Limits, normal_form};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The limits of a component in a body's axes: the operators are multiplied out for it.
const COMPONENT: Limits = Limits { terms: 400, generators: 32, degree: 48, nodes: 800, steps: 60_000 };

/// A component in normal form, nothing in it kept whole; `None` beyond the limits.
pub(super) fn normal(bench: &mut Workbench, restriction: &mut Restriction, e: ExprId) -> Option<ExprId> {
    let normal = normal_written_out(bench, restriction, e)?;
    // The sign stays outside, so that a component and its negative are computed once.
    let (coefficient, component) = bench.graph.split_coefficient(normal);
    let kept = bench.keep_above(component, COMPONENT_TERMS);
    Some(bench.graph.scale(kept, &coefficient))
}

fn normal_written_out(bench: &mut Workbench, restriction: &mut Restriction, e: ExprId) -> Option<ExprId> {
    if bench.graph.is_zero(e) {
        return Some(e);
    }
    let open = written_out(bench, e);
    restriction.normal(bench, open, &mut |bench, e| normal_form(&mut bench.graph, e, &COMPONENT))
}

/// `D(p)` of some components: their derivatives along `X_0` and along other directions, in normal form, times the weights of
/// the latter in the motion. Where all derivatives of one have a component as a factor, as those of a unit vector in a plane
/// have, it is taken out, and no digits are lost where it is small.
pub(super) fn rates_of(
    bench: &mut Workbench,
    restriction: &mut Restriction,
    entries: &[ExprId],
    weights: &[ExprId],
    mut slopes: impl FnMut(&mut Workbench, ExprId) -> Vec<ExprId>,
) -> Option<Vec<ExprId>> {
    if weighted_cost(&bench.graph, entries) > COMPONENTS_DIFFERENTIATED {
        return None;
    }
    let mut components: Vec<ExprId> = Vec::new();
    for e in entries {
        let (_, component) = bench.graph.split_coefficient(*e);
        if !bench.graph.roles(component).is_constant() && !components.contains(&component) {
            components.push(component);
        }
    }
    let mut rates: Vec<ExprId> = Vec::new();
    for component in &components {
        let open = written_out(bench, *component);
        let slopes = slopes(bench, open);
        let (factor, quotients) = shortest(bench, restriction, &slopes, &components)?;
        let terms = quotients[1..].iter().zip(weights).map(|(e, weight)| bench.graph.mul(*e, *weight));
        let terms: Vec<ExprId> = terms.collect();
        let rate = bench.graph.sum(terms.into_iter().chain([quotients[0]]));
        let (content, rate) = bench.graph.split_content(rate);
        let rate = bench.keep_above(rate, COMPONENT_TERMS);
        let rate = bench.graph.scale(rate, &content);
        rates.push(bench.graph.mul(rate, factor));
    }
    let rate_of = |bench: &mut Workbench, e: ExprId| {
        let (coefficient, component) = bench.graph.split_coefficient(e);
        match components.iter().position(|other| *other == component) {
            Some(k) => bench.graph.scale(rates[k], &coefficient),
            None => bench.graph.zero(),
        }
    };
    Some(entries.iter().map(|e| rate_of(bench, *e)).collect())
}

/// Expressions in normal form as multiples of one of these components, or of one: what leaves the shortest without dividing
/// by anything else, for components vanish.
fn shortest(
    bench: &mut Workbench,
    restriction: &mut Restriction,
    expressions: &[ExprId],
    components: &[ExprId],
) -> Option<(ExprId, Vec<ExprId>)> {
    let mut best: Vec<ExprId> = Vec::new();
    for e in expressions {
        best.push(normal_written_out(bench, restriction, *e)?);
    }
    let (own, mut factor) = (best.clone(), bench.graph.one());
    let divided = bench.graph.divisors(&own);
    let mut least = weighted_cost(&bench.graph, &best);
    for component in components {
        let (mut quotients, mut cost) = (Vec::new(), 0);
        for e in &own {
            let quotient = bench.graph.div(*e, *component);
            let Some(quotient) = normal_written_out(bench, restriction, quotient) else { break };
            quotients.push(quotient);
            cost = weighted_cost(&bench.graph, &quotients);
            if cost >= least || bench.graph.divisors(&[quotient]).iter().any(|e| !divided.contains(e)) {
                quotients.clear();
                break;
            }
        }
        if quotients.len() == own.len() {
            (best, factor, least) = (quotients, *component, cost);
        }
    }
    Some((factor, best))
}
