//! A system that is derived once more, in other parameters or for other base angles, as far as its rates ask for it.

use crate::algebra::{ExprId, Substitution};
use crate::geometry::{Form, Operators};
use crate::motion::coordinates::symmetry::Symmetry;
use crate::motion::definition::projection::{self, Projected};
use crate::motion::definition::{equations, poincare};
use crate::motion::graph::FormShape;
use crate::motion::quasi_velocities::forces;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::thresholds::ALL_FORMS;
use crate::motion::{Frame, KineticTerm, Mechanics, MotionEquations, Solution, decompose};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// A parameter in the place of a declared one.
pub(in crate::motion::formulations) struct Parameter {
    pub(in crate::motion::formulations) symbol: ExprId,
    pub(in crate::motion::formulations) form: Form,
    pub(in crate::motion::formulations) shape: Option<FormShape>,
}

/// A system in other parameters. Magnitudes of forces keep the symbols of the declared parameters.
pub(in crate::motion::formulations) fn in_parameters(
    bench: &mut Workbench,
    declared: &Mechanics,
    parameters: Vec<Parameter>,
) -> Mechanics {
    let l = declared.forms.degrees;
    let mut system = declared.clone();
    let forms = declared.etas.iter().zip(&declared.forms.forms[..l]);
    let by_velocities = forms.map(|(eta, form)| (*eta, over(bench, form, &declared.velocities)));
    let mut by_velocities = Substitution::new(by_velocities.collect::<Vec<_>>());
    let energies = [&mut system.kinetic_energy]
        .into_iter()
        .chain(system.multibody.iter_mut().map(|bodies| &mut bodies.other_energy));
    let along = system.forces.iter_mut().map(|force| &mut force.along);
    let structure = &mut system.structure;
    let shapes = structure.forms.iter_mut().chain(&mut structure.loads).flatten();
    let rests = shapes.chain(structure.scalars.values_mut()).map(|shape| &mut shape.rest);
    for e in energies.chain(along).chain(rests).chain(&mut system.written[l..]) {
        *e = by_velocities.of(&mut bench.graph, *e);
    }
    system.structure.forms.resize(declared.forms.len(), None);
    system.structure.vectors.retain(|vector| vector.iter().flatten().all(|form| *form >= l));
    for (k, Parameter { symbol, form, shape }) in parameters.into_iter().enumerate() {
        system.etas[k] = symbol;
        system.written[k] = over(bench, &form, &declared.velocities);
        system.forms.forms[k] = form;
        system.structure.forms[k] = shape;
    }
    system
}

/// A form over velocities.
pub(super) fn over(bench: &mut Workbench, form: &Form, velocities: &[ExprId]) -> ExprId {
    let linear = bench.dot(&form.row, velocities);
    bench.graph.add(linear, form.offset)
}

/// A system with what every way to its equations begins with: operators, terms of the energy, generalised forces.
pub(super) struct Prepared {
    pub(super) system: Mechanics,
    pub(super) frame: Frame,
    pub(super) partials: VelocityPartials,
    pub(super) terms: Vec<KineticTerm>,
    pub(super) forces: Vec<ExprId>,
}

impl Prepared {
    pub(super) fn new(bench: &mut Workbench, system: Mechanics, operators: Operators) -> Option<Self> {
        let mut frame = Frame::new(bench, &system, operators);
        let mut partials = VelocityPartials::of_system(bench, &system);
        let symbols: Vec<ExprId> = system.velocities.iter().chain(&system.etas).copied().collect();
        let terms = decompose(bench, &mut partials, &symbols, system.kinetic_energy).ok()?;
        let forces = forces::generalised_forces(bench, &system, &mut frame, &mut partials);
        Some(Prepared { system, frame, partials, terms, forces })
    }
}

/// A system derived once more.
pub(super) struct Restated {
    pub(super) system: Mechanics,
    pub(super) frame: Frame,
    pub(super) forces: Vec<ExprId>,
    pub(super) projected: Projected,
}

impl Restated {
    pub(super) fn new(bench: &mut Workbench, system: Mechanics, operators: Operators) -> Option<Self> {
        let prepared = Prepared::new(bench, system, operators)?;
        let Prepared { system, mut frame, mut partials, terms, forces } = prepared;
        let l = system.forms.degrees;
        let projected = projection::equations(bench, &system, &mut frame, &mut partials, &terms, 0..l);
        Some(Restated { system, frame, forces, projected })
    }

    /// The rates of the state by the equations in several forms, without what these do not depend on.
    pub(super) fn rates(&mut self, bench: &mut Workbench, symmetry: &mut Symmetry) -> Vec<Vec<ExprId>> {
        let l = self.system.forms.degrees;
        let list = flattened(&self.projected.equations, l);
        let definition = (weighted_cost(&bench.graph, &list) <= ALL_FORMS)
            .then(|| flattened(&poincare::equations(bench, &self.system, &mut self.frame), l));
        let reduced = unflattened(symmetry.reduced(bench, &list), l);
        let definition = definition.map(|list| unflattened(symmetry.reduced(bench, &list), l));
        let velocities = symmetry.reduced_each(bench, &self.frame.velocities);
        let found = forms(bench, &self.system, definition.as_ref().unwrap_or(&reduced), &reduced);
        solutions(bench, found, &self.forces, &velocities)
    }
}

/// The equations in several forms, as of [`equations::forms`]; multiplied out alone, where that leaves little: velocities that
/// are kept whole because they are long with a heading may be short without it, and their squares may meet.
pub(super) fn forms(
    bench: &mut Workbench,
    system: &Mechanics,
    definition: &MotionEquations,
    reduced: &MotionEquations,
) -> Vec<MotionEquations> {
    let mut found = equations::forms(bench, system, definition, reduced);
    let entries = reduced.entries();
    if weighted_cost(&bench.graph, &entries) > ALL_FORMS {
        return found;
    }
    let opened = bench.graph.opened(&entries);
    if opened == entries {
        return found;
    }
    let MotionEquations { mut mass, forces } = unflattened(opened, system.forms.degrees);
    let Some(forces) = equations::normal_forces(bench, system, &forces) else { return found };
    for (entry, known) in mass.iter_mut().flatten().zip(found[0].mass.iter().flatten()) {
        let tidy = bench.tidy(*entry);
        let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
        *entry = if cost(tidy) < cost(*known) { tidy } else { *known };
    }
    let open = MotionEquations { mass, forces };
    if weighted_cost(&bench.graph, &open.entries()) < weighted_cost(&bench.graph, &found[0].entries()) {
        found = vec![open];
    }
    found
}

/// A list of `l^2` entries of the mass matrix and `l` forces.
pub(super) fn unflattened(mut list: Vec<ExprId>, l: usize) -> MotionEquations {
    let forces = list.split_off(l * l);
    MotionEquations { mass: list.chunks(l).map(<[ExprId]>::to_vec).collect(), forces }
}

/// The rates of the state by each of some equations.
pub(super) fn solutions(
    bench: &mut Workbench,
    candidates: Vec<MotionEquations>,
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

/// The first `l` rows of the mass matrix, then as many forces.
pub(super) fn flattened(equations: &MotionEquations, l: usize) -> Vec<ExprId> {
    equations.mass[..l].iter().flatten().chain(&equations.forces[..l]).copied().collect()
}
