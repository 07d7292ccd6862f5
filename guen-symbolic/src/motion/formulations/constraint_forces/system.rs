//! The equations of the constraint forces: rewritten in the angles between neighbours, scaled, and solved.

use std::collections::BTreeSet;

use crate::algebra::{ExprId, FastMap, Node, Rational, Role, Substitution};
use crate::motion::coordinates::relative_angles::RelativeAngles;
use crate::motion::mass_matrix::solve::{Elimination, Naming, eliminate};
use crate::motion::mass_matrix::sparse::Vector;
use crate::normal::{Limits, normal_coefficients};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The equations of the constraint forces, and the accelerations by them.
pub(super) struct System {
    /// `N^T K N`.
    pub(super) matrix: Vec<Vector>,
    /// Terms of the right sides.
    pub(super) right: Vec<Vec<ExprId>>,
    /// The rows of `P K N`.
    pub(super) coupled: Vec<Vec<(usize, ExprId)>>,
    /// Terms of the accelerations without constraint forces.
    pub(super) direct: Vec<Vec<ExprId>>,
}

impl System {
    /// The coefficients of the constraint forces.
    pub(super) fn entries(&self) -> Vec<ExprId> {
        let rows = self.matrix.iter().enumerate();
        let lower = rows.flat_map(|(s, row)| row.entries().iter().filter(move |(t, _)| *t <= s));
        lower.chain(self.coupled.iter().flatten()).map(|(_, e)| *e).collect()
    }

    pub(super) fn cost(&self, bench: &Workbench, beside: &[ExprId]) -> u64 {
        let terms = self.right.iter().chain(&self.direct).flatten();
        let all: Vec<ExprId> = self.entries().iter().chain(terms).chain(beside).copied().collect();
        weighted_cost(&bench.graph, &all)
    }

    /// Rewrites the system in the angles between neighbours.
    pub(super) fn rewritten(&self, bench: &mut Workbench, between: &RelativeAngles, etas: &[ExprId]) -> Self {
        let lists = |bench: &mut Workbench, lists: &[Vec<ExprId>]| -> Vec<Vec<ExprId>> {
            let sums = lists.iter().map(|list| {
                let sum = bench.graph.sum(list.iter().copied());
                between.within(bench, sum, |bench| terms(bench, sum, etas)).unwrap_or_else(|| list.clone())
            });
            sums.collect()
        };
        let tidy =
            |bench: &mut Workbench, e: ExprId| between.within(bench, e, |bench| bench.tidy(e)).unwrap_or(e);
        let mut matrix = self.matrix.clone();
        for (s, row) in self.matrix.iter().enumerate() {
            for (t, e) in row.entries().iter().filter(|(t, _)| *t <= s) {
                let entry = tidy(bench, *e);
                matrix[s].set(&bench.graph, *t, entry);
                matrix[*t].set(&bench.graph, s, entry);
            }
        }
        let mut coupled = self.coupled.clone();
        for (_, e) in coupled.iter_mut().flatten() {
            *e = tidy(bench, *e);
        }
        System { matrix, right: lists(bench, &self.right), coupled, direct: lists(bench, &self.direct) }
    }

