//! The Jacobian of a straight-line function, as straight-line code.
//!
//! What comes in is the code of a function; what goes out is code for those of its partial derivatives that do not
//! vanish. Every instruction is an edge or two of the linearised computational graph, weighted by its partial
//! derivatives (`partials`); a Jacobian is that graph with all vertices eliminated that are neither variables nor
//! outputs (`eliminate`). In which order decides what it costs: forward and reverse mode are two orders of many.
//! The factors on the edges know sign, zero and one, and what depends on constants alone is computed in *prepare*
//! (`factors`).

mod eliminate;
mod factors;
mod partials;
mod trim;

use super::cost::OperationCount;
use super::instruction::{FunctionProgram, Instruction, Programs};
use crate::algebra::SymbolId;
use crate::program::thresholds::{LARGEST_DIFFERENTIATED, LARGEST_JACOBIAN, ORDERED_INSTRUCTIONS};
use eliminate::Order;
use factors::Code;

/// The place of each output of a Jacobian's function: `(row, column)`, row by row. An entry that is not listed is
/// zero everywhere.
pub type Pattern = Vec<(usize, usize)>;

impl Programs {
    /// Adds a function of the partial derivatives of another one by some symbols, and tells where they belong.
    ///
    /// ```text
    /// J_ij = d f_i / d s_j = sum over the paths from s_j to f_i of the product of the partial derivatives along it
    /// ```
    ///
    /// Returns `None`, and adds nothing, if the function has more than [`LARGEST_DIFFERENTIATED`] instructions or its
    /// Jacobian more than [`LARGEST_JACOBIAN`] operations: dual numbers do the same without code of their own.
    ///
    /// `is_constant` tells which symbols are physical constants.
    pub fn add_jacobian(
        &mut self,
        name: &str,
        of: usize,
        variables: &[SymbolId],
        is_constant: impl Fn(SymbolId) -> bool,
    ) -> Option<Pattern> {
        let function = &self.functions[of];
        let count = function.instructions.len();
        if count > LARGEST_DIFFERENTIATED {
            return None;
        }
        let orders = if count <= ORDERED_INSTRUCTIONS { &Order::ALL[..] } else { &[Order::Markowitz] };
        let mut best: Option<(u64, Code, FunctionProgram, Pattern)> = None;
        for order in orders {
            let mut code = Code::new(&self.prepare, &self.prepared, self.prepare_values);
            let (entries, pattern) =
                partials::graph(&mut code, function, variables, &is_constant).eliminated(&mut code, *order);
            let outputs = entries.into_iter().map(|entry| code.loaded(entry)).collect();
            let program = trim::function(name, code.instructions(), outputs);
            if best.as_ref().is_none_or(|(least, ..)| program.cost.weighted() < *least) {
                best = Some((program.cost.weighted(), code, program, pattern));
            }
        }
        let (_, code, program, pattern) = best?;
        if program.cost.operations() > LARGEST_JACOBIAN {
            return None;
        }
        self.keep(code, program);
        Some(pattern)
    }

    /// Takes in a function, and what it needs beyond what is prepared already.
    fn keep(&mut self, code: Code, mut program: FunctionProgram) {
        let (constants, stored) = code.into_constants();
        trim::renumber_prepared(&mut program, &mut self.prepared, &stored);
        let trimmed = trim::instructions(&constants, &self.prepared, self.prepare.len());
        self.prepare_cost = OperationCount::of(&trimmed);
        self.prepare_values =
            constants.iter().flat_map(Instruction::defined).map(|v| v.index() + 1).max().unwrap_or(0);
        self.prepare = trimmed;
        self.functions.push(program);
    }
}
