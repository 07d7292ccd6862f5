//! The outline of scenes. Which variables a scene keeps is not known where the declaration has faults: its state has all
//! of them here, and its module everything that a scene may provide.

use std::collections::BTreeSet;

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::{Names, carried, constants, levels, operators, prepared, push, records};
use crate::model::is_carried_form;
use crate::names::module_name;
use crate::syntax::{Declaration, Item, Scene};

pub(super) fn items(declaration: &Declaration, names: &Names) -> TokenStream {
    let system = &declaration.name.ident;
    // What would be a second item of a name is left out: that is among the faults.
    let mut taken = BTreeSet::from([declaration.name.text.clone(), "program".to_owned()]);
    let mut items = TokenStream::new();
    for item in &declaration.items {
        let Item::Scene(scene) = item else { continue };
        let module = module_name(&scene.name.ident, "scene").to_string();
        let is_new = taken.insert(scene.name.text.clone()) && taken.insert(module);
        let is_of_others =
            crate::names::is_generated_item(&scene.name.text) || is_carried_form(&scene.name, declaration);
        if is_new && !is_of_others {
            items.extend(self::scene(scene, system, names));
        }
    }
    items
}

fn scene(scene: &Scene, system: &proc_macro2::Ident, names: &Names) -> TokenStream {
    let (name, module) = (&scene.name.ident, module_name(&scene.name.ident, "scene"));
    let mut own = Names { bodies: 0, ..names.clone() };
    for fix in &scene.fixes {
        own.constants.retain(|constant| *constant != fix.name.ident);
        own.required.retain(|constant| *constant != fix.name.ident);
    }
    for fix in scene.fixes.iter().filter(|fix| fix.value.is_none()) {
        if names.state.contains(&fix.name.ident) {
            push(&mut own.constants, &fix.name.ident);
            push(&mut own.required, &fix.name.ident);
        }
    }
    let carried = carried::items(&own, &scene.provides.iter().collect::<Vec<_>>());
    let parts =
        [constants(name, &own), records(&own), prepared(name, &own), operators(&own), levels(&own), carried];
    let conversion = if scene.fixes.is_empty() { format_ident!("From") } else { format_ident!("TryFrom") };
    let (error, method, returns) = if scene.fixes.is_empty() {
        (quote!(), format_ident!("from"), quote!(Self))
    } else {
        (
            quote!(
                type Error = __guen::ConstantsError;
            ),
            format_ident!("try_from"),
            quote!(::core::result::Result<Self, __guen::ConstantsError>),
        )
    };
    quote! {
        /// The module of a scene of a system whose declaration has faults.
        pub mod #module {
            use super::__guen;
            #(#parts)*
            impl<R: __guen::Real> #name<R> {
                /// The scene with the constants of a system.
                pub fn of(
                    _: &super::#system<R>, _: &super::State<R>,
                ) -> ::core::result::Result<Self, __guen::ConstantsError> {
                    ::core::unreachable!()
                }
                /// The constants of the system.
                pub fn system(&self) -> super::#system<R> { ::core::unreachable!() }
            }
            impl<R: __guen::Real> ::core::convert::#conversion<super::#system<R>> for #name<R> {
                #error
                fn #method(_: super::#system<R>) -> #returns { ::core::unreachable!() }
            }
            impl<R> ::core::convert::From<&super::State<R>> for State<R> {
                fn from(_: &super::State<R>) -> Self { ::core::unreachable!() }
            }
            impl<R> ::core::convert::From<super::State<R>> for State<R> {
                fn from(_: super::State<R>) -> Self { ::core::unreachable!() }
            }
            impl<R> State<R> {
                /// A state of the system.
                pub fn within(self, _: super::State<R>) -> super::State<R> { ::core::unreachable!() }
            }
        }
        pub use #module::#name;
    }
}
