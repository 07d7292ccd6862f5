//! Rates of systems with so many parameters that their equations are not written out.
//!
//! A mass matrix has an entry for each pair of parameters, and so have the equations that are multiplied out of it. Beyond
//! [`WRITTEN_OUT_PARAMETERS`] none is made: the rates come from the bodies, or from the reactions between the velocity forms as unknowns, with
//! work that grows with the pairs of forms and parameters that meet. They are proved like all others.

use super::constraint_forces;
use super::projection::{Curl, Square, Squares, squares};
use super::proof::Definition;
use super::velocity_forms::VelocityPartials;
use super::{DerivationError, Frame, KineticTerm, Mechanics, Solution, multibody};
use crate::algebra::{ExprId, Node, gradient};
use crate::motion::thresholds::{DIAGONAL_PARAMETERS, FORCES_PER_PARAMETER, WRITTEN_OUT_PARAMETERS};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The rates of a system without its equations.
pub(super) struct Alone {
    /// The name of the formulation.
    pub(super) name: &'static str,
    /// The rates of the state, velocities first.
    pub(super) rates: Vec<ExprId>,
    /// The accelerations among them.
    pub(super) solution: Solution,
}

/// Whether a system has no constraints and more parameters than a mass matrix is written out for.
pub(super) fn has_many_parameters(system: &Mechanics) -> bool {
    let forms = &system.forms;
    forms.degrees > WRITTEN_OUT_PARAMETERS && forms.len() == forms.degrees
}

/// Whether the equations of a system are not written out: its parameters are many, and they are coupled or very many.
pub(super) fn is_large(bench: &Workbench, system: &Mechanics, terms: &[KineticTerm]) -> bool {
    let forms = &system.forms.forms;
    let graph = &bench.graph;
    let is_single = |row: &[ExprId]| row.iter().filter(|a| !graph.is_zero(**a)).count() == 1;
    let mut velocities = terms.iter().flat_map(|term| &term.forms);
    let uncoupled = velocities.all(|u| matches!(graph.node(*u), Node::Symbol(_)))
        && terms.iter().all(|term| term.forms.len() != 2 || term.forms[0] == term.forms[1])
        && forms.iter().all(|form| is_single(&form.row));
    has_many_parameters(system) && (!uncoupled || forms.len() > DIAGONAL_PARAMETERS)
}

/// The proved rates of a large system: by its bodies, where joints turn, else the cheapest of those without a mass matrix. None where
/// neither is understood.
pub(super) fn rates(
    bench: &mut Workbench,
    (system, frame): (&Mechanics, &mut Frame),
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
    generalised_forces: &[ExprId],
    definition: &mut Definition,
) -> Result<Option<Alone>, DerivationError> {
    let mut found = Vec::new();
    if system.structure.frames().len() > 1
        && let Some(bodies) = multibody::rates(bench, system, frame, partials, true, |_| false)
    {
        let accelerations = bodies.rates[frame.velocities.len()..].to_vec();
        let solution = Solution::of_pivots(bench, accelerations, &bodies.pivots);
        found.push(Alone { name: "bodies", rates: bodies.rates, solution });
    }
    if found.is_empty()
        && let Some(squares) = sparse_squares(bench, (system, frame), partials, terms)
    {
        if let Some(solution) = uncoupled(bench, &squares, generalised_forces) {
            let rates = [&frame.velocities[..], &solution.accelerations].concat();
            found.push(Alone { name: "multiplied out", rates, solution });
        }
        let l = system.forms.degrees;
        let theirs = FORCES_PER_PARAMETER * l;
        let by_forces =
            constraint_forces::solve(bench, frame, &squares, theirs, &system.etas[..l], generalised_forces);
        if let Some(by_forces) = by_forces {
            let rates = [&frame.velocities[..], &by_forces.accelerations].concat();
            let solution = Solution::known(bench, by_forces.accelerations, &by_forces.divisors);
            found.push(Alone { name: "constraint forces", rates, solution });
        }
    }
    found.sort_by_key(|alone| weighted_cost(&bench.graph, &alone.rates));
    for alone in found {
        if definition.is_solved_by(bench, (system, frame), &alone.rates)? {
            return Ok(Some(alone));
        }
    }
    Ok(None)
}

