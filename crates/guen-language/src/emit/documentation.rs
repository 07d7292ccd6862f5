//! Documentation of what is generated: rustdoc, and the same as constants of text and LaTeX.

use proc_macro2::{Ident, Literal, TokenStream};
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

/// A long text as a literal without escapes: to escape letter by letter would be a tenth of the expansion.
fn literal(text: &str) -> Literal {
    // One mark more than the most that follow a quotation mark.
    let (mut marks, mut run, mut is_plain) = (0, None, true);
    for &byte in text.as_bytes() {
        run = match (byte, run) {
            (b'"', _) => Some(1),
            (b'#', Some(length)) => Some(length + 1),
            _ => None,
        };
        if let Some(length) = run {
            marks = usize::max(marks, length);
        }
        // A raw text has none of these alone, and line ends of two letters become one.
        is_plain &= byte != b'\r';
    }
    let marks = "#".repeat(marks);
    let raw = is_plain.then(|| [r"r", &marks, "\"", text, "\"", &marks].concat().parse().ok());
    raw.flatten().unwrap_or_else(|| Literal::string(text))
}

/// The documentation of the struct: the user's words, then everything that was derived.
pub(super) fn system(report: &Report, docs: &Docs, is_whole: bool) -> TokenStream {
    let values = &docs.values;
    let blank = (!values.is_empty()).then(|| quote!(#[doc = ""]));
    let blocks = report.to_blocks();
    // Editors show the documentation as text, and it would be stored in the compiled crate; rustdoc sets formulas. Those of
    // the system itself: with five scenes they would be a tenth of the expansion, and say little that is new.
    let text = if is_whole {
        let (blocks, page) = (literal(&blocks), literal(&report.to_page()));
        quote!(#[cfg_attr(not(doc), doc = #blocks)] #[cfg_attr(doc, doc = #page)])
    } else {
        let blocks = literal(&blocks);
        quote!(#[doc = #blocks])
    };
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
    let (name, summary) = (&report.name, &report.summary);
    let all = |lines: &[String]| -> Vec<Literal> { lines.iter().map(|line| literal(line)).collect() };
    let text = report.sections.iter().map(|Section { title, text, latex }| {
        let (text, latex) = (all(text), all(latex));
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

#[cfg(test)]
mod tests {
    use quote::ToTokens;

    use super::*;

    #[test]
    fn literals_are_the_text_whatever_is_in_it() {
        for text in [
            "",
            "a",
            r"\frac{1}{2}",
            "\"",
            "say \"#\" and \"##\"",
            "#\"#",
            "ends with \"",
            "η̇\n≠",
            "a\rb",
            "a\r\nb",
        ] {
            let written: syn::LitStr = syn::parse2(literal(text).into_token_stream()).unwrap();
            assert_eq!(written.value(), text);
        }
        assert_eq!(literal("say \"#\"").to_string(), "r##\"say \"#\"\"##");
    }
}
