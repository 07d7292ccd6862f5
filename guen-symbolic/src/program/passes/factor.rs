//! `x a + x b + c = x (a + b) + c`, greedily by the factor that most terms share, constants included.

use super::super::net::{Linear, Net, NetNode, split_sign};
use super::super::terms::NetId;
use super::super::terms::{Powers, Terms, add_term, nonzero};
use super::Changes;
use crate::algebra::{ExprId, FastMap, Graph, Key, spread};
use crate::program::thresholds::FACTORED_TERMS;

/// A term: coefficient and powers.
#[derive(Clone, Debug)]
struct Term {
    k: ExprId,
    powers: Powers,
}

/// A factor that several terms have in common.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Common {
    /// A power of a node, above or below.
    Power(NetId, bool),
    /// A coefficient up to its sign.
    Coefficient(ExprId),
}

impl Key for Common {
    fn hash(&self) -> u32 {
        spread(match self {
            Common::Power(node, above) => (node.0 as u64) << 1 | *above as u64,
            Common::Coefficient(k) => (k.0 as u64) << 1 | 1 << 40,
        })
    }
}

pub(super) fn changes(graph: &mut Graph, net: &mut Net, roots: &[NetId], open_shared: bool) -> Changes {
    let (nodes, uses) = net.reachable(roots);
    let mut changes = Changes::default();
    for id in nodes {
        let NetNode::Sum(linear) = net.node(id) else { continue };
        if linear.terms.len() < 2 || linear.terms.len() > FACTORED_TERMS {
            continue;
        }
        let linear = linear.clone();
        let terms: Vec<Term> = linear
            .terms
            .iter()
            .map(|(node, k)| {
                let powers = match net.node(*node) {
                    NetNode::Product(factors) if open_shared || uses.get(*node) == 1 => {
                        Powers::from_sorted(factors.clone())
                    }
                    _ => Powers::from_sorted(vec![(*node, 1)]),
                };
                Term { k: *k, powers }
            })
            .collect();
        let factored = factor(graph, net, linear.constant, terms);
        if factored != linear {
            changes.insert(id, NetNode::Sum(factored));
        }
    }
    changes
}

/// The sum with common factors taken out; the depth of recursion is bounded by the degree of the terms.
fn factor(graph: &mut Graph, net: &mut Net, mut constant: ExprId, mut terms: Vec<Term>) -> Linear {
    let mut finished = Terms::default();
    while let Some(common) = most_common(graph, &terms) {
        let mut group = Vec::new();
        let mut rest = Vec::new();
        let mut outer = graph.one();
        let mut exponent = i32::MAX;
        for term in terms {
            let belongs = match common {
                Common::Power(node, above) => {
                    let e = term.powers.get(node).copied().unwrap_or(0);
                    let belongs = e != 0 && (e > 0) == above;
                    if belongs {
                        exponent = exponent.min(e.abs());
                    }
                    belongs
                }
                Common::Coefficient(k) => split_sign(graph, term.k).1 == k,
            };
            if belongs { group.push(term) } else { rest.push(term) }
        }
        terms = rest;
        let mut factors = Powers::default();
        let zero = graph.zero();
        let mut inner_constant = zero;
        match common {
            Common::Power(node, above) => {
                let e = if above { exponent } else { -exponent };
                factors.or_insert(node, e);
                for term in &mut group {
                    let left = term.powers.or_insert(node, 0);
                    *left -= e;
                    if *left == 0 {
                        term.powers.remove(node);
                    }
                }
                let (bare, left): (Vec<_>, Vec<_>) =
                    group.into_iter().partition(|term| term.powers.entries().is_empty());
                for term in bare {
                    inner_constant = graph.add(inner_constant, term.k);
                }
                group = left;
            }
            Common::Coefficient(k) => {
                outer = k;
                let (one, minus) = (graph.one(), graph.number(-1));
                for term in &mut group {
                    term.k = if split_sign(graph, term.k).0 { minus } else { one };
                }
                if !graph.is_zero(constant) && finished.entries().is_empty() && terms.is_empty() {
                    let (negative, size) = split_sign(graph, constant);
                    if size == k {
                        inner_constant = if negative { minus } else { one };
                        constant = zero;
                    }
                }
            }
        }
        let inner = factor(graph, net, inner_constant, group);
        // A single term keeps its coefficient outside of the product; terms may have cancelled, and leave a constant.
        let node = match inner.terms[..] {
            [] => {
                outer = graph.mul(outer, inner.constant);
                None
            }
            [(node, k)] if graph.is_zero(inner.constant) => {
                outer = graph.mul(outer, k);
                Some(node)
            }
            _ => Some(net.intern(NetNode::Sum(inner))),
        };
        match node.map(|node| (node, net.node(node))) {
            None => {}
            Some((_, NetNode::Product(inner))) if !factors.entries().is_empty() => {
                for (node, e) in inner {
                    *factors.or_insert(*node, 0) += e;
                }
            }
            Some((node, _)) => *factors.or_insert(node, 0) += 1,
        }
        if node.is_none() && factors.entries().is_empty() {
            constant = graph.add(constant, outer);
            continue;
        }
        let node = net.plain_product(factors);
        add_term(graph, &mut finished, node, outer);
    }
    for term in terms {
        let node = net.plain_product(term.powers);
        add_term(graph, &mut finished, node, term.k);
    }
    let terms = nonzero(graph, finished);
    Linear { constant, terms }
}

/// The factor that most terms share, if two do; powers before coefficients, older nodes before younger.
fn most_common(graph: &mut Graph, terms: &[Term]) -> Option<Common> {
    let mut counts: FastMap<Common, usize> = FastMap::default();
    for term in terms {
        let powers = term.powers.entries();
        let mut index = 0;
        while index < powers.len() {
            let (node, e) = powers[index];
            *counts.or_default(Common::Power(node, e > 0)) += 1;
            index += 1;
        }
        let (_, k) = split_sign(graph, term.k);
        if k != graph.one() {
            *counts.or_default(Common::Coefficient(k)) += 1;
        }
    }
    let mut best: Option<(usize, Common)> = None;
    for (common, count) in counts.iter() {
        if *count >= 2 && best.is_none_or(|(most, first)| *count > most || *count == most && *common < first)
        {
            best = Some((*count, *common));
        }
    }
    best.map(|(_, common)| common)
}
