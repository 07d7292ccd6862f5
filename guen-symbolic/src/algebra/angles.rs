//! Base angles: the angles whose sines and cosines all others are expressed by.
//!
//! A chain in relative angles uses `q_1`, `q_1 + q_2`, `q_1 + q_2 + q_3`; nobody would multiply `sin(q_1 + q_2 + q_3)` out
//! into sines and cosines of single coordinates. So the base is chosen from the arguments of sines and cosines that a
//! declaration uses: those with the fewest terms first, each that is no rational combination of the earlier ones. With
//! `a`, `b` and `a - b` it is `{a, b}`; with `q_1/2` and `q_1` it is `{q_1/2}`.

use std::cell::RefCell;
use std::collections::BTreeMap;

use super::base_angles::{AngleParts, BaseAngles};
use super::{ExprId, FastMap, Function, Graph, Node, Rational};

/// The number of terms above which an argument is no base angle and stays whole: the last joint of a long chain turns with all before it.
const ARGUMENT_TERMS: usize = 200;

impl Graph {
    /// A declaration begins: until its base angles are chosen every argument is an angle of its own.
    pub fn keep_angles_whole(&mut self) {
        self.base_angles = BaseAngles { are_whole: true, ..BaseAngles::default() };
    }

    /// The base angles that were chosen.
    pub(crate) fn base_angles(&self) -> &[ExprId] {
        &self.base_angles.base
    }

    /// Whether all sines and cosines in an expression are those of base angles.
    pub fn is_in_base_angles(&self, e: ExprId) -> bool {
        self.reachable(&[e], |id| self.roles(id).is_constant()).into_iter().all(|id| match self.node(id) {
            Node::Function(Function::Sin | Function::Cos, x) => self.base_angles.base.contains(x),
            _ => true,
        })
    }

    /// Puts base angles that were taken out before back, and takes those out that are there now.
    pub(crate) fn exchange_base_angles(&mut self, other: &mut BaseAngles) {
        core::mem::swap(&mut self.base_angles, other);
    }

    /// Chooses base angles for the sines and cosines among some expressions; given ones come first.
    pub(crate) fn choose_base_angles(&mut self, given: &[ExprId], roots: &[ExprId]) {
        let arguments = self.reachable(roots, |id| self.roles(id).is_constant()).into_iter();
        let mut arguments: Vec<ExprId> = arguments
            .filter_map(|id| match self.node(id) {
                Node::Function(Function::Sin | Function::Cos, x) => Some(*x),
                _ => None,
            })
            .collect();
        // Sines before cosines or after them: the order is that of the first of both.
        let mut seen: FastMap<ExprId, ()> = FastMap::default();
        arguments.retain(|x| seen.insert(*x, ()).is_none());
        let mut rows: Vec<AngleParts> = arguments
            .iter()
            .map(|x| self.linear_parts(*x))
            .filter(|parts| parts.len() <= ARGUMENT_TERMS && parts.iter().all(|(e, _)| self.is_monomial(*e)))
            .collect();
        // Stable: arguments of equal length in the order of their appearance.
        rows.sort_by_key(Vec::len);
        let mut images: BTreeMap<ExprId, AngleParts> = BTreeMap::new();
        let mut base: Vec<ExprId> = given.to_vec();
        for parts in rows {
            if let [(single, _)] = parts[..] {
                if !base.contains(&single) {
                    base.push(single);
                }
                continue;
            }
            let rest = self.with_images(&images, &parts);
            // The youngest monomial that is still free: in a chain the angle of the last joint.
            let free = |(e, _): &&(ExprId, Rational)| !base.contains(e) && !self.roles(*e).is_constant();
            let Some((lead, c)) = rest.iter().filter(free).max_by_key(|(e, _)| *e).cloned() else { continue };
            let Some(inverse) = c.recip() else { continue };
            let x = self.angle(&parts);
            let flipped =
                self.linear_parts(x).iter().any(|part| part.0 == parts[0].0 && part.1 != parts[0].1);
            // lead = (x - others)/c
            let others = rest.iter().filter(|(e, _)| *e != lead).map(|(e, k)| (*e, -(k * &inverse)));
            let own = if flipped { -inverse.clone() } else { inverse.clone() };
            let image: AngleParts = others.chain([(x, own)]).collect();
            let own = BTreeMap::from([(lead, image.clone())]);
            for other in images.values_mut() {
                *other = self.with_images(&own, other);
            }
            images.insert(lead, image);
            base.push(x);
        }
        self.base_angles = BaseAngles { are_whole: false, base, images, known: RefCell::default() };
    }

