//! The cheapest programs for the functions of a scene.

use std::rc::Rc;

use guen_symbolic::{
    Derivation, ExprId, Programs, Rational, Role, Substitution, SymbolId, Verdict, Workbench, evaluate_f64,
    evaluate_function, evaluate_prepare,
};

use crate::derive::function;
use crate::derive::level::DerivedLevel;
use crate::derive::quantities::domain::{Singularity, constant_pivots, domain, reason, written};
use crate::derive::quantities::parts::Functions;
use crate::derive::quantities::programs::{extend, programs};
use crate::derive::selections::selection::Selection;
use crate::model::{FixedConstant, Model};

/// The cheapest programs of a scene, and whether its right-hand side is a part of the whole system's.
///
/// Rates that are optimised together with those that left may share what they do not share alone, so that a part of the
/// larger program is tried beside a program of its own: the whole system's where nothing was fixed, so that every result
/// is the same to the bit; else that of the system at the fixed values.
///
/// Where each of these takes more operations than the right-hand side of the whole system, the latter is used, with the values that the
/// scene fixes. What it divides by and the scene's own does not is added to the functions that must not vanish.
pub(super) fn cheapest(
    model: &mut Model<'_>,
    (whole, derivation): (&DerivedLevel, &Rc<Derivation>),
    selection: &Selection,
    fixes: &[FixedConstant<'_>],
    mut lists: Vec<Vec<ExprId>>,
    mut kept: Vec<Vec<ExprId>>,
    functions: &mut Functions,
) -> (Programs, bool) {
    let parts = &functions.parts;
    let shares = Rc::ptr_eq(derivation, &whole.derivation) && selection.held.is_empty();
    let system = shares.then_some(&whole.programs);
    let fixed = fixes.iter().map(|fix| (fix.symbol, fix.value));
    let held = selection.held.iter().map(|held| (model.variable(held.place), held.symbol));
    let values: Vec<(ExprId, ExprId)> = fixed.chain(held).collect();
    extend(&mut model.bench, &mut kept);
    let quantities: Vec<_> = parts.iter().map(|part| (part.name, part.outputs.clone())).collect();
    let alone = programs(&mut model.bench, &kept, &quantities);
    let mut wanted = vec![(function::RHS, selection.variables.clone())];
    let part = match system {
        Some(system) => {
            let shared = parts.iter().filter_map(|part| Some((part.name, part.places.clone()?)));
            wanted.extend(shared);
            let mut part = system.part(&wanted);
            let own = parts.iter().filter(|part| part.places.is_none());
            let own: Vec<_> = own.map(|part| (part.name, part.outputs.clone())).collect();
            if !own.is_empty() {
                part.append(programs(&mut model.bench, &[], &own));
            }
            Some(part)
        }
        None if selection.variables.len() == lists[0].len() => None,
        None => {
            extend(&mut model.bench, &mut lists);
            wanted.extend(parts.iter().map(|part| (part.name, (0..part.outputs.len()).collect())));
            Some(programs(&mut model.bench, &lists, &quantities).part(&wanted))
        }
    };
    let cost = |programs: &Programs| programs.functions[0].cost.weighted();
    let part = part.filter(|part| cost(part) <= cost(&alone) && fits(model, selection, part));
    let best = part.as_ref().map_or(cost(&alone), cost);
    if best > cost(&whole.programs)
        && let Some(rates) = at_values(model, (whole, derivation), selection, &values, (&kept[0], functions))
    {
        return (rates, false);
    }
    match part {
        Some(part) => (part, shares),
        None => (alone, false),
    }
}

/// Returns the divisors of the whole system at some values that the scene does not have, each with its text; `None`
/// where one may be zero everywhere.
fn further_divisors(
    model: &mut Model<'_>,
    whole: &DerivedLevel,
    derivation: &Derivation,
    values: &[(ExprId, ExprId)],
) -> Option<Vec<(ExprId, String)>> {
    let divisors = |model: &Model<'_>, derivation: &Derivation| -> Vec<Singularity> {
        let constants = constant_pivots(derivation).into_iter().map(|function| {
            let (text, words) = Default::default();
            Singularity { function, text, words, origin: String::new(), is_determinant: false }
        });
        domain(model, derivation, &whole.shown).into_iter().chain(constants).collect()
    };
    let (of_whole, own) = (divisors(model, &whole.derivation), divisors(model, derivation));
    let bench = &mut model.bench;
    let mut at_values = Substitution::new(values.iter().copied());
    let mut known: Vec<ExprId> =
        own.iter().map(|singularity| at_values.of(&mut bench.graph, singularity.function)).collect();
    let mut found = Vec::new();
    for singularity in of_whole {
        let e = at_values.of(&mut bench.graph, singularity.function);
        let e = bench.tidy(e);
        if bench.verdict_on_manifold(e) != Verdict::Nonzero {
            return None;
        }
        let mut is_number = |divided: ExprId, by: ExprId| {
            let quotient = bench.graph.div(divided, by);
            let quotient = bench.tidy(quotient);
            bench.graph.as_number(quotient).is_some()
        };
        // The determinant of a block is the same, in whatever order it was eliminated.
        let is_same = |other: &Singularity| singularity.is_determinant && other.words == singularity.words;
        let is_known = own.iter().any(is_same) || known.iter().any(|other| is_number(e, *other));
        if !is_known && !bench.graph.manifestly_nonzero(e) {
            known.push(e);
            found.push((e, singularity.words));
        }
    }
    let told = |(e, words): (ExprId, String)| (e, written(model, e, &words));
    Some(found.into_iter().map(told).collect())
}

