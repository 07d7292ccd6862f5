//! Documentation of what is generated: rustdoc, and the same as constants of text and LaTeX.

use std::fmt::Write;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::layouts::text::tokens;
use crate::report::{ReportLines, SectionLines};
use crate::syntax::Docs;

/// The user's documentation of an entry, or a sentence in its place; with its unit, if it has one.
pub(super) fn entry(docs: &Docs, fallback: &str, unit: Option<&String>) -> TokenStream {
    let unit = unit.map(|unit| {
        let unit = format!("In {unit}.");
        quote!(#[doc = ""] #[doc = #unit])
    });
    if docs.values.is_empty() {
        quote!(#[doc = #fallback] #unit)
    } else {
        let values = &docs.values;
        quote!(#(#[doc = #values])* #unit)
    }
}

/// The struct with its documentation, the user's words and then everything that was derived, and `REPORT` and `LATEX`.
pub(super) fn reported(report: &ReportLines, docs: &Docs, is_whole: bool, item: &TokenStream) -> TokenStream {
    let values = &docs.values;
    let blank = (!values.is_empty()).then(|| quote!(#[doc = ""]));
    let ReportLines { name, summary, sections } = report;
    let (mut all, mut formulas) = (String::new(), String::new());
    for (i, SectionLines { title, text, latex }) in sections.iter().enumerate() {
        let _ = write!(all, "{title:?}{}{}", list(text), list(latex));
        if !latex.is_empty() {
            let _ = write!(formulas, "{i} ");
        }
    }
    // Editors show the documentation as text, and it would be stored in the compiled crate; rustdoc sets formulas. Those of
    // the system itself: of five scenes they would say little that is new.
    let kind = tokens(if is_whole { "page" } else { "text" });
    let report = tokens(&format!("{name:?} {summary:?} {{ {all} }} [{formulas}]"));
    quote!(__guen::reported! { #kind [#(#[doc = #values])* #blank] #report #item })
}

/// Lines as literals in brackets.
fn list(lines: &[String]) -> String {
    let lines: Vec<String> = lines.iter().map(|line| format!("{line:?}")).collect();
    format!("[{}]", lines.join(" "))
}

/// The documentation of the module.
pub(super) fn module(report: &ReportLines, system: &Ident, is_whole: bool) -> TokenStream {
    let what = if is_whole {
        format!("What belongs to the system [`{system}`]: its state, operators, brackets and classification.")
    } else {
        format!("What belongs to the scene [`{system}`]: its state, and what it provides.")
    };
    let text = format!("{what}\n\n{}", report.summary);
    quote!(#[doc = #text])
}
