//! Equations of motion as a mass matrix and forces.

use crate::algebra::ExprId;
use crate::motion::Mechanics;
use crate::motion::thresholds::FURTHER_FORMS;
use crate::normal::{Limits, normal_coefficients};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// `sum_t M_st eta_t' = f_s`.
#[derive(Clone, Debug)]
pub struct MotionEquations {
    /// `M_st`, a row for each equation, a column for each `eta_t'`.
    pub mass: Vec<Vec<ExprId>>,
    /// `f_s`.
    pub forces: Vec<ExprId>,
}

impl MotionEquations {
    /// Returns all entries: the mass matrix row by row, then the forces.
    pub(in crate::motion) fn entries(&self) -> Vec<ExprId> {
        self.mass.iter().flatten().chain(&self.forces).copied().collect()
    }

    /// Each equation: a row of the mass matrix, then the force.
    pub(super) fn rows(&self) -> Vec<Vec<ExprId>> {
        let rows = self.mass.iter().zip(&self.forces);
        rows.map(|(row, force)| row.iter().chain([force]).copied().collect()).collect()
    }

    /// Cuts off the rows from some place on.
    pub(in crate::motion) fn split_off(&mut self, place: usize) -> Self {
        MotionEquations { mass: self.mass.split_off(place), forces: self.forces.split_off(place) }
    }

    /// Appends other equations.
    pub(in crate::motion) fn and(&self, others: &MotionEquations) -> Self {
        let mass = [&self.mass[..], &others.mass].concat();
        MotionEquations { mass, forces: [&self.forces[..], &others.forces].concat() }
    }

    /// The equations with the generalised forces.
    pub(in crate::motion) fn driven(mut self, bench: &mut Workbench, generalised_forces: &[ExprId]) -> Self {
        for (force, q) in self.forces.iter_mut().zip(generalised_forces) {
            *force = bench.graph.add(*force, *q);
        }
        self
    }

    /// The equations without the generalised forces.
    pub(in crate::motion) fn undriven(&self, bench: &mut Workbench, generalised_forces: &[ExprId]) -> Self {
        let forces = self.forces.iter().zip(generalised_forces);
        let forces = forces.map(|(force, q)| bench.graph.sub(*force, *q)).collect();
        MotionEquations { mass: self.mass.clone(), forces }
    }

    pub(in crate::motion) fn cost(&self, bench: &Workbench) -> u64 {
        weighted_cost(&bench.graph, &self.entries())
    }
}

/// The equations in several forms, the one to show first: normal forms where they are small, then the projection as it
/// came out, if it is worth a program of its own.
pub(in crate::motion) fn forms(
    bench: &mut Workbench,
    system: &Mechanics,
    by_definition: &MotionEquations,
    by_projection: &MotionEquations,
) -> Vec<MotionEquations> {
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
    let own = weighted_cost(&bench.graph, sources[0]);
    if lists.iter().all(|list| own <= FURTHER_FORMS.max(weighted_cost(&bench.graph, list))) {
        lists.push(sources[0].to_vec());
    }
    lists.into_iter().map(|forces| MotionEquations { mass: mass.clone(), forces }).collect()
}

/// Every force as a polynomial in the `eta` with coefficients in normal form, where all are small.
pub(in crate::motion) fn normal_forces(
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
