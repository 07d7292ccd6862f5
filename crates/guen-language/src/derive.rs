//! From the model to what is emitted: the derivation, its faults in the user's names, and the programs.

use guen_symbolic::{
    Derivation, DerivationError, ExprId, Limits, ProgramBuilder, Programs, SingularForms, Substitution,
    Verdict, normal_coefficients, weighted_cost,
};
use proc_macro2::Span;

use crate::diagnostics::{Fault, Faults};
use crate::model::{FormKind, Model};
use crate::names::quoted;

/// A derived system with its programs.
pub struct Derived<'a> {
    /// The model.
    pub model: Model<'a>,
    /// What follows from it.
    pub derivation: Derivation,
    /// The straight-line code.
    pub programs: Programs,
    /// Functions that must not vanish: the domain of the chart.
    pub domain: Vec<ExprId>,
    /// Expressions of constants that must not vanish.
    pub constant_pivots: Vec<ExprId>,
}

/// Names of the functions, in the order in which they are built; the operators and brackets follow.
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
    /// The reactions.
    pub const REACTIONS: &str = "reactions";
    /// The rate of the energy integral.
    pub const POWER: &str = "power";
    /// The outputs.
    pub const OUTPUTS: &str = "outputs";
    /// The holonomic constraints.
    pub const POSITIONS: &str = "positions";
    /// The functions that must not vanish.
    pub const DOMAIN: &str = "domain";
    /// The expressions of constants that must not vanish.
    pub const PIVOTS: &str = "pivots";
}

/// Derives a checked model; a system without equations of motion is reported.
pub fn derive<'a>(mut model: Model<'a>, faults: &mut Faults) -> Option<Derived<'a>> {
    let before = faults.count();
    let derivation = match Derivation::new(&mut model.bench, model.mechanics.clone()) {
        Ok(derivation) => Some(derivation),
        Err(error) => {
            report(&mut model, error, faults);
            None
        }
    };
    let mut derivation = derivation?;
    report_missing_momenta(&mut model, &mut derivation, faults);
    if faults.count() > before {
        return None;
    }
    polish(&mut model, &mut derivation);
    let domain: Vec<ExprId> =
        derivation.frame.operators.chart.iter().chain(&derivation.solution.pivots).copied().collect();
    let constant_pivots: Vec<ExprId> = derivation
        .frame
        .operators
        .constant_pivots
        .iter()
        .chain(&derivation.solution.constant_pivots)
        .copied()
        .collect();
    let programs = programs(&mut model, &mut derivation, &domain, &constant_pivots);
    Some(Derived { model, derivation, programs, domain, constant_pivots })
}

