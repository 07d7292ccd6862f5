//! The equations of a large system, put up over the tree of its velocity forms.
//!
//! The energy is `T = 1/2 sum_k m_k u_k^2`, and each form is a multiple of one before it and a few terms, `u_k = c_k u_p(k) + b_k . eta + d_k`:
//! the speed of a link is that of the link before, and a difference. What the links behind a form have in common is summed up once, from
//! the ends inwards, so that nothing is multiplied out: multiplied out the entries of a chain's mass matrix have a term for each
//! link behind both.

use crate::algebra::{ExprId, Rational};
use crate::motion::formulations::constraint_forces::Differences;
use crate::motion::{Frame, MotionEquations};
use crate::workbench::Workbench;

/// The equations, without generalised forces, and the momenta.
pub(super) struct Composed {
    /// `M_st` and `f_s`.
    pub(super) equations: MotionEquations,
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
    let Differences { rows, drifts, rest, .. } = differences;
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

    let mass = tree.mass_matrix(bench, etas.len());
    Some(Composed { equations: MotionEquations { mass, forces }, momenta })
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

    /// `M_st`: of each pair of forms of which one stands behind the other, the components times what is behind both.
    fn mass_matrix(&self, bench: &mut Workbench, l: usize) -> Vec<Vec<ExprId>> {
        let Differences { masses, edges, rows, .. } = self.differences;
        // The masses behind each form, as it feels them.
        let mut behind = masses.clone();
        for k in self.order.iter().rev() {
            if let Some(edge) = &edges[*k] {
                let square = &edge.multiple * &edge.multiple;
                let part = bench.graph.scale(behind[*k], &square);
                behind[edge.parent] = bench.graph.add(behind[edge.parent], part);
            }
        }
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
                let Some(edge) = &edges[above] else { break };
                multiple = &multiple * &edge.multiple;
                above = edge.parent;
            }
        }
        let lower: Vec<Vec<ExprId>> = entries
            .into_iter()
            .map(|row| row.into_iter().map(|terms| bench.graph.sum(terms)).collect())
            .collect();
        (0..l).map(|s| (0..l).map(|t| lower[s.max(t)][s.min(t)]).collect()).collect()
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

#[cfg(test)]
mod tests {
    use super::Tree;
    use crate::algebra::{Graph, Rational, Role};
    use crate::motion::formulations::constraint_forces::{Differences, Edge};
    use crate::motion::mass_matrix::sparse::Vector;
    use crate::workbench::Workbench;

    #[test]
    fn parameters_that_several_forms_share_count_in_all_of_them() {
        let mut bench = Workbench::new(Graph::new());
        let mut symbol = |name: String, role| bench.graph.symbol(&name, role);
        let masses: Vec<_> = (0..4).map(|k| symbol(format!("m{k}"), Role::Constant)).collect();
        let speeds: Vec<_> = (0..4).map(|k| symbol(format!("y{k}"), Role::Coordinate)).collect();
        let components: Vec<Vec<_>> =
            (0..4).map(|k| (0..3).map(|s| symbol(format!("b{k}{s}"), Role::Coordinate)).collect()).collect();
        // The third form stands before the second in the list, and the last one hangs on it.
        let edge = |parent, n, d| Some(Edge { parent, multiple: Rational::new(n, d) });
        let edges = vec![None, edge(2, -1, 1), edge(0, 2, 1), edge(1, 1, 3)];
        let rows: Vec<Vector> = components.iter().map(|row| Vector::of_list(&bench.graph, row)).collect();
        let zero = bench.graph.zero();
        let differences = Differences { masses, edges, rows, drifts: vec![zero; 4], rest: vec![zero; 3] };
        let tree = Tree::new(&differences).unwrap();
        // The forms written out.
        let mut whole = components;
        let mut whole_speeds = speeds.clone();
        for k in [2, 1, 3] {
            let Edge { parent, multiple } = differences.edges[k].clone().unwrap();
            let before = whole[parent].clone();
            for (entry, before) in whole[k].iter_mut().zip(before) {
                let part = bench.graph.scale(before, &multiple);
                *entry = bench.graph.add(part, *entry);
            }
            let part = bench.graph.scale(whole_speeds[parent], &multiple);
            whole_speeds[k] = bench.graph.add(part, whole_speeds[k]);
        }
        let sums = tree.summed_up(&mut bench, speeds);
        for (s, row) in tree.mass_matrix(&mut bench, 3).into_iter().enumerate() {
            for (t, entry) in row.into_iter().chain([sums[s]]).enumerate() {
                let mut difference = entry;
                for (k, mass) in differences.masses.iter().enumerate() {
                    let other = if t == 3 { whole_speeds[k] } else { whole[k][t] };
                    let part = bench.graph.product(&[(*mass, 1), (whole[k][s], 1), (other, 1)]);
                    difference = bench.graph.sub(difference, part);
                }
                assert!(bench.vanishes(difference), "{s} {t}");
            }
        }
    }
}
