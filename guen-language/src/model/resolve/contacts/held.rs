//! A contact that stays in one state: what it holds becomes constraints, and what slips has a force.

use super::*;
use crate::model::Load;
use crate::syntax::{HeldContact, SlipDirection};

impl<'a> Resolver<'a, '_> {
    /// Declares the constraints and forces of a contact in its state, and returns it as outputs see it.
    pub(super) fn hold(&mut self, contact: &mut RawContact<'a>, held: &'a HeldContact) -> ContactValue {
        let name = contact.entry.name;
        let first = self.constraints.len();
        match &held.gap {
            Some(rate) if held.gap_by_rate => self.eval.constraint(rate, &mut self.constraints),
            Some(gap) => {
                self.eval.holonomic(gap, &mut self.constraints);
                self.judge_on_positions();
            }
            None => {}
        }
        held.slip.iter().for_each(|slip| self.eval.constraint(slip, &mut self.constraints));
        let mut forms = Vec::new();
        for form in &mut self.constraints[first..] {
            form.entry.written = name;
            forms.push(form.symbol);
        }
        let zero = self.eval.bench.graph.zero();
        let unknown = held.is_undetermined.then(|| {
            let text = format!("reaction({name})");
            self.eval.bench.graph.symbol(&text, Role::Input)
        });
        self.undetermined.extend(unknown);
        let mut forms = forms.into_iter();
        for (row, is_held) in contact.entry.rows.iter_mut().zip(&held.rows) {
            let form = if *is_held { forms.next().unwrap_or(zero) } else { zero };
            row.force = unknown.unwrap_or(form);
        }
        if let Some(direction) = held.slides {
            self.slide(contact, direction);
        }
        ContactValue { is_held: true, ..self.value_of(&contact.entry) }
    }

    /// The force `-mu N d` of a contact that slips, or `-F d` of a grip: along each row of its slip.
    fn slide(&mut self, contact: &mut RawContact<'a>, direction: SlipDirection) {
        let normal = usize::from(contact.entry.gap.is_some());
        let load = self.load(&contact.entry);
        let graph = &mut self.eval.bench.graph;
        let entry = &mut contact.entry;
        let slips: Vec<ExprId> = entry.rows[normal..].iter().map(|row| row.form).collect();
        let one = graph.one();
        let (speed, directions) = match direction {
            SlipDirection::Positive => (slips[0], vec![one]),
            SlipDirection::Negative => (graph.neg(slips[0]), vec![graph.neg(one)]),
            SlipDirection::Velocity => {
                let squares: Vec<ExprId> = slips.iter().map(|slip| graph.mul(*slip, *slip)).collect();
                let square = graph.sum(squares);
                self.slips.push((square, format!("{} does not slip", entry.name)));
                let speed = graph.sqrt(square);
                (speed, slips.iter().map(|slip| graph.div(*slip, speed)).collect())
            }
        };
        let zero = graph.zero();
        let coefficient = entry.friction.unwrap_or(zero);
        let magnitude = match (entry.limit, load) {
            (Some(limit), _) => limit,
            (None, Some(load)) => graph.mul(coefficient, load),
            (None, None) => zero,
        };
        let magnitude = Substitution::new(entry.speed.map(|symbol| (symbol, speed))).of(graph, magnitude);
        for (row, direction) in entry.rows[normal..].iter_mut().zip(directions) {
            let along = graph.mul(magnitude, direction);
            row.force = graph.neg(along);
            self.forces.push(Force { magnitude: row.force, along: row.form });
        }
        let shapes = contact.shapes[normal..].iter().cloned();
        self.eval.shapes.system.loads.extend(shapes);
    }

    /// The symbol of the reaction that friction is a multiple of; `None` where nothing presses, or the load is written out.
    fn load(&mut self, entry: &ContactEntry<'a>) -> Option<ExprId> {
        let loading = match (entry.kind, entry.loaded_by) {
            (ContactKind::Grip, Some(row)) => {
                let rows = self.contacts.iter().flat_map(|known| &known.entry.rows);
                rows.map(|row| row.force).nth(row)
            }
            (ContactKind::Grip, None) => entry.load_reaction,
            _ => Some(entry.rows[0].force),
        };
        let multiplier = self.eval.multipliers(Value::Scalar(loading?), entry.name);
        let Value::Scalar(reaction) = multiplier else { return None };
        if self.eval.bench.graph.is_zero(reaction) {
            return None;
        }
        let is_magnitude = entry.load_reaction.is_some();
        let same = |load: &&Load<'_>| load.reaction == reaction && load.is_magnitude == is_magnitude;
        if let Some(load) = self.loads.iter().find(same) {
            return Some(load.symbol);
        }
        let symbol = self.eval.bench.graph.symbol(&format!("load of {}", entry.name), Role::Input);
        self.loads.push(Load { name: entry.name, symbol, reaction, is_magnitude });
        Some(symbol)
    }
}
