//! The one namespace of a declaration.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, Span};

use super::Identifiers;
use super::value::Value;
use crate::diagnostics::{Fault, Faults};
use crate::names;
use crate::syntax::{Name, SPEED};

/// The category under which a name was declared.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Category {
    /// A physical constant.
    Constant,
    /// A control input.
    Input,
    /// A coordinate.
    Coordinate,
    /// A `let`.
    Let,
    /// A parameter.
    Parameter,
    /// A constraint.
    Constraint,
    /// A body.
    Body,
    /// A state beside the motion.
    State,
    /// An output.
    Output,
    /// A function.
    Function,
    /// A contact, a grip or a latch.
    Contact,
    /// A switch.
    Switch,
    /// A reset.
    Reset,
}

impl Category {
    /// The category with its article, for messages.
    pub(super) fn noun(self) -> &'static str {
        match self {
            Category::Constant => "a constant",
            Category::Input => "an input",
            Category::Coordinate => "a coordinate",
            Category::Let => "a `let`",
            Category::Parameter => "a parameter",
            Category::Constraint => "a constraint",
            Category::Body => "a body",
            Category::State => "a state",
            Category::Output => "an output",
            Category::Function => "a function",
            Category::Contact => "a contact",
            Category::Switch => "a switch",
            Category::Reset => "a reset",
        }
    }

    /// Whether something that is declared has to be used: forms, bodies and outputs are used by being there.
    fn must_be_used(self) -> bool {
        matches!(
            self,
            Category::Constant
                | Category::Input
                | Category::Coordinate
                | Category::Let
                | Category::Function
                | Category::Switch
        )
    }
}

struct Entry {
    category: Category,
    span: Span,
    /// The place among the declared names.
    written: usize,
    value: Option<Value>,
    used: bool,
    /// Part of a vector: it shares the place of the whole.
    derived: bool,
}

/// The names declared so far.
#[derive(Default)]
pub(super) struct Scope {
    entries: BTreeMap<String, Entry>,
    // In the order of declaration, for messages that list names.
    order: Vec<String>,
    // Arguments of components, which only their component reads.
    private: BTreeSet<String>,
    // Everything that the declaration declares anywhere, to tell "later" from "never".
    later: BTreeMap<String, Span>,
    // Whether there are contacts, whose friction knows `speed`.
    has_contacts: bool,
    // Unknown names that were reported: one mistake is one error, however often the name is used.
    unknown: BTreeSet<String>,
    // Every declared name and every use, as written: editors lead from one to the other.
    declared: Vec<Ident>,
    used: Vec<Ident>,
}

impl Scope {
    /// Announces a name that is declared somewhere.
    pub(super) fn announce(&mut self, name: &Name) {
        self.later.entry(name.text.clone()).or_insert_with(|| name.span());
    }

    /// Announces an argument of a component, which messages do not offer for use.
    pub(super) fn announce_argument(&mut self, name: &Name) {
        self.private.insert(name.text.clone());
        self.announce(name);
    }

    /// The names that messages offer, in the order of declaration: those of instances without what is private to their component.
    fn offered(&self) -> impl Iterator<Item = &str> {
        let is_private = |text: &str| {
            let is_function = || self.category(text) == Some(Category::Function);
            let mut steps = text.split('.').skip(1).peekable();
            let is_of_instance = steps.peek().is_some();
            self.private.contains(text)
                || is_of_instance && is_function()
                || steps.any(|step| step.starts_with('_'))
        };
        self.order.iter().map(String::as_str).filter(move |text| !is_private(text))
    }

    /// Whether contacts are declared somewhere.
    pub(super) fn has_contacts(&self) -> bool {
        self.has_contacts
    }

    /// Announces the name of a contact that is declared somewhere.
    pub(super) fn announce_contact(&mut self, name: &Name) {
        self.has_contacts = true;
        self.announce(name);
    }

    /// Declares a name; `None` for the value of something whose fault was reported.
    pub(super) fn declare(
        &mut self,
        faults: &mut Faults,
        name: &Name,
        category: Category,
        value: Option<Value>,
    ) {
        self.declared.push(name.root().clone());
        self.declare_text(faults, &name.text, name.span(), category, value, false);
    }

