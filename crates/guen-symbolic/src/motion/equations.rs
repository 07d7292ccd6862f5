//! The equations of motion as they are stated: by the definition and by projection, compared; of links that hang on links where
//! that is shorter.

use super::fault::{DerivationError, affordable};
use super::linkage::Tree;
use super::projection::Projected;
use super::proof::Definition;
use super::turned::InOwnAxes;
use super::velocity_forms::VelocityPartials;
use super::{Frame, KineticTerm, Mechanics, linkage, poincare, projection, restriction, turned};
use crate::algebra::ExprId;
use crate::normal::{Limits, normal_coefficients};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// With so many parameters, and so many links that hang on links, equations are not multiplied out.
const MANY: usize = 6;

/// Multiplied out equations up to this estimate are solved as they are.
const LARGE: u64 = 400;

/// Where those of the links are so many times shorter, the others are not solved at all.
const MUCH: u64 = 5;

/// `sum_t M_st eta_t' = f_s`.
#[derive(Clone, Debug)]
pub struct Equations {
    /// `M_st`, a row for each equation, a column for each `eta_t'`.
    pub mass: Vec<Vec<ExprId>>,
    /// `f_s`.
    pub forces: Vec<ExprId>,
}

impl Equations {
    /// All entries: the mass matrix row by row, then the forces.
    pub(super) fn entries(&self) -> Vec<ExprId> {
        self.mass.iter().flatten().chain(&self.forces).copied().collect()
    }

    /// Each equation: a row of the mass matrix, then the force.
    pub(super) fn rows(&self) -> Vec<Vec<ExprId>> {
        let rows = self.mass.iter().zip(&self.forces);
        rows.map(|(row, force)| row.iter().chain([force]).copied().collect()).collect()
    }

    /// The equations with the generalised forces.
    pub(super) fn driven(mut self, bench: &mut Workbench, generalised_forces: &[ExprId]) -> Self {
        for (force, q) in self.forces.iter_mut().zip(generalised_forces) {
            *force = bench.graph.add(*force, *q);
        }
        self
    }

    fn cost(&self, bench: &Workbench) -> u64 {
        weighted_cost(&bench.graph, &self.entries())
    }
}

/// The equations of motion in all forms in which they are looked for, each with the generalised forces and proved.
pub(super) struct Stated {
    /// (2.7).
    pub(super) definition: Definition,
    /// Multiplied out, the form to show first; none where that is too much.
    pub(super) multiplied: Vec<Equations>,
    /// What they were multiplied out from.
    pub(super) projected: Option<Projected>,
    /// Those of links that hang on links.
    pub(super) linked: Option<Equations>,
    /// Whether the latter are so much shorter that no others are solved.
    pub(super) is_linked: bool,
    /// In the axes of the bodies, where constraints on positions ask for them.
    pub(super) in_own_axes: Option<InOwnAxes>,
    /// The rows `s = l+1..n`, of the reactions, without the generalised forces.
    pub(super) constrained: Equations,
}

impl Stated {
    /// The equations to show, for `s = 1..l`.
    pub(super) fn shown(&self) -> &Equations {
        match &self.linked {
            Some(linked) if self.is_linked => linked,
            _ => &self.multiplied[0],
        }
    }

    pub(super) fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        partials: &mut VelocityPartials,
        terms: &[KineticTerm],
        generalised_forces: &[ExprId],
    ) -> Result<Self, DerivationError> {
        affordable(bench)?;
        let tree = linkage::tree(bench, system, frame, partials);
        if let Some(tree) = &tree
            && system.forms.degrees.min(tree.joints()) >= MANY
            && let Some(linked) = linkage::equations(bench, system, frame, partials, tree)
        {
            let definition = Definition::along(bench, system, frame, generalised_forces);
            affordable(bench)?;
            if definition.is(bench, &linked, true)? {
                let linked = linked.driven(bench, generalised_forces);
                return Ok(Self::of_links(bench, system, frame, partials, terms, (definition, linked)));
            }
        }
        Self::multiplied_out(bench, system, frame, partials, terms, generalised_forces, tree)
    }

    /// The equations of a large tree.
    fn of_links(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        partials: &mut VelocityPartials,
        terms: &[KineticTerm],
        (definition, linked): (Definition, Equations),
    ) -> Self {
        let (n, l) = (system.forms.len(), system.forms.degrees);
        let constrained = if l == n {
            Equations { mass: Vec::new(), forces: Vec::new() }
        } else {
            projection::equations(bench, system, frame, partials, terms, l..n).equations
        };
        Stated {
            definition,
            multiplied: Vec::new(),
            projected: None,
            linked: Some(linked),
            is_linked: true,
            in_own_axes: None,
            constrained,
        }
    }

    fn multiplied_out(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        partials: &mut VelocityPartials,
        terms: &[KineticTerm],
        generalised_forces: &[ExprId],
        tree: Option<Tree<'_>>,
    ) -> Result<Self, DerivationError> {
        let (n, l) = (system.forms.len(), system.forms.degrees);
        let by_definition = poincare::equations(bench, system, frame);
        affordable(bench)?;
        let whole = by_definition.cost(bench);
        let definition = Definition::whole(by_definition.clone(), generalised_forces);
        let linked = match tree {
            Some(tree) if whole > LARGE => linkage::equations(bench, system, frame, partials, &tree),
            _ => None,
        };
        let linked = linked.filter(|linked| linked.cost(bench) < whole);
        let is_linked = linked.as_ref().is_some_and(|linked| MUCH * linked.cost(bench) < whole);
        let linked = match linked {
            Some(linked) if definition.is(bench, &linked, true)? => {
                Some(linked.driven(bench, generalised_forces))
            }
            _ => None,
        };
        let is_linked = is_linked && linked.is_some();

        let projected = projection::equations(bench, system, frame, partials, terms, 0..n);
        let mut by_projection = projected.equations.clone();
        let constrained =
            Equations { mass: by_projection.mass.split_off(l), forces: by_projection.forces.split_off(l) };
        definition.is(bench, &by_projection, false)?;
        let mut multiplied = forms(bench, system, &by_definition, &projected.equations);
        // On constraints on positions the axes of the bodies leave less than those of the world.
        let in_own_axes = match system.holonomic.is_empty() || is_linked {
            true => None,
            false => turned::equations(bench, system, frame, &projected.forms),
        };
        if let Some(own) = &in_own_axes
            && own.equations.cost(bench) < multiplied[0].cost(bench)
            && definition.is(bench, &own.equations, true)?
        {
            multiplied.insert(0, own.equations.clone());
        }
        let multiplied = multiplied.into_iter().map(|equations| {
            let equations = equations.driven(bench, generalised_forces);
            restriction::restricted(bench, system, equations)
        });
        let multiplied = multiplied.collect();
        affordable(bench)?;
        let projected = Some(projected);
        Ok(Stated { definition, multiplied, projected, linked, is_linked, in_own_axes, constrained })
    }
}

/// The equations in several forms, the one to show first: normal forms where they are small, then the projection as it
/// came out, if it is worth a program of its own.
pub(super) fn forms(
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
