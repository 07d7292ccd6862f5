//! The Lie closure of `X_0, X_1..X_l`, (1.12) to (1.14) made exact: holonomic or not, the growth vector, and what is integrable.
//!
//! Brackets are kept modulo `D_1 = span(X_0..X_l)`, as combinations `sum_v y^v X_v` of the operators of the
//! constraints alone. A bracket with `X_r` is then `[X_r, Y]^w = X_r(y^w) + sum_v y^v C_rvw` modulo `D_1`,
//! and only brackets that enlarge the rank are carried on: dependent ones add nothing that
//! `D_i + [D_1, D_i]` does not contain already.

use super::{Brackets, Forms, Operators};
use super::{adjugate, next_level};
use crate::algebra::{ExprId, Flow, Rational};
use crate::workbench::Workbench;

/// Steps of building after which the brackets are not followed further: a classification is worth less than the
/// equations that come after it.
const WORK_LIMIT: u64 = 1_500_000;

/// The result of closing the directions under brackets.
#[derive(Clone, Debug)]
pub struct Closure {
    /// Ranks less one of `D_1`, `D_2`, ... until they stay; the first is `l`.
    pub growth: Vec<usize>,
    /// Whether the brackets were followed to the end; else nothing is known beyond `growth`.
    pub complete: bool,
    /// A basis of the integrable combinations of constraints.
    pub integrable: Vec<Combination>,
}

/// A combination `sum_v f_v eta_v` of constraints.
#[derive(Clone, Debug)]
pub struct Combination {
    /// Indices of the forms, from 0, with their coefficients where these are small enough to be known.
    pub terms: Vec<(usize, Option<ExprId>)>,
}

impl Closure {
    /// Follows the brackets until nothing new appears.
    pub fn new(bench: &mut Workbench, forms: &Forms, operators: &Operators, brackets: &mut Brackets) -> Self {
        let (n, l) = (forms.len(), forms.degrees);
        let constraints = n - l;
        let mut flows: Vec<Flow> = (0..=l).map(|r| displacement(bench, forms, operators, r)).collect();
        let start = bench.graph.work();
        let mut growth = vec![l];
        let mut kept: Vec<Vec<ExprId>> = Vec::new();
        let mut complete = true;
        // [X_r, X_s] modulo D_1 has the components C_rsv.
        let mut fresh = Vec::new();
        'first: for s in 1..=l {
            for r in 0..s {
                if kept.len() == constraints {
                    break 'first;
                }
                let y: Vec<ExprId> = (l + 1..=n).map(|v| brackets.coefficient(bench, r, s, v)).collect();
                let larger = enlarges(bench, &mut kept, &y);
                complete &= larger.is_some();
                if larger == Some(true) {
                    fresh.push(y);
                }
            }
        }
        while !fresh.is_empty() {
            growth.push(l + kept.len());
            let missing = constraints - kept.len();
            if missing == 0 || !complete {
                break;
            }
            // Numbers modulo the prime have the sign of a root by chance, and there may be none on the manifold: the rank is asked of
            // expressions then.
            let one_by_one = !bench.zero.manifold_is_solved()
                || fresh.iter().flatten().any(|e| bench.zero.has_signs_or_roots(&bench.graph, *e));
            let all = || (0..fresh.len()).flat_map(|y| (0..=l).map(move |r| (y, r))).collect();
            let found = match one_by_one {
                true => Some(all()),
                false => next_level::enlarging(bench, (forms, operators, brackets), &fresh, &kept, missing),
            };
            let Some(found) = found else {
                complete = false;
                break;
            };
            if !one_by_one && found.len() == missing {
                // No constraint is left that could be integrable, and nothing looks at these brackets.
                growth.push(n);
                break;
            }
            let mut next = Vec::with_capacity(missing);
            for (y, r) in found {
                if kept.len() == constraints {
                    break;
                }
                let bracket = bracket(bench, brackets, &mut flows[r], (r, l), &fresh[y]);
                if bench.graph.work() > start + WORK_LIMIT {
                    complete = false;
                    break;
                }
                match one_by_one {
                    true => {
                        let larger = enlarges(bench, &mut kept, &bracket);
                        complete &= larger.is_some();
                        if larger == Some(true) {
                            next.push(bracket);
                        }
                    }
                    false => {
                        kept.push(bracket.clone());
                        next.push(bracket);
                    }
                }
            }
            fresh = next;
        }
        let is_full = growth.last() == Some(&n);
        let integrable = if complete && !is_full {
            // Ranks see through what vanishes; what is printed should not contain it.
            for e in kept.iter_mut().flatten() {
                *e = bench.dropped(*e);
            }
            annihilator(bench, &kept, l, constraints)
        } else {
            Vec::new()
        };
        Closure { growth, complete, integrable }
    }

    /// Whether `X_0..X_l` are closed.
    pub fn is_holonomic(&self) -> bool {
        self.complete && self.growth.len() == 1
    }
}

