//! A scene as a level of detail: what it keeps, its formulas, its programs.

use std::rc::Rc;

use guen_symbolic::{Dependence, Derivation, ExprId, Substitution, Workbench};

use super::asked::{check_tracked, is_output, of_outputs, provided, tracked, wanted};
use super::cheapest::cheapest;
use super::kept::{Kept, closed};
use crate::derive::brackets::commutator::Commutator;
use crate::derive::brackets::commutators::commutators;
use crate::derive::brackets::readable::{polish, shown};
use crate::derive::contacts::{self, ContactEquations, SceneContacts};
use crate::derive::level::DerivedLevel;
use crate::derive::provided::{carried, series, source};
use crate::derive::quantities::jacobians::Jacobians;
use crate::derive::quantities::parts::{Functions, View, parts};
use crate::derive::quantities::{formulas, switches};
use crate::derive::selections::closure::{Reason, StateEquations};
use crate::derive::selections::facts::SceneFacts;
use crate::derive::selections::fixed::{self, Holding};
use crate::derive::selections::manifold::{Replacement, quaternions};
use crate::derive::selections::selection::StateIndex;
use crate::diagnostics::{Faults, collect};
use crate::model::{Model, SceneEntry, SceneModes};

/// A derivation with its brackets and the equations of its contacts, as scenes share it.
#[derive(Clone)]
struct Shared {
    derivation: Rc<Derivation>,
    brackets: Rc<Vec<Commutator>>,
    contacts: Option<Rc<ContactEquations>>,
}

/// Derives every scene but those in a single mode of contacts without resets; those with faults are reported and left out.
pub(in crate::derive) fn derive(
    model: &mut Model<'_>,
    system: &DerivedLevel,
    equations: Option<Rc<ContactEquations>>,
    faults: &mut Faults,
) -> Vec<DerivedLevel> {
    let contacts = model.contacts.take();
    let mut scenes = std::mem::take(&mut model.scenes);
    let (derivation, brackets) = (system.derivation.clone(), system.brackets.clone());
    let mut derived: Vec<(Vec<(ExprId, ExprId)>, Shared)> =
        vec![(Vec::new(), Shared { derivation, brackets, contacts: equations })];
    let mut levels = Vec::new();
    let may_reset = contacts.as_ref().is_some_and(|contacts| !contacts.resets.is_empty());
    for (index, entry) in scenes.iter_mut().enumerate() {
        let scene = &*entry;
        if scene.single_mode().is_some() && !may_reset {
            continue;
        }
        let undefined = |model: &mut Model<'_>| {
            fixed::undefined_contacts(&mut model.bench, contacts.as_ref()?, &scene.fixes)
        };
        // In a single mode it is not known yet whether the scene has resets, and what it needs of its contacts.
        if let Some(fault) = undefined(model).filter(|_| scene.single_mode().is_none()) {
            faults.report(fault);
            continue;
        }
        let values: Vec<(ExprId, ExprId)> = scene.fixes.iter().map(|fix| (fix.symbol, fix.value)).collect();
        let known = derived.iter().find(|(known, _)| *known == values).map(|(_, shared)| shared.clone());
        let shared = known.or_else(|| {
            let mut derivation = fixed::derivation(model, &system.derivation, scene, faults)?;
            polish(&mut model.bench, &mut derivation);
            let brackets = Rc::new(commutators(model, &mut derivation));
            let equations = match &contacts {
                Some(contacts) => {
                    let before = faults.count();
                    let fixed = (&*system.derivation, &values[..]);
                    let equations = contacts::at_values(model, contacts, fixed, faults);
                    let what = format!("at the values of scene `{}`", scene.scene.name);
                    faults.note_since(before, &what, scene.scene.keyword);
                    Some(equations?)
                }
                None => None,
            };
            let shared = Shared { derivation: Rc::new(derivation), brackets, contacts: equations };
            derived.push((values, shared.clone()));
            Some(shared)
        });
        let Some(Shared { derivation, brackets, contacts: of_contacts }) = shared else {
            // The fault of the fixed values would be reported again in its mode.
            entry.modes = SceneModes::Without;
            continue;
        };
        // What is zero is judged on the holonomic equations at the values of this scene.
        let equations: Vec<ExprId> = derivation.system.holonomic.iter().map(|h| h.equation).collect();
        model.bench.zero.set_manifold(&mut model.bench.graph, &equations);
        let modes = match &scene.modes {
            SceneModes::Without => None,
            SceneModes::One(mode) => Some(vec![mode.clone()]),
            SceneModes::Several(modes) => Some(modes.clone()),
        };
        let own = |model: &Model<'_>| {
            let ((contacts, modes), equations) =
                contacts.as_ref().zip(modes.as_ref()).zip(of_contacts.as_ref())?;
            // What an outline needs is not known.
            let switches = if model.declaration.is_outline { contacts.switches.len() } else { 0 };
            Some(SceneContacts::new(model, contacts, modes, equations, (0..switches).collect()))
        };
        if let (SceneModes::One(mode), Some(own)) = (&scene.modes, own(model)) {
            if !has_resets(model, &derivation, own, scene) {
                continue;
            }
            if let Some(fault) = undefined(model) {
                faults.report(fault);
                entry.modes = SceneModes::Without;
                continue;
            }
            let mode = mode.clone();
            entry.modes = SceneModes::Several(vec![mode]);
        }
        let (own, scene) = (own(model), &*entry);
        levels.extend(level(model, system, (derivation, brackets), own, (index, scene), faults));
    }
    model.scenes = scenes;
    model.contacts = contacts;
    levels
}

