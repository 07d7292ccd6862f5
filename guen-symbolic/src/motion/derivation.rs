//! The derivation as a whole: from a declared system to everything that is emitted.

use super::coordinates::constancy::{is_constant, jumps, rests};
use super::fault::{DerivationError, affordable, few_or_uncoupled};
use super::formulations::stated::Stated;
use super::formulations::{self, Formulated, Found, large};
use super::mass_matrix::indispensable;
use super::quasi_velocities::forces::generalised_forces;
use super::quasi_velocities::velocity_forms::VelocityPartials;
use super::results::outputs::outputs;
use super::results::state_rates;
use super::{Energies, Frame, Mechanics, MotionEquations, Solution, decompose};
use crate::algebra::{ExprId, FastMap, Flow, Substitution};
use crate::geometry::{Closure, Operators};
use crate::workbench::Workbench;
use crate::zero::Verdict;

/// The classification of the forms as declared, after (1.13) and (1.14).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Class {
    /// Holonomic, all coefficients constant: Poincaré's case.
    LieGroup,
    /// Nonholonomic, all coefficients constant.
    IncompleteLieGroup,
    /// Holonomic, some coefficient variable.
    Holonomic,
    /// Nonholonomic, some coefficient variable.
    Nonholonomic,
    /// The zero test could not decide.
    Undecided,
}

/// Everything that follows from a declaration.
pub struct Derivation {
    /// The declaration.
    pub system: Mechanics,
    /// Operators, brackets, and motion in their frame.
    pub frame: Frame,
    /// The Lie closure.
    pub closure: Closure,
    /// The class of the forms.
    pub class: Class,
    /// Whether `t` occurs neither in the forms of the constraints nor in `T°` and `U`.
    pub scleronomic: bool,
    /// Whether all `a_v0 = 0`.
    pub catastatic: bool,
    /// `h' = 0` identically, wherever constraints on positions hold.
    pub conservative: bool,
    /// The equations of motion, `l` rows, generalised forces included; none of a large system without constraints, see
    /// [`Derivation::is_written_out`].
    pub equations: MotionEquations,
    /// The generalised forces `Q_1..Q_n` on their own.
    pub generalised_forces: Vec<ExprId>,
    /// The solved accelerations.
    pub solution: Solution,
    /// The rates of the state by all formulations that gave some, those of the solution first, and of the states beside the motion:
    /// which costs least is found when code is made.
    pub formulations: Vec<Formulated>,
    /// The formulations that gave nothing, each with the reason.
    pub declined: Vec<(&'static str, &'static str)>,
    /// The reactions `lambda_v` as functions of `t, x, eta`, inputs and `eta'` (as symbols); none for constraints
    /// without momentum in `T°`.
    pub reactions: Vec<Option<ExprId>>,
    /// Whether `dT°/d eta_j` vanishes identically with all `eta` free.
    pub without_momentum: Vec<bool>,
    /// Whether the momentum of a form is known: it differs from zero, or `T°` states that it is zero.
    pub known_momentum: Vec<bool>,
    /// Energies and momenta.
    pub energies: Energies,
    /// `h'` along the motion, with `eta'` as symbols.
    pub power: ExprId,
    /// The outputs on the constraints.
    pub outputs: Vec<ExprId>,
    /// The equations with the constraints as parameters that stay zero, where they were needed so far.
    pub(super) freed: Option<MotionEquations>,
}

impl Derivation {
    /// Derives everything. Where the equations of many bodies are too much work, their rates alone.
    pub fn new(bench: &mut Workbench, system: Mechanics) -> Result<Self, DerivationError> {
        let without_equations = large::may_be_alone(&system).then(|| system.clone());
        match (Self::derived(bench, system, false), without_equations) {
            (Err(DerivationError::TooLarge), Some(system)) => {
                bench.begin_another();
                Self::derived(bench, system, true)
            }
            (derivation, _) => derivation,
        }
    }

