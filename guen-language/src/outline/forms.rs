//! Coordinates and forms: every form is the rate of a coordinate of its own.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::Span;

use super::expressions::{call, number, rate, value};
use super::kinds::{Kind, Kinds};
use super::{Names, push, section, unnamed};
use crate::names::{self, RATE_SUFFIX};
use crate::syntax::{Declaration, Definition, Docs, Equation, Expression, Item, Name, Plain};

pub(super) struct Forms {
    pub(super) coordinates: Vec<Plain>,
    pub(super) parameters: Vec<Definition>,
    /// Sections `constraints` and `holonomic`, as they were written.
    pub(super) constraints: Vec<Item>,
    /// The coordinates that constraints keep at rest.
    pub(super) resting: BTreeSet<String>,
    fields: Fields,
    /// The coordinate of the first parameter that no scene holds: what a force may act along.
    pub(super) driven: Option<Name>,
}

/// The coordinates that no form has yet.
struct Free(Vec<Name>);

impl Free {
    /// Takes as many as a form of a kind needs, or those that are left; none if there are none.
    fn take(&mut self, kind: Kind) -> Option<Vec<Name>> {
        let taken: Vec<Name> = self.0.drain(..components(kind).min(self.0.len())).collect();
        (!taken.is_empty()).then_some(taken)
    }
}

/// The fields of the records of state and forms. A second one of a name was reported as a fault already.
struct Fields(BTreeSet<String>);

impl Fields {
    /// Adds a scalar or the components of a vector, unless one is there.
    fn add(&mut self, name: &Name, kind: Kind) -> bool {
        let name = name.text.clone();
        let own = match components(kind) {
            1 => vec![name],
            count => ["_x", "_y", "_z"][..count].iter().map(|axis| names::suffixed(&name, axis)).collect(),
        };
        let is_new = own.iter().all(|field| !self.0.contains(field));
        self.0.extend(own);
        is_new
    }
}

/// The number of forms that an entry of a kind declares.
fn components(kind: Kind) -> usize {
    match kind {
        Kind::Vector => 3,
        Kind::Plane => 2,
        Kind::Scalar | Kind::Rotation => 1,
    }
}

/// The kinds of the forms by name. Where they have more components than there are coordinates, third components of
/// constraints are those that say `0 = 0`, as far as that helps.
fn of_forms(declaration: &Declaration, coordinates: usize, kinds: &Kinds) -> BTreeMap<String, Kind> {
    let mut found: BTreeMap<String, Kind> = BTreeMap::new();
    let mut vectors = Vec::new();
    let mut count = 0;
    let mut add = |name: &Name, kind: Kind, is_constraint: bool| {
        let name = name.text.clone();
        if found.contains_key(&name) {
            return;
        }
        count += components(kind);
        if is_constraint && kind == Kind::Vector {
            vectors.push(name.clone());
        }
        found.insert(name, kind);
    };
    for item in &declaration.items {
        match item {
            Item::Parameters(section) => {
                section.entries.iter().for_each(|entry| add(&entry.name, kinds.of(&entry.value), false));
            }
            Item::Constraints(section) | Item::Holonomic(section) => {
                for entry in &section.entries {
                    add(&entry.name, kinds.of(&entry.left).or(kinds.of(&entry.right)), true);
                }
            }
            _ => {}
        }
    }
    for name in vectors.into_iter().take(count.saturating_sub(coordinates)) {
        found.insert(name, Kind::Plane);
    }
    found
}

/// A scalar, or a vector with zeros for what there is no coordinate for.
fn of_kind(kind: Kind, coordinates: &[Name], part: fn(&Name) -> Expression) -> Expression {
    let mut parts: Vec<Expression> = coordinates.iter().map(part).collect();
    match kind {
        Kind::Vector | Kind::Plane => {
            parts.resize_with(3, || number(0));
            call("vec", parts)
        }
        Kind::Scalar | Kind::Rotation => parts.swap_remove(0),
    }
}

impl Forms {
    pub(super) fn new(declaration: &Declaration, kinds: &Kinds, names: &mut Names) -> Self {
        let mut coordinates = Vec::new();
        for item in &declaration.items {
            let Item::Coordinates(section) = item else { continue };
            for coordinate in &section.entries {
                let new = || Plain {
                    name: names.take(&coordinate.name),
                    unit: None,
                    limits: None,
                    ..coordinate.clone()
                };
                push(&mut coordinates, &coordinate.name, |coordinate: &Plain| &coordinate.name, new);
            }
        }
        if coordinates.is_empty() {
            let name = unnamed(names);
            coordinates.push(Plain { docs: Docs::default(), name, unit: None, limits: None });
        }
        let held = held(declaration);
        let kinds = of_forms(declaration, coordinates.len(), kinds);
        // What a scene holds has to rest: its rate is a constraint, and these come last.
        let (last, first): (Vec<&Plain>, Vec<&Plain>) =
            coordinates.iter().partition(|coordinate| held.contains(&coordinate.name.text.clone()));
        let mut free =
            Free(first.into_iter().chain(last).map(|coordinate| coordinate.name.clone()).collect());
        let mut forms = Forms {
            coordinates: coordinates.clone(),
            parameters: Vec::new(),
            constraints: Vec::new(),
            resting: BTreeSet::new(),
            driven: None,
            fields: Fields(coordinates.iter().map(|coordinate| coordinate.name.text.clone()).collect()),
        };
        for item in &declaration.items {
            let Item::Parameters(section) = item else { continue };
            section
                .entries
                .iter()
                .for_each(|entry| forms.parameter(entry, (&kinds, &held), &mut free, names));
        }
        forms.choose(declaration, &kinds, &mut free, names);
        forms.resting = free.0.iter().map(|name| name.text.clone()).collect();
        forms.constrain(declaration, &kinds, &mut free, names);
        forms
    }

