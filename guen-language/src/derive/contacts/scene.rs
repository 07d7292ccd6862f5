//! Contacts in a scene that runs through several modes: what the scene has to know of them, and their equations as it sees them.
//!
//! A row that no mode of the scene lets move is zero there. Where the scene lacks a variable of such a row, the row and its gap are
//! numbers.
//!
//! A scene has every reset that changes a variable of the scene. It also has every reset that may move a gap or a row which is zero in all its
//! modes: behind such a reset the run checks whether it still is.

use std::rc::Rc;

use guen_symbolic::{Dependence, ExprId, Programs, Workbench};
use proc_macro2::Span;

use super::programs::{LevelContacts, programs};
use super::{ContactEquations, ContactFacts, ContactFunctions, FreeMotion, ResetFacts, limits, resets};
use crate::derive::quantities::parts::View;
use crate::derive::selections::closure::Reason;
use crate::derive::selections::fixed::Holding;
use crate::derive::selections::selection::{Selection, StateIndex, StatePart};
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
    /// Every reset of the system, with the places of its variables in the whole state.
    resets: Vec<ResetFacts>,
    /// Whether the scene has each of their assignments.
    assigned: Vec<Vec<bool>>,
    /// The quantities that the resets of the scene need.
    of_resets: Vec<(Reason, ExprId)>,
}

impl<'c, 'a> SceneContacts<'c, 'a> {
    /// The contacts in these modes, with these switches, and without switches and resets that nothing has needed yet.
    pub(in crate::derive) fn new(
        model: &Model<'_>,
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
        let resets = resets(model, contacts);
        let assigned = resets.iter().map(|reset| vec![false; reset.assignments.len()]).collect();
        let of_resets = Vec::new();
        SceneContacts {
            contacts,
            modes,
            motions,
            functions,
            rests,
            stays_closed,
            switches,
            resets,
            assigned,
            of_resets,
        }
    }

    /// Puts in variables that are held as constants.
    pub(in crate::derive) fn hold(&mut self, bench: &mut Workbench, holding: &mut Holding) {
        let motions = self.motions.iter_mut().flat_map(FreeMotion::expressions);
        motions.chain(self.functions.expressions()).for_each(|e| *e = holding.of(bench, *e));
    }

    /// Reports held variables that the forces of contacts move or a reset changes.
    pub(in crate::derive) fn check_held(&self, model: &mut Model<'_>, held: &[&Name], faults: &mut Faults) {
        for name in held {
            let mover = model.places(&name.text).into_iter().find_map(|place| self.mover(model, place));
            if let Some(mover) = mover {
                let fault = Fault::new(name.span(), format!("`{name}` cannot be fixed: it moves"));
                let fault = fault.note(format!("the forces of `{}` change it", mover.name));
                faults.report(fault.help("leave it out: what nothing depends on is not kept"));
                continue;
            }
            let changer = model.places(&name.text).into_iter().find_map(|place| self.changer(place));
            if let Some(changer) = changer {
                let fault = Fault::new(name.span(), format!("`{name}` cannot be fixed: it moves"));
                let fault = fault.note(format!("the reset `{changer}` changes it"));
                faults.report(fault.help("leave it out: what nothing depends on is not kept"));
            }
        }
    }

    /// Whether this is the name of a contact.
    pub(in crate::derive) fn has(&self, name: &Name) -> bool {
        self.contacts.entries.iter().any(|entry| entry.name.text == name.text)
    }

