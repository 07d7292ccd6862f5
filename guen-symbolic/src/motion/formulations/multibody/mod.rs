//! Accelerations of bodies that hang on each other and roll: kinematics outwards, elimination inwards, over velocities that are
//! named where they are.
//!
//! 1. `places`: axes, origins, and the tree of both with the bodies in it.
//! 2. `velocities`: which of them vanish or are one; the declared forms and loads over them.
//! 3. `planning`: what determines what; the core, solved for what is left.
//! 4. `outwards`: kinematics from the root to the leaves, velocities and then accelerations.
//! 5. `inwards`: the quadratic form and the forces, from the leaves back to the parameters.
//!
//! `print` writes the plan and the form in lines.

mod inwards;
pub(in crate::motion) mod measured;
mod outwards;
mod places;
mod planning;
mod print;
mod velocities;

pub use self::print::elimination_text;

use self::inwards::assembly::{self, Assembly, Root};
use self::inwards::{beside, inertial_forces, potentials};
use self::outwards::kinematics::Kinematics;
use self::places::tree::Tree;
use self::planning::core::Core;
use self::planning::independent;
use self::planning::plan::Planner;
use self::velocities::declared::{self, Declared};
use self::velocities::strain::{self, Strain};
use self::velocities::variables::Variables;
use crate::algebra::{ExprId, FastMap};
use crate::geometry::Operators;
use crate::motion::graph::Turn;
use crate::motion::quasi_velocities::velocity_forms::VelocityPartials;
use crate::motion::thresholds::{OTHER_WAYS, WORK_BEFORE_INDEPENDENT};
use crate::motion::{Frame, Mechanics, MotionEquations};
use crate::numbering::{Num, Numbering};
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// Points of the zero test that are tried: not everywhere does every root exist.
const POINTS: usize = 8;
/// Points with drawn roots that are tried.
const DRAWN_POINTS: usize = 2;

/// The result of deriving a tree of bodies.
#[derive(Clone)]
pub(super) struct Found {
    /// The rates of the state, velocities first.
    pub(super) rates: Vec<ExprId>,
    /// The pivots of the elimination.
    pub(super) pivots: Vec<ExprId>,
    /// The equations that were solved, generalised forces included; only where they were asked for.
    pub(super) equations: Option<MotionEquations>,
}

/// The rates of the state of a system of bodies; none where its energies or forms are beyond what is understood here. `is_alone` says
/// that nothing else is derived, `is_stated` for which estimate of the rates the equations are asked for.
pub(super) fn rates(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    partials: &mut VelocityPartials,
    is_alone: bool,
    is_stated: impl Fn(u64) -> bool,
) -> Option<Found> {
    let structure = &system.structure;
    if structure.bodies.is_empty() || !is_understood(bench, system) {
        return None;
    }
    // A rotation that is one on its constraint alone.
    let on_manifold = has_general_turns(system) && !system.holonomic.is_empty();
    // What rolls and is posed by a quaternion has no axes here in which its contact rests: entries that are small where others
    // are not would be differences of these. Where nothing else is derived that has to do.
    let rolls = system.holonomic.len() < system.forms.len() - system.forms.degrees;
    if on_manifold && rolls && !is_alone {
        return None;
    }
    let forced = potentials::as_forces(bench, system, frame);
    let mut best: Option<Found> = None;
    let has_others = forced.forces.len() > system.forces.len();
    for (system, is_tried) in [(&forced, true), (system, has_others)] {
        let cost = |bench: &Workbench, found: &Found| weighted_cost(&bench.graph, &found.rates);
        // In a few coordinates derivatives of a potential may be shorter than the places.
        let is_long = best.as_ref().is_some_and(|found| cost(bench, found) > OTHER_WAYS);
        if is_long || !is_tried {
            break;
        }
        let mut by = |bench: &mut Workbench, inertial| {
            points(bench, system, on_manifold).into_iter().find_map(|point| {
                let posed = Posed { system, inertial, declared: None };
                attempt(bench, posed, frame, partials, point, &is_stated)
            })
        };
        let by_bodies = by(bench, InertialForces::OfBodies);
        let by_mass = match by_bodies {
            Some(_) if inertial_forces::are_derivatives(bench, system, frame) => {
                by(bench, InertialForces::OfTheMass)
            }
            _ => None,
        };
        // Among equals the first.
        best = best.into_iter().chain(by_bodies).chain(by_mass).min_by_key(|found| cost(bench, found));
    }
    by_independent_velocities(bench, &forced, partials, on_manifold, best)
}

