//! From the model to what is emitted: the derivation, its faults in the user's names, and the programs.

mod carried;
mod cheapest;
mod closure;
mod faults;
mod fixed;
mod formulas;
mod manifold;
mod parts;
mod scene;
mod selection;
mod series;

use std::rc::Rc;

use guen_symbolic::{
    Contracted, Derivation, ExprId, FunctionProgram, Graph, Limits, ProgramBuilder, Programs, SeriesProgram,
    Workbench, normal_coefficients, normal_form, weighted_cost,
};

use crate::diagnostics::Faults;
use crate::jacobians::Jacobians;
use crate::model::Model;

pub use closure::{Quadrature, Reason};
pub use scene::SceneFacts;
pub use selection::{Held, Place, Selection};

/// A derived system with its scenes.
pub struct Derived<'a> {
    /// The model.
    pub model: Model<'a>,
    /// The system itself.
    pub system: Level,
    /// Its scenes, in order.
    pub scenes: Vec<Level>,
}

/// A level of detail: the system itself, or a scene.
pub struct Level {
    /// The parts of the model that the level has.
    pub selection: Selection,
    /// The derivation, with the constants that a scene fixes at their values.
    pub derivation: Rc<Derivation>,
    /// The brackets that do not vanish identically.
    pub brackets: Rc<Vec<Commutator>>,
    /// The rates of its variables.
    pub rates: Vec<ExprId>,
    /// The equations of motion (2.7) as expressions that vanish; only of the system itself.
    pub equations: Vec<ExprId>,
    /// The energy integral.
    pub energy: ExprId,
    /// The straight-line code.
    pub programs: Programs,
    /// Where the bodies of the system itself are, with a preparation of its own: nothing is prepared for programs that never
    /// look.
    pub placed: Option<Programs>,
    /// Functions that must not vanish: the domain of the chart.
    pub domain: Vec<ExprId>,
    /// Each of them in words.
    pub domain_names: Vec<String>,
    /// How many of them, from the first, guards measure one by one; the others are determinants, and measured together
    /// as the condition of the mass matrix.
    pub edges: usize,
    /// Expressions of constants that must not vanish.
    pub constant_pivots: Vec<ExprId>,
    /// The recurrences of its Taylor series, if it provides one.
    pub series: Option<SeriesProgram>,
    /// Where the derivatives belong that have code of their own.
    pub jacobians: Jacobians,
    /// How expressions are written in the report.
    pub shown: Contracted,
    /// The facts about a scene that its documentation tells; none for the system itself.
    pub scene: Option<SceneFacts>,
    /// The level with its elementary functions as states, if that form is provided.
    pub carried: Option<Box<Level>>,
}

impl Level {
    /// The program of a function, if it computes anything.
    pub fn program(&self, name: &str) -> Option<&FunctionProgram> {
        self.programs.functions.iter().find(|function| function.name == name)
    }
}

/// A bracket `(X_r, X_s)`, `r < s`, that does not vanish identically.
pub struct Commutator {
    /// The first operator.
    pub r: usize,
    /// The second operator.
    pub s: usize,
    /// `C_rs1 .. C_rsn`.
    pub coefficients: Vec<ExprId>,
}