fn level(
    model: &mut Model<'_>,
    system: &DerivedLevel,
    (derivation, brackets): (Rc<Derivation>, Rc<Vec<Commutator>>),
    mut contacts: Option<SceneContacts<'_, '_>>,
    (index, scene): (usize, &SceneEntry<'_>),
    faults: &mut Faults,
) -> Option<DerivedLevel> {
    let (n, size) = model.sizes();
    let lists = formulas::rates(&derivation);
    let first = derivation.formulations[0].rates.clone();
    let held = fixed::held(model, &first, &scene.held, faults)?;
    let before = faults.count();
    contacts.iter().for_each(|contacts| contacts.check_held(model, &scene.held, faults));
    if faults.count() > before {
        return None;
    }
    let mut holding = Holding::new(model, &held);
    contacts.iter_mut().for_each(|contacts| contacts.hold(&mut model.bench, &mut holding));
    let first: Vec<ExprId> = first.into_iter().map(|e| holding.of(&mut model.bench, e)).collect();
    let mut lists: Vec<Vec<ExprId>> = lists
        .into_iter()
        .map(|list| list.into_iter().map(|e| holding.of(&mut model.bench, e)).collect())
        .collect();
    let mut selection = provided(model, &derivation, contacts.as_ref(), scene, faults);
    let tracked: Vec<StateIndex> =
        tracked(model, scene).into_iter().filter(|place| !fixed::is_held(&held, *place)).collect();
    check_tracked(model, scene, &tracked, faults);
    if faults.count() > before {
        return None;
    }
    let mut asked = wanted(model, &derivation, &mut holding, &first, &selection);
    asked.extend(contacts.iter().flat_map(|contacts| of_outputs(model, contacts, &selection)));
    let pressed = contacts.as_ref().map_or(Vec::new(), |contacts| contacts.pressed(n));

    // What is kept, with the fewest variables that the holonomic equations allow.
    let variables: Vec<Option<ExprId>> =
        (0..size).map(|p| (!fixed::is_held(&held, p)).then(|| model.variable(p))).collect();
    let pressed_places = contacts.as_ref().map_or(Vec::new(), |contacts| contacts.pressed_places(model));
    let bench = &mut model.bench;
    let wholes = quaternions(bench, &derivation.system);
    let mut dependence = Dependence::default();
    let written = StateEquations { variables: &variables, rates: &first, pressed: &pressed, wholes: &wholes };
    let known = (&*derivation, &mut holding);
    let asked = (&tracked[..], &asked[..]);
    let (wanted, Kept { reasons, replacements }) =
        closed(bench, &mut dependence, known, &written, asked, &mut contacts);
    let determined = determined(bench, &mut dependence, &derivation, &mut holding, (&variables, &reasons));
    let followers =
        followers(model, &derivation, &mut dependence, &mut holding, (&variables, &reasons), &determined);
    let mut known = reasons.clone();
    determined.iter().for_each(|(i, _)| known[*i] = Some(Reason::Tracked));
    let reset_elsewhere: Vec<StateIndex> = match &model.declaration.in_mode {
        Some(mode) => mode.reset.iter().flat_map(|name| model.places(name)).collect(),
        None => Vec::new(),
    };
    let jumps = |place: StateIndex| {
        let is_reset = contacts.as_ref().is_some_and(|contacts| contacts.changer(place).is_some());
        pressed_places.get(place).is_some_and(|is| *is) || is_reset || reset_elsewhere.contains(&place)
    };
    let quadratures = written.quadratures(&mut model.bench, &mut dependence, &known, jumps);
    selection.take(model, (0..size).filter(|p| reasons[*p].is_some()).collect());

    // Expressions without what left.
    let mut view = View { holding, replacements, dependence, idle: Vec::new() };
    let rates: Vec<ExprId> = selection.variables.iter().map(|p| view.replaced(model, first[*p])).collect();
    let forced = selection.variables.iter().flat_map(|p| pressed.get(*p)).flatten().copied();
    let forced: Vec<ExprId> = forced.map(|e| view.replaced(model, e)).collect();
    let wanted = wanted.iter().map(|(_, e)| *e);
    let results: Vec<ExprId> = rates.iter().copied().chain(wanted).chain(forced).collect();
    let needed = |model: &mut Model<'_>, view: &mut View, symbol: ExprId| {
        results.iter().any(|e| view.dependence.depends(&mut model.bench, *e, symbol))
    };
    selection.inputs =
        (0..model.inputs.len()).filter(|i| needed(model, &mut view, model.inputs[*i].symbol)).collect();
    let left_variables = (0..size).filter(|p| reasons[*p].is_none()).map(|p| model.variable(p));
    let left_inputs = model.inputs.iter().enumerate().filter(|(i, _)| !selection.inputs.contains(i));
    view.idle = left_variables.chain(left_inputs.map(|(_, input)| input.symbol)).collect();
    view.idle.extend(contacts.iter().flat_map(SceneContacts::idle));
    // Off the constraints on positions rates that are equal there may depend on what the first ones do not.
    if lists[0] != first {
        lists.retain(|list| {
            selection.variables.iter().all(|p| {
                let e = view.replaced(model, list[*p]);
                !view.is_lost(model, e)
            })
        });
        if lists.is_empty() {
            lists.push(first.clone());
        }
    }
    let kept: Vec<Vec<ExprId>> = lists
        .iter()
        .map(|list| selection.variables.iter().map(|p| view.of(model, list[*p])).collect())
        .collect();
    let rates: Vec<ExprId> = selection.variables.iter().map(|p| view.of(model, first[*p])).collect();

    let coordinates = selection.coordinates.clone();
    let mut has_all = |model: &mut Model<'_>, equation: ExprId| {
        let equation = view.holding.of(&mut model.bench, equation);
        let mut depends = |i: &usize| {
            let x = model.coordinates[*i].symbol;
            view.dependence.depends(&mut model.bench, equation, x)
        };
        let on: Vec<usize> = (0..n).filter(&mut depends).collect();
        !on.is_empty() && on.iter().all(|i| coordinates.contains(i))
    };
    let positions = &derivation.system.holonomic;
    selection.holonomic = (0..positions.len()).filter(|h| has_all(model, positions[*h].equation)).collect();
    let redundant = &derivation.system.redundant;
    selection.redundant = (0..redundant.len()).filter(|r| has_all(model, redundant[*r])).collect();
    if selection.holonomic.is_empty() {
        selection.redundant.clear();
    }
    selection.held = held;
    selection.constants = (0..model.constants.len())
        .filter(|c| scene.fixes.iter().all(|fix| fix.symbol != model.constants[*c].symbol))
        .collect();

    let energy = view.of(model, derivation.energies.integral);
    let written: Vec<ExprId> = rates.iter().copied().chain([energy]).collect();
    let shown = shown(model, &derivation, &brackets, &written);
    let follow: Vec<ExprId> =
        determined.iter().map(|(_, e)| *e).chain(followers.iter().map(|(_, e)| *e)).collect();
    let mut functions = parts(model, &derivation, &brackets, &selection, &shown, &mut view, &follow);
    let provided = |word: &str| {
        let names = scene.scene.provides.iter().map(|provide| &provide.name);
        names.into_iter().find(|name| name.text == word && !is_output(model, name))
    };
    let (carries, expands, writes) = (provided("carried"), provided("taylor"), provided("source"));
    let forms = carries.map(|_| kept.clone()).unwrap_or_default();
    let (mut programs, is_part) =
        cheapest(model, (system, &derivation), &selection, &scene.fixes, lists, kept, &mut functions);
    let Functions { domain, domain_names, domain_reasons, constant_pivots, .. } = functions;
    let mut of_contacts = None;
    if let Some(contacts) = contacts {
        let name = scene.scene.name.span();
        let (own, facts) = contacts.programs(model, &mut view, &selection, name, faults)?;
        programs.append(own);
        of_contacts = Some(facts);
    }
    let jacobians = Jacobians::add(&mut programs, model, &selection);
    let place = (scene.scene.name.span(), &mut *faults);
    let switches = switches::add(model, &rates, &shown, &mut programs, place);
    if let Some(word) = writes {
        source::check(model, &programs, of_contacts.is_some(), word, faults);
    }
    let series = expands.and_then(|word| series::of(model, &selection, &programs, word.span(), faults));
    let fixes = scene
        .fixes
        .iter()
        .filter_map(|fix| Some((model.constants.iter().position(|c| c.symbol == fix.symbol)?, fix.value)));
    let facts = SceneFacts {
        index,
        reasons,
        quadratures,
        determined,
        followers,
        eliminated: view
            .replacements
            .iter()
            .filter(|r| !r.is_trial)
            .flat_map(|r| r.coordinates.clone())
            .collect(),
        fixes: fixes.collect(),
        is_part,
    };
    let mut level = DerivedLevel {
        selection,
        derivation,
        brackets,
        rates,
        equations: Vec::new(),
        energy,
        programs,
        singularities: domain_names.len(),
        placed: None,
        domain,
        domain_names,
        domain_reasons,
        switches,
        constant_pivots,
        missing_bounds: None,
        series,
        jacobians,
        shown,
        scene: Some(facts),
        contacts: of_contacts,
        provides_source: writes.is_some(),
        carried: None,
    };
    if let Some(word) = carries {
        level.carried = Some(carried::derive(model, &level, &forms, word, faults)?);
    }
    Some(level)
}

