//! Documentation of what is generated: rustdoc, and the same as constants of text and LaTeX.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

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
pub(super) fn system(report: &Report, docs: &Docs) -> TokenStream {
    let values = &docs.values;
    let blank = (!values.is_empty()).then(|| quote!(#[doc = ""]));
    let (blocks, page) = (report.to_blocks(), report.to_page());
    // Editors show the documentation as text, and it would be stored in the compiled crate; rustdoc sets formulas.
    quote! {
        #(#[doc = #values])*
        #blank
        #[cfg_attr(not(doc), doc = #blocks)]
        #[cfg_attr(doc, doc = #page)]
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
    let (name, summary) = (&report.name, &report.summary);
    let text = report.sections.iter().map(|Section { title, text, latex }| {
        quote!(__guen::ReportSection { title: #title, lines: &[#(#text),*], formulas: &[#(#latex),*] })
    });
    // The formulas are written once.
    let latex = report.sections.iter().enumerate().filter(|(_, section)| !section.latex.is_empty());
    let latex = latex.map(|(i, _)| quote!(REPORT.sections[#i].of_formulas()));
    let (text, latex) = (quote!(&[#(#text),*]), quote!(&[#(#latex),*]));
    quote! {
        /// What was derived, as text: forms, operators, brackets, classification, equations of motion.
        pub const REPORT: __guen::Report = __guen::Report { name: #name, summary: #summary, sections: #text };
        /// The formulas of [`REPORT`] as LaTeX.
        pub const LATEX: __guen::Report = __guen::Report { name: #name, summary: #summary, sections: #latex };
    }
}