    /// Declares a component `name_x` of something written as a vector.
    pub(super) fn declare_component(
        &mut self,
        faults: &mut Faults,
        name: &Name,
        category: Category,
        value: Option<Value>,
    ) {
        self.declared.push(name.root().clone());
        self.declare_text(faults, &name.text, name.span(), category, value, true);
    }

    fn declare_text(
        &mut self,
        faults: &mut Faults,
        text: &str,
        span: Span,
        category: Category,
        value: Option<Value>,
        derived: bool,
    ) {
        // A contact is no value: one called `floor` stands in nobody's way.
        let is_free = category == Category::Contact && names::is_function(text);
        if names::is_reserved(text) && !is_free {
            let what = if names::is_function(text) { "the name of a function" } else { "reserved" };
            faults.report(
                Fault::new(span, format!("`{text}` is {what} and cannot name {}", category.noun()))
                    .help("choose another name"),
            );
        }
        if let Some(known) = self.entries.get_mut(text) {
            // What its uses mean is not known: nothing is said about them.
            known.value = None;
            faults.report(
                Fault::new(span, format!("`{text}` is declared twice"))
                    .note_place(&format!("first declared as {}", known.category.noun()), known.span),
            );
            return;
        }
        let used = text.starts_with('_');
        self.order.push(text.to_owned());
        let written = self.declared.len() - 1;
        self.entries.insert(text.to_owned(), Entry { category, span, written, value, used, derived });
    }

    /// Declares a name that the macro chose: it stands nowhere.
    pub(super) fn declare_chosen(&mut self, text: &str, span: Span, category: Category, value: Value) {
        let entry = Entry { category, span, written: 0, value: Some(value), used: true, derived: true };
        self.entries.entry(text.to_owned()).or_insert(entry);
    }

    /// Lets a name stand that may or may not be one: nothing is said about it.
    pub(super) fn excuse(&mut self, text: String, span: Span) {
        let category = Category::Parameter;
        let entry = Entry { category, span, written: 0, value: None, used: true, derived: true };
        self.entries.entry(text).or_insert(entry);
    }

    /// Returns the place where a name is declared that is not declared so far.
    pub(super) fn declared_later(&self, text: &str) -> Option<Span> {
        self.later.get(text).filter(|_| !self.entries.contains_key(text)).copied()
    }

    /// Whether a name was announced that is not declared so far.
    pub(super) fn is_declared_later(&self, text: &str) -> bool {
        self.declared_later(text).is_some()
    }

    /// Whether the declaration declares the name anywhere, or the name was found to be unknown.
    pub(super) fn is_announced(&self, text: &str) -> bool {
        self.entries.contains_key(text) || self.later.contains_key(text) || self.unknown.contains(text)
    }

    /// The value of a name in use, or `None` after a fault that is reported here or was before.
    pub(super) fn look_up(&mut self, faults: &mut Faults, name: &Name, place: &str) -> Option<Value> {
        if let Some(entry) = self.entries.get_mut(&name.text) {
            entry.used = true;
            self.used.push(name.root().clone());
            return entry.value.clone();
        }
        if !self.unknown.insert(name.text.clone()) {
            return None;
        }
        let mut fault = Fault::new(name.span(), format!("unknown name `{}` in {place}", name.text));
        if names::is_function(&name.text) {
            fault = Fault::new(name.span(), format!("`{}` is a function, and no value", name.text))
                .help(format!("write `{}(..)`", name.text));
        } else if let Some(later) = self.later.get(&name.text) {
            fault = Fault::new(name.span(), format!("`{}` is used before it is declared", name.text))
                .note_place("declared", *later)
                .help("move its declaration above this one");
        } else if let Some(rate) = self.rate(&name.text) {
            fault = fault.help(format!("the rate of `{rate}` is written `dot({rate})`"));
            // `d/dt` is one mistake.
            self.unknown.extend(["d", "dt"].map(String::from));
        } else if name.text == SPEED && self.has_contacts {
            fault = fault.help("`speed` is the magnitude of the slip, inside of `friction` alone");
        } else if let Some(near) = names::nearest(&name.text, self.offered()) {
            fault = fault.help(format!("did you mean `{near}`?"));
        } else if !self.order.is_empty() {
            // Arrays are offered as wholes, those of instances too.
            let whole = |text: &str| text.split('.').map(names::array_of).collect::<Vec<_>>().join(".");
            let mut known: Vec<String> = Vec::new();
            for text in self.offered().map(whole) {
                if !known.contains(&text) {
                    known.push(text);
                }
            }
            fault = fault
                .help(format!("declared so far are {}", names::quoted(known.iter().map(String::as_str))));
        }
        faults.report(fault);
        None
    }

