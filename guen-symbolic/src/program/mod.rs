//! Turns expressions into straight-line code: values to compute once per system, and values to compute in every
//! state.
//!
//! What comes in are expressions over symbols; what goes out are [`Programs`]: a *prepare* stage that turns
//! physical constants into prepared values, and functions of the state over those values. The stages are
//! `net` (expressions whose coefficients are constants) -> `passes` (equal functions with fewer operations)
//! -> `lower` (instructions), and `builder` runs them for several candidates and keeps the cheapest.

mod accuracy;
mod builder;
mod carried;
mod cost;
mod evaluate;
mod fixed;
mod instruction;
mod jacobian;
mod lower;
mod marks;
mod net;
mod part;
mod passes;
mod regular;
mod reuse;
mod roll;
mod shape;
mod stage;
mod taylor;
mod terms;
#[cfg(test)]
mod tests;
mod thresholds;

pub use builder::{Formulation, ProgramBuilder};
pub use carried::{Carried, CarriedFunction, NotCarried};
pub use cost::{OperationCount, weighted_cost};
pub use evaluate::{Arithmetic, evaluate_function, evaluate_prepare};
pub use instruction::{FunctionProgram, Instruction, Operation, Programs, Value};
pub use jacobian::Pattern;
pub use roll::{ArrayIndex, Arrays, Line, Loop, Operand, Places, Rolled, RolledStep};
pub use taylor::{NotAnalytic, SeriesProgram, SeriesStep, Start, SymbolInStep};
pub use thresholds::{LARGEST_DIFFERENTIATED, LARGEST_JACOBIAN};
