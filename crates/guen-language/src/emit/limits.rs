//! The limits of inputs, where the declaration has some.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::constants::default_text;
use super::{Layout, Subject, tokens};
use crate::model::SymbolEntry;

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let inputs = subject.level.selection.inputs.iter().map(|input| &subject.model.inputs[*input]);
    let inputs: Vec<&SymbolEntry<'_>> = inputs.collect();
    if inputs.iter().all(|input| input.limits.is_none()) {
        return TokenStream::new();
    }
    let end = |which: usize, otherwise: &str| -> Vec<TokenStream> {
        let unlimited = format_ident!("{otherwise}");
        inputs
            .iter()
            .map(|input| match input.limits {
                Some(limits) => tokens(&default_text(subject, limits[which])),
                None => quote!(<R as __guen::Real>::from_f64(::core::primitive::f64::#unlimited)),
            })
            .collect()
    };
    let (lower, upper) = (end(0, "NEG_INFINITY"), end(1, "INFINITY"));
    let names: Vec<&Ident> = inputs.iter().map(|input| &input.name.ident).collect();
    let locals: Vec<Ident> = (0..layout.constants).map(|i| format_ident!("__guen_c{i}")).collect();
    quote! {
        impl<R: __guen::Real> Prepared<R> {
            /// The limits of the inputs as declared, the lower and the upper ones; infinite where there are none. They
            /// do not enter the equations: whoever drives the system holds its inputs inside, as
            /// [`clamped`](Self::clamped) does.
            pub fn limits(&self) -> (Inputs<R>, Inputs<R>) {
                #[allow(unused_variables, reason = "limits need not use every constant")]
                let [#(#locals),*] = self.constants;
                (Inputs { #(#names: #lower),* }, Inputs { #(#names: #upper),* })
            }
        }

        impl<R: __guen::Ordered> Prepared<R> {
            /// The inputs inside of their [`limits`](Self::limits), each one by itself. What is not a number stays so:
            /// it is no command, and the steppers refuse it.
            pub fn clamped(&self, inputs: &Inputs<R>) -> Inputs<R> {
                let (lower, upper) = self.limits();
                Inputs { #(#names: __guen::clamped(inputs.#names, lower.#names, upper.#names)),* }
            }
        }
    }
}
