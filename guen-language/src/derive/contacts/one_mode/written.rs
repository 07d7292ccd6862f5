//! The declaration of a system in one of its modes.

use std::collections::BTreeSet;

use guen_symbolic::ExprId;
use proc_macro2::{Ident, Span};

use super::{Part, not_held, words};
use crate::derive::selections::selection::StatePart;
use crate::diagnostics::{Fault, Faults};
use crate::model::{ContactEntry, ContactState, Contacts, FormEntry, Model, SceneEntry};
use crate::syntax::{
    Clause, ClauseWord, Contact, Declaration, Definition, Docs, Equation, Expression, ExpressionKind,
    HeldContact, Item, Name, Number, Scene, Section, SingleMode, SlipDirection,
};

/// The declaration in which a scene is one of a smooth system; `None` after a fault.
pub(super) fn in_mode(
    model: &Model<'_>,
    contacts: &Contacts<'_>,
    scene: &SceneEntry<'_>,
    part: &Part,
    faults: &mut Faults,
) -> Option<Declaration> {
    let whole = model.declaration;
    let l = model.mechanics.forms.degrees;
    let is_kept = |s: usize| part.kept.contains(&s);
    let followers: Vec<Name> = (0..l).filter(|s| !is_kept(*s)).map(|s| model.forms[s].own_name()).collect();
    let before = faults.count();
    let (tracks, tracked) = tracks(model, scene, part, faults);
    for name in &scene.held {
        let is_part = |place: usize| match model.part(place) {
            StatePart::Parameter(s) => is_kept(s),
            _ => true,
        };
        if !model.places(&name.text).into_iter().all(is_part) {
            not_held(name, &followers, faults);
        }
    }
    if faults.count() > before {
        return None;
    }
    let own = Scene { tracks, modes: Vec::new(), ..scene.scene.clone() };
    let (mut items, mut origins) = (Vec::new(), Vec::new());
    // Parameters that the macro chose are rates of coordinates.
    let last = whole.items.iter().rposition(|item| matches!(item, Item::Coordinates(_)))?;
    for (place, item) in whole.items.iter().enumerate() {
        let replaced = match item {
            Item::Parameters(section) => {
                let entries = section.entries.iter();
                entries.flat_map(|definition| parameter(model, part, definition)).collect()
            }
            Item::Coordinates(_) if place == last => {
                let mut replaced = vec![item.clone()];
                replaced.extend(chosen(model, part));
                replaced
            }
            Item::Modes(_) | Item::Provide(_) => Vec::new(),
            Item::Scene(written) if std::ptr::eq(written, scene.scene) => vec![Item::Scene(own.clone())],
            Item::Scene(_) => Vec::new(),
            other => vec![other.clone()],
        };
        if !whole.origins.is_empty() {
            origins.extend(replaced.iter().map(|_| whole.origins[place]));
        }
        items.extend(replaced);
    }
    let mut taken: BTreeSet<String> =
        whole.items.iter().flat_map(Item::declared).map(|name| name.text.clone()).collect();
    let written = whole.items.iter().filter_map(|item| match item {
        Item::Contacts(section) => Some(&section.entries),
        _ => None,
    });
    let written: Vec<&Contact> = written.flatten().collect();
    let mode = scene.single_mode()?;
    let held = contacts.entries.iter().enumerate().map(|(place, entry)| {
        let contact = written.iter().find(|contact| contact.name.text == entry.name.text);
        let is_undetermined = part.undetermined[place];
        match contact {
            Some(contact) => {
                let rows = (&part.held[place][..], part.by_rate[place]);
                let slides = direction(entry.states()[mode[place]]);
                HeldContact { is_undetermined, slides, ..held(contact, entry, rows, &mut taken) }
            }
            None => HeldContact::default(),
        }
    });
    let contacts_held = held.collect();
    let reset = contacts.resets.iter().flat_map(|reset| &reset.assignments);
    let (_, size) = model.sizes();
    let name = |variable: ExprId| {
        let place = (0..size).find(|place| model.variable(*place) == variable)?;
        Some(model.variable_name(place).to_owned())
    };
    let reset = reset.filter_map(|(variable, _)| name(*variable)).collect();
    let in_mode =
        SingleMode { contacts: contacts_held, followers, tracked, reset, words: words(contacts, mode) };
    Some(Declaration {
        items,
        origins,
        nesting: Vec::new(),
        in_mode: Some(in_mode),
        of_modes: Default::default(),
        ..whole.clone()
    })
}

/// The variables that are tracked, and the names of parameters that follow from them.
fn tracks(
    model: &Model<'_>,
    scene: &SceneEntry<'_>,
    part: &Part,
    faults: &mut Faults,
) -> (Vec<Name>, Vec<String>) {
    let (mut tracks, mut tracked) = (Vec::new(), Vec::new());
    for name in &scene.scene.tracks {
        for place in model.places(&name.text) {
            match model.part(place) {
                StatePart::Parameter(s) if !part.kept.contains(&s) => {
                    tracked.push(model.forms[s].name.clone());
                }
                StatePart::Parameter(s) => {
                    tracks.push(name.part(&model.forms[s].name).unwrap_or_else(|| name.clone()))
                }
                _ => tracks.push(name.clone()),
            }
        }
    }
    if let (Some(first), true) = (scene.scene.tracks.first(), tracks.is_empty()) {
        let text = format!("`{first}` does not move in the mode of scene `{}`", scene.scene.name);
        faults.report(Fault::new(first.span(), text).note("its contacts determine it"));
    }
    (tracks, tracked)
}

