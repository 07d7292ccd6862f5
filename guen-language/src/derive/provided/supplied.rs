//! Functions that the program supplies: how often they are differentiated.

use guen_symbolic::{Instruction, Multivariate, Operation};

use crate::derive::level::DerivedLevel;
use crate::diagnostics::{Fault, Faults};
use crate::limits::MAX_DERIVATIVES;
use crate::model::Model;

/// Reports functions of which some level needs a derivative of a higher order than one evaluation computes.
pub(in crate::derive) fn check(model: &Model<'_>, levels: &[&DerivedLevel], faults: &mut Faults) {
    let mut highest = vec![0; model.functions.len()];
    if highest.is_empty() {
        return;
    }
    for programs in levels.iter().flat_map(|level| [Some(&level.programs), level.placed.as_ref()]).flatten() {
        let functions = programs.functions.iter().map(|function| &function.instructions);
        for instruction in functions.chain([&programs.prepare]).flatten() {
            if let Some((function, order)) = derivative(instruction) {
                let highest = &mut highest[function];
                *highest = order.max(*highest);
            }
        }
    }
    for (function, order) in model.functions.iter().zip(highest) {
        if order > MAX_DERIVATIVES {
            let name = &function.name;
            let text = format!(
                "the equations need the derivatives of `{name}` up to order {order}, and those up to {MAX_DERIVATIVES} are computed"
            );
            faults.report(
                Fault::new(name.span(), text)
                    .help("declare what needs them as an expression, `fn name(x) = e;`, or leave it out"),
            );
        }
    }
}

/// The function that an instruction calls, with the order of its derivative.
fn derivative(instruction: &Instruction) -> Option<(usize, usize)> {
    match &instruction.operation {
        Operation::Apply(Multivariate::Supplied { function, orders }, _) => {
            Some((usize::from(*function), orders.iter().map(|count| usize::from(*count)).sum()))
        }
        _ => None,
    }
}
