//! Scenes: which variables one keeps is not known where the declaration has faults, so each keeps all that it does not
//! hold, and provides everything.

use proc_macro2::{Ident, Span};

use super::expressions::number;
use super::forms::Forms;
use super::{Entries, push};
use crate::names::module_name;
use crate::syntax::{Declaration, Docs, Fix, Item, ModeStatement, Name, Provide, Scene, Section};

/// The scenes but those whose name is among the faults.
pub(super) fn items(declaration: &Declaration, entries: &Entries, forms: &Forms) -> Vec<Item> {
    let mut scenes: Vec<Scene> = Vec::new();
    for item in &declaration.items {
        let Item::Scene(scene) = item else { continue };
        let module = |scene: &Scene| module_name(&scene.name.ident, "scene");
        let is_of_system = scene.name.text == declaration.name.text
            || module(scene) == declaration.name.text
            || crate::names::is_generated_item(&module(scene).to_string())
            || crate::names::is_generated_type_or_constant(&scene.name.text)
            || crate::names::CARRIED_ITEMS.contains(&scene.name.text.as_str());
        if !is_of_system && scenes.iter().all(|other| module(other) != module(scene)) {
            scenes.push(sound(scene, declaration, entries, forms));
        }
    }
    scenes.into_iter().map(Item::Scene).collect()
}

fn sound(scene: &Scene, declaration: &Declaration, entries: &Entries, forms: &Forms) -> Scene {
    let mut fixes: Vec<Fix> = Vec::new();
    for Fix { name, .. } in &scene.fixes {
        let is_it = |other: &&Name| other.text == name.text;
        let constant = entries.constants.iter().map(|constant| &constant.name).find(is_it);
        let resting = forms.coordinates.iter().map(|x| &x.name).filter(|x| forms.resting.contains(&x.text));
        let states = entries.states.iter().map(|state| &state.name);
        let parameters = forms.parameters.iter().map(|parameter| &parameter.name);
        let variable = parameters.chain(resting).chain(states).find(is_it);
        if let Some(known) = constant.or(variable) {
            let new = || Fix { name: known.clone(), value: constant.map(|_| number(1)) };
            push(&mut fixes, name, |fix| &fix.name, new);
        }
    }
    let variables = forms.coordinates.iter().map(|coordinate| &coordinate.name);
    let variables = variables.chain(forms.parameters.iter().map(|parameter| &parameter.name));
    let variables = variables.chain(entries.states.iter().map(|state| &state.name));
    let tracks =
        variables.filter(|name| fixes.iter().all(|fix| fix.name.text != name.text)).cloned().collect();
    let words = ["energy", "linearization", "operators", "reactions"].into_iter();
    let words = words.filter(|word| *word != "reactions" || !forms.constraints.is_empty());
    let provided = words.map(|word| Name::new(Ident::new(word, Span::call_site())));
    let outputs = entries.outputs.iter().map(|output| output.name.clone());
    let mut provides: Vec<Provide> = provided.chain(outputs).map(|name| Provide { name, of: None }).collect();
    for provide in &scene.provides {
        let word = provide.name.text.as_str();
        if ["taylor", "source"].contains(&word) || (word == "carried" && forms.driven.is_some()) {
            push(
                &mut provides,
                &provide.name,
                |provide| &provide.name,
                || Provide { of: None, ..provide.clone() },
            );
        }
    }
    // Modes in an outline say that the scene is a smooth system.
    let modes = match has_several_modes(scene, declaration) {
        true => Vec::new(),
        false => vec![Section::new(Docs::default(), Span::call_site(), Vec::new())],
    };
    Scene { tracks, fixes, provides, modes, ..scene.clone() }
}

/// Whether a scene runs through modes, as far as the statements tell: some contact has several states, or there are resets, which it may have.
fn has_several_modes(scene: &Scene, declaration: &Declaration) -> bool {
    if declaration.items.iter().any(|item| matches!(item, Item::Resets(_))) {
        return true;
    }
    let of_system = declaration.items.iter().filter_map(|item| match item {
        Item::Modes(section) => Some(section),
        _ => None,
    });
    let statements: Vec<&ModeStatement> =
        scene.modes.iter().chain(of_system).flat_map(|section| &section.entries).collect();
    let contacts = declaration.items.iter().filter_map(|item| match item {
        Item::Contacts(section) => Some(&section.entries),
        _ => None,
    });
    contacts.flatten().any(|contact| {
        let mut of_contact = statements.iter().filter_map(|statement| match statement {
            ModeStatement::States { contact: name, states } if name.text == contact.name.text => Some(states),
            _ => None,
        });
        // Slip along a line has two directions.
        !of_contact.any(|states| states.len() == 1 && states[0].text != "slip")
    })
}
