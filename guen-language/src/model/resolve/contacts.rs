//! `contacts` and `switches`: gaps, velocities along contacts, coefficients, conditions.

mod along;
mod assembled;
mod coefficients;
mod held;
mod signs;
mod words;

use guen_symbolic::FormShape;

use coefficients::Loading;

use super::*;
use crate::limits::MAX_CONTACTS;
use crate::model::contact::{ContactEntry, ContactKind, ContactRow, SwitchEntry};
use crate::model::value::ContactValue;
use crate::syntax::{Clause, ClauseWord, Contact, StatesType, Switch, type_of_states};

pub(super) use assembled::{assembled, modes_of_scene};

/// A contact on its way into the model: with the structure of its rows.
pub(super) struct RawContact<'a> {
    pub(super) entry: ContactEntry<'a>,
    pub(super) shapes: Vec<Option<FormShape>>,
}

impl<'a> Resolver<'a, '_> {
    /// `name: e;` of `switches`.
    pub(super) fn switch(&mut self, switch: &'a Switch) {
        self.eval.entry = Some(switch.name.text.clone());
        let function = self.eval.scalar_at(ExpressionPlace::Switch, &switch.value);
        let mut symbol = self.eval.bench.graph.symbol(&switch.name.text, Role::Input);
        let function = function.and_then(|function| {
            let signs = self.signs(function, None);
            if signs.above && (signs.below || signs.zero) {
                return Ok(function);
            }
            let text = format!("the switch `{}` never changes", switch.name);
            let fault = Fault::new(switch.value.extent(), text);
            let (value, sign) = if signs.above { (1, "everywhere") } else { (0, "nowhere") };
            self.eval.fail(fault.note(format!("it is {value}: its function is {sign} above zero")))
        });
        if let (Some(_), Ok(function)) = (&self.declaration.in_mode, &function) {
            // Without contacts it follows the state.
            symbol = assembled::value_of_switch(&mut self.eval.bench.graph, *function);
        }
        self.declare_symbol(&switch.name, Category::Switch, symbol);
        if let Ok(function) = function {
            self.switches.push(SwitchEntry { name: &switch.name, docs: &switch.docs, symbol, function });
        }
    }

    /// `name: gap = e, ..;` of `contacts`.
    pub(super) fn contact(&mut self, contact: &'a Contact) {
        self.eval.entry = Some(contact.name.text.clone());
        let entry = self.entry(contact);
        self.eval.scope.declare(self.eval.faults, &contact.name, Category::Contact, None);
        self.type_of_states(contact);
        match entry {
            Ok(mut entry) if self.contacts.len() < MAX_CONTACTS => {
                let value = match &self.declaration.in_mode {
                    Some(mode) => self.hold(&mut entry, &mode.contacts[self.contacts.len()]),
                    None => self.value_of(&entry.entry),
                };
                self.eval.contacts.insert(contact.name.text.clone(), value);
                self.contacts.push(entry);
            }
            Ok(_) => {
                let text = format!("more than {MAX_CONTACTS} contacts");
                self.eval.faults.report(
                    Fault::new(contact.name.span(), text)
                        .note("every combination of their states is a mode of its own"),
                );
            }
            Err(_) => {}
        }
    }

    /// The states of a contact are a type, which has the name of the contact.
    fn type_of_states(&mut self, contact: &Contact) {
        let name = &contact.name;
        let own = type_of_states(name);
        let others = self.contacts.iter().map(|other| other.entry.name);
        let mut others = others.map(|other| (other, type_of_states(other)));
        let is_another = |of: &StatesType| of.contact != own.contact;
        let same = others.find(|(_, of)| of.module == own.module && of.name == own.name && is_another(of));
        let same = same.map(|(other, _)| format!("`{other}` has it, too"));
        let taken = self.declaration.takes_type(&own).or(same);
        if let Some(why) = taken {
            let fault = Fault::new(name.span(), format!("a contact cannot be called `{name}` here"));
            let fault = fault.note(format!("its states are the type `{}`: {why}", own.name));
            self.eval.faults.report(fault.help("choose another name"));
        }
    }

    /// A contact as outputs see it.
    fn value_of(&self, entry: &ContactEntry<'_>) -> ContactValue {
        let zero = self.eval.bench.graph.zero();
        let of_rows = |rows: &[ContactRow], of: fn(&ContactRow) -> ExprId| match rows {
            [row] => Value::Scalar(of(row)),
            _ => Value::Vector(std::array::from_fn(|i| rows.get(i).map_or(zero, of))),
        };
        let tangential = &entry.rows[usize::from(entry.gap.is_some())..];
        ContactValue {
            gap: entry.gap,
            slip: (!tangential.is_empty()).then(|| of_rows(tangential, |row| row.form)),
            reaction: of_rows(&entry.rows, |row| row.force),
            is_held: false,
            kind: entry.kind,
        }
    }

    /// Reports what is wrong in the clauses of a contact of which it is not known what it is.
    fn clauses(&mut self, contact: &'a Contact) {
        for clause in &contact.clauses {
            let place = match clause.word {
                ClauseWord::Gap => ExpressionPlace::Gap,
                ClauseWord::Slip => ExpressionPlace::Slip,
                ClauseWord::Grip => ExpressionPlace::Grip,
                ClauseWord::Latch => ExpressionPlace::Latch,
                ClauseWord::Stiction => ExpressionPlace::Stiction,
                ClauseWord::Restitution => ExpressionPlace::Restitution,
                ClauseWord::Limit => ExpressionPlace::GripForce,
                ClauseWord::When | ClauseWord::Release => ExpressionPlace::Condition,
                // `speed` and `reaction(name)` have their meaning there.
                ClauseWord::Friction | ClauseWord::Load => continue,
            };
            let _reported = self.eval.at(place, &clause.value);
        }
    }

    fn entry(&mut self, contact: &'a Contact) -> Evaluated<RawContact<'a>> {
        let before = self.eval.faults.count();
        let kind = match self.kind(contact) {
            Ok(kind) => kind,
            Err(reported) => {
                self.clauses(contact);
                return Err(reported);
            }
        };
        self.words(contact, kind);
        let mut rows = Vec::new();
        let mut shapes = Vec::new();
        let mut axes = Vec::new();
        let mut gap = None;
        if matches!(kind.word, ClauseWord::Gap | ClauseWord::Latch)
            && let Ok(value) = self.gap(contact, kind)
        {
            gap = Some(value);
            let rate = self.eval.total_rate(value);
            self.eval.shapes.scalar_rate(&self.eval.bench.graph, value, rate);
            shapes.push(self.eval.shapes.form(rate));
            rows.push(rate);
        }
        let along = if kind.word == ClauseWord::Grip { Some(kind) } else { contact.clause(ClauseWord::Slip) };
        if let Some(clause) = along
            && let Ok(along) = self.slip(contact, clause)
        {
            rows.extend(along.forms);
            shapes.extend(along.shapes);
            axes = along.axes;
        }
        let name = &contact.name.text;
        let speed = along.map(|_| self.eval.bench.graph.symbol(&format!("speed of {name}"), Role::Input));
        let coefficient = |this: &mut Self, word: ClauseWord| {
            let clause = contact.clause(word)?;
            this.coefficient(contact, clause, speed).ok()
        };
        let friction = coefficient(self, ClauseWord::Friction);
        let stiction = coefficient(self, ClauseWord::Stiction);
        let restitution = match contact.clause(ClauseWord::Restitution) {
            Some(clause) => self.restitution(contact, clause).ok(),
            None => None,
        };
        let force = |this: &mut Self, word: ClauseWord| {
            let clause = contact.clause(word)?;
            this.force_of_grip(contact, clause).ok()
        };
        let limit = force(self, ClauseWord::Limit);
        let loading = contact.clause(ClauseWord::Load).and_then(|clause| self.loading(contact, clause));
        let load = match loading {
            Some(_) => None,
            None => force(self, ClauseWord::Load),
        };
        let (loaded_by, load_reaction) = match loading {
            Some(Loading::Row(row)) => (Some(row), None),
            Some(Loading::Constraint(reaction)) => (None, Some(reaction)),
            Some(Loading::Fault) | None => (None, None),
        };
        let condition = |this: &mut Self, word: ClauseWord| {
            let clause = contact.clause(word)?;
            let value = this.eval.scalar_at(ExpressionPlace::Condition, &clause.value);
            this.condition(contact, clause, value).ok()
        };
        let when = condition(self, ClauseWord::When);
        let release = condition(self, ClauseWord::Release);
        // A clause whose expression is faulty has no value; its fault is reported already.
        let is_there = |clause: &Clause| match clause.word {
            ClauseWord::Gap | ClauseWord::Latch => gap.is_some(),
            ClauseWord::Slip | ClauseWord::Grip => rows.len() > usize::from(gap.is_some()),
            ClauseWord::Friction => friction.is_some(),
            ClauseWord::Stiction => stiction.is_some(),
            ClauseWord::Restitution => restitution.is_some(),
            ClauseWord::Limit => limit.is_some(),
            ClauseWord::Load => load.is_some() || loaded_by.is_some() || load_reaction.is_some(),
            ClauseWord::When => when.is_some(),
            ClauseWord::Release => release.is_some(),
        };
        if self.eval.faults.count() > before || !contact.clauses.iter().all(is_there) {
            return Err(self.eval.faults.reported_before());
        }
        let zero = self.eval.bench.graph.zero();
        let at_rest = |graph: &mut Graph, e: ExprId| {
            let still = speed.map(|speed| (speed, zero));
            Substitution::new(still).of(graph, e)
        };
        let graph = &mut self.eval.bench.graph;
        let symbol = speed.and_then(|speed| graph.as_symbol(speed));
        let friction_of_speed = friction.is_some_and(|friction| {
            symbol.is_some_and(|speed| graph.symbols_in(&[friction]).contains(&speed))
        });
        if let (Some(friction), Some(stiction)) = (friction, stiction) {
            let still = at_rest(graph, friction);
            let less = graph.sub(still, stiction);
            let signs = self.signs(less, None);
            if !signs.below && !signs.zero {
                let clause = contact.clause(ClauseWord::Stiction).unwrap_or(kind);
                let text = format!("the stiction of `{}` is below its friction", contact.name);
                let fault = Fault::new(clause.value.extent(), text);
                let fault = fault.note("what neither sticks nor starts to slip has no motion");
                return self.eval.fail(fault);
            }
        }
        let graph = &mut self.eval.bench.graph;
        let stiction = stiction.or_else(|| friction.map(|friction| at_rest(graph, friction)));
        let limit = match (limit, friction, load) {
            (None, Some(friction), Some(load)) => Some(graph.mul(friction, load)),
            (limit, ..) => limit,
        };
        let tangential = rows.len() - usize::from(gap.is_some());
        let kind_of = match (kind.word, tangential) {
            (ClauseWord::Grip, _) => ContactKind::Grip,
            (ClauseWord::Latch, _) => ContactKind::Latch,
            (_, 0) => ContactKind::Smooth,
            (_, 1) => ContactKind::Planar,
            _ => ContactKind::Spatial,
        };
        let rows = rows.into_iter().enumerate().map(|(i, form)| {
            let force = graph.symbol(&format!("force {i} of {name}"), Role::Input);
            ContactRow { form, force }
        });
        let entry = ContactEntry {
            name: &contact.name,
            docs: &contact.docs,
            kind: kind_of,
            gap,
            gap_span: kind.value.extent(),
            along_spans: along.map(|clause| places_of_components(clause, &axes)).unwrap_or_default(),
            rows: rows.collect(),
            axes,
            friction,
            stiction,
            friction_of_speed,
            speed,
            restitution: restitution.unwrap_or(zero),
            limit,
            loaded_by,
            load_reaction,
            when,
            release,
        };
        Ok(RawContact { entry, shapes })
    }
}

/// The places of the components of a velocity: those of the arguments where they are written one by one.
fn places_of_components(clause: &Clause, axes: &[&'static str]) -> Vec<proc_macro2::Span> {
    let whole = clause.value.extent();
    let arguments = match &clause.value.kind {
        ExpressionKind::Call { function, arguments, .. } if function.text == "vec" => &arguments[..],
        _ => &[],
    };
    let place = |axis: &str| ["x", "y", "z"].iter().position(|known| *known == axis);
    let own = |axis: &&str| place(axis).and_then(|i| arguments.get(i)).map_or(whole, Expression::extent);
    if axes.is_empty() { vec![whole] } else { axes.iter().map(own).collect() }
}
