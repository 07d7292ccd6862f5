//! Writes a net so that what is computed for each member of a family is written alike.
//!
//! The optimiser chooses the order of terms and the signs of sums by the numbers of nodes, and these say nothing of a family. Here terms and factors stand in the
//! order of their shapes, and of the distances between the indices of their symbols; the first term of a sum is positive, and who
//! uses the sum takes the sign. What differs between members in indices alone comes out as the same text with other indices.

use super::net::{Linear, Net, NetNode, split_sign};
use super::shape::{Indices, ROUNDS, Shape};
use super::terms::NetId;
use crate::algebra::{ExprId, FastMap, Graph, Node, Rational};

/// The roots of an equal net, written regularly.
pub(super) fn rebuild(graph: &mut Graph, net: &mut Net, roots: &[NetId], indices: &Indices) -> Vec<NetId> {
    let (nodes, _) = net.reachable(roots);
    let mut regular = Regular { graph, indices, constants: FastMap::default(), heights: Vec::new() };
    let shapes = regular.shapes(net, &nodes);
    // Each node: its image, and whether the image has the other sign.
    let mut images: Vec<(NetId, bool)> = vec![(NetId(0), false); net.len()];
    // The longest way down from each node.
    let mut heights: Vec<u32> = vec![0; net.len()];
    for id in &nodes {
        let mut height = 0;
        net.children(*id, |child| height = height.max(heights[child.0 as usize] + 1));
        heights[id.0 as usize] = height;
    }
    regular.heights = heights;
    for id in nodes {
        images[id.0 as usize] = regular.image(net, id, &images, &shapes);
    }
    roots.iter().map(|root| regular.plain(net, images[root.0 as usize])).collect()
}

/// Constants in the order of their shapes, and of one shape in the order of their indices.
pub(super) fn order(graph: &mut Graph, constants: &[ExprId], indices: &Indices) -> Vec<usize> {
    let mut regular = Regular { graph, indices, constants: FastMap::default(), heights: Vec::new() };
    let shapes: Vec<Shape> = constants.iter().map(|e| regular.constant(*e)).collect();
    let mut order: Vec<usize> = (0..constants.len()).collect();
    order.sort_by(|a, b| shapes[*a].order(&shapes[*b]));
    order
}

struct Regular<'a> {
    graph: &'a mut Graph,
    indices: &'a Indices,
    /// The shapes of constants.
    constants: FastMap<(ExprId, u32), Shape>,
    /// The longest way down from each node.
    heights: Vec<u32>,
}

