//! Replacing subexpressions, the same way everywhere, each shared node once.

use super::Rational;
use super::graph::Graph;
use super::id::ExprId;
use super::map::FastMap;
use super::node::Node;
use super::support::Support;

/// A simultaneous replacement of expressions (usually symbols) by others, with what was replaced so far.
///
/// ```
/// use guen_symbolic::{Graph, Role, Substitution};
/// let mut g = Graph::new();
/// let x = g.symbol("x", Role::Coordinate);
/// let (one, zero) = (g.one(), g.zero());
/// let (s, e) = (g.sin(x), g.add(x, one));
/// let both = g.add(s, e);
/// let at_zero = Substitution::new([(x, zero)]).of(&mut g, both);
/// assert_eq!(at_zero, one);
/// ```
#[derive(Clone, Debug, Default)]
pub struct Substitution {
    images: FastMap<ExprId, ExprId>,
    // Expressions to replace whose symbols have not been collected into `replaced` yet.
    added: Vec<ExprId>,
    // The symbols in what is replaced.
    replaced: Support,
    // Whether something without symbols is replaced, which may be anywhere.
    everywhere: bool,
}

impl Substitution {
    /// Replaces the first of each pair by the second.
    pub fn new(pairs: impl IntoIterator<Item = (ExprId, ExprId)>) -> Self {
        let images: FastMap<ExprId, ExprId> = pairs.into_iter().collect();
        let added = images.iter().map(|(from, _)| *from).collect();
        Substitution { images, added, ..Substitution::default() }
    }

    /// Adds a replacement; expressions replaced before keep their images.
    pub fn add(&mut self, from: ExprId, to: ExprId) {
        self.images.insert(from, to);
        self.added.push(from);
    }

    /// The expression with everything replaced; replacements are not looked into again.
    pub fn of(&mut self, graph: &mut Graph, e: ExprId) -> ExprId {
        for from in std::mem::take(&mut self.added) {
            self.replaced = self.replaced.or(graph.support(from));
            self.everywhere |= graph.support(from).is_empty();
        }
        let pending =
            graph.reachable(&[e], |id| !self.may_replace_in(graph, id) || self.images.contains_key(&id));
        for id in pending {
            let image = self.step(graph, id);
            self.images.insert(id, image);
        }
        self.image(e)
    }

    /// Whether something that is replaced may occur in an expression.
    fn may_replace_in(&self, graph: &Graph, e: ExprId) -> bool {
        self.everywhere || self.replaced.meets(graph.support(e))
    }

    fn image(&self, e: ExprId) -> ExprId {
        self.images.get(&e).copied().unwrap_or(e)
    }

    fn step(&self, graph: &mut Graph, id: ExprId) -> ExprId {
        let mut same = true;
        graph.visit_children(id, |child| same = same && self.image(child) == child);
        if same {
            return id;
        }
        match graph.node(id).clone() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined => id,
            Node::Sum { constant, terms } => {
                let mut terms: Vec<_> =
                    terms.iter().map(|(term, c)| (self.image(*term), c.clone())).collect();
                terms.push((graph.number(constant), Rational::ONE));
                graph.linear(&terms)
            }
            Node::Product(factors) => {
                let factors: Vec<_> = factors.iter().map(|(base, e)| (self.image(*base), *e)).collect();
                graph.product(&factors)
            }
            Node::Function(function, x) => graph.function(function, self.image(x)),
            Node::Kept(x) => graph.keep(self.image(x)),
            Node::Multivariate(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|e| self.image(*e)).collect();
                graph.multivariate(function, &arguments)
            }
        }
    }
}

impl Graph {
    /// Expressions with nothing in them kept whole.
    pub(crate) fn opened(&mut self, es: &[ExprId]) -> Vec<ExprId> {
        let mut open = Substitution::default();
        for id in self.reachable(es, |_| false) {
            if let Node::Kept(inside) = *self.node(id) {
                let image = open.of(self, inside);
                open.add(id, image);
            }
        }
        es.iter().map(|e| open.of(self, *e)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::Role;

    #[test]
    fn what_is_added_later_is_replaced_too() {
        let mut g = Graph::new();
        let [x, y, z] = ["x", "y", "z"].map(|name| g.symbol(name, Role::Coordinate));
        let mut substitution = Substitution::new([(x, z)]);
        let [first, second] = [g.mul(x, x), g.mul(x, y)];
        assert_eq!(substitution.of(&mut g, first), g.mul(z, z));
        substitution.add(y, x);
        assert_eq!(substitution.of(&mut g, second), g.mul(z, x));
        // From nothing, too.
        let mut substitution = Substitution::default();
        substitution.add(y, x);
        assert_eq!(substitution.of(&mut g, second), g.mul(x, x));
    }

    /// Roots of numbers have no symbols, and may be below anything.
    #[test]
    fn what_has_no_symbols_is_replaced_everywhere() {
        let mut g = Graph::new();
        let [x, y, z] = ["x", "y", "z"].map(|name| g.symbol(name, Role::Coordinate));
        let number = g.ratio(2, 1);
        let root = g.sqrt(number);
        let product = g.mul(root, z);
        let expected = g.mul(y, z);
        assert_eq!(Substitution::new([(root, y)]).of(&mut g, product), expected);
        for pairs in [[(root, y), (x, y)], [(x, y), (root, y)]] {
            let mut substitution = Substitution::default();
            pairs.into_iter().for_each(|(from, to)| substitution.add(from, to));
            assert_eq!(substitution.of(&mut g, product), expected);
        }
    }
}
