//! Contacts in the report: rows, the Delassus matrix, modes, and whether a slip may have Painlevé's paradox.

use super::lines::{Lines, SectionLines, Writer, plural};
use crate::derive::{ContactFacts, Painleve, Subject};
use crate::model::{ContactEntry, ContactKind, ContactState, Contacts};

/// The longest entry of D that is printed, in bytes. A hinge's stop on a chain of three takes ten thousand.
const LONGEST_ENTRY: usize = 300;

/// Contacts and what was derived of them; nothing where there are none.
pub(super) fn section(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> Option<SectionLines> {
    let (contacts, facts) = (subject.model.contacts.as_ref()?, subject.level.contacts.as_ref()?);
    let graph = &subject.model.bench.graph;
    let mut lines = Lines::new(writer, "Contacts");
    let mut names = Vec::new();
    let mut rows = facts.rows.iter();
    for entry in &contacts.entries {
        for i in 0..entry.rows.len() {
            let name = row_name(entry, i);
            rows.next().into_iter().for_each(|row| lines.named(&name, *row));
            names.push(name);
        }
    }
    let mut entry = facts.delassus.iter();
    let mut long = 0;
    for w in 0..names.len() {
        for v in 0..=w {
            let Some(value) = entry.next().filter(|value| !graph.is_zero(**value)) else { continue };
            if graph.text_limited(*value, LONGEST_ENTRY).is_none() {
                long += 1;
                continue;
            }
            let name = format!("D[{}, {}]", names[w], names[v]);
            let latex = format!("D_{{{}\\,{}}}", w + 1, v + 1);
            lines.equation(&name, &latex, *value);
        }
    }
    let mut section = lines.section;
    if long > 0 {
        let (entries, are) = if long == 1 { ("entry", "is") } else { ("entries", "are") };
        section.text.push(format!("{long} {entries} of D = W M^-1 W^T {are} too long to print"));
    }
    let states = |place: usize| states_of(contacts, facts, place);
    section.text.extend(contacts.entries.iter().enumerate().map(|(i, entry)| words(entry, &states(i))));
    let switches = facts.switches.iter().map(|s| &contacts.switches[*s]);
    section.text.extend(
        switches.map(|switch| format!("{} is a switch: {}", switch.name, graph.text(switch.function))),
    );
    section.text.extend(facts.resets.iter().map(|own| {
        let reset = &contacts.resets[own.reset];
        let given = own.assignments.iter().map(|(given, _)| &reset.assignments[*given]);
        let given =
            given.map(|(variable, value)| format!("{} = {}", graph.text(*variable), graph.text(*value)));
        let given = given.collect::<Vec<_>>().join(", ");
        let (function, word) = (graph.text(reset.function), reset.crossing.word());
        format!("{} is a reset, where {function} {word} through zero: {given}", reset.name)
    }));
    section.text.push(plural(facts.modes.len(), "mode"));
    section.text.extend(painleve(contacts, facts));
    Some(section)
}

/// The velocity of a row by its contact.
pub(crate) fn row_name(entry: &ContactEntry<'_>, row: usize) -> String {
    let name = &entry.name.text;
    let tangential = row.checked_sub(usize::from(entry.gap.is_some()));
    match (tangential, entry.rows.len() - usize::from(entry.gap.is_some())) {
        (None, _) => format!("{name}_n"),
        (Some(_), 1) => format!("{name}_t"),
        (Some(i), _) => format!("{name}_t{}", i + 1),
    }
}

/// The states that a contact has in some mode.
fn states_of(contacts: &Contacts<'_>, facts: &ContactFacts, place: usize) -> Vec<ContactState> {
    let states = contacts.entries[place].states().iter().enumerate();
    let occurs = |state: usize| facts.modes.iter().any(|mode| mode[place] == state);
    states.filter(|(i, _)| occurs(*i)).map(|(_, state)| *state).collect()
}

fn words(entry: &ContactEntry<'_>, states: &[ContactState]) -> String {
    let what = match entry.kind {
        ContactKind::Smooth => "a contact without friction",
        ContactKind::Planar => "a contact with friction along a line",
        ContactKind::Spatial => "a contact with friction in a plane",
        ContactKind::Grip => "a grip",
        ContactKind::Latch => "a latch",
    };
    // One direction alone has its sign.
    let both = [ContactState::SlipPlus, ContactState::SlipMinus].iter().all(|slip| states.contains(slip));
    let word = |state: &ContactState| if both { state.word() } else { state.signed_word() };
    let mut words: Vec<&str> = states.iter().map(word).collect();
    words.dedup();
    format!("{} is {what}: {}", entry.name, words.join(", "))
}

/// Whether every slip has one reaction.
fn painleve(contacts: &Contacts<'_>, facts: &ContactFacts) -> Vec<String> {
    let name = |place: usize| &contacts.entries[place].name;
    let Painleve { doubtful, by_sign } = &facts.painleve;
    let mut pairs: Vec<(usize, usize)> = doubtful.iter().flatten().copied().collect();
    pairs.sort_unstable();
    pairs.dedup();
    let pair = |(slipping, touching): &(usize, usize)| match slipping == touching {
        true => {
            format!("where {} slips, its reaction may have no value, or several (Painlevé)", name(*slipping))
        }
        false => format!(
            "where {} slips, the reaction of {} may have no value, or several",
            name(*slipping),
            name(*touching)
        ),
    };
    let doubts = pairs.iter().map(pair);
    let proved = by_sign.iter().filter(|place| !pairs.iter().any(|(slipping, _)| slipping == *place));
    let proved = proved.map(|place| {
        format!(
            "where {} slips, its reaction has one value: p = D_nn - mu D_nt > 0 by the bounds of constants",
            name(*place)
        )
    });
    let lines: Vec<String> = doubts.chain(proved).collect();
    let is_rough = |entry: &ContactEntry<'_>| entry.friction.is_some() && entry.kind != ContactKind::Grip;
    match lines.is_empty() && contacts.entries.iter().any(is_rough) {
        true => vec![
            "in every mode a slip has one reaction: D couples no slip with a gap that is closed then"
                .to_owned(),
        ],
        false => lines,
    }
}