/// The rates by independent velocities where these are cheaper than those found; the equations are those of the declared parameters.
fn by_independent_velocities(
    bench: &mut Workbench,
    declared: &Mechanics,
    partials: &mut VelocityPartials,
    on_manifold: bool,
    best: Option<Found>,
) -> Option<Found> {
    let cost = best.as_ref().map_or(u64::MAX, |found| weighted_cost(&bench.graph, &found.rates));
    if cost <= OTHER_WAYS || bench.share_of_work() > WORK_BEFORE_INDEPENDENT {
        return best;
    }
    let Some(system) = independent::restated(bench, declared, partials, on_manifold) else { return best };
    let Ok(operators) = Operators::new(bench, &system.forms) else { return best };
    let frame = Frame::new(bench, &system, operators);
    let mut partials = VelocityPartials::of_system(bench, &system);
    let posed = Posed { system: &system, inertial: InertialForces::OfBodies, declared: Some(declared) };
    let found = points(bench, &system, on_manifold)
        .into_iter()
        .find_map(|point| attempt(bench, posed, &frame, &mut partials, point, |_| false));
    match found {
        Some(found) if weighted_cost(&bench.graph, &found.rates) < cost => {
            let equations = best.and_then(|best| best.equations);
            Some(Found { equations, ..found })
        }
        _ => best,
    }
}

/// A system with the way in which its equations are put up.
#[derive(Clone, Copy)]
struct Posed<'a> {
    system: &'a Mechanics,
    inertial: InertialForces,
    /// The system in its declared parameters, where these are others.
    declared: Option<&'a Mechanics>,
}

/// A point of the zero test at which expressions are numbered.
#[derive(Clone, Copy)]
struct At {
    number: usize,
    on_manifold: bool,
    has_drawn_roots: bool,
}

impl At {
    fn numbering(self, bench: &mut Workbench) -> Numbering {
        let generation = bench.zero.generation();
        let own = Numbering::new(&mut bench.graph, (self.number, self.on_manifold), generation);
        if self.has_drawn_roots { own.with_drawn_roots(bench) } else { own }
    }
}

/// The points that are tried; of systems with roots at last those at which roots are drawn: of the others hardly one has many roots.
fn points(bench: &mut Workbench, system: &Mechanics, on_manifold: bool) -> Vec<At> {
    let lengths = system.structure.lengths.iter().map(|(length, _)| *length);
    let has_roots =
        lengths.chain(system.expressions()).any(|e| bench.zero.has_signs_or_roots(&bench.graph, e));
    let at = |number, has_drawn_roots| At { number, on_manifold, has_drawn_roots };
    let drawn = if has_roots { DRAWN_POINTS } else { 0 };
    (0..POINTS).map(|number| at(number, false)).chain((0..drawn).map(|number| at(number, true))).collect()
}

/// The inertial forces in the equations.
#[derive(Clone, Copy, PartialEq, Eq)]
enum InertialForces {
    /// The inertial forces of the bodies.
    OfBodies,
    /// Derivatives of the mass matrix.
    OfTheMass,
}

fn has_general_turns(system: &Mechanics) -> bool {
    system.structure.frames().iter().any(|frame| matches!(frame.turn, Turn::General { .. }))
}

/// Whether masses, inertias and gravity are constants.
fn is_understood(bench: &Workbench, system: &Mechanics) -> bool {
    let structure = &system.structure;
    let weights = structure.bodies.iter().flat_map(|body| body.inertia.iter().chain([&body.mass]));
    let mut weights = weights.chain(structure.gravity.iter().flatten());
    weights.all(|e| bench.graph.roles(*e).is_constant())
}

