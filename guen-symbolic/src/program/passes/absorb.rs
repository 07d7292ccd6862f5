//! `k (a x + b y) = (k a) x + (k b) y` where that is one multiplication less: constants are multiplied once per system.

use super::super::net::{Linear, Net, NetNode};
use super::super::terms::NetId;
use super::super::terms::{Terms, add_term, nonzero};
use super::{Changes, is_unit};
use crate::algebra::{ExprId, FastMap, Graph};

pub(super) fn changes(graph: &mut Graph, net: &mut Net, roots: &[NetId]) -> Changes {
    let (nodes, uses) = net.reachable(roots);
    let mut changes = Changes::default();
    let mut gone: FastMap<NetId, ()> = FastMap::default();
    // From the top, so that a constant may sink through several sums.
    for id in nodes.into_iter().rev() {
        if gone.contains_key(&id) {
            continue;
        }
        let NetNode::Sum(linear) = changes.get(&id).unwrap_or_else(|| net.node(id)) else { continue };
        let linear = linear.clone();
        let mut constant = linear.constant;
        let mut collected = Terms::with_capacity(linear.terms.len());
        let mut changed = false;
        for (child, k) in linear.terms {
            let single = uses.get(child) == 1;
            if let NetNode::Sum(inner) = net.node(child)
                && single
                && !changes.contains_key(&child)
                && gains(graph, k, inner, 1)
            {
                let inner = scaled(graph, &inner.clone(), k);
                constant = graph.add(constant, inner.constant);
                for (node, k) in inner.terms {
                    add_term(graph, &mut collected, node, k);
                }
                gone.insert(child, ());
                changed = true;
                continue;
            }
            let mut k = k;
            if single
                && k != graph.one()
                && let NetNode::Product(factors) = net.node(child)
                && let Some((sum, inner)) = factors.iter().find_map(|(factor, e)| match net.node(*factor) {
                    NetNode::Sum(inner)
                        if *e == 1
                            && uses.get(*factor) == 1
                            && !changes.contains_key(factor)
                            && gains(graph, k, inner, 0) =>
                    {
                        Some((*factor, inner.clone()))
                    }
                    _ => None,
                })
            {
                changes.insert(sum, NetNode::Sum(scaled(graph, &inner, k)));
                k = graph.one();
                changed = true;
            }
            add_term(graph, &mut collected, child, k);
        }
        if changed {
            let terms = nonzero(graph, collected);
            changes.insert(id, NetNode::Sum(Linear { constant, terms }));
        }
    }
    changes
}

fn scaled(graph: &mut Graph, linear: &Linear, k: ExprId) -> Linear {
    let terms = linear.terms.iter().map(|(node, c)| (*node, graph.mul(*c, k))).collect();
    Linear { constant: graph.mul(linear.constant, k), terms }
}

/// Whether `k * sum` costs no less than the sum with `k` in its coefficients, less some allowance.
fn gains(graph: &mut Graph, k: ExprId, sum: &Linear, allowance: usize) -> bool {
    let before =
        usize::from(!is_unit(graph, k)) + sum.terms.iter().filter(|(_, c)| !is_unit(graph, *c)).count();
    let mut after = 0;
    for (_, c) in &sum.terms {
        let product = graph.mul(*c, k);
        after += usize::from(!is_unit(graph, product));
    }
    after < before + allowance
}
