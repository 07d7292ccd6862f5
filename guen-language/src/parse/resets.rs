//! `resets { name: e rises, variable = e, ..; }`.

use proc_macro2::Group;

use super::attributes::docs;
use super::cursor::Cursor;
use super::expression::expression;
use super::index::indexed_name;
use super::lists::{entries, separated};
use super::nesting::Entries;
use super::punctuation::{begins_equation, colon, equals, semicolon};
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_ENTRIES;
use crate::syntax::{Crossing, Expression, Reset, ResetAssignment};

const HELP: &str = "a reset reads `name: e rises, variable = value;`, or `falls`";

/// The entries of `resets`.
pub(crate) fn resets(group: &Group, faults: &mut Faults) -> Entries<Reset> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let name = indexed_name(cursor, faults, "the name of a reset")?;
        colon(cursor, faults, &format!("`{name}`"), HELP)?;
        let start = cursor.span();
        let function = match expression(cursor, faults) {
            Ok(function) => function,
            Err(Reported { .. }) => {
                skip_to_comma(cursor);
                Expression::missing(start)
            }
        };
        let crossing = match function.has_missing() {
            true => Crossing::Rises,
            false => crossing(cursor, faults),
        };
        if !cursor.is_punct(';') && !cursor.is_punct(',') && !cursor.is_end() && !begins_equation(cursor) {
            let fault = Fault::new(cursor.span(), format!("expected `,` or `;`, found {}", cursor.found()));
            faults.report(fault.help(HELP));
            skip_to_comma(cursor);
        }
        cursor.eat(',');
        let assignments = separated(cursor, faults, MAX_ENTRIES, ends, begins_assignment, assignment);
        semicolon(cursor, faults, begins_equation);
        Ok(Reset { docs, name, function, crossing, assignments })
    })
}

/// `rises` or `falls`.
fn crossing(cursor: &mut Cursor, faults: &mut Faults) -> Crossing {
    for crossing in [Crossing::Rises, Crossing::Falls] {
        if cursor.eat_word(crossing.word()).is_some() {
            return crossing;
        }
    }
    let fault = Fault::new(cursor.span(), format!("expected `rises` or `falls`, found {}", cursor.found()));
    let is_comparison = ['<', '>'].into_iter().any(|mark| cursor.is_punct(mark));
    let fault = match is_comparison {
        true => fault.note("a reset happens where a function goes through zero"),
        false => fault,
    };
    faults.report(match is_comparison {
        true => fault.help("for `a > b` write `a - b rises`, for `a < b` write `a - b falls`"),
        false => fault.help(HELP),
    });
    skip_to_comma(cursor);
    Crossing::Rises
}

/// `variable = e`.
fn assignment(cursor: &mut Cursor, faults: &mut Faults) -> Result<ResetAssignment, Reported> {
    let start = cursor.span();
    let length = cursor.name_length();
    let adds = ['+', '-', '*', '/']
        .into_iter()
        .find(|mark| cursor.is_punct_at(length, *mark) && cursor.is_punct_at(length + 1, '='));
    if let (Some(mark), Some(name)) = (adds, cursor.ident_at(0)) {
        let fault = Fault::new(start, format!("expected `=` after `{name}`, found `{mark}=`"));
        let reported = faults.report(fault.help(format!("write `{name} = {name} {mark} ..`")));
        skip_to_comma(cursor);
        return Err(reported);
    }
    let variable = expression(cursor, faults)?;
    let equals = equals(cursor, faults, "a variable", "write `variable = value`")?;
    let start = cursor.span();
    let value = expression(cursor, faults).unwrap_or_else(|Reported { .. }| {
        skip_to_comma(cursor);
        Expression::missing(start)
    });
    Ok(ResetAssignment { variable, equals, value })
}

/// Whether an entry of equations ends here.
pub(super) fn ends(cursor: &Cursor) -> bool {
    cursor.is_end() || cursor.is_punct(';') || begins_equation(cursor)
}

fn begins_assignment(cursor: &Cursor) -> bool {
    cursor.ident_at(0).is_some() && cursor.is_punct_at(cursor.name_length(), '=')
}

/// Leaves what was not understood, up to the next assignment or the end of the entry.
fn skip_to_comma(cursor: &mut Cursor) {
    while !cursor.is_end() && !cursor.is_punct(',') && !cursor.is_punct(';') {
        cursor.skip(1);
    }
}
