//! What is emitted beside the errors of a faulty declaration: the public items with their signatures.
//!
//! The rest of the user's crate then reports its own mistakes only, and completion keeps working. Bodies are
//! never reached, since the crate does not compile.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::{facade, module_name};
use crate::syntax::{Declaration, Item, Plain};

/// The items of a declaration by its names alone.
pub fn outline(declaration: &Declaration) -> TokenStream {
    let facade = facade(declaration);
    let system = &declaration.name.ident;
    let module = module_name(system);
    let visibility = declaration.visibility.outside();
    let mut names = Outline::default();
    for item in &declaration.items {
        match item {
            Item::Constants(section) => {
                for constant in &section.entries {
                    push(&mut names.constants, &constant.name.ident);
                    if constant.default.is_none() {
                        push(&mut names.required, &constant.name.ident);
                    }
                }
            }
            Item::Coordinates(section) => plain(&mut names.coordinates, &section.entries),
            Item::Inputs(section) => plain(&mut names.inputs, &section.entries),
            Item::Parameters(section) => {
                section.entries.iter().for_each(|e| push(&mut names.parameters, &e.name.ident));
            }
            Item::Constraints(section) | Item::Holonomic(section) => {
                section.entries.iter().for_each(|e| push(&mut names.constraints, &e.name.ident));
            }
            Item::Outputs(section) => {
                section.entries.iter().for_each(|e| push(&mut names.outputs, &e.name.ident))
            }
            _ => {}
        }
    }
    let Outline { constants, required, coordinates, parameters, constraints, inputs, outputs } = names;
    let state: Vec<&Ident> = coordinates.iter().chain(&parameters).copied().collect();
    let momenta: Vec<&Ident> = parameters.iter().chain(&constraints).copied().collect();
    let driven = (!inputs.is_empty()).then(|| quote!(, _inputs: &Inputs<R>));
    let input_struct = (!inputs.is_empty()).then(|| record("Inputs", &inputs));
    let output_struct = (!outputs.is_empty()).then(|| record("Outputs", &outputs));
    let output_method = (!outputs.is_empty()).then(|| {
        quote! {
            /// The declared outputs.
            pub fn outputs(&self, _t: R, _state: &State<R> #driven) -> Outputs<R> { ::core::unreachable!() }
        }
    });
    let bound_method = (!constraints.is_empty()).then(|| {
        quote! {
            /// The residuals.
            pub fn residuals(&self, _t: R, _state: &State<R>) -> Residuals<R> { ::core::unreachable!() }
            /// The reactions.
            pub fn reactions(&self, _t: R, _state: &State<R> #driven) -> Reactions<R> { ::core::unreachable!() }
        }
    });
    let bound_structs = (!constraints.is_empty()).then(|| {
        let (residuals, reactions) = (record("Residuals", &constraints), record("Reactions", &constraints));
        quote!(#residuals #reactions)
    });
    let (state_struct, coordinate_struct, momenta_struct) =
        (record("State", &state), record("Coordinates", &coordinates), record("Momenta", &momenta));
    let size = state.len();
    quote! {
        /// The module of a system whose declaration has faults.
        #[allow(non_snake_case, non_camel_case_types, dead_code, reason = "stands in for a faulty declaration")]
        #visibility mod #module {
            #[allow(unused_imports, reason = "stands in for a faulty declaration")]
            use #facade::__private as __guen;
            /// The constants.
            #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
            pub struct #system<R = f64> {
                #(#[doc = ""] pub #constants: R,)*
                #[doc(hidden)]
                pub __guen_real: ::core::marker::PhantomData<R>,
            }
            impl<R: __guen::Real> #system<R> {
                /// The constants.
                #[allow(clippy::too_many_arguments, reason = "stands in for a faulty declaration")]
                pub fn new(#(#required: R),*) -> Self { ::core::unreachable!() }
                /// The prepared system.
                pub fn prepare(self) -> ::core::result::Result<Prepared<R>, __guen::ConstantsError> {
                    ::core::unreachable!()
                }
            }
            /// The prepared system.
            #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
            pub struct Prepared<R = f64>(::core::marker::PhantomData<R>);
            #state_struct #coordinate_struct #momenta_struct #input_struct #output_struct #bound_structs
            impl<R: __guen::Real> Prepared<R> {
                /// The rates.
                pub fn rhs(&self, _t: R, _state: &State<R> #driven) -> State<R> { ::core::unreachable!() }
                /// The velocities.
                pub fn velocities(&self, _t: R, _state: &State<R>) -> Coordinates<R> { ::core::unreachable!() }
                /// The energy integral.
                pub fn energy(&self, _t: R, _state: &State<R>) -> R { ::core::unreachable!() }
                /// The momenta.
                pub fn momenta(&self, _t: R, _state: &State<R>) -> Momenta<R> { ::core::unreachable!() }
                #output_method
                #bound_method
            }
            impl<R: __guen::Real> __guen::System<R, #size> for Prepared<R> {
                fn rhs(&self, _t: R, _state: &[R; #size]) -> [R; #size] { ::core::unreachable!() }
            }
        }
        #[allow(unused_imports, reason = "stands in for a faulty declaration")]
        #visibility use #module::#system;
    }
}

#[derive(Default)]
struct Outline<'a> {
    constants: Vec<&'a Ident>,
    required: Vec<&'a Ident>,
    coordinates: Vec<&'a Ident>,
    parameters: Vec<&'a Ident>,
    constraints: Vec<&'a Ident>,
    inputs: Vec<&'a Ident>,
    outputs: Vec<&'a Ident>,
}

/// A name once: a second one was reported as a fault already.
fn push<'a>(names: &mut Vec<&'a Ident>, name: &'a Ident) {
    if !names.contains(&name) {
        names.push(name);
    }
}

fn plain<'a>(names: &mut Vec<&'a Ident>, entries: &'a [Plain]) {
    entries.iter().for_each(|entry| push(names, &entry.name.ident));
}

fn record(name: &str, fields: &[&Ident]) -> TokenStream {
    let name = Ident::new(name, proc_macro2::Span::call_site());
    let count = fields.len();
    quote! {
        /// Stands in for a faulty declaration.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default
        )]
        pub struct #name<R = f64> {
            #(#[doc = ""] pub #fields: R,)*
        }
        impl<R> ::core::convert::From<[R; #count]> for #name<R> {
            fn from(_: [R; #count]) -> Self { ::core::unreachable!() }
        }
        impl<R> ::core::convert::From<#name<R>> for [R; #count] {
            fn from(_: #name<R>) -> Self { ::core::unreachable!() }
        }
    }
}
