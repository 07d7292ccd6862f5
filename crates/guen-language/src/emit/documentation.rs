//! Documentation of what is generated: rustdoc, and the same as constants of text and LaTeX.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use crate::report::Report;
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
    let mut text = format!("{}\n", report.summary);
    for section in &report.sections {
        text.push_str(&format!("\n# {}\n\n```text\n{}\n```\n", section.title, section.text.join("\n")));
    }
    quote! {
        #(#[doc = #values])*
        #blank
        #[doc = #text]
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
    let sections = |latex: bool| {
        let sections = report.sections.iter().filter(|s| !latex || !s.latex.is_empty()).map(|section| {
            let title = section.title;
            let lines = if latex { &section.latex } else { &section.text };
            quote!(__guen::ReportSection { title: #title, lines: &[#(#lines),*] })
        });
        quote!(&[#(#sections),*])
    };
    let (text, latex) = (sections(false), sections(true));
    quote! {
        /// What was derived, as text: forms, operators, brackets, classification, equations of motion.
        pub const REPORT: __guen::Report = __guen::Report { name: #name, summary: #summary, sections: #text };
        /// The formulas of [`REPORT`] as LaTeX.
        pub const LATEX: __guen::Report = __guen::Report { name: #name, summary: #summary, sections: #latex };
    }
}
