//! The names of a component with the name of an instance in front.

use crate::syntax::{Expression, Index, Item, ModeStatement, Name, Path, Step};
use crate::unfold::component_names::OwnNames;

/// The path of the field that an instance is.
pub(super) fn path_of(instance: &Name) -> Path {
    instance.path().cloned().unwrap_or_else(|| Path {
        root: instance.ident.clone(),
        module: None,
        steps: Vec::new(),
    })
}

/// A path inside of an instance.
pub(super) fn behind(instance: &Path, own: &Path) -> Path {
    let steps = instance.steps.iter().cloned();
    let steps = steps.chain([Step::Field(own.root.clone())]).chain(own.steps.iter().cloned());
    Path { root: instance.root.clone(), module: None, steps: steps.collect() }
}

/// A name of the component as that of an instance; its place stays in the component.
pub(super) fn name(own: &Name, instance: &Path) -> Name {
    let path = path_of(own);
    let mut name = Name::at(behind(instance, &path));
    name.ident.set_span(own.span());
    name
}

/// An item of the component with the names of an instance.
pub(super) fn item(item: &Item, instance: &Path, names: &OwnNames<'_>) -> Item {
    let mut item = item.clone();
    item.declared_mut().into_iter().for_each(|own| *own = name(own, instance));
    let within = |e: &mut Expression, hidden: &[&str]| expression(e, hidden, instance, names);
    match &mut item {
        Item::Function(function) => {
            let hidden: Vec<&str> = function.parameters.iter().map(|name| name.text.as_str()).collect();
            within(&mut function.value, &hidden);
        }
        Item::Contacts(section) => {
            let clauses = section.entries.iter_mut().flat_map(|contact| &mut contact.clauses);
            clauses.for_each(|clause| within(&mut clause.value, clause.word.own_names()));
        }
        Item::Modes(section) => {
            let contacts = section.entries.iter_mut().flat_map(ModeStatement::contacts_mut);
            contacts.filter(|own| names.has(&root_of(own))).for_each(|own| *own = name(own, instance));
        }
        item => item.expressions_mut().into_iter().for_each(|e| within(e, &[])),
    }
    item
}

fn expression(e: &mut Expression, hidden: &[&str], instance: &Path, names: &OwnNames<'_>) {
    e.names_mut(
        &mut |own| {
            let is_hidden = matches!(own.index, Index::None) && hidden.contains(&own.text.as_str());
            if !is_hidden && names.has(&root_of(own)) {
                *own = name(own, instance);
            }
        },
        &mut |function| {
            // That of an instance in the component has a path.
            if names.has_function(&function.text) || function.path().is_some() {
                *function = name(function, instance);
            }
        },
    );
}

/// The name in front of what leads to an entry or a member.
fn root_of(name: &Name) -> String {
    name.root().to_string().trim_start_matches("r#").to_owned()
}
