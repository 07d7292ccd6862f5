//! The parts of a derived system that controllers use, as expressions: the leaf, the equations apart, the covector of
//! reactions.

use guen_symbolic::{Derivation, ExprId, Role, Roles, Substitution, Workbench};

use super::formulas::Quantity;
use crate::derive::function;

/// The integrable combinations of constraints whose coefficients are known, as places in the list of all.
pub(crate) fn known_combinations(derivation: &Derivation) -> Vec<usize> {
    let all = derivation.closure.integrable.iter().enumerate();
    all.filter(|(_, combination)| combination.terms.iter().all(|(_, c)| c.is_some()))
        .map(|(i, _)| i)
        .collect()
}

/// Whether the reactions of all constraints are known, so that their sum is.
pub(crate) fn has_covector(derivation: &Derivation) -> bool {
    !derivation.reactions.is_empty() && derivation.reactions.iter().all(Option::is_some)
}

/// The functions and what they compute.
pub(crate) fn quantities(bench: &mut Workbench, derivation: &Derivation) -> Vec<Quantity> {
    let MassForm { entries, forced } = mass_form(bench, derivation);
    let mut found = vec![(function::LEAF, leaf(bench, derivation)), (function::MASS_FORM, entries)];
    if forced {
        found.push((function::COASTING, coasting(bench, derivation)));
    }
    if has_covector(derivation) {
        found.push((function::REACTION_COVECTOR, covector(bench, derivation)));
    }
    found
}

/// `sum_v f_v a_vi` of every integrable combination `sum_v f_v eta_v`, row by row.
fn leaf(bench: &mut Workbench, derivation: &Derivation) -> Vec<ExprId> {
    let forms = &derivation.system.forms.forms;
    let mut rows = Vec::new();
    for place in known_combinations(derivation) {
        let terms = &derivation.closure.integrable[place].terms;
        for i in 0..forms.len() {
            let parts = terms.iter().filter_map(|(v, f)| Some(((*f)?, forms[*v].row[i])));
            let parts: Vec<ExprId> = parts.map(|(f, a)| bench.graph.mul(f, a)).collect();
            let sum = bench.graph.sum(parts);
            rows.push(bench.tidy(sum));
        }
    }
    rows
}

/// The equations apart, `M eta' + bias = G u`.
struct MassForm {
    /// The lower triangle of `M`, row by row, then the bias, then `G`.
    entries: Vec<ExprId>,
    /// Whether the bias has a part of declared forces.
    forced: bool,
}

fn mass_form(bench: &mut Workbench, derivation: &Derivation) -> MassForm {
    let equations = &derivation.equations;
    let inputs = &derivation.system.inputs;
    let mut list: Vec<ExprId> =
        equations.mass.iter().enumerate().flat_map(|(s, row)| row[..=s].iter().copied()).collect();
    let slopes: Vec<Vec<ExprId>> = equations
        .forces
        .iter()
        .map(|force| inputs.iter().map(|input| bench.partial(*force, *input)).collect())
        .collect();
    let driven = Roles::of(Role::Input);
    let is_affine = !slopes.iter().flatten().any(|slope| bench.graph.roles(*slope).meets(driven));
    let zero = bench.graph.zero();
    let mut idle = Substitution::new(inputs.iter().map(|input| (*input, zero)));
    for (force, slopes) in equations.forces.iter().zip(&slopes) {
        let free = if is_affine {
            idle.of(&mut bench.graph, *force)
        } else {
            // Exact at these inputs: f - G u.
            let made = bench.dot(slopes, inputs);
            bench.graph.sub(*force, made)
        };
        list.push(bench.graph.neg(free));
    }
    let forced = !is_affine
        || derivation.generalised_forces.iter().any(|force| {
            let free = idle.of(&mut bench.graph, *force);
            !bench.graph.is_zero(free)
        });
    list.extend(slopes.into_iter().flatten());
    MassForm { entries: list, forced }
}

/// The bias without the declared forces. They are taken away here and not from values of the bias: there they may be infinite,
/// or so large that nothing is left of the rest.
fn coasting(bench: &mut Workbench, derivation: &Derivation) -> Vec<ExprId> {
    let forces = derivation.equations.forces.iter().zip(&derivation.generalised_forces);
    forces.map(|(force, generalised)| bench.graph.sub(*generalised, *force)).collect()
}

/// `R_i = sum_v lambda_v a_vi`.
fn covector(bench: &mut Workbench, derivation: &Derivation) -> Vec<ExprId> {
    let forms = &derivation.system.forms;
    (0..forms.len())
        .map(|i| {
            let parts = derivation.reactions.iter().zip(&forms.forms[forms.degrees..]);
            let parts: Vec<ExprId> = parts
                .filter_map(|(reaction, form)| Some(bench.graph.mul((*reaction)?, form.row[i])))
                .collect();
            bench.graph.sum(parts)
        })
        .collect()
}
