//! Contacts and switches of an outline: their names and kinds, all along one coordinate.

use std::collections::BTreeMap;

use proc_macro2::Span;
use quote::format_ident;

use super::expressions::{call, number, rate, value};
use super::kinds::{Kind, Kinds};
use super::{Names, section};
use crate::limits::MAX_CONTACTS;
use crate::names::is_function;
use crate::syntax::{
    Clause, ClauseWord, Contact, Declaration, Expression, Item, ModeStatement, Name, Plain, Reset,
    ResetAssignment, Switch, type_of_states,
};

/// The sections of contacts, along a coordinate that moves and another one.
pub(super) fn items(
    declaration: &Declaration,
    kinds: &Kinds,
    names: &mut Names,
    moving: &Name,
    coordinates: &[Plain],
) -> Vec<Item> {
    let mut switches: Vec<Switch> = Vec::new();
    let mut contacts: Vec<Contact> = Vec::new();
    let mut resets: Vec<Reset> = Vec::new();
    let mut modes = Vec::new();
    let mut types: BTreeMap<(Vec<String>, String), String> = BTreeMap::new();
    for item in &declaration.items {
        match item {
            Item::Switches(section) => {
                for switch in &section.entries {
                    if switches.iter().all(|known| known.name.text != switch.name.text) {
                        let (name, value) = (names.take(&switch.name), value(moving));
                        switches.push(Switch { docs: switch.docs.clone(), name, value });
                    }
                }
            }
            Item::Resets(section) => {
                for reset in &section.entries {
                    if resets.iter().all(|known| known.name.text != reset.name.text) {
                        let given = ResetAssignment {
                            variable: value(moving),
                            equals: Span::call_site(),
                            value: number(0),
                        };
                        let (name, function) = (names.take(&reset.name), value(moving));
                        resets.push(Reset { name, function, assignments: vec![given], ..reset.clone() });
                    }
                }
            }
            Item::Contacts(section) => {
                for contact in &section.entries {
                    let own = type_of_states(&contact.name);
                    let is_free = declaration.takes_type(&own).is_none()
                        && *types.entry((own.module, own.name)).or_insert(own.contact.clone()) == own.contact
                        && contacts.iter().all(|known| known.name.text != contact.name.text);
                    if !is_free || contacts.len() == MAX_CONTACTS {
                        continue;
                    }
                    // A contact may be called like a function.
                    let name = match is_function(&contact.name.text) {
                        true => contact.name.clone(),
                        false => names.take(&contact.name),
                    };
                    let clauses = clauses(contact, kinds, moving, coordinates);
                    let first = match clauses[0].word {
                        ClauseWord::Gap => "open",
                        ClauseWord::Grip => "stick",
                        _ => "free",
                    };
                    let states = vec![Name::new(format_ident!("{first}"))];
                    modes.push(ModeStatement::States { contact: name.clone(), states });
                    contacts.push(Contact { docs: contact.docs.clone(), name, clauses });
                }
            }
            _ => {}
        }
    }
    let mut found = Vec::new();
    if !switches.is_empty() {
        found.push(Item::Switches(section(switches)));
    }
    if !contacts.is_empty() {
        found.extend([Item::Contacts(section(contacts)), Item::Modes(section(modes))]);
    }
    if !resets.is_empty() {
        found.push(Item::Resets(section(resets)));
    }
    found
}

fn clauses(contact: &Contact, kinds: &Kinds, moving: &Name, coordinates: &[Plain]) -> Vec<Clause> {
    let has = |word: ClauseWord| contact.clause(word);
    let clause = |word, value| Clause { word, keyword: Span::call_site(), value };
    let along = |written: &Expression| {
        let other = coordinates.iter().map(|plain| &plain.name).find(|name| name.text != moving.text);
        match (kinds.of(written), other) {
            (Kind::Vector | Kind::Plane, Some(other)) => {
                call("vec", vec![rate(moving), rate(other), number(0)])
            }
            _ => rate(moving),
        }
    };
    match (has(ClauseWord::Grip), has(ClauseWord::Latch), has(ClauseWord::Slip)) {
        (Some(grip), ..) => {
            vec![clause(ClauseWord::Grip, along(&grip.value)), clause(ClauseWord::Limit, number(1))]
        }
        (_, Some(_), _) => vec![clause(ClauseWord::Latch, value(moving))],
        (.., Some(slip)) => vec![
            clause(ClauseWord::Gap, value(moving)),
            clause(ClauseWord::Slip, along(&slip.value)),
            clause(ClauseWord::Friction, number(0)),
        ],
        _ => vec![clause(ClauseWord::Gap, value(moving))],
    }
}
