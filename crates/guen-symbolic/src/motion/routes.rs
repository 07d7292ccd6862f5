//! The equations by two independent routes, compared, and solved in what ways promise to be short.

use super::derivation::affordable;
use super::linkage::Tree;
use super::projection::Projected;
use super::rephrased::Rephrased;
use super::symmetry::Symmetry;
use super::velocity_forms::VelocityPartials;
use super::{
    DerivationError, Equations, Frame, KineticTerm, Mechanics, Solution, linkage, multibody, nested,
    poincare, projection, proof, rephrased, restriction, tensions, turned,
};
use crate::algebra::ExprId;
use crate::geometry::dependence;
use crate::normal::{Limits, normal_coefficients};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// With so many parameters, and so many links that hang on links, equations are not multiplied out.
const MANY: usize = 6;

/// Multiplied out equations up to this estimate are solved as they are.
const LARGE: u64 = 400;

/// Rates up to this estimate are sought in all ways.
const LARGEST_TRIED: u64 = 600;

/// Where those of the links are so many times shorter, the others are not solved at all.
const MUCH: u64 = 5;

/// What the routes lead to.
pub(super) struct Found {
    /// The equations for `s = 1..l`, generalised forces included.
    pub(super) equations: Equations,
    /// The rows `s = l+1..n`, of the reactions, without the generalised forces.
    pub(super) constrained: Equations,
    /// The solved accelerations.
    pub(super) solution: Solution,
    /// Equal rates of the state, velocities first.
    pub(super) alternatives: Vec<Vec<ExprId>>,
    pub(super) by_tensions: bool,
    pub(super) by_nesting: bool,
    pub(super) by_links: bool,
    pub(super) by_bodies: bool,
    /// What the equations do not depend on.
    pub(super) symmetry: Symmetry,
}

