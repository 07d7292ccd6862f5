//! Sines and cosines of sums, for readers: `sin(a) sin(b) + cos(a) cos(b)` is `cos(a - b)` in every book.
//!
//! Equations are computed in base angles, where a sum of two products costs three operations and a further sine a
//! hundred. What is shown is put together again. The images are equal to what they stand for and are only written.

use crate::algebra::{ExprId, FastMap, Function, Graph, Node, Rational};

/// The number of terms above which a sum stays as it is: nobody would read it.
const CONTRACTED_TERMS: usize = 64;

/// Expressions, with the sines and cosines of sums in them put together.
///
/// ```
/// use guen_symbolic::{Contracted, Graph, Role};
/// let mut g = Graph::new();
/// let (a, b) = (g.symbol("a", Role::Coordinate), g.symbol("b", Role::Coordinate));
/// let ((sa, ca), (sb, cb)) = (g.sin_cos(a), g.sin_cos(b));
/// let (ss, cc) = (g.mul(sa, sb), g.mul(ca, cb));
/// let e = g.add(ss, cc);
/// let contracted = Contracted::of(&mut g, &[e]);
/// assert_eq!(g.text(contracted.image(e)), "cos(a - b)");
/// ```
#[derive(Clone, Debug, Default)]
pub struct Contracted {
    images: FastMap<ExprId, ExprId>,
}

impl Contracted {
    /// The images of some expressions.
    pub fn of(graph: &mut Graph, roots: &[ExprId]) -> Self {
        let nodes = graph.reachable(roots, |e| graph.roles(e).is_constant());
        let mut contracted = Contracted::default();
        if !nodes.iter().any(|e| pair(graph, *e).is_some()) {
            return contracted;
        }
        for e in nodes {
            let image = contracted.step(graph, e);
            if image != e {
                contracted.images.insert(e, image);
            }
        }
        contracted
    }

    /// Returns the expression to write in place of another one, equal to it.
    pub fn image(&self, e: ExprId) -> ExprId {
        self.images.get(&e).copied().unwrap_or(e)
    }

    /// The image of a node whose children have theirs.
    fn step(&self, graph: &mut Graph, e: ExprId) -> ExprId {
        match graph.node(e).clone() {
            Node::Number(_) | Node::Pi | Node::Symbol(_) | Node::Undefined => e,
            Node::Kept(x) => self.image(x),
            Node::Function(function, x) => match self.image(x) {
                same if same == x => e,
                other => graph.function(function, other),
            },
            Node::Multivariate(function, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(|x| self.image(*x)).collect();
                graph.multivariate(function, &arguments)
            }
            Node::Product(factors) => {
                let images: Vec<_> = factors.iter().map(|(base, k)| (self.image(*base), *k)).collect();
                graph.product(&images)
            }
            Node::Sum { constant, terms } => {
                let mut images: Vec<_> =
                    terms.iter().map(|(term, c)| (self.image(*term), c.clone())).collect();
                images.push((graph.number(constant), Rational::ONE));
                let mut sum = graph.linear(&images);
                while let Some((first, second, term)) = pair(graph, sum) {
                    let Node::Sum { constant, terms } = graph.node(sum).clone() else { break };
                    let mut rest: Vec<_> = terms
                        .iter()
                        .enumerate()
                        .filter(|(place, _)| *place != first && *place != second)
                        .map(|(_, term)| term.clone())
                        .collect();
                    let together = term.build(graph);
                    rest.push((together, terms[first].1.clone()));
                    rest.push((graph.number(constant), Rational::ONE));
                    sum = graph.linear(&rest);
                }
                sum
            }
        }
    }
}

/// `factor * rest * function(x + sign*y)`.
struct Together {
    function: Function,
    x: ExprId,
    y: ExprId,
    sign: Rational,
    factor: Rational,
    rest: Vec<(ExprId, i32)>,
}

impl Together {
    fn build(mut self, graph: &mut Graph) -> ExprId {
        let argument = graph.linear(&[(self.x, Rational::ONE), (self.y, self.sign)]);
        self.rest.push((graph.function(self.function, argument), 1));
        let product = graph.product(&self.rest);
        graph.scale(product, &self.factor)
    }
}

/// Two terms of a sum that are one, by the coefficient of the first.
fn pair(graph: &Graph, e: ExprId) -> Option<(usize, usize, Together)> {
    let Node::Sum { terms, .. } = graph.node(e) else { return None };
    if terms.len() > CONTRACTED_TERMS {
        return None;
    }
    let candidates: Vec<usize> =
        (0..terms.len()).filter(|place| circular(graph, terms[*place].0) > 1).collect();
    for (index, first) in candidates.iter().enumerate() {
        for second in &candidates[index + 1..] {
            let ((a, c), (b, d)) = (&terms[*first], &terms[*second]);
            let sign = match () {
                () if c == d => Rational::ONE,
                () if (c + d).is_zero() => Rational::MINUS_ONE,
                () => continue,
            };
            if let Some(term) = together(graph, *a, *b, sign) {
                return Some((*first, *second, term));
            }
        }
    }
    None
}

/// Returns the number of sines and cosines among the factors of a term.
fn circular(graph: &Graph, term: ExprId) -> i32 {
    let is_circular = |e: ExprId| matches!(graph.node(e), Node::Function(Function::Sin | Function::Cos, _));
    match graph.node(term) {
        Node::Product(factors) => {
            factors.iter().filter(|(base, k)| *k > 0 && is_circular(*base)).map(|(_, k)| k).sum()
        }
        _ => 0,
    }
}

