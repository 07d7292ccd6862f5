//! The names of a component with the name of an instance in front.

use crate::syntax::{Index, Item, Name, Path, Step};
use crate::unfold::component_names::OwnNames;

/// The path of the field that an instance is.
pub(super) fn path_of(instance: &Name) -> Path {
    instance.path().cloned().unwrap_or_else(|| Path { root: instance.ident.clone(), steps: Vec::new() })
}

/// A path inside of an instance.
pub(super) fn behind(instance: &Path, own: &Path) -> Path {
    let steps = instance.steps.iter().cloned();
    let steps = steps.chain([Step::Field(own.root.clone())]).chain(own.steps.iter().cloned());
    Path { root: instance.root.clone(), steps: steps.collect() }
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
    let hidden: Vec<String> = match &item {
        Item::Function(function) => function.parameters.iter().map(|name| name.text.clone()).collect(),
        _ => Vec::new(),
    };
    item.declared_mut().into_iter().for_each(|own| *own = name(own, instance));
    item.expressions_mut().into_iter().for_each(|e| {
        e.names_mut(&mut |own| {
            let is_hidden = matches!(own.index, Index::None) && hidden.contains(&own.text);
            if !is_hidden && names.has(own.root().to_string().trim_start_matches("r#")) {
                *own = name(own, instance);
            }
        });
    });
    item
}