pub(super) fn equations(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
    generalised_forces: &[ExprId],
) -> Result<Found, DerivationError> {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    affordable(bench)?;
    let tree = linkage::tree(bench, system, frame, partials);
    if let Some(tree) = &tree
        && l.min(tree.joints()) >= MANY
        && let Some(equations) = of_links(bench, system, frame, partials, tree)?
    {
        let equations = equations.driven(bench, generalised_forces);
        let constrained = if l == n {
            Equations { mass: Vec::new(), forces: Vec::new() }
        } else {
            projection::equations(bench, system, frame, partials, terms, l..n).equations
        };
        affordable(bench)?;
        let mut solution = solved(bench, &equations)?;
        let bodies = of_bodies(bench, system, frame, partials, &solution)?;
        let by_bodies = bodies.is_some();
        if let Some(found) = bodies {
            solution = found.taken(bench, frame);
        }
        return Ok(Found {
            equations,
            constrained,
            solution,
            alternatives: Vec::new(),
            by_tensions: false,
            by_nesting: false,
            by_links: true,
            by_bodies,
            symmetry: Symmetry::default(),
        });
    }
    let by_definition = poincare::equations(bench, system, frame);
    affordable(bench)?;
    let whole = weighted_cost(&bench.graph, &by_definition.entries());
    let linked = match tree {
        Some(tree) if whole > LARGE => linkage::equations(bench, system, frame, partials, &tree),
        _ => None,
    };
    let linked = match linked {
        Some(linked)
            if weighted_cost(&bench.graph, &linked.entries()) < whole
                && proof::are_same(bench, &by_definition, &linked)? =>
        {
            Some(linked.driven(bench, generalised_forces))
        }
        _ => None,
    };

    let projected = projection::equations(bench, system, frame, partials, terms, 0..n);
    compare(bench, &by_definition, &projected.equations, l)?;
    let constrained = Equations {
        mass: projected.equations.mass[l..].to_vec(),
        forces: projected.equations.forces[l..].to_vec(),
    };
    let mut candidates = candidates(bench, system, &by_definition, &projected.equations);
    // On constraints on positions the axes of the bodies leave less than those of the world.
    let linked_only = linked.as_ref().is_some_and(|linked| is_much_shorter(bench, linked, whole));
    let in_own_axes = match system.holonomic.is_empty() || linked_only {
        true => None,
        false => turned::equations(bench, system, frame, &projected.forms),
    };
    if let Some(own) = &in_own_axes
        && weighted_cost(&bench.graph, &own.equations.entries())
            < weighted_cost(&bench.graph, &candidates[0].entries())
        && proof::are_same(bench, &by_definition, &own.equations)?
    {
        candidates.insert(0, own.equations.clone());
    }
    let mut candidates: Vec<Equations> = candidates
        .into_iter()
        .map(|equations| {
            let equations = equations.driven(bench, generalised_forces);
            restriction::restricted(bench, system, equations)
        })
        .collect();
    let equations = candidates.remove(0);
    affordable(bench)?;
    let mut words = rephrased::Words::changed(bench, system, frame);
    let tensions = match &mut words {
        Some(words) => words.by_tensions(bench, system),
        None => projected.squares.as_ref().and_then(|squares| {
            let etas = &system.etas[..l];
            tensions::solve(bench, frame, squares, &equations, etas, generalised_forces)
        }),
    };
    affordable(bench)?;
    let tensions = match tensions {
        Some(tensions) if proof::solve_equations(bench, &equations, &tensions.accelerations)? => {
            Some(tensions)
        }
        _ => None,
    };
    let by_tensions = tensions.is_some();
    let clear = tensions.as_ref().is_some_and(|tensions| tensions.is_clear);
    let mut alternatives: Vec<Vec<ExprId>> = Vec::new();
    let (mut by_nesting, mut by_bodies) = (false, false);
    let mut symmetry = Symmetry::default();
    let by_links = linked.is_some();
    let (equations, solution) = match (tensions, linked) {
        (Some(tensions), linked) if clear => {
            let others = linked.and_then(|linked| Solution::new(bench, &linked.mass, &linked.forces).ok());
            let least = weighted_cost(&bench.graph, &tensions.accelerations);
            let others = others.filter(|other| weighted_cost(&bench.graph, &other.accelerations) < least);
            alternatives.extend(others.map(|other| [&frame.velocities[..], &other.accelerations].concat()));
            (equations, Solution::known(bench, tensions.accelerations, &tensions.divisors))
        }
        (tensions, Some(linked)) if linked_only => {
            let mut solution = solved(bench, &linked)?;
            let others = tensions.map(|tensions| [&frame.velocities[..], &tensions.accelerations].concat());
            alternatives.extend(others);
            if let Some(found) = of_bodies(bench, system, frame, partials, &solution)? {
                by_bodies = true;
                solution = found.taken(bench, frame);
            }
            (linked, solution)
        }
        (tensions, linked) => {
            let solution = solved(bench, &equations)?;
            // Where the bodies as they hang on each other promise half of the cost, nothing else is tried.
            let bodies = of_bodies(bench, system, frame, partials, &solution)?;
            if let Some(found) = &bodies
                && found.is_half
            {
                let solution = found.clone().taken(bench, frame);
                affordable(bench)?;
                return Ok(Found {
                    equations,
                    constrained,
                    solution,
                    alternatives: Vec::new(),
                    by_tensions: false,
                    by_nesting: false,
                    by_links,
                    by_bodies: true,
                    symmetry,
                });
            }
            let others = candidates
                .into_iter()
                .chain(linked)
                .filter_map(|other| Solution::new(bench, &other.mass, &other.forces).ok())
                .collect::<Vec<Solution>>();
            let others = others
                .into_iter()
                .chain(Solution::shared(bench, &equations.mass, &equations.forces))
                .map(|other| other.accelerations)
                .chain(tensions.map(|tensions| tensions.accelerations));
            alternatives.extend(others.map(|other| [&frame.velocities[..], &other].concat()));
            let own = [&frame.velocities[..], &solution.accelerations].concat();
            by_bodies = bodies.is_some();
            alternatives.extend(bodies.map(|found| found.rates));
            let Projected { equations: by_projection, forms, .. } = &projected;
            // What multiplies out to little is better multiplied out.
            let least = weighted_cost(&bench.graph, &own);
            let mut others = nested::rates(bench, system, frame, terms, forms, generalised_forces, least);
            others.retain(|rates| weighted_cost(&bench.graph, rates) < least);
            by_nesting = !others.is_empty();
            let in_own_axes = in_own_axes.or_else(|| turned::equations(bench, system, frame, forms));
            others
                .extend(in_own_axes.into_iter().flat_map(|own| own.rates(bench, system, generalised_forces)));
            let rephrased = Rephrased::new(bench, system, frame, &equations, by_projection, words);
            others.extend(rephrased.rates);
            symmetry = rephrased.symmetry;
            for rates in others {
                if proof::are_equal(bench, &own, &rates, n)? {
                    alternatives.push(rates);
                }
            }
            let shorter = match rephrased.equations {
                Some(other) if proof::are_same(bench, &by_definition, &other)? => {
                    Some(other.driven(bench, generalised_forces))
                }
                _ => None,
            };
            let cost = |equations: &Equations| weighted_cost(&bench.graph, &equations.entries());
            let shorter = shorter.filter(|other| cost(other) < cost(&equations));
            (shorter.unwrap_or(equations), solution)
        }
    };
    affordable(bench)?;
    Ok(Found {
        equations,
        constrained,
        solution,
        alternatives,
        by_tensions,
        by_nesting,
        by_links,
        by_bodies,
        symmetry,
    })
}

