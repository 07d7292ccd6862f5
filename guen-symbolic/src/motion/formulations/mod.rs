//! The formulations, ways to the rates of the state: one list, walked once.
//!
//! Each formulation gives rates of the state, perhaps several, or says why it has none; none knows of another. What it gives is
//! proved against (2.7), and which costs least is found when code is made. Where one promises half of what the equations as they
//! are stated cost, the others are not looked at.
//!
//! `stated` is what the others start from and are compared with: the equations as they were declared.

mod body_axes;
mod constraint_forces;
pub(super) mod large;
pub(super) mod multibody;
mod other_parameters;
mod recursive;
pub(super) mod stated;

use self::large::Alone;
use self::other_parameters::base_parameters::InBaseParameters;
use self::other_parameters::{headings, spins};
use self::stated::{BODIES, Stated};
use super::coordinates::symmetry::Symmetry;
use super::fault::{DerivationError, affordable};
use super::mass_matrix::weightless::solved;
use super::quasi_velocities::velocity_forms::VelocityPartials;
use super::thresholds::OTHER_WAYS;
use super::{Frame, KineticTerm, Mechanics, MotionEquations, Solution};
use crate::algebra::ExprId;
use crate::geometry::MANY_COORDINATES;
use crate::program::weighted_cost;
use crate::workbench::Workbench;

/// The reason of a formulation that is not to be tried.
const LEFT_OUT: &str = "it is left out";

/// A way to the rates of the state.
struct Formulation {
    /// The name of the formulation, as in [`Formulated::name`].
    name: &'static str,
    /// Whether it goes by spins: see [`Formulated::is_by_spins`].
    is_by_spins: bool,
    find: fn(&mut Workbench, &mut Search<'_>) -> Result<Outcome, DerivationError>,
}

/// The name of the formulation that solves the equations as they are multiplied out.
const MULTIPLIED_OUT: &str = "multiplied out";

/// The names of all formulations, in the order in which they are tried: for [`Workbench::leave_out`].
///
/// ```
/// assert!(guen_symbolic::formulation_names().any(|name| name == "bodies"));
/// ```
pub fn formulation_names() -> impl Iterator<Item = &'static str> {
    FORMULATIONS.iter().map(|formulation| formulation.name)
}

/// All formulations, in the order in which they are tried.
const FORMULATIONS: [Formulation; 10] = [
    Formulation { name: "constraint forces", is_by_spins: false, find: by_constraint_forces },
    Formulation { name: MULTIPLIED_OUT, is_by_spins: false, find: multiplied_out },
    Formulation { name: BODIES, is_by_spins: false, find: of_bodies },
    Formulation { name: "projected", is_by_spins: false, find: projected },
    Formulation { name: "shared", is_by_spins: false, find: shared },
    Formulation { name: "recursive", is_by_spins: false, find: recursive },
    Formulation { name: "body axes", is_by_spins: false, find: in_body_axes },
    Formulation { name: "spins", is_by_spins: true, find: by_spins },
    Formulation { name: "base parameters", is_by_spins: false, find: in_base_parameters },
    Formulation { name: "without headings", is_by_spins: false, find: without_headings },
];

/// The rates of the state by one formulation, proved to be those of (2.7).
#[derive(Clone, Debug)]
pub struct Formulated {
    /// The name of the formulation.
    pub name: &'static str,
    /// The rates, velocities first.
    pub rates: Vec<ExprId>,
    /// Whether they are found by spins of bodies, which know nothing of an edge of the parameters.
    pub is_by_spins: bool,
}

/// The result of asking a formulation for rates.
enum Outcome {
    Found(Vec<Candidate>),
    /// The reason why it has nothing to give.
    Declined(&'static str),
}

/// Rates of the state.
struct Candidate {
    /// Velocities first.
    rates: Vec<ExprId>,
    rank: Rank,
}

/// The rank of a list of rates among the others.
enum Rank {
    /// The equations as they are stated, solved: shown, with what was divided by, unless something is much shorter.
    Base(Solution),
    /// Equations that are proved, solved by elimination.
    Solved,
    /// Rates of a further formulation, yet to be proved.
    Other,
    /// Rates yet to be proved, so much shorter that no other formulation is tried.
    Last(Solution),
    /// The solution of the only equations that are stated, proved with them.
    Only(Solution),
}

impl Outcome {
    fn found(lists: Vec<Vec<ExprId>>, rank: fn() -> Rank) -> Self {
        Outcome::Found(lists.into_iter().map(|rates| Candidate { rates, rank: rank() }).collect())
    }
}

/// The system, its frame and its equations, which all formulations use.
struct Search<'a> {
    system: &'a Mechanics,
    frame: &'a mut Frame,
    partials: &'a mut VelocityPartials,
    terms: &'a [KineticTerm],
    generalised_forces: &'a [ExprId],
    stated: &'a mut Stated,
    /// The system in the rates of its base angles, once it was looked for.
    in_base: Option<InBaseParameters>,
    /// The estimate of the rates by the equations as they are stated, once these are solved.
    least: u64,
    symmetry: Symmetry,
    /// The equations without what they do not depend on.
    shorter: Option<MotionEquations>,
}

