//! The symbols that stand for accelerations and reactions until the derivation knows them.

use std::collections::BTreeMap;

use guen_symbolic::{ExprId, MotionSymbol};
use proc_macro2::Span;

/// The symbols introduced so far.
#[derive(Default)]
pub(super) struct MotionSymbols {
    /// Coordinates with their velocities.
    pub(super) coordinates: Vec<(ExprId, ExprId)>,
    /// Velocities and quasi-velocities, with the symbols of their rates.
    pub(super) rates: BTreeMap<ExprId, ExprId>,
    /// Quasi-velocities of constraints, with the symbols of their reactions and the places that ask for them.
    pub(super) reactions: Vec<(ExprId, ExprId, Span)>,
}

impl MotionSymbols {
    /// Returns the meaning of each symbol; `etas` are the quasi-velocities in order. The rates of the first `degrees`
    /// of them are known to the mechanics already.
    pub(super) fn meanings(&self, etas: &[ExprId], degrees: usize) -> Vec<(ExprId, MotionSymbol)> {
        let form = |eta: &ExprId| etas.iter().position(|known| known == eta);
        let rates = self.rates.iter().filter_map(|(of, rate)| {
            let coordinate = self.coordinates.iter().position(|(_, velocity)| velocity == of);
            let meaning = match (coordinate, form(of)) {
                (Some(i), _) => MotionSymbol::CoordinateAcceleration(i),
                (None, Some(j)) if j >= degrees => MotionSymbol::ConstraintRate,
                _ => return None,
            };
            Some((*rate, meaning))
        });
        let reactions = self
            .reactions
            .iter()
            .filter_map(|(eta, reaction, _)| Some((*reaction, MotionSymbol::Reaction(form(eta)?))));
        rates.chain(reactions).collect()
    }
}
