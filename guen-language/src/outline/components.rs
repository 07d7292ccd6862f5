//! Components in the braces of a system: those whose names the generated module needs for itself are called otherwise.

use std::rc::Rc;

use quote::{ToTokens, format_ident};

use crate::syntax::{Component, Declaration, Instance, Name};

/// Returns the outline with new names for components whose names are among the faults of the declaration.
pub(super) fn free_names(mut outline: Declaration, declaration: &Declaration) -> Declaration {
    let renamed: Vec<(String, Name)> = declaration
        .components
        .iter()
        .map(|(component, _)| &component.name)
        .filter(|name| declaration.takes_name_of(name))
        .map(|name| (name.text.clone(), Name::new(format_ident!("Other{}", name.ident))))
        .collect();
    let new = |text: &str| renamed.iter().find(|(old, _)| old == text).map(|(_, name)| name.clone());
    for (component, constants) in &mut outline.components {
        if let Some(name) = new(&component.name.text) {
            constants.name = name.clone();
            *component = Rc::new(Component { name, ..Component::clone(component) });
        }
        rename(&mut constants.instances, &new);
    }
    rename(&mut outline.instances, &new);
    outline
}

fn rename(instances: &mut [Instance], new: &dyn Fn(&str) -> Option<Name>) {
    for instance in instances {
        if let Some(name) = new(&instance.component.text).filter(|_| instance.component.is_name()) {
            instance.component.tokens = name.ident.to_token_stream();
            instance.component.text.clone_from(&name.text);
            instance.component.name = name;
        }
    }
}
