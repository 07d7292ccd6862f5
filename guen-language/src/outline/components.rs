//! Components in the braces of a system, and instances: those whose names the generated module needs for itself are called otherwise.

use std::rc::Rc;

use proc_macro2::Ident;
use quote::{ToTokens, format_ident};

use crate::syntax::{Component, Declaration, Index, Instance, Item, Name, Path};

/// Returns the outline with new names for components whose names are among the faults of the declaration.
pub(super) fn free_names(mut outline: Declaration, declaration: &Declaration) -> Declaration {
    let renamed: Vec<(String, Name)> = declaration
        .components
        .iter()
        .map(|(component, _)| &component.name)
        .filter(|name| declaration.takes_name(&name.text))
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

/// Returns the outline with new names for the modules of instances whose names are among the faults of the declaration. Their fields
/// keep their names, by which the rest of the crate reads them.
pub(super) fn free_modules(mut outline: Declaration, declaration: &Declaration) -> Declaration {
    let roots: Vec<Ident> = outline.instances.iter().map(|instance| instance.path.root.clone()).collect();
    let is_taken = |module: &Ident| declaration.takes_module(&module.to_string());
    let module = |root: &Ident| {
        let mut module = format_ident!("other_{root}", span = root.span());
        while is_taken(&module) || roots.contains(&module) {
            module = format_ident!("other_{module}", span = root.span());
        }
        module
    };
    let free = |path: &mut Path| {
        if roots.contains(&path.root) && is_taken(&path.root) {
            path.module = Some(module(&path.root));
        }
    };
    outline.instances.iter_mut().for_each(|instance| free(&mut instance.path));
    for name in outline.items.iter_mut().flat_map(Item::declared_mut) {
        if let Index::Entry(path) = &mut name.index {
            free(path);
        }
    }
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
