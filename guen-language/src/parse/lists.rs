//! Sections that list names with commas, and the loops over entries of either punctuation.

use proc_macro2::{Group, TokenTree};

use super::attributes::docs;
use super::cursor::Cursor;
use super::expression::expression;
use super::index::indexed_name;
use super::nesting::Entries;
use super::punctuation::semicolon;
use super::units::unit;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::{MAX_COORDINATES, MAX_ENTRIES};
use crate::syntax::{Expression, Plain, Unit};

/// The name for an entry of `inputs` in messages.
pub(crate) const INPUT: &str = "the name of an input";

/// Reads one entry of a section.
pub(crate) type Entry<T> = fn(&mut Cursor, &mut Faults) -> Result<T, Reported>;

/// Entries that each take their `;`.
pub(crate) fn entries<T>(group: &Group, faults: &mut Faults, entry: Entry<T>) -> Entries<T> {
    let mut entries = Entries::new();
    fill(group, faults, &mut entries, entry);
    entries
}

fn fill<T>(group: &Group, faults: &mut Faults, entries: &mut Entries<T>, entry: Entry<T>) {
    let mut cursor = Cursor::inside(group);
    while !cursor.is_end() {
        if is_too_long(entries.list.len(), MAX_ENTRIES, &cursor, faults) {
            break;
        }
        let before = cursor.position();
        let mut inside = |group: &Group, faults: &mut Faults, entries: &mut Entries<T>| {
            fill(group, faults, entries, entry)
        };
        if stray_semicolon(&mut cursor, faults) || entries.block(&mut cursor, faults, &mut inside) {
            continue;
        }
        match entry(&mut cursor, faults) {
            Ok(entry) => entries.push(entry),
            Err(Reported { .. }) => cursor.recover(),
        }
        if cursor.position() == before {
            cursor.skip(1);
        }
    }
}

/// A section whose entries have commas between them; behind the braces of loops they may be left out.
pub(crate) fn listed<T>(
    group: &Group,
    faults: &mut Faults,
    most: usize,
    begins_entry: fn(&Cursor) -> bool,
    entry: &mut dyn FnMut(&mut Cursor, &mut Faults) -> Result<T, Reported>,
) -> Entries<T> {
    let mut entries = Entries::new();
    fill_listed(group, faults, &mut entries, most, begins_entry, entry);
    entries
}

fn fill_listed<T>(
    group: &Group,
    faults: &mut Faults,
    entries: &mut Entries<T>,
    most: usize,
    begins_entry: fn(&Cursor) -> bool,
    entry: &mut dyn FnMut(&mut Cursor, &mut Faults) -> Result<T, Reported>,
) {
    let mut cursor = Cursor::inside(group);
    while !cursor.is_end() {
        if is_too_long(entries.list.len(), most, &cursor, faults) {
            break;
        }
        let mut inside = |group: &Group, faults: &mut Faults, entries: &mut Entries<T>| {
            fill_listed(group, faults, entries, most, begins_entry, entry);
        };
        if entries.block(&mut cursor, faults, &mut inside) {
            cursor.eat(',');
            continue;
        }
        let is_whole = match entry(&mut cursor, faults) {
            Ok(entry) => {
                entries.push(entry);
                true
            }
            Err(Reported { .. }) => false,
        };
        comma(&mut cursor, faults, is_whole, at_end, begins_entry);
    }
}

/// Reports and passes a `;` that ends nothing.
pub(crate) fn stray_semicolon(cursor: &mut Cursor, faults: &mut Faults) -> bool {
    if !cursor.is_punct(';') {
        return false;
    }
    faults.report(Fault::new(cursor.span(), "this `;` ends nothing").help("remove it"));
    cursor.skip(1);
    true
}

/// Entries with commas between them, and perhaps one at the end.
pub(crate) fn separated<T>(
    cursor: &mut Cursor,
    faults: &mut Faults,
    most: usize,
    is_end: fn(&Cursor) -> bool,
    begins_entry: fn(&Cursor) -> bool,
    mut entry: impl FnMut(&mut Cursor, &mut Faults) -> Result<T, Reported>,
) -> Vec<T> {
    let mut entries = Vec::new();
    while !is_end(cursor) {
        if is_too_long(entries.len(), most, cursor, faults) {
            while !is_end(cursor) {
                cursor.skip(1);
            }
            break;
        }
        let is_whole = match entry(cursor, faults) {
            Ok(entry) => {
                entries.push(entry);
                true
            }
            Err(Reported { .. }) => false,
        };
        comma(cursor, faults, is_whole, is_end, begins_entry);
    }
    entries
}

