//! Parses tokens into the syntax tree: faults of the grammar are reported here, faults of the meaning later.
//!
//! Every concept of the language has a file. A fault ends the entry in which it is, at its `;` or `,`; the next
//! entry is parsed as if nothing had happened, so that several mistakes are reported together. Faults that leave
//! the meaning clear, such as `==` for `=`, end nothing at all.

mod attributes;
mod bodies;
mod components;
mod constants;
mod contacts;
mod cursor;
mod declaration;
mod definitions;
mod energies;
mod equations;
mod expression;
mod forces;
mod functions;
mod index;
mod lists;
mod modes;
mod names;
mod nesting;
mod numbers;
mod particles;
mod punctuation;
mod resets;
mod scene;
mod states;
#[cfg(test)]
mod tests;
mod units;

use proc_macro2::TokenStream;

use crate::damage::Damaged;
use crate::diagnostics::{FaultReport, collect};
use crate::syntax::{Component, Declaration, Expression};
use crate::unfold::unfold;
use crate::unfold::unknown_names::{self, unknown_names};

/// Parses the tokens of one invocation, and writes its loops out. With an empty report there is a declaration, and nothing in it is
/// missing; otherwise there is one if at least the head `system Name { .. }` could be read.
pub fn parse(tokens: TokenStream) -> (Option<Declaration>, FaultReport) {
    let (declaration, report) = written(tokens.clone());
    let Some(declaration) = declaration else { return (None, report) };
    let (declaration, report) = unfolded(&tokens, declaration, report);
    (Some(declaration), report)
}

/// Parses the tokens of one invocation, and leaves loops and uses of components as they are.
pub(crate) fn written(tokens: TokenStream) -> (Option<Declaration>, FaultReport) {
    collect(|faults| declaration::declaration(tokens, faults))
}

/// Writes loops and uses of components out; the faults of the parser are among those of the result.
pub(crate) fn unfolded(
    tokens: &TokenStream,
    declaration: Declaration,
    report: FaultReport,
) -> (Declaration, FaultReport) {
    let damaged = Damaged::new(tokens, &declaration.items, report.faults());
    // What the parser left out may have declared any name.
    let unknown = if report.is_empty() { unknown_names(&declaration) } else { Vec::new() };
    collect(|faults| {
        faults.absorb(report);
        let (before, declaration) = (faults.count(), unfold(declaration, faults));
        faults.keep_since(before, |fault| !damaged.explains(fault));
        if faults.count() > before {
            unknown_names::report(unknown, faults);
        }
        declaration
    })
}

/// Parses the tokens of one invocation of `mechanical_component!`, as [`parse`] does those of a system.
pub fn parse_component(tokens: TokenStream) -> (Option<Component>, FaultReport) {
    collect(|faults| declaration::declared_component(tokens, faults))
}

/// Parses the tokens of a single expression. None exactly if the report is not empty.
pub fn parse_expression(tokens: TokenStream) -> (Option<Expression>, FaultReport) {
    collect(|faults| faults.part(|faults| expression::whole(tokens, faults)).ok())
}
