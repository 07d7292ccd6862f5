//! All contacts together: the mechanics that their forces act on, and the modes.

use guen_symbolic::{Function, Rational, SystemGraph, Workbench};

use super::*;
use crate::model::SceneModes;
use crate::model::contact::Contacts;

/// The contacts with the mechanics that their forces act on. In the system itself no force acts, and switches follow the state.
pub(in crate::model::resolve) fn assembled<'a>(
    bench: &mut Workbench,
    mechanics: &mut Mechanics,
    entries: Vec<ContactEntry<'a>>,
    (switches, resets): (Vec<SwitchEntry<'a>>, Vec<ResetEntry<'a>>),
    modes: Vec<Vec<usize>>,
    structure: SystemGraph,
) -> Contacts<'a> {
    let mut pressed = mechanics.clone();
    pressed.structure = structure;
    let rows = entries.iter().flat_map(|entry| &entry.rows);
    pressed.forces.extend(rows.clone().map(|row| Force { magnitude: row.force, along: row.form }));
    pressed.outputs.extend(entries.iter().filter_map(|entry| entry.load_reaction));
    pressed.inputs.extend(switches.iter().map(|switch| switch.symbol));
    pressed.inputs.extend(rows.map(|row| row.force));
    let switched = switches.iter();
    let values: Vec<(ExprId, ExprId)> =
        switched.map(|switch| (switch.symbol, value_of_switch(&mut bench.graph, switch.function))).collect();
    // Without contact there is no force.
    let zero = bench.graph.zero();
    let unpressed = entries.iter().flat_map(|entry| &entry.rows).map(|row| (row.force, zero));
    let mut values = Substitution::new(values.into_iter().chain(unpressed));
    let expressions = mechanics.forces.iter_mut().map(|force| &mut force.magnitude);
    let rates = mechanics.states.iter_mut().map(|state| &mut state.rate);
    for e in expressions.chain(rates).chain(&mut mechanics.outputs) {
        *e = values.of(&mut bench.graph, *e);
    }
    Contacts { entries, switches, resets, modes, mechanics: pressed }
}

impl Resolver<'_, '_> {
    /// Whether the declaration has contacts, switches or resets.
    pub(in crate::model::resolve) fn has_contacts(&self) -> bool {
        let has_none = self.switches.is_empty() && self.contacts.is_empty() && self.resets.is_empty();
        self.declaration.in_mode.is_none() && !has_none
    }

    /// The modes of the declaration; `None` without contacts, switches and resets, and after a fault.
    pub(in crate::model::resolve) fn modes(&mut self) -> Option<Vec<Vec<usize>>> {
        let declaration = self.declaration;
        let mut keyword = None;
        for (place, item) in declaration.items.iter().enumerate() {
            let is_own = declaration.origins.get(place).copied().flatten().is_none();
            match item {
                // That of a family without members says nothing.
                Item::Modes(section) if section.entries.is_empty() && !self.eval.scope.has_contacts() => {}
                Item::Modes(section) if !self.eval.scope.has_contacts() => {
                    let text = "there are no contacts that `modes` could speak of";
                    let fault = Fault::new(section.keyword, text);
                    self.eval.faults.report(fault.help("declare them: `contacts { name: gap = e; }`"));
                    return None;
                }
                Item::Contacts(contacts) if is_own => keyword = Some(contacts.keyword),
                Item::Switches(switches) if is_own => keyword = keyword.or(Some(switches.keyword)),
                Item::Resets(resets) if is_own => keyword = keyword.or(Some(resets.keyword)),
                _ => {}
            }
        }
        if !self.has_contacts() {
            return None;
        }
        // Where instances alone have contacts, what is said of all of them is said of the system.
        let keyword = keyword.unwrap_or(declaration.name.span());
        let missing = self.missing_contacts();
        let entries: Vec<&ContactEntry<'_>> = self.contacts.iter().map(|contact| &contact.entry).collect();
        let known = (&entries[..], &missing);
        super::super::modes::combinations(known, declaration, keyword, self.eval.faults)
    }

    /// The contacts of which something is wrong.
    pub(in crate::model::resolve) fn missing_contacts(&self) -> BTreeSet<String> {
        let declared = self.declaration.items.iter().flat_map(|item| match item {
            Item::Contacts(section) => &section.entries[..],
            _ => &[],
        });
        let known = |name: &str| self.contacts.iter().any(|contact| contact.entry.name.text == name);
        declared.map(|contact| contact.name.text.clone()).filter(|name| !known(name)).collect()
    }
}

/// A switch that follows the state: 1, 0, or 1/2 at the zero of its function.
pub(super) fn value_of_switch(graph: &mut Graph, function: ExprId) -> ExprId {
    let half = graph.number(Rational::new(1, 2));
    let sign = graph.function(Function::Sign, function);
    let half_sign = graph.mul(half, sign);
    graph.add(half, half_sign)
}

/// The modes of a scene of a system with contacts or switches; `None` after a fault.
pub(in crate::model::resolve) fn modes_of_scene(
    (entries, missing): (&[&ContactEntry<'_>], &BTreeSet<String>),
    modes: Option<&[Vec<usize>]>,
    scene: &Scene,
    faults: &mut Faults,
) -> Option<SceneModes> {
    let left = match scene.modes.is_empty() {
        // A fault in the modes of the system was reported.
        true => modes?.to_vec(),
        false => super::super::modes::of_scene((entries, missing), modes, scene, faults)?,
    };
    let [mode] = &left[..] else { return Some(SceneModes::Several(left)) };
    Some(SceneModes::One(mode.clone()))
}