/// The comma after an entry.
fn comma(
    cursor: &mut Cursor,
    faults: &mut Faults,
    is_whole: bool,
    is_end: fn(&Cursor) -> bool,
    begins_entry: fn(&Cursor) -> bool,
) {
    if is_whole && !is_end(cursor) && !cursor.is_punct(',') {
        let fault = Fault::new(cursor.span(), format!("expected `,`, found {}", cursor.found()));
        if cursor.is_punct(';') {
            faults.report(fault.help("the entries of this list are separated by `,`"));
        } else if begins_entry(cursor) {
            let text = format!("expected `,` before {}", cursor.found());
            faults.report(
                Fault::new(cursor.span(), text).help("the entries of this list are separated by `,`"),
            );
            return;
        } else {
            faults.report(fault);
        }
    }
    while !is_end(cursor) && !cursor.is_punct(',') && !cursor.is_punct(';') {
        cursor.skip(1);
    }
    if !is_end(cursor) {
        cursor.skip(1);
    }
}

/// Reports a list that is longer than it may be.
fn is_too_long(length: usize, most: usize, cursor: &Cursor, faults: &mut Faults) -> bool {
    if length >= most {
        let what = if most == MAX_COORDINATES { "coordinates" } else { "entries" };
        faults.report(Fault::new(cursor.span(), format!("more than {most} {what}")));
    }
    length >= most
}

/// The end of a list that fills its braces.
pub(crate) fn at_end(cursor: &Cursor) -> bool {
    cursor.is_end()
}

/// The entries of `coordinates` or `inputs`.
pub(crate) fn plain_names(group: &Group, faults: &mut Faults, role: &str, most: usize) -> Entries<Plain> {
    let begins = |cursor: &Cursor| cursor.is_punct('#') || cursor.ident_at(0).is_some();
    listed(group, faults, most, begins, &mut |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let name = indexed_name(cursor, faults, role)?;
        let unit = own_unit(cursor, faults, role);
        let limits = limits(cursor, faults, role);
        if let Some(TokenTree::Punct(mark)) = cursor.peek().filter(|_| !ends_name(cursor)) {
            let fault =
                Fault::new(cursor.span(), format!("expected `,` after {role}, found {}", cursor.found()));
            let reported = faults.report(match mark.as_char() {
                '=' => fault.help("initial values are given when the system runs, in its state"),
                '>' | '<' | '!' => fault.help("only `constants` have bounds"),
                _ => fault,
            });
            // The name counts as declared nevertheless.
            cursor.recover_to_comma();
            let _: Reported = reported;
        }
        Ok(Plain { docs, name, unit, limits })
    })
}

/// The unit behind a name. Degrees are for constants.
pub(crate) fn own_unit(cursor: &mut Cursor, faults: &mut Faults, role: &str) -> Option<Unit> {
    match unit(cursor, faults) {
        Ok(Some(unit)) if unit.is_degrees => {
            let fault = Fault::new(
                unit.span,
                format!("{} has its values in `rad`", role.replace("the name of ", "")),
            );
            faults.report(fault.help("write `rad`: only constants may be given in degrees"));
            None
        }
        Ok(unit) => unit,
        Err(Reported { .. }) => {
            cursor.recover_to_comma();
            None
        }
    }
}

/// `in lower..upper` after the name of an input.
fn limits(cursor: &mut Cursor, faults: &mut Faults, role: &str) -> Option<Box<[Expression; 2]>> {
    let span = cursor.eat_word("in")?;
    let limits = match role {
        INPUT => limits_behind(cursor, faults, "input"),
        _ => Err(faults.report(Fault::new(span, "only `inputs` have limits"))),
    };
    if limits.is_err() {
        cursor.recover_to_comma();
    }
    limits.ok()
}

/// `lower..upper` behind `in`, of a constant or an input.
pub(super) fn limits_behind(
    cursor: &mut Cursor,
    faults: &mut Faults,
    what: &str,
) -> Result<Box<[Expression; 2]>, Reported> {
    let lower = expression(cursor, faults)?;
    if !cursor.is_pair('.', '.') {
        let fault = Fault::new(cursor.span(), format!("expected `..`, found {}", cursor.found()));
        return Err(faults.report(fault.help("limits are written `name in lower..upper`")));
    }
    cursor.skip(2);
    if let Some(span) = cursor.eat('=') {
        let fault = Fault::new(span, "limits are written with `..`");
        faults.report(
            fault.help(format_args!(
                "both ends belong to what the {what} may be: write `name in lower..upper`"
            )),
        );
    }
    Ok(Box::new([lower, expression(cursor, faults)?]))
}

/// Whether what follows a name belongs to the list or to the next entry.
fn ends_name(cursor: &Cursor) -> bool {
    cursor.is_punct(',') || cursor.is_punct(';') || cursor.is_punct('#')
}

/// An expression and the `;` after it. After a fault the entry is left and the expression is missing.
pub(crate) fn expression_to_semicolon(
    cursor: &mut Cursor,
    faults: &mut Faults,
    begins_entry: fn(&Cursor) -> bool,
) -> Expression {
    let span = cursor.span();
    match expression(cursor, faults) {
        Ok(value) => {
            semicolon(cursor, faults, begins_entry);
            value
        }
        Err(Reported { .. }) => {
            cursor.recover();
            Expression::missing(span)
        }
    }
}
