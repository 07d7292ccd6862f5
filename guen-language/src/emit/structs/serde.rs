//! Constants, states and inputs as serde sees them, where the facade's feature is on.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use crate::derive::Subject;
use crate::emit::layouts::fields::{Entry, Fields, plain};
use crate::emit::layouts::layout::{Layout, variable_name};
use crate::syntax::Name;

pub(in crate::emit) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level, .. } = subject;
    let selection = &level.selection;
    let given = selection.constants.iter().map(|c| model.constants[*c].name.clone());
    let held = selection.held.iter().map(|held| variable_name(model, held.place));
    let constants = Fields::new(&given.chain(held).collect::<Vec<Name>>()).of_record("Constants");
    let marker = (constants.len() == 0).then(|| quote!(real: ::core::marker::PhantomData,));
    // With functions it is a struct of other types, which need not be written to files.
    let constants = layout.supplied.is_empty().then(|| of_constants(layout, &constants, marker.as_ref()));
    let has_coordinates = layout.n > 0 && (layout.is_whole || !selection.holonomic.is_empty());
    let coordinates = has_coordinates.then(|| {
        let coordinates = selection.coordinates.iter().map(|i| model.coordinates[*i].name);
        record("Coordinates", &Fields::new(coordinates).of_record("Coordinates"))
    });
    let inputs = (layout.inputs > 0).then(|| {
        let inputs = selection.inputs.iter().map(|u| model.inputs[*u].name);
        record("Inputs", &Fields::new(inputs).of_record("Inputs"))
    });
    let state = state(layout);
    quote!(#constants #state #coordinates #inputs)
}

/// The state alone.
pub(in crate::emit) fn state(layout: &Layout) -> TokenStream {
    record("State", &layout.state)
}

/// A record, which knows its names and converts from and to an array.
fn record(name: &str, structure: &Fields) -> TokenStream {
    let record = format_ident!("{name}");
    let count = structure.len();
    if !structure.is_plain() {
        let is_derived = vec![false; count];
        return structured(&record, name, structure, &is_derived, None);
    }
    quote!(__guen::serde_record!(#record, #name, #count);)
}

/// A struct with arrays, whose values stand in them in the order of the fields.
fn structured(
    record: &Ident,
    text: &str,
    structure: &Fields,
    is_derived: &[bool],
    marker: Option<&TokenStream>,
) -> TokenStream {
    let count = structure.len();
    let names = structure.idents().map(plain);
    let (shape, order) = (structure.shape(), structure.order());
    let is_apart = |place: usize| is_derived[place];
    let given =
        structure.list_of_fields(&is_apart, &|Entry { place, access, .. }| match is_derived[*place] {
            true => quote!(__guen::Derived::value(record.#access)),
            false => quote!(::core::option::Option::Some(record.#access)),
        });
    let mut read = vec![TokenStream::new(); count];
    for (k, place) in order.iter().enumerate() {
        read[*place] = match is_derived[*place] {
            true => {
                quote!(::core::option::Option::map_or(values[#k], __guen::Derived::Follows, __guen::Derived::Set))
            }
            false => quote!(values[#k]?),
        };
    }
    let mut position = vec![0_usize; count];
    order.iter().enumerate().for_each(|(k, place)| position[*place] = k);
    let fields = structure.trees().map(|(ident, tree)| {
        let value = match tree.long_run(&is_apart) {
            Some(run) => {
                let from = position[run.start];
                let to = from + run.len();
                quote!(__guen::entries(&values[#from..#to])?)
            }
            None => tree.literal(&|place| read[place].clone()),
        };
        quote!(#ident: #value,)
    });
    let literal: TokenStream = fields.collect();
    let is_derived = match is_derived.contains(&true) {
        true => {
            let is_derived = order.iter().map(|place| is_derived[*place]);
            quote!([#(#is_derived),*])
        }
        false => quote!([false; #count]),
    };
    quote! {
        __guen::serde_structured!(
            #record, #text, #count, [#(#names),*], #shape, #is_derived,
            |record| #given,
            |values| ::core::option::Option::Some(#record { #literal #marker })
        );
    }
}

fn of_constants(layout: &Layout, structure: &Fields, marker: Option<&TokenStream>) -> TokenStream {
    let name = &layout.system;
    let (text, count) = (layout.declared.to_string(), structure.len());
    if !structure.is_flat() {
        let is_derived: Vec<bool> = (0..count).map(|i| layout.derived.contains(&i)).collect();
        return structured(name, &text, structure, &is_derived, marker);
    }
    let fields: Vec<&Ident> = structure.idents().collect();
    let names = fields.iter().map(|field| field.to_string().trim_start_matches("r#").to_owned());
    let locals: Vec<Ident> = (0..count).map(|i| format_ident!("__guen_{i}")).collect();
    if !layout.derived.is_empty() {
        // An entry that a scene leaves of an array has its field behind the others.
        let places = structure.order();
        let is_derived: Vec<bool> = places.iter().map(|place| layout.derived.contains(place)).collect();
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
