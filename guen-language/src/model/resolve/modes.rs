//! `modes`: the states and combinations that exist.

use std::collections::BTreeMap;

use super::*;
use crate::limits::MAX_MODES;
use crate::model::contact::{ContactEntry, ContactState};
use crate::names::{nearest, quoted};
use crate::syntax::{ModeStatement, Name, Section};

/// The combinations of states of some contacts that statements leave; `None` after a fault. `keyword` is the place of the word
/// `contacts`.
pub(super) fn combinations(
    entries: &[&ContactEntry<'_>],
    section: Option<&Section<ModeStatement>>,
    keyword: proc_macro2::Span,
    faults: &mut Faults,
) -> Option<Vec<Vec<usize>>> {
    let before = faults.count();
    let statements = section.map_or(&[][..], |section| &section.entries[..]);
    let mut states: Vec<Vec<usize>> =
        entries.iter().map(|entry| (0..entry.states().len()).collect()).collect();
    let mut stated: BTreeMap<usize, &Name> = BTreeMap::new();
    let mut never = Vec::new();
    for statement in statements {
        match statement {
            ModeStatement::States { contact, states: written } => {
                let Some(place) = find(entries, contact, faults) else { continue };
                if let Some(first) = stated.insert(place, contact) {
                    let fault =
                        Fault::new(contact.span(), format!("the states of `{contact}` are given twice"));
                    faults.report(fault.note_place("first given", first.span()));
                }
                states[place] =
                    written.iter().flat_map(|state| of_word(entries[place], state, faults)).collect();
                states[place].sort_unstable();
                states[place].dedup();
            }
            ModeStatement::Never { keyword, combination } => {
                let mut pairs: Vec<(usize, Vec<usize>)> = Vec::new();
                for (contact, state) in combination {
                    let Some(place) = find(entries, contact, faults) else { continue };
                    if pairs.iter().any(|(known, _)| *known == place) {
                        faults.report(Fault::new(
                            contact.span(),
                            format!("this never happens: `{contact}` is in one state at a time"),
                        ));
                    }
                    pairs.push((place, of_word(entries[place], state, faults)));
                }
                never.push((*keyword, pairs));
            }
        }
    }
    if faults.count() > before {
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
    for (keyword, pairs) in never {
        let left = modes.len();
        modes.retain(|mode| !pairs.iter().all(|(place, states)| states.contains(&mode[*place])));
        if modes.len() == left {
            faults.report(
                Fault::new(keyword, "this never happens").note("the other statements exclude it already"),
            );
        }
    }
    if modes.is_empty() {
        let place = section.map_or(keyword, |section| section.keyword);
        faults.report(Fault::new(place, "no mode is left"));
    }
    if modes.len() > MAX_MODES {
        faults.report(too_many(entries, &states, modes.len(), keyword));
    }
    (faults.count() == before).then_some(modes)
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
    let found: Vec<usize> = (0..states.len()).filter(|i| states[*i].word() == word.text).collect();
    if found.is_empty() {
        let mut words: Vec<&str> = states.iter().map(|state: &ContactState| state.word()).collect();
        words.dedup();
        let (last, others) = words.split_last().map_or(("", &[][..]), |(last, others)| (*last, others));
        let text = format!("`{}` has no state `{word}`: it is {} or {last}", entry.name, others.join(", "));
        faults.report(Fault::new(word.span(), text));
    }
    found
}