    /// The name of the first reset of the system that changes a variable.
    pub(in crate::derive) fn changer(&self, place: StateIndex) -> Option<&'c Name> {
        let changes = |reset: &&ResetFacts| reset.assignments.iter().any(|(_, changed)| *changed == place);
        self.resets.iter().find(changes).map(|reset| self.contacts.resets[reset.reset].name)
    }

    /// Whether the scene has a reset.
    pub(in crate::derive) fn has_resets(&self) -> bool {
        self.assigned.iter().flatten().any(|assigned| *assigned)
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
        found.extend(self.of_resets.iter().cloned());
        found
    }

    /// The gaps and rows that are zero in every mode of the scene.
    fn resting(&self) -> Vec<ExprId> {
        let ContactFunctions { gaps, rows, .. } = &self.functions;
        let gaps = gaps.iter().zip(&self.stays_closed);
        let resting = gaps.chain(rows.iter().zip(&self.rests));
        resting.filter(|(_, rests)| **rests).map(|(e, _)| *e).collect()
    }

    /// The coordinates that must not be eliminated by these equations, because a reset may break the equations in which they stand.
    pub(in crate::derive) fn reset_coordinates(
        &self,
        bench: &mut Workbench,
        dependence: &mut Dependence,
        (coordinates, equations): (&[Option<ExprId>], &[ExprId]),
    ) -> Vec<StateIndex> {
        let is_changed = |place: &StateIndex| self.changer(*place).is_some();
        let mut found: Vec<StateIndex> = (0..coordinates.len()).filter(is_changed).collect();
        let changed = found.clone();
        for equation in equations {
            let on: Vec<StateIndex> = (0..coordinates.len())
                .filter(|place| coordinates[*place].is_some_and(|x| dependence.depends(bench, *equation, x)))
                .collect();
            if on.iter().any(|place| changed.contains(place)) {
                found.extend(on);
            }
        }
        found
    }

    /// Takes the resets that change a kept variable, or a gap or row that is zero in the scene. Returns whether a new one was taken.
    ///
    /// A reset needs its function, its new values, and the gaps, rows and equations on positions that it may break.
    pub(in crate::derive) fn take_resets(
        &mut self,
        bench: &mut Workbench,
        dependence: &mut Dependence,
        (variables, equations): (&[Option<ExprId>], &[ExprId]),
        is_kept: impl Fn(StateIndex) -> bool,
    ) -> bool {
        let breakable = [self.resting(), equations.to_vec()].concat();
        let resting = breakable.len() - equations.len();
        let (mut is_new, mut first) = (false, 0);
        for (reset, assigned) in self.resets.iter().zip(&mut self.assigned) {
            let entry = &self.contacts.resets[reset.reset];
            let reason = Reason::Reset(entry.name.text.clone());
            for ((given, place), assigned) in reset.assignments.iter().zip(assigned) {
                let Some(variable) = variables[*place].filter(|_| !*assigned) else { continue };
                let mut changes = |e: &ExprId| dependence.depends(bench, *e, variable);
                if !is_kept(*place) && !breakable[..resting].iter().any(&mut changes) {
                    continue;
                }
                let broken: Vec<ExprId> = breakable.iter().copied().filter(changes).collect();
                let read =
                    [variable, self.functions.resets[reset.reset], self.functions.given[first + given]];
                self.of_resets.extend(read.into_iter().chain(broken).map(|e| (reason.clone(), e)));
                (*assigned, is_new) = (true, true);
            }
            first += entry.assignments.len();
        }
        is_new
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
        let SceneContacts {
            contacts,
            modes,
            motions,
            functions,
            rests,
            stays_closed,
            switches,
            resets,
            assigned,
            ..
        } = self;
        let motions = motions_of(model, view, selection, &motions);
        let zero = model.bench.graph.zero();
        // On the constraints of all modes of the scene.
        let or_rest = |model: &mut Model<'_>, view: &mut View, e: ExprId, rests: bool| {
            let replaced = view.replaced(model, e);
            if rests && view.is_lost(model, replaced) { zero } else { view.of(model, e) }
        };
        let mut seen = functions.clone();
        seen.resets.clear();
        seen.given.clear();
        let mut own: Vec<ResetFacts> = Vec::new();
        let mut first = 0;
        for (ResetFacts { reset, assignments }, assigned) in resets.into_iter().zip(assigned) {
            let place = |place: StateIndex| selection.variables.iter().position(|known| *known == place);
            let taken = assignments.into_iter().zip(assigned).filter(|(_, assigned)| *assigned);
            let assignments: Vec<(usize, usize)> =
                taken.filter_map(|((given, variable), _)| Some((given, place(variable)?))).collect();
            let values = &functions.given[first..];
            first += contacts.resets[reset].assignments.len();
            if !assignments.is_empty() {
                seen.given.extend(assignments.iter().map(|(given, _)| view.of(model, values[*given])));
                seen.resets.push(view.of(model, functions.resets[reset]));
                own.push(ResetFacts { reset, assignments });
            }
        }
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
        let level = LevelContacts {
            modes,
            switches: &switches,
            motions: &motions,
            functions: &seen,
            limits: &limits,
        };
        let (programs, mut facts) = programs(&mut model.bench, contacts, &level, name, faults)?;
        facts.resets = own;
        Some((programs, facts))
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
