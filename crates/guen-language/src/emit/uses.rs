//! A function that is never called, in which every use of a name refers to a constant at the name's declaration: an
//! editor leads from a coordinate in an expression to where it was declared.
//!
//! Constants and not locals, because locals that come through `macro_rules!` are told apart by where they come from,
//! and the names of the language are not.

use proc_macro2::TokenStream;
use quote::quote;

use crate::model::Model;

pub(super) fn items(model: &Model<'_>) -> TokenStream {
    let (declared, used) = (&model.declared, &model.used);
    let count = used.len();
    quote! {
        #[allow(dead_code, reason = "for editors: it is never called")]
        const _: () = {
            fn uses_lead_to_declarations() {
                #(const #declared: () = ();)*
                let _: [(); #count] = [#(#used),*];
            }
        };
    }
}
