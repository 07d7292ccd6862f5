//! `bodies { name { mass: e, inertia: diag(e, e, e), center: e, orientation: e } .. }`.

use proc_macro2::{Delimiter, Group, Span};

use super::attributes::docs;
use super::cursor::Cursor;
use super::expression::{arguments, expression};
use super::index::indexed_name;
use super::lists::{at_end, separated};
use super::names::name;
use super::nesting::Entries;
use super::punctuation::colon;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_ENTRIES;
use crate::names::{BODY_FIELDS, nearest, quoted};
use crate::syntax::{Body, BodyField, Expression, Inertia, Name};

const HELP_INERTIA: &str = "write `inertia: diag(xx, yy, zz)` or `inertia: sym(xx, yy, zz, xy, yz, zx)`";

/// The entries of `bodies`; commas between them are optional.
pub(crate) fn bodies(group: &Group, faults: &mut Faults) -> Entries<Body> {
    let mut bodies = Entries::new();
    fill(group, faults, &mut bodies);
    bodies
}

fn fill(group: &Group, faults: &mut Faults, bodies: &mut Entries<Body>) {
    let mut cursor = Cursor::inside(group);
    while !cursor.is_end() {
        if bodies.block(&mut cursor, faults, &mut fill) {
            cursor.eat(',');
            continue;
        }
        if bodies.list.len() >= MAX_ENTRIES {
            faults.report(Fault::new(cursor.span(), format!("more than {MAX_ENTRIES} bodies")));
            break;
        }
        match body(&mut cursor, faults) {
            Ok(body) => {
                bodies.push(body);
                if cursor.is_punct(';') {
                    let fault = Fault::new(cursor.span(), "this `;` ends nothing");
                    faults.report(fault.help("remove it, or write `,`"));
                    cursor.skip(1);
                } else {
                    cursor.eat(',');
                }
            }
            Err(Reported { .. }) => {
                while !cursor.is_end() && cursor.eat_group(Delimiter::Brace).is_none() {
                    cursor.skip(1);
                }
                cursor.eat(',');
            }
        }
    }
}

fn body(cursor: &mut Cursor, faults: &mut Faults) -> Result<Body, Reported> {
    let docs = docs(cursor, faults)?;
    let name = indexed_name(cursor, faults, "the name of a body")?;
    let Some(group) = cursor.eat_group(Delimiter::Brace) else {
        let fault =
            Fault::new(cursor.span(), format!("expected `{{` after `{name}`, found {}", cursor.found()));
        return Err(faults.report(fault.help("a body reads `name { mass: e, center: e, .. }`")));
    };
    let mut body = Body { docs, name, mass: None, inertia: None, center: None, orientation: None };
    let is_clear = faults.part(|faults| fields(&group, faults, &mut body)).is_ok();
    if is_clear {
        pairs(&body, faults);
    }
    Ok(body)
}

fn fields(group: &Group, faults: &mut Faults, body: &mut Body) {
    let begins = |cursor: &Cursor| cursor.ident_at(0).is_some() && cursor.is_punct_at(1, ':');
    separated(&mut Cursor::inside(group), faults, MAX_ENTRIES, at_end, begins, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let field = name(cursor, faults, "a field of a body")?;
        if !docs.values.is_empty() {
            let fault = Fault::new(field.span(), "a field of a body has no documentation of its own");
            faults.report(fault.help("document the body instead, or write `//`"));
        }
        self::field(cursor, faults, body, &field)
    });
}

