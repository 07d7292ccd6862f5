//! Powers and terms while they are collected: lists in the order of nodes.

use crate::algebra::{ExprId, Graph, Key, Ordinal, SortedMap, spread};

/// A node of a [`Net`]; children have smaller identifiers than their parents.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct NetId(pub(super) u32);

impl Key for NetId {
    fn hash(&self) -> u32 {
        spread(self.0 as u64)
    }
}

impl Ordinal for NetId {
    fn ordinal(self) -> u32 {
        self.0
    }
}

impl Key for (NetId, NetId) {
    fn hash(&self) -> u32 {
        spread((self.0.0 as u64) << 32 | self.1.0 as u64)
    }
}

impl Key for (ExprId, NetId) {
    fn hash(&self) -> u32 {
        spread((self.0.0 as u64) << 32 | self.1.0 as u64)
    }
}

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