/// Whether a bracket enlarges the rank of those that are kept, and keeps it then; `None` if no point was found.
fn enlarges(bench: &mut Workbench, kept: &mut Vec<Vec<ExprId>>, y: &[ExprId]) -> Option<bool> {
    if y.iter().all(|e| bench.graph.is_zero(*e)) {
        return Some(false);
    }
    kept.push(y.to_vec());
    let rank = bench.zero.observed_rank(&mut bench.graph, kept);
    let larger = rank.map(|rank| rank == kept.len());
    if larger != Some(true) {
        kept.pop();
    }
    larger
}

/// `[X_r, Y]` modulo `D_1`.
fn bracket(
    bench: &mut Workbench,
    brackets: &mut Brackets,
    flow: &mut Flow,
    (r, l): (usize, usize),
    y: &[ExprId],
) -> Vec<ExprId> {
    let mut bracket = Vec::with_capacity(y.len());
    for w in 0..y.len() {
        let mut terms = vec![flow.of(&mut bench.graph, y[w])];
        for (v, component) in y.iter().enumerate() {
            if !bench.graph.is_zero(*component) {
                let c = brackets.coefficient(bench, r, l + 1 + v, l + 1 + w);
                terms.push(bench.graph.mul(*component, c));
            }
        }
        let sum = bench.graph.sum(terms);
        // The next derivative shares what this one has found.
        bracket.push(bench.keep_large(sum));
    }
    bracket
}

/// `X_r` as a flow on functions of `t` and the coordinates, `r` from 0.
fn displacement(bench: &Workbench, forms: &Forms, operators: &Operators, r: usize) -> Flow {
    let time = (r == 0).then_some((forms.time, bench.graph.one()));
    let rates = forms.coordinates.iter().copied().zip(operators.xi[r].iter().copied());
    Flow::new(&bench.graph, time.into_iter().chain(rates))
}

/// A basis of the row vectors `f` with `sum_v f_v y^v = 0` for every kept bracket.
fn annihilator(
    bench: &mut Workbench,
    kept: &[Vec<ExprId>],
    l: usize,
    constraints: usize,
) -> Vec<Combination> {
    let one = bench.graph.one();
    // Constraints that no bracket touches are integrable by themselves.
    let (alone, touched): (Vec<usize>, Vec<usize>) =
        (0..constraints).partition(|v| kept.iter().all(|y| bench.graph.is_zero(y[*v])));
    let mut found: Vec<Combination> =
        alone.into_iter().map(|v| Combination { terms: vec![(l + v, Some(one))] }).collect();
    // The kept brackets are independent, so that regular columns of their number exist.
    let mut pivots: Vec<usize> = Vec::new();
    for v in &touched {
        let trial: Vec<usize> = pivots.iter().copied().chain([*v]).collect();
        let columns: Vec<Vec<ExprId>> = trial.iter().map(|v| kept.iter().map(|y| y[*v]).collect()).collect();
        if bench.zero.observed_rank(&mut bench.graph, &columns) == Some(trial.len()) {
            pivots = trial;
        }
    }
    let free: Vec<usize> = touched.iter().copied().filter(|v| !pivots.contains(v)).collect();
    if free.is_empty() {
        return found;
    }
    const LARGEST_SOLVED: usize = 4;
    let solved = (pivots.len() == kept.len() && kept.len() <= LARGEST_SOLVED).then(|| {
        let matrix: Vec<Vec<ExprId>> = kept.iter().map(|y| pivots.iter().map(|v| y[*v]).collect()).collect();
        adjugate(bench, &matrix)
    });
    for v in free {
        let mut terms: Vec<(usize, Option<ExprId>)> = Vec::new();
        match &solved {
            Some((adjugate, determinant)) => {
                // K f_pivots = -y^v: f = -adj(K) y^v / det K with f_v = 1.
                let column: Vec<ExprId> = kept.iter().map(|y| y[v]).collect();
                for (row, pivot) in adjugate.iter().zip(&pivots) {
                    let product = bench.dot(row, &column);
                    let quotient = bench.graph.div(product, *determinant);
                    let f = bench.graph.scale(quotient, &Rational::MINUS_ONE);
                    let f = bench.tidy(f);
                    if !bench.graph.is_zero(f) {
                        terms.push((l + pivot, Some(f)));
                    }
                }
                terms.push((l + v, Some(one)));
            }
            None => terms.extend(pivots.iter().chain([&v]).map(|v| (l + v, None))),
        }
        terms.sort_by_key(|term| term.0);
        found.push(Combination { terms });
    }
    found
}
