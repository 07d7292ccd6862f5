//! The reason why a checked model has no equations of motion, in the user's names.

use guen_symbolic::{
    COUPLED_COORDINATES, Derivation, DerivationError, ExprId, MAX_WORK, SingularForms, Verdict,
};

use proc_macro2::Span;

use crate::diagnostics::{Fault, Faults};
use crate::model::{FormKind, Model};
use crate::names::quoted;

pub(super) fn report(model: &mut Model<'_>, error: DerivationError, faults: &mut Faults) {
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
        DerivationError::TooManyCoordinates => {
            let text = format!(
                "more than {COUPLED_COORDINATES} coordinates, and what they have between them is not sparse"
            );
            faults.report(
                Fault::new(model.declaration.name.span(), text)
                    .note("beyond this number a system has no constraints and no bodies that turn, and its kinetic energy is that of particles that move by themselves, or relative to few others with few roots in the energies")
                    .help("declare fewer coordinates, or particles in their place"),
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

/// The fault of an equation of positions whose rate is a combination of those of others, with these coefficients where they are known.
fn dependent_position(
    model: &mut Model<'_>,
    (form, place): (usize, Span),
    terms: Option<&[(usize, ExprId)]>,
    others: &str,
) -> Fault {
    let name = model.forms[form].name.clone();
    let equation = |model: &Model<'_>, form: usize| {
        model.mechanics.holonomic.iter().find(|row| row.form == form).map(|row| row.equation)
    };
    // With constant coefficients the equation itself is this combination, up to a constant.
    let rest = terms.and_then(|terms| {
        let mut rest = equation(model, form)?;
        for (other, c) in terms {
            if !model.bench.graph.roles(*c).is_constant() {
                return None;
            }
            let other = equation(model, *other)?;
            let part = model.bench.graph.mul(*c, other);
            rest = model.bench.graph.sub(rest, part);
        }
        Some(model.bench.tidy(rest))
    });
    let fault = match rest {
        Some(rest) if model.bench.vanishes(rest) => {
            Fault::new(place, format!("`{name}` follows from {others}"))
        }
        Some(rest) => Fault::new(place, format!("`{name}` contradicts {others}"))
            .note(format!("together they require `{} = 0`", short(model, rest))),
        None => Fault::new(place, format!("`{name}` changes only with {others}"))
            .note(format!("the rate of `{name}` is a combination of the rates of {others}")),
    };
    fault.help(format!("delete `{name}`"))
}

/// A form without velocities wherever the holonomic constraints hold, and what is left of a constraint there.
fn vanishing(model: &mut Model<'_>, (noun, name, place): (&str, &str, Span), rest: Option<ExprId>) -> Fault {
    let rest = rest.filter(|rest| noun == "constraint" && !model.bench.is_seen_to_vanish(*rest));
    let Some(rest) = rest else {
        return Fault::new(
            place,
            format!("{noun} `{name}` vanishes wherever the holonomic constraints hold"),
        );
    };
    let text = short(model, rest);
    let fault = Fault::new(
        place,
        format!("the velocities of constraint `{name}` vanish wherever the holonomic constraints hold"),
    );
    let fault = fault.note(format!("there it requires `{text} = 0`"));
    match model.bench.graph.roles(rest).is_constant() {
        true => fault,
        false => fault.help(format!("declare it under `holonomic`: `{name}: {text} = 0;`")),
    }
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
    if others.is_empty() {
        let fault = if form.kind == FormKind::Holonomic {
            let fault = Fault::new(place, format!("the rate of `{name}` vanishes wherever `{name}` holds"));
            fault.help("write the constraint so that its gradient differs from zero: `x - y = 0` for `(x - y)^2 = 0`")
        } else {
            vanishing(model, (noun, &name, place), rest)
        };
        faults.report(fault);
        return;
    }
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
    if combination.iter().all(|(j, _)| kind(model, *j) == FormKind::Holonomic) {
        let fault = dependent_position(model, (last, place), terms.as_deref(), &other_names);
        let fault = others.last().map(|(j, _)| &model.forms[*j]).into_iter().fold(fault, |fault, other| {
            fault.note_place(&format!("`{}` is declared", other.name), other.written.span())
        });
        faults.report(fault);
        return;
    }
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
                    "impose the other components of `{whole}` one by one, as `{}: inner(e, vec(1, 0, 0)) = 0;`",
 crate::names::suffixed(whole, "_x")
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

pub(super) fn report_missing_momenta(
    model: &mut Model<'_>,
    derivation: &mut Derivation,
    faults: &mut Faults,
) {
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
pub(super) fn short(model: &Model<'_>, e: ExprId) -> String {
    const MESSAGE_CHARACTERS: usize = 200;
    model.bench.graph.text_limited(e, MESSAGE_CHARACTERS).unwrap_or_else(|| "..".to_owned())
}

/// Outputs that ask for a reaction that the kinetic energy does not determine.
pub(super) fn report_unknown_reactions(model: &Model<'_>, derivation: &Derivation, faults: &mut Faults) {
    let degrees = derivation.system.forms.degrees;
    for (form, span) in &model.reactions {
        if derivation.reactions[*form - degrees].is_none() {
            let name = &model.forms[*form].name;
            faults.report(
                Fault::new(*span, format!("the reaction of `{name}` is not known"))
                    .note(format!("the kinetic energy says nothing of the momentum that goes with `{name}`"))
                    .help("write the energy in the velocities, before the constraint"),
            );
        }
    }
}
