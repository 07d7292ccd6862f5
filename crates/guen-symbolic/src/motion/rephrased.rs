//! The equations of motion in other words, where that makes them shorter: in other parameters, and without coordinates
//! that they do not depend on.
//!
//! The parameters of a chain in relative angles are the rates of its joints, and its mass matrix in them has long
//! entries: each joint moves all links beyond it. In the rates of the base angles, the sums of the joints' rates, the
//! equations are those of absolute angles. So the accelerations are found there, `zeta = J eta` with numbers for `J`,
//! and turned back. For symmetries see `symmetry`.

use super::symmetry::Symmetry;
use super::velocity_forms::VelocityPartials;
use super::{Equations, Frame, Mechanics, Solution, decompose, derivation, poincare, projection};
use crate::algebra::{ExprId, Rational, Role, Substitution};
use crate::geometry::{Form, Operators};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// Up to this estimate all forms are tried.
const SMALL: u64 = 600;

type Matrix = Vec<Vec<Rational>>;

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
        let mut other = operators.clone();
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

/// The rates of the state in other words, one list for each set of expressions that is worth a program.
pub(super) fn rates(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    shown: &Equations,
    raw: &Equations,
) -> Vec<Vec<ExprId>> {
    let change = Change::new(bench, system, frame);
    let sums = bench.graph.base_angles().iter().any(|angle| !bench.graph.is_monomial(*angle));
    let (mut symmetry, reduced) = symmetry(bench, system, shown, raw);
    let mut found = Vec::new();
    if !symmetry.is_empty() {
        let l = system.forms.degrees;
        bench.choose_base_angles(&symmetry.heads, &reduced);
        if change.is_none() {
            let mut partials = VelocityPartials::of_system(bench, system);
            let forces = derivation::generalised_forces(bench, system, frame, &mut partials);
            let velocities = symmetry.reduced_each(bench, &frame.velocities);
            let reduced = unflattened(reduced, l);
            let equations = derivation::candidates(bench, system, &reduced, &reduced);
            found.extend(solutions(bench, equations, &forces, &velocities));
        }
    }
    if !symmetry.is_empty() || change.is_some() {
        found.extend(in_other_words(bench, system, frame, &mut symmetry, change).unwrap_or_default());
    }
    if sums && found.iter().all(|rates| weighted_cost(&bench.graph, rates) <= SMALL) {
        // In single coordinates too: `cos(q_2)` is more than it looks beside `q_1` and `q_1 + q_2`.
        bench.choose_base_angles(&[], &[]);
        let mut none = Symmetry::default();
        found.extend(in_other_words(bench, system, frame, &mut none, None).unwrap_or_default());
        bench.choose_base_angles(&[], &system.expressions());
    }
    found
}

/// A list of `l^2` entries of the mass matrix and `l` forces.
fn unflattened(mut list: Vec<ExprId>, l: usize) -> Equations {
    let forces = list.split_off(l * l);
    Equations { mass: list.chunks(l).map(<[ExprId]>::to_vec).collect(), forces }
}

/// The rates of the state by each of some equations.
fn solutions(
    bench: &mut Workbench,
    candidates: Vec<Equations>,
    forces: &[ExprId],
    velocities: &[ExprId],
) -> Vec<Vec<ExprId>> {
    let mut found = Vec::new();
    for mut equations in candidates {
        for (force, q) in equations.forces.iter_mut().zip(forces) {
            *force = bench.graph.add(*force, *q);
        }
        if let Ok(solution) = Solution::new(bench, &equations.mass, &equations.forces) {
            found.push([velocities, &solution.accelerations].concat());
        }
    }
    found
}

/// Symmetries, looked for where the equations have coordinates that the force function does not have, and what is
/// left of the equations.
fn symmetry(
    bench: &mut Workbench,
    system: &Mechanics,
    shown: &Equations,
    raw: &Equations,
) -> (Symmetry, Vec<ExprId>) {
    let l = system.forms.degrees;
    let written: Vec<ExprId> = shown.mass.iter().flatten().chain(&shown.forces).copied().collect();
    let occurring = bench.graph.symbols_in(&written);
    let bound = bench.graph.symbols_in(&[system.force_function]);
    let coordinates = system.forms.coordinates.iter().copied();
    let free: Vec<ExprId> = coordinates
        .filter(|x| bench.graph.as_symbol(*x).is_some_and(|s| occurring.contains(&s) && !bound.contains(&s)))
        .collect();
    // Zero is no point of a manifold.
    if free.is_empty() || !system.holonomic.is_empty() {
        return Default::default();
    }
    Symmetry::new(bench, &free, &flattened(raw, l))
}

/// The first `l` rows of the mass matrix, then as many forces.
fn flattened(equations: &Equations, l: usize) -> Vec<ExprId> {
    equations.mass[..l].iter().flatten().chain(&equations.forces[..l]).copied().collect()
}

fn in_other_words(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    symmetry: &mut Symmetry,
    change: Option<Change>,
) -> Option<Vec<Vec<ExprId>>> {
    let l = system.forms.degrees;
    let mut operators =
        if change.is_some() { frame.operators.clone() } else { Operators::new(bench, &system.forms).ok()? };
    let mut other = system.clone();
    if let Some(change) = &change {
        let zetas: Vec<ExprId> =
            (0..l).map(|s| bench.graph.symbol(&format!("zeta{}", s + 1), Role::QuasiVelocity)).collect();
        other = change.system(bench, system, &zetas);
        operators = change.operators(bench, &operators);
    }
    let mut frame = Frame::new(bench, &other, operators);
    let mut partials = VelocityPartials::of_system(bench, &other);
    let symbols: Vec<ExprId> = other.velocities.iter().chain(&other.etas).copied().collect();
    let terms = decompose(bench, &mut partials, &symbols, other.kinetic_energy).ok()?;
    let forces = derivation::generalised_forces(bench, &other, &mut frame, &mut partials);
    let raw = projection::equations(bench, &other, &mut frame, &mut partials, &terms, l);
    let list = flattened(&raw, l);
    let definition = (weighted_cost(&bench.graph, &list) <= SMALL)
        .then(|| flattened(&poincare::equations(bench, &other, &mut frame), l));
    let reduced = unflattened(symmetry.reduced(bench, &list), l);
    let definition = definition.map(|list| unflattened(symmetry.reduced(bench, &list), l));
    let velocities = symmetry.reduced_each(bench, &frame.velocities);
    let equations = derivation::candidates(bench, &other, definition.as_ref().unwrap_or(&reduced), &reduced);
    let found = solutions(bench, equations, &forces, &velocities);
    let Some(change) = change else { return Some(found) };
    // Back to the parameters as declared; each sum of them once.
    let sums = applied(bench, &change.to, &system.etas[..l]);
    let sums: Vec<ExprId> = sums.into_iter().map(|e| bench.graph.keep(e)).collect();
    let mut out = Substitution::new(other.etas[..l].iter().copied().zip(sums));
    let n = system.forms.len();
    Some(
        found
            .into_iter()
            .map(|mut rates| {
                let accelerations = applied(bench, &change.back, &rates.split_off(n));
                let rates = rates.iter().chain(&accelerations);
                rates.map(|e| out.of(&mut bench.graph, *e)).collect()
            })
            .collect(),
    )
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
