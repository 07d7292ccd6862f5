//! The third way to solve: the reactions between the velocity forms as unknowns.
//!
//! In a chain each mass feels its two links only, but in the mass matrix `M = U^T D U` of the parameters every link meets
//! every other: the forms `u = U eta` of the particles are long sums. As differences from each other, `S u = B eta` with
//! the tree `S` of `tree`, they are short, and the equations
//!
//! ```text
//! U^T D u' = g,   u' = U eta' + D(u)
//! ```
//!
//! are, with the reactions `lambda` of the differences,
//!
//! ```text
//! D u' = S^T lambda,   S u' = B eta' + c,   B^T lambda = g,
//! ```
//!
//! all of them sparse. The rates `u'` go first, for the masses are positive: `K = S D^-1 S^T`, `B eta' = K lambda - c`.
//! Then `lambda = lambda_c + P^T g + N sigma` with `B^T N = 0` and `P B = 1` of `balance`, which leaves the tensions
//!
//! ```text
//! N^T K N sigma = N^T (c - K (lambda_c + P^T g)),   eta' = P (K lambda - c).
//! ```
//!
//! `N^T K N` is positive definite wherever the mass matrix is regular, so that its elimination needs no licence for a
//! pivot and may go in the order of least fill; for a chain it is tridiagonal. `lambda_c` is constant and takes forces
//! like weight out of `g` where they are constant along a difference: at rest the tensions are known.

mod angles;
mod balance;
mod pattern;
mod sparse;
mod tree;

use super::projection::Squares;
use super::solve::{Elimination, Naming, eliminate};
use super::{Equations, Frame};
use crate::algebra::{ExprId, FastMap, Node, Rational};
use crate::normal::{Limits, normal_coefficients};
use crate::program::weighted_cost;
use crate::workbench::Workbench;
use angles::Between;
use balance::{Balance, balance};
use pattern::Pattern;
use sparse::Vector;
use tree::Edge;

/// The accelerations by tensions.
pub(super) struct Tensions {
    /// `eta_1'..eta_l'`.
    pub(super) accelerations: Vec<ExprId>,
    /// What was divided by: it vanishes only where the mass matrix is singular.
    pub(super) divisors: Vec<ExprId>,
    /// Whether the mass matrix would cost much more, judged by the patterns of both.
    pub(super) is_clear: bool,
}

/// The forms as differences.
struct Stretched<'a> {
    edges: &'a [Option<Edge>],
    /// `1/m_k`.
    weights: &'a [ExprId],
}

impl Stretched<'_> {
    /// `S^T y`.
    fn of(&self, bench: &mut Workbench, y: &Vector) -> Vector {
        let mut image = Vector::default();
        for (k, e) in y.entries() {
            image.add(bench, *k, *e);
            if let Some(Edge { parent, multiple }) = &self.edges[*k] {
                let part = bench.graph.scale(*e, &-multiple.clone());
                image.add(bench, *parent, part);
            }
        }
        image
    }

    /// `K y` for `z = S^T y`: the differences of the rates.
    fn rates(&self, bench: &mut Workbench, z: &Vector) -> Vector {
        let mut found = Vector::default();
        for (k, e) in z.entries() {
            let rate = bench.graph.mul(*e, self.weights[*k]);
            let rate = bench.tidy(rate);
            found.add(bench, *k, rate);
            for (child, edge) in self.edges.iter().enumerate() {
                if let Some(Edge { parent, multiple }) = edge
                    && parent == k
                {
                    let part = bench.graph.scale(rate, &-multiple.clone());
                    found.add(bench, child, part);
                }
            }
        }
        found
    }
}