/// A function beside the right-hand side, by its name, and what it computes.
pub(crate) type Quantity = (&'static str, Vec<ExprId>);

/// Names of the functions, in the order in which they are built.
pub mod function {
    /// The rates of the state.
    pub const RHS: &str = "rhs";
    /// The velocities `x'` of a state.
    pub const VELOCITIES: &str = "velocities";
    /// The values of all forms at given velocities.
    pub const FORMS: &str = "forms";
    /// The energy integral.
    pub const ENERGY: &str = "energy";
    /// The kinetic energy.
    pub const KINETIC_ENERGY: &str = "kinetic_energy";
    /// The force function.
    pub const FORCE_FUNCTION: &str = "force_function";
    /// The momenta.
    pub const MOMENTA: &str = "momenta";
    /// The reactions at given accelerations.
    pub const REACTIONS: &str = "reactions";
    /// The rate of the energy integral at given accelerations.
    pub const POWER: &str = "power";
    /// The outputs.
    pub const OUTPUTS: &str = "outputs";
    /// The holonomic constraints, then those that follow from them.
    pub const POSITIONS: &str = "positions";
    /// The values of [`POSITIONS`], then the derivatives of each by the coordinates, one constraint after the other. There is no such
    /// program without holonomic constraints.
    pub const GRADIENTS: &str = "gradients";
    /// The lower triangle of the mass matrix, where it is not diagonal.
    pub const MASS: &str = "mass";
    /// Centers and orientations of the bodies, then the positions of the particles.
    pub const BODIES: &str = "bodies";
    /// The functions that must not vanish.
    pub const DOMAIN: &str = "domain";
    /// The expressions of constants that must not vanish.
    pub const PIVOTS: &str = "pivots";
    /// Coordinates that a scene leaves out and that holonomic equations say of what it keeps.
    pub const DETERMINED: &str = "determined";
    /// The differentials of the integrable combinations of constraints, row by row.
    pub const LEAF: &str = "leaf";
    /// The lower triangle of the mass matrix, the bias, and the matrix of the inputs.
    pub const MASS_FORM: &str = "mass_form";
    /// The reactions as a covector on the velocities; only where all are known.
    pub const REACTION_COVECTOR: &str = "reaction_covector";
    /// The derivatives of the rates by state and inputs, those that do not vanish.
    pub const LINEARIZATION: &str = "linearization";
    /// The derivatives of the outputs likewise.
    pub const OUTPUT_LINEARIZATION: &str = "output_linearization";
    /// The coefficients of `X_0`, then of `X_1`, and so on.
    pub const OPERATORS: &str = "operators";
    /// The coefficients of the brackets that do not vanish, in their order.
    pub const BRACKETS: &str = "brackets";
    /// The functions that are carried as states, at a state without them.
    pub const CARRY: &str = "carry";
    /// Functions that vanish where carried functions have the values that they stand for.
    pub const INVARIANTS: &str = "invariants";
    /// Carried functions, closer to their relations.
    pub const RENORMALIZED: &str = "renormalized";
}

/// Derives a checked model and its scenes; a system without equations of motion is reported.
pub fn derive<'a>(mut model: Model<'a>, faults: &mut Faults) -> Option<Derived<'a>> {
    let before = faults.count();
    let derivation = match Derivation::new(&mut model.bench, model.mechanics.clone()) {
        Ok(derivation) => Some(derivation),
        Err(error) => {
            faults::report(&mut model, error, faults);
            None
        }
    };
    let mut derivation = derivation?;
    faults::report_missing_momenta(&mut model, &mut derivation, faults);
    faults::report_unknown_reactions(&model, &derivation, faults);
    if faults.count() > before {
        return None;
    }
    derivation.restate_by_bodies(&mut model.bench);
    polish(&mut model.bench, &mut derivation);
    let brackets = commutators(&mut model, &mut derivation);
    let mut system = whole(&mut model, Rc::new(derivation), Rc::new(brackets), faults);
    if let Some(word) = model.provides_taylor {
        system.series = series::of(&model, &system.selection, &system.programs, word.span(), faults);
    }
    let scenes = scene::derive(&mut model, &system, faults);
    (faults.count() == before).then_some(Derived { model, system, scenes })
}

