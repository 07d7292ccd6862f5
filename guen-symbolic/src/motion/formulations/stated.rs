//! The equations of motion as they are stated: by the definition and by projection, compared; of bodies, as they were put up at
//! the root of their tree, where that is much shorter.

use super::body_axes::{self, InBodyAxes};
use super::large::{self, Alone};
use super::multibody;
use super::other_parameters::base_parameters::{Change, InBaseParameters};
use super::other_parameters::spins;
use crate::algebra::ExprId;
use crate::geometry::MANY_COORDINATES;
use crate::motion::coordinates::parts::joints_of_one_part;
use crate::motion::coordinates::restriction;
use crate::motion::definition::equations::forms;
use crate::motion::definition::projection::{self, Projected};
use crate::motion::definition::proof::Definition;
use crate::motion::fault::{DerivationError, affordable};
use crate::motion::graph::Turn;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::thresholds::{
    ALL_WAYS, COUPLED_COORDINATES, MASS_PRODUCTS, MULTIPLIED_PARAMETERS, MULTIPLIED_VELOCITIES, OTHER_WAYS,
};
use crate::motion::{Frame, KineticTerm, Mechanics, MotionEquations};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The name of the formulation that goes through the bodies.
pub(super) const BODIES: &str = "bodies";

/// The equations of motion in all forms in which they are looked for, each with the generalised forces and proved.
pub(in crate::motion) struct Stated {
    /// (2.7).
    pub(super) definition: Definition,
    /// Multiplied out, the form to show first; none where that is too much.
    pub(super) multiplied: Vec<MotionEquations>,
    /// The projection that they were multiplied out from.
    pub(super) projected: Option<Projected>,
    /// The equations of bodies, where no others are multiplied out.
    pub(super) of_bodies: Option<MotionEquations>,
    /// The rates by bodies, once they were looked for; proved where their equations are stated.
    pub(super) bodies: Option<Option<multibody::Found>>,
    /// The equations with the constraints as parameters that stay zero, as of [`multibody::freed`], where they were looked for and proved.
    pub(in crate::motion) freed: Option<MotionEquations>,
    /// The system in the rates of its base angles, where the equations come from there.
    pub(super) in_base: Option<InBaseParameters>,
    /// The equations in the axes of the bodies, where constraints on positions ask for them.
    pub(super) in_body_axes: Option<InBodyAxes>,
    /// The rows `s = l+1..n`, of the reactions, with the generalised forces.
    pub(in crate::motion) constrained: MotionEquations,
    /// The rates of a large system, whose equations are not written out.
    pub(super) alone: Option<Alone>,
}

impl Stated {
    /// The equations to show, for `s = 1..l`.
    pub(super) fn shown(&self) -> &MotionEquations {
        match &self.of_bodies {
            Some(equations) => equations,
            None => &self.multiplied[0],
        }
    }

    pub(in crate::motion) fn new(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        partials: &mut VelocityPartials,
        (terms, generalised_forces): (&[KineticTerm], &[ExprId]),
        without_equations: bool,
    ) -> Result<Self, DerivationError> {
        affordable(bench)?;
        // Particles have a way of their own, and are looked at as bodies after it.
        let turns = system.structure.frames().len() > 1;
        if without_equations || large::is_large(bench, system, terms) {
            let mut definition = Definition::new(bench, system, generalised_forces);
            let of = (system, &mut *frame);
            // In relative angles a form has all joints before it.
            let others = if turns { None } else { Change::new(bench, system, of.1) };
            let found = match others {
                Some(change) => change.large_rates(bench, of, (&mut definition, generalised_forces))?,
                None => {
                    let given = (terms, generalised_forces);
                    large::rates(bench, of, partials, given, &mut definition, without_equations)?
                }
            };
            if let Some(alone) = found {
                return Ok(Stated {
                    definition,
                    multiplied: Vec::new(),
                    projected: None,
                    of_bodies: None,
                    bodies: None,
                    freed: None,
                    in_base: None,
                    in_body_axes: None,
                    constrained: MotionEquations { mass: Vec::new(), forces: Vec::new() },
                    alone: Some(alone),
                });
            }
            if system.forms.len() > COUPLED_COORDINATES {
                return Err(DerivationError::TooManyCoordinates);
            }
        }
        let velocities = weighted_cost(&bench.graph, &frame.velocities);
        let is_large = is_large(bench, system) || velocities > MULTIPLIED_VELOCITIES;
        let mut bodies = ((is_large || turns) && !bench.leaves_out(BODIES)).then(|| {
            let least = if is_large { 0 } else { least(bench, system, frame) };
            let is_stated = |cost: u64| is_large || promises_least(cost, least);
            multibody::rates(bench, system, frame, partials, is_large, is_stated)
        });
        let found = bodies.as_mut().and_then(Option::as_mut);
        let of_bodies = found.and_then(|found| Some((found.equations.take()?, found.rates.clone())));
        let of_bodies = of_bodies.filter(|(_, rates)| {
            is_large
                || weighted_cost(&bench.graph, rates) > OTHER_WAYS
                || !spins::are_others(bench, system, partials)
        });
        let mut definition = Definition::new(bench, system, generalised_forces);
        if let Some((equations, rates)) = of_bodies
            && let own = equations.undriven(bench, generalised_forces)
            && definition.is(bench, (system, frame), &own, true)?
            && definition.is_solved_by(bench, (system, frame), &rates)?
        {
            let freed = match system.forms.len() > system.forms.degrees {
                true => multibody::freed(bench, system, frame, partials, generalised_forces),
                false => None,
            };
            let freed = freed.filter(|freed| definition.has(bench, system, freed, generalised_forces));
            let constrained = match &freed {
                Some(freed) => freed.clone().split_off(system.forms.degrees),
                None => {
                    let rows = constrained(bench, system, frame, partials, terms);
                    definition.is(bench, (system, frame), &own.and(&rows), true)?;
                    rows.driven(bench, &generalised_forces[system.forms.degrees..])
                }
            };
            return Ok(Stated {
                definition,
                multiplied: Vec::new(),
                projected: None,
                of_bodies: Some(equations),
                bodies,
                freed,
                in_base: None,
                in_body_axes: None,
                constrained,
                alone: None,
            });
        }
        let l = system.forms.degrees;
        if terms.len() * l * l > MASS_PRODUCTS
            && let Some(in_base) = InBaseParameters::new(bench, system, frame)
        {
            let equations = in_base.equations(bench, system);
            affordable(bench)?;
            if definition.is(bench, (system, frame), &equations, true)? {
                let constrained = constrained(bench, system, frame, partials, terms);
                if !constrained.mass.is_empty() {
                    definition.is(bench, (system, frame), &equations.and(&constrained), true)?;
                }
                let constrained = constrained.driven(bench, &generalised_forces[l..]);
                let equations = equations.driven(bench, generalised_forces);
                return Ok(Stated {
                    definition,
                    multiplied: vec![equations],
                    projected: None,
                    of_bodies: None,
                    bodies,
                    freed: None,
                    in_base: Some(in_base),
                    in_body_axes: None,
                    constrained,
                    alone: None,
                });
            }
        }
        let stated =
            Self::multiplied_out(bench, system, frame, partials, terms, (definition, generalised_forces))?;
        Ok(Stated { bodies, ..stated })
    }