    /// Whether no field of the state and of the forms has this name.
    pub(super) fn is_free(&self, name: &Name) -> bool {
        !self.fields.0.contains(&name.text.clone())
    }

    fn parameter(
        &mut self,
        entry: &Definition,
        (kinds, held): (&BTreeMap<String, Kind>, &BTreeSet<String>),
        free: &mut Free,
        names: &mut Names,
    ) {
        let kind = kinds[&entry.name.text.clone()];
        if !self.fields.add(&entry.name, kind) {
            return;
        }
        let Some(own) = free.take(kind) else { return };
        if !held.contains(&entry.name.text.clone()) && self.driven.is_none() {
            self.driven = own.first().cloned();
        }
        let value = of_kind(kind, &own, rate);
        self.parameters.push(Definition { docs: entry.docs.clone(), name: names.take(&entry.name), value });
    }

    /// The parameters that the declaration leaves to the macro: of which coordinates is not known where there are faults, so that
    /// they are those of the first that no declared parameter mentions.
    fn choose(
        &mut self,
        declaration: &Declaration,
        kinds: &BTreeMap<String, Kind>,
        free: &mut Free,
        names: &mut Names,
    ) {
        let is_constraint = |item: &Item| matches!(item, Item::Constraints(_) | Item::Holonomic(_));
        let entries =
            declaration.items.iter().filter(|item| is_constraint(item)).flat_map(|item| match item {
                Item::Constraints(section) | Item::Holonomic(section) => section.entries.as_slice(),
                _ => &[],
            });
        let needed: usize = entries.map(|entry| components(kinds[&entry.name.text.clone()])).sum();
        let count = free.0.len().saturating_sub(needed);
        let given = declaration.items.iter().filter_map(|item| match item {
            Item::Parameters(section) => Some(&section.entries),
            _ => None,
        });
        let given: Vec<&Definition> = given.flatten().collect();
        let is_given = |x: &Plain| given.iter().any(|entry| entry.value.mentions(&x.name.text));
        let (last, first): (Vec<Plain>, Vec<Plain>) = self.coordinates.iter().cloned().partition(is_given);
        for coordinate in first.into_iter().chain(last).take(count) {
            let name = coordinate.name.suffixed(RATE_SUFFIX);
            if !self.fields.add(&name, Kind::Scalar) {
                continue;
            }
            let Some(own) = free.take(Kind::Scalar) else { return };
            self.driven.get_or_insert_with(|| own[0].clone());
            let value = of_kind(Kind::Scalar, &own, rate);
            self.parameters.push(Definition { docs: Docs::default(), name: names.take(&name), value });
        }
    }

    /// The constraints as far as there are coordinates, and further ones where there are too few.
    fn constrain(
        &mut self,
        declaration: &Declaration,
        kinds: &BTreeMap<String, Kind>,
        free: &mut Free,
        names: &mut Names,
    ) {
        let fields = &mut self.fields;
        let mut equations = |entries: &[Equation], part: fn(&Name) -> Expression, free: &mut Free| {
            let mut found = Vec::new();
            for entry in entries {
                let kind = kinds[&entry.name.text.clone()];
                if !fields.add(&entry.name, kind) {
                    continue;
                }
                let Some(own) = free.take(kind) else { break };
                let (left, name) = (of_kind(kind, &own, part), names.take(&entry.name));
                found.push(Equation { name, left, right: number(0), ..entry.clone() });
            }
            section(found)
        };
        for item in &declaration.items {
            match item {
                Item::Constraints(section) => {
                    self.constraints.push(Item::Constraints(equations(&section.entries, rate, free)));
                }
                Item::Holonomic(section) => {
                    self.constraints.push(Item::Holonomic(equations(&section.entries, value, free)));
                }
                _ => {}
            }
        }
        let further: Vec<Equation> = free
            .0
            .drain(..)
            .map(|coordinate| Equation {
                docs: Docs::default(),
                name: unnamed(names),
                left: rate(&coordinate),
                equals: Span::call_site(),
                right: number(0),
            })
            .collect();
        self.constraints.push(Item::Constraints(section(further)));
        self.constraints.retain(|item| match item {
            Item::Constraints(section) | Item::Holonomic(section) => !section.entries.is_empty(),
            _ => true,
        });
    }
}

/// The names that scenes hold at their initial values.
fn held(declaration: &Declaration) -> BTreeSet<String> {
    let scenes = declaration.items.iter().filter_map(|item| match item {
        Item::Scene(scene) => Some(scene),
        _ => None,
    });
    scenes.flat_map(|scene| &scene.fixes).map(|fix| fix.name.text.clone()).collect()
}
