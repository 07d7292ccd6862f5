//! A function that is never called, in which every use of a name refers to a parameter at the name's declaration: an
//! editor leads from a coordinate in an expression to where it was declared. What is never used is a local variable
//! there, so that the compiler's own lint `unused_variables` says so at its place.
//!
//! Parameters that are constants and not locals, because locals that come through `macro_rules!` are told apart by where they come from,
//! and the names of the language are not; not constants, because the compiler suggests constants with similar names when a variable is
//! unused; not statics, each of which has a body to check; not variants, which are types to the compiler's messages.

use proc_macro2::TokenStream;
use quote::quote;

use crate::model::Identifiers;

pub(super) fn items(identifiers: &Identifiers) -> TokenStream {
    let Identifiers { declared, used, unused } = identifiers;
    let unused = (!unused.is_empty()).then(|| {
        quote! {
            // A module of its own: in a pattern a constant of the system's module, or `None`, would be meant.
            #[no_implicit_prelude]
            mod __guen_unused {
                #[allow(dead_code, reason = "for the compiler's lint: it is never called")]
                fn nothing_is_ignored_in_silence() {
                    #(let #unused = ();)*
                }
            }
        }
    });
    quote! {
        __guen::uses!(#(#declared)*; #(#used)*);
        #unused
    }
}
