//! `constants { a, m > 0, c >= 0, k != 0, g = 9.81, I > 0 = 2/5*m*a^2 }`.

use proc_macro2::{Group, TokenTree};

use super::attributes::docs;
use super::cursor::Cursor;
use super::expression::expression;
use super::index::indexed_name;
use super::lists::{limits_behind, listed};
use super::nesting::Entries;
use super::punctuation::equals;
use super::units::unit;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_ENTRIES;
use crate::syntax::{BoundKind, Constant, Expression, Number, WrittenBound};

const HELP_BOUND: &str = "the bounds are `name > 0`, `name >= 0`, `name != 0` and `name in lower..upper`";

/// The entries of `constants`.
pub(crate) fn constants(group: &Group, faults: &mut Faults) -> Entries<Constant> {
    listed(group, faults, MAX_ENTRIES, begins_constant, &mut constant)
}

/// Whether a name with something that may follow it in this list stands here. Anything else, such as a unit
/// after a number, is no new entry.
fn begins_constant(cursor: &Cursor) -> bool {
    cursor.is_punct('#')
        || (cursor.ident_at(0).is_some()
            && (cursor.peek_nth(cursor.name_length()).is_none()
                || cursor.is_word_at(cursor.name_length(), "in")
                || [',', '>', '!', '=', ':']
                    .iter()
                    .any(|mark| cursor.is_punct_at(cursor.name_length(), *mark))))
}

fn constant(cursor: &mut Cursor, faults: &mut Faults) -> Result<Constant, Reported> {
    let docs = docs(cursor, faults)?;
    if matches!(cursor.peek(), Some(TokenTree::Literal(_))) {
        let fault =
            Fault::new(cursor.span(), format!("expected the name of a constant, found {}", cursor.found()));
        return Err(faults.report(fault.help(HELP_BOUND)));
    }
    let name = indexed_name(cursor, faults, "the name of a constant")?;
    // From here on the name counts as declared, whatever is wrong with the rest.
    let mut constant = Constant { docs, name, unit: None, bound: None, limits: None, default: None };
    if rest(cursor, faults, &mut constant).is_err() {
        cursor.recover_to_comma();
    }
    Ok(constant)
}

fn rest(cursor: &mut Cursor, faults: &mut Faults, constant: &mut Constant) -> Result<(), Reported> {
    constant.unit = unit(cursor, faults)?;
    constant.bound = bound(cursor, faults)?;
    constant.limits = limits(cursor, faults, constant)?;
    if cursor.is_end() || !(cursor.is_punct('=') || cursor.is_punct(':')) {
        return Ok(());
    }
    equals(cursor, faults, "the constant", "a default is written `g = 9.81`")?;
    constant.default = Some(expression(cursor, faults)?);
    if is_comparison(cursor) {
        let text = if constant.bound.is_some() {
            "a constant has one bound"
        } else {
            "the bound stands before the default"
        };
        let fault = Fault::new(cursor.span(), text);
        return Err(faults.report(fault.help(format_args!("write `{} > 0 = value`", constant.name))));
    }
    Ok(())
}

/// `in lower..upper`, if it stands here.
fn limits(
    cursor: &mut Cursor,
    faults: &mut Faults,
    constant: &Constant,
) -> Result<Option<Box<[Expression; 2]>>, Reported> {
    let Some(span) = cursor.eat_word("in") else { return Ok(None) };
    if constant.bound.is_some() {
        return Err(faults.report(Fault::new(span, "a constant has one bound")));
    }
    limits_behind(cursor, faults, "constant").map(Some)
}

fn is_comparison(cursor: &Cursor) -> bool {
    cursor.is_punct('>') || cursor.is_punct('<') || cursor.is_pair('!', '=')
}

/// `> 0`, `>= 0` or `!= 0`, if a comparison stands here.
fn bound(cursor: &mut Cursor, faults: &mut Faults) -> Result<Option<WrittenBound>, Reported> {
    if !is_comparison(cursor) {
        return Ok(None);
    }
    let span = cursor.span();
    let kind = if cursor.is_pair('>', '=') {
        cursor.skip(2);
        BoundKind::Nonnegative
    } else if cursor.is_pair('!', '=') {
        cursor.skip(2);
        BoundKind::Nonzero
    } else if cursor.eat('>').is_some() {
        BoundKind::Positive
    } else {
        let fault = Fault::new(span, format!("{} does not begin a bound of a constant", cursor.found()));
        return Err(
            faults.report(fault.help(HELP_BOUND).help("for a negative quantity declare its opposite"))
        );
    };
    cursor.open_invisible();
    match cursor.peek() {
        Some(TokenTree::Literal(literal))
            if Number::from_literal(&literal.to_string()).is_ok_and(|number| number.is_zero()) =>
        {
            cursor.skip(1);
        }
        _ => {
            let fault =
                Fault::new(cursor.span(), format!("a bound compares with `0`, found {}", cursor.found()));
            return Err(faults.report(fault.help(HELP_BOUND)));
        }
    }
    if is_comparison(cursor) {
        let fault = Fault::new(cursor.span(), "comparisons cannot be chained");
        return Err(faults.report(fault.help(HELP_BOUND)));
    }
    Ok(Some(WrittenBound { kind, span }))
}
