//! The order of what instances bring: constants, inputs and coordinates of the system first, then those of its instances.

use super::Unfolded;
use crate::diagnostics::{Fault, Faults};
use crate::limits::{MAX_COORDINATES, MAX_ENTRIES};
use crate::syntax::{
    Component, Declaration, Expression, ExpressionKind, Item, Name, Plain, Quantity, Section, Visibility,
};

/// Reports what a system cannot be without, and what it may not have so many of.
pub(super) fn check(system: &Name, items: &[Item], faults: &mut Faults) {
    let entries =
        |of: fn(&Item) -> bool| items.iter().filter(|item| of(item)).map(|item| item.declared().len()).sum();
    let coordinates: usize = entries(|item| matches!(item, Item::Coordinates(_)));
    if coordinates == 0 {
        let text = format!("system `{system}` has no coordinates, and neither have its instances");
        faults.report(Fault::new(system.span(), text).help("add `coordinates { x, y }`"));
    }
    let mut limited = |count: usize, most: usize, what: &str| {
        if count > most {
            let text = format!("more than {most} {what}, with those of all instances");
            faults.report(Fault::new(system.span(), text));
        }
    };
    limited(coordinates, MAX_COORDINATES, "coordinates");
    limited(entries(|item| matches!(item, Item::Constants(_))), MAX_ENTRIES, "constants");
    limited(entries(|item| matches!(item, Item::Inputs(_))), MAX_ENTRIES, "inputs");
    limited(entries(|item| matches!(item, Item::Parameters(_))), MAX_ENTRIES, "parameters");
    let has_energy = items
        .iter()
        .any(|item| matches!(item, Item::KineticEnergy(_) | Item::Particles(_) | Item::Bodies(_)));
    if !has_energy {
        let text = format!("system `{system}` has no kinetic energy, and neither have its instances");
        let fault = Fault::new(system.span(), text);
        faults.report(fault.help("add `kinetic_energy = e;`, `particles { .. }` or `bodies { .. }`"));
    }
}

/// The items with one section of constants, one of inputs and one of coordinates, at the place of the first of them.
pub(super) fn merged(items: Vec<Item>, origins: Vec<Option<usize>>) -> (Vec<Item>, Vec<Option<usize>>) {
    let is_first = |item: &Item| matches!(item, Item::Constants(_) | Item::Inputs(_) | Item::Coordinates(_));
    let place = items.iter().position(is_first).unwrap_or(items.len());
    let mut constants = Vec::new();
    let mut inputs = Vec::new();
    let mut coordinates = Vec::new();
    let mut rest = (Vec::new(), Vec::new());
    for (item, origin) in items.into_iter().zip(origins) {
        match item {
            Item::Constants(section) => constants.push((origin, section)),
            Item::Inputs(section) => inputs.push((origin, section)),
            Item::Coordinates(section) => coordinates.push((origin, section)),
            item => {
                rest.0.push(item);
                rest.1.push(origin);
            }
        }
    }
    let one = [
        joined(constants).map(Item::Constants),
        joined(inputs).map(Item::Inputs),
        joined(coordinates).map(Item::Coordinates),
    ];
    let one: Vec<Item> = one.into_iter().flatten().collect();
    let count = one.len();
    rest.0.splice(place..place, one);
    rest.1.splice(place..place, std::iter::repeat_n(None, count));
    rest
}

/// The sections as one, in the order of their instances; that of the system itself comes first.
fn joined<T>(mut sections: Vec<(Option<usize>, Section<T>)>) -> Option<Section<T>> {
    sections.sort_by_key(|(origin, _)| *origin);
    let mut sections = sections.into_iter().map(|(_, section)| section);
    let mut first = sections.next()?;
    sections.for_each(|section| first.entries.extend(section.entries));
    Some(first)
}

/// A declaration with the constants and functions of a component, and one coordinate, so that it is one.
pub(super) fn constants(component: &Component, content: &Unfolded) -> Declaration {
    let sections = content.items.iter().zip(&content.origins).filter_map(|(item, origin)| match item {
        Item::Constants(section) => Some((*origin, section.clone())),
        _ => None,
    });
    let constants = joined(sections.collect()).map(Item::Constants);
    let functions = content.items.iter().filter(|item| matches!(item, Item::Functions(_))).cloned();
    let taken: Vec<&Name> = content.items.iter().flat_map(Item::declared).collect();
    let mut text = "coordinate".to_owned();
    while taken.iter().any(|name| name.root() == text.as_str()) {
        text.push('_');
    }
    let place = component.name.span();
    let coordinate = Name::new(proc_macro2::Ident::new(&text, place));
    let plain = Plain { docs: Default::default(), name: coordinate.clone(), unit: None, limits: None };
    let value = |kind| Expression::new(place, kind);
    let rate = value(ExpressionKind::Call {
        function: Name::new(proc_macro2::Ident::new("dot", place)),
        arguments: vec![value(ExpressionKind::Name(coordinate))],
        list: place,
    });
    let square = ExpressionKind::Power {
        base: Box::new(rate),
        exponent: Box::new(value(ExpressionKind::Number(crate::syntax::Number {
            digits: "2".to_owned(),
            exponent: 0,
            text: "2".to_owned(),
        }))),
    };
    let energy = Quantity { docs: Default::default(), keyword: place, value: value(square) };
    let coordinates = Section::new(Default::default(), place, vec![plain]);
    let rest = [Item::Coordinates(coordinates), Item::KineticEnergy(energy)];
    Declaration {
        tokens: Default::default(),
        crate_path: component.crate_path.clone(),
        docs: Default::default(),
        visibility: Visibility::Private,
        name: component.name.clone(),
        items: constants.into_iter().chain(functions).chain(rest).collect(),
        nesting: Vec::new(),
        counts: Vec::new(),
        imported: Vec::new(),
        instances: content.instances.clone(),
        components: Vec::new(),
        origins: Vec::new(),
        in_mode: None,
        is_outline: false,
        of_modes: Default::default(),
    }
}
