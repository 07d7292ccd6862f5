//! The equations in other parameters: the rates of the base angles.
//!
//! The parameters of a chain in relative angles are the rates of its joints, and its mass matrix in them has long entries: each joint
//! moves all links beyond it. In the rates of the base angles, the sums of the joints' rates, the equations are those of absolute angles.
//! So the accelerations are found there, `zeta = J eta` with numbers for `J`, and turned back.

use super::constraint_forces::{self, ByConstraintForces};
use super::restated::Restated;
use super::symmetry::Symmetry;
use super::thresholds::ALL_FORMS;
use super::{Equations, Frame, Mechanics};
use crate::algebra::{ExprId, Rational, Role, Substitution};
use crate::geometry::{Form, Operators};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

type Matrix = Vec<Vec<Rational>>;

/// Whether some base angle turns with several parameters, so that its rate is another parameter.
pub(super) fn are_others(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame) -> bool {
    Change::new(bench, system, frame).is_some()
}

/// Other parameters, `zeta = J eta`.
struct Change {
    to: Matrix,
    back: Matrix,
}

impl Change {
    /// The rates of base angles, as far as they are combinations of several parameters; parameters beside them.
    fn new(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame) -> Option<Self> {
        let l = system.forms.degrees;
        let etas = &system.etas[..l];
        let mut rows: Matrix = Vec::new();
        for angle in bench.graph.base_angles().to_vec() {
            let rate = frame.motion.of(&mut bench.graph, angle);
            let parts = bench.graph.linear_parts(rate);
            let mut row = vec![Rational::ZERO; l];
            let mut is_linear = true;
            for (e, c) in parts {
                match etas.iter().position(|eta| *eta == e) {
                    Some(s) => row[s] = c,
                    None => is_linear &= bench.graph.roles(e).is_constant(),
                }
            }
            if is_linear && row.iter().any(|c| !c.is_zero()) {
                rows.push(row);
            }
        }
        if !rows.iter().any(|row| row.iter().filter(|c| !c.is_zero()).count() > 1) {
            return None;
        }
        // Parameters that no angle stands for stay.
        rows.extend((0..l).map(|s| unit(l, s)));
        let mut to: Matrix = Vec::new();
        let mut reduced: Vec<(usize, Vec<Rational>)> = Vec::new();
        for row in rows {
            let mut rest = row.clone();
            for (pivot, other) in &reduced {
                let c = rest[*pivot].clone();
                eliminate(&mut rest, &c, other);
            }
            let Some(pivot) = rest.iter().position(|c| !c.is_zero()) else { continue };
            let inverse = rest[pivot].recip()?;
            rest.iter_mut().for_each(|c| *c = &*c * &inverse);
            reduced.push((pivot, rest));
            to.push(row);
        }
        let back = inverse(&to)?;
        Some(Change { to, back })
    }

    /// The system in the other parameters.
    fn system(&self, bench: &mut Workbench, system: &Mechanics, zetas: &[ExprId]) -> Mechanics {
        let l = zetas.len();
        let etas_of_zetas = applied(bench, &self.back, zetas);
        let mut other = system.clone();
        other.etas[..l].copy_from_slice(zetas);
        let mut into = Substitution::new(system.etas[..l].iter().copied().zip(etas_of_zetas));
        other.kinetic_energy = into.of(&mut bench.graph, system.kinetic_energy);
        for force in &mut other.forces {
            force.magnitude = into.of(&mut bench.graph, force.magnitude);
            force.along = into.of(&mut bench.graph, force.along);
        }
        for (k, row) in self.to.iter().enumerate() {
            let combined = |bench: &mut Workbench, entries: Vec<ExprId>| {
                let terms: Vec<_> = entries.into_iter().zip(row.iter().cloned()).collect();
                let sum = bench.graph.linear(&terms);
                bench.tidy(sum)
            };
            let forms = &system.forms.forms[..l];
            other.forms.forms[k] = Form {
                row: (0..system.forms.len())
                    .map(|i| combined(bench, forms.iter().map(|form| form.row[i]).collect()))
                    .collect(),
                offset: combined(bench, forms.iter().map(|form| form.offset).collect()),
            };
        }
        other
    }