/// The rates of a tree of bodies, where these are cheaper than others, and equal to them.
fn of_bodies(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    partials: &mut VelocityPartials,
    solution: &Solution,
) -> Result<Option<multibody::Found>, DerivationError> {
    let own = [&frame.velocities[..], &solution.accelerations].concat();
    let Some(mut found) = multibody::rates(bench, system, frame, partials) else { return Ok(None) };
    let [cost, least] = [&found.rates, &own].map(|rates| weighted_cost(&bench.graph, rates));
    if cost >= least {
        return Ok(None);
    }
    found.is_half = cost > LARGEST_TRIED && 2 * cost <= least;
    let is_equal = proof::are_equal(bench, &own, &found.rates, frame.velocities.len())?;
    Ok(is_equal.then_some(found))
}

/// The equations of the links of a large tree, compared with (2.7) along two displacements.
fn of_links(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
    tree: &Tree<'_>,
) -> Result<Option<Equations>, DerivationError> {
    let Some(equations) = linkage::equations(bench, system, frame, partials, tree) else { return Ok(None) };
    // Numbers without a pattern that entries could share.
    for (factor, modulus) in [(37, 101), (59, 103)] {
        let weights: Vec<i64> =
            (1..=system.forms.degrees as i64).map(|s| factor * s * s % modulus - 50).collect();
        let (mass, force) = poincare::along(bench, system, frame, &weights);
        affordable(bench)?;
        if !proof::are_same_along(bench, &weights, (&mass, force), &equations)? {
            return Ok(None);
        }
    }
    Ok(Some(equations))
}

/// Whether nothing else is to be solved beside these equations.
fn is_much_shorter(bench: &Workbench, linked: &Equations, whole: u64) -> bool {
    MUCH * weighted_cost(&bench.graph, &linked.entries()) < whole
}

impl Equations {
    /// All entries.
    pub(super) fn entries(&self) -> Vec<ExprId> {
        self.mass.iter().flatten().chain(&self.forces).copied().collect()
    }

    /// The equations with the generalised forces.
    pub(super) fn driven(mut self, bench: &mut Workbench, generalised_forces: &[ExprId]) -> Self {
        for (force, q) in self.forces.iter_mut().zip(generalised_forces) {
            *force = bench.graph.add(*force, *q);
        }
        self
    }
}

/// The equations solved, or what of them is without inertia.
fn solved(bench: &mut Workbench, equations: &Equations) -> Result<Solution, DerivationError> {
    let solution = Solution::new(bench, &equations.mass, &equations.forces);
    affordable(bench)?;
    solution.map_err(|rows| DerivationError::SingularMass(weightless(bench, &equations.mass, &rows)))
}

