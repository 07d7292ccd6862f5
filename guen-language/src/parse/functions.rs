//! `fn name(x, y) = e;`, and the entries `name(x, y);` of `functions`.

use proc_macro2::{Delimiter, Group, Span};

use super::attributes::docs;
use super::cursor::Cursor;
use super::lists::{at_end, entries, expression_to_semicolon, separated};
use super::names::name;
use super::nesting::Entries;
use super::punctuation::{begins_definition, equals, semicolon};
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_ENTRIES;
use crate::syntax::{Docs, Expression, FunctionDefinition, Name, SuppliedFunction};

const HELP: &str = "a function reads `fn name(x, y) = e;`";

/// Reads the definition behind `fn`.
pub(crate) fn function(
    cursor: &mut Cursor,
    faults: &mut Faults,
    docs: Docs,
) -> Result<FunctionDefinition, Reported> {
    let name = name(cursor, faults, "the name of a function")?;
    let Some(group) = cursor.eat_group(Delimiter::Parenthesis) else {
        let fault =
            Fault::new(cursor.span(), format!("expected `(` after `{name}`, found {}", cursor.found()));
        return Err(faults.report(if cursor.is_punct('<') {
            fault.help("remove the parameters: an argument may be a scalar, a vector, a rotation or a body")
        } else {
            fault.help(HELP)
        }));
    };
    let parameters = parameters(&group, faults);
    result_type(cursor, faults);
    if let Some(body) = cursor.group_at(0, Delimiter::Brace) {
        let fault = Fault::new(body.span_open(), format!("expected `=` after `{name}(..)`, found `{{`"));
        let reported = faults.report(fault.help("a function is one expression: write `fn name(x, y) = e;`"));
        cursor.skip(1);
        return Err(reported);
    }
    let span = cursor.span();
    let value = match equals(cursor, faults, &format!("`{name}(..)`"), HELP) {
        Ok(_) => expression_to_semicolon(cursor, faults, begins_definition),
        Err(Reported { .. }) => {
            cursor.recover();
            Expression::missing(span)
        }
    };
    Ok(FunctionDefinition { docs, name, parameters, value })
}

/// The entries of `functions`.
pub(crate) fn supplied(group: &Group, faults: &mut Faults) -> Entries<SuppliedFunction> {
    const HELP: &str = "a function that the program supplies reads `name(x, y);`";
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        if let Some(span) = cursor.eat_word("fn") {
            let fault = Fault::new(span, "an entry of `functions` has no `fn`");
            faults.report(
                fault
                    .help("a function that the program supplies reads `name(x, y);`")
                    .help("a function of the declaration, `fn name(x, y) = e;`, stands beside the sections"),
            );
        }
        let name = name(cursor, faults, "the name of a function")?;
        let Some(group) = cursor.eat_group(Delimiter::Parenthesis) else {
            let fault =
                Fault::new(cursor.span(), format!("expected `(` after `{name}`, found {}", cursor.found()));
            let is_array = cursor.group_at(0, Delimiter::Bracket).is_some();
            return Err(faults.report(match is_array {
                true => fault.help("there are no arrays of functions: pass the index as an argument"),
                false => fault.help(HELP),
            }));
        };
        let arguments = parameters(&group, faults);
        if arguments.is_empty() && group.stream().is_empty() {
            let fault = Fault::new(group.span(), format!("`{name}` is a function of nothing"));
            faults.report(fault.help("a number that the program supplies is an entry of `constants`"));
        }
        result_type(cursor, faults);
        if cursor.is_punct('=') {
            let fault = Fault::new(cursor.span(), format!("the program supplies `{name}`"));
            let help = format!(
                "a function of the declaration reads `fn {name}(..) = e;`, and stands beside the sections"
            );
            return Err(faults.report(fault.help(help)));
        }
        semicolon(cursor, faults, |cursor| {
            cursor.ident_at(0).is_some() && cursor.group_at(1, Delimiter::Parenthesis).is_some()
        });
        Ok(SuppliedFunction { docs, name, arguments })
    })
}

/// The names in parentheses.
fn parameters(group: &Group, faults: &mut Faults) -> Vec<Name> {
    let begins = |cursor: &Cursor| cursor.ident_at(0).is_some();
    separated(&mut Cursor::inside(group), faults, MAX_ENTRIES, at_end, begins, |cursor, faults| {
        let parameter = name(cursor, faults, "the name of an argument")?;
        if let Some(span) = cursor.eat(':') {
            types(span, faults);
            cursor.recover_to_comma();
        }
        Ok(parameter)
    })
}

/// `-> type`.
fn result_type(cursor: &mut Cursor, faults: &mut Faults) {
    if !cursor.is_pair('-', '>') {
        return;
    }
    types(cursor.span(), faults);
    cursor.skip(2);
    while !cursor.is_end() && !cursor.is_punct('=') && !cursor.is_punct(';') {
        if cursor.group_at(0, Delimiter::Brace).is_some() {
            return;
        }
        cursor.skip(1);
    }
}

fn types(span: Span, faults: &mut Faults) {
    let fault = Fault::new(span, "arguments and values of functions have no types");
    faults.report(
        fault.help("remove the type: whether an argument is a scalar or a vector is known at the call"),
    );
}