    /// Chooses the sign of each constraint force: so that equations of neighbours have opposite ones, and most terms of the right sides are
    /// positive. Then what is eliminated adds up, and nothing has to be negated.
    fn signed(&mut self, bench: &mut Workbench) {
        let count = self.right.len();
        let is_negative = |bench: &mut Workbench, e: ExprId| bench.graph.split_content(e).0.is_negative();
        let mut flips: Vec<Option<bool>> = vec![None; count];
        for start in 0..count {
            if flips[start].is_some() {
                continue;
            }
            flips[start] = Some(false);
            let mut block = vec![start];
            let mut next = 0;
            while let Some(s) = block.get(next).copied() {
                next += 1;
                for (t, e) in self.matrix[s].entries() {
                    if flips[*t].is_none() {
                        let same = is_negative(bench, *e);
                        flips[*t] = flips[s].map(|flip| flip == same);
                        block.push(*t);
                    }
                }
            }
            let terms: Vec<(usize, ExprId)> =
                block.iter().flat_map(|s| self.right[*s].iter().map(|e| (*s, *e))).collect();
            let negative =
                terms.iter().filter(|(s, e)| is_negative(bench, *e) != (flips[*s] == Some(true))).count();
            if 2 * negative > terms.len() {
                block.iter().for_each(|s| flips[*s] = flips[*s].map(|flip| !flip));
            }
        }
        let flips: Vec<bool> = flips.into_iter().map(|flip| flip == Some(true)).collect();
        for (s, row) in self.matrix.iter_mut().enumerate() {
            for (_, e) in row.entries_mut().filter(|(t, _)| flips[*t] != flips[s]) {
                *e = bench.graph.neg(*e);
            }
        }
        let right = self.right.iter_mut().zip(&flips).filter(|(_, flip)| **flip).flat_map(|(row, _)| row);
        let coupled = self.coupled.iter_mut().flatten().filter(|(t, _)| flips[*t]).map(|(_, e)| e);
        right.chain(coupled).for_each(|e| *e = bench.graph.neg(*e));
    }

    /// The accelerations.
    pub(super) fn solved(mut self, bench: &mut Workbench) -> Option<Vec<ExprId>> {
        self.signed(bench);
        // One scale for all constraint forces, and one for their equations: both leave ones where there were constants.
        let entries = self.matrix.iter().flat_map(Vector::entries);
        let scale = most_common(bench, entries.map(|(_, e)| *e));
        let size = most_common(bench, self.right.iter().flatten().copied());
        for (_, entry) in self.matrix.iter_mut().flat_map(Vector::entries_mut) {
            let quotient = bench.graph.div(*entry, scale);
            *entry = bench.tidy(quotient);
        }
        let right: Vec<ExprId> = self
            .right
            .into_iter()
            .map(|parts| {
                let parts: Vec<ExprId> = parts.into_iter().map(|e| bench.graph.div(e, size)).collect();
                bench.graph.sum(parts)
            })
            .collect();
        let forces = by_least_fill(bench, self.matrix, right)?;
        let rows = self.coupled.into_iter().zip(self.direct);
        let accelerations = rows.map(|(coupled, direct)| {
            let mut parts = Vec::new();
            for (t, e) in coupled {
                let e = bench.graph.product(&[(e, 1), (size, 1), (scale, -1)]);
                let e = bench.tidy(e);
                let e = bench.graph.keep(e);
                parts.push(bench.graph.mul(e, forces[t]));
            }
            parts.extend(direct);
            bench.graph.sum(parts)
        });
        Some(accelerations.collect())
    }
}

/// Returns a force in which sums are kept whole that are factors of products. The force of a spring has the place of its end as such a
/// factor: a sum with a term for each link.
pub(super) fn with_whole_factors(bench: &mut Workbench, e: ExprId) -> ExprId {
    let mut whole = Substitution::default();
    let mut inner: BTreeSet<ExprId> = BTreeSet::new();
    for id in bench.graph.reachable(&[e], |_| false) {
        let mut is_inner = bench.graph.children(id).iter().any(|part| inner.contains(part));
        if !is_inner {
            for (base, _) in bench.graph.factors(id).to_vec() {
                let roles = bench.graph.roles(base);
                if summands(bench, base).len() > 1 && !roles.is_constant() {
                    let kept = bench.graph.keep(base);
                    whole.add(base, kept);
                    is_inner = true;
                }
            }
        }
        if is_inner {
            inner.insert(id);
        }
    }
    whole.of(&mut bench.graph, e)
}