/// Whether constraints on positions are no integrals of some velocities off the constraints: then these are of no use. It is enough that
/// some are integrals everywhere, and the others wherever these hold: what keeps quaternions at length one keeps hinges.
fn drifts(bench: &mut Workbench, system: &Mechanics, velocities: &[ExprId]) -> bool {
    let mut drift = Vec::new();
    for holonomic in &system.holonomic {
        let form = &system.forms.forms[holonomic.form];
        let rate = bench.dot(&form.row, velocities);
        drift.push(bench.graph.add(rate, form.offset));
    }
    let Some(residues) = bench.zero.residues(&mut bench.graph, 0, &drift, false) else { return true };
    let is_kept = |place: &usize| residues[*place] == 0;
    let (kept, others): (Vec<usize>, Vec<usize>) = (0..drift.len()).partition(is_kept);
    let others: Vec<ExprId> = others.into_iter().map(|place| drift[place]).collect();
    let kept: Vec<ExprId> = kept.into_iter().map(|place| system.holonomic[place].equation).collect();
    !others.is_empty() && !bench.zero.vanish_where(&mut bench.graph, &kept, &others)
}

/// The equations of a system of bodies whose constraints are parameters that stay zero: a row for each form, a column for each parameter
/// of the system, generalised forces included. None where `rates` has none.
pub(in crate::motion) fn freed(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    partials: &mut VelocityPartials,
    generalised_forces: &[ExprId],
) -> Option<MotionEquations> {
    if system.structure.bodies.is_empty() || !is_understood(bench, system) {
        return None;
    }
    let (n, l) = (system.forms.len(), system.forms.degrees);
    let on_manifold = has_general_turns(system) && !system.holonomic.is_empty();
    let mut free = potentials::as_forces(bench, system, frame);
    free.forms.degrees = n;
    free.holonomic.clear();
    let tried = points(bench, &free, on_manifold);
    let mut attempt = |free: &Mechanics, point: At| {
        let mut own = point.numbering(bench);
        let (mass, forces) = assembled(
            bench,
            &mut own,
            (Posed { system: free, inertial: InertialForces::OfBodies, declared: None }, l),
            frame,
            partials,
            |assembly, _| assembly.at_the_root(),
        )?;
        if !own.is_sound() {
            return None;
        }
        let rows = mass.into_iter().map(|row| row[..l].to_vec());
        let entries: Vec<Num> = rows.flatten().chain(forces).collect();
        let mut entries = own.export(&mut bench.graph, &entries);
        let forces = entries.split_off(n * l);
        Some(MotionEquations { mass: (0..n).map(|j| entries[j * l..][..l].to_vec()).collect(), forces })
    };
    if let Some(found) = tried.iter().find_map(|point| attempt(&free, *point)) {
        return Some(found);
    }
    if free.forces.is_empty() {
        return None;
    }
    // Along a velocity that does not follow here forces are as the operators have them.
    free.forces.clear();
    free.structure.loads.clear();
    let found = tried.iter().find_map(|point| attempt(&free, *point))?;
    Some(found.driven(bench, generalised_forces))
}