    /// `x' = xi_0 + xi eta` with `eta = J^-1 zeta`.
    fn operators(&self, bench: &mut Workbench, operators: &Operators) -> Operators {
        // The steps are those of the forms as declared.
        let mut other = Operators { steps: Vec::new(), ..operators.clone() };
        let l = self.to.len();
        for i in 0..operators.xi[0].len() {
            for k in 0..l {
                let terms: Vec<_> =
                    (0..l).map(|s| (operators.xi[s + 1][i], self.back[s][k].clone())).collect();
                let sum = bench.graph.linear(&terms);
                other.xi[k + 1][i] = bench.tidy(sum);
            }
        }
        other
    }
}

/// A system in the rates of its base angles.
pub(super) struct InBaseParameters {
    change: Change,
    restated: Restated,
}

impl InBaseParameters {
    /// `None` where these are the parameters as declared.
    pub(super) fn new(bench: &mut Workbench, declared: &Mechanics, frame: &mut Frame) -> Option<Self> {
        let change = Change::new(bench, declared, frame)?;
        let zetas: Vec<ExprId> = (0..declared.forms.degrees)
            .map(|s| bench.graph.symbol(&format!("zeta{}", s + 1), Role::QuasiVelocity))
            .collect();
        let system = change.system(bench, declared, &zetas);
        let operators = change.operators(bench, &frame.operators);
        let restated = Restated::new(bench, system, operators)?;
        Some(InBaseParameters { change, restated })
    }

    /// The equations in the parameters as declared, `J^T M J eta' = J^T f`, without the generalised forces.
    pub(super) fn equations(&self, bench: &mut Workbench, declared: &Mechanics) -> Equations {
        let Equations { mass, forces } = &self.restated.projected.equations;
        let columns = transposed(&self.change.to);
        let kept = |bench: &mut Workbench, v: &[ExprId]| -> Vec<ExprId> {
            accumulated(bench, &columns, v).into_iter().map(|e| bench.keep_large(e)).collect()
        };
        let right: Vec<Vec<ExprId>> = mass.iter().map(|row| kept(bench, row)).collect();
        let turned: Vec<Vec<ExprId>> = transposed(&right).iter().map(|column| kept(bench, column)).collect();
        let forces = kept(bench, forces);
        let l = forces.len();
        let sums = self.parameters(bench, declared);
        let mut out = Substitution::new(self.restated.system.etas[..l].iter().copied().zip(sums));
        let mut out = |bench: &mut Workbench, e: &ExprId| out.of(&mut bench.graph, *e);
        Equations {
            mass: transposed(&turned).iter().map(|row| row.iter().map(|e| out(bench, e)).collect()).collect(),
            forces: forces.iter().map(|e| out(bench, e)).collect(),
        }
    }

    /// The other parameters by those as declared; each sum of them once.
    fn parameters(&self, bench: &mut Workbench, declared: &Mechanics) -> Vec<ExprId> {
        let sums = applied(bench, &self.change.to, &declared.etas[..self.change.to.len()]);
        sums.into_iter().map(|e| bench.graph.keep(e)).collect()
    }

    /// Solves by the constraint forces, and returns to the parameters as declared.
    pub(super) fn by_constraint_forces(
        &mut self,
        bench: &mut Workbench,
        declared: &Mechanics,
    ) -> Option<ByConstraintForces> {
        let Restated { system, frame, forces, projected } = &mut self.restated;
        let (squares, etas) = (projected.squares.as_ref()?, &system.etas[..system.forms.degrees]);
        let theirs = constraint_forces::dense_cost(bench, &projected.equations.mass[..etas.len()]);
        let solved = constraint_forces::solve_squares(bench, frame, squares, theirs, etas, forces)?;
        // An acceleration that several of the others are differences of is computed once; written out, small ones have more in common.
        let is_large = weighted_cost(&bench.graph, &solved.accelerations) > ALL_FORMS;
        let is_shared = |k: usize| self.change.back.iter().filter(|row| !row[k].is_zero()).count() > 1;
        let mut own = solved.accelerations;
        for (_, e) in own.iter_mut().enumerate().filter(|(k, _)| is_large && is_shared(*k)) {
            *e = bench.graph.keep(*e);
        }
        let accelerations = self.turned_back(bench, declared, &[], own);
        Some(ByConstraintForces { accelerations, ..solved })
    }

