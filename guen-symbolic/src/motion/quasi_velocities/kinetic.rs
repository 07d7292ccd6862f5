//! `T°` as a sum of weighted products of velocity forms, `sum w u v`, without expanding it.

use std::collections::BTreeMap;

use super::velocity_forms::{VELOCITIES, VelocityPartials};
use crate::algebra::{ExprId, FastMap, Graph, Node, Rational};
use crate::workbench::Workbench;
use crate::zero::Verdict;

/// A term `w u v` of the kinetic energy; fewer forms for the linear and constant parts.
#[derive(Clone, Debug)]
pub struct KineticTerm {
    /// `w(t, x)`.
    pub weight: ExprId,
    /// The forms: none, one or two, equal ones for a square.
    pub forms: Vec<ExprId>,
}

/// A part of the kinetic energy is not a polynomial of degree two in the velocities.
#[derive(Clone, Debug)]
pub struct NotQuadratic {
    /// The part.
    pub part: ExprId,
}

/// Takes the kinetic energy apart; the symbols are all `x'`, then all `eta`.
pub fn decompose(
    bench: &mut Workbench,
    partials: &mut VelocityPartials,
    symbols: &[ExprId],
    energy: ExprId,
) -> Result<Vec<KineticTerm>, NotQuadratic> {
    let mut found = Vec::new();
    let mut known = Degrees::default();
    let one = bench.graph.one();
    let mut stack = vec![(energy, one)];
    while let Some((e, weight)) = stack.pop() {
        if !bench.graph.roles(e).meets(VELOCITIES) {
            let weight = bench.graph.mul(weight, e);
            found.push(KineticTerm { weight, forms: Vec::new() });
            continue;
        }
        match bench.graph.node(e).clone() {
            Node::Symbol(_) => found.push(KineticTerm { weight, forms: vec![e] }),
            Node::Sum { constant, terms } => {
                let constant = bench.graph.number(constant);
                stack.push((constant, weight));
                for (term, c) in terms.iter().rev() {
                    let weight = bench.graph.scale(weight, c);
                    stack.push((*term, weight));
                }
            }
            Node::Product(factors) => {
                let (moving, fixed): (Vec<_>, Vec<_>) =
                    factors.iter().copied().partition(|(base, _)| bench.graph.roles(*base).meets(VELOCITIES));
                let fixed = bench.graph.product(&fixed);
                let outer = bench.graph.mul(weight, fixed);
                let degrees: Vec<_> = moving.iter().map(|(base, _)| known.of(&bench.graph, *base)).collect();
                match (&moving[..], &degrees[..]) {
                    ([(u, 2)], [Some(1)]) => found.push(KineticTerm { weight: outer, forms: vec![*u, *u] }),
                    ([(u, 1), (v, 1)], [Some(1), Some(1)]) => {
                        found.push(KineticTerm { weight: outer, forms: vec![*u, *v] });
                    }
                    // Written out, a velocity that others stand in would be met once on every way down to it.
                    ([(u, 1)], [Some(1)]) => found.push(KineticTerm { weight: outer, forms: vec![*u] }),
                    ([(inner, 1)], _) => stack.push((*inner, outer)),
                    _ => polarise(bench, partials, symbols, e, weight, &mut found)?,
                }
            }
            _ => polarise(bench, partials, symbols, e, weight, &mut found)?,
        }
    }
    // Equal products of forms are one term.
    let mut merged: Vec<KineticTerm> = Vec::new();
    let mut places: BTreeMap<Vec<ExprId>, usize> = BTreeMap::new();
    for term in found {
        match places.get(&term.forms) {
            Some(place) => {
                let known = &mut merged[*place];
                known.weight = bench.graph.add(known.weight, term.weight);
            }
            None => {
                places.insert(term.forms.clone(), merged.len());
                merged.push(term);
            }
        }
    }
    merged.retain(|term| !bench.graph.is_zero(term.weight));
    Ok(merged)
}

/// Degrees in the velocities, each found once: velocities stand in each other.
#[derive(Default)]
struct Degrees(FastMap<ExprId, Option<u32>>);

impl Degrees {
    /// The degree of an expression as it is written, `None` if it is not seen to be a polynomial.
    fn of(&mut self, graph: &Graph, e: ExprId) -> Option<u32> {
        if !graph.roles(e).meets(VELOCITIES) {
            return Some(0);
        }
        if let Some(known) = self.0.get(&e) {
            return *known;
        }
        let found = match graph.node(e) {
            Node::Symbol(_) => Some(1),
            Node::Sum { terms, .. } => {
                terms.iter().map(|(term, _)| self.of(graph, *term)).try_fold(0, |most, d| Some(most.max(d?)))
            }
            Node::Product(factors) => factors.iter().try_fold(0, |sum, (base, e)| {
                let d = self.of(graph, *base)?;
                if d == 0 { Some(sum) } else { u32::try_from(*e).ok().map(|e| sum + d * e) }
            }),
            _ => None,
        };
        self.0.insert(e, found);
        found
    }
}

/// `e = e_0 + sum g_a a + 1/2 sum h_ab a b` by its derivatives at rest, if that is all of it.
fn polarise(
    bench: &mut Workbench,
    partials: &mut VelocityPartials,
    symbols: &[ExprId],
    e: ExprId,
    weight: ExprId,
    found: &mut Vec<KineticTerm>,
) -> Result<(), NotQuadratic> {
    let mut terms: Vec<(ExprId, Vec<ExprId>)> = Vec::new();
    let resting = partials.at_rest(bench, e);
    terms.push((resting, Vec::new()));
    for a in 0..partials.len() {
        let slope = partials.by(bench, a, e);
        if bench.graph.is_zero(slope) {
            continue;
        }
        let resting = partials.at_rest(bench, slope);
        terms.push((resting, vec![symbols[a]]));
        for b in 0..=a {
            let second = partials.by(bench, b, slope);
            let resting = partials.at_rest(bench, second);
            let half = if a == b { Rational::new(1, 2) } else { Rational::ONE };
            terms.push((bench.graph.scale(resting, &half), vec![symbols[a], symbols[b]]));
        }
    }
    let mut parts = Vec::new();
    for (coefficient, forms) in &mut terms {
        *coefficient = bench.tidy(*coefficient);
        let factors: Vec<_> = forms.iter().map(|u| (*u, 1)).chain([(*coefficient, 1)]).collect();
        parts.push(bench.graph.product(&factors));
    }
    let sum = bench.graph.sum(parts);
    let difference = bench.graph.sub(e, sum);
    // An open verdict is no licence: the energy must be seen to be quadratic.
    let known =
        bench.graph.is_zero(difference) || bench.zero.verdict(&mut bench.graph, difference) == Verdict::Zero;
    if !known {
        return Err(NotQuadratic { part: e });
    }
    for (coefficient, forms) in terms {
        if !bench.graph.is_zero(coefficient) {
            let weight = bench.graph.mul(weight, coefficient);
            found.push(KineticTerm { weight, forms });
        }
    }
    Ok(())
}
