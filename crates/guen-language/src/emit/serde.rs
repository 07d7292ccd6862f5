//! Constants, states and inputs as serde sees them, where the facade's feature is on.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Layout;
use crate::derive::Derived;

pub(super) fn items(derived: &Derived<'_>, layout: &Layout) -> TokenStream {
    let model = &derived.model;
    let constants: Vec<&Ident> = model.constants.iter().map(|c| &c.name.ident).collect();
    let coordinates: Vec<&Ident> = layout.state[..layout.n].iter().collect();
    let state: Vec<&Ident> = layout.state.iter().collect();
    let inputs: Vec<&Ident> = model.inputs.iter().map(|input| &input.name.ident).collect();
    let marker = constants.is_empty().then(|| quote!(__guen_real: ::core::marker::PhantomData,));
    let inputs = (!inputs.is_empty()).then(|| record(&format_ident!("Inputs"), &inputs, &None));
    let constants = record(&layout.system, &constants, &marker);
    let coordinates = record(&format_ident!("Coordinates"), &coordinates, &None);
    let state = record(&format_ident!("State"), &state, &None);
    quote!(#constants #state #coordinates #inputs)
}

fn record(name: &Ident, fields: &[&Ident], marker: &Option<TokenStream>) -> TokenStream {
    let text = name.to_string();
    let count = proc_macro2::Literal::usize_unsuffixed(fields.len());
    let names = fields.iter().map(|field| field.to_string().trim_start_matches("r#").to_owned());
    let locals: Vec<Ident> = (0..fields.len()).map(|i| format_ident!("__guen_{i}")).collect();
    quote! {
        __guen::serde_record!(
            #name, #text, #count, [#(#names),*],
            |record| [#(record.#fields),*],
            |[#(#locals),*]| #name { #(#fields: #locals,)* #marker }
        );
    }
}