    /// A sum of several terms as an angle: of the two signs the one that sines and cosines are written with.
    fn angle(&mut self, parts: &[(ExprId, Rational)]) -> ExprId {
        let x = self.linear(parts);
        match self.node(x) {
            Node::Sum { terms, .. } if terms[0].1.is_negative() => self.neg(x),
            _ => x,
        }
    }

    /// An argument by base angles, and by monomials that none stands for.
    pub(crate) fn angle_parts(&self, x: ExprId) -> AngleParts {
        let BaseAngles { are_whole, images, known, .. } = &self.base_angles;
        if let Some(known) = known.borrow().get(&x) {
            return known.clone();
        }
        let parts = self.linear_parts(x);
        let parts = match parts.len() {
            2.. if *are_whole => vec![(x, Rational::ONE)],
            _ if images.is_empty() => parts,
            _ => self.with_images(images, &parts),
        };
        known.borrow_mut().insert(x, parts.clone());
        parts
    }

    fn with_images(&self, images: &BTreeMap<ExprId, AngleParts>, parts: &[(ExprId, Rational)]) -> AngleParts {
        let mut sum: BTreeMap<(u64, ExprId), Rational> = BTreeMap::new();
        let mut add = |e: ExprId, c: Rational| {
            let slot = sum.entry(self.key(e)).or_default();
            *slot = &*slot + &c;
        };
        for (e, c) in parts {
            match images.get(e) {
                Some(image) => image.iter().for_each(|(base, k)| add(*base, k * c)),
                None => add(*e, c.clone()),
            }
        }
        collected(sum)
    }

    /// The terms of a sum, sums of sums opened; the number is the multiple of one.
    pub(crate) fn linear_parts(&self, x: ExprId) -> AngleParts {
        let mut sum: BTreeMap<(u64, ExprId), Rational> = BTreeMap::new();
        let mut stack = vec![(x, Rational::ONE)];
        while let Some((e, c)) = stack.pop() {
            match self.node(e) {
                Node::Number(value) => {
                    let slot = sum.entry(self.key(self.one())).or_default();
                    *slot = &*slot + &(value * &c);
                }
                Node::Sum { constant, terms } => {
                    if !constant.is_zero() {
                        stack.push((self.one(), constant * &c));
                    }
                    stack.extend(terms.iter().map(|(term, k)| (*term, k * &c)));
                }
                _ => {
                    let slot = sum.entry(self.key(e)).or_default();
                    *slot = &*slot + &c;
                }
            }
        }
        collected(sum)
    }

    /// Whether an expression is a sum of monomials, sums of sums opened.
    pub(crate) fn is_sum_of_monomials(&self, sum: ExprId) -> bool {
        let mut stack = vec![sum];
        while let Some(e) = stack.pop() {
            match self.node(e) {
                Node::Sum { terms, .. } => {
                    let terms: &[(ExprId, Rational)] = terms;
                    let mut index = 0;
                    while index < terms.len() {
                        stack.push(terms[index].0);
                        index += 1;
                    }
                }
                _ if self.is_monomial(e) => {}
                // Unless it cancels.
                _ => return self.linear_parts(sum).iter().all(|(term, _)| self.is_monomial(*term)),
            }
        }
        true
    }

