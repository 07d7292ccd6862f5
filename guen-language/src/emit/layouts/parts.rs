//! The structs of instances: the instance `left` has a module `left`, with a struct for each record that it has values in.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::fields::{Fields, Part, Tree};
use crate::syntax::Instance;

/// The modules of instances, and those inside of them.
#[derive(Default)]
pub(in crate::emit) struct Modules {
    docs: String,
    items: Vec<TokenStream>,
    inner: Vec<(Ident, Modules)>,
}

impl Modules {
    /// Adds an item to the module of an instance.
    pub(in crate::emit) fn add(&mut self, module: &[Ident], item: TokenStream) {
        let mut place = self;
        let mut text = String::new();
        for name in module {
            text = if text.is_empty() { name.to_string() } else { format!("{text}.{name}") };
            let known = place.inner.iter().position(|(known, _)| known == name);
            let index = known.unwrap_or_else(|| {
                let docs = format!("What belongs to the instance `{}`.", text.replace("r#", ""));
                place.inner.push((name.clone(), Modules { docs, ..Modules::default() }));
                place.inner.len() - 1
            });
            place = &mut place.inner[index].1;
        }
        place.items.push(item);
    }

    /// The modules as items.
    pub(in crate::emit) fn tokens(&self) -> TokenStream {
        let modules = self.inner.iter().map(|(name, module)| {
            let (Modules { docs, items, .. }, inner) = (module, module.tokens());
            quote! {
                #[doc = #docs]
                pub mod #name {
                    #[allow(unused_imports, reason = "some instances need none of its items")]
                    use super::__guen;
                    #(#items)*
                    #inner
                }
            }
        });
        quote!(#(#modules)*)
    }
}

/// Adds the structs of a record: a field has the documentation of its first value. `leaf` is the type of a value.
pub(in crate::emit) fn add(
    modules: &mut Modules,
    record: &'static str,
    structure: &Fields,
    docs: &dyn Fn(&Tree) -> TokenStream,
    leaf: &dyn Fn(usize) -> TokenStream,
    has_default: bool,
) {
    for part in structure.parts() {
        let item = structure_of(record, part, docs, leaf, has_default);
        modules.add(&part.module, item);
    }
}

fn structure_of(
    record: &'static str,
    part: &Part,
    docs: &dyn Fn(&Tree) -> TokenStream,
    leaf: &dyn Fn(usize) -> TokenStream,
    has_default: bool,
) -> TokenStream {
    let name = format_ident!("{record}");
    let depth = part.module.len();
    let fields = part.fields.iter().map(|(ident, tree)| {
        let (docs, kind) = (docs(tree), tree.inner_type(leaf, depth));
        quote!(#docs pub #ident: #kind,)
    });
    let text = format!("The values of the instance in [`{record}`]({}{record}).", "super::".repeat(depth));
    let default = has_default.then(|| {
        let value = quote!(::core::default::Default::default());
        let fields = part.fields.iter().map(|(ident, tree)| {
            let value = tree.inner_filled(&value, depth);
            quote!(#ident: #value,)
        });
        quote! {
            impl<R: ::core::default::Default> ::core::default::Default for #name<R> {
                fn default() -> Self {
                    #name { #(#fields)* }
                }
            }
        }
    });
    let (kinds, marker) = (&part.kinds, part.has_marker.then(marker));
    quote! {
        #[doc = #text]
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
        )]
        pub struct #name<R = f64 #(, #kinds = f64)*> {
            #(#fields)*
            #marker
        }
        #default
    }
}

