//! Emits Rust items for a derived system, one file for each kind of item.
//!
//! Two piles: what users name (the constants, the state, the operators, ...) carries their spans, visibility and
//! documentation; straight-line code sits in the private module `program`, where lint allowances are.
//!
//! `layouts` has the names and fields that all items are written by, `programs` the straight-line code; `structs`, `methods` and `contact_modes` are the
//! items that users name, `carried` a level in the carried form, with all of these.

mod carried;
mod contact_modes;
mod documentation;
mod layouts;
mod methods;
mod programs;
mod structs;
mod thresholds;
mod uses;

use proc_macro2::{Ident, Span, TokenStream};
use quote::quote;

use crate::derive::{DerivedSystem, Subject};
use crate::names::module_name;
use crate::report::ReportLines;
use contact_modes::contacts;
use layouts::layout::{Layout, facade};
use methods::{bodies, classification, control, lanes, linearization, missing, motion, operators, positions};
use programs::{functions, series, source};
pub(crate) use structs::components::component;
use structs::{components, constants, levels, limits, physical, records, serde};

/// Emits a derived system with its scenes.
pub fn emit(derived: DerivedSystem<'_>) -> TokenStream {
    items(&derived, false)
}

/// Emits the items of what stands in for a faulty declaration: without a report, and with every marker trait, because what
/// is derived of it says nothing of the system that is meant.
pub fn outline(derived: DerivedSystem<'_>) -> TokenStream {
    items(&derived, true)
}

fn items(derived: &DerivedSystem<'_>, is_outline: bool) -> TokenStream {
    let DerivedSystem { model, system, .. } = derived;
    let facade = facade(model.declaration);
    let whole = Subject { model, level: system, whole: model };
    let scenes = scenes(derived);
    let inner: Vec<TokenStream> = scenes
        .iter()
        .map(|scene| {
            let private = quote!(super::__guen);
            module(scene, &private, &quote!(pub), &TokenStream::new(), is_outline)
        })
        .collect();
    let levels = levels::table(&scenes);
    let uses = (!is_outline).then(|| uses::items(&model.identifiers));
    let visibility = model.declaration.visibility.outside();
    let (of_instances, inside) = components::of_instances(model, &facade);
    let module = module(
        &whole,
        &quote!(#facade::__private),
        &quote!(#visibility),
        &quote!(#levels #uses #inside #(#inner)*),
        is_outline,
    );
    quote!(#module #of_instances)
}

/// The scenes in order.
fn scenes<'d, 'a>(derived: &'d DerivedSystem<'a>) -> Vec<Subject<'d, 'a>> {
    let whole = &derived.model;
    let of_whole = derived.scenes.iter().filter_map(|level| {
        let place = level.scene.as_ref()?.index;
        Some((place, Subject { model: whole, level, whole }))
    });
    let in_modes = derived.in_modes.iter().flat_map(|(place, own)| {
        own.scenes.iter().map(|level| (*place, Subject { model: &own.model, level, whole }))
    });
    let mut scenes: Vec<(usize, Subject<'d, 'a>)> = of_whole.chain(in_modes).collect();
    scenes.sort_by_key(|(place, _)| *place);
    scenes.into_iter().map(|(_, scene)| scene).collect()
}

/// The module of a level, and the struct beside it.
fn module(
    subject: &Subject<'_, '_>,
    private: &TokenStream,
    visibility: &TokenStream,
    inner: &TokenStream,
    is_outline: bool,
) -> TokenStream {
    let layout = Layout::new(subject);
    let system = &layout.declared;
    let is_hidden = layout.system != layout.declared;
    let alias_of_system = is_hidden.then(|| {
        let alias = &layout.system;
        quote!(use self::#system as #alias;)
    });
    let module = module_name(system, if layout.is_whole { "system" } else { "scene" });
    let report = if is_outline { ReportLines::stand_in(system) } else { ReportLines::new(subject) };
    let parts = [
        constants::items(subject, &layout, &report),
        records::items(subject, &layout),
        motion::items(subject, &layout),
        lanes::items(&layout),
        series::items(subject, &layout),
        linearization::items(subject, &layout),
        control::items(subject, &layout),
        limits::items(subject, &layout),
        serde::items(subject, &layout),
        positions::items(subject, &layout),
        physical::items(subject, &layout),
        bodies::items(subject, &layout),
        operators::items(subject, &layout),
        classification::items(subject, &layout, is_outline),
        levels::items(subject, &layout),
        contacts::items(subject, &layout),
        missing::items(subject, &layout),
        functions::modules(subject, &layout),
        carried::items(subject, &layout),
        source::items(subject, &layout, is_outline),
    ];
    let parts = parts.into_iter().map(|part| layout.supplied.spread(part));
    let docs = documentation::module(&report, system, layout.is_whole);
    let alias = Ident::new("__guen", Span::call_site());
    quote! {
        #docs
        #[allow(
            non_snake_case, non_camel_case_types, non_upper_case_globals, unreachable_pub,
            reason = "names and visibility are the user's own"
        )]
        #visibility mod #module {
            #[allow(unused_imports, reason = "small systems use few of its items")]
            use #private as #alias;
            #alias_of_system
            #(#parts)*
            #inner
        }
        #[allow(unused_imports, reason = "the module alone may be what is used")]
        #visibility use #module::#system;
    }
}