/// A proved difference between the routes is a mistake of ours.
fn compare(bench: &mut Workbench, a: &Equations, b: &Equations, l: usize) -> Result<(), DerivationError> {
    if proof::routes_agree(bench, a, b, l) {
        return Ok(());
    }
    for s in 0..l {
        let same = |bench: &mut Workbench, a: ExprId, b: ExprId| {
            let difference = bench.graph.sub(a, b);
            !bench.zero.is_shown_nonzero(&mut bench.graph, difference, false)
        };
        let agree =
            same(bench, a.forces[s], b.forces[s]) && (0..l).all(|t| same(bench, a.mass[s][t], b.mass[s][t]));
        if !agree {
            return Err(DerivationError::RoutesDisagree { equation: s });
        }
    }
    Ok(())
}

/// The motion without inertia of a singular mass matrix, from a smallest set of rows that is dependent: by symmetry
/// the coefficients of the rows are the motion.
fn weightless(bench: &mut Workbench, mass: &[Vec<ExprId>], rows: &[usize]) -> Vec<(usize, Option<ExprId>)> {
    let Some((last, support)) = rows.split_last() else { return Vec::new() };
    let others: Vec<&[ExprId]> = support.iter().map(|s| &mass[*s][..]).collect();
    let Some(coefficients) = dependence(bench, &others, &mass[*last]) else {
        return rows.iter().map(|s| (*s, None)).collect();
    };
    let negative = coefficients.into_iter().map(|c| bench.graph.neg(c)).collect::<Vec<_>>();
    let one = bench.graph.one();
    support.iter().copied().chain([*last]).zip(negative.into_iter().chain([one]).map(Some)).collect()
}

/// The equations in several forms, the one to show first: normal forms where they are small, then the projection as it
/// came out, if it is worth a program of its own.
pub(super) fn candidates(
    bench: &mut Workbench,
    system: &Mechanics,
    by_definition: &Equations,
    by_projection: &Equations,
) -> Vec<Equations> {
    /// The estimate above which a further form is not worth the time to optimise it.
    const WORTH: u64 = 1000;
    let l = system.forms.degrees;
    let mut entry = |s: usize, t: usize| {
        // Both routes give the same function.
        let (a, b) = (bench.tidy(by_definition.mass[s][t]), bench.tidy(by_projection.mass[s][t]));
        let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
        if a != b && cost(a) < cost(b) { a } else { b }
    };
    let lower: Vec<Vec<ExprId>> = (0..l).map(|s| (0..=s).map(|t| entry(s, t)).collect()).collect();
    let mass: Vec<Vec<ExprId>> =
        (0..l).map(|s| (0..l).map(|t| lower[s.max(t)][s.min(t)]).collect()).collect();
    let sources = [&by_projection.forces[..l], &by_definition.forces[..l]];
    let mut lists: Vec<Vec<ExprId>> = Vec::new();
    lists.extend(sources.iter().find_map(|forces| normal_forces(bench, system, forces)));
    if lists.is_empty() || weighted_cost(&bench.graph, sources[0]) <= WORTH {
        lists.push(sources[0].to_vec());
    }
    lists.into_iter().map(|forces| Equations { mass: mass.clone(), forces }).collect()
}

/// Every force as a polynomial in the `eta` with coefficients in normal form, where all are small.
pub(super) fn normal_forces(
    bench: &mut Workbench,
    system: &Mechanics,
    forces: &[ExprId],
) -> Option<Vec<ExprId>> {
    let limits = Limits { nodes: 800, steps: 12_000, ..Limits::default() };
    let variables = &system.etas[..system.forms.degrees];
    forces
        .iter()
        .map(|force| {
            let coefficients = normal_coefficients(&mut bench.graph, *force, variables, &limits)?;
            let terms: Vec<ExprId> = coefficients
                .into_iter()
                .map(|(exponents, c)| {
                    let factors: Vec<_> = variables
                        .iter()
                        .zip(exponents)
                        .map(|(eta, e)| (*eta, e as i32))
                        .chain([(c, 1)])
                        .collect();
                    bench.graph.product(&factors)
                })
                .collect();
            Some(bench.graph.sum(terms))
        })
        .collect()
}