    fn multiplied_out(
        bench: &mut Workbench,
        system: &Mechanics,
        frame: &mut Frame,
        partials: &mut VelocityPartials,
        terms: &[KineticTerm],
        (mut definition, generalised_forces): (Definition, &[ExprId]),
    ) -> Result<Self, DerivationError> {
        let (n, l) = (system.forms.len(), system.forms.degrees);
        // Many equations are multiplied out by one route, and proved at points alone.
        let by_definition = match l > MANY_COORDINATES {
            true => None,
            false => Some(definition.written(bench, system, frame).clone()),
        };
        affordable(bench)?;
        if let Some(by_definition) = &by_definition {
            definition.is(bench, (system, frame), by_definition, false)?;
        }
        let projected = projection::equations(bench, system, frame, partials, terms, 0..n);
        let mut by_projection = projected.equations.clone();
        let constrained = by_projection.split_off(l).driven(bench, &generalised_forces[l..]);
        definition.is(bench, (system, frame), &projected.equations, false)?;
        let own = by_definition.as_ref().unwrap_or(&projected.equations);
        let mut multiplied = forms(bench, system, own, &projected.equations);
        // On constraints on positions the axes of the bodies leave less than those of the world.
        let in_body_axes = match system.holonomic.is_empty() {
            true => None,
            false => body_axes::equations(bench, system, frame, &projected.forms),
        };
        if let Some(own) = &in_body_axes
            && own.equations.cost(bench) < multiplied[0].cost(bench)
            && definition.is(bench, (system, frame), &own.equations, true)?
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
        Ok(Stated {
            definition,
            multiplied,
            projected,
            of_bodies: None,
            bodies: None,
            freed: None,
            in_base: None,
            in_body_axes,
            constrained,
            alone: None,
        })
    }
}

/// The rows of the reactions alone.
fn constrained(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
) -> MotionEquations {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    if l == n {
        return MotionEquations { mass: Vec::new(), forces: Vec::new() };
    }
    projection::equations(bench, system, frame, partials, terms, l..n).equations
}

/// The estimate of the velocities and the energy, which equations that are multiplied out have in them beside their derivatives.
fn least(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame) -> u64 {
    let energy = frame.constrain.of(&mut bench.graph, system.kinetic_energy);
    weighted_cost(&bench.graph, &[&frame.velocities[..], &[energy]].concat())
}

/// Whether rates of this cost take less than what equations that are multiplied out have in them, of which the least is known. Of large
/// systems the derivatives take several times the energy.
fn promises_least(cost: u64, least: u64) -> bool {
    cost > ALL_WAYS && cost <= least || cost > OTHER_WAYS && 2 * cost <= 3 * least
}

/// Whether many frames of one part turn, about several axes: multiplied out, each brings a factor.
fn is_large(bench: &Workbench, system: &Mechanics) -> bool {
    let frames: Vec<_> = system.structure.frames().iter().skip(1).collect();
    let mut axes: Vec<_> = frames
        .iter()
        .map(|frame| match &frame.turn {
            Turn::About { axis, .. } => Some(*axis),
            Turn::General { .. } => None,
        })
        .collect();
    axes.dedup();
    (axes.len() > 1 || axes.contains(&None))
        && system.forms.degrees.min(frames.len()) >= MULTIPLIED_PARAMETERS
        && joints_of_one_part(bench, system) >= MULTIPLIED_PARAMETERS
}