/// A parameter as it is in the mode: a parameter, or a name for an expression; of a vector each component.
fn parameter(model: &Model<'_>, part: &Part, definition: &Definition) -> Vec<Item> {
    let of: Vec<usize> = (0..model.mechanics.forms.degrees)
        .filter(|s| std::ptr::eq(model.forms[*s].written, &definition.name))
        .collect();
    let is_kept = |s: &usize| part.kept.contains(s);
    if of.iter().all(is_kept) {
        return vec![parameters(definition.clone())];
    }
    if !of.iter().any(is_kept) {
        let name = &definition.name;
        let mut found = vec![Item::Let(definition.clone())];
        if of.iter().any(|s| model.forms[*s].name != name.text) {
            found.extend(AXES.map(|axis| Item::Let(component(definition, axis, &value(name)))));
        }
        return found;
    }
    let mut found = Vec::new();
    for axis in AXES {
        let own = component(definition, axis, &definition.value);
        let kept = of.iter().any(|s| is_kept(s) && model.forms[*s].name == own.name.text);
        found.push(if kept { parameters(own) } else { Item::Let(own) });
    }
    let arguments = AXES.map(|axis| value(&definition.name.suffixed(&format!("_{axis}"))));
    let whole = Definition { value: call("vec", arguments.to_vec()), ..definition.clone() };
    found.push(Item::Let(whole));
    found
}

/// The parameters that the macro has chosen.
fn chosen(model: &Model<'_>, part: &Part) -> Vec<Item> {
    let is_written = |form: &FormEntry<'_>| {
        let sections = model.declaration.items.iter().filter_map(|item| match item {
            Item::Parameters(section) => Some(&section.entries),
            _ => None,
        });
        sections.flatten().any(|definition| std::ptr::eq(form.written, &definition.name))
    };
    let l = model.mechanics.forms.degrees;
    let own = (0..l).filter(|s| !is_written(&model.forms[*s]));
    own.map(|s| {
        let form = &model.forms[s];
        let definition = Definition {
            docs: Docs::default(),
            name: form.own_name(),
            value: call("dot", vec![value(form.written)]),
        };
        if part.kept.contains(&s) { parameters(definition) } else { Item::Let(definition) }
    })
    .collect()
}

/// The equations of a contact in the mode.
fn held(
    contact: &Contact,
    entry: &ContactEntry<'_>,
    (rows, by_rate): (&[bool], bool),
    taken: &mut BTreeSet<String>,
) -> HeldContact {
    let mut equation = |suffix: &str, left: Expression| {
        let mut suffix = suffix.to_owned();
        while taken.contains(&contact.name.suffixed(&suffix).text) {
            suffix.push('_');
        }
        let name = contact.name.suffixed(&suffix);
        taken.insert(name.text.clone());
        Equation { docs: contact.docs.clone(), name, left, equals: contact.name.span(), right: zero() }
    };
    let clause = |word: ClauseWord| contact.clauses.iter().find(|clause: &&Clause| clause.word == word);
    let normal = usize::from(entry.gap.is_some());
    let gap = clause(ClauseWord::Gap).or(clause(ClauseWord::Latch));
    let gap = gap.filter(|_| normal == 1 && rows[0]).map(|clause| match by_rate {
        true => equation("_n", call("dot", vec![clause.value.clone()])),
        false => equation("_n", clause.value.clone()),
    });
    let along = clause(ClauseWord::Slip).or(clause(ClauseWord::Grip));
    let tangential = &rows[normal..];
    let mut slip = Vec::new();
    if let Some(clause) = along {
        if !tangential.is_empty() && tangential.iter().all(|held| *held) {
            slip.push(equation("_t", clause.value.clone()));
        } else {
            // Of several components those that are independent.
            let rows = tangential.iter().zip(&entry.axes).filter(|(held, _)| **held);
            slip.extend(rows.map(|(_, axis)| {
                equation(&format!("_t_{axis}"), field(&clause.value, axis, clause.value.span))
            }));
        }
    }
    HeldContact { gap, gap_by_rate: by_rate, slip, slides: None, rows: rows.to_vec(), is_undetermined: false }
}

/// The direction of a slip in a state.
fn direction(state: ContactState) -> Option<SlipDirection> {
    match state {
        ContactState::SlipPlus => Some(SlipDirection::Positive),
        ContactState::SlipMinus => Some(SlipDirection::Negative),
        ContactState::Slip => Some(SlipDirection::Velocity),
        _ => None,
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// `name_axis = (value).axis`.
fn component(definition: &Definition, axis: &str, of: &Expression) -> Definition {
    Definition {
        docs: definition.docs.clone(),
        name: definition.name.suffixed(&format!("_{axis}")),
        value: field(of, axis, definition.name.span()),
    }
}

fn parameters(definition: Definition) -> Item {
    Item::Parameters(Section::new(Docs::default(), definition.name.span(), vec![definition]))
}

fn value(name: &Name) -> Expression {
    Expression::new(name.span(), ExpressionKind::Name(name.clone()))
}

fn field(base: &Expression, axis: &str, span: Span) -> Expression {
    let name = Name::new(Ident::new(axis, span));
    Expression::new(span, ExpressionKind::Field { base: Box::new(base.clone()), name })
}

fn call(function: &str, arguments: Vec<Expression>) -> Expression {
    let place = Span::call_site();
    let function = Name::new(Ident::new(function, place));
    Expression::new(place, ExpressionKind::Call { function, arguments, list: place })
}

fn zero() -> Expression {
    let number = Number { digits: "0".to_owned(), exponent: 0, text: "0".to_owned() };
    Expression::new(Span::call_site(), ExpressionKind::Number(number))
}
