//! Text and numbers as tokens.

use guen_symbolic::OperationCount;
use proc_macro2::TokenStream;
use quote::quote;

/// Text of Rust as tokens; what is written here is ours, so that a failure is a bug of ours.
///
/// In a compiler it is read by the compiler's lexer alone, which is optimised. `proc_macro2` would read it twice there,
/// first with its own lexer to see whether it is Rust: a sixth of the hoop's expansion.
pub(in crate::emit) fn tokens(text: &str) -> TokenStream {
    let read = if proc_macro::is_available() {
        text.parse().ok().map(|tokens: proc_macro::TokenStream| tokens.into())
    } else {
        text.parse().ok()
    };
    read.unwrap_or_else(|| {
        let message = "guen emitted text that is not Rust: this is a bug of guen";
        quote!(::core::compile_error!(#message))
    })
}

/// The operations of a program as the constant that states them.
pub(in crate::emit) fn cost(count: &OperationCount) -> TokenStream {
    let counts = counts(count);
    quote!(__guen::Cost::of([#(#counts),*]))
}

/// The counts of a program in the order in which the runtime has them.
pub(in crate::emit) fn counts(count: &OperationCount) -> [u32; 6] {
    let OperationCount { additions, negations, multiplications, divisions, roots, sines, calls } = *count;
    // The runtime counts every elementary function as a call.
    [additions, negations, multiplications, divisions, roots, sines + calls]
}
