//! Items of a component: the struct of its constants.

use guen_symbolic::{ExprId, SymbolId};
use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote, quote_spanned};

use crate::diagnostics::collect;
use crate::emit::documentation;
use crate::emit::layouts::fields::{self, Fields, Tree};
use crate::emit::layouts::parts;
use crate::emit::layouts::supplied::Supplied;
use crate::emit::layouts::text::tokens;
use crate::emit::programs::formula::text_of;
use crate::model::Model;
use crate::names::module_name;
use crate::report::interface;
use crate::syntax::{Component, Instance};

/// The struct of the constants of a component, for a model of these alone, and the module with its name for them.
pub(crate) fn component(component: &Component, model: &Model<'_>, facade: &TokenStream) -> TokenStream {
    let structure = structure(component, model, facade, &component.visibility.outside());
    let module = module(component, &Supplied::new(model), &quote!(#facade::__private));
    quote!(#structure #module)
}

fn structure(
    component: &Component,
    model: &Model<'_>,
    facade: &TokenStream,
    visibility: &TokenStream,
) -> TokenStream {
    let name = &component.name.ident;
    let private = quote!(#facade::__private);
    let supplied = &Supplied::new(model);
    let structure = fields_of(model, supplied);
    let instances = &model.declaration.instances;
    let leaf = leaf(model, &structure, supplied, &private);
    let fields = structure.trees().map(|(ident, tree)| {
        let docs = docs(model, &structure, supplied, tree);
        let kind = kind(tree, instances, &leaf);
        quote!(#docs pub #ident: #kind,)
    });
    let marker = structure.has_marker().then(parts::marker);
    let constructors = constructors(component, model, (&structure, supplied), &private);
    let parts = parts(name, &structure, instances, &private);
    let kinds = supplied.declared();
    let text = interface(component);
    let written = &component.docs.values;
    let blank = (!written.is_empty()).then(|| quote!(#[doc = ""]));
    quote! {
        #(#[doc = #written])*
        #blank
        #[doc = #text]
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
        )]
        #[allow(non_snake_case, reason = "names are the user's own")]
        #visibility struct #name<R = f64 #kinds> {
            #(#fields)*
            #marker
        }
        #constructors
        #parts
    }
}

/// The fields of the struct.
fn fields_of(model: &Model<'_>, supplied: &Supplied) -> Fields {
    supplied.behind(model.constants.iter().map(|constant| constant.name))
}

/// The types of values.
fn leaf<'a>(
    model: &'a Model<'_>,
    structure: &'a Fields,
    supplied: &Supplied,
    private: &'a TokenStream,
) -> impl Fn(usize) -> TokenStream + 'a {
    let kinds = supplied.kinds();
    move |place| match structure.function(place) {
        Some(function) => {
            let kind = &kinds[function];
            quote!(#kind)
        }
        None if model.constants[place].is_derived => quote!(#private::Derived<R>),
        None => quote!(R),
    }
}

/// `rolling_wheel::Constants` for `RollingWheel`.
fn module(component: &Component, supplied: &Supplied, private: &TokenStream) -> TokenStream {
    let name = &component.name.ident;
    let module = module_name(name, "component");
    let (visibility, inner) = (component.visibility.outside(), component.visibility.inside());
    let text = format!("The constants of the component `{name}`.");
    let (declared, kinds) = (supplied.declared(), supplied.arguments());
    let Tuple { functions, parameters } = Tuple::of(&supplied.parameter_list());
    quote! {
        #[doc = #text]
        #[allow(unused_imports, dead_code, reason = "the struct alone may be what is used")]
        #visibility mod #module {
            #[doc(hidden)]
            #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
            #inner struct __GuenComponent;
            #[doc = #text]
            pub type Constants<R = f64 #declared> =
                <__GuenComponent as __guen::Instances<0 #functions>>::Constants<R>;
            use #private as __guen;
        }
        impl #parameters #private::Instances<0 #functions> for #module::__GuenComponent {
            type Constants<R> = #name<R #kinds>;
        }
    }
}

/// The functions of an instance, as the trait of instances takes them.
struct Tuple {
    /// The tuple of their types behind a comma.
    functions: Option<TokenStream>,
    /// The parameters of an implementation.
    parameters: Option<TokenStream>,
}

impl Tuple {
    fn of(kinds: &[Ident]) -> Self {
        let parameters = (!kinds.is_empty()).then(|| quote!(<#(#kinds),*>));
        Tuple { functions: parts::functions_of(kinds), parameters }
    }
}

fn docs(model: &Model<'_>, structure: &Fields, supplied: &Supplied, tree: &Tree) -> TokenStream {
    let mut places = Vec::new();
    tree.leaves(&mut places);
    let Some(first) = places.first() else { return TokenStream::new() };
    if let Some(part) = tree.instance() {
        return parts::docs_of_instance(&model.declaration.instances, part);
    }
    if let Some(function) = structure.function(*first) {
        return supplied.docs(function).clone();
    }
    let constant = &model.constants[*first];
    let text = format!("The constant `{}`.", constant.name);
    documentation::entry(constant.docs, &text, model.units.get(&constant.name.text))
}

/// The component of an instance that is a field, as the use has it.
fn path_of<'a>(tree: &Tree, instances: &'a [Instance]) -> Option<&'a TokenStream> {
    let part = tree.instance()?;
    let instance = instances.iter().find(|instance| {
        let is_top = instance.path.steps.iter().all(|step| matches!(step, crate::syntax::Step::Index { .. }));
        is_top && part.module.first() == Some(instance.path.module())
    });
    instance.map(|instance| &instance.component.tokens)
}

fn kind(tree: &Tree, instances: &[Instance], leaf: &dyn Fn(usize) -> TokenStream) -> TokenStream {
    match tree {
        Tree::Leaf(place) => leaf(*place),
        Tree::Array(entries) => {
            let count = entries.len();
            let inner = entries.first().map_or_else(|| quote!(R), |entry| kind(entry, instances, leaf));
            quote!([#inner; #count])
        }
        Tree::Instance(part) => path_of(tree, instances).map_or_else(
            || quote!(R),
            |path| {
                let kinds = &part.kinds;
                quote!(#path<R #(, #kinds)*>)
            },
        ),
    }
}

/// `new` with what has no default, and `Default` if everything has one.
fn constructors(
    component: &Component,
    model: &Model<'_>,
    (structure, supplied): (&Fields, &Supplied),
    private: &TokenStream,
) -> TokenStream {
    let name = &component.name.ident;
    let types = leaf(model, structure, supplied, private);
    let (mut required, mut kinds, mut values) = (Vec::new(), Vec::new(), Vec::new());
    for (ident, tree) in structure.trees() {
        let mut places = Vec::new();
        tree.leaves(&mut places);
        let is_default =
            |place: &usize| model.constants.get(*place).is_some_and(|constant| constant.default.is_some());
        if places.iter().all(is_default) {
            let value = default(model, tree, private);
            values.push(quote!(#ident: #value));
            continue;
        }
        let parameter: Ident = match crate::names::is_pattern(&fields::plain(ident)) {
            true => format_ident!("{ident}_", span = ident.span()),
            false => ident.clone(),
        };
        kinds.push(kind(tree, &model.declaration.instances, &types));
        values.push(if *ident == parameter { quote!(#ident) } else { quote!(#ident: #parameter) });
        required.push(parameter);
    }
    let marker = super::constants::marker_of(structure);
    if required.is_empty() {
        return quote! {
            #[allow(dead_code, reason = "a struct may be written out")]
            impl #name<::core::primitive::f64> {
                /// The component with its default constants.
                pub fn new() -> Self {
                    Self::with_defaults()
                }

                /// [`new`](Self::new) over another real: `with_defaults::<f32>()`.
                pub fn with_defaults<R: #private::Real>() -> #name<R> {
                    #name { #(#values,)* #marker }
                }
            }

            impl ::core::default::Default for #name<::core::primitive::f64> {
                fn default() -> Self {
                    Self::new()
                }
            }
        };
    }
    let parameters = supplied.arguments();
    let list: Vec<String> = required.iter().map(|name| format!("`{name}`")).collect();
    let docs = format!("The component with {}, and the defaults of all other constants.", list.join(", "));
    quote! {
        #[allow(dead_code, reason = "a struct may be written out")]
        impl<R: #private::Real #parameters> #name<R #parameters> {
            #[doc = #docs]
            #[allow(clippy::too_many_arguments, non_snake_case, reason = "one for each constant without a default")]
            pub fn new(#(#required: #kinds),*) -> Self {
                #name { #(#values,)* #marker }
            }
        }
    }
}

/// The value of a field from defaults.
fn default(model: &Model<'_>, tree: &Tree, private: &TokenStream) -> TokenStream {
    match tree {
        Tree::Leaf(place) => {
            let constant = &model.constants[*place];
            if constant.is_derived {
                return quote!(#private::Derived::Follows);
            }
            let unknown = |_: SymbolId| String::new();
            let text = |e: ExprId| text_of(&model.bench.graph, e, &unknown);
            constant.default.map_or_else(TokenStream::new, |e| tokens(&text(e)))
        }
        Tree::Array(entries) => {
            let entries = entries.iter().map(|entry| default(model, entry, private));
            quote!([#(#entries),*])
        }
        Tree::Instance(_) => {
            let path = path_of(tree, &model.declaration.instances);
            quote!(<#path<::core::primitive::f64>>::with_defaults())
        }
    }
}

/// The types of the constants of inner instances, by which systems find them.
fn parts(name: &Ident, structure: &Fields, instances: &[Instance], private: &TokenStream) -> TokenStream {
    let fields: Vec<(Ident, Tree)> =
        structure.trees().map(|(ident, tree)| (ident.clone(), tree.clone())).collect();
    let parts = parts::instances(&fields).filter_map(|(place, ident)| {
        let tree = fields.iter().find(|(known, _)| known == ident).map(|(_, tree)| tree)?;
        let path = path_of(tree, instances)?;
        let kinds = &tree.instance()?.kinds;
        let Tuple { functions, parameters } = Tuple::of(kinds);
        Some(quote! {
            impl #parameters #private::Instances<#place #functions> for #name<::core::primitive::f64> {
                type Constants<R> = #path<R #(, #kinds)*>;
            }
        })
    });
    let parts: Vec<TokenStream> = parts.collect();
    quote!(#(#parts)*)
}

/// The types of the constants of the instances of a system: an implementation beside the module for each component that is
/// imported there, and in the module the components that are declared in the braces of the system.
pub(in crate::emit) fn of_instances(model: &Model<'_>, facade: &TokenStream) -> (TokenStream, TokenStream) {
    let declaration = model.declaration;
    if declaration.instances.is_empty() {
        return Default::default();
    }
    let module = module_name(&declaration.name.ident, "system");
    let supplied = &Supplied::new(model);
    let fields: Vec<(Ident, Tree)> =
        fields_of(model, supplied).trees().map(|(ident, tree)| (ident.clone(), tree.clone())).collect();
    let (mut outside, mut inside) = (TokenStream::new(), TokenStream::new());
    let inner = declaration.visibility.inside();
    inside.extend(quote! {
        #[doc(hidden)]
        #[::core::prelude::v1::derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
        #inner struct __GuenInstances;
    });
    for (place, ident) in parts::instances(&fields) {
        let tree = fields.iter().find(|(known, _)| known == ident).map(|(_, tree)| tree);
        let Some(path) = tree.and_then(|tree| path_of(tree, &declaration.instances)) else { continue };
        let kinds = tree.and_then(Tree::instance).map_or(&[][..], |part| &part.kinds);
        let Tuple { functions, parameters } = Tuple::of(kinds);
        let text = path.to_string();
        let is_inside = declaration.components.iter().any(|(known, _)| known.name.ident == text);
        if is_inside {
            inside.extend(quote! {
                impl #parameters __guen::Instances<#place #functions> for __GuenInstances {
                    type Constants<R> = #path<R #(, #kinds)*>;
                }
            });
        } else {
            // A component that fewer may see than the system is the compiler's mistake at this place.
            let place_of_path =
                path.clone().into_iter().last().map_or_else(Span::call_site, |token| token.span());
            let constants = quote_spanned!(place_of_path=> type Constants<R> = #path<R #(, #kinds)*>;);
            outside.extend(quote! {
                impl #parameters #facade::__private::Instances<#place #functions> for #module::__GuenInstances {
                    #constants
                }
            });
        }
    }
    for (component, constants) in &declaration.components {
        let (constants, _) = collect(|faults| crate::model::resolve(constants, faults));
        if let Some(constants) = constants {
            inside.extend(structure(component, &constants, facade, &quote!(pub)));
        }
    }
    (outside, inside)
}