/// The system itself, with everything that follows from its derivation.
fn whole(
    model: &mut Model<'_>,
    derivation: Rc<Derivation>,
    brackets: Rc<Vec<Commutator>>,
    faults: &mut Faults,
) -> Level {
    let (n, size) = model.sizes();
    let forms = 0..model.forms.len();
    let selection = Selection {
        variables: (0..size).collect(),
        coordinates: (0..n).collect(),
        parameters: (0..size - n).collect(),
        constants: (0..model.constants.len()).collect(),
        held: Vec::new(),
        inputs: (0..model.inputs.len()).collect(),
        holonomic: (0..derivation.system.holonomic.len()).collect(),
        redundant: (0..derivation.system.redundant.len()).collect(),
        momenta: forms.clone().filter(|j| derivation.known_momentum[*j]).collect(),
        reactions: forms.skip(size - n).filter(|v| derivation.reactions[v + n - size].is_some()).collect(),
        outputs: (0..model.outputs.len()).collect(),
        energy: true,
        linearization: true,
        operators: true,
        carried: Vec::new(),
    };
    let equations = equations(&mut model.bench, &derivation);
    let shown = shown(model, &derivation, &brackets, &equations);
    let edges = domain(model, &derivation, &shown).into_iter().map(|edge| (edge.function, edge.text));
    let (domain, domain_names): (Vec<ExprId>, Vec<String>) = edges.unzip();
    let constant_pivots = constant_pivots(&derivation);
    let quantities = formulas::whole(model, &derivation, &brackets, domain.clone(), constant_pivots.clone());
    let control = crate::control::quantities(&mut model.bench, &derivation);
    let quantities: Vec<Quantity> = quantities.into_iter().chain(control).collect();
    let rates = derivation.formulations[0].rates.clone();
    let mut lists = formulas::rates(&derivation);
    extend(&mut model.bench, &mut lists);
    let placed = formulas::placed(model);
    let placed = (!placed.is_empty()).then(|| programs(&mut model.bench, &[], &[(function::BODIES, placed)]));
    let mut programs = programs(&mut model.bench, &lists, &quantities);
    add_mass(&mut programs, model, &derivation);
    let edges = domain_names.len() - derivation.solution.determinants.len();
    let jacobians = Jacobians::add(&mut programs, model, &selection);
    let energy = derivation.energies.integral;
    let mut level = Level {
        selection,
        derivation,
        brackets,
        rates,
        equations,
        energy,
        programs,
        placed,
        domain,
        domain_names,
        edges,
        constant_pivots,
        series: None,
        jacobians,
        shown,
        scene: None,
        carried: None,
    };
    if let Some(word) = model.provides_carried {
        level.carried = carried::derive(model, &level, &formulas::rates(&level.derivation), word, faults);
    }
    level
}

/// The mass matrix by itself, out of the equations apart, unless it is diagonal: then it has no condition to measure.
fn add_mass(programs: &mut Programs, model: &Model<'_>, derivation: &Derivation) {
    let mass = &derivation.equations.mass;
    let l = mass.len();
    let graph = &model.bench.graph;
    let coupled = (0..l).any(|s| (0..s).any(|k| !graph.is_zero(mass[s][k])));
    if coupled {
        programs.add_excerpt(function::MASS, function::MASS_FORM, 0..l * (l + 1) / 2);
    }
}

/// `sum_t M_st eta_t' - f_s`.
fn equations(bench: &mut Workbench, derivation: &Derivation) -> Vec<ExprId> {
    let rows = derivation.equations.mass.iter().zip(&derivation.equations.forces);
    let rows = rows.map(|(row, force)| {
        let inertia = bench.dot(row, &derivation.system.accelerations);
        bench.graph.sub(inertia, *force)
    });
    rows.collect()
}

/// How a derivation is written: what is shown of it, with sines and cosines of sums.
fn shown(
    model: &mut Model<'_>,
    derivation: &Derivation,
    brackets: &[Commutator],
    others: &[ExprId],
) -> Contracted {
    let (operators, energies) = (&derivation.frame.operators, &derivation.energies);
    let forms = &derivation.system.forms.forms;
    let lists = operators
        .xi
        .iter()
        .chain(brackets.iter().map(|bracket| &bracket.coefficients))
        .chain(forms.iter().map(|form| &form.row))
        .chain([
            &derivation.frame.velocities,
            &operators.chart,
            &derivation.solution.pivots,
            &energies.momenta,
        ]);
    let single = [energies.kinetic, energies.integral, derivation.system.force_function, derivation.power];
    let offsets = forms.iter().map(|form| form.offset);
    let roots: Vec<ExprId> = lists.flatten().chain(others).copied().chain(single).chain(offsets).collect();
    Contracted::of(&mut model.bench.graph, &roots)
}

