//! The equations of motion in other words, where that makes them shorter: in other parameters, and without coordinates
//! that they do not depend on.
//!
//! The parameters of a chain in relative angles are the rates of its joints, and its mass matrix in them has long
//! entries: each joint moves all links beyond it. In the rates of the base angles, the sums of the joints' rates, the
//! equations are those of absolute angles. So the accelerations are found there, `zeta = J eta` with numbers for `J`,
//! and turned back. For symmetries see `symmetry`.

use super::projection::Projected;
use super::symmetry::Symmetry;
use super::tensions::{self, Tensions};
use super::velocity_forms::VelocityPartials;
use super::{Equations, Frame, Mechanics, Solution, decompose, derivation, poincare, projection, routes};
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

/// What is found in other words.
pub(super) struct Rephrased {
    /// The rates of the state, one list for each set of expressions that is worth a program.
    pub(super) rates: Vec<Vec<ExprId>>,
    /// What the equations do not depend on.
    pub(super) symmetry: Symmetry,
    /// The equations without that, generalised forces not included, where they are in the parameters as declared.
    pub(super) equations: Option<Equations>,
}

impl Rephrased {
    /// Looks for other words for the motion.
    pub(super) fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        shown: &Equations,
        raw: &Equations,
        mut words: Option<Words>,
    ) -> Self {
        let is_changed = words.is_some();
        let sums = bench.graph.base_angles().iter().any(|angle| !bench.graph.is_monomial(*angle));
        let (mut symmetry, reduced) = symmetry(bench, system, shown, raw);
        let mut found = Vec::new();
        let mut without = None;
        if !symmetry.is_empty() {
            let l = system.forms.degrees;
            bench.choose_base_angles(&symmetry.heads, &reduced);
            if is_changed {
                // The base angles are others now.
                words = Words::changed(bench, system, frame);
            } else {
                let mut partials = VelocityPartials::of_system(bench, system);
                let forces = derivation::generalised_forces(bench, system, frame, &mut partials);
                let velocities = symmetry.reduced_each(bench, &frame.velocities);
                let reduced = unflattened(reduced, l);
                let equations = candidates(bench, system, &reduced, &reduced);
                without = equations.first().cloned();
                found.extend(solutions(bench, equations, &forces, &velocities));
                words = Words::unchanged(bench, system);
            }
        }
        if let Some(words) = words {
            found.extend(words.rates(bench, system, &mut symmetry));
        }
        if sums && found.iter().all(|rates| weighted_cost(&bench.graph, rates) <= SMALL) {
            // In single coordinates too: `cos(q_2)` is more than it looks beside `q_1` and `q_1 + q_2`.
            bench.choose_base_angles(&[], &[]);
            if let Some(words) = Words::unchanged(bench, system) {
                found.extend(words.rates(bench, system, &mut Symmetry::default()));
            }
            bench.choose_base_angles(&[], &system.expressions());
        }
        Self { rates: found, symmetry, equations: without }
    }
}

