//! The equations in other parameters: the rates of the base angles.
//!
//! The parameters of a chain in relative angles are the rates of its joints, and its mass matrix in them has long entries: each joint
//! moves all links beyond it. In the rates of the base angles, the sums of the joints' rates, the equations are those of absolute angles.
//! So the accelerations are found there, `zeta = J eta` with numbers for `J`, and turned back.

use super::restated::{Prepared, Restated};
use crate::algebra::{ExprId, Rational, Role, Substitution};
use crate::geometry::{Form, Operators};
use crate::motion::coordinates::symmetry::Symmetry;
use crate::motion::definition::proof::Definition;
use crate::motion::formulations::constraint_forces::{self, ByConstraintForces};
use crate::motion::formulations::large::{self, Alone};
use crate::motion::thresholds::{ALL_FORMS, COUPLED_COORDINATES};
use crate::motion::{DerivationError, Frame, Mechanics, MotionEquations, Solution};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

type Matrix = Vec<Vec<Rational>>;

/// Other parameters, `zeta = J eta`.
pub(in crate::motion) struct Change {
    to: Matrix,
    back: Matrix,
}

impl Change {
    /// The rates of base angles, as far as they are combinations of several parameters, and parameters beside them; none where these are
    /// the parameters as declared, or where they are too many for a full matrix.
    pub(in crate::motion) fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
    ) -> Option<Self> {
        let l = system.forms.degrees;
        if l > COUPLED_COORDINATES {
            return None;
        }
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
        if !rows.iter().any(|row| count(row) > 1) {
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
    fn system(&self, bench: &mut Workbench, system: &Mechanics) -> Mechanics {
        let l = self.to.len();
        let zetas: Vec<ExprId> =
            (0..l).map(|s| bench.graph.symbol(&format!("zeta{}", s + 1), Role::QuasiVelocity)).collect();
        let etas_of_zetas = applied(bench, &self.back, &zetas);
        let mut other = system.clone();
        other.etas[..l].copy_from_slice(&zetas);
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

    /// The other parameters by those as declared; each sum of them once.
    fn parameters(&self, bench: &mut Workbench, declared: &Mechanics) -> Vec<ExprId> {
        PartialSums::new(&self.to).found(bench, &declared.etas[..self.to.len()])
    }

    /// The equations in the parameters as declared, `J^T M J eta' = J^T f`, of those in the other ones.
    fn equations(
        &self,
        bench: &mut Workbench,
        own: &MotionEquations,
        systems: (&Mechanics, &Mechanics),
    ) -> MotionEquations {
        let partial = PartialSums::new(&transposed(&self.to));
        let right: Vec<Vec<ExprId>> = own.mass.iter().map(|row| partial.kept(bench, row)).collect();
        let turned: Vec<Vec<ExprId>> =
            transposed(&right).iter().map(|column| partial.kept(bench, column)).collect();
        let forces = partial.kept(bench, &own.forces);
        let mut out = self.out(bench, systems);
        let mut out = |e: &ExprId| out.of(&mut bench.graph, *e);
        MotionEquations {
            mass: transposed(&turned).iter().map(|row| row.iter().map(&mut out).collect()).collect(),
            forces: forces.iter().map(&mut out).collect(),
        }
    }

    /// Returns the rates of the state with the parameters as declared; each sum of parameters is computed once.
    fn turned_back(
        &self,
        bench: &mut Workbench,
        systems: (&Mechanics, &Mechanics),
        velocities: &[ExprId],
        accelerations: &[ExprId],
    ) -> Vec<ExprId> {
        let mut out = self.out(bench, systems);
        let accelerations = applied(bench, &self.back, accelerations);
        velocities.iter().chain(&accelerations).map(|e| out.of(&mut bench.graph, *e)).collect()
    }

    /// The accelerations with the parameters as declared. One that several of them are differences of is computed once; written out,
    /// small ones have more in common.
    fn accelerations(
        &self,
        bench: &mut Workbench,
        systems: (&Mechanics, &Mechanics),
        mut own: Vec<ExprId>,
    ) -> Vec<ExprId> {
        let is_large = weighted_cost(&bench.graph, &own) > ALL_FORMS;
        let is_shared = |k: usize| self.back.iter().filter(|row| !row[k].is_zero()).count() > 1;
        for (_, e) in own.iter_mut().enumerate().filter(|(k, _)| is_large && is_shared(*k)) {
            *e = bench.graph.keep(*e);
        }
        self.turned_back(bench, systems, &[], &own)
    }

    /// Puts the parameters as declared in the place of the other ones.
    fn out(&self, bench: &mut Workbench, (declared, other): (&Mechanics, &Mechanics)) -> Substitution {
        let sums = self.parameters(bench, declared);
        Substitution::new(other.etas.iter().copied().zip(sums))
    }

    /// The proved rates of a large system by those in the other parameters; none where no way to these is known.
    pub(in crate::motion) fn large_rates(
        &self,
        bench: &mut Workbench,
        (declared, frame): (&Mechanics, &mut Frame),
        (definition, generalised_forces): (&mut Definition, &[ExprId]),
    ) -> Result<Option<Alone>, DerivationError> {
        let (system, operators) = (self.system(bench, declared), self.operators(bench, &frame.operators));
        let Some(mut own) = Prepared::new(bench, system, operators) else { return Ok(None) };
        let mut proof = Definition::new(bench, &own.system, &own.forces);
        let of = (&own.system, &mut own.frame);
        let given = (&own.terms[..], &own.forces[..]);
        let found = large::rates(bench, of, &mut own.partials, given, &mut proof, false)?;
        let Some(Alone { name, solution, equations, momenta, .. }) = found else { return Ok(None) };
        let systems = (declared, &own.system);
        let accelerations = self.accelerations(bench, systems, solution.accelerations);
        let rates = [&frame.velocities[..], &accelerations].concat();
        if !definition.is_solved_by(bench, (declared, frame), &rates)? {
            return Ok(None);
        }
        let solution = Solution { accelerations, ..solution };
        if equations.mass.is_empty() {
            return Ok(Some(Alone { name, rates, solution, equations, momenta }));
        }
        let undriven = equations.undriven(bench, &own.forces);
        let equations = self.equations(bench, &undriven, systems);
        if !definition.is(bench, (declared, frame), &equations, true)? {
            return Ok(None);
        }
        let equations = equations.driven(bench, generalised_forces);
        let momenta = PartialSums::new(&transposed(&self.to)).kept(bench, &momenta);
        let mut out = self.out(bench, systems);
        let momenta = momenta.into_iter().map(|e| out.of(&mut bench.graph, e)).collect();
        Ok(Some(Alone { name, rates, solution, equations, momenta }))
    }
}

/// A system in the rates of its base angles.
pub(in crate::motion) struct InBaseParameters {
    change: Change,
    restated: Restated,
}

impl InBaseParameters {
    /// `None` where these are the parameters as declared.
    pub(in crate::motion) fn new(
        bench: &mut Workbench,
        declared: &Mechanics,
        frame: &mut Frame,
    ) -> Option<Self> {
        let change = Change::new(bench, declared, frame)?;
        let system = change.system(bench, declared);
        let operators = change.operators(bench, &frame.operators);
        let restated = Restated::new(bench, system, operators)?;
        Some(InBaseParameters { change, restated })
    }

    /// The equations in the parameters as declared, without the generalised forces.
    pub(in crate::motion) fn equations(
        &self,
        bench: &mut Workbench,
        declared: &Mechanics,
    ) -> MotionEquations {
        let Restated { system, projected, .. } = &self.restated;
        self.change.equations(bench, &projected.equations, (declared, system))
    }

    /// Solves by the constraint forces, and returns to the parameters as declared.
    pub(in crate::motion) fn by_constraint_forces(
        &mut self,
        bench: &mut Workbench,
        declared: &Mechanics,
    ) -> Option<ByConstraintForces> {
        let Restated { system, frame, forces, projected } = &mut self.restated;
        let (squares, etas) = (projected.squares.as_ref()?, &system.etas[..system.forms.degrees]);
        let theirs = constraint_forces::dense_cost(bench, &projected.equations.mass[..etas.len()]);
        let solved = constraint_forces::solve_squares(bench, frame, squares, theirs, etas, forces)?;
        let accelerations = self.change.accelerations(bench, (declared, system), solved.accelerations);
        Some(ByConstraintForces { accelerations, ..solved })
    }

    /// Solves the equations, and returns to the parameters as declared.
    pub(in crate::motion) fn rates(
        &mut self,
        bench: &mut Workbench,
        declared: &Mechanics,
    ) -> Vec<Vec<ExprId>> {
        let n = declared.velocities.len();
        let found = self.restated.rates(bench, &mut Symmetry::default());
        let systems = (declared, &self.restated.system);
        let back = |rates: Vec<ExprId>| {
            let (velocities, accelerations) = rates.split_at(n);
            self.change.turned_back(bench, systems, velocities, accelerations)
        };
        found.into_iter().map(back).collect()
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

/// Sums of a matrix times a vector, each computed from one that was found before and the terms that it has beyond it. No two of
/// these have opposite signs where rows of the matrix grow by one entry each.
struct PartialSums {
    /// The sums, in the order in which they are computed.
    steps: Vec<PartialSum>,
}

/// A sum that is computed from another one.
struct PartialSum {
    row: usize,
    /// The row of the sum that is known before it.
    known: Option<usize>,
    /// The terms that it has beyond that sum.
    beyond: Vec<(usize, Rational)>,
}

impl PartialSums {
    fn new(matrix: &Matrix) -> Self {
        let mut order: Vec<usize> = (0..matrix.len()).collect();
        order.sort_by_key(|k| count(&matrix[*k]));
        let mut steps: Vec<PartialSum> = Vec::new();
        for row in order {
            let own = &matrix[row];
            let (mut least, mut known) = (count(own), None);
            for step in &steps {
                let beyond = own.iter().zip(&matrix[step.row]).filter(|(a, b)| a != b).count();
                if beyond + 1 < least {
                    (least, known) = (beyond, Some(step.row));
                }
            }
            let beyond = |s: usize| match known {
                Some(other) => &own[s] - &matrix[other][s],
                None => own[s].clone(),
            };
            let beyond = (0..own.len()).map(|s| (s, beyond(s))).filter(|(_, c)| !c.is_zero()).collect();
            steps.push(PartialSum { row, known, beyond });
        }
        PartialSums { steps }
    }

    /// The sums for a vector, with what is large kept whole.
    fn kept(&self, bench: &mut Workbench, vector: &[ExprId]) -> Vec<ExprId> {
        self.found(bench, vector).into_iter().map(|e| bench.keep_large(e)).collect()
    }

    /// The sums for a vector.
    fn found(&self, bench: &mut Workbench, vector: &[ExprId]) -> Vec<ExprId> {
        let mut found = vec![bench.graph.zero(); self.steps.len()];
        for PartialSum { row, known, beyond } in &self.steps {
            let own = beyond.iter().map(|(s, c)| (vector[*s], c.clone()));
            let terms: Vec<_> = own.chain(known.map(|other| (found[other], Rational::ONE))).collect();
            let sum = bench.graph.linear(&terms);
            found[*row] = bench.graph.keep(sum);
        }
        found
    }
}

/// The entries that differ from zero.
fn count(row: &[Rational]) -> usize {
    row.iter().filter(|c| !c.is_zero()).count()
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
