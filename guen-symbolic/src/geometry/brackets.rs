//! Structure coefficients of the commutators, (1.11) and (1.14), from the exterior derivative of the forms, (1.10).
//!
//! `C_ijt = -sum_{p<q} (d a_tq/d x_p - d a_tp/d x_q) (xi_i^p xi_j^q - xi_i^q xi_j^p)`, `p, q` from 0 with
//! `x_0 = t`, `xi_0^0 = 1`: no derivative of the inverse is needed. Coefficients are computed when they are
//! asked for, each once: twenty coordinates have four thousand of them.

use std::collections::{BTreeMap, BTreeSet};

use super::{Forms, Operators};
use crate::algebra::{ExprId, Flow};
use crate::workbench::Workbench;
use crate::zero::field::{add, mul, sub};
use crate::zero::jets::Moving;

/// The brackets of the operators, computed on demand.
pub struct Brackets {
    operators: Operators,
    degrees: usize,
    // For each form the components of its exterior derivative that are not zero, `p < q`.
    curls: Vec<Vec<(usize, usize, ExprId)>>,
    // For each form whether each of `X_0..X_n` moves a coordinate that its exterior derivative is over.
    touched: Vec<Vec<bool>>,
    coefficients: BTreeMap<(usize, usize, usize), ExprId>,
    // The least cost of a coefficient that has no normal form.
    beyond: Option<u64>,
}

impl Brackets {
    /// Prepares the exterior derivatives of the forms.
    pub fn new(bench: &mut Workbench, forms: &Forms, operators: &Operators) -> Self {
        let n = forms.len();
        let mut partials: Vec<Flow> =
            (0..=n).map(|p| Flow::partial(&bench.graph, forms.variable(p))).collect();
        let mut beyond = None;
        let curls: Vec<Vec<(usize, usize, ExprId)>> = (0..n)
            .map(|t| {
                let mut curl: BTreeMap<(usize, usize), ExprId> = BTreeMap::new();
                for q in 0..=n {
                    let a = forms.component(t, q);
                    if bench.graph.roles(a).is_constant() {
                        continue;
                    }
                    for (p, partial) in partials.iter_mut().enumerate().filter(|(p, _)| *p != q) {
                        let slope = partial.of(&mut bench.graph, a);
                        if bench.graph.is_zero(slope) {
                            continue;
                        }
                        // d a_q/d x_p enters (p, q) with plus, or (q, p) with minus.
                        let (key, slope) =
                            if p < q { ((p, q), slope) } else { ((q, p), bench.graph.neg(slope)) };
                        let old = curl.get(&key).copied().unwrap_or(bench.graph.zero());
                        curl.insert(key, bench.graph.add(old, slope));
                    }
                }
                let zero = bench.graph.zero();
                curl.into_iter()
                    .map(|((p, q), e)| (p, q, bench.tidy_alike(e, &mut beyond)))
                    .filter(|(_, _, e)| *e != zero)
                    .collect()
            })
            .collect();
        let moves = |j: usize, p: usize| match (j, p) {
            (_, 0) => j == 0,
            _ => !bench.graph.is_zero(operators.xi[j][p - 1]),
        };
        let touched = |curl: &Vec<(usize, usize, ExprId)>| {
            let over: BTreeSet<usize> = curl.iter().flat_map(|(p, q, _)| [*p, *q]).collect();
            (0..operators.xi.len()).map(|j| over.iter().any(|p| moves(j, *p))).collect()
        };
        Brackets {
            operators: operators.clone(),
            degrees: forms.degrees,
            touched: curls.iter().map(touched).collect(),
            curls,
            coefficients: BTreeMap::new(),
            beyond: None,
        }
    }

    /// Whether all forms are closed, so that no bracket differs from zero.
    pub fn are_zero(&self) -> bool {
        self.curls.iter().all(Vec::is_empty)
    }