/// Puts up the equations of the bodies of a system, of whose parameters those from some place on are zero, and hands them on with the
/// velocities.
fn assembled<T>(
    bench: &mut Workbench,
    numbers: &mut Numbering,
    (posed, moving): (Posed<'_>, usize),
    frame: &Frame,
    partials: &mut VelocityPartials,
    then: impl FnOnce(&mut Assembly<'_>, Vec<Num>) -> Option<T>,
) -> Option<T> {
    let Posed { system, inertial, declared: in_declared } = posed;
    for eta in &system.etas[moving..] {
        numbers.define(*eta, Num::ZERO);
    }
    let mut tree = Tree::new(bench, numbers, system, partials)?;
    let strains = Strain::all(bench, numbers, (system, frame), &tree, moving..system.forms.degrees)?;
    let shapes = declared::shapes(bench, numbers, system, (&mut tree, &strains), in_declared)?;
    if !numbers.is_sound() {
        return None;
    }
    let variables = Variables::new(bench, numbers, system, &tree)?;
    let declared = Declared::new(bench, numbers, system, partials, (&tree, &variables), &shapes)?;
    tree.regroup(numbers, &variables);
    let loads = declared.loads.iter().flat_map(|load| load.terms.iter().map(|(var, _)| *var));
    let beside = beside::rows(bench, system, partials)?;
    let moved = beside.iter().flat_map(|row| row.inertia.iter().map(|(j, _)| *j).chain([row.coordinate]));
    let needed = assembly::needed(&tree, &variables).into_iter();
    let mut needed: Vec<_> = needed.chain(loads).chain(moved.map(|i| variables.rate(i))).collect();
    needed.extend(strain::needed(&tree, &variables, &strains));
    let mut planner = Planner {
        bench,
        numbers,
        tree: &tree,
        variables: &variables,
        forms: &system.forms.forms,
        known: FastMap::default(),
    };
    let plan = planner.plan(declared.rows, &declared.groups, &needed)?;
    let core = Core::new(&mut planner, &plan)?;
    if let Some(in_declared) = in_declared {
        let mut given = Vec::new();
        for (form, eta) in declared.parameters.iter().zip(&in_declared.etas) {
            given.push((form.clone(), planner.numbers.import(planner.bench, *eta)));
        }
        planner.forms = &in_declared.forms.forms;
        let values = core.parameters(&mut planner, &plan, &given)?;
        for (symbol, value) in system.etas.iter().zip(values) {
            planner.numbers.define(*symbol, value);
        }
    }

    let mut kinematics = Kinematics::new(bench, numbers, system, frame, (&tree, &variables), (&plan, &core));
    let velocities: Vec<Num> = (0..system.forms.len()).map(|i| kinematics.value(variables.rate(i))).collect();
    // Forces may be written in velocities and in the names of constraints.
    for (symbol, value) in system.velocities.iter().zip(&velocities) {
        kinematics.numbers.define(*symbol, *value);
    }
    if inertial == InertialForces::OfTheMass {
        // The rows of other energies and of strained frames contain their inertial forces: with the derivatives they would count twice.
        if !strains.is_empty() || beside.iter().any(|row| !row.inertia.is_empty()) {
            return None;
        }
        kinematics.rest();
    }
    let mut assembly = Assembly::new(kinematics);
    assembly.declared.clone_from(&declared.parameters);
    assembly.bodies();
    assembly.loads(&declared.loads);
    assembly.beside(&beside);
    for strain in &strains {
        assembly.strained(partials, strain)?;
    }
    then(&mut assembly, velocities)
}

fn attempt(
    bench: &mut Workbench,
    posed: Posed<'_>,
    frame: &Frame,
    partials: &mut VelocityPartials,
    point: At,
    is_stated: impl Fn(u64) -> bool,
) -> Option<Found> {
    let system = posed.system;
    let (n, l) = (system.forms.len(), system.forms.degrees);
    let mut own = point.numbering(bench);
    let solved = assembled(bench, &mut own, (posed, l), frame, partials, |assembly, velocities| {
        let (accelerations, pivots, root) = assembly.solve()?;
        Some((velocities, accelerations, pivots, root))
    });
    let (velocities, accelerations, pivots, root) = solved?;
    if !own.is_sound() {
        return None;
    }
    let outputs: Vec<Num> = velocities.into_iter().chain(accelerations).chain(pivots).collect();
    let mut rates = own.export(&mut bench.graph, &outputs);
    let pivots = rates.split_off(n + l);
    let cost = weighted_cost(&bench.graph, &rates);
    let equations = root.filter(|_| is_stated(cost)).map(|Root { table, mass, forces }| {
        let entries: Vec<Num> = mass.into_iter().flatten().chain(forces).collect();
        let mut entries = table.export(&mut bench.graph, &entries);
        let forces = entries.split_off(l * l);
        MotionEquations { mass: (0..l).map(|s| entries[s * l..][..l].to_vec()).collect(), forces }
    });
    if point.on_manifold && drifts(bench, system, &rates[..n]) {
        if posed.declared.is_some() {
            return None;
        }
        rates[..n].copy_from_slice(&frame.velocities);
    }
    Some(Found { rates, pivots, equations })
}
