//! Rates of systems with so many parameters that their equations are not written out.
//!
//! A mass matrix has an entry for each pair of parameters, and equations that are multiplied out have a term for each body behind
//! both. Beyond [`STATED_PARAMETERS`] the rates do not come from there: they come from the reactions between the velocity forms as unknowns,
//! or from the bodies, with work that grows with the pairs of forms and parameters that meet. The equations are put up over the tree of
//! the forms, and beyond [`WRITTEN_OUT_PARAMETERS`] not at all. Rates and equations are proved like all others.

mod composed;

use std::collections::BTreeMap;

use self::composed::Composed;
use super::constraint_forces::{self, Differences, Edge};
use super::{MULTIPLIED_OUT, multibody};
use crate::algebra::{ExprId, FastMap, Node, Rational, gradient};
use crate::motion::definition::projection::{Curl, Square, squares};
use crate::motion::definition::proof::Definition;
use crate::motion::mass_matrix::sparse::Vector;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::thresholds::{
    COMPARED_FORMS, COUPLED_COORDINATES, DIAGONAL_PARAMETERS, FORCES_PER_PARAMETER, MOST_FORMS,
    STATED_PARAMETERS, WRITTEN_OUT_PARAMETERS,
};
use crate::motion::{DerivationError, Frame, KineticTerm, Mechanics, MotionEquations, Solution};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The name of the formulation by reactions between the velocity forms.
const CONSTRAINT_FORCES: &str = "constraint forces";

/// The rates of a system without its equations.
pub(super) struct Alone {
    /// The name of the formulation.
    pub(super) name: &'static str,
    /// The rates of the state, velocities first.
    pub(super) rates: Vec<ExprId>,
    /// The accelerations among them.
    pub(super) solution: Solution,
    /// The equations with the generalised forces, and the momenta; none of those that are not written out.
    pub(super) equations: MotionEquations,
    pub(super) momenta: Vec<ExprId>,
}

/// Whether rates are looked for without the equations: the parameters are many, and they are coupled or very many.
pub(super) fn is_large(bench: &Workbench, system: &Mechanics, terms: &[KineticTerm]) -> bool {
    let forms = &system.forms.forms;
    let graph = &bench.graph;
    let is_single = |row: &[ExprId]| row.iter().filter(|a| !graph.is_zero(**a)).count() == 1;
    let mut velocities = terms.iter().flat_map(|term| &term.forms);
    let uncoupled = velocities.all(|u| matches!(graph.node(*u), Node::Symbol(_)))
        && terms.iter().all(|term| term.forms.len() != 2 || term.forms[0] == term.forms[1])
        && forms.iter().all(|form| is_single(&form.row));
    let turns = system.structure.frames().len() > 1;
    let many = if turns { WRITTEN_OUT_PARAMETERS } else { STATED_PARAMETERS };
    let is_free = forms.len() == system.forms.degrees;
    is_free && forms.len() > many && (!uncoupled || forms.len() > DIAGONAL_PARAMETERS)
}

/// Whether rates without equations may be found where equations are too much work: of bodies that turn, without constraints.
pub(in crate::motion) fn may_be_alone(system: &Mechanics) -> bool {
    let l = system.forms.degrees;
    l > STATED_PARAMETERS && system.forms.len() == l && system.structure.frames().len() > 1
}

/// The proved rates of a large system: by its bodies, where joints turn, else the cheapest of those without a mass matrix. None where
/// neither is understood.
pub(super) fn rates(
    bench: &mut Workbench,
    (system, frame): (&Mechanics, &mut Frame),
    partials: &mut VelocityPartials,
    (terms, generalised_forces): (&[KineticTerm], &[ExprId]),
    definition: &mut Definition,
    without_equations: bool,
) -> Result<Option<Alone>, DerivationError> {
    let mut found = Vec::new();
    if system.structure.frames().len() > 1
        && let Some(bodies) = multibody::rates(bench, system, frame, partials, true, |_| false)
    {
        let accelerations = bodies.rates[frame.velocities.len()..].to_vec();
        let solution = Solution::of_pivots(bench, accelerations, &bodies.pivots);
        found.push(("bodies", bodies.rates, solution));
    }
    let l = system.forms.degrees;
    let etas = &system.etas[..l];
    let without_equations = without_equations || l > WRITTEN_OUT_PARAMETERS;
    let mut composed = None;
    if found.is_empty()
        && let Some(differences) = differences(bench, (system, frame), partials, terms)
    {
        if let Some(solution) = uncoupled(bench, &differences, generalised_forces) {
            let rates = [&frame.velocities[..], &solution.accelerations].concat();
            found.push((MULTIPLIED_OUT, rates, solution));
        }
        if !without_equations {
            composed = composed::equations(bench, frame, &differences, etas);
        }
        let solved = composed.as_ref().map(|own| constraint_forces::dense_cost(bench, &own.equations.mass));
        let theirs = solved.unwrap_or(usize::MAX).min(FORCES_PER_PARAMETER * l);
        // Each constraint force costs as much as a parameter at least.
        let is_tried = differences.rows.len() <= MOST_FORMS * l && !bench.leaves_out(CONSTRAINT_FORCES);
        let by_forces = is_tried
            .then(|| constraint_forces::solve(bench, frame, differences, theirs, etas, generalised_forces));
        if let Some(by_forces) = by_forces.flatten() {
            let rates = [&frame.velocities[..], &by_forces.accelerations].concat();
            let solution = Solution::known(bench, by_forces.accelerations, &by_forces.divisors);
            found.push((CONSTRAINT_FORCES, rates, solution));
        }
    }
    found.sort_by_key(|(_, rates, _)| weighted_cost(&bench.graph, rates));
    for (name, rates, solution) in found {
        // Residues may lack too many roots to decide. Rows that are multiplied out are taken where real points show no difference.
        if !definition.is_solved_by(bench, (system, frame), &rates)? && name != MULTIPLIED_OUT {
            continue;
        }
        if without_equations {
            let equations = MotionEquations { mass: Vec::new(), forces: Vec::new() };
            return Ok(Some(Alone { name, rates, solution, equations, momenta: Vec::new() }));
        }
        if let Some(Composed { equations, momenta }) = composed
            && definition.is(bench, (system, frame), &equations, true)?
        {
            let equations = equations.driven(bench, generalised_forces);
            return Ok(Some(Alone { name, rates, solution, equations, momenta }));
        }
        return Ok(None);
    }
    Ok(None)
}

