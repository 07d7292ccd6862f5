//! The report of a scene: what it keeps and why, what left, and its rates.

use super::lines::{Lines, SectionLines, Writer, class_name, plural};
use crate::derive::Subject;
use crate::derive::{Reason, SceneFacts, StateIndex};
use crate::names::quoted;

fn facts<'d>(subject: &Subject<'d, '_>) -> &'d SceneFacts {
    subject.level.scene.as_ref().expect("a report of a scene")
}

/// Returns the sentence that sums up a scene.
pub(super) fn summary(subject: &Subject<'_, '_>) -> String {
    let of = &subject.model.declaration.name;
    format!(
        "A scene of [`{of}`](super::{of}): {} of {}; {}.",
        subject.level.selection.variables.len(),
        plural(subject.whole.sizes().1, "variable"),
        class_name(subject.level.derivation.class),
    )
}

/// Returns the sections on kept, dropped and fixed variables, each with its reason.
pub(super) fn sections(subject: &Subject<'_, '_>) -> Vec<SectionLines> {
    let Subject { model, level, .. } = subject;
    let facts = facts(subject);
    let name = |place: StateIndex| model.variable_name(place);
    let kept = facts.reasons.iter().enumerate().filter_map(|(place, reason)| {
        Some(match reason.as_ref()? {
            Reason::Tracked => format!("{}: tracked", name(place)),
            Reason::Provided(what) => format!("{}: `{what}` needs it", name(place)),
            Reason::Contact(contact) => format!("{}: the contact {contact} needs it", name(place)),
            Reason::Switch(switch) => format!("{}: the switch {switch} depends on it", name(place)),
            Reason::Reset(reset) => format!("{}: the reset {reset} needs it", name(place)),
            Reason::Rate(by) => format!("{}: the rate of {} depends on it", name(place), name(*by)),
            Reason::Whole(by) => format!("{}: of one quaternion with {}", name(place), name(*by)),
        })
    });
    let quadrature =
        |place: StateIndex| facts.quadratures.iter().flatten().find(|known| known.place == place);
    let left = facts.reasons.iter().enumerate().filter(|(_, reason)| reason.is_none()).map(|(place, _)| {
        if let Some(held) = level.selection.held.iter().find(|held| held.place == place) {
            return format!("{}: its rate vanishes identically, and it is a constant here", name(held.place));
        }
        if facts.eliminated.contains(&place) {
            return format!("{}: a holonomic equation tells what it would be", name(place));
        }
        let left = format!("{}: nothing kept depends on it", name(place));
        match quadrature(place) {
            None => left,
            Some(quadrature) if quadrature.needs.is_empty() => {
                format!("{left}; a quadrature of what is kept")
            }
            Some(quadrature) => {
                let needs = quoted(quadrature.needs.iter().map(|place| name(*place)));
                format!("{left}; a quadrature of what is kept and of {needs}")
            }
        }
    });
    let graph = &model.bench.graph;
    let fixed =
        facts.fixes.iter().map(|(c, value)| format!("{} = {}", model.constants[*c].name, graph.text(*value)));
    vec![
        SectionLines::words("Mode", mode(subject)),
        SectionLines::words("Variables that are kept", kept.collect()),
        SectionLines::words("Variables that left", left.collect()),
        SectionLines::words("Constants that are fixed", fixed.collect()),
    ]
}

/// The mode in which the contacts stay, and what follows from it.
fn mode(subject: &Subject<'_, '_>) -> Vec<String> {
    let Some(mode) = &subject.model.declaration.in_mode else { return Vec::new() };
    let mut lines = vec![mode.words.clone()];
    let graph = &subject.model.bench.graph;
    let known = &facts(subject).followers;
    lines.extend(mode.followers.iter().map(|name| {
        match known.iter().find(|(follower, _)| *follower == name.text) {
            Some((_, value)) => format!("{name} follows: {name} = {}", graph.text(*value)),
            None => format!("{name} follows from the other variables, kept and left"),
        }
    }));
    let contacts = subject.whole.contacts.iter().flat_map(|contacts| &contacts.entries);
    let loose: Vec<&str> = contacts
        .zip(&mode.contacts)
        .filter(|(_, held)| held.is_undetermined)
        .map(|(entry, _)| entry.name.text.as_str())
        .collect();
    if !loose.is_empty() {
        let names = quoted(loose);
        lines.push(format!(
            "rows of {names} depend on each other: only sums of their reactions are determined"
        ));
    }
    lines
}

/// The rates of the kept variables.
pub(super) fn rates(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let Subject { model, level, .. } = subject;
    let mut lines = Lines::new(writer, "Rates");
    for (place, rate) in level.selection.variables.iter().zip(&level.rates) {
        let name = model.variable_name(*place);
        lines.named(&format!("{name}'"), *rate);
    }
    let mut section = lines.section;
    if facts(subject).is_part {
        section.text.push("computed by the same operations as in the whole system".to_owned());
    }
    section
}

/// The energy integral.
pub(super) fn energy(subject: &Subject<'_, '_>, writer: &mut Writer<'_>) -> SectionLines {
    let mut lines = Lines::new(writer, "Energies");
    lines.equation("h", "h", subject.level.energy);
    lines.section
}
