//! The procedural macro of guen, a shim over `guen-language`: a proc-macro crate can export nothing else.
//!
//! Use it through the facade `guen`, whose macro `mechanical_system!` tells this one where the facade is.
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

use proc_macro::TokenStream;

/// Expands the declaration of a mechanical system; documented in the facade.
#[proc_macro]
pub fn mechanical_system(tokens: TokenStream) -> TokenStream {
    guen_language::expand(tokens.into()).into()
}

/// Sets the formulas in the documentation of an expansion; no part of the public interface.
#[doc(hidden)]
#[proc_macro]
pub fn page(tokens: TokenStream) -> TokenStream {
    guen_language::expand_page(tokens.into()).into()
}
