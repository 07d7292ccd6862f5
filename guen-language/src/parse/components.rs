//! `component Name(a: scalar, ..) { sections }`, and `use path as name { a: e, .. }`.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

use super::attributes::docs;
use super::cursor::Cursor;
use super::declaration::{Owner, items};
use super::expression::expression;
use super::index::indexed_name;
use super::lists::{at_end, separated};
use super::names::name;
use super::punctuation::colon;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_ENTRIES;
use crate::names::{nearest, quoted};
use crate::syntax::{
    ArgumentKind, Component, ComponentPath, DeclaredArgument, Docs, Expression, ExpressionKind,
    GivenArgument, Name, Use, Visibility,
};

/// The form of a component, for a help.
pub(crate) const HELP_COMPONENT: &str = "a component reads `component Name(a: scalar, v: vector) { .. }`";
const HELP_USE: &str = "a component is used by `use Name as name { argument: e, .. }`";

/// Reads a component behind the word `component`.
pub(crate) fn component(
    cursor: &mut Cursor,
    faults: &mut Faults,
    docs: Docs,
    visibility: Visibility,
) -> Result<Component, Reported> {
    let name = name(cursor, faults, "the name of a component")?;
    let arguments = match cursor.eat_group(Delimiter::Parenthesis) {
        Some(group) => arguments(&group, faults),
        None if cursor.is_punct('<') => {
            let fault = Fault::new(cursor.span(), format!("expected `(` after `{name}`, found `<`"));
            faults.report(fault.help(HELP_COMPONENT));
            let begins = |cursor: &Cursor| {
                let group = |delimiter| cursor.group_at(0, delimiter).is_some();
                group(Delimiter::Parenthesis) || group(Delimiter::Brace)
            };
            while !cursor.is_end() && !begins(cursor) {
                cursor.skip(1);
            }
            cursor.eat_group(Delimiter::Parenthesis).map_or_else(Vec::new, |group| arguments(&group, faults))
        }
        // One without arguments.
        None => Vec::new(),
    };
    let Some(group) = cursor.eat_group(Delimiter::Brace) else {
        let fault =
            Fault::new(cursor.span(), format!("expected `{{` after `{name}`, found {}", cursor.found()));
        return Err(faults.report(fault.help(HELP_COMPONENT)));
    };
    let (items, nesting) = items(&group, faults, &name, Owner::Component);
    let (crate_path, imported) = (None, Vec::new());
    Ok(Component { crate_path, docs, visibility, name, arguments, items, nesting, imported })
}

/// The arguments in parentheses, each `name: kind`.
fn arguments(group: &Group, faults: &mut Faults) -> Vec<DeclaredArgument> {
    let begins = |cursor: &Cursor| cursor.ident_at(0).is_some() && cursor.is_punct_at(1, ':');
    let mut known: Vec<Name> = Vec::new();
    separated(&mut Cursor::inside(group), faults, MAX_ENTRIES, at_end, begins, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let name = name(cursor, faults, "the name of an argument")?;
        if let Some(first) = known.iter().find(|other| other.text == name.text) {
            let fault = Fault::new(name.span(), format!("`{name}` is an argument twice"));
            faults.report(fault.note_place("first declared", first.span()));
        }
        known.push(name.clone());
        colon(cursor, faults, &format!("`{name}`"), &format!("write `{name}: scalar`, or another kind"))?;
        cursor.open_invisible();
        let span = cursor.span();
        let word = cursor.ident_at(0).map(ToString::to_string).unwrap_or_default();
        let Some(kind) = ArgumentKind::of_word(&word) else {
            let fault = Fault::new(span, format!("expected a kind of argument, found {}", cursor.found()));
            let words = || ArgumentKind::ALL.into_iter().map(ArgumentKind::word);
            let near = kind_of_habit(&word).or_else(|| nearest(&word, words()));
            let is_function = FUNCTION_OF_HABIT.contains(&word.as_str());
            let fault = match near {
                _ if is_function => fault
                    .note("an argument is a value, and a function is handed over with the constants of an instance")
                    .help(format_args!("declare it in the component, `functions {{ {name}(x); }}`")),
                Some(near) => fault.help(format_args!("did you mean `{near}`?")),
                None => fault.help(format_args!("the kinds are {}", quoted(words()))),
            };
            faults.report(fault);
            cursor.recover_to_comma();
            // The likely meaning is taken: nothing is derived after a fault.
            let kind = near.and_then(ArgumentKind::of_word).unwrap_or(ArgumentKind::Scalar);
            return Ok(DeclaredArgument { docs, name, kind, is_sound: false });
        };
        cursor.skip(1);
        Ok(DeclaredArgument { docs, name, kind, is_sound: true })
    })
}

/// Words of other tools for an argument that is a function.
const FUNCTION_OF_HABIT: [&str; 6] = ["function", "fn", "Fn", "Function", "callable", "lambda"];

