//! The quantities and variables that a scene asks for: what it provides and tracks.

use guen_symbolic::{Derivation, ExprId, Substitution};

use crate::derive::contacts::SceneContacts;
use crate::derive::selections::closure::Reason;
use crate::derive::selections::fixed::Holding;
use crate::derive::selections::selection::{Selection, StateIndex};
use crate::diagnostics::{Fault, Faults};
use crate::model::{Model, SceneEntry};
use crate::syntax::Name;

/// Returns the quantities that the scene says it provides; reports those that the system does not have.
pub(super) fn provided(
    model: &Model<'_>,
    derivation: &Derivation,
    contacts: Option<&SceneContacts<'_, '_>>,
    scene: &SceneEntry<'_>,
    faults: &mut Faults,
) -> Selection {
    let l = derivation.system.forms.degrees;
    let mut selection = Selection::default();
    let is_loose = |v: &usize| {
        let mode = model.declaration.in_mode.iter();
        mode.flat_map(|mode| &mode.contacts)
            .any(|contact| contact.is_undetermined && contact.has(&model.forms[*v].name))
    };
    let known = |v: &usize| derivation.reactions[*v - l].is_some() && !is_loose(v);
    for provide in &scene.scene.provides {
        let name = &provide.name;
        match name.text.as_str() {
            "energy" => selection.energy = true,
            "linearization" => selection.linearization = true,
            "operators" => selection.operators = true,
            // Of the programs, once they are there.
            "taylor" | "source" => {}
            "reactions" => match &provide.of {
                None => {
                    let all = (l..model.forms.len()).filter(known);
                    let (count, bound) = (selection.reactions.len(), model.forms.len() - l);
                    selection.reactions.extend(all);
                    if selection.reactions.len() == count {
                        faults.report(no_reaction(name, bound == 0));
                    }
                }
                Some(of) => {
                    for constraint in of {
                        let forms = model.constraints(&constraint.text);
                        if forms.is_empty() {
                            faults.report(no_rows(model, contacts, constraint));
                        } else if forms.iter().any(is_loose) {
                            faults.report(not_determined(constraint, &constraint.text));
                        } else if !forms.iter().all(known) {
                            faults.report(no_reaction(constraint, false));
                        } else {
                            selection.reactions.extend(forms);
                        }
                    }
                }
            },
            // A form of its own, derived when this one is.
            "carried" if !is_output(model, name) => {}
            output => {
                let place = model.outputs.iter().position(|known| known.name.text == output);
                for c in place.iter().flat_map(|o| &model.outputs[*o].components) {
                    let symbols = model.bench.graph.symbols_in(&[model.mechanics.outputs[*c]]);
                    let unknown = model.undetermined.iter().find(|reaction| {
                        model.bench.graph.as_symbol(**reaction).is_some_and(|r| symbols.contains(&r))
                    });
                    if let Some(reaction) = unknown {
                        faults.report(not_determined(name, &model.bench.graph.text(*reaction)));
                        break;
                    }
                }
                selection.outputs.extend(place);
            }
        }
    }
    for list in [&mut selection.reactions, &mut selection.outputs] {
        list.sort_unstable();
        list.dedup();
    }
    selection
}

/// The fault of a reaction of something without a row: a constraint that says 0 = 0, a contact that does not touch, or any contact in a scene
/// with resets.
fn no_rows(model: &Model<'_>, contacts: Option<&SceneContacts<'_, '_>>, name: &Name) -> Fault {
    if contacts.is_some_and(|contacts| contacts.has(name)) {
        return Fault::new(name.span(), format!("`{name}` is not a constraint"))
            .note("the scene has resets, so it is no smooth system in which contacts are constraints")
            .help(format!("declare an output, `force = reaction({name});`, and provide that"));
    }
    match &model.declaration.in_mode {
        Some(mode) => Fault::new(name.span(), format!("`{name}` has no reaction in this scene"))
            .note(format!("its mode is: {}", mode.words)),
        None => Fault::new(name.span(), format!("`{name}` was left out: it says 0 = 0")),
    }
}

/// A reaction that only together with others is determined.
fn not_determined(place: &Name, what: &str) -> Fault {
    Fault::new(place.span(), format!("`{what}` is not determined in the mode of this scene")).note(
        "the rows of its contact depend on those of others: only sums of their reactions are determined",
    )
}