/// Solves by tensions, where that is possible and promises to be cheaper than the mass matrix of `equations`, of which
/// the pattern counts. `etas` and `forces` are those of the frame, the forces without `T` and `U`.
pub(super) fn solve(
    bench: &mut Workbench,
    frame: &mut Frame,
    squares: &Squares,
    equations: &Equations,
    etas: &[ExprId],
    forces: &[ExprId],
) -> Option<Tensions> {
    let l = etas.len();
    let dense = pattern::of_mass(bench, &equations.mass[..l]);
    let zero = bench.graph.zero();
    // Forms that no parameter moves take no part.
    let moving: Vec<usize> =
        (0..squares.masses.len()).filter(|k| squares.components[*k].iter().any(|e| *e != zero)).collect();
    // Each tension is as dear as a parameter at least.
    if moving.len() > 4 * l || dense.cost() < pattern::LEAST {
        return None;
    }
    let components: Vec<Vec<ExprId>> = moving.iter().map(|k| squares.components[*k].clone()).collect();
    let edges = tree::spanning(bench, &components);
    let mut coupling: Vec<usize> = edges.iter().map(|edge| usize::from(edge.is_some())).collect();
    edges.iter().flatten().for_each(|edge| coupling[edge.parent] += 1);
    let rows: Vec<Vector> =
        (0..moving.len()).map(|k| tree::difference(bench, &components, k, edges[k].as_ref())).collect();
    if rows.iter().map(Vector::len).sum::<usize>() > pattern::densest(l, moving.len()) {
        return None;
    }
    let Balance { inverse, null, divisors } = balance(bench, &rows, l, &coupling)?;
    let weights: Vec<ExprId> = moving.iter().map(|k| bench.graph.powi(squares.masses[*k], -1)).collect();
    let stretched = Stretched { edges: &edges, weights: &weights };
    let across: Vec<Vector> = null.iter().map(|y| stretched.of(bench, y)).collect();
    let along: Vec<Vector> = inverse.iter().map(|y| stretched.of(bench, y)).collect();
    let tensions = Pattern::of_products(&across, &along);
    let (ours, theirs) = (tensions.cost(), dense.cost());
    // An estimate: what is a little dearer by it may be cheaper.
    if 4 * ours > 5 * theirs {
        return None;
    }

    // Forces, and differences of the accelerations at eta' = 0.
    let mut rest: Vec<Vec<ExprId>> = (0..l)
        .map(|s| {
            let e = bench.graph.add(squares.rest[s], forces[s]);
            terms(bench, e, etas)
        })
        .collect();
    let constant = constant_reactions(bench, &rows, &inverse, &mut rest);
    let stretched_constant = stretched.of(bench, &constant);
    let known = stretched.rates(bench, &stretched_constant);
    let accelerations: Vec<Vec<ExprId>> = (0..moving.len())
        .map(|k| {
            let drift = squares.drifts[moving[k]];
            let drift = match &edges[k] {
                Some(Edge { parent, multiple }) => {
                    let part = bench.graph.scale(squares.drifts[moving[*parent]], multiple);
                    bench.graph.sub(drift, part)
                }
                None => drift,
            };
            let mut parts = vec![frame.motion.of(&mut bench.graph, drift)];
            for (s, e) in rows[k].entries() {
                let rate = frame.motion.of(&mut bench.graph, *e);
                parts.push(bench.graph.mul(rate, etas[*s]));
            }
            if let Some(e) = known.get(k) {
                parts.push(bench.graph.neg(e));
            }
            parts
        })
        .collect();
    let rest: Vec<ExprId> = rest.into_iter().map(|terms| bench.graph.sum(terms)).collect();

    // N^T K N sigma = N^T c - N^T K P^T g
    let count = null.len();
    let mut matrix = vec![vec![zero; count]; count];
    for s in 0..count {
        for t in 0..=s {
            if across[s].meets(&across[t]) {
                let entry = across[s].dot(bench, &across[t], &weights);
                (matrix[s][t], matrix[t][s]) = (entry, entry);
            }
        }
    }
    let mut right: Vec<Vec<ExprId>> = Vec::new();
    for (y, own) in null.iter().zip(&across) {
        let sum = weighted(bench, y, &accelerations);
        let mut parts = terms(bench, sum, etas);
        push_products(bench, &mut parts, own, &along, &weights, &rest, true);
        right.push(parts);
    }
    // eta' = P K N sigma + P K P^T g - P c
    let mut coupled: Vec<Vec<(usize, ExprId)>> = Vec::new();
    let mut direct: Vec<Vec<ExprId>> = Vec::new();
    for (y, own) in inverse.iter().zip(&along) {
        let meeting = (0..count).filter(|t| own.meets(&across[*t]));
        coupled.push(meeting.map(|t| (t, own.dot(bench, &across[t], &weights))).collect());
        let sum = weighted(bench, y, &accelerations);
        let mut parts = terms(bench, sum, etas);
        for e in &mut parts {
            *e = bench.graph.neg(*e);
        }
        push_products(bench, &mut parts, own, &along, &weights, &rest, false);
        direct.push(parts);
    }
    let mut system = System { matrix, right, coupled, direct };
    let between = Between::new(bench, &system.entries());
    if !between.is_empty() {
        // Only neighbours meet: in the angles between them the entries are short.
        let other = system.rewritten(bench, &between, etas);
        if other.cost(bench, &frame.velocities) < system.cost(bench, &frame.velocities) {
            system = other;
        }
    }
    let accelerations = system.solved(bench)?;
    Some(Tensions { accelerations, divisors, is_clear: 2 * ours <= theirs })
}

