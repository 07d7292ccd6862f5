//! Constants, states and inputs as serde sees them, where the facade's feature is on.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::{Layout, Subject, variable_ident};

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    let Subject { model, level } = subject;
    let selection = &level.selection;
    let given = selection.constants.iter().map(|c| model.constants[*c].name.ident.clone());
    let held = selection.held.iter().map(|held| variable_ident(model, held.place));
    let constants: Vec<Ident> = given.chain(held).collect();
    let inputs: Vec<Ident> = selection.inputs.iter().map(|u| model.inputs[*u].name.ident.clone()).collect();
    let marker = constants.is_empty().then(|| quote!(__guen_real: ::core::marker::PhantomData,));
    let inputs = (!inputs.is_empty()).then(|| record(&format_ident!("Inputs"), &inputs, &None));
    let constants = record(&layout.system, &constants, &marker);
    let has_coordinates = layout.n > 0 && (layout.is_whole || !selection.holonomic.is_empty());
    let coordinates =
        has_coordinates.then(|| record(&format_ident!("Coordinates"), &layout.state[..layout.n], &None));
    let state = record(&format_ident!("State"), &layout.state, &None);
    quote!(#constants #state #coordinates #inputs)
}

/// The state alone.
pub(super) fn state(layout: &Layout) -> TokenStream {
    record(&format_ident!("State"), &layout.state, &None)
}

fn record(name: &Ident, fields: &[Ident], marker: &Option<TokenStream>) -> TokenStream {
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