/// The terms of a force of a long family. A sum that is multiplied by another function of the coordinates is kept whole; the sums inside are
/// not visited, because they are as long as the family.
pub(super) fn terms_with_whole_factors(bench: &mut Workbench, e: ExprId) -> Vec<ExprId> {
    let whole = |bench: &mut Workbench, term: ExprId| {
        let (coefficient, monomial) = bench.graph.split_coefficient(term);
        let mut factors = bench.graph.factors(monomial).to_vec();
        let is_moving = |(base, _): &&(ExprId, i32)| bench.graph.roles(*base).has(Role::Coordinate);
        // Multiples of sums of functions of the coordinates are sums, of which neighbours have most in common.
        match factors.iter().filter(is_moving).count() {
            0 => return spread(bench, vec![term]),
            1 => return vec![term],
            _ => {}
        }
        for (base, _) in &mut factors {
            if summands(bench, *base).len() > 1 && bench.graph.roles(*base).has(Role::Coordinate) {
                *base = bench.graph.keep(*base);
            }
        }
        let product = bench.graph.product(&factors);
        vec![bench.graph.scale(product, &coefficient)]
    };
    summands(bench, e).into_iter().flat_map(|term| whole(bench, term)).collect()
}

/// The terms of a polynomial in the parameters with tidy coefficients, or of the sum as it is.
pub(super) fn terms(bench: &mut Workbench, e: ExprId, etas: &[ExprId]) -> Vec<ExprId> {
    let limits = Limits { nodes: 400, steps: 6_000, ..Limits::default() };
    let mut found = Vec::new();
    match normal_coefficients(&mut bench.graph, e, etas, &limits) {
        Some(coefficients) => {
            for (exponents, c) in coefficients {
                let factors = etas.iter().zip(exponents).map(|(eta, k)| (*eta, k as i32)).chain([(c, 1)]);
                let factors: Vec<_> = factors.filter(|(_, k)| *k != 0).collect();
                let product = bench.graph.product(&factors);
                found.extend(summands(bench, product));
            }
        }
        None => found = summands(bench, e),
    }
    found
}

/// The terms of a sum.
pub(super) fn summands(bench: &mut Workbench, e: ExprId) -> Vec<ExprId> {
    match bench.graph.node(e).clone() {
        Node::Sum { constant, terms } => {
            let mut found: Vec<ExprId> = terms.iter().map(|(term, c)| bench.graph.scale(*term, c)).collect();
            if !constant.is_zero() {
                found.push(bench.graph.number(constant));
            }
            found
        }
        _ if bench.graph.is_zero(e) => Vec::new(),
        _ => vec![e],
    }
}

/// Multiplies out the sums among the factors of terms, where these depend on the state. Of several long sums in one product only one is
/// multiplied out: products of all their terms would be more than any rate has.
pub(super) fn spread(bench: &mut Workbench, terms: Vec<ExprId>) -> Vec<ExprId> {
    /// The terms of the shorter sums of a product, multiplied: a length beside a constant has two.
    const MOST_BESIDE_THE_LONGEST: usize = 8;
    let mut found = Vec::new();
    // Each with the number of products that it is one of, and the longest sum in them.
    let mut open: Vec<(ExprId, usize, usize)> = terms.into_iter().map(|term| (term, 1, 1)).collect();
    while let Some((term, products, longest)) = open.pop() {
        let (coefficient, monomial) = bench.graph.split_coefficient(term);
        // The opposite of a sum.
        if let Node::Sum { .. } = bench.graph.node(monomial) {
            open.extend(summands(bench, monomial).into_iter().map(|part| {
                let part = bench.graph.scale(part, &coefficient);
                (part, products, longest)
            }));
            continue;
        }
        let factors = bench.graph.factors(monomial).to_vec();
        let is_sum = |(base, k): &(ExprId, i32)| {
            *k == 1
                && matches!(bench.graph.node(*base), Node::Sum { .. })
                && !bench.graph.roles(*base).is_constant()
        };
        let Some((sum, _)) = factors.into_iter().find(is_sum) else {
            found.push(term);
            continue;
        };
        let parts = summands(bench, sum);
        let (products, longest) = (products.saturating_mul(parts.len()), longest.max(parts.len()));
        if products / longest > MOST_BESIDE_THE_LONGEST {
            found.push(term);
            continue;
        }
        let others = bench.graph.div(term, sum);
        for part in parts {
            let product = bench.graph.mul(others, part);
            open.extend(summands(bench, product).into_iter().map(|part| (part, products, longest)));
        }
    }
    found.reverse();
    found
}

