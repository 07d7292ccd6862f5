//! Documentation of what is generated: rustdoc, and the same as constants of text and LaTeX.

use std::fmt::Write;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::text::tokens;

use crate::report::{Report, Section};
use crate::syntax::Docs;

/// The user's documentation of an entry, or a sentence in its place.
pub(super) fn entry(docs: &Docs, fallback: &str) -> TokenStream {
    if docs.values.is_empty() {
        quote!(#[doc = #fallback])
    } else {
        let values = &docs.values;
        quote!(#(#[doc = #values])*)
    }
}

/// The documentation of the struct: the user's words, then everything that was derived.
pub(super) fn system(report: &Report, docs: &Docs, is_whole: bool) -> TokenStream {
    let values = &docs.values;
    let blank = (!values.is_empty()).then(|| quote!(#[doc = ""]));
    let blocks = report.to_blocks();
    // Editors show the documentation as text, and it would be stored in the compiled crate; rustdoc sets formulas. Those of
    // the system itself: with five scenes they would be a tenth of the expansion, and say little that is new.
    let text = if is_whole {
        let page = report.to_page();
        format!("#[cfg_attr(not(doc), doc = {blocks:?})] #[cfg_attr(doc, doc = __guen::page!({page:?}))]")
    } else {
        format!("#[doc = {blocks:?}]")
    };
    let text = tokens(&text);
    quote! {
        #(#[doc = #values])*
        #blank
        #text
    }
}

/// The documentation of the module.
pub(super) fn module(report: &Report, system: &Ident, is_whole: bool) -> TokenStream {
    let what = if is_whole {
        format!("What belongs to the system [`{system}`]: its state, operators, brackets and classification.")
    } else {
        format!("What belongs to the scene [`{system}`]: its state, and what it provides.")
    };
    let text = format!("{what}\n\n{}", report.summary);
    quote!(#[doc = #text])
}

/// `REPORT` and `LATEX`.
pub(super) fn constants(report: &Report) -> TokenStream {
    let Report { name, summary, sections } = report;
    let (mut all, mut formulas) = (String::new(), String::new());
    for (i, Section { title, text, latex }) in sections.iter().enumerate() {
        let _ = write!(
            all,
            "__guen::ReportSection {{ title: {title:?}, lines: &{text:?}, formulas: &{latex:?} }},"
        );
        // The formulas are written once.
        if !latex.is_empty() {
            let _ = write!(formulas, "REPORT.sections[{i}].of_formulas(),");
        }
    }
    tokens(&format!(
        "/// What was derived, as text: forms, operators, brackets, classification, equations of motion.
        pub const REPORT: __guen::Report = __guen::Report {{ name: {name:?}, summary: {summary:?}, sections: &[{all}] }};
        /// The formulas of [`REPORT`] as LaTeX.
        pub const LATEX: __guen::Report = __guen::Report {{ name: {name:?}, summary: {summary:?}, sections: &[{formulas}] }};"
    ))
}
