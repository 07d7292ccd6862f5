//! The names of a component, checked where it is declared: what it means is known only where it is used.

use std::collections::BTreeSet;

use crate::diagnostics::{Fault, Faults};
use crate::names::{RATE_SUFFIX, is_function, is_reserved, nearest};
use crate::syntax::{
    Component, Conditional, EntryNode, Expression, ExpressionKind, Index, Item, Loop, ModeStatement, Name,
    SPEED,
};

/// Reports names that a component does not declare, and names that it declares twice or that are reserved.
pub(crate) fn names(component: &Component, faults: &mut Faults) {
    let mut known: Vec<&Name> = Vec::new();
    let arguments = component.arguments.iter().map(|argument| &argument.name);
    let declared = component.items.iter().flat_map(|item| {
        let is_contact = matches!(item, Item::Contacts(_));
        item.declared().into_iter().map(move |name| (name, is_contact))
    });
    for (name, is_contact) in arguments.map(|name| (name, false)).chain(declared) {
        let text = name.text.as_str();
        // A contact is no value, and may be called like a function.
        if is_reserved(text) && !(is_contact && is_function(text)) {
            let what = if is_function(text) { "the name of a function" } else { "reserved" };
            let fault = Fault::new(name.span(), format!("`{text}` is {what} and cannot be declared"));
            faults.report(fault.help("choose another name"));
        }
        let first = known.iter().find(|first| first.text == name.text);
        // Entries of an array have one name.
        if let Some(first) = first.filter(|_| matches!(name.index, Index::None)) {
            let fault = Fault::new(name.span(), format!("`{text}` is declared twice"));
            faults.report(fault.note_place("first declared", first.span()));
        }
        known.push(name);
    }
    super::component_counts::check(component, faults);
    let mut variables = Vec::new();
    loop_variables(&component.nesting, &mut variables);
    component.items.iter().for_each(|item| loop_variables(item.nesting(), &mut variables));
    let scope = Scope { component, own: OwnNames::new(component), variables };
    let mut unknown = BTreeSet::new();
    for item in &component.items {
        let own: Vec<&str> = match item {
            Item::Function(function) => function.parameters.iter().map(|name| name.text.as_str()).collect(),
            _ => Vec::new(),
        };
        match item {
            Item::Contacts(section) => {
                for clause in section.entries.iter().flat_map(|contact| &contact.clauses) {
                    scope.check(&clause.value, clause.word.own_names(), &mut unknown, faults);
                }
            }
            Item::Modes(section) => {
                section.entries.iter().for_each(|statement| scope.statement(statement, faults));
            }
            item => item.expressions().into_iter().for_each(|e| scope.check(e, &own, &mut unknown, faults)),
        }
    }
}

/// The words that are functions in outputs, and names like any other elsewhere.
const ASKING: [&str; 3] = ["reaction", "gap", "slip"];

/// The names that belong to a component.
pub(crate) struct OwnNames<'a> {
    declared: BTreeSet<&'a str>,
    /// Coordinates, whose rates have names.
    coordinates: BTreeSet<&'a str>,
    /// Forms, whose components have names.
    forms: BTreeSet<&'a str>,
    functions: BTreeSet<&'a str>,
}

/// The names that an item declares.
pub(super) fn texts(item: &Item) -> impl Iterator<Item = &str> {
    item.declared().into_iter().map(|name| name.text.as_str())
}

impl<'a> OwnNames<'a> {
    pub(crate) fn new(component: &'a Component) -> Self {
        let arguments = component.arguments.iter().map(|argument| argument.name.text.as_str());
        let coordinates = component.items.iter().filter(|item| matches!(item, Item::Coordinates(_)));
        let forms = component
            .items
            .iter()
            .filter(|item| matches!(item, Item::Parameters(_) | Item::Constraints(_) | Item::Holonomic(_)));
        let functions =
            component.items.iter().filter(|item| matches!(item, Item::Function(_) | Item::Functions(_)));
        OwnNames {
            declared: arguments.chain(component.items.iter().flat_map(texts)).collect(),
            coordinates: coordinates.flat_map(texts).collect(),
            forms: forms.flat_map(texts).collect(),
            functions: functions.flat_map(texts).collect(),
        }
    }

    /// Whether a name is one of the component's, be it that of a rate or of a component of a vector.
    pub(crate) fn has(&self, text: &str) -> bool {
        let is_rate = || text.strip_suffix(RATE_SUFFIX).is_some_and(|of| self.coordinates.contains(of));
        let is_part = || {
            let parts = ["_x", "_y", "_z"].into_iter().filter_map(|suffix| text.strip_suffix(suffix));
            parts.into_iter().any(|of| self.forms.contains(of))
        };
        self.declared.contains(text) || is_rate() || is_part()
    }

