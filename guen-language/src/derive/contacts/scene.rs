//! Contacts in a scene that runs through several modes: what the scene has to know of them, and their equations as it sees them.
//!
//! A row that no mode of the scene lets move is zero there. Where the scene lacks a variable of such a row, the row and its gap are
//! numbers.

use std::rc::Rc;

use guen_symbolic::{Dependence, ExprId, Programs, Workbench};
use proc_macro2::Span;

use super::super::closure::Reason;
use super::super::fixed::Holding;
use super::super::parts::View;
use super::super::selection::{Selection, StateIndex, StatePart};
use super::programs::{Level, programs};
use super::{ContactEquations, ContactFacts, ContactFunctions, FreeMotion, limits};
use crate::diagnostics::{Fault, Faults};
use crate::model::{ContactEntry, ContactState, Contacts, Model};
use crate::syntax::Name;

/// The contacts of a scene.
pub(in crate::derive) struct SceneContacts<'c, 'a> {
    contacts: &'c Contacts<'a>,
    modes: &'c [Vec<usize>],
    motions: Vec<FreeMotion>,
    functions: ContactFunctions,
    /// Whether each row stays zero in every mode of the scene.
    rests: Vec<bool>,
    /// Whether the gap of each contact does.
    stays_closed: Vec<bool>,
    /// The switches that the scene has.
    pub(in crate::derive) switches: Vec<usize>,
}

impl<'c, 'a> SceneContacts<'c, 'a> {
    /// The contacts in these modes, with these switches and without those that nothing has needed yet.
    pub(in crate::derive) fn new(
        contacts: &'c Contacts<'a>,
        modes: &'c [Vec<usize>],
        equations: &Rc<ContactEquations>,
        switches: Vec<usize>,
    ) -> Self {
        let (mut rests, mut stays_closed) = (Vec::new(), Vec::new());
        for (place, entry) in contacts.entries.iter().enumerate() {
            let everywhere =
                |is: fn(ContactState) -> bool| modes.iter().all(|mode| is(entry.states()[mode[place]]));
            let closed = entry.gap.is_some()
                && everywhere(|state| !matches!(state, ContactState::Open | ContactState::Free));
            let sticks = everywhere(|state| state == ContactState::Stick);
            let normal = usize::from(entry.gap.is_some());
            rests.extend((0..entry.rows.len()).map(|row| if row < normal { closed } else { sticks }));
            stays_closed.push(closed);
        }
        let ContactEquations { motions, functions } = &**equations;
        let (motions, functions) = (motions.clone(), functions.clone());
        SceneContacts { contacts, modes, motions, functions, rests, stays_closed, switches }
    }

    /// Puts in variables that are held as constants.
    pub(in crate::derive) fn hold(&mut self, bench: &mut Workbench, holding: &mut Holding) {
        let motions = self.motions.iter_mut().flat_map(FreeMotion::expressions);
        motions.chain(self.functions.expressions()).for_each(|e| *e = holding.of(bench, *e));
    }

    /// Reports held variables that the forces of contacts move.
    pub(in crate::derive) fn check_held(&self, model: &mut Model<'_>, held: &[&Name], faults: &mut Faults) {
        for name in held {
            let mover = model.places(&name.text).into_iter().find_map(|place| self.mover(model, place));
            if let Some(mover) = mover {
                let fault = Fault::new(name.span(), format!("`{name}` cannot be fixed: it moves"));
                let fault = fault.note(format!("the forces of `{}` change it", mover.name));
                faults.report(fault.help("leave it out: what nothing depends on is not kept"));
            }
        }
    }

    /// The first contact whose forces change a variable.
    fn mover(&self, model: &mut Model<'_>, place: StateIndex) -> Option<&'c ContactEntry<'a>> {
        let own = place.checked_sub(model.coordinates.len())?;
        let owners = self.contacts.entries.iter().flat_map(|entry| entry.rows.iter().map(move |_| entry));
        let responses = self.motions.first()?.responses.iter().map(|response| response[own]);
        let moves =
            |bench: &mut Workbench, e: ExprId| bench.verdict_on_manifold(e) != guen_symbolic::Verdict::Zero;
        owners.zip(responses).find(|(_, e)| moves(&mut model.bench, *e)).map(|(entry, _)| entry)
    }

    /// Tells by place whether forces of contacts change a variable.
    pub(in crate::derive) fn pressed_places(&self, model: &mut Model<'_>) -> Vec<bool> {
        let (_, size) = model.sizes();
        (0..size).map(|place| self.mover(model, place).is_some()).collect()
    }

    /// The rates without forces of contacts and what these add to them, by place.
    pub(in crate::derive) fn pressed(&self, n: usize) -> Vec<Vec<ExprId>> {
        let Some(motion) = self.motions.first() else { return Vec::new() };
        let places = motion.rates.iter().enumerate();
        places
            .map(|(place, rate)| {
                let own = place.checked_sub(n);
                let responses = own.into_iter().flat_map(|own| motion.responses.iter().map(move |r| r[own]));
                [*rate].into_iter().chain(responses).collect()
            })
            .collect()
    }

    /// The values of these outputs with the forces of contacts, component by component.
    pub(in crate::derive) fn output(&self, component: usize) -> ExprId {
        self.functions.outputs[component]
    }

