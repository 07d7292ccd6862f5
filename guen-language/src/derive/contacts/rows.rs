//! The rows of contacts on the constraints: those that no force can hold are reported.
//!
//! A gap whose rate has no velocity there cannot be kept at zero, a slip without one cannot stick, and rows of one contact that depend on each
//! other leave its force undetermined in every mode.

use std::collections::BTreeSet;

use guen_symbolic::{ExprId, Substitution, Verdict, Workbench};
use proc_macro2::Span;

use crate::diagnostics::{Fault, Faults};
use crate::model::{ContactEntry, ContactKind, Contacts};
use crate::syntax::Instance;

/// Reports the rows that no force can hold; `rows` are those of all contacts over the parameters.
pub(super) fn check(
    bench: &mut Workbench,
    contacts: &Contacts<'_>,
    instances: &[Instance],
    (rows, etas): (&[ExprId], &[ExprId]),
    faults: &mut Faults,
) {
    // In a component the first instance is named.
    let mut places = BTreeSet::new();
    let mut rows = rows.iter().copied();
    for entry in &contacts.entries {
        let own: Vec<ExprId> = rows.by_ref().take(entry.rows.len()).collect();
        for (span, fault) in of_contact(bench, entry, &own, etas) {
            if places.insert(format!("{span:?}")) {
                let before = faults.count();
                faults.report(fault);
                if let Some(Instance { path, component, place, .. }) = instance_of(entry, instances) {
                    let what = format!("in `{}`, a `{}`, used", path.text(), component.name);
                    faults.note_since(before, &what, *place);
                }
            }
        }
    }
}

/// The instance that a contact belongs to.
fn instance_of<'i>(entry: &ContactEntry<'_>, instances: &'i [Instance]) -> Option<&'i Instance> {
    let (path, _) = entry.name.text.rsplit_once('.')?;
    instances.iter().find(|instance| instance.path.text() == path)
}

/// The faults of the rows of a contact, with their places.
fn of_contact(
    bench: &mut Workbench,
    entry: &ContactEntry<'_>,
    forms: &[ExprId],
    etas: &[ExprId],
) -> Vec<(Span, Fault)> {
    let mut rows: Vec<Vec<ExprId>> = Vec::new();
    for form in forms {
        let mut row = Vec::new();
        for eta in etas {
            let slope = bench.partial(*form, *eta);
            row.push(bench.tidy(slope));
        }
        rows.push(row);
    }
    let Workbench { graph, zero, .. } = bench;
    if zero.rank(graph, &rows, true).is_none_or(|rank| rank == rows.len()) {
        return Vec::new();
    }
    let mut found = Vec::new();
    // The rows before, each without what it has in common with those before it, and the place of an entry that does not vanish.
    let mut before: Vec<(usize, usize, Vec<ExprId>)> = Vec::new();
    for (place, mut row) in rows.into_iter().enumerate() {
        if vanishes(bench, &row) {
            found.push(without_velocity(bench, entry, place, forms[place], etas));
            continue;
        }
        let mut used = Vec::new();
        for (other, pivot, entries) in &before {
            if bench.verdict_on_manifold(row[*pivot]) == Verdict::Zero {
                continue;
            }
            row = without(bench, &row, entries, *pivot);
            used.push(*other);
            if vanishes(bench, &row) {
                break;
            }
        }
        match row.iter().position(|e| bench.verdict_on_manifold(*e) == Verdict::Nonzero) {
            Some(pivot) => before.push((place, pivot, row)),
            None if vanishes(bench, &row) => found.push(dependent(bench, entry, place, forms, &used)),
            None => {}
        }
    }
    found
}

fn vanishes(bench: &mut Workbench, row: &[ExprId]) -> bool {
    row.iter().all(|e| bench.verdict_on_manifold(*e) == Verdict::Zero)
}

/// A multiple of a row less one of another, so that its entry at a place vanishes.
fn without(bench: &mut Workbench, row: &[ExprId], other: &[ExprId], pivot: usize) -> Vec<ExprId> {
    let mut found = Vec::new();
    for (own, taken) in row.iter().zip(other) {
        let own = bench.graph.mul(*own, other[pivot]);
        let taken = bench.graph.mul(*taken, row[pivot]);
        let difference = bench.graph.sub(own, taken);
        found.push(bench.tidy(difference));
    }
    found
}

/// The row at a place in words, and where it is written.
fn words(entry: &ContactEntry<'_>, place: usize) -> (String, Span) {
    let name = entry.name;
    let what = match entry.kind {
        ContactKind::Latch => "latch",
        ContactKind::Grip => "grip",
        _ if place == 0 => "gap",
        _ => "slip",
    };
    let tangential = place.checked_sub(usize::from(entry.gap.is_some()));
    let axis = tangential.and_then(|i| entry.axes.get(i));
    let span = tangential.and_then(|i| entry.along_spans.get(i)).copied().unwrap_or(entry.gap_span);
    let whole = format!("the {what} of `{name}`");
    (axis.map_or_else(|| whole.clone(), |axis| format!("component `{axis}` of {whole}")), span)
}

/// The fault of a row that no velocity changes on the constraints.
fn without_velocity(
    bench: &mut Workbench,
    entry: &ContactEntry<'_>,
    place: usize,
    form: ExprId,
    etas: &[ExprId],
) -> (Span, Fault) {
    let (what, span) = words(entry, place);
    let is_gap = entry.gap.is_some() && place == 0;
    if bench.verdict_on_manifold(form) == Verdict::Zero {
        let fault = match is_gap {
            true => {
                Fault::new(span, format!("{what} never changes")).note("its rate vanishes on the constraints")
            }
            false => Fault::new(span, format!("{what} vanishes on the constraints"))
                .note("the constraints hold it at zero already"),
        };
        return (span, fault);
    }
    let zero = bench.graph.zero();
    let drift = Substitution::new(etas.iter().map(|eta| (*eta, zero))).of(&mut bench.graph, form);
    let drift = bench.tidy(drift);
    let text = bench.graph.text_limited(drift, DRIFT_CHARACTERS).unwrap_or_else(|| "..".to_owned());
    let rate = if is_gap { "its rate" } else { "there it" };
    let fault = Fault::new(span, format!("{what} has no velocity on the constraints"));
    (span, fault.note(format!("{rate} is `{text}`, which no force changes")))
}

/// The fault of a row that depends on others of its contact.
fn dependent(
    bench: &mut Workbench,
    entry: &ContactEntry<'_>,
    place: usize,
    forms: &[ExprId],
    used: &[usize],
) -> (Span, Fault) {
    let (what, span) = words(entry, place);
    let is_along_gap = entry.gap.is_some() && used == [0];
    let fault = if is_along_gap {
        let difference = bench.graph.sub(forms[place], forms[0]);
        let goes = match bench.verdict_on_manifold(difference) {
            Verdict::Zero => "is the rate of its gap",
            _ => "goes along its gap",
        };
        let fault = Fault::new(span, format!("{what} {goes}"));
        fault.help("write a velocity across the gap, along which friction acts")
    } else {
        let others: Vec<String> = used.iter().map(|other| words(entry, *other).0).collect();
        let fault = Fault::new(span, format!("{what} depends on {}", others.join(" and ")));
        fault.help("write components that are independent of each other")
    };
    (span, fault)
}

/// The most characters of an expression in a message.
const DRIFT_CHARACTERS: usize = 80;
