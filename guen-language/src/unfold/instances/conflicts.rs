//! Names of instances and components that the generated module needs for itself.

use crate::diagnostics::{Fault, Faults};
use crate::names::{REAL, is_function, is_reserved, module_name};
use crate::syntax::{Declaration, Item, Name};

/// Reports instances and components whose modules and structs would have the names of others.
pub(super) fn check(declaration: &Declaration, faults: &mut Faults) {
    let scenes: Vec<_> = declaration
        .items
        .iter()
        .filter_map(|item| match item {
            Item::Scene(scene) => Some(&scene.name),
            _ => None,
        })
        .collect();
    for item in &declaration.items {
        match item {
            Item::Use(instance) => {
                if instance.path.text == REAL && is_imported(declaration, REAL) {
                    let text = format!("a component cannot be used by the name `{REAL}`");
                    let fault = Fault::new(instance.path.name.span(), text);
                    let fault = fault.note(format!("`{REAL}` is the real type of generated code"));
                    let help = format!("import it by another name, as `use module::{REAL} as Other`");
                    faults.report(fault.help(help));
                }
                let name = &instance.name;
                let text = name.root().to_string();
                let has_module = |scene: &Name| module_name(&scene.ident, "scene") == text;
                let scene = scenes.iter().find(|scene| scene.text == text || has_module(scene));
                let fault = || Fault::new(name.span(), format!("an instance cannot be called `{text}`"));
                if is_reserved(&text) {
                    let what = if is_function(&text) { "the name of a function" } else { "reserved" };
                    let text = format!("`{text}` is {what} and cannot name an instance");
                    faults.report(Fault::new(name.span(), text).help("choose another name"));
                } else if let Some(scene) = scene {
                    let item = if has_module(scene) { "module" } else { "type" };
                    let note = format!("scene `{scene}` has a {item} of that name, declared");
                    let fault = fault().note_place(&note, scene.span());
                    faults.report(fault.help("choose another name for one of them"));
                } else if declaration.takes_name(&text) {
                    let fault =
                        fault().note(format!("the module of the system has an item `{text}` of its own"));
                    faults.report(fault.help("choose another name"));
                }
            }
            Item::Component(component) => {
                let name = &component.name;
                if declaration.takes_name(&name.text) {
                    let text =
                        format!("a component in the braces of a system cannot be called `{name}` here");
                    let fault = Fault::new(name.span(), text);
                    let note = format!("the module of the system has an item `{name}` of its own");
                    faults.report(fault.note(note).help("choose another name"));
                }
            }
            _ => {}
        }
    }
}

fn is_imported(declaration: &Declaration, path: &str) -> bool {
    declaration.imported.iter().any(|imported| imported.path == path)
}
