//! Prepares a system over `f64` anew over every other real.

use proc_macro2::TokenStream;
use quote::quote;

use super::fields::Fields;
use super::layout::Layout;

/// The trait `WithScalar` for the constants and the prepared system, or for the system with held inputs. `structure` has the
/// constants, `marker` the value of the field that a struct without constants has.
pub(super) fn items(layout: &Layout, structure: &Fields, marker: Option<&TokenStream>) -> TokenStream {
    let (system, size) = (&layout.system, layout.size);
    let values =
        structure.accesses()[..structure.constants()].iter().enumerate().map(|(i, name)| {
            match layout.derived.contains(&i) {
                true => quote!(__guen::Derived::map(constants.#name, R::from_f64)),
                false => quote!(R::from_f64(constants.#name)),
            }
        });
    let functions = layout.supplied.taken(structure, &quote!(constants));
    let values = structure.literal(&values.chain(functions).collect::<Vec<_>>());
    let inputs = match layout.inputs {
        0 => None,
        count => Some(quote!(, #count)),
    };
    quote! {
        __guen::with_scalar!(#system #size, constants: #system { #values #marker } #inputs);
    }
}