    /// Whether an expression is a number, a symbol, pi, or a product of such.
    pub(crate) fn is_monomial(&self, e: ExprId) -> bool {
        match self.node(e) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => true,
            Node::Product(factors) => {
                factors.iter().all(|(base, _)| matches!(self.node(*base), Node::Symbol(_) | Node::Pi))
            }
            _ => false,
        }
    }
}

fn collected(sum: BTreeMap<(u64, ExprId), Rational>) -> AngleParts {
    sum.into_iter().filter(|(_, c)| !c.is_zero()).map(|((_, e), c)| (e, c)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::Role;

    fn graph() -> (Graph, [ExprId; 3]) {
        let mut g = Graph::new();
        let q = ["q1", "q2", "q3"].map(|name| g.symbol(name, Role::Coordinate));
        (g, q)
    }

    fn parts(g: &Graph, x: ExprId) -> Vec<(String, Rational)> {
        g.angle_parts(x).into_iter().map(|(e, c)| (g.text(e), c)).collect()
    }

    #[test]
    fn sums_that_a_chain_uses_are_base_angles() {
        let (mut g, [q1, q2, q3]) = graph();
        let s2 = g.add(q1, q2);
        let s3 = g.add(s2, q3);
        let roots = [g.sin(q1), g.cos(s2), g.sin(s3)];
        g.choose_base_angles(&[], &roots);
        assert_eq!(g.base_angles(), [q1, s2, s3]);
        // q3 = s3 - s2
        let expected = [(s2, Rational::MINUS_ONE), (s3, Rational::ONE)];
        let found: BTreeMap<_, _> = g.angle_parts(q3).into_iter().collect();
        assert_eq!(found, BTreeMap::from(expected));
    }

    #[test]
    fn dependent_sums_are_taken_apart() {
        let (mut g, [a, b, _]) = graph();
        let difference = g.sub(a, b);
        // The sum is seen first, and the angles are the base all the same.
        let roots = [g.sin(difference), g.sin(a), g.cos(b)];
        g.choose_base_angles(&[], &roots);
        assert_eq!(g.base_angles().len(), 2);
        assert!(!g.base_angles().contains(&difference));
        let mut found = parts(&g, difference);
        found.sort_by(|x, y| x.0.cmp(&y.0));
        assert_eq!(found, [("q1".to_owned(), Rational::ONE), ("q2".to_owned(), Rational::MINUS_ONE)]);
    }

    #[test]
    fn given_angles_come_first_and_constants_belong_to_sums() {
        let (mut g, [q1, q2, _]) = graph();
        let b = g.symbol("b", Role::Constant);
        let first = g.add(q1, b);
        let second = g.sum([q1, q2, b, b]);
        let roots = [g.sin(first), g.sin(second)];
        g.choose_base_angles(&[], &roots);
        assert_eq!(g.base_angles(), [first, second]);
        g.choose_base_angles(&[q1], &roots);
        assert_eq!(g.base_angles()[0], q1);
        let sum: Vec<_> = g.angle_parts(first).into_iter().map(|(e, _)| e).collect();
        assert!(sum.contains(&q1) && sum.contains(&b));
    }

    #[test]
    fn sums_of_sums_are_opened() {
        let mut g = Graph::new();
        let q: Vec<_> = (0..12).map(|i| g.symbol(&format!("q{i}"), Role::Coordinate)).collect();
        let mut sum = q[0];
        let mut roots = vec![g.sin(sum)];
        for x in &q[1..] {
            sum = g.add(sum, *x);
            roots.push(g.sin(sum));
        }
        g.choose_base_angles(&[], &roots);
        assert_eq!(g.base_angles().len(), 12);
        assert_eq!(g.angle_parts(sum).len(), 1);
        assert_eq!(g.angle_parts(q[11]).len(), 2);
    }
}
