//! `x (a + b) = x a + x b` for short sums that few products use, so that later passes can group terms anew.

use super::super::marks::Marks;
use super::super::net::{Linear, Net, NetNode};
use super::super::terms::NetId;
use super::super::terms::{Terms, add_term, nonzero};
use super::Changes;
use crate::algebra::{ExprId, FastMap, Graph};
use crate::program::thresholds::{EXPANDED_DEPTH, EXPANDED_TERMS, SHARED_TERMS, SINGLE_TERMS};

pub(super) fn changes(graph: &mut Graph, net: &mut Net, roots: &[NetId]) -> Changes {
    let (nodes, uses) = net.reachable(roots);
    let mut changes = Changes::default();
    let mut gone: FastMap<NetId, ()> = FastMap::default();
    for id in nodes.into_iter().rev() {
        if gone.contains_key(&id) {
            continue;
        }
        let NetNode::Sum(linear) = net.node(id) else { continue };
        let mut linear = linear.clone();
        let mut changed = false;
        for _ in 0..EXPANDED_DEPTH {
            let mut progress = false;
            let mut constant = linear.constant;
            let mut collected = Terms::with_capacity(linear.terms.len());
            let mut add =
                |graph: &mut Graph, node: NetId, k: ExprId| add_term(graph, &mut collected, node, k);
            let mut size = linear.terms.len();
            for (node, k) in &linear.terms {
                let Some((rest, factor)) = expandable(net, &uses, *node) else {
                    add(graph, *node, *k);
                    continue;
                };
                let NetNode::Sum(inner) = net.node(factor).clone() else { unreachable!("only sums expand") };
                size += inner.terms.len();
                if size > EXPANDED_TERMS {
                    add(graph, *node, *k);
                    continue;
                }
                for (part, c) in inner.terms {
                    let mut factors = rest.clone();
                    factors.push((part, 1));
                    let product = net.product(&factors);
                    let k = graph.mul(*k, c);
                    add(graph, product, k);
                }
                if !graph.is_zero(inner.constant) {
                    let k = graph.mul(*k, inner.constant);
                    if rest.is_empty() {
                        constant = graph.add(constant, k);
                    } else {
                        let product = net.product(&rest);
                        add(graph, product, k);
                    }
                }
                if uses.get(factor) == 1 {
                    gone.insert(factor, ());
                }
                progress = true;
            }
            if !progress {
                break;
            }
            let terms = nonzero(graph, collected);
            linear = Linear { constant, terms };
            changed = true;
        }
        if changed {
            changes.insert(id, NetNode::Sum(linear));
        }
    }
    changes
}

/// A short sum among the factors of a node that few others use, and the other factors.
fn expandable(net: &Net, uses: &Marks, node: NetId) -> Option<(Vec<(NetId, i32)>, NetId)> {
    // Nodes that this pass has made are used once.
    let count = |id: NetId| uses.get(id).max(1);
    let short = |id: NetId| match net.node(id) {
        NetNode::Sum(inner) => match count(id) {
            1 => inner.terms.len() <= SINGLE_TERMS,
            2 => inner.terms.len() <= SHARED_TERMS,
            _ => false,
        },
        _ => false,
    };
    match net.node(node) {
        NetNode::Sum(_) if short(node) => Some((Vec::new(), node)),
        NetNode::Product(factors) if count(node) == 1 => {
            let position = factors.iter().position(|(factor, e)| *e == 1 && short(*factor))?;
            let mut rest = factors.clone();
            let (factor, _) = rest.remove(position);
            Some((rest, factor))
        }
        _ => None,
    }
}
