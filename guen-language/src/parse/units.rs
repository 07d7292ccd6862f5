//! `: kg*m/s^2` behind a name.

use guen_symbolic::Rational;
use proc_macro2::{Delimiter, TokenTree};

use super::cursor::Cursor;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::names::{nearest, quoted};
use crate::syntax::{Dimension, Number, Unit};

const HELP: &str = "a unit is a product of powers of SI units, as `kg*m/s^2`";

/// The unit behind a `:`, if one stands here.
pub(crate) fn unit(cursor: &mut Cursor, faults: &mut Faults) -> Result<Option<Unit>, Reported> {
    if !cursor.is_punct(':') || cursor.is_pair(':', '=') {
        return Ok(None);
    }
    cursor.skip(1);
    cursor.open_invisible();
    let span = cursor.span();
    let mut unit = Unit { span, text: String::new(), dimension: Dimension::one(), is_degrees: false };
    let mut sign = 1;
    loop {
        factor(cursor, faults, &mut unit, sign)?;
        sign = match cursor.peek() {
            Some(TokenTree::Punct(mark)) if mark.as_char() == '*' => 1,
            Some(TokenTree::Punct(mark)) if mark.as_char() == '/' => -1,
            _ => break,
        };
        unit.text.push(if sign > 0 { '*' } else { '/' });
        cursor.skip(1);
    }
    if unit.is_degrees && unit.text != "deg" {
        let fault = Fault::new(span, "`deg` stands alone");
        return Err(faults.report(fault.help("in products write `rad`")));
    }
    Ok(Some(unit))
}

/// A unit with its power, `1`, or a product in parentheses.
fn factor(cursor: &mut Cursor, faults: &mut Faults, unit: &mut Unit, sign: i64) -> Result<(), Reported> {
    let span = cursor.span();
    let (text, dimension) = match cursor.peek().cloned() {
        Some(TokenTree::Ident(ident)) => {
            let text = ident.to_string();
            let Some(dimension) = Dimension::of_unit(&text) else {
                return Err(faults.report(unknown(span, &text)));
            };
            cursor.skip(1);
            unit.is_degrees |= text == "deg";
            (text, dimension)
        }
        Some(TokenTree::Literal(literal)) if literal.to_string() == "1" => {
            cursor.skip(1);
            ("1".to_owned(), Dimension::one())
        }
        Some(TokenTree::Group(group)) if group.delimiter() == Delimiter::Parenthesis => {
            cursor.skip(1);
            let mut inside = Cursor::inside(&group);
            let mut product =
                Unit { span, text: String::new(), dimension: Dimension::one(), is_degrees: false };
            let mut own = 1;
            loop {
                factor(&mut inside, faults, &mut product, own)?;
                let (mark, next) = match () {
                    () if inside.is_punct('*') => ('*', 1),
                    () if inside.is_punct('/') => ('/', -1),
                    () => break,
                };
                product.text.push(mark);
                inside.skip(1);
                own = next;
            }
            if !inside.is_end() {
                let fault = Fault::new(inside.span(), format!("expected `)`, found {}", inside.found()));
                return Err(faults.report(fault.help(HELP)));
            }
            unit.is_degrees |= product.is_degrees;
            (format!("({})", product.text), product.dimension)
        }
        _ => {
            let fault = Fault::new(span, format!("expected a unit, found {}", cursor.found()));
            return Err(faults.report(fault.help(HELP)));
        }
    };
    unit.text.push_str(&text);
    let mut power = Rational::integer(1);
    if cursor.eat('^').is_some() {
        unit.text.push('^');
        power = exponent(cursor, faults, &mut unit.text)?;
    }
    unit.dimension = unit.dimension.times(&dimension, &(&power * &Rational::integer(sign)));
    Ok(())
}

/// A whole number, or a quotient in parentheses.
fn exponent(cursor: &mut Cursor, faults: &mut Faults, text: &mut String) -> Result<Rational, Reported> {
    if let Some(group) = cursor.eat_group(Delimiter::Parenthesis) {
        let mut inside = Cursor::inside(&group);
        text.push('(');
        let mut value = whole(&mut inside, faults, text)?;
        if inside.eat('/').is_some() {
            text.push('/');
            let below = whole(&mut inside, faults, text)?;
            let Some(reciprocal) = below.recip() else {
                return Err(faults.report(Fault::new(group.span_open(), "a power by zero")));
            };
            value = &value * &reciprocal;
        }
        text.push(')');
        return Ok(value);
    }
    whole(cursor, faults, text)
}

fn whole(cursor: &mut Cursor, faults: &mut Faults, text: &mut String) -> Result<Rational, Reported> {
    let is_negative = cursor.eat('-').is_some();
    let span = cursor.span();
    if let Some(TokenTree::Literal(literal)) = cursor.peek().cloned()
        && let Ok(number) = Number::from_literal(&literal.to_string())
        && let Some(value) = Rational::from_decimal(&number.digits, number.exponent)
        && value.to_i64().is_some_and(|value| value < 100)
    {
        cursor.skip(1);
        text.push_str(&format!("{}{}", if is_negative { "-" } else { "" }, number.text));
        return Ok(if is_negative { &value * &Rational::integer(-1) } else { value });
    }
    let fault = Fault::new(span, format!("expected the power of a unit, found {}", cursor.found()));
    Err(faults.report(fault.help("powers are whole, or quotients in parentheses, as `m^(1/2)`")))
}

fn unknown(span: proc_macro2::Span, text: &str) -> Fault {
    let fault = Fault::new(span, format!("unknown unit `{text}`"));
    let types = ["f64", "f32", "scalar", "real", "Real", "vector", "angle", "int", "float"];
    if types.contains(&text) {
        return fault.help("names have no types; what stands here is a unit, as in `l: m > 0`");
    }
    let prefixed = ["k", "c", "m", "u", "M", "G", "n"]
        .into_iter()
        .any(|prefix| text.strip_prefix(prefix).is_some_and(|rest| Dimension::of_unit(rest).is_some()));
    if prefixed || ["g", "min", "h", "inch", "ft", "lb", "rpm", "bar", "t"].contains(&text) {
        return fault
            .help("units have no prefixes and no factors: give values in kg, m, s, A, N, J and the like");
    }
    match nearest(text, Dimension::names()) {
        Some(near) => fault.help(format!("did you mean `{near}`?")),
        None => fault.help(format!("the units are {}", quoted(Dimension::names()))),
    }
}
