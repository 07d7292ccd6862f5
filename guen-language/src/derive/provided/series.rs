//! The Taylor series of a level: its recurrences, and what has none.

use guen_symbolic::{Multivariate, Operation, Programs, SeriesProgram, SymbolId, SymbolInStep};
use proc_macro2::Span;

use crate::derive::function;
use crate::derive::level::Series;
use crate::derive::selections::selection::Selection;
use crate::diagnostics::{Fault, Faults};
use crate::limits::MAX_SERIES_SUMS;
use crate::model::Model;

/// The recurrences of the rates of what a level keeps. What has no series is reported at the word `taylor`.
///
/// Where a rate has a kink in an input, or the sums along inputs are too many, there are those with inputs held alone.
pub(in crate::derive) fn of(
    model: &Model<'_>,
    selection: &Selection,
    programs: &Programs,
    word: Span,
    faults: &mut Faults,
) -> Option<Series> {
    let rates = programs.functions.iter().find(|known| known.name == function::RHS)?;
    let graph = &model.bench.graph;
    let time = graph.as_symbol(model.mechanics.forms.time);
    let variables: Vec<Option<SymbolId>> =
        selection.variables.iter().map(|place| graph.as_symbol(model.variable(*place))).collect();
    let place =
        |symbols: &[Option<SymbolId>], symbol| symbols.iter().position(|known| *known == Some(symbol));
    let source = |symbol: SymbolId| {
        if Some(symbol) == time {
            return SymbolInStep::Time;
        }
        place(&variables, symbol).map_or(SymbolInStep::Still, SymbolInStep::State)
    };
    let held = match SeriesProgram::new(rates, source) {
        Ok(series) => series,
        Err(refused) => {
            let function = model.called(&refused.operation);
            let variable = model.variable_name(selection.variables[refused.output]);
            let is_supplied = matches!(refused.operation, Operation::Apply(Multivariate::Supplied { .. }, _));
            let text =
                format!("the motion has no Taylor series: the rate of `{variable}` needs `{function}`");
            let fault = Fault::new(word, text);
            faults.report(match is_supplied {
                true => fault
                    .note(format!("the program supplies `{function}` with derivatives of a few orders, and a series takes twenty"))
                    .help("leave `taylor` out and integrate with another method"),
                false => fault
                    .note(format!("at a kink of `{function}` a series goes on as if there were none, and nothing would tell"))
                    .help("leave `taylor` out and integrate with another method, which locates the kink"),
            });
            return None;
        }
    };
    if held.sums.len() > MAX_SERIES_SUMS {
        let text = format!(
            "the Taylor series needs {} sums of products, and {MAX_SERIES_SUMS} are allowed",
            held.sums.len()
        );
        faults.report(
            Fault::new(word, text)
                .note("while a series is computed its coefficients are on the stack, about 450 bytes for each sum")
                .help("leave `taylor` out, or provide it in a scene that keeps fewer variables"),
        );
        return None;
    }
    let inputs: Vec<Option<SymbolId>> =
        selection.inputs.iter().map(|u| graph.as_symbol(model.mechanics.inputs[*u])).collect();
    let moving = |symbol| place(&inputs, symbol).map_or_else(|| source(symbol), SymbolInStep::Input);
    let along_inputs = (!inputs.is_empty())
        .then(|| SeriesProgram::new(rates, moving).ok())
        .flatten()
        .filter(|series| series.sums.len() <= MAX_SERIES_SUMS);
    Some(Series { held, along_inputs })
}
