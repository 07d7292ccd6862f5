//! The derivatives that are emitted as code: of the rates, and of the outputs, by state and inputs.

use guen_symbolic::{Pattern, Programs, Role, SymbolId};

use crate::derive::function;
use crate::derive::selections::selection::Selection;
use crate::model::Model;

/// The place of each output of the functions [`function::LINEARIZATION`] and [`function::OUTPUT_LINEARIZATION`] in a
/// matrix with a column for every coordinate, parameter and input; `None` where there is no such function.
#[derive(Clone, Debug, Default)]
pub struct Jacobians {
    /// The derivatives of the rates of the state.
    pub rates: Option<Pattern>,
    /// The derivatives of the outputs.
    pub outputs: Option<Pattern>,
}

impl Jacobians {
    /// Adds the functions to the programs, unless they are too large: then duals do their work.
    pub(crate) fn add(programs: &mut Programs, model: &Model<'_>, selection: &Selection) -> Self {
        if !selection.linearization {
            return Jacobians::default();
        }
        let graph = &model.bench.graph;
        let states = selection.variables.iter().map(|place| model.variable(*place));
        let variables: Vec<SymbolId> = states
            .chain(selection.inputs.iter().map(|input| model.inputs[*input].symbol))
            .filter_map(|symbol| graph.as_symbol(symbol))
            .collect();
        let is_constant = |symbol: SymbolId| graph.symbol_info(symbol).role == Role::Constant;
        let mut add = |name: &str, of: &str| {
            let of = programs.functions.iter().position(|f| f.name == of)?;
            programs.add_jacobian(name, of, &variables, is_constant)
        };
        Jacobians {
            rates: add(function::LINEARIZATION, function::RHS),
            outputs: (!selection.outputs.is_empty())
                .then(|| add(function::OUTPUT_LINEARIZATION, function::OUTPUTS))
                .flatten(),
        }
    }
}