impl Regular<'_> {
    /// The shapes of nodes as far as [`ROUNDS`] operations below them, whatever their signs are.
    fn shapes(&mut self, net: &Net, nodes: &[NetId]) -> Vec<Shape> {
        let mut shapes = vec![Shape::default(); net.len()];
        for round in 0..=ROUNDS {
            let before = shapes.clone();
            for id in nodes {
                let of = |node: NetId| before[node.0 as usize];
                shapes[id.0 as usize] = match net.node(*id) {
                    NetNode::Atom(e) | NetNode::Constant(e) => self.constant(*e),
                    // A sign is not seen.
                    NetNode::Sum(Linear { constant, terms })
                        if self.graph.is_zero(*constant) && terms.len() == 1 && self.is_unit(terms[0].1) =>
                    {
                        shapes[terms[0].0.0 as usize]
                    }
                    _ if round == 0 => Shape::of_kind(1),
                    NetNode::Sum(linear) => {
                        let mut parts: Vec<Shape> = Vec::with_capacity(linear.terms.len() + 1);
                        for (node, k) in &linear.terms {
                            let k = self.constant(*k);
                            parts.push(Shape::joined(2, &mut [of(*node), k]));
                        }
                        if !self.graph.is_zero(linear.constant) {
                            parts.push(self.constant(linear.constant));
                        }
                        Shape::joined(3, &mut parts)
                    }
                    NetNode::Product(factors) => {
                        let parts = factors.iter().map(|(node, e)| of(*node).raised(*e));
                        Shape::joined(4, &mut parts.collect::<Vec<_>>())
                    }
                    NetNode::Call(function, x) => Shape::joined(16 + function.code(), &mut [of(*x)]),
                    NetNode::Apply(function, arguments) => {
                        let mut parts: Vec<Shape> = arguments.iter().map(|x| of(*x)).collect();
                        Shape::joined(1 << 20 | function.code(), &mut parts)
                    }
                };
            }
        }
        shapes
    }

    /// Whether a coefficient is one or minus one.
    fn is_unit(&self, k: ExprId) -> bool {
        self.graph.as_number(k).is_some_and(|value| value.is_one() || value.is_minus_one())
    }

    /// The shape of an expression of constants, or of a symbol.
    fn constant(&mut self, e: ExprId) -> Shape {
        self.constant_within(e, ROUNDS as u32)
    }

    /// The shape as far as some operations below.
    fn constant_within(&mut self, e: ExprId, rounds: u32) -> Shape {
        if let Some(shape) = self.constants.get(&(e, rounds)) {
            return *shape;
        }
        let number = |value: &Rational| Shape::of_kind(value.abs().hash64() | 1);
        let shape = match self.graph.node(e).clone() {
            Node::Number(value) => number(&value),
            Node::Pi => Shape::of_kind(5),
            Node::Symbol(symbol) => self.indices.of(symbol),
            Node::Sum { constant, terms }
                if constant.is_zero() && terms.len() == 1 && terms[0].1.is_minus_one() =>
            {
                self.constant_within(terms[0].0, rounds)
            }
            _ if rounds == 0 => Shape::of_kind(7),
            Node::Sum { constant, terms } => {
                let mut parts: Vec<Shape> = Vec::with_capacity(terms.len() + 1);
                for (term, c) in &terms {
                    let term = self.constant_within(*term, rounds - 1);
                    parts.push(Shape::joined(2, &mut [term, number(c)]));
                }
                if !constant.is_zero() {
                    parts.push(number(&constant));
                }
                Shape::joined(3, &mut parts)
            }
            Node::Product(factors) => {
                let parts: Vec<Shape> = factors
                    .iter()
                    .map(|(base, e)| self.constant_within(*base, rounds - 1).raised(*e))
                    .collect();
                Shape::joined(4, &mut { parts })
            }
            Node::Function(function, x) => {
                let x = self.constant_within(x, rounds - 1);
                Shape::joined(16 + function.code(), &mut [x])
            }
            Node::Multivariate(function, arguments) => {
                let parts: Vec<Shape> =
                    arguments.iter().map(|x| self.constant_within(*x, rounds - 1)).collect();
                Shape::joined(1 << 20 | function.code(), &mut { parts })
            }
            Node::Kept(inside) => self.constant_within(inside, rounds),
            Node::Undefined => Shape::of_kind(6),
        };
        self.constants.insert((e, rounds), shape);
        shape
    }

    fn image(
        &mut self,
        net: &mut Net,
        id: NetId,
        images: &[(NetId, bool)],
        shapes: &[Shape],
    ) -> (NetId, bool) {
        let of = |node: NetId| images[node.0 as usize];
        match net.node(id).clone() {
            NetNode::Atom(_) | NetNode::Constant(_) => (id, false),
            NetNode::Sum(linear) => {
                let mut terms: Vec<(Shape, NetId, ExprId)> = Vec::with_capacity(linear.terms.len());
                // What is carried from member to member is the highest: a sign must not follow it.
                let mut lowest: Option<(u32, Shape, ExprId)> = None;
                for (node, k) in linear.terms {
                    let (image, is_turned) = of(node);
                    let shape = Shape::joined(2, &mut [shapes[node.0 as usize], self.constant(k)]);
                    let k = if is_turned { self.graph.neg(k) } else { k };
                    terms.push((shape, image, k));
                    let height = self.heights[node.0 as usize];
                    if lowest.as_ref().is_none_or(|(least, first, _)| {
                        height.cmp(least).then_with(|| shape.order(first)).is_lt()
                    }) {
                        lowest = Some((height, shape, k));
                    }
                }
                terms.sort_by(|a, b| a.0.order(&b.0));
                let mut constant = linear.constant;
                let decides =
                    if self.graph.is_zero(constant) { lowest.map(|(.., k)| k) } else { Some(constant) };
                let is_turned = decides.is_some_and(|k| split_sign(self.graph, k).0);
                if is_turned {
                    constant = self.graph.neg(constant);
                }
                let terms: Vec<(NetId, ExprId)> = terms
                    .into_iter()
                    .map(|(_, node, k)| (node, if is_turned { self.graph.neg(k) } else { k }))
                    .collect();
                (net.sum(self.graph, Linear { constant, terms }), is_turned)
            }
            NetNode::Product(factors) => {
                let mut is_turned = false;
                let mut parts: Vec<(Shape, NetId, i32)> = Vec::with_capacity(factors.len());
                for (node, e) in factors {
                    let (image, negative) = of(node);
                    is_turned ^= negative && e % 2 != 0;
                    parts.push((shapes[node.0 as usize].raised(e), image, e));
                }
                parts.sort_by(|a, b| a.0.order(&b.0));
                let mut product: Vec<(NetId, i32)> = Vec::with_capacity(parts.len());
                for (_, node, e) in parts {
                    match product.iter_mut().find(|(other, _)| *other == node) {
                        Some((_, power)) => *power += e,
                        None => product.push((node, e)),
                    }
                }
                product.retain(|(_, e)| *e != 0);
                let image = match product[..] {
                    [(node, 1)] => node,
                    _ => net.intern(NetNode::Product(product)),
                };
                (image, is_turned)
            }
            NetNode::Call(function, x) => {
                let x = self.plain(net, of(x));
                (net.intern(NetNode::Call(function, x)), false)
            }
            NetNode::Apply(function, arguments) => {
                let arguments = arguments.iter().map(|x| self.plain(net, of(*x))).collect();
                (net.intern(NetNode::Apply(function, arguments)), false)
            }
        }
    }

    /// A node with its sign.
    fn plain(&mut self, net: &mut Net, (image, is_turned): (NetId, bool)) -> NetId {
        if !is_turned {
            return image;
        }
        // A sum takes the sign into its terms, where it costs nothing.
        if let NetNode::Sum(linear) = net.node(image).clone() {
            let terms = linear.terms.into_iter().map(|(node, k)| (node, self.graph.neg(k))).collect();
            let constant = self.graph.neg(linear.constant);
            return net.sum(self.graph, Linear { constant, terms });
        }
        let minus = self.graph.number(-1);
        net.intern(NetNode::Sum(Linear { constant: self.graph.zero(), terms: vec![(image, minus)] }))
    }
}