/// The accelerations of parameters of which no two meet in a square; none where some meet, or where one has no inertia that is sure.
fn uncoupled(bench: &mut Workbench, forms: &Differences, generalised_forces: &[ExprId]) -> Option<Solution> {
    let mut inertias: Vec<Vec<ExprId>> = vec![Vec::new(); generalised_forces.len()];
    for (k, mass) in forms.masses.iter().enumerate() {
        // A multiple of another form moves with the parameter of that one.
        let (mut of, mut multiple) = (k, Rational::ONE);
        while let (Some(edge), 0) = (&forms.edges[of], forms.rows[of].len()) {
            multiple = &multiple * &edge.multiple;
            of = edge.parent;
        }
        let [(s, component)] = forms.rows[of].entries() else { return None };
        if forms.edges[of].is_some() || !bench.graph.roles(*component).is_constant() {
            return None;
        }
        let component = bench.graph.scale(*component, &multiple);
        inertias[*s].push(bench.graph.product(&[(*mass, 1), (component, 2)]));
    }
    let mut accelerations = Vec::new();
    for (inertia, (own, force)) in inertias.into_iter().zip(forms.rest.iter().zip(generalised_forces)) {
        let inertia = bench.graph.sum(inertia);
        if !bench.graph.manifestly_nonzero(inertia) {
            return None;
        }
        let force = bench.graph.add(*own, *force);
        accelerations.push(bench.graph.div(force, inertia));
    }
    Some(Solution::known(bench, accelerations, &[]))
}

/// A form of the energy relative to another one that it is written with, the sum of that and of a few terms.
struct Relative {
    edge: Option<Edge>,
    /// The terms, without the factor of the square.
    terms: ExprId,
}

/// The forms of squares relative to those that stand in their sums: the position of a link is that of the link before, and a term.
fn as_written(bench: &mut Workbench, squares: &[Square]) -> Vec<Relative> {
    let mut places: FastMap<ExprId, usize> = FastMap::default();
    for (k, square) in squares.iter().enumerate() {
        places.or_insert_with(square.form, || k);
    }
    let relative = |bench: &mut Workbench, (k, square): (usize, &Square)| {
        let edge_to = |bench: &mut Workbench, form: ExprId, number: &Rational| {
            let parent = *places.get(&form).filter(|place| **place != k)?;
            let ratio = bench.graph.div(square.factor, squares[parent].factor);
            let multiple = number * bench.graph.as_number(ratio)?;
            Some(Edge { parent, multiple })
        };
        if let Some(edge) = edge_to(bench, square.form, &Rational::ONE) {
            return Relative { edge: Some(edge), terms: bench.graph.zero() };
        }
        if let Node::Sum { constant, terms } = bench.graph.node(square.form).clone() {
            for (place, (form, number)) in terms.iter().enumerate() {
                if let Some(edge) = edge_to(bench, *form, number) {
                    let others = terms.iter().enumerate().filter(|(other, _)| *other != place);
                    let others: Vec<(ExprId, Rational)> = others.map(|(_, term)| term.clone()).collect();
                    let (others, constant) = (bench.graph.linear(&others), bench.graph.number(constant));
                    return Relative { edge: Some(edge), terms: bench.graph.add(others, constant) };
                }
            }
        }
        Relative { edge: None, terms: square.form }
    };
    squares.iter().enumerate().map(|square| relative(bench, square)).collect()
}

