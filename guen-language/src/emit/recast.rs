//! Prepares a system over `f64` anew over every other real.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::layout::Layout;

/// The trait `Recast` for the constants and the prepared system, or for the system with held inputs. `names` are the
/// constants, `marker` the value of the field that a struct without constants has.
pub(super) fn items(layout: &Layout, names: &[&Ident], marker: Option<&TokenStream>) -> TokenStream {
    let (system, size) = (&layout.system, layout.size);
    let constants = |of: TokenStream| {
        let values = names.iter().enumerate().map(|(i, name)| match layout.derived.contains(&i) {
            true => quote!(__guen::Derived::map(#of.#name, R::from_f64)),
            false => quote!(R::from_f64(#of.#name)),
        });
        quote! { #system { #(#names: #values,)* #marker } }
    };
    let recast = |owner: TokenStream, made: TokenStream, before: TokenStream, value: TokenStream| {
        quote! {
            impl __guen::Recast<#size> for #owner<f64> {
                type In<R: __guen::Real> = #made<R>;

                fn recast<R: __guen::Real>(&self) -> ::core::result::Result<#made<R>, __guen::ConstantsError> {
                    #before
                    #value
                }
            }
        }
    };
    let of_constants = constants(quote!(constants));
    if layout.inputs == 0 {
        let of_self = constants(quote!(self));
        let prepared = recast(
            quote!(Prepared),
            quote!(Prepared),
            quote! {
                let constants = self.constants();
                let _ = &constants;
            },
            quote!(#of_constants.prepare()),
        );
        let plain = recast(quote!(#system), quote!(Prepared), quote!(), quote!(#of_self.prepare()));
        return quote!(#plain #prepared);
    }
    let inputs = layout.inputs;
    recast(
        quote!(Driven),
        quote!(Driven),
        quote! {
            let constants = self.system.constants();
            let _ = &constants;
            let inputs: [f64; #inputs] = ::core::convert::From::from(self.inputs);
            let system = #of_constants.prepare()?;
        },
        quote! {
            ::core::result::Result::Ok(Driven {
                system,
                inputs: ::core::convert::From::from(inputs.map(R::from_f64)),
            })
        },
    )
}