    /// Returns of what an unknown name is probably meant to be the rate: `theta_dot`, `dx` of `dx/dt`, `d` of `d/dt`.
    fn rate<'n>(&'n self, text: &'n str) -> Option<&'n str> {
        let is_known = |word: &&str| self.entries.contains_key(*word);
        let suffixes = ["_dot", "dot", "_rate"].into_iter().filter_map(|suffix| text.strip_suffix(suffix));
        let of_known = suffixes.chain(text.strip_prefix('d')).find(is_known);
        of_known.or_else(|| matches!(text, "d" | "dt").then_some("x"))
    }

    /// Returns the place of the declaration of a name, if it is a `let` or a function.
    pub(super) fn definition(&self, text: &str) -> Option<Span> {
        let entry = self.entries.get(text)?;
        matches!(entry.category, Category::Let | Category::Function).then_some(entry.span)
    }

    /// The category of a declared name.
    pub(super) fn category(&self, text: &str) -> Option<Category> {
        self.entries.get(text).map(|entry| entry.category)
    }

    /// Notes a use of a declared name that takes no value.
    pub(super) fn mark_used(&mut self, name: &Name) {
        if let Some(entry) = self.entries.get_mut(&name.text) {
            entry.used = true;
        }
        self.used.push(name.root().clone());
    }

    /// Notes a place that refers to a declared name without using its value.
    pub(super) fn refer(&mut self, name: &Name) {
        self.used.push(name.root().clone());
    }

    /// The value of a declared name, without counting as a use.
    pub(super) fn peek(&self, text: &str) -> Option<&Value> {
        self.entries.get(text).and_then(|entry| entry.value.as_ref())
    }

    /// Reports coordinates that nothing mentions: without them the number of forms means nothing. Names that faulty expressions mention
    /// are used.
    pub(super) fn report_unused(&self, mentioned: &BTreeSet<String>, faults: &mut Faults) {
        let coordinates = self.unused().filter(|text| self.entries[*text].category == Category::Coordinate);
        for text in coordinates.filter(|text| !mentioned.contains(*text)) {
            let fault = Fault::new(
                self.entries[text].span,
                format!("`{text}` is declared as a coordinate and never used"),
            );
            faults.report(match text.ends_with(']') {
                true => fault.help("use it, or declare fewer entries"),
                false => fault.help(format!("use it, remove it, or call it `_{text}` to keep it")),
            });
        }
    }

    /// Names without any use, in the order of declaration.
    fn unused(&self) -> impl Iterator<Item = &str> {
        // An array is used where one of its entries is; a coordinate is on its own.
        let is_array = |text: &str| text.ends_with(']');
        let used = self.entries.iter().filter(|(text, entry)| entry.used && is_array(text));
        let used: BTreeSet<&str> = used.map(|(text, _)| names::array_of(text)).collect();
        self.order.iter().map(String::as_str).filter(move |text| {
            let entry = &self.entries[*text];
            let is_idle = !entry.used && !entry.derived && entry.category.must_be_used();
            is_idle && (entry.category == Category::Coordinate || !used.contains(names::array_of(text)))
        })
    }

    /// Every name as written, and those without any use: a scene may refer to one of them all the same.
    pub(super) fn into_identifiers(self) -> Identifiers {
        // Names of a component may be needed by its other uses.
        let unused = self.unused().filter(|text| !text.contains('.'));
        let idle: BTreeSet<usize> = unused.map(|text| self.entries[text].written).collect();
        let mut unused: Vec<Ident> = idle.into_iter().map(|place| self.declared[place].clone()).collect();
        let (mut declared, mut used) = (self.declared, self.used);
        if self.entries.keys().any(|text| text.ends_with(']') || text.contains('.')) {
            // The entries of an array and the names of an instance share a name, and what a loop says a place.
            let mut seen = BTreeSet::new();
            declared.retain(|ident| seen.insert(ident.to_string()));
            seen.clear();
            unused.retain(|ident| seen.insert(ident.to_string()));
            seen.clear();
            used.retain(|ident| seen.insert(format!("{ident} {:?}", ident.span())));
        }
        Identifiers { declared, used, unused }
    }
}