/// The field that names the type of reals, of a struct without constants.
pub(in crate::emit) fn marker() -> TokenStream {
    quote!(#[doc(hidden)] pub real: ::core::marker::PhantomData<R>,)
}

/// The types of functions behind a comma, as a trait of instances takes them: nothing where there are none.
pub(in crate::emit) fn functions_of(kinds: &[Ident]) -> Option<TokenStream> {
    (!kinds.is_empty()).then(|| quote!(, (#(#kinds,)*)))
}

/// The places of instances among the fields of a struct of constants, each with its name: by them the types of their constants
/// are found.
pub(in crate::emit) fn instances(fields: &[(Ident, Tree)]) -> impl Iterator<Item = (usize, &Ident)> {
    fn is_instance(tree: &Tree) -> bool {
        match tree {
            Tree::Leaf(_) => false,
            Tree::Array(entries) => entries.first().is_some_and(is_instance),
            Tree::Instance(_) => true,
        }
    }
    fields.iter().filter(|(_, tree)| is_instance(tree)).map(|(ident, _)| ident).enumerate()
}

/// Adds the types of the constants of instances: those of their components.
pub(in crate::emit) fn add_constants(modules: &mut Modules, structure: &Fields) {
    let top: Vec<(Ident, Tree)> =
        structure.trees().map(|(ident, tree)| (ident.clone(), tree.clone())).collect();
    let place = |fields: &[(Ident, Tree)], module: &[Ident]| {
        let has_module = |(_, tree): &&(Ident, Tree)| tree.instance().is_some_and(|own| own.module == module);
        let field = fields.iter().find(has_module).map(|(ident, _)| ident);
        instances(fields).find(|(_, known)| Some(*known) == field).map_or(0, |(place, _)| place)
    };
    let parts = structure.parts();
    for part in &parts {
        let Some((_, outer)) = part.module.split_last() else { continue };
        let owner = parts.iter().find(|other| other.module == outer);
        let (place, of) = match owner {
            None => (place(&top, &part.module), quote!(super::__GuenInstances)),
            Some(owner) => {
                (place(&owner.fields, &part.module), quote!(super::Constants<::core::primitive::f64>))
            }
        };
        let (kinds, functions) = (&part.kinds, functions_of(&part.kinds));
        let item = quote! {
            /// The constants of the instance.
            pub type Constants<R = f64 #(, #kinds = f64)*> =
                <#of as __guen::Instances<#place #functions>>::Constants<R>;
        };
        modules.add(&part.module, item);
    }
}

/// Adds the types of the constants of instances in a scene: those of the system where the scene has all of them.
pub(in crate::emit) fn add_constants_of_scene(
    modules: &mut Modules,
    own: &Fields,
    whole: &Fields,
    docs: &dyn Fn(&Tree) -> TokenStream,
    leaf: &dyn Fn(usize) -> TokenStream,
) {
    for part in own.parts() {
        let of_system = whole.parts().into_iter().find(|other| other.module == part.module);
        let item = match of_system.filter(|other| other.is_like(part)) {
            Some(_) => {
                let (outer, module) = (super::fields::outward(part.module.len() + 1), &part.module);
                let kinds = &part.kinds;
                quote! {
                    /// The constants of the instance.
                    pub type Constants<R = f64 #(, #kinds = f64)*> =
                        #outer #(#module::)* Constants<R #(, #kinds)*>;
                }
            }
            None => structure_of("Constants", part, docs, leaf, false),
        };
        modules.add(&part.module, item);
    }
}

/// The documentation of an instance as a field.
pub(in crate::emit) fn docs_of_instance(instances: &[Instance], part: &Part) -> TokenStream {
    let text = |instance: &Instance| {
        let fields = instance.path.steps.iter().filter_map(|step| match step {
            crate::syntax::Step::Field(field) => Some(field),
            crate::syntax::Step::Index { .. } => None,
        });
        std::iter::once(instance.path.module()).chain(fields).eq(part.module.iter())
    };
    let Some(instance) = instances.iter().find(|instance| text(instance)) else { return TokenStream::new() };
    let values = &instance.docs.values;
    if !values.is_empty() {
        return quote!(#(#[doc = #values])*);
    }
    let name =
        part.module.iter().map(|name| name.to_string().replace("r#", "")).collect::<Vec<_>>().join(".");
    let text = format!("Of the instance `{name}`, a `{}`.", instance.component.name);
    quote!(#[doc = #text])
}