/// Whether a scene in a single mode has resets, and runs through that mode as through several.
fn has_resets(
    model: &mut Model<'_>,
    derivation: &Derivation,
    contacts: SceneContacts<'_, '_>,
    scene: &SceneEntry<'_>,
) -> bool {
    let (n, size) = model.sizes();
    let held: Vec<StateIndex> = scene.held.iter().flat_map(|name| model.places(&name.text)).collect();
    // A reset that changes a fixed variable is refused later, once it is known that the scene has it.
    if held.iter().any(|place| contacts.changer(*place).is_some()) {
        return true;
    }
    // Faults are reported once it is known in which form the scene is derived.
    let (selection, _) = collect(|faults| provided(model, derivation, None, scene, faults));
    let tracked = tracked(model, scene);
    let tracked: Vec<StateIndex> = tracked.into_iter().filter(|place| !held.contains(place)).collect();
    let rates = derivation.formulations[0].rates.clone();
    let mut holding = Holding::new(model, &[]);
    let mut asked = wanted(model, derivation, &mut holding, &rates, &selection);
    asked.extend(of_outputs(model, &contacts, &selection));
    let variables: Vec<Option<ExprId>> =
        (0..size).map(|p| (!held.contains(&p)).then(|| model.variable(p))).collect();
    let pressed = contacts.pressed(n);
    let bench = &mut model.bench;
    let wholes = quaternions(bench, &derivation.system);
    let written = StateEquations { variables: &variables, rates: &rates, pressed: &pressed, wholes: &wholes };
    let mut contacts = Some(contacts);
    let asked = (&tracked[..], &asked[..]);
    closed(bench, &mut Dependence::default(), (derivation, &mut holding), &written, asked, &mut contacts);
    contacts.is_some_and(|contacts| contacts.has_resets())
}

