//! `states { dot(name) = rate; .. }`.

use proc_macro2::{Delimiter, Group, Span};

use super::attributes::docs;
use super::cursor::Cursor;
use super::index::indexed_name;
use super::lists::{entries, expression_to_semicolon, own_unit};
use super::nesting::Entries;
use super::punctuation::equals;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::syntax::{Expression, Name, State, Unit};

const HELP: &str = "a state is declared by its rate: `dot(name) = rate;`";

/// The entries of `states`.
pub(crate) fn states(group: &Group, faults: &mut Faults) -> Entries<State> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let (name, unit) = declared(cursor, faults)?;
        let span = cursor.span();
        let (equals, rate) = match equals(cursor, faults, &format!("`dot({name})`"), HELP) {
            Ok(equals) => (equals, expression_to_semicolon(cursor, faults, begins_state)),
            Err(Reported { .. }) => {
                cursor.recover();
                (span, Expression::missing(span))
            }
        };
        Ok(State { docs, name, unit, equals, rate })
    })
}

/// Whether the declaration of a state begins here: `dot(`, perhaps with documentation.
fn begins_state(cursor: &Cursor) -> bool {
    cursor.is_punct('#')
        || (cursor.is_word("dot")
            && cursor.group_at(1, Delimiter::Parenthesis).is_some()
            && cursor.is_punct_at(2, '='))
}

/// `dot(name)` or `dot(name: unit)`.
fn declared(cursor: &mut Cursor, faults: &mut Faults) -> Result<(Name, Option<Unit>), Reported> {
    const ROLE: &str = "the name of a state";
    cursor.open_invisible();
    let Some(word) = cursor.ident_at(0).cloned() else {
        let fault = Fault::new(cursor.span(), format!("expected `dot(name)`, found {}", cursor.found()));
        return Err(faults.report(fault.help(HELP)));
    };
    let Some(group) = cursor.group_at(1, Delimiter::Parenthesis).cloned() else {
        return bare(cursor, faults, ROLE, &word);
    };
    if word != "dot" {
        let fault = Fault::new(word.span(), format!("expected `dot(name)`, found `{word}`"));
        faults.report(fault.help(HELP));
    }
    cursor.skip(2);
    let mut inside = Cursor::inside(&group);
    let name = indexed_name(&mut inside, faults, ROLE)?;
    let unit = own_unit(&mut inside, faults, ROLE);
    if !inside.is_end() {
        let fault = Fault::new(inside.span(), format!("expected `)`, found {}", inside.found()));
        faults.report(fault.help(if inside.is_punct(',') {
            "every state has an entry of its own"
        } else {
            HELP
        }));
    }
    Ok((name, unit))
}

/// A name that is not the argument of `dot`: the entry means something, and is read on.
fn bare(
    cursor: &mut Cursor,
    faults: &mut Faults,
    role: &str,
    word: &proc_macro2::Ident,
) -> Result<(Name, Option<Unit>), Reported> {
    let span: Span = word.span();
    let name = indexed_name(cursor, faults, role)?;
    let fault = Fault::new(span, format!("`{name}` is not declared by its rate"));
    let reported = faults.report(if cursor.is_punct('=') {
        fault
            .help(format!("write `dot({name}) = ..;` with the rate"))
            .help("an initial value is given when the system runs, in its state")
    } else {
        fault.help(format!("write `dot({name}) = ..;` with the rate"))
    });
    if cursor.is_punct('=') { Ok((name, None)) } else { Err(reported) }
}
