//! `kinetic_energy = e;`, `gravity = e;`, `force_function = e;`, `potential_energy = e;`.

use proc_macro2::{Delimiter, Span};

use super::cursor::Cursor;
use super::lists::expression_to_semicolon;
use super::punctuation::equals;
use crate::diagnostics::{Faults, Reported};
use crate::syntax::{Docs, Expression, Quantity};

/// Reads the expression behind the word in front.
pub(crate) fn quantity(
    cursor: &mut Cursor,
    faults: &mut Faults,
    docs: Docs,
    word: &str,
    keyword: Span,
) -> Quantity {
    let help = format!("write `{word} = e;`");
    let value = match equals(cursor, faults, &format!("`{word}`"), &help) {
        Ok(_) => expression_to_semicolon(cursor, faults, |cursor| cursor.is_punct('#')),
        Err(Reported { .. }) => {
            if cursor.eat_group(Delimiter::Brace).is_none() {
                cursor.recover();
            }
            Expression::missing(keyword)
        }
    };
    Quantity { docs, keyword, value }
}