/// Expressions of constants that must not vanish.
fn constant_pivots(derivation: &Derivation) -> Vec<ExprId> {
    let operators = &derivation.frame.operators.constant_pivots;
    operators.iter().chain(&derivation.solution.constant_pivots).copied().collect()
}

/// Energies, momenta and reactions as polynomials in the quasi-velocities, where that is cheaper.
fn polish(bench: &mut Workbench, derivation: &mut Derivation) {
    let system = &derivation.system;
    let variables: Vec<ExprId> = system.accelerations.iter().chain(&system.etas).copied().collect();
    // What is larger is read by nobody, and seldom gets cheaper.
    let limits = Limits { nodes: 400, steps: 6_000, ..Limits::default() };
    let in_angles = |graph: &mut Graph, e: ExprId| {
        let Some(coefficients) = normal_coefficients(graph, e, &variables, &limits) else { return e };
        let terms: Vec<ExprId> = coefficients
            .into_iter()
            .map(|(exponents, c)| {
                let factors = variables.iter().zip(exponents).map(|(x, k)| (*x, k as i32));
                let factors: Vec<_> = factors.chain([(c, 1)]).collect();
                graph.product(&factors)
            })
            .collect();
        let sum = graph.sum(terms);
        if weighted_cost(graph, &[sum]) <= weighted_cost(graph, &[e]) { sum } else { e }
    };
    let mut polished = |e: ExprId| {
        let here = in_angles(&mut bench.graph, e);
        if bench.graph.is_in_base_angles(e) {
            return here;
        }
        let own = bench.in_base_angles(&[e], |bench| in_angles(&mut bench.graph, e));
        let cost = |e: ExprId| weighted_cost(&bench.graph, &[e]);
        if cost(own) < cost(here) { own } else { here }
    };
    let energies = &mut derivation.energies;
    energies.kinetic = polished(energies.kinetic);
    energies.integral = polished(energies.integral);
    for momentum in &mut energies.momenta {
        *momentum = polished(*momentum);
    }
    for reaction in derivation.reactions.iter_mut().flatten() {
        *reaction = polished(*reaction);
    }
    derivation.power = polished(derivation.power);
}

/// A function that must not vanish, as it is written, and in words that hold wherever it is seen from.
struct Edge {
    function: ExprId,
    text: String,
    words: String,
    /// Whether it is the determinant of a block of the mass matrix, which the words tell by its rows.
    is_determinant: bool,
}

/// The functions that must not vanish: large determinants are told by their rows.
fn domain(model: &Model<'_>, derivation: &Derivation, shown: &Contracted) -> Vec<Edge> {
    let named = |e: &ExprId, words: &str| Edge {
        function: *e,
        text: written(model, shown.image(*e), words),
        words: words.to_owned(),
        is_determinant: false,
    };
    let chart = derivation.frame.operators.chart.iter().map(|e| named(e, "a factor of det A"));
    let pivots = derivation.solution.pivots.iter().map(|e| named(e, "a pivot of the mass matrix"));
    let determinants = derivation.solution.determinants.iter().map(|(rows, e)| {
        let names: Vec<&str> = rows.iter().map(|s| model.forms[*s].name.as_str()).collect();
        let words = format!("det M[{}]", names.join(", "));
        Edge { function: *e, text: words.clone(), words, is_determinant: true }
    });
    chart.chain(pivots).chain(determinants).collect()
}

/// A function that must not vanish in words; another text where it is too long.
fn written(model: &Model<'_>, e: ExprId, otherwise: &str) -> String {
    const LONGEST: usize = 400;
    model.bench.graph.text_limited(e, LONGEST).unwrap_or(otherwise.to_owned())
}

