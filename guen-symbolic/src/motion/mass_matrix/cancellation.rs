//! `f d - m g` without the products that both sides have.
//!
//! The acceleration that is found by putting another one back is `(f - m x)/p` with `x = g/d`. Next to a pole of the mass
//! matrix both terms can grow without bound while their difference does not: the inertia of a car that turns on the spot is in
//! `f`, in `d` and in `g`, and its digits cover all others. As `(f d - m g)/(p d)` these products meet, and leave before
//! anything is rounded.

use crate::motion::thresholds::CANCELLATION_PRODUCTS;
use std::collections::BTreeMap;

use crate::algebra::{ExprId, Graph, Node, Rational};

/// `f d - m g`, or `None` where nothing cancels.
pub(super) fn difference(graph: &mut Graph, [f, d]: [ExprId; 2], [m, g]: [ExprId; 2]) -> Option<ExprId> {
    let mut left = Product::new(graph, f, d, CANCELLATION_PRODUCTS)?;
    let mut right = Product::new(graph, m, g, CANCELLATION_PRODUCTS)?;
    if left.size() + right.size() > CANCELLATION_PRODUCTS {
        return None;
    }
    let mut places: BTreeMap<ExprId, Vec<(usize, usize)>> = BTreeMap::new();
    for (k, i) in left.places() {
        let (monomial, _) = left.term(graph, k, i);
        places.entry(monomial).or_default().push((k, i));
    }
    let mut cancels = false;
    for (h, j) in right.places() {
        let (monomial, b) = right.term(graph, h, j);
        for (k, i) in places.get(&monomial).into_iter().flatten().copied() {
            let (_, a) = left.term(graph, k, i);
            if a.is_zero() || b.is_zero() || a.is_negative() != b.is_negative() {
                continue;
            }
            // What is left of the first is part of its factor, and the second is gone.
            let rest = &(&a - &b) * &a.recip()?;
            left.parts[k][i] = &left.parts[k][i] * &rest;
            right.parts[h][j] = Rational::ZERO;
            cancels = true;
            break;
        }
    }
    if !cancels {
        return None;
    }
    let (left, right) = (left.sum(graph), right.sum(graph));
    Some(graph.sub(left, right))
}

/// A product of two sums, multiplied out.
struct Product {
    outer: Sum,
    inner: Sum,
    /// The remaining multiple of each product, by the monomials of the first sum and those of the second.
    parts: Vec<Vec<Rational>>,
}

impl Product {
    fn new(graph: &mut Graph, outer: ExprId, inner: ExprId, most: usize) -> Option<Self> {
        let (outer, inner) = (Sum::new(graph, outer, most)?, Sum::new(graph, inner, most)?);
        let parts = vec![vec![Rational::ONE; inner.monomials.len()]; outer.monomials.len()];
        Some(Product { outer, inner, parts })
    }

    fn size(&self) -> usize {
        self.outer.monomials.len() * self.inner.monomials.len()
    }

    fn places(&self) -> Vec<(usize, usize)> {
        (0..self.outer.monomials.len())
            .flat_map(|k| (0..self.inner.monomials.len()).map(move |i| (k, i)))
            .collect()
    }

    /// Returns one of the products, and its coefficient.
    fn term(&self, graph: &mut Graph, k: usize, i: usize) -> (ExprId, Rational) {
        let (a, b) = (&self.outer.monomials[k], &self.inner.monomials[i]);
        let product = graph.mul(a.monomial, b.monomial);
        let (content, monomial) = graph.split_coefficient(product);
        (monomial, &(&content * &self.parts[k][i]) * &(&a.coefficient * &b.coefficient))
    }

    /// Returns the sum that is left: each distinct part of the second sum times the sum of the monomials of the first
    /// that have it.
    fn sum(&self, graph: &mut Graph) -> ExprId {
        let mut sums = Vec::new();
        let mut done = vec![false; self.parts.len()];
        for k in 0..self.parts.len() {
            if done[k] {
                continue;
            }
            let mut alike = vec![Rational::ZERO; self.parts.len()];
            for h in (k..self.parts.len()).filter(|h| self.parts[*h] == self.parts[k]) {
                (done[h], alike[h]) = (true, Rational::ONE);
            }
            let (factor, rest) = (self.outer.part(graph, &alike), self.inner.part(graph, &self.parts[k]));
            sums.push(graph.mul(factor, rest));
        }
        graph.sum(sums)
    }
}

/// A sum, and the monomials of its terms.
struct Sum {
    terms: Vec<(ExprId, Rational)>,
    monomials: Vec<Monomial>,
}

struct Monomial {
    /// The place of the term that it comes from.
    term: usize,
    monomial: ExprId,
    coefficient: Rational,
}

impl Sum {
    /// The terms with products of sums multiplied out; what is kept whole stays a factor. `None` if there are more than so
    /// many.
    fn new(graph: &mut Graph, e: ExprId, most: usize) -> Option<Self> {
        let mut terms = Vec::new();
        let mut nested = vec![(e, Rational::ONE)];
        while let Some((e, c)) = nested.pop() {
            match summands(graph, e) {
                Some(own) => nested.extend(own.into_iter().map(|(term, k)| (term, &k * &c))),
                None => terms.push((e, c)),
            }
        }
        let mut monomials = Vec::new();
        for (term, (e, c)) in terms.iter().enumerate() {
            let mut open = vec![(*e, c.clone())];
            while let Some((e, c)) = open.pop() {
                if monomials.len() + open.len() > most {
                    return None;
                }
                match summands(graph, e).or_else(|| multiplied_out(graph, e)) {
                    Some(own) => open.extend(own.into_iter().map(|(term, k)| (term, &k * &c))),
                    None => monomials.push(Monomial { term, monomial: e, coefficient: c }),
                }
            }
        }
        Some(Sum { terms, monomials })
    }

