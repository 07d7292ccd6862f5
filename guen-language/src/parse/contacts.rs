//! `contacts { name: gap = e, slip = v, ..; }` and `switches { name: e; }`.

use proc_macro2::{Group, Span};

use super::attributes::docs;
use super::cursor::Cursor;
use super::expression::expression;
use super::index::indexed_name;
use super::lists::{entries, expression_to_semicolon, separated};
use super::nesting::Entries;
use super::punctuation::{begins_equation, colon, equals, semicolon};
use super::resets::ends;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_ENTRIES;
use crate::names::{nearest, quoted};
use crate::syntax::{Clause, ClauseWord, Contact, Expression, Name, Switch};

const HELP: &str = "a contact reads `name: gap = e;` or `name: gap = e, slip = v, friction = mu;`";

/// The entries of `contacts`.
pub(crate) fn contacts(group: &Group, faults: &mut Faults) -> Entries<Contact> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let end = cursor.name_length();
        let has_name = cursor.is_punct_at(end, ':') && !cursor.is_punct_at(end + 1, ':');
        if !has_name && cursor.is_punct_at(end, '=') {
            let fault = Fault::new(cursor.span(), "a contact needs a name");
            return Err(faults.report(fault.help(HELP)));
        }
        let name = indexed_name(cursor, faults, "the name of a contact")?;
        colon(cursor, faults, &format!("`{name}`"), HELP)?;
        let clauses = separated(cursor, faults, MAX_ENTRIES, ends, begins_clause, clause);
        semicolon(cursor, faults, begins_equation);
        Ok(Contact { docs, clauses: once(clauses, &name, faults), name })
    })
}

fn begins_clause(cursor: &Cursor) -> bool {
    cursor.ident_at(0).is_some() && cursor.is_punct_at(1, '=')
}

fn clause(cursor: &mut Cursor, faults: &mut Faults) -> Result<Clause, Reported> {
    let keyword = cursor.span();
    let Some(text) = cursor.ident_at(0).map(ToString::to_string) else {
        let fault = Fault::new(keyword, format!("expected a word of a contact, found {}", cursor.found()));
        return Err(faults.report(fault.help(HELP)));
    };
    let Some(word) = ClauseWord::ALL.into_iter().find(|word| word.text() == text) else {
        let fault = Fault::new(keyword, format!("unknown word `{text}` in a contact"));
        let words = ClauseWord::ALL.iter().map(|word| word.text());
        return Err(faults.report(match nearest(&text, words.clone()) {
            Some(near) => fault.help(format_args!("did you mean `{near}`?")),
            None => fault.help(format_args!("the words are {}", quoted(words))),
        }));
    };
    cursor.skip(1);
    equals(cursor, faults, &format!("`{text}`"), &format!("write `{text} = e`"))?;
    let start = cursor.span();
    let value = expression(cursor, faults).unwrap_or_else(|Reported { .. }| missing(cursor, start));
    Ok(Clause { word, keyword, value })
}

/// Leaves what is no expression, up to the next clause.
fn missing(cursor: &mut Cursor, start: Span) -> Expression {
    cursor.recover_to_comma();
    Expression::missing(start)
}

/// Every word once.
fn once(clauses: Vec<Clause>, name: &Name, faults: &mut Faults) -> Vec<Clause> {
    let mut found: Vec<Clause> = Vec::new();
    for clause in clauses {
        let word = clause.word.text();
        match found.iter().find(|known| known.word == clause.word) {
            Some(first) => {
                let fault = Fault::new(clause.keyword, format!("`{word}` of `{name}` is given twice"));
                faults.report(fault.note_place("first given", first.keyword));
            }
            None => found.push(clause),
        }
    }
    found
}

/// The entries of `switches`.
pub(crate) fn switches(group: &Group, faults: &mut Faults) -> Entries<Switch> {
    entries(group, faults, |cursor, faults| {
        let docs = docs(cursor, faults)?;
        let name = indexed_name(cursor, faults, "the name of a switch")?;
        colon(
            cursor,
            faults,
            &format!("`{name}`"),
            "a switch reads `name: e;`, and is 1 where `e` is positive",
        )?;
        let value = expression_to_semicolon(cursor, faults, begins_equation);
        Ok(Switch { docs, name, value })
    })
}
