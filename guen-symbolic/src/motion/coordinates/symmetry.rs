//! Coordinates that the equations of motion do not depend on, although they are written with them.
//!
//! A vehicle in the plane moves alike in all headings, but its velocities are declared in the world's axes. If nothing
//! changes when the coordinates move along a direction `v`, one of them may be set to zero, the others relative to it:
//! with relative angles the heading itself, with absolute angles all of them together. That is tried and tested;
//! expressions that are no longer written with the heading are much shorter.

use std::collections::BTreeMap;

use crate::algebra::{ExprId, Function, Graph, Node, Rational, Role, Substitution};
use crate::program::weighted_cost;
use crate::workbench::Workbench;
use crate::zero::Verdict;

/// Points at which all expressions must be unchanged before each is looked at.
const SYMMETRY_POINTS: usize = 2;

/// The replacements that leave a system's equations as they are.
#[derive(Default)]
pub(in crate::motion) struct Symmetry {
    found: Vec<Substitution>,
    /// The coordinates that are set to zero.
    pub(in crate::motion) heads: Vec<ExprId>,
}

impl Symmetry {
    /// Finds directions in some coordinates for equations; returns these without the coordinates set to zero.
    pub(in crate::motion) fn new(
        bench: &mut Workbench,
        free: &[ExprId],
        equations: &[ExprId],
    ) -> (Self, Vec<ExprId>) {
        let mut symmetry = Symmetry::default();
        let mut equations = equations.to_vec();
        let together = common_shift(&bench.graph, &equations, free);
        let singles = free.iter().map(|x| vec![(*x, Rational::ONE)]);
        for direction in together.into_iter().chain(singles) {
            if direction.iter().any(|(x, _)| symmetry.heads.contains(x)) {
                continue;
            }
            let mut shift = shift(&mut bench.graph, &direction);
            let Some(images) = unchanged(bench, &mut shift, &equations) else { continue };
            equations = images;
            symmetry.found.push(shift);
            symmetry.heads.push(direction[0].0);
        }
        (symmetry, equations)
    }

    /// Whether no direction was found.
    pub(in crate::motion) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// Expressions with those replacements that leave all of them as they are.
    pub(in crate::motion) fn reduced(&mut self, bench: &mut Workbench, es: &[ExprId]) -> Vec<ExprId> {
        let mut current = es.to_vec();
        for shift in &mut self.found {
            current = unchanged(bench, shift, &current).unwrap_or(current);
        }
        current
    }

    /// Each expression with those replacements that leave it as it is.
    pub(in crate::motion) fn reduced_each(&mut self, bench: &mut Workbench, es: &[ExprId]) -> Vec<ExprId> {
        es.iter().map(|e| self.reduced(bench, &[*e])[0]).collect()
    }

    /// An expression, without what it does not depend on where it is shorter so: as it is then, or multiplied out.
    pub(in crate::motion) fn shorter(&mut self, bench: &mut Workbench, e: ExprId) -> ExprId {
        let reduced = self.reduced(bench, &[e])[0];
        if reduced == e {
            return e;
        }
        let open = bench.graph.opened(&[reduced])[0];
        let tidy = bench.in_base_angles(&[open], |bench| bench.tidy(open));
        let cost = |e: &ExprId| weighted_cost(&bench.graph, &[*e]);
        [tidy, reduced, e].into_iter().min_by_key(cost).unwrap_or(e)
    }
}

/// The images, if they are proved to be equal.
fn unchanged(bench: &mut Workbench, shift: &mut Substitution, es: &[ExprId]) -> Option<Vec<ExprId>> {
    let images: Vec<ExprId> = es.iter().map(|e| shift.of(&mut bench.graph, *e)).collect();
    let differences: Vec<ExprId> =
        es.iter().zip(&images).map(|(e, image)| bench.graph.sub(*e, *image)).collect();
    if differences.iter().all(|e| bench.graph.is_zero(*e)) {
        return (images != es).then_some(images);
    }
    for sample in 0..SYMMETRY_POINTS {
        let residues = bench.zero.residues(&mut bench.graph, sample, &differences, false)?;
        if residues.iter().any(|residue| *residue != 0) {
            return None;
        }
    }
    let is_zero = |e: &ExprId| bench.zero.verdict(&mut bench.graph, *e) == Verdict::Zero;
    differences.iter().all(is_zero).then_some(images)
}

/// `x_i -> x_i - v_i x_h`, where `v_h = 1`.
fn shift(graph: &mut Graph, direction: &[(ExprId, Rational)]) -> Substitution {
    let head = direction[0].0;
    let pairs: Vec<(ExprId, ExprId)> = direction
        .iter()
        .map(|(x, v)| (*x, graph.linear(&[(*x, Rational::ONE), (head, -v.clone())])))
        .collect();
    Substitution::new(pairs)
}

/// A direction along which the arguments of all sines and cosines change alike, in more than one coordinate; the
/// coordinate that is set to zero comes first.
fn common_shift(graph: &Graph, es: &[ExprId], free: &[ExprId]) -> Option<Vec<(ExprId, Rational)>> {
    let mut rows: Vec<BTreeMap<ExprId, Rational>> = Vec::new();
    for id in graph.reachable(es, |_| false) {
        let Node::Function(Function::Sin | Function::Cos, x) = graph.node(id) else { continue };
        if !graph.roles(*x).has(Role::Coordinate) {
            continue;
        }
        let row: BTreeMap<ExprId, Rational> =
            graph.linear_parts(*x).into_iter().filter(|(e, _)| free.contains(e)).collect();
        if row.is_empty() {
            return None;
        }
        if !rows.contains(&row) {
            rows.push(row);
        }
    }
    // Short arguments first: each gives one more coordinate its rate.
    rows.sort_by_key(BTreeMap::len);
    let mut rates: BTreeMap<ExprId, Rational> = BTreeMap::new();
    for row in rows {
        let known: Rational = row.iter().filter_map(|(x, c)| Some(c * rates.get(x)?)).sum();
        let rest = &Rational::ONE - &known;
        match row.iter().find(|(x, _)| !rates.contains_key(x)) {
            Some((x, c)) => {
                let open: Vec<ExprId> = row.keys().filter(|x| !rates.contains_key(x)).copied().collect();
                rates.insert(*x, &rest * &c.recip()?);
                open.into_iter().for_each(|x| {
                    rates.entry(x).or_default();
                });
            }
            None if rest.is_zero() => {}
            None => return None,
        }
    }
    let direction: Vec<_> = rates.into_iter().filter(|(_, v)| !v.is_zero()).collect();
    (direction.len() > 1 && direction[0].1.is_one()).then_some(direction)
}
