//! The counts among the arguments of a component: its constants do not depend on them, because it has one struct of them, whatever
//! its uses give.

use std::collections::BTreeSet;

use proc_macro2::Span;

use crate::diagnostics::{Fault, Faults};
use crate::syntax::{
    Component, Condition, Conditional, EntryNode, Expression, ExpressionKind, Index, IndexExpression,
    IndexKind, Item, Loop, Range,
};

/// Reports constants, and instances with constants of their own, whose number or value depends on a count that a use gives.
pub(super) fn check(component: &Component, faults: &mut Faults) {
    let mut given = Given(component.counts().map(|argument| argument.name.text.as_str()).collect());
    if given.0.is_empty() {
        return;
    }
    for item in &component.items {
        match item {
            Item::Count(count) if given.index(&count.value).is_some() => {
                given.0.insert(&count.name.text);
            }
            Item::Constants(section) => {
                let of_entry = section.entries.iter().filter_map(|entry| {
                    let lengths = match &entry.name.index {
                        Index::Written(written) => &written.indices[..],
                        _ => &[],
                    };
                    let values = entry.default.iter().chain(entry.limits.as_deref().into_iter().flatten());
                    let length = lengths.iter().find_map(|e| given.index(e));
                    length.or_else(|| values.into_iter().find_map(|e| given.expression(e)))
                });
                for place in of_entry.chain(given.nodes(&section.nesting, &|_| true)) {
                    let text =
                        format!("constants of `{}` depend on a count that its uses give", component.name);
                    faults.report(
                        Fault::new(place, text)
                            .note(ONE)
                            .help("declare what all entries have in common, or give the others as arguments"),
                    );
                }
            }
            _ => {}
        }
    }
    let is_use = |entry: usize| matches!(component.items[entry], Item::Use(_));
    if let Some(place) = given.nodes(&component.nesting, &is_use) {
        let text = format!("instances in `{}` depend on a count that its uses give", component.name);
        faults.report(
            Fault::new(place, text).note(ONE).help("write their sections in this component, in loops"),
        );
    }
}

const ONE: &str = "a component has one struct of constants, with those of its instances, for all uses";

/// The names that depend on what a use gives.
struct Given<'a>(BTreeSet<&'a str>);

impl Given<'_> {
    /// The first place where an expression of whole numbers depends on a count.
    fn index(&self, e: &IndexExpression) -> Option<Span> {
        match &e.kind {
            IndexKind::Missing | IndexKind::Number(_) => None,
            IndexKind::Name(name) => self.0.contains(name.text.as_str()).then(|| name.span()),
            IndexKind::Negation(operand) => self.index(operand),
            IndexKind::Operation(left, _, right) => self.index(left).or_else(|| self.index(right)),
        }
    }

    fn range(&self, range: &Range) -> Option<Span> {
        self.index(&range.start).or_else(|| self.index(&range.end))
    }

    fn condition(&self, condition: &Condition) -> Option<Span> {
        match condition {
            Condition::Missing => None,
            Condition::Comparison(left, _, right) => self.index(left).or_else(|| self.index(right)),
            Condition::Not(inner) => self.condition(inner),
            Condition::And(left, right) | Condition::Or(left, right) => {
                self.condition(left).or_else(|| self.condition(right))
            }
        }
    }

    fn expression(&self, e: &Expression) -> Option<Span> {
        let own = match &e.kind {
            ExpressionKind::Name(name) => self.0.contains(name.text.as_str()).then(|| name.span()),
            ExpressionKind::Fold(fold) => self.range(&fold.range),
            _ => None,
        };
        own.or_else(|| e.children().into_iter().find_map(|child| self.expression(child)))
    }

    /// The first loop or choice that depends on a count, with an entry in it that is meant.
    fn nodes(&self, nodes: &[EntryNode], is_meant: &dyn Fn(usize) -> bool) -> Option<Span> {
        fn has(nodes: &[EntryNode], is_meant: &dyn Fn(usize) -> bool) -> bool {
            nodes.iter().any(|node| match node {
                EntryNode::Entry(entry) => is_meant(*entry),
                EntryNode::For(Loop { body, .. }) => has(body, is_meant),
                EntryNode::If(Conditional { then, otherwise, .. }) => {
                    has(then, is_meant) || has(otherwise, is_meant)
                }
            })
        }
        nodes.iter().find_map(|node| match node {
            EntryNode::Entry(_) => None,
            EntryNode::For(Loop { range, body, .. }) => {
                let own = self.range(range).filter(|_| has(body, is_meant));
                own.or_else(|| self.nodes(body, is_meant))
            }
            EntryNode::If(Conditional { condition, then, otherwise }) => {
                let own =
                    self.condition(condition).filter(|_| has(then, is_meant) || has(otherwise, is_meant));
                own.or_else(|| self.nodes(then, is_meant)).or_else(|| self.nodes(otherwise, is_meant))
            }
        })
    }
}
