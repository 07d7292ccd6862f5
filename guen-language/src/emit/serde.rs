//! Constants, states and inputs as serde sees them, where the facade's feature is on.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::layout::{Layout, variable_ident};
use crate::derive::Subject;

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level } = subject;
    let selection = &level.selection;
    let given = selection.constants.iter().map(|c| model.constants[*c].name.ident.clone());
    let held = selection.held.iter().map(|held| variable_ident(model, held.place));
    let constants: Vec<Ident> = given.chain(held).collect();
    let marker = constants.is_empty().then(|| quote!(real: ::core::marker::PhantomData,));
    let constants = of_constants(layout, &constants, marker.as_ref());
    let has_coordinates = layout.n > 0 && (layout.is_whole || !selection.holonomic.is_empty());
    let coordinates = has_coordinates.then(|| record("Coordinates", layout.n));
    let inputs = (layout.inputs > 0).then(|| record("Inputs", layout.inputs));
    let state = state(layout);
    quote!(#constants #state #coordinates #inputs)
}

/// The state alone.
pub(super) fn state(layout: &Layout) -> TokenStream {
    record("State", layout.size)
}

/// A record, which knows its names and converts from and to an array.
fn record(name: &str, count: usize) -> TokenStream {
    let record = format_ident!("{name}");
    quote!(__guen::serde_record!(#record, #name, #count);)
}

fn of_constants(layout: &Layout, fields: &[Ident], marker: Option<&TokenStream>) -> TokenStream {
    let name = &layout.system;
    let (text, count) = (layout.declared.to_string(), fields.len());
    let names = fields.iter().map(|field| field.to_string().trim_start_matches("r#").to_owned());
    let locals: Vec<Ident> = (0..count).map(|i| format_ident!("__guen_{i}")).collect();
    if !layout.derived.is_empty() {
        let is_derived: Vec<bool> = (0..count).map(|i| layout.derived.contains(&i)).collect();
        let given = fields.iter().zip(&is_derived).map(|(field, is_derived)| match is_derived {
            true => quote!(__guen::Derived::value(record.#field)),
            false => quote!(::core::option::Option::Some(record.#field)),
        });
        let read = locals.iter().zip(&is_derived).map(|(local, is_derived)| match is_derived {
            true => {
                quote!(::core::option::Option::map_or(#local, __guen::Derived::Follows, __guen::Derived::Set))
            }
            false => quote!(#local?),
        });
        return quote! {
            __guen::serde_record!(
                #name, #text, #count, [#(#names),*], derived [#(#is_derived),*],
                |record| [#(#given),*],
                |[#(#locals),*]| ::core::option::Option::Some(#name { #(#fields: #read,)* })
            );
        };
    }
    quote! {
        __guen::serde_record!(
            #name, #text, #count, [#(#names),*],
            |record| [#(record.#fields),*],
            |[#(#locals),*]| #name { #(#fields: #locals,)* #marker }
        );
    }
}