    fn derived(
        bench: &mut Workbench,
        system: Mechanics,
        without_equations: bool,
    ) -> Result<Self, DerivationError> {
        let (n, l) = (system.forms.len(), system.forms.degrees);
        few_or_uncoupled(&system)?;
        let equations_of_position: Vec<ExprId> = system.holonomic.iter().map(|h| h.equation).collect();
        bench.zero.set_manifold(&mut bench.graph, &equations_of_position);
        bench.choose_base_angles(&[], &system.expressions());
        let operators = Operators::new(bench, &system.forms);
        affordable(bench)?;
        let operators = operators.map_err(DerivationError::SingularForms)?;
        let mut frame = Frame::new(bench, &system, operators);
        let mut partials = VelocityPartials::of_system(bench, &system);
        let symbols: Vec<ExprId> = system.velocities.iter().chain(&system.etas).copied().collect();
        let terms = decompose(bench, &mut partials, &symbols, system.kinetic_energy)
            .map_err(DerivationError::NotQuadratic)?;
        let indispensable = indispensable::find(bench, &system, &frame, &mut partials, &terms);
        let generalised_forces = generalised_forces(bench, &system, &mut frame, &mut partials);

        let given = (&terms[..], &generalised_forces[..]);
        let mut stated = Stated::new(bench, &system, &mut frame, &mut partials, given, without_equations)?;
        let Found { equations, momenta, mut solution, mut formulations, declined, mut symmetry } =
            formulations::walk(
                bench,
                &system,
                &mut frame,
                &mut partials,
                &terms,
                &generalised_forces,
                &mut stated,
            )?;
        let (constrained, freed) = (stated.constrained, stated.freed);
        // What was taken to differ from zero is looked at when a system is prepared.
        solution.constant_pivots.extend(indispensable);

        let closure = {
            let Frame { operators, brackets, .. } = &mut frame;
            Closure::new(bench, &system.forms, operators, brackets)
        };
        affordable(bench)?;
        let class = classify(bench, &system, &mut frame, &closure);
        let wanted = if momenta.is_none() { 0..n } else { 0..0 };
        let mut energies = Energies::new(bench, &system, &mut frame, &mut partials, &terms, wanted);
        energies.momenta.extend(momenta.into_iter().flatten());
        for e in energies.momenta.iter_mut().chain([&mut energies.kinetic, &mut energies.integral]) {
            *e = symmetry.shorter(bench, *e);
        }
        let without_momentum = without_momentum(bench, &system, &frame, &mut partials, &terms);
        let is_written_out = equations.mass.len() == l;
        let known_momentum: Vec<bool> = without_momentum
            .iter()
            .zip(&system.stated)
            .map(|(without, stated)| is_written_out && (!without || *stated))
            .collect();
        let reactions: Vec<Option<ExprId>> = (l..n)
            .map(|v| {
                // lambda_v = sum_t M_vt eta_t' - f_v
                known_momentum[v].then(|| {
                    let mut parts = vec![bench.graph.neg(constrained.forces[v - l])];
                    for (mass, acceleration) in constrained.mass[v - l].iter().zip(&system.accelerations) {
                        let mass = bench.tidy(*mass);
                        parts.push(bench.graph.mul(mass, *acceleration));
                    }
                    let reaction = bench.graph.sum(parts);
                    symmetry.shorter(bench, reaction)
                })
            })
            .collect();
        affordable(bench)?;
        let catastatic = system.forms.is_catastatic(&bench.graph);
        let explicit = explicit_time(bench, &system, &mut frame);
        let scleronomic = forms_scleronomic(bench, &system) && bench.vanishes(explicit);
        let power = power(bench, &system, &generalised_forces, &reactions, explicit);
        let conservative = power.is_some_and(|power| {
            let mut solved = Substitution::new(
                system.accelerations.iter().copied().zip(solution.accelerations.iter().copied()),
            );
            let power = solved.of(&mut bench.graph, power);
            bench.is_seen_to_vanish(power)
        });
        let power = power.unwrap_or(bench.graph.zero());
        let outputs = outputs(bench, &system, &mut frame, &mut partials, &formulations, &reactions);
        state_rates::append(bench, &system, &frame, &reactions, &mut formulations);
        Ok(Derivation {
            system,
            frame,
            closure,
            class,
            scleronomic,
            catastatic,
            conservative,
            equations,
            generalised_forces,
            solution,
            formulations,
            declined,
            reactions,
            without_momentum,
            known_momentum,
            energies,
            power,
            outputs,
            freed,
        })
    }

    /// Whether the equations, the mass matrix and the momenta are there. Those of many parameters without constraints are not made: a
    /// mass matrix has an entry for each pair.
    #[must_use]
    pub fn is_written_out(&self) -> bool {
        self.equations.mass.len() == self.system.forms.degrees
    }

    /// Whether a formulation gave rates.
    #[must_use]
    pub fn is_by(&self, name: &str) -> bool {
        self.formulations.iter().any(|formulated| formulated.name == name)
    }

    /// Constraints whose momentum (2.7) needs, because some `C_rsv` differs from zero, although `T°` has none:
    /// triples `(v, r, s)`, `v` from 0 and `r, s` as in the paper.
    pub fn missing_momenta(&mut self, bench: &mut Workbench) -> Vec<(usize, usize, usize)> {
        let (n, l) = (self.system.forms.len(), self.system.forms.degrees);
        let mut found = Vec::new();
        for v in (l..n).filter(|v| self.without_momentum[*v]) {
            'pairs: for s in 1..=l {
                for r in 0..s {
                    let c = self.frame.brackets.coefficient(bench, r, s, v + 1);
                    if bench.verdict_on_manifold(c) == Verdict::Nonzero {
                        found.push((v, r, s));
                        break 'pairs;
                    }
                }
            }
        }
        found
    }
}