/// The reason why a formulation is not taken of which a point shows that it is wrong: tests fail where it is given.
pub const REFUTED: &str = "it is refuted";

/// The result of the walk through all formulations.
pub(super) struct Found {
    /// The equations for `s = 1..l`, generalised forces included.
    pub(super) equations: MotionEquations,
    /// The momenta, where they come with the equations.
    pub(super) momenta: Option<Vec<ExprId>>,
    /// The solved accelerations.
    pub(super) solution: Solution,
    /// All rates that were found, those of the solution first.
    pub(super) formulations: Vec<Formulated>,
    /// The formulations that gave nothing, and why.
    pub(super) declined: Vec<(&'static str, &'static str)>,
    /// The directions along which the equations do not change.
    pub(super) symmetry: Symmetry,
}

/// Walks the list.
pub(super) fn walk(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &mut Frame,
    partials: &mut VelocityPartials,
    terms: &[KineticTerm],
    generalised_forces: &[ExprId],
    stated: &mut Stated,
) -> Result<Found, DerivationError> {
    let (symmetry, shorter) = Default::default();
    if let Some(Alone { name, rates, solution, equations, momenta }) = stated.alone.take() {
        let others = FORMULATIONS.iter().filter(|formulation| formulation.name != name);
        let declined = others.map(|other| (other.name, "the parameters are many"));
        frame.velocities = rates[..frame.velocities.len()].to_vec();
        return Ok(Found {
            equations,
            momenta: Some(momenta),
            solution,
            formulations: vec![Formulated { name, rates, is_by_spins: false }],
            declined: declined.collect(),
            symmetry,
        });
    }
    let mut search = Search {
        system,
        frame,
        partials,
        terms,
        generalised_forces,
        stated,
        in_base: None,
        least: 0,
        symmetry,
        shorter,
    };
    let mut formulations: Vec<Formulated> = Vec::new();
    let mut declined = Vec::new();
    let mut shown: Option<(usize, Solution)> = None;
    'list: for Formulation { name, is_by_spins, find } in FORMULATIONS {
        // The others need the equations solved, whether their rates are taken or not.
        if bench.leaves_out(name) && name != MULTIPLIED_OUT {
            declined.push((name, LEFT_OUT));
            continue;
        }
        let outcome = find(bench, &mut search)?;
        affordable(bench)?;
        let candidates = match outcome {
            Outcome::Found(candidates) => candidates,
            Outcome::Declined(reason) => {
                declined.push((name, reason));
                continue;
            }
        };
        for Candidate { rates, rank } in candidates {
            if matches!(rank, Rank::Other | Rank::Last(_)) {
                let doubt = match search.is_proved(bench, &rates) {
                    Ok(true) => None,
                    Ok(false) => Some("it is not proved"),
                    // A mistake of ours, which the others are not touched by.
                    Err(DerivationError::RoutesDisagree { .. }) => Some(REFUTED),
                    Err(other) => return Err(other),
                };
                if let Some(doubt) = doubt {
                    declined.push((name, doubt));
                    continue;
                }
            }
            let is_last = matches!(rank, Rank::Last(_) | Rank::Only(_));
            if is_last {
                // A program for what promises more would only cost time.
                let least = weighted_cost(&bench.graph, &rates);
                formulations.retain(|other| {
                    let is_dearer = weighted_cost(&bench.graph, &other.rates) >= least;
                    declined.extend(is_dearer.then_some((other.name, "another formulation promises less")));
                    !is_dearer
                });
            }
            if let Rank::Base(solution) | Rank::Last(solution) | Rank::Only(solution) = rank {
                shown = Some((formulations.len(), solution));
            }
            formulations.push(Formulated { name, rates, is_by_spins });
            if is_last {
                break 'list;
            }
        }
    }
    let Search { symmetry, shorter, .. } = search;
    let equations = match shorter {
        Some(shorter) => shorter,
        None => stated.shown().clone(),
    };
    // The base comes without proof, or with an error.
    let Some((place, solution)) = shown else {
        return Err(DerivationError::RoutesDisagree { equation: 0 });
    };
    // Those of the solution come first.
    formulations[..=place].rotate_right(1);
    if bench.leaves_out(MULTIPLIED_OUT) && formulations.iter().any(|other| other.name != MULTIPLIED_OUT) {
        formulations.retain(|other| other.name != MULTIPLIED_OUT);
        declined.push((MULTIPLIED_OUT, LEFT_OUT));
    }
    frame.velocities = formulations[0].rates[..frame.velocities.len()].to_vec();
    Ok(Found { equations, momenta: None, solution, formulations, declined, symmetry })
}

