//! `modes { contact: state, state; never contact.state with contact.state; }`, where a state may be `slip+`.

use proc_macro2::Group;

use super::attributes::docs;
use super::cursor::Cursor;
use super::index::{member_name, member_of, member_steps};
use super::lists::{entries, separated};
use super::names::name;
use super::nesting::Entries;
use super::punctuation::{begins_equation, colon, semicolon};
use crate::diagnostics::{Fault, Faults, Reported};
use crate::limits::MAX_ENTRIES;
use crate::syntax::{Index, ModeStatement, Name};

const HELP_STATES: &str = "the states of a contact read `contact: open, stick;`";
const HELP_NEVER: &str = "a combination that does not occur reads `never left.stick with right.stick;`";

/// The statements of `modes`.
pub(crate) fn modes(group: &Group, faults: &mut Faults) -> Entries<ModeStatement> {
    entries(group, faults, |cursor, faults| {
        let documented = cursor.span();
        let docs = docs(cursor, faults)?;
        if !docs.values.is_empty() {
            let fault = Fault::new(documented, "a statement of `modes` has no documentation of its own");
            faults.report(fault.help("write `//`"));
        }
        // A contact may be called `never`.
        if cursor.is_word("never") && !cursor.is_punct_at(cursor.name_length(), ':') {
            return never(cursor, faults);
        }
        let contact = member_name(cursor, faults, "the name of a contact")?;
        colon(cursor, faults, &format!("`{contact}`"), HELP_STATES)?;
        let begins = |cursor: &Cursor| cursor.ident_at(0).is_some() && !begins_equation(cursor);
        let ends = |cursor: &Cursor| cursor.is_end() || cursor.is_punct(';') || begins_equation(cursor);
        if ends(cursor) {
            let fault = Fault::new(cursor.span(), format!("expected a state, found {}", cursor.found()));
            faults.report(fault.help(HELP_STATES));
        }
        let states = separated(cursor, faults, MAX_ENTRIES, ends, begins, state);
        semicolon(cursor, faults, begins_equation);
        Ok(ModeStatement::States { contact, states })
    })
}

fn state(cursor: &mut Cursor, faults: &mut Faults) -> Result<Name, Reported> {
    let state = name(cursor, faults, "a state of a contact")?;
    Ok(signed(cursor, state))
}

/// A state with its sign: `slip+` and `slip-` are the two directions of a slip along a line.
fn signed(cursor: &mut Cursor, mut state: Name) -> Name {
    for sign in ['+', '-'] {
        if cursor.is_punct(sign) {
            cursor.skip(1);
            state.text.push(sign);
            break;
        }
    }
    state
}

fn never(cursor: &mut Cursor, faults: &mut Faults) -> Result<ModeStatement, Reported> {
    let keyword = cursor.span();
    cursor.skip(1);
    let mut combination = vec![pair(cursor, faults)?];
    while cursor.eat_word("with").is_some() {
        combination.push(pair(cursor, faults)?);
    }
    semicolon(cursor, faults, begins_equation);
    Ok(ModeStatement::Never { keyword, combination })
}

/// `contact.state`, where the contact may be that of an instance, `left.tyre.stick`.
fn pair(cursor: &mut Cursor, faults: &mut Faults) -> Result<(Name, Name), Reported> {
    let mut steps = member_steps(cursor, faults, "the name of a contact")?;
    let state = if steps.len() > 1 { steps.pop() } else { None };
    let contact = member_of(steps);
    let Some(state) = state else {
        let fault =
            Fault::new(cursor.span(), format!("expected `.` after `{contact}`, found {}", cursor.found()));
        return Err(faults.report(fault.help(HELP_NEVER)));
    };
    if !matches!(state.index, Index::None) {
        let fault = Fault::new(state.span(), format!("the state `{state}` has no entries"));
        return Err(faults.report(fault.help(HELP_NEVER)));
    }
    Ok((contact, signed(cursor, state)))
}
