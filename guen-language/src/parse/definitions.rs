//! `name = e;`: in `parameters`, in `outputs` and after `let`.

use proc_macro2::{Group, TokenTree};

use super::attributes::docs;
use super::cursor::Cursor;
use super::index::indexed_name;
use super::lists::{entries, expression_to_semicolon};
use super::nesting::Entries;
use super::punctuation::{begins_definition, equals};
use crate::diagnostics::{Fault, Faults, Reported};
use crate::syntax::{Definition, Docs, Expression};

const HELP_PARAMETER: &str = "`parameters` are the quasi-velocities, each `name = e;`; physical constants belong in `constants { .. }`";

/// The entries of `parameters`.
pub(crate) fn parameters(group: &Group, faults: &mut Faults) -> Entries<Definition> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        if is_constant(cursor) {
            return physical_constant(cursor, faults, docs);
        }
        definition(cursor, faults, docs, "the name of a parameter", "a parameter reads `name = e;`")
    })
}

/// Whether an entry has the shape of a physical constant: no definition, a bound, or a comma after a value.
fn is_constant(cursor: &Cursor) -> bool {
    if cursor.ident_at(0).is_none() {
        return false;
    }
    let end = cursor.name_length();
    cursor.peek_nth(end).is_none()
        || [',', ';', '>', '!'].iter().any(|mark| cursor.is_punct_at(end, *mark))
        || (cursor.is_punct_at(end, '=')
            && matches!(cursor.peek_nth(end + 1), Some(TokenTree::Literal(_)))
            && cursor.is_punct_at(end + 2, ','))
}

fn physical_constant(cursor: &mut Cursor, faults: &mut Faults, docs: Docs) -> Result<Definition, Reported> {
    let name = indexed_name(cursor, faults, "the name of a parameter")?;
    let span = name.span();
    faults.report(Fault::new(span, format!("`{name}` is not defined by an expression")).help(HELP_PARAMETER));
    cursor.recover_to_comma();
    cursor.skip(1);
    Ok(Definition { docs, name, value: Expression::missing(span) })
}

/// The entries of `outputs`.
pub(crate) fn outputs(group: &Group, faults: &mut Faults) -> Entries<Definition> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        definition(cursor, faults, docs, "the name of an output", "an output reads `name = e;`")
    })
}

/// Reads the definition behind `let`.
pub(crate) fn definition_of_let(
    cursor: &mut Cursor,
    faults: &mut Faults,
    docs: Docs,
) -> Result<Definition, Reported> {
    if cursor.is_word("mut") {
        let fault = Fault::new(cursor.span(), "a name stands for one expression and is never changed");
        faults.report(fault.help("remove `mut`"));
        cursor.skip(1);
    }
    definition(cursor, faults, docs, "a name after `let`", "a definition reads `let name = e;`")
}

fn definition(
    cursor: &mut Cursor,
    faults: &mut Faults,
    docs: Docs,
    role: &str,
    help: &str,
) -> Result<Definition, Reported> {
    let name = indexed_name(cursor, faults, role)?;
    let span = cursor.span();
    let value = match equals(cursor, faults, &format!("`{name}`"), help) {
        Ok(_) => expression_to_semicolon(cursor, faults, begins_definition),
        Err(Reported { .. }) => {
            cursor.recover();
            Expression::missing(span)
        }
    };
    Ok(Definition { docs, name, value })
}
