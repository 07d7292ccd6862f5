//! `name: left = right;`: in `constraints` and `holonomic`.

use proc_macro2::{Group, Span};

use super::attributes::docs;
use super::cursor::Cursor;
use super::expression::expression;
use super::index::indexed_name;
use super::lists::{entries, expression_to_semicolon};
use super::nesting::Entries;
use super::punctuation::{begins_equation, colon};
use crate::diagnostics::{Fault, Faults, Reported};
use crate::syntax::{Equation, Expression};

const HELP: &str = "an entry reads `name: left = right;`";

/// The entries of `constraints` or `holonomic`.
pub(crate) fn equations(group: &Group, faults: &mut Faults) -> Entries<Equation> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let end = cursor.name_length();
        let has_name = (cursor.is_punct_at(end, ':') && !cursor.is_punct_at(end + 1, ':'))
            || cursor.is_punct_at(end, '=');
        if !has_name && !cursor.is_end() && !cursor.is_word("pub") {
            let fault = Fault::new(cursor.span(), "a constraint needs a name");
            return Err(faults
                .report(fault.help("write `name: left = right;`, the name stands for its reaction too")));
        }
        let name = indexed_name(cursor, faults, "the name of a constraint")?;
        let start = cursor.span();
        let (left, equals, right) =
            sides(cursor, faults, &name.text).unwrap_or_else(|Reported { .. }| {
                cursor.recover();
                (Expression::missing(start), start, Expression::missing(start))
            });
        Ok(Equation { docs, name, left, equals, right })
    })
}

fn sides(
    cursor: &mut Cursor,
    faults: &mut Faults,
    name: &str,
) -> Result<(Expression, Span, Expression), Reported> {
    colon(cursor, faults, &format!("`{name}`"), HELP)?;
    let left = expression(cursor, faults)?;
    let span = cursor.span();
    if cursor.is_pair('=', '=') {
        faults
            .report(Fault::new(span, "expected `=`, found `==`").help("an equation is written with one `=`"));
        cursor.skip(2);
    } else if cursor.eat('=').is_none() {
        if cursor.is_punct(';') || cursor.is_end() {
            let fault =
                Fault::new(cursor.span_before(), format!("expected `=` after this: `{name}` is an equation"));
            return Err(faults.report(fault.help("write `= 0` at its end")));
        }
        let fault = Fault::new(span, format!("expected `=` or an operator, found {}", cursor.found()));
        let is_inequality = cursor.is_punct('<') || cursor.is_punct('>') || cursor.is_punct('!');
        return Err(faults.report(if is_inequality {
            fault.help("constraints are equations; what stays on one side is a contact: `contacts { name: gap = e; }`")
        } else {
            fault.help(HELP).help("if a product is meant, write `*` between its factors")
        }));
    }
    let right = expression_to_semicolon(cursor, faults, begins_equation);
    Ok((left, span, right))
}
