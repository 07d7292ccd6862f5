//! The limits of inputs, where the declaration has some.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::derive::Subject;
use crate::emit::layouts::fields::Fields;
use crate::emit::layouts::layout::Layout;
use crate::emit::layouts::text::tokens;
use crate::emit::programs::formula::default_text;
use crate::model::SymbolEntry;

/// The inputs of the level.
fn given<'d>(subject: &Subject<'d, '_>) -> Vec<&'d SymbolEntry<'d>> {
    subject.level.selection.inputs.iter().map(|input| &subject.model.inputs[*input]).collect()
}

/// Whether an input of the level has limits.
pub(super) fn has_any(subject: &Subject<'_, '_>) -> bool {
    given(subject).iter().any(|input| input.limits.is_some())
}

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let inputs = given(subject);
    if !has_any(subject) {
        return TokenStream::new();
    }
    let end = |which: usize, otherwise: &str| -> Vec<TokenStream> {
        let unlimited = format_ident!("{otherwise}");
        inputs
            .iter()
            .map(|input| match input.limits {
                Some(limits) => tokens(&default_text(subject, limits[which])),
                None => quote!(R::from_f64(::core::primitive::f64::#unlimited)),
            })
            .collect()
    };
    let (lower, upper) = (end(0, "NEG_INFINITY"), end(1, "INFINITY"));
    let structure = Fields::new(inputs.iter().map(|input| input.name)).of_record("Inputs");
    let locals: Vec<Ident> = (0..layout.constants).map(|i| format_ident!("__guen_c{i}")).collect();
    let is_limited = |place: &usize| inputs[*place].limits.is_some();
    let places: Vec<usize> = (0..inputs.len()).filter(is_limited).collect();
    let limited: Vec<&TokenStream> = places.iter().map(|place| structure.access(*place)).collect();
    let texts = places.iter().map(|place| &structure.names()[*place]);
    let names = structure.accesses().iter();
    let clamped: Vec<TokenStream> =
        names.map(|name| quote!(__guen::clamped(inputs.#name, lower.#name, upper.#name))).collect();
    let (lower, upper, clamped) =
        (structure.literal(&lower), structure.literal(&upper), structure.literal(&clamped));
    quote! {
        impl<R: __guen::Real> Prepared<R> {
            fn check_limits(&self) -> ::core::result::Result<(), __guen::ConstantsError> {
                let (lower, upper) = self.limits();
                #(__guen::check_limits(lower.#limited, upper.#limited, #texts)?;)*
                ::core::result::Result::Ok(())
            }

            /// The limits of the inputs as declared, the lower and the upper ones; infinite where there are none. They
            /// do not enter the equations: whoever drives the system holds its inputs inside, as
            /// [`clamped`](Self::clamped) does.
            pub fn limits(&self) -> (Inputs<R>, Inputs<R>) {
                #[allow(unused_variables, reason = "limits need not use every constant")]
                let [#(#locals),*] = self.constants;
                (Inputs { #lower }, Inputs { #upper })
            }
        }

        impl<R: __guen::Ordered> Prepared<R> {
            /// The inputs inside of their [`limits`](Self::limits), each one by itself. What is not a number stays so:
            /// it is no command, and the steppers refuse it.
            pub fn clamped(&self, inputs: &Inputs<R>) -> Inputs<R> {
                let (lower, upper) = self.limits();
                Inputs { #clamped }
            }
        }
    }
}
