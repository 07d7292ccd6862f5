//! Memoised directional derivatives: partial derivatives, flows and `X_s(f)` are all of this kind.

use super::Rational;
use super::graph::Graph;
use super::id::{ExprId, SymbolId};
use super::map::FastMap;
use super::node::Node;
use super::support::Support;

/// A direction `sum v_k d/dx_k` in the space of symbols, with what was differentiated along it so far.
///
/// ```
/// use guen_symbolic::{Flow, Graph, Role};
/// let mut g = Graph::new();
/// let x = g.symbol("x", Role::Coordinate);
/// let v = g.symbol("v", Role::Velocity);
/// let mut rate = Flow::new(&g, [(x, v)]);
/// let x2 = g.powi(x, 2);
/// let derivative = rate.of(&mut g, x2);
/// assert_eq!(g.text(derivative), "2*x*v");
/// ```
#[derive(Clone, Debug)]
pub struct Flow {
    images: FastMap<SymbolId, ExprId>,
    moved: Support,
    memo: FastMap<ExprId, ExprId>,
    keeps: bool,
}

impl Flow {
    /// The direction that moves each symbol at the given rate and leaves all others fixed.
    pub fn new(graph: &Graph, rates: impl IntoIterator<Item = (ExprId, ExprId)>) -> Self {
        let (images, memo) = (FastMap::default(), FastMap::default());
        let mut flow = Flow { images, moved: Support::default(), memo, keeps: false };
        for (e, rate) in rates {
            if let Some(symbol) = graph.as_symbol(e)
                && !graph.is_zero(rate)
            {
                flow.images.insert(symbol, rate);
                flow.moved = flow.moved.or(graph.support(e));
            }
        }
        flow
    }

    /// Keeps the derivative of what is kept whole as a whole, too: for results that others are built on.
    pub(crate) fn keeping(self) -> Self {
        Flow { keeps: true, ..self }
    }

    /// The partial derivative by one symbol.
    pub fn partial(graph: &Graph, symbol: ExprId) -> Self {
        Flow::new(graph, [(symbol, graph.one())])
    }

    /// The derivative of an expression along this direction.
    pub fn of(&mut self, graph: &mut Graph, e: ExprId) -> ExprId {
        if !self.moved.meets(graph.support(e)) {
            return graph.zero();
        }
        if let Some(known) = self.memo.get(&e) {
            return *known;
        }
        let pending =
            graph.reachable(&[e], |id| !self.moved.meets(graph.support(id)) || self.memo.contains_key(&id));
        for id in pending {
            let derivative = self.step(graph, id);
            self.memo.insert(id, derivative);
        }
        self.memo[&e]
    }

    fn known(&self, graph: &Graph, id: ExprId) -> ExprId {
        self.memo.get(&id).copied().unwrap_or(graph.zero())
    }

    /// The derivative of a node whose children are done.
    fn step(&self, graph: &mut Graph, id: ExprId) -> ExprId {
        match graph.node(id).clone() {
            Node::Number(_) | Node::Pi => graph.zero(),
            Node::Undefined => id,
            // Equal to what is inside, so is its derivative.
            Node::Kept(x) => {
                let derivative = self.known(graph, x);
                if self.keeps { graph.keep(derivative) } else { derivative }
            }
            Node::Symbol(symbol) => self.images.get(&symbol).copied().unwrap_or(graph.zero()),
            Node::Sum { terms, .. } => {
                let terms: Vec<_> =
                    terms.iter().map(|(term, c)| (self.known(graph, *term), c.clone())).collect();
                graph.linear(&terms)
            }
            Node::Product(factors) => {
                // (prod b^e)' = sum e b^(e-1) b' prod of the others
                let mut terms = Vec::new();
                for (i, (base, e)) in factors.iter().enumerate() {
                    let slope = self.known(graph, *base);
                    if graph.is_zero(slope) {
                        continue;
                    }
                    let mut product = Vec::with_capacity(factors.len() + 1);
                    product.extend_from_slice(&factors);
                    product[i].1 -= 1;
                    product.push((slope, 1));
                    terms.push((graph.product(&product), Rational::integer((*e).into())));
                }
                graph.linear(&terms)
            }
            Node::Function(function, x) => {
                let inner = self.known(graph, x);
                if graph.is_zero(inner) {
                    return graph.zero();
                }
                let slope = graph.function_derivative(function, x, id);
                graph.mul(slope, inner)
            }
            Node::Multivariate(function, arguments) => {
                let rates: Vec<_> = arguments.iter().map(|e| self.known(graph, *e)).collect();
                graph.multivariate_differential(function, &arguments, &rates)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Flow;
    use crate::{Graph, Node, Role};

    #[test]
    fn what_is_kept_whole_has_the_derivative_of_what_is_inside() {
        let mut g = Graph::new();
        let x = g.symbol("x", Role::Coordinate);
        let (s, one) = (g.sin(x), g.one());
        let sum = g.add(s, one);
        let inside = g.powi(sum, 3);
        let kept = g.keep(inside);
        assert!(matches!(g.node(kept), Node::Kept(_)));
        let mut by_x = Flow::partial(&g, x);
        let expected = by_x.of(&mut g, inside);
        assert!(!g.is_zero(expected));
        assert_eq!(by_x.of(&mut g, kept), expected);
    }
}