/// The constant factor that most of the expressions have that are not constant, of positive sign; one if it might vanish.
fn most_common(bench: &mut Workbench, es: impl Iterator<Item = ExprId>) -> ExprId {
    let mut counts: FastMap<ExprId, usize> = FastMap::default();
    for e in es {
        if bench.graph.roles(e).is_constant() {
            continue;
        }
        let graph = &mut bench.graph;
        let (content, primitive) = graph.split_content(e);
        let factors: Vec<(ExprId, i32)> = match graph.node(primitive) {
            Node::Product(factors) => factors.to_vec(),
            _ => Vec::new(),
        };
        let factors: Vec<_> =
            factors.into_iter().filter(|(base, _)| graph.roles(*base).is_constant()).collect();
        let size = if content.is_negative() { &content * &Rational::MINUS_ONE } else { content };
        let number = graph.number(size);
        let product = graph.product(&factors);
        let constant = graph.mul(number, product);
        *counts.or_default(constant) += 1;
    }
    let mut best = (0, bench.graph.one());
    for (constant, count) in counts.iter() {
        if *count > best.0 {
            best = (*count, *constant);
        }
    }
    if bench.graph.manifestly_nonzero(best.1) { best.1 } else { bench.graph.one() }
}

/// Solves a positive definite system in the order of least fill; among equals that which waits least for others.
fn by_least_fill(bench: &mut Workbench, matrix: Vec<Vector>, right: Vec<ExprId>) -> Option<Vec<ExprId>> {
    let mut waiting = vec![0_usize; right.len()];
    let others = |(s, row): (usize, &Vector)| -> BTreeSet<usize> {
        row.entries().iter().map(|(t, _)| *t).filter(|t| *t != s).collect()
    };
    // Those that are left and meet each row; whoever leaves joins its neighbours.
    let mut neighbours: Vec<BTreeSet<usize>> = matrix.iter().enumerate().map(others).collect();
    let mut left: BTreeSet<(usize, usize, usize)> =
        neighbours.iter().enumerate().map(|(k, around)| (around.len(), 0, k)).collect();
    // A long family is gone through in one direction, so that every member is eliminated in the same way.
    let one_way = bench.graph.nests_sums();
    let choose = |_: &mut Workbench, _: &[Vector], _: &[usize]| {
        let (.., k) = left.pop_first()?;
        let around = core::mem::take(&mut neighbours[k]);
        for r in &around {
            left.remove(&(neighbours[*r].len(), waiting[*r], *r));
            if !one_way {
                waiting[*r] = waiting[*r].max(waiting[k] + 1);
            }
            neighbours[*r].remove(&k);
            neighbours[*r].extend(around.iter().filter(|other| *other != r));
            left.insert((neighbours[*r].len(), waiting[*r], *r));
        }
        Some(k)
    };
    eliminate(bench, matrix, right, Naming::Definite, choose).map(|Elimination { values, .. }| values)
}

#[cfg(test)]
mod tests {
    use super::spread;
    use crate::algebra::{ExprId, Graph, Role};
    use crate::workbench::Workbench;

    /// A spring with a length has two sums in its force; inner products of places have many.
    #[test]
    fn products_of_long_sums_are_not_multiplied_out() {
        let mut bench = Workbench::new(Graph::new());
        let mut sum = |name: &str, terms: usize| {
            let terms: Vec<ExprId> =
                (0..terms).map(|k| bench.graph.symbol(&format!("{name}{k}"), Role::Coordinate)).collect();
            bench.graph.sum(terms)
        };
        let [short, long, other, third] = [("a", 2), ("b", 30), ("c", 30), ("d", 30)].map(|(n, k)| sum(n, k));
        let few = bench.graph.product(&[(short, 1), (long, 1)]);
        assert_eq!(spread(&mut bench, vec![few]).len(), 60);
        let many = bench.graph.product(&[(long, 1), (other, 1), (third, 1)]);
        assert!(spread(&mut bench, vec![many]).len() <= 30);
    }
}
