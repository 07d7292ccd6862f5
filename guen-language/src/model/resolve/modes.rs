//! `modes`: the states and combinations that exist.

use std::collections::BTreeMap;

use super::*;
use crate::limits::MAX_MODES;
use crate::model::contact::{ContactEntry, ContactState};
use crate::names::{nearest, quoted};
use crate::syntax::{ModeStatement, Name, Path, Scene, Section, Step};

/// The statements about some contacts, as far as they were read.
struct Stated<'a, 'e> {
    entries: &'e [&'e ContactEntry<'a>],
    /// The contacts of which something is wrong: nothing is said about them.
    missing: &'e BTreeSet<String>,
    /// The states that each contact may have.
    states: Vec<Vec<usize>>,
    /// The statement of each contact that was read last: where its contact stands, and in which instance.
    last: BTreeMap<usize, (&'a Name, Option<usize>)>,
    never: Vec<Never>,
}

/// A combination that does not occur.
struct Never {
    /// The place of the word, if the system says it.
    keyword: Option<proc_macro2::Span>,
    /// The contacts by their places, each with its states.
    combination: Vec<(usize, Vec<usize>)>,
}

/// The combinations of states of some contacts that the declaration leaves; `None` after a fault. `keyword` is the place of what
/// is said of all contacts.
pub(super) fn combinations<'a>(
    (entries, missing): (&[&ContactEntry<'a>], &BTreeSet<String>),
    declaration: &'a Declaration,
    keyword: proc_macro2::Span,
    faults: &mut Faults,
) -> Option<Vec<Vec<usize>>> {
    let before = faults.count();
    let states = entries.iter().map(|entry| (0..entry.states().len()).collect()).collect();
    let mut stated = Stated { entries, missing, states, last: BTreeMap::new(), never: Vec::new() };
    let mut own = None;
    for (section, origin) in sections(declaration) {
        own = own.or(Some(section.keyword).filter(|_| origin.is_none()));
        let before = faults.count();
        section.entries.iter().for_each(|statement| stated.read(statement, origin, faults));
        if let Some(origin) = origin {
            let instance = &declaration.instances[origin];
            faults.of_instance(before, &instance.used(), instance.place);
        }
    }
    let Stated { states, never, .. } = stated;
    if faults.count() > before || !missing.is_empty() {
        return None;
    }
    // Counted before they are listed: contacts without a statement multiply quickly.
    let count = states.iter().map(Vec::len).fold(1_usize, usize::saturating_mul);
    const LISTED: usize = 1 << 20;
    if count > LISTED {
        faults.report(too_many(entries, &states, count, keyword));
        return None;
    }
    let mut modes: Vec<Vec<usize>> = vec![Vec::new()];
    for of_contact in &states {
        modes = modes
            .into_iter()
            .flat_map(|mode| of_contact.iter().map(move |state| [&mode[..], &[*state]].concat()))
            .collect();
    }
    exclude(&mut modes, never, faults);
    if modes.is_empty() {
        faults.report(Fault::new(own.unwrap_or(keyword), "no mode is left"));
    }
    if modes.len() > MAX_MODES {
        faults.report(too_many(entries, &states, modes.len(), keyword));
    }
    (faults.count() == before).then_some(modes)
}

/// The modes of a system that a scene has, where it says which; `None` after a fault.
pub(super) fn of_scene<'a>(
    (entries, missing): (&[&ContactEntry<'a>], &BTreeSet<String>),
    modes: Option<&[Vec<usize>]>,
    scene: &'a Scene,
    faults: &mut Faults,
) -> Option<Vec<Vec<usize>>> {
    let before = faults.count();
    let keyword = scene.modes.first()?.keyword;
    let states = entries.iter().map(|entry| (0..entry.states().len()).collect()).collect();
    let mut stated = Stated { entries, missing, states, last: BTreeMap::new(), never: Vec::new() };
    let statements = scene.modes.iter().flat_map(|section| &section.entries);
    statements.for_each(|statement| stated.read(statement, None, faults));
    let Stated { states, never, .. } = stated;
    if faults.count() > before {
        return None;
    }
    // A fault in the modes of the system was reported.
    let mut left = modes?.to_vec();
    left.retain(|mode| mode.iter().zip(&states).all(|(state, states)| states.contains(state)));
    if left.is_empty() {
        faults.report(Fault::new(keyword, "no mode is left").note("the system has no mode of this kind"));
        return None;
    }
    exclude(&mut left, never, faults);
    if left.is_empty() {
        faults.report(Fault::new(keyword, "no mode is left"));
    }
    (faults.count() == before).then_some(left)
}

/// Takes combinations that do not occur out of the modes.
fn exclude(modes: &mut Vec<Vec<usize>>, never: Vec<Never>, faults: &mut Faults) {
    for Never { keyword, combination: pairs } in never {
        let left = modes.len();
        modes.retain(|mode| !pairs.iter().all(|(place, states)| states.contains(&mode[*place])));
        // A system may leave out what its components exclude.
        if let Some(keyword) = keyword.filter(|_| modes.len() == left) {
            faults.report(
                Fault::new(keyword, "this never happens").note("the other statements exclude it already"),
            );
        }
    }
}

/// The sections of modes with their instances, those of inner instances first: the system has the last word.
fn sections(declaration: &Declaration) -> Vec<(&Section<ModeStatement>, Option<usize>)> {
    let items = declaration.items.iter().enumerate().filter_map(|(place, item)| match item {
        Item::Modes(section) => Some((section, declaration.origins.get(place).copied().flatten())),
        _ => None,
    });
    let mut sections: Vec<_> = items.collect();
    let depth = |origin: Option<usize>| {
        let fields = |path: &Path| path.steps.iter().filter(|step| matches!(step, Step::Field(_))).count();
        origin.map_or(0, |origin| 1 + fields(&declaration.instances[origin].path))
    };
    sections.sort_by_key(|(_, origin)| std::cmp::Reverse(depth(*origin)));
    sections
}

impl<'a> Stated<'a, '_> {
    fn find(&self, contact: &Name, faults: &mut Faults) -> Option<usize> {
        if self.missing.contains(&contact.text) { None } else { find(self.entries, contact, faults) }
    }

    fn read(&mut self, statement: &'a ModeStatement, origin: Option<usize>, faults: &mut Faults) {
        match statement {
            ModeStatement::States { contact, states } => {
                let Some(place) = self.find(contact, faults) else { return };
                let mut found = Vec::new();
                let before = self.last.insert(place, (contact, origin));
                if let Some((first, _)) = before.filter(|(_, other)| *other == origin) {
                    let fault =
                        Fault::new(contact.span(), format!("the states of `{contact}` are given twice"));
                    faults.report(fault.note_place("first given", first.span()));
                    return;
                }
                for state in states {
                    let meant = of_word(self.entries[place], state, faults);
                    if !meant.is_empty() && meant.iter().all(|state| found.contains(state)) {
                        let text = format!("the state `{state}` of `{contact}` is given twice");
                        faults.report(Fault::new(state.span(), text).help("remove this"));
                    }
                    // A system narrows what a component says.
                    if let Some((first, _)) = before
                        && !meant.is_empty()
                        && meant.iter().all(|state| !self.states[place].contains(state))
                    {
                        let text = format!("`{contact}` has no state `{state}` here");
                        let fault = Fault::new(state.span(), text);
                        faults.report(fault.note_place("its component leaves it out", first.span()));
                    }
                    found.extend(meant);
                }
                found.retain(|state| self.states[place].contains(state));
                found.sort_unstable();
                found.dedup();
                self.states[place] = found;
            }
            ModeStatement::Never { keyword, combination } => {
                let mut pairs: Vec<(usize, Vec<usize>)> = Vec::new();
                for (contact, state) in combination {
                    let Some(place) = self.find(contact, faults) else { continue };
                    if pairs.iter().any(|(known, _)| *known == place) {
                        faults.report(Fault::new(
                            contact.span(),
                            format!("this never happens: `{contact}` is in one state at a time"),
                        ));
                    }
                    pairs.push((place, of_word(self.entries[place], state, faults)));
                }
                let keyword = Some(*keyword).filter(|_| origin.is_none());
                self.never.push(Never { keyword, combination: pairs });
            }
        }
    }
}

fn too_many(
    entries: &[&ContactEntry<'_>],
    states: &[Vec<usize>],
    count: usize,
    keyword: proc_macro2::Span,
) -> Fault {
    let factors =
        entries.iter().zip(states).map(|(entry, states)| format!("`{}` {}", entry.name, states.len()));
    let factors: Vec<String> = factors.collect();
    let all: usize = states.iter().map(Vec::len).fold(1, usize::saturating_mul);
    let left = if count < all { format!(", of which {count} are left") } else { String::new() };
    let text = format!("{} = {all} modes{left}, at most {MAX_MODES}", factors.join(" x "));
    Fault::new(keyword, text)
        .help("say which states and combinations exist: `modes { left: open, stick; never left.stick with right.stick; }`")
}

fn find(entries: &[&ContactEntry<'_>], contact: &Name, faults: &mut Faults) -> Option<usize> {
    let found = entries.iter().position(|entry| entry.name.text == contact.text);
    if found.is_none() {
        let names = || entries.iter().map(|entry| entry.name.text.as_str());
        let inside = format!("{contact}.");
        if let Some(own) = names().find(|name| name.starts_with(&inside)) {
            let fault = Fault::new(contact.span(), format!("`{contact}` is an instance, and no contact"));
            faults.report(fault.help(format!("write the contact that is meant, as `{own}`")));
            return None;
        }
        let fault = Fault::new(contact.span(), format!("unknown contact `{contact}`"));
        faults.report(match nearest(&contact.text, names()) {
            Some(near) => fault.help(format!("did you mean `{near}`?")),
            None => fault.help(format!("the contacts are {}", quoted(names()))),
        });
    }
    found
}

/// The states that a word stands for.
fn of_word(entry: &ContactEntry<'_>, word: &Name, faults: &mut Faults) -> Vec<usize> {
    let states = entry.states();
    let means = |state: ContactState| [state.word(), state.signed_word()].contains(&word.text.as_str());
    let found: Vec<usize> = (0..states.len()).filter(|i| means(states[*i])).collect();
    if found.is_empty() {
        let mut words: Vec<&str> = states.iter().map(|state: &ContactState| state.word()).collect();
        words.dedup();
        let (last, others) = words.split_last().map_or(("", &[][..]), |(last, others)| (*last, others));
        let text = format!("`{}` has no state `{word}`: it is {} or {last}", entry.name, others.join(", "));
        let fault = Fault::new(word.span(), text);
        let unsigned = word.text.trim_end_matches(['+', '-']);
        faults.report(match words.contains(&unsigned) && unsigned != word.text {
            true => fault.note("only slip along a line has a sign"),
            false => fault,
        });
    }
    found
}
