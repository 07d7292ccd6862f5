//! The carried form of a level: its elementary functions as states, its rates without calls.

use guen_symbolic::{Carried, CarriedFunction, Contracted, ExprId, NotCarried, ProgramBuilder, Programs};

use crate::derive::function;
use crate::derive::level::DerivedLevel;
use crate::derive::quantities::domain::written;
use crate::derive::quantities::jacobians::Jacobians;
use crate::derive::quantities::programs::extend;
use crate::derive::selections::selection::Selection;
use crate::derive::thresholds::CARRIED_VARIABLE_COST;
use crate::diagnostics::{Fault, Faults};
use crate::model::Model;
use crate::syntax::Name;

/// The carried form of a level whose rates are given in several equal forms; what has none is reported at the word that
/// asks for it.
pub(in crate::derive) fn derive(
    model: &mut Model<'_>,
    level: &DerivedLevel,
    lists: &[Vec<ExprId>],
    word: &Name,
    faults: &mut Faults,
) -> Option<Box<DerivedLevel>> {
    if let Some(function) = model.functions.first() {
        let text = "a system with functions that the program supplies has no carried form";
        let fault = Fault::new(word.span(), text).note(format!("`{}` is one", function.name));
        faults.report(fault.help("leave `carried` out"));
        return None;
    }
    let places = &level.selection.variables;
    let variables: Vec<ExprId> = places.iter().map(|place| model.variable(*place)).collect();
    let taken: Vec<String> = places.iter().map(|place| model.variable_name(*place).to_owned()).collect();
    let mut best: Option<(u64, Carried, Vec<Vec<ExprId>>)> = None;
    for list in lists {
        let carried = match Carried::new(&mut model.bench.graph, &variables, list, &taken) {
            Ok(carried) => carried,
            Err(refused) => {
                faults.report(refusal(model, refused, word));
                return None;
            }
        };
        let rates = carried.rates.iter().chain(carried.functions.iter().map(|f| &f.rate)).copied().collect();
        let mut forms = vec![rates];
        extend(&mut model.bench, &mut forms);
        let cost = programs(model, &forms, None).functions[0].cost.weighted()
            + CARRIED_VARIABLE_COST * carried.functions.len() as u64;
        if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
            best = Some((cost, carried, forms));
        }
    }
    let (_, carried, forms) = best?;
    let programs = programs(model, &forms, Some(&carried));
    let domain_names = carried.edges.iter().map(|e| written(model, *e, "what a carried function divides by"));
    let domain_names: Vec<String> = domain_names.collect();
    let selection = Selection {
        variables: places.clone(),
        coordinates: level.selection.coordinates.clone(),
        parameters: level.selection.parameters.clone(),
        states: level.selection.states.clone(),
        constants: level.selection.constants.clone(),
        held: level.selection.held.clone(),
        inputs: level.selection.inputs.clone(),
        energy: level.selection.energy,
        carried: carried.functions,
        ..Selection::default()
    };
    Some(Box::new(DerivedLevel {
        selection,
        derivation: level.derivation.clone(),
        brackets: level.brackets.clone(),
        rates: carried.rates,
        equations: Vec::new(),
        energy: level.energy,
        programs,
        singularities: domain_names.len(),
        domain: carried.edges,
        domain_names,
        domain_reasons: Vec::new(),
        switches: level.switches.clone(),
        constant_pivots: Vec::new(),
        missing_bounds: None,
        jacobians: Jacobians::default(),
        shown: Contracted::default(),
        placed: None,
        series: None,
        scene: None,
        contacts: None,
        provides_source: false,
        carried: None,
    }))
}

/// The code of the rates, and with the functions that of everything else.
fn programs(model: &mut Model<'_>, forms: &[Vec<ExprId>], carried: Option<&Carried>) -> Programs {
    let mut builder = ProgramBuilder::new(&mut model.bench.graph);
    builder.add_equal(function::RHS, forms);
    if let Some(carried) = carried {
        let of =
            |what: fn(&CarriedFunction) -> ExprId| carried.functions.iter().map(what).collect::<Vec<_>>();
        builder.add_cold(function::CARRY, &of(|function| function.value));
        builder.add_cold(function::RENORMALIZED, &of(|function| function.rejoined));
        builder.add_cold(function::INVARIANTS, &carried.invariants);
        builder.add_cold(function::DOMAIN, &carried.edges);
    }
    builder.finish()
}

fn refusal(model: &Model<'_>, refused: NotCarried, word: &Name) -> Fault {
    match refused {
        NotCarried::Nothing => Fault::new(word.span(), "there is nothing to carry")
            .note("the rates call no elementary function of the state")
            .help("leave it out: the right-hand side is without calls as it is"),
        NotCarried::Supplied(call) => {
            let call = written(model, call, "a long expression");
            Fault::new(word.span(), "a function that the program supplies cannot be carried as a state")
                .note(format!("it is `{call}`, whose rate calls its derivatives"))
                .help("leave `carried` out")
        }
        NotCarried::Input(call) => {
            let call = written(model, call, "a long expression");
            Fault::new(word.span(), "a function of an input cannot be carried as a state")
                .note(format!("it is `{call}`, and jumps where the input does"))
                .help("declare the value of the function as the input")
        }
    }
}