/// Energies, momenta and reactions as polynomials in the quasi-velocities, where that is cheaper.
fn polish(model: &mut Model<'_>, derivation: &mut Derivation) {
    let system = &derivation.system;
    let variables: Vec<ExprId> = system.accelerations.iter().chain(&system.etas).copied().collect();
    let limits = Limits::default();
    let mut polished = |e: ExprId| {
        let graph = &mut model.bench.graph;
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

fn programs(
    model: &mut Model<'_>,
    derivation: &mut Derivation,
    domain: &[ExprId],
    constant_pivots: &[ExprId],
) -> Programs {
    let (n, l) = (derivation.system.forms.len(), derivation.system.forms.degrees);
    let bench = &mut model.bench;
    let mut solved = Substitution::new(
        derivation
            .system
            .accelerations
            .iter()
            .copied()
            .zip(derivation.solution.accelerations.iter().copied()),
    );
    let forms: Vec<ExprId> = derivation
        .system
        .forms
        .forms
        .iter()
        .map(|form| {
            let linear = bench.dot(&form.row, &derivation.system.velocities);
            bench.graph.add(linear, form.offset)
        })
        .collect();
    let reactions: Vec<ExprId> =
        derivation.reactions.iter().flatten().map(|e| solved.of(&mut bench.graph, *e)).collect();
    let power = solved.of(&mut bench.graph, derivation.power);
    let positions: Vec<ExprId> = derivation.system.holonomic.iter().map(|h| h.equation).collect();
    let rates: Vec<ExprId> =
        derivation.frame.velocities.iter().chain(&derivation.solution.accelerations).copied().collect();
    let mut brackets: Vec<(String, Vec<ExprId>)> = Vec::new();
    for s in 1..=l {
        for r in 0..s {
            let coefficients: Vec<ExprId> =
                (1..=n).map(|t| derivation.frame.brackets.coefficient(bench, r, s, t)).collect();
            if coefficients.iter().any(|c| !bench.graph.is_zero(*c)) {
                brackets.push((format!("bracket_{r}_{s}"), coefficients));
            }
        }
    }
    let mut builder = ProgramBuilder::new(&mut bench.graph);
    let energies = &derivation.energies;
    builder.add_function(function::RHS, &rates);
    builder.add_function(function::VELOCITIES, &derivation.frame.velocities);
    builder.add_function(function::FORMS, &forms);
    builder.add_function(function::ENERGY, &[energies.integral]);
    builder.add_function(function::KINETIC_ENERGY, &[energies.kinetic]);
    builder.add_function(function::FORCE_FUNCTION, &[derivation.system.force_function]);
    builder.add_function(function::MOMENTA, &energies.momenta);
    builder.add_function(function::REACTIONS, &reactions);
    builder.add_function(function::POWER, &[power]);
    builder.add_function(function::OUTPUTS, &derivation.outputs);
    builder.add_function(function::POSITIONS, &positions);
    builder.add_function(function::DOMAIN, domain);
    builder.add_function(function::PIVOTS, constant_pivots);
    for (j, xi) in derivation.frame.operators.xi.iter().enumerate() {
        builder.add_function(&format!("xi_{j}"), xi);
    }
    for (name, coefficients) in &brackets {
        builder.add_function(name, coefficients);
    }
    builder.finish()
}

fn report(model: &mut Model<'_>, error: DerivationError, faults: &mut Faults) {
    match error {
        DerivationError::SingularForms(singular) => report_singular_forms(model, singular, faults),
        DerivationError::NotQuadratic(part) => {
            let place = model.kinetic_energy_span.unwrap_or(model.declaration.name.span());
            let text = short(model, part.part);
            faults.report(
                Fault::new(place, "the kinetic energy is not quadratic in the velocities")
                    .note(format!("`{text}` is not a polynomial of degree two in them")),
            );
        }
        DerivationError::SingularMass(rows) => {
            let names: Vec<&str> = rows.iter().map(|s| model.forms[*s].name.as_str()).collect();
            let place =
                rows.first().map_or(model.declaration.name.span(), |s| model.forms[*s].written.span());
            let fault = if let [name] = names[..] {
                Fault::new(place, format!("cannot solve for the accelerations: `{name}` is without inertia"))
            } else {
                Fault::new(
                    place,
                    format!(
                        "cannot solve for the accelerations: a combination of {} is without inertia",
                        quoted(names)
                    ),
                )
            };
            faults.report(
                fault.note("the mass matrix is singular as a function: give every degree of freedom a mass"),
            );
        }
        DerivationError::RoutesDisagree { equation } => {
            let name = &model.forms[equation].name;
            faults.report(
                Fault::new(
                    model.declaration.name.span(),
                    format!("guen derived two different equations for `{name}`: this is a bug of guen"),
                )
                .help("please report it with this declaration"),
            );
        }
    }
}

fn report_singular_forms(model: &mut Model<'_>, singular: SingularForms, faults: &mut Faults) {
    let Some((last, _)) = singular.combination.last().cloned() else {
        faults.report(Fault::new(model.declaration.name.span(), "the forms are linearly dependent"));
        return;
    };
    let form = &model.forms[last];
    let (place, name, kind) = (form.written.span(), form.name.clone(), form.kind);
    let others: Vec<usize> = singular.combination.iter().map(|(j, _)| *j).filter(|j| *j != last).collect();
    let other_names = quoted(others.iter().map(|j| model.forms[*j].name.as_str()));
    let only_constraints =
        singular.combination.iter().all(|(j, _)| model.forms[*j].kind != FormKind::Parameter);
    let known = singular.combination.iter().all(|(_, c)| c.is_some());
    let combination: Vec<(ExprId, &str)> = singular
        .combination
        .iter()
        .filter(|(j, _)| *j != last)
        .filter_map(|(j, c)| c.map(|c| (c, model.forms[*j].name.as_str())))
        .collect();
    let written = known.then(|| model.bench.graph.text_sum(&combination));
    let mut fault = match (only_constraints, singular.rest) {
        (true, Some(rest)) => match model.bench.verdict_on_manifold(rest) {
            Verdict::Zero => Fault::new(place, format!("constraint `{name}` is redundant"))
                .help(format!("delete `{name}` and add a parameter")),
            _ if model.bench.graph.as_number(rest).is_some() => {
                Fault::new(place, format!("constraint `{name}` contradicts {other_names}"))
            }
            _ => {
                let text = short(model, rest);
                Fault::new(place, format!("constraint `{name}` leaves no velocity beside {other_names}"))
                    .note(format!("together they require `{text} = 0`"))
                    .help(format!("declare it under `holonomic`: `{name}: {text} = 0;`"))
            }
        },
        _ => {
            let noun = if kind == FormKind::Parameter { "parameter" } else { "constraint" };
            let fault = Fault::new(place, format!("{noun} `{name}` is linearly dependent on {other_names}"));
            if kind == FormKind::Holonomic {
                fault.note(format!("`{name}` enters as its rate"))
            } else {
                fault
            }
        }
    };
    if let Some(written) = written {
        fault = fault.note(format!("in the velocities, `{name}` = {written}"));
    }
    faults.report(fault);
}

fn report_missing_momenta(model: &mut Model<'_>, derivation: &mut Derivation, faults: &mut Faults) {
    if model.has_masses {
        return;
    }
    for (v, r, s) in derivation.missing_momenta(&mut model.bench) {
        let form = &model.forms[v];
        if form.mentioned_in_energy {
            continue;
        }
        let name = form.name.clone();
        let c = derivation.frame.brackets.coefficient(&mut model.bench, r, s, v + 1);
        let text = short(model, c);
        let place = model.kinetic_energy_span.unwrap_or(Span::call_site());
        faults.report(
            Fault::new(place, format!("the kinetic energy lacks the momentum of `{name}`"))
                .note(format!("(2.7) needs it, because `{name}` is not integrable: (X{r}, X{s}) contains {text} X{}", v + 1))
                .help(format!("write T° in the velocities, with constraints dropped; `+ 0*{name}` states that it is truly zero")),
        );
    }
}

/// The text of an expression for a message.
fn short(model: &Model<'_>, e: ExprId) -> String {
    const LONGEST: usize = 200;
    model.bench.graph.text_limited(e, LONGEST).unwrap_or_else(|| "..".to_owned())
}
