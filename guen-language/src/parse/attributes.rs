//! Doc comments in front of the system, a section or an entry. Other attributes are refused.

use proc_macro2::{Delimiter, Group, TokenStream};

use super::cursor::Cursor;
use crate::diagnostics::{Fault, Faults, Reported};
use crate::syntax::Docs;

/// Reads all attributes that stand here. One that is no doc comment is reported and left out; an error if nothing
/// follows that they could belong to.
pub(crate) fn docs(cursor: &mut Cursor, faults: &mut Faults) -> Result<Docs, Reported> {
    let mut docs = Docs::default();
    let mut last = None;
    while let Some(hash) = cursor.eat('#') {
        if cursor.eat('!').is_some() {
            faults.report(
                Fault::new(hash, "inner attributes and `//!` comments have no place here")
                    .help("write `///` before what is documented"),
            );
        }
        let Some(group) = cursor.eat_group(Delimiter::Bracket) else {
            faults.report(Fault::new(hash, "expected an attribute such as a doc comment after `#`"));
            continue;
        };
        attribute(&group, &mut docs, faults);
        last = Some(hash);
    }
    if let Some(hash) = last.filter(|_| cursor.is_end()) {
        let fault = Fault::new(hash, "this doc comment documents nothing");
        return Err(faults.report(fault.help("write `//`, or remove it")));
    }
    Ok(docs)
}

/// Reads one pair of brackets.
fn attribute(group: &Group, docs: &mut Docs, faults: &mut Faults) {
    let mut inside = Cursor::inside(group);
    inside.open_invisible();
    if inside.is_word("doc") && inside.is_punct_at(1, '=') {
        inside.skip(2);
        let value: TokenStream = std::iter::from_fn(|| inside.next()).collect();
        if let Ok(text) = syn::parse2::<syn::LitStr>(value.clone()) {
            docs.lines.push(text.value());
        }
        if value.is_empty() {
            faults.report(Fault::new(group.span_close(), "expected the text of the documentation"));
        } else {
            docs.values.push(value);
        }
        return;
    }
    let span = inside.span();
    let text = match inside.ident_at(0) {
        Some(word) => format!("attribute `{word}` has no meaning here"),
        None => "expected a doc comment".to_owned(),
    };
    faults.report(Fault::new(span, text).help(
        "only doc comments may stand inside of the macro; put other attributes on a module around the invocation",
    ));
}
