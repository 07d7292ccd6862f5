//! Signs where they cost nothing.
//!
//! A sum that only subtracts, `-x - y`, needs a negation. If `x` is a product with a factor that is a sum or has a
//! prepared coefficient, that factor can change its sign for free, provided that its other users gain no negation.

use super::super::net::{Linear, Net, NetNode, split_sign};
use super::super::terms::NetId;
use super::Changes;
use crate::algebra::{ExprId, FastMap, Graph};
use crate::program::thresholds::{SUBTRACTING_SUMS, USERS_OF_A_SIGN};

pub(super) fn changes(graph: &mut Graph, net: &mut Net, roots: &[NetId]) -> Changes {
    let (nodes, _) = net.reachable(roots);
    let mut turning = Turning { net, sums: FastMap::default(), parents: FastMap::default() };
    for id in &nodes {
        turning.net.children(*id, |child| turning.parents.or_default(child).push(Some(*id)));
        if let NetNode::Sum(linear) = turning.net.node(*id) {
            turning.sums.insert(*id, linear.clone());
        }
    }
    for root in roots {
        turning.parents.or_default(*root).push(None);
    }
    let bad: Vec<NetId> = nodes
        .iter()
        .copied()
        .filter(|id| turning.sums.get(id).is_some_and(|sum| needs_negation(graph, sum)))
        .collect();
    let mut changed: Vec<NetId> = Vec::new();
    for id in bad.into_iter().take(SUBTRACTING_SUMS) {
        if !needs_negation(graph, &turning.sums[&id]) {
            continue;
        }
        let mut candidates = vec![id];
        for (child, _) in &turning.sums[&id].terms {
            match turning.net.node(*child) {
                NetNode::Sum(_) => candidates.push(*child),
                NetNode::Product(factors) => candidates.extend(
                    factors
                        .iter()
                        .filter(|(f, e)| e % 2 != 0 && matches!(turning.net.node(*f), NetNode::Sum(_)))
                        .map(|(f, _)| *f),
                ),
                _ => {}
            }
        }
        for candidate in candidates {
            if let Some(touched) = turning.turned(graph, candidate) {
                for (sum, linear) in touched {
                    changed.push(sum);
                    turning.sums.insert(sum, linear);
                }
                break;
            }
        }
    }
    changed.sort_unstable();
    changed.dedup();
    let mut changes = Changes::default();
    for id in changed {
        changes.insert(id, NetNode::Sum(turning.sums[&id].clone()));
    }
    changes
}

struct Turning<'a> {
    net: &'a Net,
    /// The sums as they are by now.
    sums: FastMap<NetId, Linear>,
    /// The users of a node; none for an output.
    parents: FastMap<NetId, Vec<Option<NetId>>>,
}

impl Turning<'_> {
    /// The sums that change if this one changes its sign, if that is fewer negations than before.
    fn turned(&self, graph: &mut Graph, id: NetId) -> Option<Vec<(NetId, Linear)>> {
        let whole = &self.sums[&id];
        let mut touched: Vec<(NetId, Linear)> = Vec::new();
        let terms = whole.terms.iter().map(|(node, k)| (*node, negated(graph, *k))).collect();
        touched.push((id, Linear { constant: negated(graph, whole.constant), terms }));
        // Products with an odd power of it change their signs, too.
        let mut stack = vec![id];
        let mut users = 0;
        while let Some(node) = stack.pop() {
            for parent in self.parents.get(&node).into_iter().flatten() {
                users += 1;
                let parent = (*parent).filter(|_| users <= USERS_OF_A_SIGN)?;
                match self.net.node(parent) {
                    NetNode::Sum(_) => {
                        let position = match touched.iter().position(|(sum, _)| *sum == parent) {
                            Some(position) => position,
                            None => {
                                touched.push((parent, self.sums[&parent].clone()));
                                touched.len() - 1
                            }
                        };
                        let linear = &mut touched[position].1;
                        let term = linear.terms.iter_mut().find(|(child, _)| *child == node)?;
                        term.1 = negated(graph, term.1);
                    }
                    NetNode::Product(factors) => {
                        if factors.iter().any(|(factor, e)| *factor == node && e % 2 != 0) {
                            stack.push(parent);
                        }
                    }
                    _ => return None,
                }
            }
        }
        let before = touched.iter().filter(|(sum, _)| needs_negation(graph, &self.sums[sum])).count();
        let after = touched.iter().filter(|(_, linear)| needs_negation(graph, linear)).count();
        (after < before).then_some(touched)
    }
}

fn negated(graph: &mut Graph, k: ExprId) -> ExprId {
    if graph.is_zero(k) {
        return k;
    }
    match split_sign(graph, k) {
        (true, size) => size,
        (false, size) => graph.neg(size),
    }
}

/// Whether all terms are subtracted and no coefficient can take the sign.
fn needs_negation(graph: &Graph, linear: &Linear) -> bool {
    graph.is_zero(linear.constant)
        && linear.terms.iter().all(|(_, k)| graph.as_number(*k).is_some_and(|value| value.is_minus_one()))
}