    /// Returns the given multiples of the monomials; terms that are there as a whole stay as they are written.
    fn part(&self, graph: &mut Graph, of: &[Rational]) -> ExprId {
        let mut left = Vec::new();
        for (term, whole) in self.terms.iter().enumerate() {
            let own = || self.monomials.iter().zip(of).filter(|(monomial, _)| monomial.term == term);
            if own().all(|(_, part)| part.is_one()) {
                left.push(whole.clone());
            } else {
                left.extend(own().map(|(m, part)| (m.monomial, &m.coefficient * part)));
            }
        }
        left.retain(|(_, c)| !c.is_zero());
        graph.linear(&left)
    }
}

/// The terms of a sum; a number is one times itself.
fn summands(graph: &Graph, e: ExprId) -> Option<Vec<(ExprId, Rational)>> {
    match graph.node(e) {
        Node::Number(value) if e != graph.one() => Some(vec![(graph.one(), value.clone())]),
        Node::Sum { constant, terms } => {
            let number = (!constant.is_zero()).then(|| (graph.one(), constant.clone()));
            Some(number.into_iter().chain(terms.iter().cloned()).collect())
        }
        _ => None,
    }
}

/// A product with a sum in it by the terms of that sum.
fn multiplied_out(graph: &mut Graph, e: ExprId) -> Option<Vec<(ExprId, Rational)>> {
    let Node::Product(factors) = graph.node(e) else { return None };
    let is_sum = |(base, k): &(ExprId, i32)| *k > 0 && matches!(graph.node(*base), Node::Sum { .. });
    let place = factors.iter().position(is_sum)?;
    let mut others = factors.to_vec();
    others[place].1 -= 1;
    let sum = summands(graph, others[place].0)?;
    let others = graph.product(&others);
    Some(sum.into_iter().map(|(term, k)| (graph.mul(others, term), k)).collect())
}

#[cfg(test)]
mod tests {
    use super::difference;
    use crate::algebra::{ExprId, Graph, Role};
    use crate::zero::evaluate_f64;

    fn symbols<const N: usize>(g: &mut Graph) -> [ExprId; N] {
        std::array::from_fn(|i| g.symbol(&format!("x{i}"), Role::Coordinate))
    }

    /// `f d - m g` as it is, and by [`difference`], at a point.
    fn both(g: &mut Graph, [f, d]: [ExprId; 2], [m, n]: [ExprId; 2]) -> Option<[f64; 2]> {
        let (first, second) = (g.mul(f, d), g.mul(m, n));
        let plain = g.sub(first, second);
        let short = difference(g, [f, d], [m, n])?;
        let values = evaluate_f64(g, &[plain, short], &|symbol| (1.3 * symbol.index() as f64 + 0.7).sin());
        Some([values[0], values[1]])
    }

    #[test]
    fn products_of_both_sides_are_gone_and_the_rest_stays_in_factors() {
        // (a + b) (p q + r s) - p (a q + 3 t)
        let mut g = Graph::new();
        let [a, b, p, q, r, s, t] = symbols(&mut g);
        let (f, pq, rs, aq) = (g.add(a, b), g.mul(p, q), g.mul(r, s), g.mul(a, q));
        let three = g.number(3);
        let t3 = g.mul(three, t);
        let (d, n) = (g.add(pq, rs), g.add(aq, t3));
        let [plain, short] = both(&mut g, [f, d], [p, n]).expect("a p q is on both sides");
        assert!((plain - short).abs() < 1e-15, "{plain} {short}");
        let short = difference(&mut g, [f, d], [p, n]).expect("as before");
        // a r s + b (p q + r s) - 3 p t
        let parts = [g.mul(a, rs), g.mul(b, d), g.mul(p, t3)];
        let minus = g.neg(parts[2]);
        assert_eq!(short, g.sum([parts[0], parts[1], minus]), "{}", g.text(short));
    }

    #[test]
    fn a_part_of_a_product_is_left() {
        // a (2 b + c) - a (5 b - c), inside of products of sums too.
        let mut g = Graph::new();
        let [a, b, c, e] = symbols(&mut g);
        let [two, five] = [2, 5].map(|n| g.number(n));
        let (b2, b5) = (g.mul(two, b), g.mul(five, b));
        let (d, n) = (g.add(b2, c), g.sub(b5, c));
        let [plain, short] = both(&mut g, [a, d], [a, n]).expect("two of the five");
        assert!((plain - short).abs() < 1e-15, "{plain} {short}");
        let ce = g.add(c, e);
        let (d, n) = (g.mul(b, ce), g.mul(b, e));
        let one = g.one();
        let rest = difference(&mut g, [one, d], [one, n]);
        assert_eq!(rest, Some(g.mul(b, c)));
    }

    #[test]
    fn where_nothing_is_on_both_sides_nothing_is_done() {
        let mut g = Graph::new();
        let [a, b, c, d] = symbols(&mut g);
        let (sum, minus) = (g.add(a, b), g.neg(a));
        let zero = g.zero();
        assert_eq!(difference(&mut g, [sum, c], [b, d]), None);
        // Of opposite signs they add up.
        assert_eq!(difference(&mut g, [a, c], [minus, c]), None);
        assert_eq!(difference(&mut g, [zero, c], [b, c]), None);
    }
}
