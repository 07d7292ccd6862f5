//! All contacts together: the mechanics that their forces act on, and the modes.

use guen_symbolic::{Function, Rational, SystemGraph, Workbench};

use super::*;
use crate::model::contact::Contacts;

/// The contacts with the mechanics that their forces act on. In the system itself no force acts, and switches follow the state.
pub(in crate::model::resolve) fn assembled<'a>(
    bench: &mut Workbench,
    mechanics: &mut Mechanics,
    entries: Vec<ContactEntry<'a>>,
    switches: Vec<SwitchEntry<'a>>,
    modes: Vec<Vec<usize>>,
    structure: SystemGraph,
) -> Contacts<'a> {
    let mut pressed = mechanics.clone();
    pressed.structure = structure;
    let rows = entries.iter().flat_map(|entry| &entry.rows);
    pressed.forces.extend(rows.clone().map(|row| Force { magnitude: row.force, along: row.form }));
    pressed.inputs.extend(switches.iter().map(|switch| switch.symbol));
    pressed.inputs.extend(rows.map(|row| row.force));
    let graph = &mut bench.graph;
    let half = graph.number(Rational::new(1, 2));
    let values: Vec<(ExprId, ExprId)> = switches
        .iter()
        .map(|switch| {
            let sign = graph.function(Function::Sign, switch.function);
            let (sign, half_sign) = (half, graph.mul(half, sign));
            (switch.symbol, graph.add(sign, half_sign))
        })
        .collect();
    // Without contact there is no force.
    let zero = bench.graph.zero();
    let unpressed = entries.iter().flat_map(|entry| &entry.rows).map(|row| (row.force, zero));
    let mut values = Substitution::new(values.into_iter().chain(unpressed));
    let expressions = mechanics.forces.iter_mut().map(|force| &mut force.magnitude);
    for e in expressions.chain(&mut mechanics.outputs) {
        *e = values.of(&mut bench.graph, *e);
    }
    Contacts { entries, switches, modes, mechanics: pressed }
}

impl Resolver<'_, '_> {
    /// Whether the declaration has contacts or switches.
    pub(in crate::model::resolve) fn has_contacts(&self) -> bool {
        !self.switches.is_empty() || !self.contacts.is_empty()
    }

    /// The modes of the declaration; `None` without contacts or switches, and after a fault.
    pub(in crate::model::resolve) fn modes(&mut self) -> Option<Vec<Vec<usize>>> {
        let declaration = self.declaration;
        let mut keyword = None;
        for (place, item) in declaration.items.iter().enumerate() {
            let is_own = declaration.origins.get(place).copied().flatten().is_none();
            match item {
                Item::Modes(section) if self.contacts.is_empty() => {
                    let text = "there are no contacts that `modes` could speak of";
                    let fault = Fault::new(section.keyword, text);
                    self.eval.faults.report(fault.help("declare them: `contacts { name: gap = e; }`"));
                    return None;
                }
                Item::States(states) if self.has_contacts() && !states.entries.is_empty() => {
                    let text = "a system with contacts or switches has no `states` so far";
                    self.eval.faults.report(Fault::new(states.keyword, text));
                    return None;
                }
                Item::Contacts(contacts) if is_own => keyword = Some(contacts.keyword),
                Item::Switches(switches) if is_own => keyword = keyword.or(Some(switches.keyword)),
                _ => {}
            }
        }
        if !self.has_contacts() {
            return None;
        }
        // Where instances alone have contacts, what is said of all of them is said of the system.
        let keyword = keyword.unwrap_or(declaration.name.span());
        let entries: Vec<&ContactEntry<'_>> = self.contacts.iter().map(|contact| &contact.entry).collect();
        super::super::modes::combinations(&entries, declaration, keyword, self.eval.faults)
    }
}

/// Refuses a scene of a system with contacts or switches.
pub(in crate::model::resolve) fn refuse_scene(scene: &Scene, faults: &mut Faults) {
    let text = "a system with contacts or switches has no scenes so far";
    let fault = Fault::new(scene.keyword, text);
    faults.report(fault.help("declare what the scene requires as a system of its own"));
}
