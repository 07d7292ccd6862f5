//! Rewriting a net into an equal one with fewer operations: one file per pass, composed in a visible list.
//!
//! What comes in are roots of a net; what goes out are roots of equal functions. A pass only names nodes whose
//! contents change; [`rebuild`] carries the changes to everything above.

mod absorb;
pub(super) mod angles;
mod expand;
mod factor;
mod products;
mod signs;
mod sums;

use super::net::{Linear, Net, NetNode};
use super::terms::NetId;
use super::terms::{Powers, Terms, add_term, nonzero};
use crate::algebra::{ExprId, FastMap, Graph};

/// New contents of some nodes, in terms of nodes whose contents may change as well.
pub(super) type Changes = FastMap<NetId, NetNode>;

/// A rewriting of the whole net.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Pass {
    /// Constant factors move into sums that have a coefficient at every term anyway.
    Absorb,
    /// Products of short sums that little else uses as sums of products.
    Expand,
    /// Sums as `x * (...) + rest`; products that are shared are not taken apart.
    FactorUnshared,
    /// Sums as `x * (...) + rest`, shared products included.
    FactorAll,
    /// Pairs of factors that several products have become one; a constant coefficient is one factor.
    Products,
    /// Pairs of factors as in `Products`, with coefficients taken apart into their own factors first.
    ProductsAndConstants,
    /// Pairs of terms that several sums have in the same ratio become one.
    Sums,
    /// Signs move to where they cost nothing.
    Signs,
}

/// The sequences that are tried; the cheapest result is kept, the earlier one of equals, and then [`Pass::Signs`].
///
/// Each is there because some system needs it: rates in velocities (hoop, sled) the first, masses and forces of chains
/// the second, solves with named entries the third, single expressions the others.
pub(super) const CANDIDATES: [&[Pass]; 5] = {
    use Pass::{Absorb, Expand, FactorAll, FactorUnshared, Products, ProductsAndConstants, Sums};
    [
        &[Expand, Absorb, Sums, Products, FactorUnshared, Absorb, Products],
        &[Expand, ProductsAndConstants, FactorUnshared, Sums, Absorb, Products],
        &[Absorb, FactorAll, Sums, Absorb, Products, FactorUnshared],
        &[Absorb, Products, Sums, FactorUnshared, Absorb, Products],
        &[ProductsAndConstants, Sums, FactorUnshared, Absorb, Products],
    ]
};

/// The sequence for the whole of a program whose depths were optimised one by one.
pub(super) const JOINED: [Pass; 7] = {
    use Pass::{Absorb, FactorUnshared, Products, Signs, Sums};
    [Absorb, Sums, Products, FactorUnshared, Absorb, Products, Signs]
};

/// Returns the number of candidates that are tried for a net of so many nodes: expansion must stay quick.
pub(super) fn affordable(nodes: usize) -> usize {
    match nodes {
        0..=600 => CANDIDATES.len(),
        601..=40_000 => 2,
        _ => 0,
    }
}

/// Applies one pass.
pub(super) fn apply(pass: Pass, graph: &mut Graph, net: &mut Net, roots: &[NetId]) -> Vec<NetId> {
    let changes = match pass {
        Pass::Absorb => absorb::changes(graph, net, roots),
        Pass::Expand => expand::changes(graph, net, roots),
        Pass::FactorUnshared => factor::changes(graph, net, roots, false),
        Pass::FactorAll => factor::changes(graph, net, roots, true),
        Pass::Products => products::changes(graph, net, roots, false),
        Pass::ProductsAndConstants => products::changes(graph, net, roots, true),
        Pass::Sums => sums::changes(graph, net, roots),
        Pass::Signs => signs::changes(graph, net, roots),
    };
    rebuild(graph, net, roots, &changes)
}

/// The roots with everything below them as the changes say.
pub(super) fn rebuild(graph: &mut Graph, net: &mut Net, roots: &[NetId], changes: &Changes) -> Vec<NetId> {
    if changes.is_empty() {
        return roots.to_vec();
    }
    // One more than the image, zero for none.
    let mut images = net.marks();
    let mut stack: Vec<(NetId, bool)> = roots.iter().rev().map(|root| (*root, false)).collect();
    while let Some((id, entered)) = stack.pop() {
        if images.get(id) != 0 {
            continue;
        }
        let change = changes.get(&id);
        let content = change.unwrap_or_else(|| net.node(id));
        if !entered {
            stack.push((id, true));
            content.children(|child| {
                if images.get(child) == 0 {
                    stack.push((child, false));
                }
            });
            continue;
        }
        let mut same = change.is_none();
        content.children(|child| same &= images.get(child) == child.0 + 1);
        let image = if same {
            id
        } else {
            let content = content.clone();
            with_children(graph, net, content, |child| NetId(images.get(child) - 1))
        };
        images.set(id, image.0 + 1);
    }
    roots.iter().map(|root| NetId(images.get(*root) - 1)).collect()
}

fn with_children(graph: &mut Graph, net: &mut Net, node: NetNode, image: impl Fn(NetId) -> NetId) -> NetId {
    match node {
        NetNode::Atom(_) | NetNode::Constant(_) => net.intern(node),
        NetNode::Sum(linear) => {
            let old: &[(NetId, ExprId)] = &linear.terms;
            let mut collected = Terms::with_capacity(old.len());
            let mut index = 0;
            while index < old.len() {
                let (child, k) = old[index];
                add_term(graph, &mut collected, image(child), k);
                index += 1;
            }
            let terms = nonzero(graph, collected);
            net.sum(graph, Linear { constant: linear.constant, terms })
        }
        NetNode::Product(factors) => {
            let factors: &[(NetId, i32)] = &factors;
            let mut collected = Powers::with_capacity(factors.len());
            let mut index = 0;
            while index < factors.len() {
                let (child, e) = factors[index];
                *collected.or_insert(image(child), 0) += e;
                index += 1;
            }
            net.plain_product(collected)
        }
        NetNode::Call(function, x) => net.intern(NetNode::Call(function, image(x))),
        NetNode::Apply(function, arguments) => {
            let arguments = arguments.iter().map(|x| image(*x)).collect();
            net.intern(NetNode::Apply(function, arguments))
        }
    }
}

/// A coefficient that costs nothing: one or minus one.
fn is_unit(graph: &Graph, k: ExprId) -> bool {
    graph.as_number(k).is_some_and(|value| value.is_one() || value.is_minus_one())
}
