//! Sums of velocities as differences from each other.

use crate::algebra::{ExprId, FastMap, Node, Rational};
use crate::motion::quasi_velocities::velocity_forms::VELOCITIES;
use crate::motion::thresholds::COMPARED_SUMS;
use crate::workbench::Workbench;

/// `S = multiple*parent + rest`, a sum by another one that has many of its terms.
pub(super) struct Relative {
    pub(super) parent: ExprId,
    pub(super) multiple: Rational,
    pub(super) constant: Rational,
    pub(super) rest: Vec<(ExprId, Rational)>,
}

/// Every sum of velocities by the one that it differs least from, if that is worth it.
pub(super) fn relatives(bench: &Workbench, roots: &[ExprId]) -> Option<FastMap<ExprId, Relative>> {
    let graph = &bench.graph;
    let mut sums: Vec<ExprId> = graph
        .reachable(roots, |e| !graph.roles(e).meets(VELOCITIES))
        .into_iter()
        .filter(|e| {
            matches!(graph.node(*e), Node::Sum { terms, .. } if terms.len() > 1)
                && graph.roles(*e).meets(VELOCITIES)
        })
        .collect();
    if sums.len() > COMPARED_SUMS {
        return None;
    }
    let length = |e: &ExprId| match graph.node(*e) {
        Node::Sum { terms, .. } => terms.len(),
        _ => 0,
    };
    // A sum is taken relative to one before it: of fewer terms, and of no greater depth, so that it is not inside.
    sums.sort_by_key(|e| (length(e), graph.depth(*e), *e));
    let mut found = FastMap::default();
    let (mut before, mut after) = (0, 0);
    for (place, own) in sums.iter().enumerate() {
        let mut best: Option<Relative> = None;
        let mut shortest = length(own);
        for parent in sums[..place].iter().filter(|e| graph.depth(**e) <= graph.depth(*own)) {
            if length(own) - length(parent) >= shortest {
                continue;
            }
            if let Some(relative) = difference(bench, *own, *parent, shortest) {
                shortest = relative.rest.len() + 1;
                best = Some(relative);
            }
        }
        before += length(own);
        after += shortest;
        if let Some(best) = best {
            found.insert(*own, best);
        }
    }
    (after < before).then_some(found)
}

/// A sum less a multiple of another, if that has fewer than so many terms, the other one counted.
fn difference(bench: &Workbench, own: ExprId, parent: ExprId, fewer_than: usize) -> Option<Relative> {
    let (Node::Sum { constant, terms }, Node::Sum { constant: other_constant, terms: others }) =
        (bench.graph.node(own), bench.graph.node(parent))
    else {
        return None;
    };
    let mut multiple: Option<Rational> = None;
    let mut rest: Vec<(ExprId, Rational)> = Vec::new();
    let mut met = 0;
    for (e, c) in terms {
        // Both are in the graph's order, which is not that of the identifiers.
        let other = others.iter().find(|(other, _)| other == e);
        let Some((_, other)) = other else {
            rest.push((*e, c.clone()));
            if rest.len() + 1 >= fewer_than {
                return None;
            }
            continue;
        };
        met += 1;
        let factor = match &multiple {
            Some(multiple) => multiple,
            None => multiple.insert(c * &other.recip()?),
        };
        let difference = c - &(factor * other);
        if !difference.is_zero() {
            rest.push((*e, difference));
        }
    }
    let multiple = multiple?;
    if met < others.len() {
        for (e, c) in others.iter().filter(|(e, _)| !terms.iter().any(|(own, _)| own == e)) {
            rest.push((*e, -(&multiple * c)));
        }
    }
    let constant = constant - &(&multiple * other_constant);
    (rest.len() + 1 < fewer_than).then_some(Relative { parent, multiple, constant, rest })
}
