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

/// Expands a system to which the components that it uses have been added; no part of the public interface.
#[doc(hidden)]
#[proc_macro]
pub fn mechanical_system_with(tokens: TokenStream) -> TokenStream {
    guen_language::expand_with(tokens.into()).into()
}

/// Expands the declaration of a component; documented in the facade.
#[proc_macro]
pub fn mechanical_component(tokens: TokenStream) -> TokenStream {
    guen_language::expand_component(tokens.into()).into()
}

/// Expands a component to which those that it uses have been added; no part of the public interface.
#[doc(hidden)]
#[proc_macro]
pub fn mechanical_component_with(tokens: TokenStream) -> TokenStream {
    guen_language::expand_component_with(tokens.into()).into()
}

/// Sets the formulas in the documentation of an expansion; no part of the public interface.
#[doc(hidden)]
#[proc_macro]
pub fn page(tokens: TokenStream) -> TokenStream {
    guen_language::expand_page(tokens.into()).into()
}