/// The equations in several forms, as of [`routes::candidates`]; multiplied out alone, where that leaves little: velocities that
/// are kept whole because they are long with a heading may be short without it, and their squares may meet.
fn candidates(
    bench: &mut Workbench,
    system: &Mechanics,
    definition: &Equations,
    reduced: &Equations,
) -> Vec<Equations> {
    let mut found = routes::candidates(bench, system, definition, reduced);
    let entries = reduced.entries();
    if weighted_cost(&bench.graph, &entries) > SMALL {
        return found;
    }
    let opened = bench.graph.opened(&entries);
    if opened == entries {
        return found;
    }
    let Equations { mut mass, forces } = unflattened(opened, system.forms.degrees);
    let Some(forces) = routes::normal_forces(bench, system, &forces) else { return found };
    for (entry, known) in mass.iter_mut().flatten().zip(found[0].mass.iter().flatten()) {
        let tidy = bench.tidy(*entry);
        let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
        *entry = if cost(tidy) < cost(*known) { tidy } else { *known };
    }
    let open = Equations { mass, forces };
    if weighted_cost(&bench.graph, &open.entries()) < weighted_cost(&bench.graph, &found[0].entries()) {
        found = vec![open];
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

/// A system derived once more, perhaps in other parameters.
pub(super) struct Words {
    change: Option<Change>,
    system: Mechanics,
    frame: Frame,
    forces: Vec<ExprId>,
    projected: Projected,
}

impl Words {
    /// In the rates of the base angles; `None` where these are the parameters.
    pub(super) fn changed(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame) -> Option<Self> {
        let change = Change::new(bench, system, frame)?;
        let zetas: Vec<ExprId> = (0..system.forms.degrees)
            .map(|s| bench.graph.symbol(&format!("zeta{}", s + 1), Role::QuasiVelocity))
            .collect();
        let other = change.system(bench, system, &zetas);
        let operators = change.operators(bench, &frame.operators);
        Self::new(bench, other, operators, Some(change))
    }

    /// In the same parameters, for base angles that have changed.
    fn unchanged(bench: &mut Workbench, system: &Mechanics) -> Option<Self> {
        let operators = Operators::new(bench, &system.forms).ok()?;
        Self::new(bench, system.clone(), operators, None)
    }

    fn new(
        bench: &mut Workbench,
        system: Mechanics,
        operators: Operators,
        change: Option<Change>,
    ) -> Option<Self> {
        let mut frame = Frame::new(bench, &system, operators);
        let mut partials = VelocityPartials::of_system(bench, &system);
        let symbols: Vec<ExprId> = system.velocities.iter().chain(&system.etas).copied().collect();
        let terms = decompose(bench, &mut partials, &symbols, system.kinetic_energy).ok()?;
        let forces = derivation::generalised_forces(bench, &system, &mut frame, &mut partials);
        let l = system.forms.degrees;
        let projected = projection::equations(bench, &system, &mut frame, &mut partials, &terms, 0..l);
        Some(Words { change, system, frame, forces, projected })
    }

    /// By tensions, in the parameters as declared.
    pub(super) fn by_tensions(&mut self, bench: &mut Workbench, declared: &Mechanics) -> Option<Tensions> {
        let etas = &self.system.etas[..self.system.forms.degrees];
        let squares = self.projected.squares.as_ref()?;
        let equations = &self.projected.equations;
        let tensions = tensions::solve(bench, &mut self.frame, squares, equations, etas, &self.forces)?;
        let accelerations = self.turned_back(bench, declared, &[], tensions.accelerations);
        Some(Tensions { accelerations, ..tensions })
    }

    fn rates(
        mut self,
        bench: &mut Workbench,
        declared: &Mechanics,
        symmetry: &mut Symmetry,
    ) -> Vec<Vec<ExprId>> {
        let l = self.system.forms.degrees;
        let list = flattened(&self.projected.equations, l);
        let definition = (weighted_cost(&bench.graph, &list) <= SMALL)
            .then(|| flattened(&poincare::equations(bench, &self.system, &mut self.frame), l));
        let reduced = unflattened(symmetry.reduced(bench, &list), l);
        let definition = definition.map(|list| unflattened(symmetry.reduced(bench, &list), l));
        let velocities = symmetry.reduced_each(bench, &self.frame.velocities);
        let definition = definition.as_ref().unwrap_or(&reduced);
        let equations = candidates(bench, &self.system, definition, &reduced);
        let found = solutions(bench, equations, &self.forces, &velocities);
        found
            .into_iter()
            .map(|mut rates| {
                let accelerations = rates.split_off(velocities.len());
                self.turned_back(bench, declared, &rates, accelerations)
            })
            .collect()
    }

    /// Back to the parameters as declared; each sum of them once.
    fn turned_back(
        &self,
        bench: &mut Workbench,
        declared: &Mechanics,
        velocities: &[ExprId],
        accelerations: Vec<ExprId>,
    ) -> Vec<ExprId> {
        let Some(change) = &self.change else { return [velocities, &accelerations].concat() };
        let l = accelerations.len();
        let sums = applied(bench, &change.to, &declared.etas[..l]);
        let sums: Vec<ExprId> = sums.into_iter().map(|e| bench.graph.keep(e)).collect();
        let mut out = Substitution::new(self.system.etas[..l].iter().copied().zip(sums));
        let accelerations = applied(bench, &change.back, &accelerations);
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
