//! Puts several prepared systems together into one over lanes.

use proc_macro2::TokenStream;
use quote::quote;

use crate::emit::layouts::layout::Layout;

/// Returns the code that puts a prepared system together from those of the lanes.
fn gathered(layout: &Layout, path: &TokenStream, of: &TokenStream) -> TokenStream {
    let supplied = &layout.supplied;
    // A derived constant follows in the whole only if it follows in every lane; otherwise it is set, lane by lane.
    let follows = (!layout.derived.is_empty()).then(|| {
        quote! {
            follows: ::core::array::from_fn(|k| {
                ::core::iter::Iterator::all(&mut (0..<L as __guen::Lanes>::COUNT), |lane| member(lane)#of.follows[k])
            }),
        }
    });
    let mut hoisted = quote! {
        ::core::array::from_fn(|k| <L as __guen::Lanes>::from_fn(|lane| member(lane)#of.hoisted[k]))
    };
    if !supplied.is_empty() {
        let (functions, _) = supplied.in_lanes(&quote!(member(lane)#of));
        hoisted = quote!(__guen::Hoisted { values: #hoisted, functions: #functions });
    }
    quote! {
        #path {
            constants: ::core::array::from_fn(|k| <L as __guen::Lanes>::from_fn(|lane| member(lane)#of.constants[k])),
            hoisted: #hoisted,
            #follows
        }
    }
}

pub(in crate::emit) fn items(layout: &Layout) -> TokenStream {
    if layout.inputs == 0 && layout.derived.is_empty() && layout.supplied.is_empty() {
        let size = layout.size;
        return quote!(__guen::laned!(#size););
    }
    laned(layout, &gathered(layout, &quote!(Prepared), &quote!()))
}

/// Emits the lanes of a carried form, which has the system inside.
pub(in crate::emit) fn carried(layout: &Layout) -> TokenStream {
    let system = gathered(layout, &quote!(super::Prepared), &quote!(.system));
    let prepared = quote! {
        Prepared {
            system: #system,
            constants: ::core::array::from_fn(|k| <L as __guen::Lanes>::from_fn(|lane| member(lane).constants[k])),
            hoisted: ::core::array::from_fn(|k| <L as __guen::Lanes>::from_fn(|lane| member(lane).hoisted[k])),
        }
    };
    laned(layout, &prepared)
}

fn laned(layout: &Layout, prepared: &TokenStream) -> TokenStream {
    let size = layout.size;
    // In lanes every lane has its own functions.
    let (_, kinds) = layout.supplied.in_lanes(&quote!());
    if layout.inputs == 0 {
        return quote! {
            impl __guen::Laned<#size> for Prepared<f64> {
                type Over<L: __guen::Lanes> = Prepared<L #kinds>;

                fn gather<'a, L: __guen::Lanes>(
                    member: impl ::core::ops::Fn(usize) -> &'a Self,
                ) -> Prepared<L #kinds> {
                    #prepared
                }
            }
        };
    }
    let inputs = layout.inputs;
    quote! {
        impl __guen::Laned<#size> for Driven<f64> {
            type Over<L: __guen::Lanes> = Driven<L #kinds>;

            fn gather<'a, L: __guen::Lanes>(
                driven: impl ::core::ops::Fn(usize) -> &'a Self,
            ) -> Driven<L #kinds> {
                let member = |lane: usize| &driven(lane).system;
                let inputs: [L; #inputs] = ::core::array::from_fn(|k| {
                    <L as __guen::Lanes>::from_fn(|lane| {
                        let inputs: [f64; #inputs] = ::core::convert::From::from(driven(lane).inputs);
                        inputs[k]
                    })
                });
                Driven { system: #prepared, inputs: ::core::convert::From::from(inputs) }
            }
        }
    }
}
