//! Functions and expressions of constants that must not vanish.

use guen_symbolic::{Contracted, Derivation, ExprId};

use crate::model::Model;

/// Expressions of constants that must not vanish.
pub(super) fn constant_pivots(derivation: &Derivation) -> Vec<ExprId> {
    let operators = &derivation.frame.operators.constant_pivots;
    operators.iter().chain(&derivation.solution.constant_pivots).copied().collect()
}

/// A function that must not vanish, as it is written, and in words that hold wherever it is seen from.
pub(super) struct Edge {
    pub(super) function: ExprId,
    pub(super) text: String,
    pub(super) words: String,
    /// Whether it is the determinant of a block of the mass matrix, which the words tell by its rows.
    pub(super) is_determinant: bool,
}

/// The functions that must not vanish: large determinants are told by their rows.
pub(super) fn domain(model: &Model<'_>, derivation: &Derivation, shown: &Contracted) -> Vec<Edge> {
    let named = |e: &ExprId, words: &str| Edge {
        function: *e,
        text: written(model, shown.image(*e), words),
        words: words.to_owned(),
        is_determinant: false,
    };
    let chart = derivation.frame.operators.chart.iter().map(|e| named(e, "a factor of det A"));
    let pivots = derivation.solution.pivots.iter().map(|e| named(e, "a pivot of the mass matrix"));
    let determinants = derivation.solution.determinants.iter().map(|(rows, e)| {
        let names: Vec<&str> = rows.iter().map(|s| model.forms[*s].name.as_str()).collect();
        let words = format!("det M[{}]", names.join(", "));
        Edge { function: *e, text: words.clone(), words, is_determinant: true }
    });
    chart.chain(pivots).chain(determinants).collect()
}

/// A function that must not vanish in words; another text where it is too long.
pub(super) fn written(model: &Model<'_>, e: ExprId, otherwise: &str) -> String {
    const LONGEST: usize = 400;
    model.bench.graph.text_limited(e, LONGEST).unwrap_or(otherwise.to_owned())
}