    /// Solves the equations, and returns to the parameters as declared.
    pub(super) fn rates(&mut self, bench: &mut Workbench, declared: &Mechanics) -> Vec<Vec<ExprId>> {
        let n = declared.velocities.len();
        let found = self.restated.rates(bench, &mut Symmetry::default());
        let back = |mut rates: Vec<ExprId>| {
            let accelerations = rates.split_off(n);
            self.turned_back(bench, declared, &rates, accelerations)
        };
        found.into_iter().map(back).collect()
    }

    /// Returns the rates of the state with the parameters as declared; each sum of parameters is computed once.
    fn turned_back(
        &self,
        bench: &mut Workbench,
        declared: &Mechanics,
        velocities: &[ExprId],
        accelerations: Vec<ExprId>,
    ) -> Vec<ExprId> {
        let l = accelerations.len();
        let sums = self.parameters(bench, declared);
        let mut out = Substitution::new(self.restated.system.etas[..l].iter().copied().zip(sums));
        let accelerations = applied(bench, &self.change.back, &accelerations);
        velocities.iter().chain(&accelerations).map(|e| out.of(&mut bench.graph, *e)).collect()
    }
}

fn applied(bench: &mut Workbench, matrix: &Matrix, vector: &[ExprId]) -> Vec<ExprId> {
    matrix
        .iter()
        .map(|row| {
            let terms: Vec<_> = vector.iter().copied().zip(row.iter().cloned()).collect();
            bench.graph.linear(&terms)
        })
        .collect()
}

/// Sums of the matrix times a vector, each computed from one that was found before and the terms that it has beyond
/// it. No two of these have opposite signs where rows of the matrix grow by one entry each.
fn accumulated(bench: &mut Workbench, matrix: &Matrix, vector: &[ExprId]) -> Vec<ExprId> {
    let count = |row: &[Rational]| row.iter().filter(|c| !c.is_zero()).count();
    let mut order: Vec<usize> = (0..matrix.len()).collect();
    order.sort_by_key(|k| count(&matrix[*k]));
    let mut found: Vec<(usize, ExprId)> = Vec::new();
    for k in order {
        let mut best = (matrix[k].clone(), None);
        for (other, e) in &found {
            let beyond: Vec<Rational> = matrix[k].iter().zip(&matrix[*other]).map(|(a, b)| a - b).collect();
            if count(&beyond) + 1 < count(&best.0) {
                best = (beyond, Some(*e));
            }
        }
        let (beyond, known) = best;
        let own = vector.iter().copied().zip(beyond).filter(|(_, c)| !c.is_zero());
        let terms: Vec<_> = own.chain(known.map(|e| (e, Rational::ONE))).collect();
        let sum = bench.graph.linear(&terms);
        found.push((k, bench.graph.keep(sum)));
    }
    found.sort_by_key(|(k, _)| *k);
    found.into_iter().map(|(_, e)| e).collect()
}

fn transposed<T: Clone>(matrix: &[Vec<T>]) -> Vec<Vec<T>> {
    let width = matrix.first().map_or(0, Vec::len);
    (0..width).map(|k| matrix.iter().map(|row| row[k].clone()).collect()).collect()
}

fn unit(l: usize, s: usize) -> Vec<Rational> {
    (0..l).map(|k| if k == s { Rational::ONE } else { Rational::ZERO }).collect()
}

/// `row - c other`.
fn eliminate(row: &mut [Rational], c: &Rational, other: &[Rational]) {
    if !c.is_zero() {
        row.iter_mut().zip(other).for_each(|(a, b)| *a = &*a - &(c * b));
    }
}

/// The inverse of a matrix of numbers, by elimination.
fn inverse(matrix: &Matrix) -> Option<Matrix> {
    let l = matrix.len();
    let mut rows: Matrix =
        matrix.iter().enumerate().map(|(k, row)| [row.clone(), unit(l, k)].concat()).collect();
    for k in 0..l {
        let pivot = (k..l).find(|r| !rows[*r][k].is_zero())?;
        rows.swap(k, pivot);
        let inverse = rows[k][k].recip()?;
        rows[k].iter_mut().for_each(|c| *c = &*c * &inverse);
        let own = rows[k].clone();
        for (r, row) in rows.iter_mut().enumerate() {
            if r != k {
                let c = row[k].clone();
                eliminate(row, &c, &own);
            }
        }
    }
    Some(rows.into_iter().map(|row| row[l..].to_vec()).collect())
}
