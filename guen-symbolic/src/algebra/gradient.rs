//! All partial derivatives of one expression in one pass back through it.

use super::Rational;
use super::graph::Graph;
use super::id::ExprId;
use super::map::FastMap;
use super::node::Node;
use super::symbol::Roles;

/// The partial derivatives of an expression by some symbols, with work that grows with the expression and not with the number of
/// symbols.
pub(crate) fn gradient(graph: &mut Graph, e: ExprId, symbols: &[ExprId]) -> Vec<ExprId> {
    let roles = symbols.iter().filter_map(|symbol| graph.as_symbol(*symbol));
    let roles = roles.fold(Roles::NONE, |roles, symbol| roles.or(Roles::of(graph.symbol_info(symbol).role)));
    // Slopes of the expression by a node, a summand for each of its users.
    let mut slopes: FastMap<ExprId, Vec<ExprId>> = FastMap::default();
    let mut found: FastMap<ExprId, ExprId> = FastMap::default();
    slopes.or_default(e).push(graph.one());
    for id in graph.reachable(&[e], |id| !graph.roles(id).meets(roles)).into_iter().rev() {
        let Some(parts) = slopes.get(&id).cloned() else { continue };
        let slope = graph.sum(parts);
        if graph.is_zero(slope) {
            continue;
        }
        let mut below: Vec<(ExprId, ExprId)> = Vec::new();
        match graph.node(id).clone() {
            Node::Number(_) | Node::Pi | Node::Undefined => {}
            Node::Symbol(_) => {
                found.insert(id, slope);
            }
            Node::Kept(x) => below.push((x, slope)),
            Node::Sum { terms, .. } => {
                below.extend(terms.iter().map(|(term, c)| (*term, graph.scale(slope, c))));
            }
            Node::Product(factors) => {
                for (i, (base, exponent)) in factors.iter().enumerate() {
                    if !graph.roles(*base).meets(roles) {
                        continue;
                    }
                    let mut product = factors.to_vec();
                    product[i].1 -= 1;
                    product.push((slope, 1));
                    let part = graph.product(&product);
                    below.push((*base, graph.scale(part, &Rational::integer((*exponent).into()))));
                }
            }
            Node::Function(function, x) => {
                let own = graph.function_derivative(function, x, id);
                below.push((x, graph.mul(own, slope)));
            }
            Node::Multivariate(function, arguments) => {
                for (i, argument) in arguments.iter().enumerate() {
                    let zero = graph.zero();
                    let mut rates = vec![zero; arguments.len()];
                    rates[i] = slope;
                    below.push((*argument, graph.multivariate_differential(function, &arguments, &rates)));
                }
            }
        }
        for (child, part) in below {
            if graph.roles(child).meets(roles) {
                slopes.or_default(child).push(part);
            }
        }
    }
    symbols.iter().map(|symbol| found.get(symbol).copied().unwrap_or(graph.zero())).collect()
}

#[cfg(test)]
mod tests {
    use super::gradient;
    use crate::{Flow, Graph, Limits, Role, normal_form};

    #[test]
    fn slopes_are_those_of_the_directions_one_by_one() {
        let mut g = Graph::new();
        let [x, y, z] = ["x", "y", "z"].map(|name| g.symbol(name, Role::Coordinate));
        let [a, b] = ["a", "b"].map(|name| g.symbol(name, Role::Constant));
        let (sine, cosine) = (g.sin(x), g.cos(y));
        let long = g.product(&[(a, 1), (sine, 2), (y, 3)]);
        let other = g.product(&[(b, 1), (cosine, -1), (z, 1)]);
        let sum = g.sum([long, other, z]);
        let kept = g.keep(sum);
        let root = g.sqrt(z);
        let whole = g.product(&[(kept, 2), (root, 1), (x, 1)]);
        let e = g.sum([whole, sum, x]);
        let found = gradient(&mut g, e, &[x, y, z]);
        for (symbol, slope) in [x, y, z].into_iter().zip(found) {
            let expected = Flow::partial(&g, symbol).of(&mut g, e);
            let difference = g.sub(slope, expected);
            let opened = g.opened(&[difference])[0];
            let left = normal_form(&mut g, opened, &Limits::default()).unwrap();
            assert!(g.is_zero(left), "{}", g.text(left));
            assert!(!g.is_zero(slope));
        }
    }
}
