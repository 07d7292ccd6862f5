//! Bounds that the declaration lacks and that would save operations: no form is divided by a constant without a bound.

use guen_symbolic::{Derivation, Programs};

use super::formulas;
use super::programs::{extend, programs};
use crate::derive::function;
use crate::derive::thresholds::REPEATED_DERIVATION;
use crate::diagnostics::collect;
use crate::model::{self, Model};
use crate::syntax::{BoundKind, Item, WrittenBound};

/// The bounds that the declaration lacks and that would save operations.
pub struct MissingBounds {
    /// The constants that would have to differ from zero.
    pub constants: Vec<String>,
    /// The operations of a right-hand side that are saved; none where a second derivation would be too much work.
    pub saved: Option<u32>,
}

/// Returns the bounds that would save operations. Only where a form has an entry that nothing but the missing bound keeps from being
/// divided by, the system is derived once more, with the bounds.
pub(in crate::derive) fn missing_bounds(
    model: &Model<'_>,
    derivation: &Derivation,
    own: &Programs,
) -> Option<MissingBounds> {
    let graph = &model.bench.graph;
    let symbols = graph.symbols_in(&derivation.frame.operators.unpromised);
    let missing = model.constants.iter().filter(|constant| {
        constant.bound.is_none() && graph.as_symbol(constant.symbol).is_some_and(|s| symbols.contains(&s))
    });
    let constants: Vec<String> = missing.map(|constant| constant.name.text.clone()).collect();
    if constants.is_empty() {
        return None;
    }
    if graph.work() > REPEATED_DERIVATION {
        return Some(MissingBounds { constants, saved: None });
    }
    let saved = operations(own)?.checked_sub(with(model, &constants)?).filter(|saved| *saved > 0)?;
    Some(MissingBounds { constants, saved: Some(saved) })
}

/// The operations of a right-hand side.
fn operations(programs: &Programs) -> Option<u32> {
    let rhs = programs.functions.iter().find(|program| program.name == function::RHS)?;
    Some(rhs.cost.operations() + rhs.cost.sines + rhs.cost.calls)
}

/// The operations of a right-hand side where these constants are promised to differ from zero.
fn with(model: &Model<'_>, constants: &[String]) -> Option<u32> {
    let mut declaration = model.declaration.clone();
    declaration.items.retain(|item| !matches!(item, Item::Scene(_)));
    for item in &mut declaration.items {
        let Item::Constants(section) = item else { continue };
        for constant in section.entries.iter_mut().filter(|c| constants.contains(&c.name.text)) {
            constant.bound = Some(WrittenBound { kind: BoundKind::Nonzero, span: constant.name.span() });
        }
    }
    let (found, report) = collect(|faults| {
        let mut model = model::resolve(&declaration, faults)?;
        let derivation = Derivation::new(&mut model.bench, model.mechanics.clone()).ok()?;
        let mut lists = formulas::rates(&derivation);
        extend(&mut model.bench, &mut lists);
        operations(&programs(&mut model.bench, &lists, &[]))
    });
    found.filter(|_| report.is_empty())
}
