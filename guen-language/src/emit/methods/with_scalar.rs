//! Prepares a system over `f64` anew over every other real.

use proc_macro2::TokenStream;
use quote::quote;

use crate::emit::layouts::fields::{Entry, Fields};
use crate::emit::layouts::layout::Layout;

/// The trait `WithScalar` for the constants and the prepared system, or for the system with held inputs. `structure` has the
/// constants, `marker` the value of the field that a struct without constants has.
pub(in crate::emit) fn items(
    layout: &Layout,
    structure: &Fields,
    marker: Option<&TokenStream>,
) -> TokenStream {
    let (system, size) = (&layout.system, layout.size);
    let is_derived = |place: usize| layout.derived.contains(&place);
    let value = |Entry { place, access, .. }: &Entry| match is_derived(*place) {
        true => quote!(__guen::Derived::map(constants.#access, R::from_f64)),
        false => quote!(R::from_f64(constants.#access)),
    };
    let functions = layout.supplied.taken(structure, &quote!(constants));
    let values = structure.literal_of(&is_derived, &value, functions);
    let inputs = match layout.inputs {
        0 => None,
        count => Some(quote!(, #count)),
    };
    quote! {
        __guen::with_scalar!(#system #size, constants: #system { #values #marker } #inputs);
    }
}