/// The equations of the tensions, and the accelerations by tensions.
struct System {
    matrix: Vec<Vec<ExprId>>,
    /// Terms of the right sides.
    right: Vec<Vec<ExprId>>,
    /// The rows of `P K N`.
    coupled: Vec<Vec<(usize, ExprId)>>,
    /// Terms of the accelerations without tensions.
    direct: Vec<Vec<ExprId>>,
}

impl System {
    /// The coefficients of the tensions.
    fn entries(&self) -> Vec<ExprId> {
        let lower = self.matrix.iter().enumerate().flat_map(|(s, row)| &row[..=s]);
        lower.copied().chain(self.coupled.iter().flatten().map(|(_, e)| *e)).collect()
    }

    fn cost(&self, bench: &Workbench, beside: &[ExprId]) -> u64 {
        let terms = self.right.iter().chain(&self.direct).flatten();
        let all: Vec<ExprId> = self.entries().iter().chain(terms).chain(beside).copied().collect();
        weighted_cost(&bench.graph, &all)
    }

    /// The same in the angles between neighbours.
    fn rewritten(&self, bench: &mut Workbench, between: &Between, etas: &[ExprId]) -> Self {
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
        for s in 0..matrix.len() {
            for t in 0..=s {
                let entry = tidy(bench, matrix[s][t]);
                (matrix[s][t], matrix[t][s]) = (entry, entry);
            }
        }
        let mut coupled = self.coupled.clone();
        for (_, e) in coupled.iter_mut().flatten() {
            *e = tidy(bench, *e);
        }
        System { matrix, right: lists(bench, &self.right), coupled, direct: lists(bench, &self.direct) }
    }

    /// The accelerations.
    fn solved(mut self, bench: &mut Workbench) -> Option<Vec<ExprId>> {
        // One scale for all tensions, and one for their equations: both leave ones where there were constants.
        let scale = most_common(bench, self.matrix.iter().flatten().copied());
        let size = most_common(bench, self.right.iter().flatten().copied());
        for entry in self.matrix.iter_mut().flatten() {
            if !bench.graph.is_zero(*entry) {
                let quotient = bench.graph.div(*entry, scale);
                *entry = bench.tidy(quotient);
            }
        }
        let right: Vec<ExprId> = self
            .right
            .into_iter()
            .map(|parts| {
                let parts: Vec<ExprId> = parts.into_iter().map(|e| bench.graph.div(e, size)).collect();
                bench.graph.sum(parts)
            })
            .collect();
        let tensions = by_least_fill(bench, self.matrix, right)?;
        let rows = self.coupled.into_iter().zip(self.direct);
        let accelerations = rows.map(|(coupled, direct)| {
            let mut parts = Vec::new();
            for (t, e) in coupled {
                let e = bench.graph.product(&[(e, 1), (size, 1), (scale, -1)]);
                let e = bench.tidy(e);
                let e = bench.graph.keep(e);
                parts.push(bench.graph.mul(e, tensions[t]));
            }
            parts.extend(direct);
            bench.graph.sum(parts)
        });
        Some(accelerations.collect())
    }
}

