//! Names where something is declared or listed.

use proc_macro2::{Delimiter, Ident, TokenTree};

use super::cursor::Cursor;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::names::{can_be_raw, is_rust_keyword};
use crate::syntax::Name;

/// A name; `role` says in a message of what.
pub(crate) fn name(cursor: &mut Cursor, faults: &mut Faults, role: &str) -> Result<Name, Reported> {
    cursor.open_invisible();
    if cursor.is_word("pub") {
        faults.report(
            Fault::new(cursor.span(), "`pub` may stand only before `system`")
                .help("remove it: everything that is generated is as visible as the system"),
        );
        cursor.skip(1);
        if cursor.group_at(0, Delimiter::Parenthesis).is_some() {
            cursor.skip(1);
        }
    }
    let Some(TokenTree::Ident(ident)) = cursor.peek().cloned() else {
        let mut fault = Fault::new(cursor.span(), format!("expected {role}, found {}", cursor.found()));
        if matches!(cursor.peek(), Some(TokenTree::Literal(_))) {
            fault = fault.help("a name begins with a letter or `_`");
        }
        return Err(faults.report(fault));
    };
    let text = ident.to_string();
    if !is_rust_keyword(&text) {
        cursor.skip(1);
        return Ok(Name::new(ident));
    }
    let fault = Fault::new(ident.span(), format!("expected {role}, found keyword `{text}`"));
    if !can_be_raw(&text) {
        return Err(faults.report(fault.help("choose another name: the word has a meaning in Rust")));
    }
    faults.report(fault.help(format_args!("write `r#{text}`, or choose another name")));
    cursor.skip(1);
    Ok(Name::new(Ident::new_raw(&text, ident.span())))
}