impl Search<'_> {
    /// Whether rates solve (2.7).
    fn is_proved(&mut self, bench: &mut Workbench, rates: &[ExprId]) -> Result<bool, DerivationError> {
        let Search { system, frame, stated, .. } = self;
        stated.definition.is_solved_by(bench, (system, frame), rates)
    }

    /// The rates of the state by solved equations.
    fn rates(&self, accelerations: &[ExprId]) -> Vec<ExprId> {
        [&self.frame.velocities, accelerations].concat()
    }

    /// The rates by bodies.
    fn bodies(&mut self, bench: &mut Workbench) -> Option<&multibody::Found> {
        let Search { system, frame, partials, stated, .. } = self;
        let find = || multibody::rates(bench, system, frame, partials, false, |_| false);
        stated.bodies.get_or_insert_with(find).as_ref()
    }

    /// Whether there are many parameters and nothing turns: by bodies, particles have a full mass matrix then.
    fn are_many_particles(&self) -> bool {
        self.system.structure.frames().len() <= 1 && self.system.forms.degrees > MANY_COORDINATES
    }

    /// The equations as they are stated, solved: what is shown unless something is much shorter.
    fn base(&mut self, bench: &mut Workbench) -> Result<Outcome, DerivationError> {
        let solution = solved(bench, self.stated.shown())?;
        let rates = self.rates(&solution.accelerations);
        let is_compared = !bench.leaves_out(MULTIPLIED_OUT);
        self.least = if is_compared { weighted_cost(&bench.graph, &rates) } else { u64::MAX };
        Ok(Outcome::Found(vec![Candidate { rates, rank: Rank::Base(solution) }]))
    }
}

/// Finds rates with the reactions between the velocity forms as unknowns.
fn by_constraint_forces(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    search.in_base = match search.stated.in_base.take() {
        None if search.stated.projected.is_some() => {
            InBaseParameters::new(bench, search.system, search.frame)
        }
        known => known,
    };
    let Stated { projected, multiplied, .. } = &*search.stated;
    let squares = projected.as_ref().map(|projected| &projected.squares);
    let found = match (&mut search.in_base, squares) {
        (Some(in_base), _) => in_base.by_constraint_forces(bench, search.system),
        (None, Some(Some(squares))) => {
            let etas = &search.system.etas[..search.system.forms.degrees];
            let theirs = constraint_forces::dense_cost(bench, &multiplied[0].mass[..etas.len()]);
            constraint_forces::solve_squares(
                bench,
                search.frame,
                squares,
                theirs,
                etas,
                search.generalised_forces,
            )
        }
        (None, Some(None)) => return Ok(Outcome::Declined("the energy is no sum of squares")),
        (None, None) => return Ok(Outcome::Declined("the energy is not multiplied out")),
    };
    let Some(found) = found else { return Ok(Outcome::Declined("the mass matrix promises less")) };
    let rates = search.rates(&found.accelerations);
    let cost = weighted_cost(&bench.graph, &rates);
    // The equations that the others solve are more expensive before they are solved; bodies do not solve them.
    let is_least = found.is_clear
        && cost <= weighted_cost(&bench.graph, &multiplied[0].entries())
        && (search.are_many_particles()
            || search.bodies(bench).is_none_or(|found| cost <= weighted_cost(&bench.graph, &found.rates)));
    let rank = if is_least {
        Rank::Last(Solution::known(bench, found.accelerations, &found.divisors))
    } else {
        Rank::Other
    };
    Ok(Outcome::Found(vec![Candidate { rates, rank }]))
}

/// The equations as they are multiplied out, solved.
fn multiplied_out(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    if search.stated.of_bodies.is_some() {
        return Ok(Outcome::Declined("the equations of bodies are much shorter"));
    }
    search.base(bench)
}