fn classify(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame, closure: &Closure) -> Class {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    let variables: Vec<ExprId> =
        system.forms.coordinates.iter().copied().chain([system.forms.time]).collect();
    let mut constant = true;
    // All coefficients of closed forms are zero.
    let last = if frame.brackets.are_zero() { 0 } else { l };
    'all: for s in 1..=last {
        for r in 0..s {
            for t in 1..=n {
                let c = frame.brackets.coefficient(bench, r, s, t);
                // Without constraints on positions nothing rests but constants.
                let rests = !system.holonomic.is_empty() && rests(bench, system, frame, c);
                if !(rests || is_constant(bench, c, &variables)) || jumps(bench, c) {
                    constant = false;
                    break 'all;
                }
            }
        }
    }
    match (closure.growth.len() > 1, closure.complete, constant) {
        (true, _, true) => Class::IncompleteLieGroup,
        (true, _, false) => Class::Nonholonomic,
        (false, true, true) => Class::LieGroup,
        (false, true, false) => Class::Holonomic,
        (false, false, _) => Class::Undecided,
    }
}

/// Whether `(dT°/d eta_v)` vanishes identically with all `eta` free, for each constraint; never for a parameter.
fn without_momentum(
    bench: &mut Workbench,
    system: &Mechanics,
    frame: &Frame,
    partials: &mut VelocityPartials,
    terms: &[super::KineticTerm],
) -> Vec<bool> {
    let (n, l) = (system.forms.len(), system.forms.degrees);
    if n == l {
        return vec![false; n];
    }
    // Each form with all eta free: u_0 + sum_j eta_j u_j, and its components.
    let mut free: FastMap<ExprId, (ExprId, Vec<ExprId>)> = FastMap::default();
    for u in terms.iter().flat_map(|term| &term.forms) {
        if !free.contains_key(u) {
            let form = partials.affine(bench, *u).expect("the decomposition yields affine forms");
            let components: Vec<ExprId> = (0..=n).map(|j| frame.component(bench, &form, j)).collect();
            let moving = bench.dot(&components[1..], &system.etas);
            free.insert(*u, (bench.graph.add(components[0], moving), components));
        }
    }
    (0..n)
        .map(|j| {
            if j < l {
                return false;
            }
            let mut parts = Vec::new();
            for term in terms {
                for (place, u) in term.forms.iter().enumerate() {
                    let mut factors = vec![(term.weight, 1), (free[u].1[j + 1], 1)];
                    let partner = term.forms.iter().enumerate().find(|(k, _)| *k != place);
                    factors.extend(partner.map(|(_, other)| (free[other].0, 1)));
                    parts.push(bench.graph.product(&factors));
                }
            }
            let momentum = bench.graph.sum(parts);
            bench.vanishes(momentum)
        })
        .collect()
}

/// `d(T° + U)/dt` at fixed `x, x'`, on the constraints.
fn explicit_time(bench: &mut Workbench, system: &Mechanics, frame: &mut Frame) -> ExprId {
    let expanded: Vec<(ExprId, ExprId)> = system
        .etas
        .iter()
        .zip(&system.forms.forms)
        .map(|(eta, form)| {
            let linear = bench.dot(&form.row, &system.velocities);
            (*eta, bench.graph.add(linear, form.offset))
        })
        .collect();
    let mut by_velocities = Substitution::new(expanded);
    let kinetic = by_velocities.of(&mut bench.graph, system.kinetic_energy);
    let total = bench.graph.add(kinetic, system.force_function);
    let slope = bench.partial(total, system.forms.time);
    frame.constrain.of(&mut bench.graph, slope)
}

/// Whether time is absent from the forms of the constraints.
fn forms_scleronomic(bench: &mut Workbench, system: &Mechanics) -> bool {
    let mut by_time = Flow::partial(&bench.graph, system.forms.time);
    system.forms.forms[system.forms.degrees..].iter().all(|form| {
        form.row.iter().chain([&form.offset]).all(|a| {
            let slope = by_time.of(&mut bench.graph, *a);
            bench.vanishes(slope)
        })
    })
}

/// `h' = Q.x' - sum_v lambda_v a_v0 - d(T° + U)/dt`, or `None` where a reaction would be needed that is not known.
fn power(
    bench: &mut Workbench,
    system: &Mechanics,
    generalised_forces: &[ExprId],
    reactions: &[Option<ExprId>],
    explicit: ExprId,
) -> Option<ExprId> {
    let l = system.forms.degrees;
    // x_i' as a combination of the forms' linear parts: sum_j (eta_j - a_j0) X_j, so Q.x' = sum_j Q_j (eta_j - a_j0).
    let mut terms = vec![bench.graph.neg(explicit)];
    for (j, q) in generalised_forces.iter().enumerate() {
        let zero = bench.graph.zero();
        let eta = if j < l { system.etas[j] } else { zero };
        let linear = bench.graph.sub(eta, system.forms.forms[j].offset);
        terms.push(bench.graph.mul(*q, linear));
    }
    for (reaction, form) in reactions.iter().zip(&system.forms.forms[l..]) {
        if !bench.graph.is_zero(form.offset) {
            let product = bench.graph.mul((*reaction)?, form.offset);
            terms.push(bench.graph.neg(product));
        }
    }
    Some(bench.graph.sum(terms))
}
