//! `scene Name { track ..; fix ..; provide ..; }`, and `provide ..;` of a whole system.

use proc_macro2::{Delimiter, Group, Span};

use super::attributes::docs;
use super::cursor::Cursor;
use super::expression::expression;
use super::index::member_name;
use super::lists::{separated, stray_semicolon};
use super::modes::modes;
use super::names::name;
use super::nesting::Entries;
use super::punctuation::{equals, semicolon};
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_ENTRIES;
use crate::names::{SCENE_STATEMENTS, nearest, quoted};
use crate::syntax::{Docs, Fix, Provide, Scene, SceneStatement};

/// Reads a scene behind the word `scene`.
pub(crate) fn scene(
    cursor: &mut Cursor,
    faults: &mut Faults,
    docs: Docs,
    keyword: Span,
) -> Result<Scene, Reported> {
    let name = name(cursor, faults, "the name of a scene")?;
    let Some(group) = cursor.eat_group(Delimiter::Brace) else {
        let fault =
            Fault::new(cursor.span(), format!("expected `{{` after `{name}`, found {}", cursor.found()));
        return Err(faults.report(fault.help("a scene reads `scene Name { track theta; fix a = 1; }`")));
    };
    let mut statements = Entries::new();
    fill(&group, faults, &mut statements);
    let (statements, nesting) = statements.nesting();
    let mut scene = Scene {
        docs,
        keyword,
        name,
        tracks: Vec::new(),
        fixes: Vec::new(),
        provides: Vec::new(),
        modes: Vec::new(),
        statements: Vec::new(),
        nesting,
    };
    match scene.nesting.is_empty() {
        true => statements.into_iter().for_each(|statement| scene.add(statement)),
        false => scene.statements = statements,
    }
    Ok(scene)
}

/// Reads statements, and loops and choices around them.
fn fill(group: &Group, faults: &mut Faults, statements: &mut Entries<SceneStatement>) {
    let mut cursor = Cursor::inside(group);
    while !cursor.is_end() {
        if stray_semicolon(&mut cursor, faults) || statements.block(&mut cursor, faults, &mut fill) {
            continue;
        }
        match statement(&mut cursor, faults) {
            Ok(statement) => statements.push(statement),
            Err(Reported { .. }) => cursor.recover(),
        }
    }
}

fn statement(cursor: &mut Cursor, faults: &mut Faults) -> Result<SceneStatement, Reported> {
    let documented = cursor.span();
    let docs = docs(cursor, faults)?;
    if !docs.values.is_empty() {
        let fault = Fault::new(documented, "a statement of a scene has no documentation of its own");
        faults.report(fault.help("document the scene instead, or write `//`"));
    }
    if cursor.eat_word("track").is_some() {
        let name =
            |cursor: &mut Cursor, faults: &mut Faults| member_name(cursor, faults, "a name after `track`");
        Ok(SceneStatement::Track(list(cursor, faults, name)))
    } else if cursor.eat_word("fix").is_some() {
        Ok(SceneStatement::Fix(list(cursor, faults, fix)))
    } else if cursor.eat_word("provide").is_some() {
        Ok(SceneStatement::Provide(provides(cursor, faults)))
    } else if let Some(keyword) = cursor.eat_word("modes") {
        let Some(group) = cursor.eat_group(Delimiter::Brace) else {
            let text = format!("expected `{{` after `modes`, found {}", cursor.found());
            let fault = Fault::new(cursor.span(), text);
            return Err(faults.report(fault.help("write `modes { contact: state, state; }`")));
        };
        Ok(SceneStatement::Modes(modes(&group, faults).section(docs, keyword)))
    } else {
        Err(unknown(cursor, faults))
    }
}

fn unknown(cursor: &Cursor, faults: &mut Faults) -> Reported {
    let statements = quoted(SCENE_STATEMENTS.iter().copied());
    let Some(word) = cursor.ident_at(0).map(ToString::to_string) else {
        let text = format!("expected a statement of a scene, found {}", cursor.found());
        return faults.report(Fault::new(cursor.span(), text).help(format_args!("a scene has {statements}")));
    };
    let fault = Fault::new(cursor.span(), format!("unknown statement `{word}` in a scene"));
    faults.report(match nearest(&word, SCENE_STATEMENTS.iter().copied()) {
        Some(near) => fault.help(format_args!("did you mean `{near}`?")),
        None => fault.help(format_args!("a scene has {statements}")),
    })
}

/// The names after `provide`, with the `;`.
pub(crate) fn provides(cursor: &mut Cursor, faults: &mut Faults) -> Vec<Provide> {
    list(cursor, faults, |cursor, faults| {
        let quantity = member_name(cursor, faults, "a name after `provide`")?;
        let Some(group) = cursor.eat_group(Delimiter::Parenthesis) else {
            return Ok(Provide { name: quantity, of: None });
        };
        let begins = |cursor: &Cursor| cursor.ident_at(0).is_some();
        let mut inside = Cursor::inside(&group);
        if inside.is_end() {
            let fault = Fault::new(group.span(), format!("`{quantity}()` names nothing"));
            faults.report(fault.help(format!("write `{quantity}` for all of them")));
            return Ok(Provide { name: quantity, of: None });
        }
        let of = separated(&mut inside, faults, MAX_ENTRIES, Cursor::is_end, begins, |cursor, faults| {
            member_name(cursor, faults, "the name of a constraint")
        });
        Ok(Provide { name: quantity, of: Some(of) })
    })
}

/// `name = e` or `name`.
fn fix(cursor: &mut Cursor, faults: &mut Faults) -> Result<Fix, Reported> {
    let name = member_name(cursor, faults, "a name after `fix`")?;
    if is_end_of_list(cursor) || !(cursor.is_punct('=') || cursor.is_punct(':')) {
        return Ok(Fix { name, value: None });
    }
    equals(cursor, faults, &format!("`{name}`"), "a constant is fixed by `name = number`")?;
    Ok(Fix { name, value: Some(expression(cursor, faults)?) })
}

fn is_end_of_list(cursor: &Cursor) -> bool {
    cursor.is_end() || cursor.is_punct(';') || begins_statement(cursor)
}

/// Whether a statement begins here: after a missing `;`.
fn begins_statement(cursor: &Cursor) -> bool {
    cursor.starts_section()
        || (cursor.is_word("modes") && cursor.group_at(1, Delimiter::Brace).is_some())
        || (cursor.ident_at(0).is_some_and(|word| SCENE_STATEMENTS.iter().any(|known| word == known))
            && cursor.ident_at(1).is_some())
}

/// A list with commas that ends at a `;`.
fn list<T>(
    cursor: &mut Cursor,
    faults: &mut Faults,
    entry: impl FnMut(&mut Cursor, &mut Faults) -> Result<T, Reported>,
) -> Vec<T> {
    if is_end_of_list(cursor) {
        faults.report(Fault::new(cursor.span(), format!("expected a name, found {}", cursor.found())));
    }
    let begins = |cursor: &Cursor| cursor.ident_at(0).is_some();
    let entries = separated(cursor, faults, MAX_ENTRIES, is_end_of_list, begins, entry);
    semicolon(cursor, faults, begins_statement);
    entries
}