/// Bodies that hang on each other and roll, as they were declared.
fn of_bodies(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    let Some(found) = search.bodies(bench).cloned() else {
        return Ok(Outcome::Declined("the energy is not that of bodies, or their axes are not understood"));
    };
    if search.stated.of_bodies.is_some() {
        let accelerations = found.rates[search.frame.velocities.len()..].to_vec();
        let solution = Solution::of_pivots(bench, accelerations, &found.pivots);
        let candidate = Candidate { rates: found.rates, rank: Rank::Only(solution) };
        return Ok(Outcome::Found(vec![candidate]));
    }
    let cost = weighted_cost(&bench.graph, &found.rates);
    if cost >= search.least {
        return Ok(Outcome::Declined("the equations as stated promise less"));
    }
    let is_half = cost > OTHER_WAYS && cost <= search.least / 2;
    let rank = if is_half {
        let accelerations = found.rates[search.frame.velocities.len()..].to_vec();
        Rank::Last(Solution::of_pivots(bench, accelerations, &found.pivots))
    } else {
        Rank::Other
    };
    Ok(Outcome::Found(vec![Candidate { rates: found.rates, rank }]))
}

/// The equations in further forms, solved.
fn projected(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    let others = search.stated.multiplied.iter().skip(1);
    let solutions = others.filter_map(|other| Solution::new(bench, &other.mass, &other.forces).ok());
    let solutions: Vec<Solution> = solutions.collect();
    if solutions.is_empty() {
        return Ok(Outcome::Declined("the equations have one form"));
    }
    let lists = solutions.iter().map(|other| search.rates(&other.accelerations)).collect();
    Ok(Outcome::found(lists, || Rank::Solved))
}

/// The equations solved with the first value of each pair kept whole.
fn shared(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    let MotionEquations { mass, forces } = search.stated.shown();
    let Some(solution) = Solution::shared(bench, mass, forces) else {
        return Ok(Outcome::Declined("no two accelerations are coupled by themselves"));
    };
    Ok(Outcome::found(vec![search.rates(&solution.accelerations)], || Rank::Solved))
}

/// Velocities computed one from another.
fn recursive(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    let Some(projected) = &search.stated.projected else {
        return Ok(Outcome::Declined("the energy is not multiplied out"));
    };
    let (system, forces, least) = (search.system, search.generalised_forces, search.least);
    let mut lists =
        recursive::rates(bench, system, search.frame, search.terms, &projected.forms, forces, least);
    lists.retain(|rates| weighted_cost(&bench.graph, rates) < least);
    if lists.is_empty() {
        return Ok(Outcome::Declined(
            "velocities have nothing in common, or the equations as stated promise less",
        ));
    }
    Ok(Outcome::found(lists, || Rank::Other))
}

/// Velocities along the axes of the bodies.
fn in_body_axes(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    let Some(projected) = &search.stated.projected else {
        return Ok(Outcome::Declined("the energy is not multiplied out"));
    };
    let own = match search.stated.in_body_axes.take() {
        Some(own) => Some(own),
        None => body_axes::equations(bench, search.system, search.frame, &projected.forms),
    };
    let Some(own) = own else {
        return Ok(Outcome::Declined("no chart has an edge, or no body turns"));
    };
    let lists = own.rates(bench, search.system, search.generalised_forces, false);
    Ok(Outcome::found(lists, || Rank::Other))
}

/// Finds rates by the spins of the bodies.
fn by_spins(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    let Some(lists) = spins::rates(bench, search.system, search.frame, search.partials) else {
        return Ok(Outcome::Declined("no body turns freely, or its spins have the edges of the parameters"));
    };
    Ok(Outcome::found(lists, || Rank::Other))
}

/// Finds rates in the rates of the base angles.
fn in_base_parameters(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    let Some(in_base) = &mut search.in_base else {
        return Ok(Outcome::Declined("the parameters are the rates of the base angles"));
    };
    Ok(Outcome::found(in_base.rates(bench, search.system), || Rank::Other))
}

/// Solves the equations without the coordinates that they do not depend on.
fn without_headings(bench: &mut Workbench, search: &mut Search<'_>) -> Result<Outcome, DerivationError> {
    let Some(projected) = &search.stated.projected else {
        return Ok(Outcome::Declined("the energy is not multiplied out"));
    };
    let shown = search.stated.shown();
    let forms = (shown, &projected.equations);
    let found = headings::without(bench, search.system, search.frame, forms, search.generalised_forces);
    let Some(found) = found else {
        return Ok(Outcome::Declined("the equations depend on all their coordinates"));
    };
    let least = weighted_cost(&bench.graph, &shown.entries());
    if let Some(shorter) = found.equations
        && search.stated.definition.is(bench, (search.system, search.frame), &shorter, true)?
    {
        let shorter = shorter.driven(bench, search.generalised_forces);
        let is_shorter = weighted_cost(&bench.graph, &shorter.entries()) < least;
        search.shorter = is_shorter.then_some(shorter);
    }
    search.symmetry = found.symmetry;
    Ok(Outcome::found(found.rates, || Rank::Other))
}
