//! Powers and terms while they are collected: lists in the order of nodes.

use super::net::NetId;
use crate::algebra::{ExprId, Graph, SortedMap};

/// Powers of nodes.
pub(super) type Powers = SortedMap<NetId, i32>;

/// Coefficients of nodes.
pub(super) type Terms = SortedMap<NetId, ExprId>;

/// Adds `k` to the coefficient of a node.
pub(super) fn add_term(graph: &mut Graph, terms: &mut Terms, node: NetId, k: ExprId) {
    let slot = terms.or_insert(node, graph.zero());
    *slot = graph.add(*slot, k);
}

/// The terms whose coefficients are not zero.
pub(super) fn nonzero(graph: &Graph, terms: Terms) -> Vec<(NetId, ExprId)> {
    let mut terms = terms.into_entries();
    let zero = graph.zero();
    let mut index = 0;
    while index < terms.len() {
        if terms[index].1 == zero {
            terms.remove(index);
        } else {
            index += 1;
        }
    }
    terms
}
