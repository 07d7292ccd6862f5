//! Contacts in outputs: `gap(name)`, `slip(name)` and `reaction(name)`.

use proc_macro2::Span;

use super::accelerations::REACTION;
use super::evaluate::{Evaluated, Evaluator};
use super::expression_place::ExpressionPlace;
use super::scope::Category;
use super::value::{ContactValue, Value};
use crate::diagnostics::Fault;
use crate::names::{nearest, quoted};
use crate::syntax::{Expression, ExpressionKind, Name};

/// The words that are functions of contacts in outputs, and names like any other elsewhere.
const GAP: &str = "gap";
const SLIP: &str = "slip";

/// The word for the mode of a contact, which is no number.
const MODE: &str = "mode";

impl Evaluator<'_> {
    /// Whether a call asks for something of a contact.
    pub(super) fn is_of_contact(&self, function: &Name) -> bool {
        let word = function.text.as_str();
        (word == GAP || word == SLIP)
            && self.scope.category(word).is_none()
            && self.functions.get(word).is_none()
    }

    /// Whether the argument of a call is a name that stands for no value: `reaction(row)`, `gap(contact)`.
    pub(super) fn takes_a_name(&self, function: &Name) -> bool {
        let word = function.text.as_str();
        matches!(word, GAP | SLIP | MODE | REACTION)
            && self.scope.category(word).is_none()
            && self.functions.get(word).is_none()
    }

    /// Whether contacts are declared above: one with a fault has no value, but the name of one.
    pub(super) fn stands_below_contacts(&self, arguments: &[Expression]) -> bool {
        let names_one = matches!(arguments, [Expression { kind: ExpressionKind::Name(name), .. }]
            if matches!(self.scope.category(&name.text), Some(Category::Contact)));
        names_one || !self.contacts.is_empty()
    }

    /// `gap(name)` or `slip(name)`.
    pub(super) fn of_contact(&mut self, function: &Name, arguments: &[Expression], list: Span) -> Evaluated {
        let word = function.text.as_str();
        if self.place != ExpressionPlace::Output {
            let place = self.place.description(self.entry.as_deref());
            let fault =
                Fault::new(function.span(), format!("{place} cannot ask for the {word} of a contact"));
            return self.fail(fault.note("only `outputs` may").help("give the expression a name by `let`"));
        }
        let contact = self.contact_named(word, arguments, list)?;
        let value = if word == GAP { contact.1.gap.map(Value::Scalar) } else { contact.1.slip };
        match value {
            Some(value) => Ok(value),
            None => {
                let name = contact.0;
                self.fail(Fault::new(name.span(), format!("`{name}` has no {word}")))
            }
        }
    }

    /// The words for a call that would ask for something of a contact where that is no number.
    pub(super) fn instead_of_contact(&self, function: &str) -> Option<&'static str> {
        let is_of_contact = self.scope.has_contacts() && self.functions.get(function).is_none();
        match function {
            MODE if is_of_contact => {
                Some("a mode is no number: a run tells it, and `Mode` has a field for every contact")
            }
            GAP | SLIP if is_of_contact => {
                Some("only `outputs` may ask for it, below `contacts`: write the expression")
            }
            _ => None,
        }
    }

    /// The contact that a call names.
    pub(super) fn contact_named<'e>(
        &mut self,
        word: &str,
        arguments: &'e [Expression],
        list: Span,
    ) -> Evaluated<(&'e Name, ContactValue)> {
        if let [Expression { kind: ExpressionKind::Missing, .. }] = arguments {
            return Err(self.faults.reported_before());
        }
        let [Expression { kind: ExpressionKind::Name(name), .. }] = arguments else {
            let fault = Fault::new(list, format!("`{word}` takes the name of a contact"));
            return self.fail(fault.help(format!("write `{word}(name)` with a name from `contacts`")));
        };
        if let Some(contact) = self.contacts.get(&name.text) {
            let contact = contact.clone();
            self.scope.refer(name);
            return Ok((name, contact));
        }
        match self.scope.category(&name.text) {
            // Its fault was reported.
            Some(Category::Contact) => Err(self.faults.reported_before()),
            Some(category) => {
                let text = format!("`{name}` is {}, and no contact", category.noun());
                self.fail(Fault::new(name.span(), text))
            }
            None if self.scope.declared_later(&name.text).is_some() => {
                let fault = Fault::new(name.span(), format!("`{name}` is used before it is declared"));
                self.fail(fault.help("move its declaration above this one"))
            }
            None => {
                let names: Vec<String> = self.contacts.keys().cloned().collect();
                let known = || names.iter().map(String::as_str);
                let fault = Fault::new(name.span(), format!("unknown contact `{name}`"));
                self.fail(match nearest(&name.text, known()) {
                    Some(near) => fault.help(format!("did you mean `{near}`?")),
                    None if names.is_empty() => fault.help("the system declares no contacts"),
                    None => fault.help(format!("the contacts are {}", quoted(known()))),
                })
            }
        }
    }
}