/// The coordinates that left and that holonomic equations say of what is kept, one by one.
fn determined(
    bench: &mut Workbench,
    dependence: &mut Dependence,
    derivation: &Derivation,
    holding: &mut Holding,
    (variables, reasons): (&[Option<ExprId>], &[Option<Reason>]),
) -> Vec<(usize, ExprId)> {
    let coordinates = &derivation.system.forms.coordinates;
    let mut candidates: Vec<(usize, ExprId)> = Vec::new();
    for replacement in Replacement::all(bench, &derivation.system, holding) {
        if let (false, [i]) = (replacement.is_trial, &replacement.coordinates[..])
            && reasons[*i].is_none()
            && variables[*i].is_some()
        {
            let mut replacement = replacement;
            let i = replacement.coordinates[0];
            candidates.push((i, replacement.of(bench, coordinates[i])));
        }
    }
    let mut found: Vec<(usize, ExprId)> = Vec::new();
    loop {
        let mut known = Substitution::new(found.iter().map(|(i, value)| (coordinates[*i], *value)));
        let next = candidates.iter().find_map(|(i, value)| {
            if found.iter().any(|(other, _)| other == i) {
                return None;
            }
            let value = known.of(&mut bench.graph, *value);
            let left = (0..variables.len()).filter(|place| reasons[*place].is_none());
            let mut left = left.filter_map(|place| variables[place]);
            left.all(|x| !dependence.depends(bench, value, x)).then_some((*i, value))
        });
        match next {
            Some(next) => found.push(next),
            None => return found,
        }
    }
}

/// The parameters that the mode of a scene leaves out and that follow from what is kept.
fn followers(
    model: &mut Model<'_>,
    derivation: &Derivation,
    dependence: &mut Dependence,
    holding: &mut Holding,
    (variables, reasons): (&[Option<ExprId>], &[Option<Reason>]),
    determined: &[(usize, ExprId)],
) -> Vec<(String, ExprId)> {
    let coordinates = &derivation.system.forms.coordinates;
    let mut known = Substitution::new(determined.iter().map(|(i, value)| (coordinates[*i], *value)));
    let bench = &mut model.bench;
    let mut found = Vec::new();
    for follower in &model.followers {
        let value = holding.of(bench, derivation.outputs[follower.output]);
        let value = known.of(&mut bench.graph, value);
        let left = (0..variables.len()).filter(|place| reasons[*place].is_none());
        let mut left = left.filter_map(|place| variables[place]);
        if left.all(|x| !dependence.depends(bench, value, x)) {
            found.push((follower.name.clone(), value));
        }
    }
    found
}