/// The right-hand side of the whole system with what a scene fixes and holds at its values, and the scene's functions. What it
/// reads and does not depend on is a number at which it has the values of the scene's rates.
fn at_values(
    model: &mut Model<'_>,
    (whole, derivation): (&DerivedLevel, &Derivation),
    selection: &Selection,
    values: &[(ExprId, ExprId)],
    (rates, functions): (&[ExprId], &mut Functions),
) -> Option<Programs> {
    let part = whole.programs.part(&[(function::RHS, selection.variables.clone())]);
    let kept: Vec<SymbolId> = kept(model, selection).collect();
    let bench = &mut model.bench;
    let fixed: Vec<SymbolId> = values.iter().filter_map(|(e, _)| bench.graph.as_symbol(*e)).collect();
    let mut idle: Vec<SymbolId> = part.functions.first()?.symbols().collect();
    idle.retain(|symbol| {
        let is_given = matches!(bench.graph.symbol_info(*symbol).role, Role::Time | Role::Constant);
        !is_given && !kept.contains(symbol) && !fixed.contains(symbol)
    });
    let symbols: Vec<SymbolId> = fixed.iter().chain(&idle).copied().collect();
    // Of what the rates do not depend on one number is as good as another, if they are defined there.
    let numbers = [(0, 1), (1, 1), (1, 2), (-1, 3)];
    let tried = if idle.is_empty() { 1 } else { numbers.len() };
    for (n, d) in &numbers[..tried] {
        let bench = &mut model.bench;
        let number = bench.graph.number(Rational::new(*n, *d));
        let idle = idle.iter().map(|symbol| (bench.graph.symbol_expr(*symbol), number));
        let all: Vec<(ExprId, ExprId)> = values.iter().copied().chain(idle).collect();
        let mut found = part.clone();
        if !all.is_empty() {
            let given = programs(bench, &[], &[("values", all.iter().map(|(_, value)| *value).collect())]);
            found = part.with_values(&symbols, &given);
        }
        if all.len() > values.len() && !agrees(bench, &found, rates) {
            continue;
        }
        let Some(divisors) = further_divisors(model, whole, derivation, &all) else { continue };
        let quantities = functions.with_divisors(&divisors, &model.bench.graph);
        found.append(programs(&mut model.bench, &[], &quantities));
        if fits(model, selection, &found) {
            for (e, told) in divisors {
                if model.bench.graph.roles(e).is_constant() {
                    functions.constant_pivots.push(e);
                } else {
                    functions.domain.push(e);
                    functions.domain_names.push(told);
                    let origin = "the rates of the whole system are not finite";
                    functions.domain_reasons.push(reason(&model.bench.graph, e, origin));
                }
            }
            return Some(found);
        }
    }
    None
}

/// Whether a program has the values of expressions at some points, to rounding.
fn agrees(bench: &Workbench, found: &Programs, expected: &[ExprId]) -> bool {
    const AGREEMENT: f64 = 1e-9;
    (1..=4).all(|round| {
        let value =
            |symbol: SymbolId| 0.3 + f64::from(round) * (symbol.index() as f64 * 2.3).sin().abs() / 3.0;
        let wanted = evaluate_f64(&bench.graph, expected, &value);
        let values = evaluate_function(found, 0, &evaluate_prepare(found, value), value);
        let mut pairs = values.iter().zip(&wanted);
        pairs.all(|(value, wanted)| (value - wanted).abs() <= AGREEMENT * (1.0 + wanted.abs()))
    })
}

/// The symbols of what a scene keeps.
fn kept(model: &Model<'_>, selection: &Selection) -> impl Iterator<Item = SymbolId> {
    let variables = selection.variables.iter().map(|place| model.variable(*place));
    let accelerations = selection.parameters.iter().map(|s| model.mechanics.accelerations[*s]);
    let inputs = selection.inputs.iter().map(|u| model.inputs[*u].symbol);
    variables.chain(accelerations).chain(inputs).filter_map(|e| model.bench.graph.as_symbol(e))
}

/// Whether programs read nothing that left.
fn fits(model: &Model<'_>, selection: &Selection, programs: &Programs) -> bool {
    let graph = &model.bench.graph;
    let kept: Vec<SymbolId> = kept(model, selection).collect();
    let is_everywhere = |name: &str| matches!(name, function::OPERATORS | function::BRACKETS);
    programs.functions.iter().filter(|function| !is_everywhere(&function.name)).all(|function| {
        function.symbols().all(|symbol| {
            matches!(graph.symbol_info(symbol).role, Role::Time | Role::Constant) || kept.contains(&symbol)
        })
    })
}
