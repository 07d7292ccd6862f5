//! Coefficients of friction and restitution, and what loads a grip.

use proc_macro2::Span;

use super::*;
use crate::model::accelerations::REACTION;
use crate::syntax::SPEED;

impl Resolver<'_, '_> {
    /// A coefficient of friction, in which `speed` is the magnitude of the slip.
    pub(super) fn coefficient(
        &mut self,
        contact: &Contact,
        clause: &Clause,
        speed: Option<ExprId>,
    ) -> Evaluated<ExprId> {
        let word = clause.word.text();
        let inside = speed.filter(|_| clause.word == ClauseWord::Friction);
        let own = inside.map(|speed| (SPEED.to_owned(), Value::Scalar(speed)));
        self.eval.functions.frames.push(own.into_iter().collect());
        let value = self.eval.scalar_at(Place::Friction, &clause.value);
        self.eval.functions.frames.pop();
        let value = value?;
        if self.eval.bench.graph.as_number(value).is_some_and(|number| number.is_negative()) {
            let text = format!("the {word} of `{}` is below zero", contact.name);
            return self.eval.fail(Fault::new(clause.value.extent(), text));
        }
        self.without_inputs(contact, clause, value)
    }

    /// The coefficient of restitution: of constants, from 0 to 1.
    pub(super) fn restitution(&mut self, contact: &Contact, clause: &Clause) -> Evaluated<ExprId> {
        let value = self.eval.scalar_at(Place::Restitution, &clause.value)?;
        let graph = &self.eval.bench.graph;
        let span = clause.value.extent();
        if let Some(number) = graph.as_number(value) {
            let number = number.to_f64();
            if !(0.0..=1.0).contains(&number) {
                let text = format!("restitution {} lies outside of 0 to 1", clause.value.source());
                return self.eval.fail(Fault::new(span, text));
            }
            return Ok(value);
        }
        let symbol = graph.as_symbol(value);
        let plain = self.constants.iter().find(|c| symbol.is_some() && graph.as_symbol(c.symbol) == symbol);
        if let Some(constant) = plain {
            let number = |e: Option<ExprId>| e.and_then(|e| graph.as_number(e)).map(|n| n.to_f64());
            let name = constant.name;
            if constant.limits.is_none() && constant.default.is_none() {
                let text = format!("restitution `{name}` of `{}` may lie outside of 0 to 1", contact.name);
                return self.eval.fail(Fault::new(span, text).help(format!("declare `{name} in 0..1`")));
            }
            if constant.limits.is_none()
                && number(constant.default).is_some_and(|default| !(0.0..=1.0).contains(&default))
            {
                let text = format!("restitution `{name}` lies outside of 0 to 1 by its default");
                return self.eval.fail(Fault::new(span, text));
            }
        }
        Ok(value)
    }

    /// An expression in which switches may stand, and inputs may not.
    pub(super) fn without_inputs(
        &mut self,
        contact: &Contact,
        clause: &Clause,
        value: ExprId,
    ) -> Evaluated<ExprId> {
        let graph = &self.eval.bench.graph;
        let symbols = graph.symbols_in(&[value]);
        let input = self
            .inputs
            .iter()
            .find(|input| graph.as_symbol(input.symbol).is_some_and(|symbol| symbols.contains(&symbol)));
        let Some(input) = input else { return Ok(value) };
        let span = self.place_of(&clause.value, input.symbol).unwrap_or(clause.value.extent());
        let text = format!("the {} of `{}` depends on an input", clause.word.text(), contact.name);
        let fault = Fault::new(span, text).note(format!("`{}` is an input", input.name));
        self.eval.fail(fault)
    }

    /// The first name in an expression that brings in a symbol.
    pub(super) fn place_of(&self, e: &Expression, symbol: ExprId) -> Option<Span> {
        if let ExpressionKind::Name(name) = &e.kind {
            let parts = self.eval.scope.peek(&name.text)?.expressions();
            let graph = &self.eval.bench.graph;
            let has = graph.as_symbol(symbol).is_some_and(|s| graph.symbols_in(&parts).contains(&s));
            return has.then(|| name.span());
        }
        e.children().into_iter().find_map(|child| self.place_of(child, symbol))
    }

    /// The row whose force loads a grip, where the load is written as a reaction; inside of it none after a fault.
    pub(super) fn loading_row(&mut self, clause: &Clause) -> Option<Option<usize>> {
        let ExpressionKind::Call { function, arguments, list } = &clause.value.kind else { return None };
        let [Expression { kind: ExpressionKind::Name(name), .. }] = &arguments[..] else { return None };
        let scope = &self.eval.scope;
        if function.text != REACTION || scope.category(REACTION).is_some() {
            return None;
        }
        if scope.category(&name.text) == Some(Category::Constraint) {
            self.eval.faults.report(
                Fault::new(name.span(), format!("`{name}` is a constraint that always holds"))
                    .note("a grip is loaded by an expression, or by the force of a contact without friction")
                    .help("declare it as a contact, or write its force as an expression"),
            );
            return Some(None);
        }
        let Ok((name, contact)) = self.eval.contact_named(REACTION, arguments, *list) else {
            return Some(None);
        };
        if !contact.is_smooth {
            let text = format!("`{name}` has friction of its own, and cannot load a grip");
            self.eval.faults.report(
                Fault::new(name.span(), text)
                    .note("a grip is loaded by the force of a contact without friction"),
            );
            return Some(None);
        }
        let place = self.contacts.iter().position(|known| known.entry.name.text == name.text);
        let rows_of = |count: usize| self.contacts[..count].iter().map(|known| known.entry.rows.len()).sum();
        Some(place.map(rows_of))
    }
}
