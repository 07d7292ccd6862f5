//! Scenes in a single mode of contacts: smooth systems in which the rows of that mode are constraints.
//!
//! The declaration of such a system is written out of that of the whole one, and derived as if a user had written it: gaps that stay
//! closed under `holonomic`, slips that stay zero under `constraints`, and parameters that follow from others as names for expressions.
//! A contact that slips holds its gap alone, and has the force of its friction.

mod written;

use guen_symbolic::{ExprId, Substitution, SymbolId, chosen_rates, independent_rows};

use super::ContactFacts;
use crate::derive::level::{DerivedLevel, DerivedSystem};
use crate::derive::selections::selection::StatePart;
use crate::diagnostics::{Fault, Faults};
use crate::model::{self, ContactState, Contacts, Model, SceneEntry, nominal};
use crate::names::quoted;
use crate::syntax::{Declaration, Name};

/// The part of a system that moves in a mode.
pub(super) struct Part {
    /// Whether each row of each contact is a constraint of the mode.
    held: Vec<Vec<bool>>,
    /// Whether the gap of each contact is held by its rate.
    by_rate: Vec<bool>,
    /// Whether the reactions of each contact are not determined, because its rows depend on others.
    undetermined: Vec<bool>,
    /// The parameters that are kept, in order.
    kept: Vec<usize>,
}

/// Derives the scenes that have one mode, each as a scene of a system of its own.
pub(in crate::derive) fn derive<'a>(
    model: &mut Model<'a>,
    system: &DerivedLevel,
    faults: &mut Faults,
) -> Vec<(usize, DerivedSystem<'a>)> {
    let scenes = std::mem::take(&mut model.scenes);
    let mut written: Vec<(usize, Declaration)> = Vec::new();
    if let (Some(contacts), Some(facts)) = (model.contacts.take(), &system.contacts) {
        for (index, scene) in scenes.iter().enumerate().filter(|(_, scene)| scene.single_mode().is_some()) {
            let declaration = declaration(model, (&contacts, facts), scene, faults);
            written.extend(declaration.map(|declaration| (index, declaration)));
        }
        model.contacts = Some(contacts);
    }
    model.scenes = scenes;
    let (places, declarations): (Vec<usize>, Vec<Declaration>) = written.into_iter().unzip();
    let whole: &'a Declaration = model.declaration;
    let declarations = whole.of_modes.get_or_init(|| declarations);
    let mut derived = Vec::new();
    for (index, declaration) in places.into_iter().zip(declarations) {
        let before = faults.count();
        let own = model::resolve(declaration, faults).and_then(|model| crate::derive::derive(model, faults));
        let scene = &model.scenes[index].scene;
        if faults.count() > before {
            let what = format!("in the mode of scene `{}`", scene.name);
            faults.note_since(before, &what, scene.keyword);
        }
        derived.extend(own.map(|own| (index, own)));
    }
    derived
}

