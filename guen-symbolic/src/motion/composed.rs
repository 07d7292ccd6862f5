//! The equations of a large system, put up over the tree of its velocity forms.
//!
//! The energy is `T = 1/2 sum_k m_k u_k^2`, and each form is a multiple of one before it and a few terms, `u_k = c_k u_p(k) + b_k . eta + d_k`:
//! the speed of a link is that of the link before, and a difference. What the links behind a form have in common is summed up once, from
//! the ends inwards, so that nothing is multiplied out: multiplied out the entries of a chain's mass matrix have a term for each
//! link behind both.

use super::Equations;
use super::Frame;
use super::constraint_forces::Differences;
use crate::algebra::{ExprId, Rational};
use crate::workbench::Workbench;

/// The equations, without generalised forces, and the momenta.
pub(super) struct Composed {
    /// `M_st` and `f_s`.
    pub(super) equations: Equations,
    /// `dT/d eta_s`.
    pub(super) momenta: Vec<ExprId>,
}

/// Puts them up; none where the forms have no order in which each stands behind the one it is relative to.
pub(super) fn equations(
    bench: &mut Workbench,
    frame: &mut Frame,
    differences: &Differences,
    etas: &[ExprId],
) -> Option<Composed> {
    let tree = Tree::new(differences)?;
    let Differences { masses, rows, drifts, rest, .. } = differences;
    let dot = |bench: &mut Workbench, row: &[(usize, ExprId)], offset: ExprId| {
        let terms = row.iter().map(|(s, b)| bench.graph.mul(*b, etas[*s])).collect::<Vec<_>>();
        bench.graph.sum(terms.into_iter().chain([offset]))
    };
    // The speeds, and the accelerations at eta' = 0.
    let (mut speeds, mut accelerations) = (Vec::new(), Vec::new());
    for (row, drift) in rows.iter().zip(drifts) {
        speeds.push(dot(bench, row.entries(), *drift));
        let rates = row.entries().iter().map(|(s, b)| (*s, frame.motion.of(&mut bench.graph, *b)));
        let rates: Vec<(usize, ExprId)> = rates.collect();
        let own = frame.motion.of(&mut bench.graph, *drift);
        accelerations.push(dot(bench, &rates, own));
    }
    let momenta = tree.summed_up(bench, speeds);
    let inertial = tree.summed_up(bench, accelerations);
    let forces = rest.iter().zip(&inertial).map(|(force, own)| bench.graph.sub(*force, *own)).collect();

    // The masses behind each form, as it feels them.
    let mut behind = masses.clone();
    for k in tree.order.iter().rev() {
        if let Some(edge) = &differences.edges[*k] {
            let square = &edge.multiple * &edge.multiple;
            let part = bench.graph.scale(behind[*k], &square);
            behind[edge.parent] = bench.graph.add(behind[edge.parent], part);
        }
    }
    let l = etas.len();
    let mut entries: Vec<Vec<Vec<ExprId>>> = (0..l).map(|s| vec![Vec::new(); s + 1]).collect();
    for (k, row) in rows.iter().enumerate() {
        let (mut above, mut multiple) = (k, Rational::ONE);
        loop {
            for (s, b) in rows[above].entries() {
                for (t, c) in row.entries() {
                    // Of a form with itself each pair comes once in both orders.
                    if above == k && s < t {
                        continue;
                    }
                    let product = bench.graph.product(&[(*b, 1), (*c, 1), (behind[k], 1)]);
                    let twice = if above != k && s == t { Rational::from(2) } else { Rational::ONE };
                    let part = bench.graph.scale(product, &(&multiple * &twice));
                    entries[(*s).max(*t)][(*s).min(*t)].push(part);
                }
            }
            let Some(edge) = &differences.edges[above] else { break };
            multiple = &multiple * &edge.multiple;
            above = edge.parent;
        }
    }
    let lower: Vec<Vec<ExprId>> = entries
        .into_iter()
        .map(|row| row.into_iter().map(|terms| bench.graph.sum(terms)).collect())
        .collect();
    let mass = (0..l).map(|s| (0..l).map(|t| lower[s.max(t)][s.min(t)]).collect()).collect();
    Some(Composed { equations: Equations { mass, forces }, momenta })
}

/// The forms in an order in which each stands behind the one that it is relative to.
struct Tree<'a> {
    differences: &'a Differences,
    order: Vec<usize>,
}

impl<'a> Tree<'a> {
    fn new(differences: &'a Differences) -> Option<Self> {
        let count = differences.edges.len();
        let mut children: Vec<Vec<usize>> = vec![Vec::new(); count];
        let mut order = Vec::new();
        for (k, edge) in differences.edges.iter().enumerate() {
            match edge {
                Some(edge) => children[edge.parent].push(k),
                None => order.push(k),
            }
        }
        let mut next = 0;
        while let Some(k) = order.get(next) {
            order.extend(children[*k].iter().copied());
            next += 1;
        }
        (order.len() == count).then_some(Tree { differences, order })
    }

    /// `sum_k m_k y_k du_k/d eta_s` of `y_k`, given as differences as the forms are.
    fn summed_up(&self, bench: &mut Workbench, mut values: Vec<ExprId>) -> Vec<ExprId> {
        let Differences { masses, edges, rows, rest, .. } = self.differences;
        for k in &self.order {
            if let Some(edge) = &edges[*k] {
                let before = bench.graph.scale(values[edge.parent], &edge.multiple);
                values[*k] = bench.graph.add(before, values[*k]);
            }
        }
        let mut felt: Vec<ExprId> =
            masses.iter().zip(&values).map(|(mass, value)| bench.graph.mul(*mass, *value)).collect();
        for k in self.order.iter().rev() {
            if let Some(edge) = &edges[*k] {
                let part = bench.graph.scale(felt[*k], &edge.multiple);
                felt[edge.parent] = bench.graph.add(felt[edge.parent], part);
            }
        }
        let mut sums: Vec<Vec<ExprId>> = vec![Vec::new(); rest.len()];
        for (row, felt) in rows.iter().zip(&felt) {
            for (s, b) in row.entries() {
                sums[*s].push(bench.graph.mul(*b, *felt));
            }
        }
        sums.into_iter().map(|terms| bench.graph.sum(terms)).collect()
    }
}