    /// Whether a name is that of one of the component's functions.
    pub(crate) fn has_function(&self, text: &str) -> bool {
        self.functions.contains(text)
    }
}

struct Scope<'a> {
    component: &'a Component,
    own: OwnNames<'a>,
    /// Loop variables, wherever their loops are: where they may stand is asked when loops are written out.
    variables: Vec<&'a str>,
}

pub(super) fn loop_variables<'a>(nodes: &'a [EntryNode], found: &mut Vec<&'a str>) {
    for node in nodes {
        match node {
            EntryNode::Entry(_) => {}
            EntryNode::For(Loop { variable, body, .. }) => {
                found.push(&variable.text);
                loop_variables(body, found);
            }
            EntryNode::If(Conditional { then, otherwise, .. }) => {
                loop_variables(then, found);
                loop_variables(otherwise, found);
            }
        }
    }
}

impl Scope<'_> {
    fn check(&self, e: &Expression, own: &[&str], unknown: &mut BTreeSet<String>, faults: &mut Faults) {
        match &e.kind {
            ExpressionKind::Name(name) if !self.knows(&name.text, own) => {
                self.unknown_name(name, unknown, faults);
            }
            ExpressionKind::Call { function, arguments, .. } => {
                let is_own = self.own.functions.contains(function.text.as_str());
                let asks = ASKING.contains(&function.text.as_str());
                let mut arguments_after_faults = self.component.arguments.iter().filter(|a| !a.is_sound);
                let is_excused = arguments_after_faults.any(|argument| argument.name.text == function.text);
                if !is_function(&function.text) && !is_own && !asks && !is_excused {
                    let fault = Fault::new(function.span(), format!("unknown function `{function}`"));
                    faults
                        .report(fault.help("a component knows its own functions and those of the language"));
                }
                arguments.iter().for_each(|argument| self.check(argument, own, unknown, faults));
                return;
            }
            ExpressionKind::Fold(fold) => {
                let own: Vec<&str> = own.iter().copied().chain([fold.variable.text.as_str()]).collect();
                self.check(&fold.body, &own, unknown, faults);
                return;
            }
            _ => {}
        }
        e.children().into_iter().for_each(|child| self.check(child, own, unknown, faults));
    }

    /// The contacts that `modes` speaks of are the component's own, or those of its instances.
    fn statement(&self, statement: &ModeStatement, faults: &mut Faults) {
        let items = || self.component.items.iter();
        let known = items().filter(|item| matches!(item, Item::Contacts(_) | Item::Use(_)));
        let known: Vec<&str> = known.flat_map(Item::declared).map(|name| name.text.as_str()).collect();
        for contact in statement.contacts() {
            let root = match &contact.index {
                Index::Member(member) => &member.steps[0].text,
                _ => &contact.text,
            };
            if known.contains(&root.as_str()) {
                continue;
            }
            let component = &self.component.name;
            let text = format!("unknown contact `{contact}` in component `{component}`");
            let fault = Fault::new(contact.span(), text);
            faults.report(match nearest(root, known.iter().copied()) {
                Some(near) => fault.help(format_args!("did you mean `{near}`?")),
                None => fault.note("a component knows its own contacts, and those of what it uses"),
            });
        }
    }

    fn knows(&self, text: &str, own: &[&str]) -> bool {
        self.own.has(text) || own.contains(&text) || self.variables.contains(&text) || is_reserved(text)
    }

    fn unknown_name(&self, name: &Name, unknown: &mut BTreeSet<String>, faults: &mut Faults) {
        if !unknown.insert(name.text.clone()) {
            return;
        }
        let component = &self.component.name;
        let fault = Fault::new(name.span(), format!("unknown name `{name}` in component `{component}`"));
        let fault = fault
            .note("a component knows its own names and its arguments, and nothing of the system around it");
        let has_contacts = self.component.items.iter().any(|item| matches!(item, Item::Contacts(_)));
        faults.report(match nearest(&name.text, self.own.declared.iter().copied()) {
            Some(near) => fault.help(format_args!("did you mean `{near}`?")),
            None if name.text == SPEED && has_contacts => {
                fault.help("`speed` is the magnitude of the slip, inside of `friction` alone")
            }
            None => fault.help(format_args!("declare an argument, `{component}({name}: scalar)`")),
        });
    }
}