/// The declaration of the system in the only mode of a scene.
pub(super) fn declaration(
    model: &mut Model<'_>,
    (contacts, facts): (&Contacts<'_>, &ContactFacts),
    scene: &SceneEntry<'_>,
    faults: &mut Faults,
) -> Option<Declaration> {
    let part = part(model, (contacts, facts), scene, faults)?;
    written::in_mode(model, contacts, scene, &part, faults)
}

/// A row of a contact that is closed, over the parameters.
struct ActiveRow {
    contact: usize,
    /// The place among the rows of its contact.
    place: usize,
    row: Vec<ExprId>,
    /// The rate of the row at rest.
    drift: ExprId,
}

/// Finds the part that moves in the mode of a scene; a mode in which nothing does is reported.
fn part(
    model: &mut Model<'_>,
    (contacts, facts): (&Contacts<'_>, &ContactFacts),
    scene: &SceneEntry<'_>,
    faults: &mut Faults,
) -> Option<Part> {
    let mode = scene.single_mode()?;
    let l = model.mechanics.forms.degrees;
    let etas = model.mechanics.etas[..l].to_vec();
    let (active, gaps) = active(model, contacts, facts, mode);
    let permanent: Vec<ExprId> = model.mechanics.holonomic.iter().map(|h| h.equation).collect();
    let mut equations = permanent.clone();
    equations.extend(gaps.iter().flatten());
    let values = nominal(&model.bench.graph, &model.constants);
    let value = |symbol: SymbolId| values.get(&symbol).copied().unwrap_or(1.0);
    let mut rows: Vec<Vec<ExprId>> = active.iter().map(|active| active.row.clone()).collect();
    let (free, related) = independent_rows(&mut model.bench.graph, &rows, &equations, &value);
    let with_drifts = active.iter().map(|active| [&active.row[..], &[active.drift]].concat());
    let with_drifts: Vec<Vec<ExprId>> = with_drifts.collect();
    let (fulfilled, _) = independent_rows(&mut model.bench.graph, &with_drifts, &equations, &value);
    let keyword = scene.scene.modes.first().map_or(scene.scene.keyword, |section| section.keyword);
    let of_scene = format!("in the mode of scene `{}`", scene.scene.name);
    if let Some(k) = (0..active.len()).find(|k| free[*k] != fulfilled[*k]) {
        let name = &contacts.entries[active[k].contact].name;
        let fault = Fault::new(keyword, format!("`{name}` contradicts other contacts {of_scene}"));
        faults.report(fault.note("no velocities fulfil all of them"));
        return None;
    }
    let is_held = |active: &ActiveRow, free: bool| free && active.place == 0;
    let gap_of = |active: &ActiveRow| gaps[active.contact].map(|gap| (active.contact, gap));
    let kept_gaps = active.iter().zip(&free).filter(|(active, free)| is_held(active, **free));
    let kept_gaps: Vec<(usize, ExprId)> = kept_gaps.filter_map(|(active, _)| gap_of(active)).collect();
    for (active, _) in active.iter().zip(&free).filter(|(active, free)| active.place == 0 && !**free) {
        let Some((contact, gap)) = gap_of(active) else { continue };
        if let Some((other, _)) = kept_gaps.iter().find(|(_, kept)| are_apart(model, gap, *kept)) {
            let (name, other) = (&contacts.entries[contact].name, &contacts.entries[*other].name);
            let fault = Fault::new(keyword, format!("`{name}` contradicts `{other}` {of_scene}"));
            faults.report(fault.note("their gaps do not vanish together"));
            return None;
        }
    }
    let mut held: Vec<Vec<bool>> =
        contacts.entries.iter().map(|entry| vec![false; entry.rows.len()]).collect();
    let mut undetermined = vec![false; contacts.entries.len()];
    for (k, active) in active.iter().enumerate() {
        held[active.contact][active.place] = free[k];
        undetermined[active.contact] |= related[k];
    }
    let loose = |contact: usize| {
        let entry = &contacts.entries[contact];
        let loading = entry.loaded_by.map_or(contact, |row| contacts.of_row(row));
        entry.states()[mode[contact]].slips() && undetermined[loading]
    };
    if let Some(contact) = (0..contacts.entries.len()).find(|contact| loose(*contact)) {
        let name = &contacts.entries[contact].name;
        let fault = Fault::new(keyword, format!("the friction of `{name}` is not determined {of_scene}"));
        faults.report(fault.note("the reaction that loads it is not: rows of contacts depend on each other"));
        return None;
    }
    let mut is_free = free.iter();
    rows.retain(|_| is_free.next().copied().unwrap_or(false));
    if rows.len() >= l {
        let fault = Fault::new(keyword, format!("nothing moves {of_scene}"));
        faults.report(fault.note("its contacts hold every velocity"));
        return None;
    }
    let by_rate = by_rate(model, &gaps, permanent, &rows);
    let (zero, one) = (model.bench.graph.zero(), model.bench.graph.one());
    let unit = |s: usize| (0..l).map(|i| if i == s { one } else { zero }).collect::<Vec<ExprId>>();
    let mut kept: Vec<usize> = Vec::new();
    let tracks = scene.scene.tracks.iter().flat_map(|name| model.places(&name.text));
    for place in tracks.collect::<Vec<usize>>() {
        let StatePart::Parameter(s) = model.part(place) else { continue };
        rows.push(unit(s));
        let (free, _) = independent_rows(&mut model.bench.graph, &rows, &equations, &value);
        match free.last() {
            Some(true) => kept.push(s),
            _ => drop(rows.pop()),
        }
    }
    kept.extend(match chosen_rates(&mut model.bench.graph, &rows, &equations, &etas, &value) {
        Ok(choice) => choice.coordinates,
        Err(places) => places,
    });
    kept.sort_unstable();
    kept.dedup();
    Some(Part { held, by_rate, undetermined, kept })
}

/// Whether the sum or the difference of two gaps is constant and not zero.
fn are_apart(model: &mut Model<'_>, gap: ExprId, other: ExprId) -> bool {
    let opposite = model.bench.graph.neg(other);
    [other, opposite].into_iter().any(|other| {
        let sum = model.bench.graph.add(gap, other);
        let sum = model.bench.tidy(sum);
        model.bench.graph.roles(sum).is_constant()
            && model.bench.graph.as_number(sum).is_none_or(|n| !n.is_zero())
    })
}

/// The rows of contacts that are closed in a mode, and by contact its gap where that stays zero.
fn active(
    model: &mut Model<'_>,
    contacts: &Contacts<'_>,
    facts: &ContactFacts,
    mode: &[usize],
) -> (Vec<ActiveRow>, Vec<Option<ExprId>>) {
    let etas = model.mechanics.etas[..model.mechanics.forms.degrees].to_vec();
    let zero = model.bench.graph.zero();
    let mut at_rest = Substitution::new(etas.iter().map(|eta| (*eta, zero)));
    let (mut active, mut gaps) = (Vec::new(), Vec::new());
    let mut rows = facts.rows.iter();
    for (contact, (entry, state)) in contacts.entries.iter().zip(mode).enumerate() {
        let state = entry.states()[*state];
        let slips = state.slips();
        let closes = matches!(state, ContactState::Closed | ContactState::Stick | ContactState::Locked);
        gaps.push(entry.gap.filter(|_| closes || slips));
        let normal = usize::from(entry.gap.is_some());
        let is_held = |place: usize| closes || (slips && place < normal);
        for (place, form) in rows.by_ref().take(entry.rows.len()).enumerate() {
            if !is_held(place) {
                continue;
            }
            let mut row = Vec::new();
            for eta in &etas {
                let slope = model.bench.partial(*form, *eta);
                row.push(model.bench.tidy(slope));
            }
            let drift = at_rest.of(&mut model.bench.graph, *form);
            active.push(ActiveRow { contact, place, row, drift });
        }
    }
    (active, gaps)
}

/// The gaps that are declared by their rates, by contact: points modulo a prime at which they and the others vanish would show rows as
/// dependent that are not, as where the two feet of a block stand on the floor.
fn by_rate(
    model: &mut Model<'_>,
    gaps: &[Option<ExprId>],
    mut equations: Vec<ExprId>,
    rows: &[Vec<ExprId>],
) -> Vec<bool> {
    let bench = &mut model.bench;
    bench.begin_another();
    let mut found = Vec::new();
    for gap in gaps {
        let Some(gap) = gap else {
            found.push(false);
            continue;
        };
        equations.push(*gap);
        let rank = bench.on_manifold(&equations, |bench| bench.zero.rank(&mut bench.graph, rows, true));
        let is_degenerate = rank.is_some_and(|rank| rank < rows.len());
        if is_degenerate {
            equations.pop();
        }
        found.push(is_degenerate);
    }
    found
}

/// The mode of a scene in words.
fn words(contacts: &Contacts<'_>, mode: &[usize]) -> String {
    let states = contacts.entries.iter().zip(mode);
    let states =
        states.map(|(entry, state)| format!("{} {}", entry.name, entry.states()[*state].signed_word()));
    states.collect::<Vec<String>>().join(", ")
}

/// Reports a variable that the scene holds and that is none in its mode.
fn not_held(name: &Name, followers: &[Name], faults: &mut Faults) {
    let others = quoted(followers.iter().map(|name| name.text.as_str()));
    let fault =
        Fault::new(name.span(), format!("`{name}` cannot be fixed: it follows from other parameters"));
    faults.report(fault.note(format!("in the mode of this scene the contacts determine {others}")));
}