/// `a + sign*b` as one product.
fn together(graph: &Graph, a: ExprId, b: ExprId, sign: Rational) -> Option<Together> {
    use Function::{Cos, Sin};
    let (Node::Product(own), Node::Product(others)) = (graph.node(a), graph.node(b)) else { return None };
    let [(f, x), (g, y)] = factors_beyond(graph, own, others)?;
    let other = factors_beyond(graph, others, own)?;
    let has = |f: Function, x: ExprId, g: Function, y: ExprId| {
        other == [(f, x), (g, y)] || other == [(g, y), (f, x)]
    };
    let rest = own
        .iter()
        .map(|(base, k)| (*base, *k - i32::from([(f, x), (g, y)].iter().any(|own| is(graph, *base, *own)))))
        .filter(|(_, k)| *k != 0)
        .collect();
    let minus = -sign.clone();
    let (function, x, y, sign, factor) = match (f, g) {
        (Sin, Cos) if has(Cos, x, Sin, y) => (Sin, x, y, sign, Rational::ONE),
        (Cos, Sin) if has(Sin, x, Cos, y) => (Sin, y, x, sign, Rational::ONE),
        (Cos, Cos) if has(Sin, x, Sin, y) => (Cos, x, y, minus, Rational::ONE),
        (Sin, Sin) if has(Cos, x, Cos, y) => (Cos, x, y, minus, sign),
        _ => return None,
    };
    Some(Together { function, x, y, sign, factor, rest })
}

fn is(graph: &Graph, e: ExprId, (function, x): (Function, ExprId)) -> bool {
    *graph.node(e) == Node::Function(function, x)
}

/// The two sines or cosines that a product has beyond what it shares with another one, if that is all it has.
fn factors_beyond(
    graph: &Graph,
    own: &[(ExprId, i32)],
    others: &[(ExprId, i32)],
) -> Option<[(Function, ExprId); 2]> {
    let mut found = Vec::new();
    for (base, k) in own {
        let other = others.iter().find(|(other, _)| other == base).map_or(0, |(_, k)| *k);
        if *k <= other {
            continue;
        }
        match graph.node(*base) {
            Node::Function(function @ (Function::Sin | Function::Cos), x) if k - other == 1 => {
                found.push((*function, *x));
            }
            _ => return None,
        }
    }
    found.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::Contracted;
    use crate::algebra::{Graph, Rational, Role};

    #[test]
    fn all_four_theorems_with_what_stands_beside_them() {
        let mut g = Graph::new();
        let [a, b, m] = ["a", "b", "m"].map(|name| g.symbol(name, Role::Coordinate));
        let ((sa, ca), (sb, cb)) = (g.sin_cos(a), g.sin_cos(b));
        let products = [(sa, cb, ca, sb), (ca, cb, sa, sb), (sa, sb, ca, cb)];
        let mut shown = Vec::new();
        for (p, q, r, s) in products {
            for sign in [1, -1] {
                let first = g.product(&[(m, 2), (p, 1), (q, 1)]);
                let second = g.product(&[(m, 2), (r, 1), (s, 1)]);
                let e = g.linear(&[
                    (first, Rational::integer(3)),
                    (second, Rational::integer(3 * sign)),
                    (a, Rational::ONE),
                ]);
                let contracted = Contracted::of(&mut g, &[e]);
                shown.push(g.text(contracted.image(e)));
            }
        }
        assert_eq!(
            shown,
            [
                "a + 3*sin(a + b)*m^2",
                "a + 3*sin(a - b)*m^2",
                "a + 3*cos(a - b)*m^2",
                "a + 3*cos(a + b)*m^2",
                "a + 3*cos(a - b)*m^2",
                "a - 3*cos(a + b)*m^2",
            ]
        );
    }

    #[test]
    fn what_was_put_together_is_put_together_again() {
        // cos(a) (sin(b) cos(c) - cos(b) sin(c)) + sin(a) (cos(b) cos(c) + sin(b) sin(c)), multiplied out.
        let mut g = Graph::new();
        let x = ["a", "b", "c"].map(|name| g.symbol(name, Role::Coordinate));
        let [(sa, ca), (sb, cb), (sc, cc)] = x.map(|x| g.sin_cos(x));
        let term = |g: &mut Graph, p, q, r| g.product(&[(p, 1), (q, 1), (r, 1)]);
        let terms = [
            term(&mut g, ca, sb, cc),
            term(&mut g, ca, cb, sc),
            term(&mut g, sa, cb, cc),
            term(&mut g, sa, sb, sc),
        ];
        let minus = g.neg(terms[1]);
        let e = g.sum([terms[0], minus, terms[2], terms[3]]);
        let contracted = Contracted::of(&mut g, &[e]);
        assert_eq!(g.text(contracted.image(e)), "sin(a + b - c)");
    }

    #[test]
    fn what_does_not_fit_stays() {
        let mut g = Graph::new();
        let [a, b] = ["a", "b"].map(|name| g.symbol(name, Role::Coordinate));
        let ((sa, ca), (sb, cb)) = (g.sin_cos(a), g.sin_cos(b));
        let pairs = [(sa, cb, sa, sb, 1), (sa, cb, ca, sb, 2), (sa, sa, ca, ca, -1)];
        for (p, q, r, s, c) in pairs {
            let (first, second) = (g.mul(p, q), g.mul(r, s));
            let e = g.linear(&[(first, Rational::ONE), (second, Rational::integer(c))]);
            let contracted = Contracted::of(&mut g, &[e]);
            assert_eq!(contracted.image(e), e);
        }
    }
}