fn no_reaction(name: &Name, is_free: bool) -> Fault {
    if is_free {
        return Fault::new(name.span(), "this system has no constraints, and so no reactions");
    }
    Fault::new(name.span(), "the kinetic energy does not tell this reaction")
        .note("it is given on the constraints, where the momentum is lost")
        .help("write the energy in the velocities, with the constraints dropped")
}

/// The variables that the scene tracks: those named, else the parameters.
pub(super) fn tracked(model: &Model<'_>, scene: &SceneEntry<'_>) -> Vec<StateIndex> {
    let (n, l) = (model.coordinates.len(), model.mechanics.forms.degrees);
    let named = scene.scene.tracks.iter().flat_map(|name| model.places(&name.text));
    if scene.scene.tracks.is_empty() { (n..n + l).collect() } else { named.collect() }
}

/// Reports what a scene tracks and no variable stands for, and a scene that fixes all that it would track.
pub(super) fn check_tracked(
    model: &Model<'_>,
    scene: &SceneEntry<'_>,
    tracked: &[StateIndex],
    faults: &mut Faults,
) {
    let (name, before) = (&scene.scene.name, faults.count());
    for own in scene.scene.tracks.iter().filter(|own| model.places(&own.text).is_empty()) {
        let fault = Fault::new(own.span(), format!("`{own}` is zero, and scene `{name}` cannot track it"));
        faults.report(fault.note("a component of a vector that is zero is no variable"));
    }
    if tracked.is_empty() && faults.count() == before {
        let fault = match scene.scene.tracks.first() {
            Some(own) => Fault::new(own.span(), format!("nothing that scene `{name}` tracks moves")),
            None => Fault::new(name.span(), format!("scene `{name}` has nothing that moves"))
                .note("without `track` the parameters are tracked, and all of them are fixed"),
        };
        faults.report(fault.help("write `track` and what somebody will look at"));
    }
}

/// Returns the provided quantities that depend on the state, by name, with accelerations as functions of the state.
pub(super) fn wanted(
    model: &mut Model<'_>,
    derivation: &Derivation,
    holding: &mut Holding,
    rates: &[ExprId],
    selection: &Selection,
) -> Vec<(Reason, ExprId)> {
    let (n, l) = (model.coordinates.len(), derivation.system.forms.degrees);
    let accelerations = derivation.system.accelerations.iter().copied().zip(rates[n..].iter().copied());
    let mut solved = Substitution::new(accelerations);
    let mut found: Vec<(Reason, ExprId)> = Vec::new();
    if selection.energy {
        found.push((Reason::Provided("provide energy".to_owned()), derivation.energies.integral));
    }
    for v in &selection.reactions {
        let reason = Reason::Provided(format!("provide reactions({})", model.forms[*v].name));
        found.extend(derivation.reactions[*v - l].map(|e| (reason, e)));
    }
    for output in selection.outputs.iter().map(|o| &model.outputs[*o]) {
        let reason = Reason::Provided(format!("provide {}", output.name.text));
        found.extend(output.components.iter().map(|c| (reason.clone(), derivation.outputs[*c])));
    }
    for name in model.declaration.in_mode.iter().flat_map(|mode| &mode.tracked) {
        let follower = model.followers.iter().find(|follower| follower.name == *name);
        let reason = Reason::Provided(format!("track {name}"));
        found.extend(follower.map(|f| (reason, derivation.outputs[f.output])));
    }
    for (_, e) in &mut found {
        *e = holding.of(&mut model.bench, *e);
        *e = solved.of(&mut model.bench.graph, *e);
    }
    found
}

/// The provided outputs with the forces of contacts.
pub(super) fn of_outputs(
    model: &Model<'_>,
    contacts: &SceneContacts<'_, '_>,
    selection: &Selection,
) -> Vec<(Reason, ExprId)> {
    let outputs = selection.outputs.iter().map(|o| &model.outputs[*o]);
    let components = outputs.flat_map(|output| {
        let reason = Reason::Provided(format!("provide {}", output.name.text));
        output.components.iter().map(move |c| (reason.clone(), contacts.output(*c)))
    });
    components.collect()
}

pub(super) fn is_output(model: &Model<'_>, name: &Name) -> bool {
    model.outputs.iter().any(|output| output.name.text == name.text)
}