    /// The quantities of contacts that the modes of the scene watch, and those that decide transitions and impacts.
    pub(in crate::derive) fn watched(&self) -> Vec<(Reason, ExprId)> {
        let mut found = Vec::new();
        let ContactFunctions { gaps, rows, friction, stiction, limits, loads, conditions, .. } =
            &self.functions;
        let Some(motion) = self.motions.first() else { return found };
        let [when, release] = conditions;
        let (mut first, mut loading) = (0, 0);
        for (place, entry) in self.contacts.entries.iter().enumerate() {
            let mut add = |e: ExprId| found.push((Reason::Contact(entry.name.text.clone()), e));
            let count = entry.rows.len();
            if !self.stays_closed[place] {
                add(gaps[place]);
                when[place].into_iter().for_each(&mut add);
            }
            for (row, form) in rows.iter().enumerate().skip(first).take(count) {
                if !self.rests[row] {
                    add(*form);
                }
                add(motion.biases[row]);
                let before = row * (row + 1) / 2;
                motion.delassus[before..=before + row].iter().for_each(|e| add(*e));
            }
            for list in [friction, stiction, limits] {
                add(list[place]);
            }
            release[place].into_iter().for_each(&mut add);
            if entry.load_reaction.is_some() {
                let size = 1 + rows.len();
                loads[loading * size..][..size].iter().for_each(|e| add(*e));
                loading += 1;
            }
            first += count;
        }
        for switch in &self.switches {
            let name = self.contacts.switches[*switch].name.text.clone();
            found.push((Reason::Switch(name), self.functions.switches[*switch]));
        }
        found
    }

    /// Takes the switches that some expressions depend on; whether there are new ones among them.
    pub(in crate::derive) fn take_switches(
        &mut self,
        bench: &mut Workbench,
        dependence: &mut Dependence,
        expressions: &[ExprId],
    ) -> bool {
        let before = self.switches.len();
        for (place, switch) in self.contacts.switches.iter().enumerate() {
            if !self.switches.contains(&place)
                && expressions.iter().any(|e| dependence.depends(bench, *e, switch.symbol))
            {
                self.switches.push(place);
            }
        }
        self.switches.sort_unstable();
        self.switches.len() > before
    }

    /// The symbols of the switches that the scene lacks.
    pub(in crate::derive) fn idle(&self) -> impl Iterator<Item = ExprId> {
        let switches = self.contacts.switches.iter().enumerate();
        switches.filter(|(place, _)| !self.switches.contains(place)).map(|(_, switch)| switch.symbol)
    }

    /// The programs of the contacts over what the scene keeps, with the facts; `None` after a fault.
    pub(in crate::derive) fn programs(
        self,
        model: &mut Model<'_>,
        view: &mut View,
        selection: &Selection,
        name: Span,
        faults: &mut Faults,
    ) -> Option<(Programs, ContactFacts)> {
        let SceneContacts { contacts, modes, motions, functions, rests, stays_closed, switches } = self;
        let motions = motions_of(model, view, selection, &motions);
        let zero = model.bench.graph.zero();
        // On the constraints of all modes of the scene.
        let or_rest = |model: &mut Model<'_>, view: &mut View, e: ExprId, rests: bool| {
            let replaced = view.replaced(model, e);
            if rests && view.is_lost(model, replaced) { zero } else { view.of(model, e) }
        };
        let mut seen = functions.clone();
        // A scene has none.
        seen.resets.clear();
        seen.given.clear();
        for (gap, rests) in seen.gaps.iter_mut().zip(&stays_closed) {
            *gap = or_rest(model, view, *gap, *rests);
        }
        for ((row, drift), rests) in seen.rows.iter_mut().zip(&mut seen.drifts).zip(&rests) {
            *row = or_rest(model, view, *row, *rests);
            *drift = or_rest(model, view, *drift, *rests);
        }
        for condition in seen.conditions.iter_mut().flatten() {
            // A condition that the scene does not need is one of a contact that never closes there.
            let is_lost = condition.is_some_and(|e| {
                let e = view.replaced(model, e);
                view.is_lost(model, e)
            });
            *condition = condition.filter(|_| !is_lost).map(|e| view.of(model, e));
        }
        let coefficients = [&mut seen.friction, &mut seen.stiction, &mut seen.limits];
        for list in coefficients.into_iter().chain([&mut seen.loads, &mut seen.restitutions]) {
            list.iter_mut().for_each(|e| *e = view.of(model, *e));
        }
        for switch in &switches {
            seen.switches[*switch] = view.of(model, seen.switches[*switch]);
        }
        let components = selection.outputs.iter().flat_map(|o| model.outputs[*o].components.clone());
        let components: Vec<usize> = components.collect();
        seen.outputs = components.into_iter().map(|c| view.of(model, functions.outputs[c])).collect();
        let limits = limits(model);
        let level =
            Level { modes, switches: &switches, motions: &motions, functions: &seen, limits: &limits };
        programs(&mut model.bench, contacts, &level, name, faults)
    }
}

/// The motion of what a scene keeps, in the forms that depend on nothing else.
fn motions_of(
    model: &mut Model<'_>,
    view: &mut View,
    selection: &Selection,
    motions: &[FreeMotion],
) -> Vec<FreeMotion> {
    let n = model.coordinates.len();
    let moving: Vec<usize> = selection
        .variables
        .iter()
        .filter(|place| !matches!(model.part(**place), StatePart::Coordinate(_)))
        .map(|place| place - n)
        .collect();
    let restricted = motions.iter().map(|motion| FreeMotion {
        rates: selection.variables.iter().map(|place| motion.rates[*place]).collect(),
        responses: motion.responses.iter().map(|r| moving.iter().map(|own| r[*own]).collect()).collect(),
        ..motion.clone()
    });
    let mut restricted: Vec<FreeMotion> = restricted.collect();
    let mut place = 0;
    // Off the constraints an equal form may depend on more than the first one.
    restricted.retain_mut(|motion| {
        place += 1;
        place == 1
            || !motion.expressions().any(|e| {
                let e = view.replaced(model, *e);
                view.is_lost(model, e)
            })
    });
    restricted.iter_mut().flat_map(FreeMotion::expressions).for_each(|e| *e = view.of(model, *e));
    restricted
}