/// The kind that other tools call so.
fn kind_of_habit(word: &str) -> Option<&'static str> {
    Some(match word {
        "f64" | "f32" | "R" | "Real" | "real" | "float" | "double" | "number" | "angle" => "scalar",
        "vec" | "Vec" | "Vec3" | "vec3" | "Vector" | "Vector3" | "point" | "Point" | "Position" => "vector",
        "rot" | "Rotation" | "Orientation" | "orientation" | "frame" | "Frame" | "Rotation3" => "rotation",
        "usize" | "u32" | "i32" | "int" | "Integer" | "integer" | "const" => "count",
        "rigid_body" | "Body" | "RigidBody" => "body",
        _ => return None,
    })
}

/// Reads a use behind the word `use`.
pub(crate) fn instance(
    cursor: &mut Cursor,
    faults: &mut Faults,
    docs: Docs,
    keyword: proc_macro2::Span,
) -> Result<Use, Reported> {
    let path = path(cursor, faults)?;
    if cursor.eat_word("as").is_none() {
        let fault = Fault::new(
            cursor.span(),
            format!("expected `as` after `{}`, found {}", path.text, cursor.found()),
        );
        return Err(faults.report(fault.help(HELP_USE)));
    }
    let name = indexed_name(cursor, faults, "the name of an instance")?;
    let arguments = match cursor.eat_group(Delimiter::Brace) {
        Some(group) => {
            // As behind a statement of Rust; a brace ends it as well.
            cursor.eat(';');
            given(&group, faults)
        }
        None if cursor.eat(';').is_some() => Vec::new(),
        None => {
            let fault =
                Fault::new(cursor.span(), format!("expected `{{` after `{name}`, found {}", cursor.found()));
            return Err(faults.report(fault.help(HELP_USE)));
        }
    };
    Ok(Use { docs, keyword, path, name, arguments })
}

/// `Name`, `module::Name`, `crate::module::Name`, `::package::Name`.
fn path(cursor: &mut Cursor, faults: &mut Faults) -> Result<ComponentPath, Reported> {
    cursor.open_invisible();
    let (mut tokens, mut text): (Vec<TokenTree>, String) = (Vec::new(), String::new());
    let separator = |cursor: &mut Cursor, tokens: &mut Vec<TokenTree>, text: &mut String| {
        if !cursor.is_pair(':', ':') {
            return false;
        }
        tokens.extend([cursor.next(), cursor.next()].into_iter().flatten());
        text.push_str("::");
        true
    };
    separator(cursor, &mut tokens, &mut text);
    loop {
        let is_macro_crate = cursor.is_punct('$');
        let Some(ident) = cursor.ident_at(0).cloned().filter(|_| !is_macro_crate) else {
            let fault = Fault::new(cursor.span(), format!("expected a component, found {}", cursor.found()));
            return Err(faults.report(fault.help(HELP_USE)));
        };
        cursor.skip(1);
        tokens.push(ident.clone().into());
        text.push_str(&ident.to_string());
        if !separator(cursor, &mut tokens, &mut text) {
            let name = Name::new(ident);
            let tokens: TokenStream = tokens.into_iter().collect();
            return Ok(ComponentPath { tokens, text, name });
        }
    }
}

/// The arguments of a use, each `name: e`, or `name` for `name: name`.
fn given(group: &Group, faults: &mut Faults) -> Vec<GivenArgument> {
    let begins = |cursor: &Cursor| cursor.ident_at(0).is_some() && cursor.is_punct_at(1, ':');
    let mut known: Vec<Name> = Vec::new();
    separated(&mut Cursor::inside(group), faults, MAX_ENTRIES, at_end, begins, |cursor, faults| {
        if cursor.is_pair('.', '.') {
            let fault = Fault::new(cursor.span(), "every argument of a component is given");
            let reported = faults.report(fault.help("write each as `argument: e`"));
            cursor.recover_to_comma();
            return Err(reported);
        }
        let name = name(cursor, faults, "the name of an argument")?;
        if let Some(first) = known.iter().find(|other| other.text == name.text) {
            let fault = Fault::new(name.span(), format!("`{name}` is given twice"));
            faults.report(fault.note_place("first given", first.span()));
        }
        known.push(name.clone());
        if cursor.is_end() || cursor.is_punct(',') {
            let value = Expression::new(name.span(), ExpressionKind::Name(name.clone()));
            return Ok(GivenArgument { name, value });
        }
        let start = cursor.span();
        let after = format!("`{name}`");
        let value = match colon(cursor, faults, &after, &format!("write `{name}: e`")) {
            Ok(()) => expression(cursor, faults),
            Err(reported) => Err(reported),
        };
        let value = value.unwrap_or_else(|Reported { .. }| {
            cursor.recover_to_comma();
            Expression::missing(start)
        });
        Ok(GivenArgument { name, value })
    })
}