/// `sum_k y_k (sum of parts_k)`.
fn weighted(bench: &mut Workbench, y: &Vector, parts: &[Vec<ExprId>]) -> ExprId {
    let mut all = Vec::new();
    for (k, e) in y.entries() {
        for part in &parts[*k] {
            all.push(bench.graph.mul(*e, *part));
        }
    }
    bench.graph.sum(all)
}

/// Adds the terms of `own^T D^-1 S^T P^T g`, or of its negative.
fn push_products(
    bench: &mut Workbench,
    parts: &mut Vec<ExprId>,
    own: &Vector,
    along: &[Vector],
    weights: &[ExprId],
    rest: &[ExprId],
    negative: bool,
) {
    for (other, g) in along.iter().zip(rest) {
        if !bench.graph.is_zero(*g) && own.meets(other) {
            let factor = own.dot(bench, other, weights);
            let factor = if negative { bench.graph.neg(factor) } else { factor };
            parts.push(bench.graph.mul(factor, *g));
        }
    }
}

/// The terms of a polynomial in the parameters with tidy coefficients, or of the sum as it is.
fn terms(bench: &mut Workbench, e: ExprId, etas: &[ExprId]) -> Vec<ExprId> {
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
fn summands(bench: &mut Workbench, e: ExprId) -> Vec<ExprId> {
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

/// Reactions that are constant and take terms out of the forces: `g - B^T lambda_c` is what is left, and rather of those
/// parameters that have a difference of their own.
fn constant_reactions(
    bench: &mut Workbench,
    rows: &[Vector],
    inverse: &[Vector],
    rest: &mut [Vec<ExprId>],
) -> Vector {
    let mut found = Vector::default();
    for (k, row) in rows.iter().enumerate() {
        let dearness = |lists: &[(usize, Vec<ExprId>)]| -> usize {
            lists.iter().map(|(s, terms)| terms.len() * inverse[*s].len()).sum()
        };
        let own: Vec<(usize, Vec<ExprId>)> =
            row.entries().iter().map(|(s, _)| (*s, rest[*s].clone())).collect();
        let mut best = (dearness(&own), None);
        for (s, b) in row.entries() {
            let mut ratios = Vec::new();
            for term in &rest[*s] {
                let ratio = bench.graph.div(*term, *b);
                if bench.graph.roles(ratio).is_constant() && balance::divides_safely(bench, ratio) {
                    ratios.push(ratio);
                }
            }
            if ratios.is_empty() {
                continue;
            }
            let ratio = bench.graph.sum(ratios);
            let mut changed = Vec::new();
            for (s, b) in row.entries() {
                let product = bench.graph.mul(ratio, *b);
                let left = bench.graph.sum(rest[*s].iter().copied());
                let left = bench.graph.sub(left, product);
                let left = bench.tidy(left);
                changed.push((*s, summands(bench, left)));
            }
            let left = dearness(&changed);
            if left < best.0 {
                best = (left, Some((ratio, changed)));
            }
        }
        if let (_, Some((ratio, changed))) = best {
            changed.into_iter().for_each(|(s, left)| rest[s] = left);
            found.add(bench, k, ratio);
        }
    }
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
fn by_least_fill(bench: &mut Workbench, matrix: Vec<Vec<ExprId>>, right: Vec<ExprId>) -> Option<Vec<ExprId>> {
    let mut waiting = vec![0_usize; right.len()];
    let choose = |bench: &mut Workbench, m: &[Vec<ExprId>], left: &[usize]| {
        let neighbours = |k: usize| -> Vec<usize> {
            left.iter().copied().filter(|r| *r != k && !bench.graph.is_zero(m[*r][k])).collect()
        };
        let k = left.iter().copied().min_by_key(|k| (neighbours(*k).len(), waiting[*k], *k))?;
        for r in neighbours(k) {
            waiting[r] = waiting[r].max(waiting[k] + 1);
        }
        Some(k)
    };
    eliminate(bench, matrix, right, Naming::Definite, choose).map(|Elimination { values, .. }| values)
}