/// The brackets that do not vanish identically: among `X_0 .. X_l`, or among all operators if the system or a scene
/// provides operators.
fn commutators(model: &mut Model<'_>, derivation: &mut Derivation) -> Vec<Commutator> {
    let n = derivation.system.forms.len();
    let last = model.last_operator();
    // What is constant on a unit sphere is that constant.
    let mut holding = fixed::Holding::new(model, &[]);
    let (bench, brackets) = (&mut model.bench, &mut derivation.frame.brackets);
    let mut spheres = manifold::Replacement::all(bench, &derivation.system, &mut holding);
    spheres.retain(|replacement| replacement.is_trial);
    let mut found = Vec::new();
    for (r, s) in (1..=last).flat_map(|s| (0..s).map(move |r| (r, s))) {
        let mut coefficients: Vec<ExprId> = (1..=n).map(|t| brackets.coefficient(bench, r, s, t)).collect();
        for c in &mut coefficients {
            if bench.graph.roles(*c).is_constant() {
                continue;
            }
            let image = parts::replaced(bench, &mut spheres, *c);
            if bench.graph.roles(image).is_constant() {
                *c = image;
            }
        }
        if coefficients.iter().any(|c| !bench.graph.is_zero(*c)) {
            found.push(Commutator { r, s, coefficients });
        }
    }
    found
}

/// Adds further forms of the first list of rates, and drops those that are too dear to be looked at.
fn extend(bench: &mut Workbench, lists: &mut Vec<Vec<ExprId>>) {
    // Beyond this estimate normal forms run into their limits, and only cost time.
    const LARGEST_WRITTEN_OUT: u64 = 600;
    let mut estimates: Vec<u64> = lists.iter().map(|list| weighted_cost(&bench.graph, list)).collect();
    let best = (0..lists.len()).min_by_key(|i| estimates[*i]).unwrap_or_default();
    if estimates[best] <= LARGEST_WRITTEN_OUT {
        let limits = Limits::default();
        let written_out: Vec<ExprId> =
            lists[best].iter().map(|e| normal_form(&mut bench.graph, *e, &limits).unwrap_or(*e)).collect();
        estimates.insert(1, weighted_cost(&bench.graph, &written_out));
        lists.insert(1, written_out);
    }
    // A form may come out cheaper although it looks dearer, but hardly by more than half.
    let most = 3 * estimates.iter().copied().min().unwrap_or_default() / 2;
    let mut estimate = estimates.into_iter();
    lists.retain(|_| estimate.next().is_some_and(|cost| cost <= most));
}

/// The code of the rates, given in several equal forms, and of everything else.
fn programs(bench: &mut Workbench, rates: &[Vec<ExprId>], quantities: &[Quantity]) -> Programs {
    /// Reactions beyond this estimate get no program of their own.
    const LARGE: u64 = 1000;
    let quantity =
        |name: &str| quantities.iter().find(|(known, _)| *known == name).map(|(_, outputs)| outputs);
    // The covector is the reactions times the rows of their constraints: where they are large one program is made, and divided.
    let reactions = quantity(function::REACTIONS).filter(|list| weighted_cost(&bench.graph, list) > LARGE);
    let both = reactions.zip(quantity(function::REACTION_COVECTOR));
    let mut builder = ProgramBuilder::new(&mut bench.graph);
    if !rates.is_empty() {
        builder.add_equal(function::RHS, rates);
    }
    for (name, outputs) in quantities.iter().filter(|(_, outputs)| !outputs.is_empty()) {
        match (*name, both) {
            (function::REACTIONS, Some(_)) => {}
            (function::REACTION_COVECTOR, Some((reactions, covector))) => {
                builder.add_cold(name, &[&covector[..], reactions].concat());
            }
            _ => builder.add_cold(name, outputs),
        }
    }
    let mut programs = builder.finish();
    if let Some((_, covector)) = both {
        programs.divide(function::REACTION_COVECTOR, covector.len(), function::REACTIONS);
    }
    programs
}