    /// Whether the form `eta_{t+1}` is closed, so that none of its coefficients differs from zero.
    pub(crate) fn is_closed(&self, t: usize) -> bool {
        self.curls[t].is_empty()
    }

    /// `C_ijt`: `i`, `j` from 0, `t` from 1, as in the paper.
    pub fn coefficient(&mut self, bench: &mut Workbench, i: usize, j: usize, t: usize) -> ExprId {
        let touched: &[bool] = &self.touched[t - 1];
        if i == j || !touched[i] || !touched[j] {
            return bench.graph.zero();
        }
        if i > j {
            let swapped = self.coefficient(bench, j, i, t);
            return bench.graph.neg(swapped);
        }
        if let Some(known) = self.coefficients.get(&(i, j, t)) {
            return *known;
        }
        let mut terms = Vec::new();
        for (p, q, curl) in &self.curls[t - 1] {
            let (ip, iq) = (self.component(bench, i, *p), self.component(bench, i, *q));
            let (jp, jq) = (self.component(bench, j, *p), self.component(bench, j, *q));
            let vanish = |a, b| bench.graph.is_zero(a) || bench.graph.is_zero(b);
            if vanish(ip, jq) && vanish(iq, jp) {
                continue;
            }
            let (forward, backward) = (bench.graph.mul(ip, jq), bench.graph.mul(iq, jp));
            let area = bench.graph.sub(forward, backward);
            terms.push(bench.graph.mul(*curl, area));
        }
        let coefficient = if terms.is_empty() {
            bench.graph.zero()
        } else {
            let sum = bench.graph.sum(terms);
            let sum = bench.graph.neg(sum);
            bench.tidy_alike(sum, &mut self.beyond)
        };
        self.coefficients.insert((i, j, t), coefficient);
        coefficient
    }

    /// `C_rvw` for all constraints at a point, a row for each `w` with a column for each `v`, from the values of all `xi_j^p`.
    pub(crate) fn values(&self, moving: &mut Moving<'_>, xi: &[Vec<u64>], r: usize) -> Option<Vec<Vec<u64>>> {
        let component = |j: usize, p: usize| match (j, p) {
            (0, 0) => 1,
            (_, 0) => 0,
            _ => xi[j][p - 1],
        };
        let first = self.degrees;
        let mut rows = Vec::new();
        for curl in &self.curls[first..] {
            let mut row = vec![0; self.curls.len() - first];
            for (p, q, e) in curl {
                let (rp, rq) = (component(r, *p), component(r, *q));
                if rp == 0 && rq == 0 {
                    continue;
                }
                let e = moving.value(*e)?;
                for (v, c) in row.iter_mut().enumerate() {
                    let (vp, vq) = (component(first + 1 + v, *p), component(first + 1 + v, *q));
                    let area = sub(mul(rq, vp), mul(rp, vq));
                    *c = add(*c, mul(e, area));
                }
            }
            rows.push(row);
        }
        Some(rows)
    }

    /// `C_0st + sum_{r<=l} eta_r C_rst`: how the form `t` turns along the motion against `X_s`.
    pub(crate) fn along_motion(
        &mut self,
        bench: &mut Workbench,
        etas: &[ExprId],
        s: usize,
        t: usize,
    ) -> ExprId {
        if self.is_closed(t - 1) {
            return bench.graph.zero();
        }
        let mut terms = vec![self.coefficient(bench, 0, s, t)];
        for r in 1..=self.degrees {
            let c = self.coefficient(bench, r, s, t);
            terms.push(bench.graph.mul(etas[r - 1], c));
        }
        bench.graph.sum(terms)
    }

    /// `xi_j^p` with `xi_0^0 = 1` and `xi_j^0 = 0`.
    fn component(&self, bench: &Workbench, j: usize, p: usize) -> ExprId {
        match (j, p) {
            (0, 0) => bench.graph.one(),
            (_, 0) => bench.graph.zero(),
            _ => self.operators.xi[j][p - 1],
        }
    }
}