fn field(cursor: &mut Cursor, faults: &mut Faults, body: &mut Body, field: &Name) -> Result<(), Reported> {
    let keyword = field.span();
    if !BODY_FIELDS.contains(&field.text.as_str()) {
        let fault = Fault::new(keyword, format!("a body has no field `{field}`"));
        return Err(faults.report(match nearest(&field.text, BODY_FIELDS.iter().copied()) {
            Some(near) => fault.help(format_args!("did you mean `{near}`?")),
            None => fault.help(format_args!("the fields are {}", quoted(BODY_FIELDS.iter().copied()))),
        }));
    }
    let earlier = match field.text.as_str() {
        "mass" => body.mass.as_ref().map(|field| field.keyword),
        "inertia" => body.inertia.as_ref().map(|field| field.keyword),
        "center" => body.center.as_ref().map(|field| field.keyword),
        _ => body.orientation.as_ref().map(|field| field.keyword),
    };
    if let Some(earlier) = earlier {
        let fault = Fault::new(keyword, format!("`{field}` is given twice"));
        faults.report(fault.note_place("first given", earlier));
    }
    colon(cursor, faults, &format!("`{field}`"), &format!("write `{field}: e`"))?;
    if field.text == "inertia" {
        let value = inertia(cursor, faults);
        let is_whole = value.is_ok();
        body.inertia = Some(BodyField { keyword, value: value.unwrap_or(Inertia::Missing) });
        if !is_whole {
            cursor.recover_to_comma();
        }
        return Ok(());
    }
    let start = cursor.span();
    let value = expression(cursor, faults).unwrap_or_else(|Reported { .. }| {
        cursor.recover_to_comma();
        Expression::missing(start)
    });
    let value = Some(BodyField { keyword, value });
    match field.text.as_str() {
        "mass" => body.mass = value,
        "center" => body.center = value,
        _ => body.orientation = value,
    }
    Ok(())
}

/// `diag(..)` or `sym(..)`.
fn inertia(cursor: &mut Cursor, faults: &mut Faults) -> Result<Inertia, Reported> {
    cursor.open_invisible();
    let span = cursor.span();
    let is_diagonal = cursor.is_word("diag");
    if !is_diagonal && !cursor.is_word("sym") {
        let fault = Fault::new(span, format!("expected `diag` or `sym`, found {}", cursor.found()));
        return Err(faults.report(fault.help(HELP_INERTIA)));
    }
    cursor.skip(1);
    let Some(group) = cursor.eat_group(Delimiter::Parenthesis) else {
        let fault = Fault::new(cursor.span(), format!("expected `(`, found {}", cursor.found()));
        return Err(faults.report(fault.help(HELP_INERTIA)));
    };
    let entries = arguments(&group, faults, 0);
    let given = entries.len();
    let tensor = if is_diagonal {
        <Box<[Expression; 3]>>::try_from(entries).ok().map(Inertia::Diagonal)
    } else {
        <Box<[Expression; 6]>>::try_from(entries).ok().map(Inertia::Symmetric)
    };
    tensor.ok_or_else(|| {
        let (word, wanted) = if is_diagonal { ("diag", 3) } else { ("sym", 6) };
        let fault = Fault::new(span, format!("`{word}` takes {wanted} entries, {given} are given"));
        faults.report(fault.help(HELP_INERTIA))
    })
}

/// Mass goes with center, inertia with orientation.
fn pairs(body: &Body, faults: &mut Faults) {
    fn place<T>(field: &Option<BodyField<T>>) -> Option<Span> {
        field.as_ref().map(|field| field.keyword)
    }
    let name = &body.name;
    let mut pair = |first: (&str, Option<Span>), second: (&str, Option<Span>), help: &str| {
        let (span, given, absent) = match (first.1, second.1) {
            (Some(span), None) => (span, first.0, second.0),
            (None, Some(span)) => (span, second.0, first.0),
            _ => return,
        };
        let fault = Fault::new(span, format!("body `{name}` has `{given}` but no `{absent}`"));
        faults.report(fault.help(help));
    };
    pair(
        ("mass", place(&body.mass)),
        ("center", place(&body.center)),
        "give both; without mass write `mass: 0`",
    );
    pair(
        ("inertia", place(&body.inertia)),
        ("orientation", place(&body.orientation)),
        "give both; without inertia write `inertia: diag(0, 0, 0)`",
    );
    if body.mass.is_none() && body.inertia.is_none() {
        let fault = Fault::new(name.span(), format!("body `{name}` has neither mass nor inertia"));
        faults.report(fault.help("give it `mass` and `center`, or `inertia` and `orientation`, or all four"));
    }
}