/// The energy as squares of velocities, with constant factors, and the forces of `U`; none where it has anything else.
fn differences(
    bench: &mut Workbench,
    (system, frame): (&Mechanics, &mut Frame),
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
) -> Option<Differences> {
    if terms.iter().any(|term| term.forms.len() != 2) {
        return None;
    }
    let mut squares = squares(bench, terms)?;
    // A factor that is not constant is a part of the velocity form: the height of a link changes by `l sin(q) q'`.
    for square in &mut squares {
        if !bench.graph.roles(square.factor).is_constant() {
            square.form = bench.graph.mul(square.factor, square.form);
            square.factor = bench.graph.one();
        }
    }
    let masses: Vec<ExprId> = squares.iter().map(|square| square.mass).collect();
    let rest = potential_forces(bench, system, frame);
    // Sums that were made one have lost what they stood behind.
    let mut relative = match bench.graph.nests_sums() {
        true => as_written(bench, &squares),
        false => squares.iter().map(|square| Relative { edge: None, terms: square.form }).collect(),
    };
    let velocities: Vec<_> =
        squares.iter().zip(&relative).map(|(square, form)| (square.factor, form.terms)).collect();
    let (mut rows, mut drifts) = along_operators(bench, (system, frame), partials, &velocities)?;
    // Each form was written as an older form and a difference. Where the difference has nearly as many parameters as the form, the
    // form itself is kept. Doubtful are differences of several parameters, and the first forms of a chain, which hang on its root. For
    // those that are kept, `joined` looks for the nearest of all.
    let is_few = system.forms.degrees <= COUPLED_COORDINATES;
    let is_doubtful = |k: &usize| {
        let of_root = |edge: &Edge| relative[edge.parent].edge.is_none();
        relative[*k].edge.as_ref().is_some_and(|edge| is_few && rows[*k].len() > 1 || of_root(edge))
    };
    let doubtful: Vec<usize> = (0..rows.len()).filter(is_doubtful).collect();
    let doubtful = if is_few || doubtful.len() <= COMPARED_FORMS { doubtful } else { Vec::new() };
    let whole: Vec<_> = doubtful.iter().map(|k| (squares[*k].factor, squares[*k].form)).collect();
    let (whole, whole_drifts) = along_operators(bench, (system, frame), partials, &whole)?;
    for ((k, row), drift) in doubtful.into_iter().zip(whole).zip(whole_drifts) {
        if row.len() <= rows[k].len() + 1 {
            relative[k].edge = None;
            (rows[k], drifts[k]) = (row, drift);
        }
    }
    let edges = relative.into_iter().map(|form| form.edge).collect();
    Differences { masses, edges, rows, drifts, rest }.joined(bench)
}

/// The components of affine expressions in the velocities, times constant factors, along `X_1..X_l` and along `X_0`; none where one is
/// not closed.
fn along_operators(
    bench: &mut Workbench,
    (system, frame): (&Mechanics, &mut Frame),
    partials: &mut VelocityPartials,
    velocities: &[(ExprId, ExprId)],
) -> Option<(Vec<Vector>, Vec<ExprId>)> {
    let mut curl = Curl::new(bench, system);
    let columns = frame.operators.by_coordinate(&bench.graph);
    let (mut rows, mut drifts) = (Vec::new(), Vec::new());
    for (factor, terms) in velocities {
        let form = partials.affine(bench, *terms)?;
        if !curl.vanishes(bench, system, &form) {
            return None;
        }
        let mut sums: BTreeMap<usize, Vec<ExprId>> = BTreeMap::new();
        for (i, b) in &form.on_velocities {
            for (s, xi) in &columns[*i] {
                sums.entry(*s).or_default().push(bench.graph.mul(*b, *xi));
            }
        }
        sums.entry(0).or_default().push(form.offset);
        let mut row = Vector::default();
        for (s, terms) in sums {
            let sum = bench.graph.sum(terms);
            let own = bench.graph.mul(*factor, sum);
            let own = bench.tidy(own);
            match s {
                0 => drifts.push(own),
                s => row.set(&bench.graph, s - 1, own),
            }
        }
        rows.push(row);
    }
    Some((rows, drifts))
}

/// `X_s(U)` from all slopes at once.
fn potential_forces(bench: &mut Workbench, system: &Mechanics, frame: &Frame) -> Vec<ExprId> {
    let columns = frame.operators.by_coordinate(&bench.graph);
    let slopes = gradient(&mut bench.graph, system.force_function, &system.forms.coordinates);
    let mut forces: Vec<Vec<ExprId>> = vec![Vec::new(); system.forms.degrees + 1];
    for (slope, column) in slopes.iter().zip(&columns) {
        for (s, xi) in column {
            forces[*s].push(bench.graph.mul(*xi, *slope));
        }
    }
    let sum = |terms: Vec<ExprId>| {
        let several = terms.len() > 1;
        let sum = bench.graph.sum(terms);
        // Slopes along several coordinates have most of their terms in common.
        match several.then(|| bench.graph.linear_parts(sum)) {
            Some(parts) => bench.graph.linear(&parts),
            None => sum,
        }
    };
    forces.into_iter().skip(1).map(sum).collect()
}
