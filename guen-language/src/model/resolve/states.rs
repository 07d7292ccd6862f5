//! States beside the motion: names that are known everywhere, and rates where they are written.
//!
//! The equations of several states use each other, and a `let` between them may use what an equation below it declares: so their
//! names, and no others, may stand above their declaration.

use guen_symbolic::Role;

use super::Resolver;
use crate::model::SymbolEntry;
use crate::model::expression_place::ExpressionPlace;
use crate::model::scope::Category;
use crate::syntax::{Item, State};

impl<'a> Resolver<'a, '_> {
    /// Declares all states before anything is read, but those whose name something else has: these are declared twice.
    pub(super) fn declare_states(&mut self) {
        let sections = self.declaration.items.iter().filter_map(|item| match item {
            Item::States(section) => Some(&section.entries),
            _ => None,
        });
        let mut states: Vec<&'a State> = sections.flatten().collect();
        // Those of the system, then those of each instance.
        states.sort_by_key(|state| super::order::rank(self.declaration, &state.name));
        for state in &states {
            if !self.eval.scope.is_declared_later(&state.name.text) {
                self.declare_state(state);
            }
        }
        states.iter().for_each(|state| self.eval.scope.announce(&state.name));
    }

    fn declare_state(&mut self, state: &'a State) {
        let symbol = self.eval.bench.graph.symbol(&state.name.text, Role::State);
        self.declare_symbol(&state.name, Category::State, symbol);
        self.eval.states.push((symbol, None));
        self.states.push(SymbolEntry { name: &state.name, docs: &state.docs, symbol, limits: None });
    }

    /// Reads the rate of a state.
    pub(super) fn state(&mut self, state: &'a State) {
        let place = self.states.iter().position(|known| std::ptr::eq(known.name, &state.name));
        let Some(place) = place else { return self.declare_state(state) };
        self.eval.entry = Some(state.name.text.clone());
        let rate = self.eval.scalar_at(ExpressionPlace::StateRate, &state.rate);
        // A rate with a fault is declared, whatever it is.
        let graph = &mut self.eval.bench.graph;
        let unknown = |_| graph.symbol(&format!("dot({})", state.name.text), Role::State);
        self.eval.states[place].1 = Some(rate.unwrap_or_else(unknown));
    }
}
