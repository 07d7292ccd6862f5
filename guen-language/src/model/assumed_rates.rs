//! Rates of coordinates that a declaration uses as parameters before it is known whether the macro chooses them.

use std::collections::BTreeMap;

use guen_symbolic::ExprId;

use crate::syntax::Name;

/// Rates of coordinates that are used as parameters and declared nowhere.
#[derive(Default)]
pub(super) struct AssumedRates(pub(super) BTreeMap<String, Assumed>);

/// A rate of a coordinate that is used as a parameter and declared nowhere.
pub(super) struct Assumed {
    pub(super) symbol: ExprId,
    /// The first use, and the place in words.
    pub(super) first: (Name, String),
}

impl AssumedRates {
    pub(super) fn symbols(&self) -> impl Iterator<Item = ExprId> {
        self.0.values().map(|assumed| assumed.symbol)
    }
}
