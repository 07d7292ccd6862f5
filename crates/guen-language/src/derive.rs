//! From the model to what is emitted: the derivation, its faults in the user's names, and the programs.

use guen_symbolic::{
    Derivation, DerivationError, ExprId, Limits, MAX_WORK, ProgramBuilder, Programs, SingularForms, Verdict,
    Workbench, normal_coefficients, normal_form, weighted_cost,
};

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
    /// The same in words.
    pub domain_names: Vec<String>,
    /// Expressions of constants that must not vanish.
    pub constant_pivots: Vec<ExprId>,
}

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
    /// The holonomic constraints.
    pub const POSITIONS: &str = "positions";
    /// The holonomic constraints and then their derivatives, row by row; only where there are some.
    pub const GRADIENTS: &str = "gradients";
    /// The functions that must not vanish.
    pub const DOMAIN: &str = "domain";
    /// The expressions of constants that must not vanish.
    pub const PIVOTS: &str = "pivots";
    /// The coefficients of `X_0`, then of `X_1`, and so on.
    pub const OPERATORS: &str = "operators";
    /// The coefficients of the brackets that do not vanish, in the order of [`bracket_pairs`](super::bracket_pairs).
    pub const BRACKETS: &str = "brackets";
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
    crate::scenes::report(&mut model, &derivation, faults);
    if faults.count() > before {
        return None;
    }
    polish(&mut model, &mut derivation);
    let (domain, domain_names) = domain(&model, &derivation);
    let constant_pivots: Vec<ExprId> = derivation
        .frame
        .operators
        .constant_pivots
        .iter()
        .chain(&derivation.solution.constant_pivots)
        .copied()
        .collect();
    let programs = programs(&mut model, &mut derivation, &domain, &constant_pivots);
    Some(Derived { model, derivation, programs, domain, domain_names, constant_pivots })
}