/// The accelerations of parameters of which no two meet in a square; none where some meet, or where one has no inertia that is sure.
fn uncoupled(bench: &mut Workbench, squares: &Squares, generalised_forces: &[ExprId]) -> Option<Solution> {
    let mut inertias: Vec<Vec<ExprId>> = vec![Vec::new(); generalised_forces.len()];
    for (mass, components) in squares.masses.iter().zip(&squares.components) {
        let moving = components.iter().enumerate().filter(|(_, e)| !bench.graph.is_zero(**e));
        let moving: Vec<(usize, &ExprId)> = moving.take(2).collect();
        let Some((s, component)) = moving.first().copied() else { continue };
        if moving.len() > 1 || !bench.graph.roles(*component).is_constant() {
            return None;
        }
        inertias[s].push(bench.graph.product(&[(*mass, 1), (*component, 2)]));
    }
    let mut accelerations = Vec::new();
    for (inertia, (own, force)) in inertias.into_iter().zip(squares.rest.iter().zip(generalised_forces)) {
        let inertia = bench.graph.sum(inertia);
        if !bench.graph.manifestly_nonzero(inertia) {
            return None;
        }
        let force = bench.graph.add(*own, *force);
        accelerations.push(bench.graph.div(force, inertia));
    }
    Some(Solution::known(bench, accelerations, &[]))
}

/// The energy as squares of velocities, with constant factors, and the forces of `U`; none where it has anything else.
fn sparse_squares(
    bench: &mut Workbench,
    (system, frame): (&Mechanics, &mut Frame),
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
) -> Option<Squares> {
    if terms.iter().any(|term| term.forms.len() != 2) {
        return None;
    }
    let l = system.forms.degrees;
    let list = squares(bench, terms)?;
    let mut curl = Curl::new(bench, system);
    let columns = frame.operators.by_coordinate(&bench.graph);
    let zero = bench.graph.zero();
    let mut found =
        Squares { masses: Vec::new(), components: Vec::new(), drifts: Vec::new(), rest: Vec::new() };
    for Square { mass, factor, form } in list {
        let form = partials.affine(bench, form)?;
        if !bench.graph.roles(factor).is_constant() || !curl.vanishes(bench, system, &form) {
            return None;
        }
        let mut components = vec![zero; l];
        let mut sums: Vec<Vec<ExprId>> = vec![Vec::new(); l + 1];
        for (i, b) in &form.on_velocities {
            for (s, xi) in &columns[*i] {
                sums[*s].push(bench.graph.mul(*b, *xi));
            }
        }
        sums[0].push(form.offset);
        let mut sums = sums.into_iter().map(|terms| {
            if terms.is_empty() {
                return zero;
            }
            let sum = bench.graph.sum(terms);
            let own = bench.graph.mul(factor, sum);
            bench.tidy(own)
        });
        found.drifts.push(sums.next().unwrap_or(zero));
        components.iter_mut().zip(sums).for_each(|(component, sum)| *component = sum);
        found.masses.push(mass);
        found.components.push(components);
    }
    // X_s(U) from all slopes at once.
    let slopes = gradient(&mut bench.graph, system.force_function, &system.forms.coordinates);
    let mut rest: Vec<Vec<ExprId>> = vec![Vec::new(); l + 1];
    for (slope, column) in slopes.iter().zip(&columns) {
        for (s, xi) in column {
            rest[*s].push(bench.graph.mul(*xi, *slope));
        }
    }
    found.rest = rest.into_iter().skip(1).map(|terms| bench.graph.sum(terms)).collect();
    Some(found)
}
