//! The marks between the parts of an entry, with the slips that are common at each of them.

use proc_macro2::{Span, TokenTree};

use super::cursor::Cursor;
use crate::diagnostics::{Fault, Faults, Reported};

/// The `=` between two parts. Other habits are reported and read as `=`.
pub(crate) fn equals(
    cursor: &mut Cursor,
    faults: &mut Faults,
    after: &str,
    help: &str,
) -> Result<Span, Reported> {
    let span = cursor.span();
    if cursor.is_pair('=', '=') {
        faults
            .report(Fault::new(span, "expected `=`, found `==`").help("an equation is written with one `=`"));
        cursor.skip(2);
        return Ok(span);
    }
    if cursor.eat('=').is_some() {
        return Ok(span);
    }
    let fault = Fault::new(span, format!("expected `=` after {after}, found {}", cursor.found())).help(help);
    let reported = faults.report(fault);
    if cursor.is_pair(':', '=') {
        cursor.skip(2);
        return Ok(span);
    }
    if cursor.eat(':').is_some() {
        return Ok(span);
    }
    Err(reported)
}

/// The `:` after a name. An `=` is reported and read as `:`.
pub(crate) fn colon(
    cursor: &mut Cursor,
    faults: &mut Faults,
    after: &str,
    help: &str,
) -> Result<(), Reported> {
    if cursor.eat(':').is_some() {
        return Ok(());
    }
    let fault = Fault::new(cursor.span(), format!("expected `:` after {after}, found {}", cursor.found()));
    let reported = faults.report(fault.help(help));
    if cursor.is_punct('=') && !cursor.is_pair('=', '=') {
        cursor.skip(1);
        return Ok(());
    }
    Err(reported)
}

/// The `;` that ends an entry whose name and mark stand before. Whatever stands there instead is reported, and
/// the cursor goes on to where the next entry begins.
pub(crate) fn semicolon(cursor: &mut Cursor, faults: &mut Faults, begins_entry: fn(&Cursor) -> bool) {
    if cursor.eat(';').is_some() {
        return;
    }
    if cursor.is_end() {
        faults.report(
            Fault::new(cursor.span_before(), "expected `;` after this").help("every entry ends with `;`"),
        );
        return;
    }
    if cursor.is_punct(',') {
        faults.report(
            Fault::new(cursor.span(), "expected `;`, found `,`")
                .help("entries that hold expressions end with `;`"),
        );
        cursor.skip(1);
        return;
    }
    if cursor.starts_section() || begins_entry(cursor) {
        faults.report(
            Fault::new(cursor.span(), format!("expected `;` before {}", cursor.found()))
                .help("the entry before this one has to end with `;`"),
        );
        return;
    }
    unexpected(cursor, faults, "`;`");
    cursor.recover();
}

/// Reports what cannot continue an expression, and says what was probably meant.
pub(crate) fn unexpected(cursor: &Cursor, faults: &mut Faults, expected: &str) -> Reported {
    let fault =
        Fault::new(cursor.span(), format!("expected {expected} or an operator, found {}", cursor.found()));
    faults.report(match cursor.peek() {
        Some(TokenTree::Ident(word)) if word == "as" => {
            fault.help("numbers have no types here: leave out `as` and the type")
        }
        Some(TokenTree::Ident(_) | TokenTree::Group(_)) => {
            fault.help("if a product is meant, write `*` between its factors")
        }
        Some(TokenTree::Punct(mark)) => match mark.as_char() {
            '=' => fault.help("an entry has one `=`"),
            '<' | '>' | '!' => fault.help("comparisons stand in `constants`, as `m > 0`, and first in `select(c >= 0, a, b)`"),
            '%' => fault.help("there is no remainder of a division: use `sin` and `cos` of angles"),
            '?' => {
                fault.help("an expression has no branches: write `select(c >= 0, a, b)`, `a` where the comparison holds and `b` elsewhere")
            }
            ':' => fault.help("the name of an entry stands at its beginning"),
            _ => fault,
        },
        _ => fault,
    })
}

/// Whether a definition begins here: `name =`, perhaps with documentation.
pub(crate) fn begins_definition(cursor: &Cursor) -> bool {
    cursor.is_punct('#')
        || (cursor.ident_at(0).is_some()
            && cursor.is_punct_at(cursor.name_length(), '=')
            && !cursor.is_punct_at(cursor.name_length() + 1, '='))
}

/// Whether an equation begins here: `name:`, perhaps with documentation.
pub(crate) fn begins_equation(cursor: &Cursor) -> bool {
    cursor.is_punct('#')
        || (cursor.ident_at(0).is_some()
            && cursor.is_punct_at(cursor.name_length(), ':')
            && !cursor.is_punct_at(cursor.name_length() + 1, ':'))
}

/// Whether documentation begins here; for entries that begin with an expression.
pub(crate) fn begins_documentation(cursor: &Cursor) -> bool {
    cursor.is_punct('#')
}