/// Energies, momenta and reactions as polynomials in the quasi-velocities, where that is cheaper.
fn polish(model: &mut Model<'_>, derivation: &mut Derivation) {
    let system = &derivation.system;
    let variables: Vec<ExprId> = system.accelerations.iter().chain(&system.etas).copied().collect();
    // What is larger is read by nobody, and seldom gets cheaper.
    let limits = Limits { nodes: 400, steps: 6_000, ..Limits::default() };
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

/// The functions that must not vanish, and how they are written: large determinants by their rows.
fn domain(model: &Model<'_>, derivation: &Derivation) -> (Vec<ExprId>, Vec<String>) {
    const LONGEST: usize = 400;
    let graph = &model.bench.graph;
    let written =
        |e: &ExprId, otherwise: &str| (*e, graph.text_limited(*e, LONGEST).unwrap_or(otherwise.to_owned()));
    let chart = derivation.frame.operators.chart.iter().map(|e| written(e, "a factor of det A"));
    let pivots = derivation.solution.pivots.iter().map(|e| written(e, "a pivot of the mass matrix"));
    let determinants = derivation.solution.determinants.iter().map(|(rows, e)| {
        let names: Vec<&str> = rows.iter().map(|s| model.forms[*s].name.as_str()).collect();
        (*e, format!("det M[{}]", names.join(", ")))
    });
    chart.chain(pivots).chain(determinants).unzip()
}

/// The pairs `r < s` of `X_0 .. X_l` whose bracket does not vanish identically.
pub fn bracket_pairs(bench: &mut Workbench, derivation: &mut Derivation) -> Vec<(usize, usize)> {
    let (n, l) = (derivation.system.forms.len(), derivation.system.forms.degrees);
    let brackets = &mut derivation.frame.brackets;
    let pairs = (1..=l).flat_map(|s| (0..s).map(move |r| (r, s)));
    let mut found: Vec<(usize, usize)> = Vec::new();
    for (r, s) in pairs {
        if (1..=n).any(|t| {
            let c = brackets.coefficient(bench, r, s, t);
            !bench.graph.is_zero(c)
        }) {
            found.push((r, s));
        }
    }
    found
}

fn programs(
    model: &mut Model<'_>,
    derivation: &mut Derivation,
    domain: &[ExprId],
    constant_pivots: &[ExprId],
) -> Programs {
    let n = derivation.system.forms.len();
    let bench = &mut model.bench;
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
    let reactions: Vec<ExprId> = derivation.reactions.iter().flatten().copied().collect();
    let positions: Vec<ExprId> = derivation.system.holonomic.iter().map(|h| h.equation).collect();
    let rows = derivation.system.holonomic.iter().map(|h| &derivation.system.forms.forms[h.form].row);
    let gradients: Vec<ExprId> = positions.iter().chain(rows.flatten()).copied().collect();
    let rates: Vec<ExprId> =
        derivation.frame.velocities.iter().chain(&derivation.solution.accelerations).copied().collect();
    let limits = Limits::default();
    // Beyond this estimate normal forms run into their limits, and only cost time.
    const LARGEST_WRITTEN_OUT: u64 = 600;
    let mut lists = vec![rates];
    lists.extend(derivation.alternatives.iter().cloned());
    let mut estimates: Vec<u64> = lists.iter().map(|list| weighted_cost(&bench.graph, list)).collect();
    let best = (0..lists.len()).min_by_key(|i| estimates[*i]).unwrap_or_default();
    if estimates[best] <= LARGEST_WRITTEN_OUT {
        let written_out: Vec<ExprId> =
            lists[best].iter().map(|e| normal_form(&mut bench.graph, *e, &limits).unwrap_or(*e)).collect();
        estimates.insert(1, weighted_cost(&bench.graph, &written_out));
        lists.insert(1, written_out);
    }
    // A form may come out cheaper although it looks dearer, but hardly by more than half.
    let most = 3 * estimates.iter().copied().min().unwrap_or_default() / 2;
    let mut estimate = estimates.into_iter();
    lists.retain(|_| estimate.next().is_some_and(|cost| cost <= most));
    let brackets: Vec<Vec<ExprId>> = bracket_pairs(bench, derivation)
        .into_iter()
        .map(|(r, s)| (1..=n).map(|t| derivation.frame.brackets.coefficient(bench, r, s, t)).collect())
        .collect();
    let mut builder = ProgramBuilder::new(&mut bench.graph);
    let energies = &derivation.energies;
    builder.add_equal(function::RHS, &lists);
    builder.add_cold(function::VELOCITIES, &derivation.frame.velocities);
    builder.add_cold(function::FORMS, &forms);
    builder.add_cold(function::ENERGY, &[energies.integral]);
    builder.add_cold(function::KINETIC_ENERGY, &[energies.kinetic]);
    builder.add_cold(function::FORCE_FUNCTION, &[derivation.system.force_function]);
    let momenta: Vec<ExprId> = energies
        .momenta
        .iter()
        .zip(&derivation.known_momentum)
        .filter(|(_, known)| **known)
        .map(|(e, _)| *e)
        .collect();
    builder.add_cold(function::MOMENTA, &momenta);
    builder.add_cold(function::REACTIONS, &reactions);
    builder.add_cold(function::POWER, &[derivation.power]);
    builder.add_cold(function::OUTPUTS, &derivation.outputs);
    builder.add_cold(function::POSITIONS, &positions);
    if !gradients.is_empty() {
        builder.add_cold(function::GRADIENTS, &gradients);
    }
    builder.add_cold(function::DOMAIN, domain);
    builder.add_cold(function::PIVOTS, constant_pivots);
    // All operators in one function, and all brackets in another: they share the inverse of the forms.
    builder.add_cold(function::OPERATORS, &derivation.frame.operators.xi.concat());
    builder.add_cold(function::BRACKETS, &brackets.concat());
    builder.finish()
}

fn report(model: &mut Model<'_>, error: DerivationError, faults: &mut Faults) {
    match error {
        DerivationError::SingularForms(all) => {
            for singular in all {
                report_singular_forms(model, singular, faults);
            }
        }
        DerivationError::NotQuadratic(part) => {
            let place = model.kinetic_energy_span.unwrap_or(model.declaration.name.span());
            let text = short(model, part.part);
            faults.report(
                Fault::new(place, "the kinetic energy is not quadratic in the velocities")
                    .note(format!("`{text}` is not a polynomial of degree two in them")),
            );
        }
        DerivationError::SingularMass(motion) => report_singular_mass(model, &motion, faults),
        DerivationError::TooLarge => {
            faults.report(
                Fault::new(model.declaration.name.span(), "the equations of this system are too large to derive")
                    .note(format!("the derivation was given up after {MAX_WORK} steps"))
                    .help("choose parameters in which the velocities are short, or coordinates with fewer products of angles"),
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

/// A motion without inertia: one parameter, or a combination that is spelled out.
fn report_singular_mass(model: &mut Model<'_>, motion: &[(usize, Option<ExprId>)], faults: &mut Faults) {
    let name = |s: usize| model.forms[s].name.as_str();
    let place = motion.last().map_or(model.declaration.name.span(), |(s, _)| model.forms[*s].written.span());
    let fault = if let [(s, _)] = motion {
        let name = name(*s);
        Fault::new(place, format!("cannot solve for the accelerations: `{name}` is without inertia"))
            .note(format!("the kinetic energy does not depend on `{name}`"))
    } else {
        let names = quoted(motion.iter().map(|(s, _)| name(*s)));
        let fault = Fault::new(
            place,
            format!("cannot solve for the accelerations: a combination of {names} is without inertia"),
        );
        let values: Option<Vec<String>> = motion
            .iter()
            .map(|(s, value)| Some(format!("`{} = {}`", name(*s), short(model, (*value)?))))
            .collect();
        match values {
            Some(values) => fault.note(format!("a motion with {} has no kinetic energy", values.join(", "))),
            None => fault,
        }
    };
    faults.report(fault.help("give every degree of freedom a mass or an inertia"));
}

fn report_singular_forms(model: &mut Model<'_>, singular: SingularForms, faults: &mut Faults) {
    let SingularForms { mut combination, rest } = singular;
    if combination.is_empty() {
        faults.report(Fault::new(model.declaration.name.span(), "the forms are linearly dependent"));
        return;
    }
    let kind = |model: &Model<'_>, j: usize| model.forms[j].kind;
    // The row to blame is the last one; a constraint before the rate of a holonomic one.
    if kind(model, combination[combination.len() - 1].0) == FormKind::Holonomic
        && let Some(i) = combination.iter().rposition(|(j, _)| kind(model, *j) == FormKind::Constraint)
    {
        let blamed = combination.remove(i);
        combination.push(blamed);
    }
    let Some((last, others)) = combination.split_last() else { return };
    let (last, divisor) = *last;
    let form = &model.forms[last];
    let (place, name) = (form.written.span(), form.name.clone());
    let noun = if form.kind == FormKind::Parameter { "parameter" } else { "constraint" };
    let other_names = quoted(others.iter().map(|(j, _)| model.forms[*j].name.as_str()));
    let rates: Vec<&str> = others
        .iter()
        .map(|(j, _)| *j)
        .chain([last])
        .filter(|j| kind(model, *j) == FormKind::Holonomic)
        .map(|j| model.forms[j].name.as_str())
        .collect();
    let rates = (!rates.is_empty()).then(|| {
        let (enter, their) = if rates.len() == 1 { ("enters", "its rate") } else { ("enter", "their rates") };
        format!("{} {enter} by {their}", quoted(rates))
    });
    let only_constraints = combination.iter().all(|(j, _)| kind(model, *j) != FormKind::Parameter);
    // `name = sum c_j name_j` from `0 = d name + sum d_j name_j`.
    let terms: Option<Vec<(usize, ExprId)>> = others
        .iter()
        .map(|(j, c)| {
            let bench = &mut model.bench;
            let opposite = bench.graph.neg((*c)?);
            let quotient = bench.graph.div(opposite, divisor?);
            Some((*j, bench.tidy(quotient)))
        })
        .collect();
    let one = model.bench.graph.one();
    let single = match terms.as_deref() {
        Some([(j, c)]) if *c == one && kind(model, *j) == FormKind::Holonomic => Some(*j),
        _ => None,
    };
    let rest = rest.filter(|_| only_constraints);
    let mut fault = match rest.map(|rest| (rest, model.bench.verdict_on_manifold(rest))) {
        Some((_, Verdict::Zero)) => {
            let fault = match single {
                Some(j) => {
                    let holonomic = &model.forms[j].name;
                    Fault::new(place, format!("constraint `{name}` is the rate of `{holonomic}`"))
                }
                None => Fault::new(place, format!("constraint `{name}` is redundant beside {other_names}")),
            };
            if name == model.forms[last].written.text {
                fault.help(format!("delete `{name}`, and declare one more parameter"))
            } else {
                let whole = &model.forms[last].written.text;
                fault.help(format!(
                    "impose the other components of `{whole}` one by one, as `{whole}_x: inner(e, vec(1, 0, 0)) = 0;`"
                ))
            }
        }
        Some((rest, _)) if model.bench.graph.roles(rest).is_constant() => {
            let text = short(model, rest);
            let number = model.bench.graph.as_number(rest).is_some();
            let unless = if number { String::new() } else { format!(" unless `{text} = 0`") };
            let fault = Fault::new(place, format!("constraint `{name}` contradicts {other_names}{unless}"));
            let fault =
                if number { fault.note(format!("together they require `{text} = 0`")) } else { fault };
            fault.help(format!("delete `{name}`, and declare one more parameter"))
        }
        Some((rest, _)) => {
            let text = short(model, rest);
            Fault::new(place, format!("the velocities of constraint `{name}` are those of {other_names}"))
                .note(format!("together they require `{text} = 0`"))
                .help(format!("declare it under `holonomic`: `{name}: {text} = 0;`"))
        }
        None => match single {
            Some(j) => {
                let holonomic = &model.forms[j].name;
                Fault::new(place, format!("{noun} `{name}` is the rate of `{holonomic}`"))
                    .note(format!("`{holonomic}` keeps it zero"))
            }
            None => Fault::new(place, format!("{noun} `{name}` is linearly dependent on {other_names}")),
        },
    };
    if single.is_none() {
        if let Some(rates) = rates {
            fault = fault.note(rates);
        }
        fault = match &terms {
            Some(terms) => {
                let bench = &mut model.bench;
                let products: Vec<ExprId> =
                    terms.iter().map(|(j, c)| bench.graph.mul(*c, model.mechanics.etas[*j])).collect();
                let sum = bench.graph.sum(products);
                let text = short(model, sum);
                fault.note(format!("in the velocities `{name}` is `{text}`"))
            }
            None => fault,
        };
    }
    let other = others.last().map(|(j, _)| &model.forms[*j]);
    if let Some(other) = other {
        fault = fault.note_place(&format!("`{}` is declared", other.name), other.written.span());
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
        let place = model.kinetic_energy_span.unwrap_or(model.declaration.name.span());
        let parameter = |s: usize| match s.checked_sub(1) {
            None => "the time".to_owned(),
            Some(s) => format!("`{}`", model.forms[s].name),
        };
        faults.report(
            Fault::new(place, format!("the kinetic energy lacks the momentum of `{name}`"))
                .note(format!(
                    "(2.7) needs it: the bracket (X{r}, X{s}) of {} and {} has the component `{text}` along `{name}`",
                    parameter(r),
                    parameter(s)
                ))
                .help(format!(
                    "write the energy in the velocities, with the constraints dropped; `+ 0*{name}` states that the momentum is truly zero"
                )),
        );
    }
}

/// The text of an expression for a message.
fn short(model: &Model<'_>, e: ExprId) -> String {
    const LONGEST: usize = 200;
    model.bench.graph.text_limited(e, LONGEST).unwrap_or_else(|| "..".to_owned())
}
