//! The struct of physical constants, `prepare`, and the prepared system.

use guen_symbolic::ExprId;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::formula::default_text;
use super::layout::{Layout, REAL, is_derived, variable_ident};
use super::text::tokens;
use super::{documentation, limits, motion, physical, with_scalar};
use crate::derive::Subject;
use crate::report::Report;
use crate::syntax::BoundKind;

/// A field of the struct of constants.
struct Field {
    ident: Ident,
    /// The name without `r#`.
    name: String,
    docs: TokenStream,
    bound: Option<BoundKind>,
    default: Option<ExprId>,
    /// Whether the default is made of other constants.
    is_derived: bool,
}

/// The values of the constants of a struct, where those that are derived are computed.
pub(super) fn values(layout: &Layout, names: &[&Ident], of: &TokenStream) -> TokenStream {
    match layout.derived.is_empty() {
        true => quote!([#(#of.#names),*]),
        false => quote!(#of.__guen_values()),
    }
}

/// The constants that a scene does not fix, then the variables that it holds.
fn fields(subject: &Subject<'_, '_>, layout: &Layout) -> Vec<Field> {
    let Subject { model, level } = subject;
    let constants = level.selection.constants.iter().map(|c| &model.constants[*c]).enumerate();
    let constants = constants.map(|(i, c)| {
        let is_derived = layout.derived.contains(&i);
        Field {
            ident: c.name.ident.clone(),
            name: c.name.text.clone(),
            docs: documentation::entry(
                c.docs,
                &format!("The constant `{}`.", c.name),
                model.units.get(&c.name.text),
            ),
            bound: c.bound,
            default: c.default.filter(|_| is_derived || !self::is_derived(model, c)),
            is_derived,
        }
    });
    let held = level.selection.held.iter().map(|held| {
        let name = model.variable_name(held.place).to_owned();
        let text = format!("The value at which `{name}` stays.");
        let ident = variable_ident(model, held.place);
        Field { ident, name, docs: quote!(#[doc = #text]), bound: None, default: None, is_derived: false }
    });
    constants.chain(held).collect()
}

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout, report: &Report) -> TokenStream {
    let (system, declared) = (&layout.system, &layout.declared);
    let fields = fields(subject, layout);
    let names: Vec<&Ident> = fields.iter().map(|field| &field.ident).collect();
    let docs = fields.iter().map(|field| &field.docs);
    let real = format_ident!("{}", if system == declared { REAL } else { "Scalar" });
    let types = fields
        .iter()
        .map(|field| if field.is_derived { quote!(__guen::Derived<#real>) } else { quote!(#real) });
    let written = subject.scene().map_or(&subject.model.declaration.docs, |(scene, _)| &scene.docs);
    let (count, hoisted) = (layout.constants, layout.hoisted);
    let checks = checks(subject, &fields);
    let constructors = constructors(subject, layout, &fields);
    // A system without constants still has a type parameter to carry; its name is a value, as that of a unit struct.
    let marker = (count == 0).then(|| quote!(real: ::core::marker::PhantomData<#real>,));
    let marker_value = (count == 0).then(|| quote!(real: ::core::marker::PhantomData,));
    let is_type_like = declared.to_string().starts_with(char::is_uppercase);
    let unit = (count == 0 && is_type_like).then(|| {
        let docs = format!("The system [`{declared}`](struct@{declared}): it has no constants.");
        quote! {
            #[doc = #docs]
            pub const #declared: #system = #system { #marker_value };
        }
    });
    let structure = quote! {
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
        )]
        pub struct #declared<#real = f64> {
            #(#docs pub #names: #types,)*
            #marker
        }
    };
    let structure = documentation::reported(report, written, layout.is_whole, &structure);
    let values = values(layout, &names, &quote!(self));
    let resolution = resolution(subject, layout, &fields);
    let derived: Vec<&Ident> = layout.derived.iter().map(|i| &fields[*i].ident).collect();
    let (follows, follows_field) = match derived.len() {
        0 => (None, None),
        count => (
            Some(quote!(follows: [#(__guen::Derived::follows(&self.#derived)),*],)),
            Some(quote!(follows #count)),
        ),
    };
    let given = (0..count).map(|i| {
        let place = layout.derived.iter().position(|derived| *derived == i);
        match place {
            None => quote!(self.constants[#i]),
            Some(k) => quote! {
                if self.follows[#k] { __guen::Derived::Follows } else { __guen::Derived::Set(self.constants[#i]) }
            },
        }
    });
    let definite = physical::definite(subject, layout);
    let pivots = motion::pivots(subject);
    let limits = limits::has_any(subject).then(|| quote!(prepared.check_limits()?;));
    let with_scalar = with_scalar::items(layout, &names, marker_value.as_ref());
    let what = if layout.is_whole { "system" } else { "scene" };
    let prepared_docs = format!(
        "The {what} [`{declared}`] with its constants checked and everything that depends on them alone computed once. Immutable; it alone runs."
    );
    quote! {
        #structure
        #unit

        #constructors

        #resolution

        impl<R> __guen::Unprepared for #system<R> {}

        __guen::prepare!(
            self constants hoisted prepared; #system #count, #values, { #checks } { #pivots } { #follows } { #limits } { #definite }
        );

        __guen::prepared!(#prepared_docs #count #hoisted #follows_field);

        impl<R: __guen::Real> Prepared<R> {
            /// The constants that the system was prepared from.
            pub fn constants(&self) -> #system<R> {
                #system { #(#names: #given,)* #marker_value }
            }
        }

        #with_scalar
    }
}

/// Returns the code that makes numbers of constants that follow others; nothing where there are none.
fn resolution(subject: &Subject<'_, '_>, layout: &Layout, fields: &[Field]) -> Option<TokenStream> {
    if layout.derived.is_empty() {
        return None;
    }
    let system = &layout.system;
    let count = fields.len();
    let locals: Vec<Ident> = (0..count).map(|i| format_ident!("__guen_c{i}")).collect();
    // Formulas come last, each behind those that it reads.
    let plain = (0..count).filter(|i| !fields[*i].is_derived).map(|i| {
        let (local, name) = (&locals[i], &fields[i].ident);
        quote!(let #local: R = self.#name;)
    });
    let formulas = layout.derived.iter().map(|i| {
        let (local, name) = (&locals[*i], &fields[*i].ident);
        let formula = fields[*i].default.map(|e| tokens(&default_text(subject, e)));
        quote!(let #local: R = __guen::Derived::resolve(self.#name, || #formula);)
    });
    let resolved = fields.iter().enumerate().map(|(i, field)| {
        let name = &field.ident;
        let value = quote!(values[#i]);
        if field.is_derived { quote!(#name: __guen::Derived::Set(#value)) } else { quote!(#name: #value) }
    });
    Some(quote! {
        impl<R: __guen::Real> #system<R> {
            /// Returns the constants with every derived one set to its present value.
            pub fn resolved(&self) -> Self {
                let values = self.__guen_values();
                #system { #(#resolved),* }
            }

            /// The constants as numbers, each out of those before it.
            fn __guen_values(&self) -> [R; #count] {
                #(#plain)*
                #(#formulas)*
                [#(#locals),*]
            }
        }
    })
}

/// Finite, and inside the bound, each constant.
fn checks(subject: &Subject<'_, '_>, fields: &[Field]) -> TokenStream {
    let bounds = fields.iter().map(|field| {
        let name = &field.name;
        let bound = match field.bound {
            None => quote!(None),
            Some(bound) => {
                let (words, kind, _) = words(name, bound);
                quote!(#kind(#words))
            }
        };
        quote!((#name, __guen::Bound::#bound))
    });
    let given = quote!(__guen::check_constants(&constants, &[#(#bounds),*])?;);
    // A constant that is fixed to a number was checked when it was declared; one that is made of others is checked here.
    let graph = &subject.model.bench.graph;
    let fixes = subject.scene().map_or(&[][..], |(_, facts)| &facts.fixes);
    let fixed: Vec<TokenStream> = fixes
        .iter()
        .filter(|(_, value)| graph.as_number(*value).is_none())
        .filter_map(|(c, value)| {
            let constant = &subject.model.constants[*c];
            let value = tokens(&default_text(subject, *value));
            constant.bound.map(|bound| check_bound(&constant.name.text, bound, &value))
        })
        .collect();
    let locals = (0..fields.len()).map(|i| format_ident!("__guen_c{i}"));
    let locals = (!fixed.is_empty()).then(|| {
        quote! {
            #[allow(unused_variables, reason = "the fixed constants need not use every other")]
            let [#(#locals),*] = constants;
        }
    });
    quote!(#given #locals #(#fixed)*)
}

fn check_bound(name: &str, bound: BoundKind, value: &TokenStream) -> TokenStream {
    let (words, _, check) = words(name, bound);
    quote!(__guen::#check(#value, #name, #words)?;)
}

/// A bound in words, its variant of `Bound`, and the function that checks it.
fn words(name: &str, bound: BoundKind) -> (String, TokenStream, TokenStream) {
    let (kind, check) = match bound {
        BoundKind::Positive => (quote!(Positive), quote!(check_positive)),
        BoundKind::Nonnegative => (quote!(Nonnegative), quote!(check_nonnegative)),
        BoundKind::Nonzero => (quote!(Nonzero), quote!(check_nonzero)),
    };
    (format!("{name} {}", bound.relation()), kind, check)
}

/// `new` with the constants that have no default, and `Default` if all have one.
fn constructors(subject: &Subject<'_, '_>, layout: &Layout, fields: &[Field]) -> TokenStream {
    let system = &layout.system;
    // A parameter named like a constant of the module, an operator or `None` would be a pattern.
    let parameter = |field: &Field| {
        if crate::names::is_pattern(&field.name) {
            format_ident!("{}_", field.name, span = field.ident.span())
        } else {
            field.ident.clone()
        }
    };
    let required: Vec<Ident> = fields.iter().filter(|field| field.default.is_none()).map(parameter).collect();
    let values = fields.iter().map(|field| {
        let name = &field.ident;
        match field.default {
            None => {
                let parameter = parameter(field);
                // `a: a` would be a lint in the user's file.
                if *name == parameter { quote!(#name) } else { quote!(#name: #parameter) }
            }
            Some(_) if field.is_derived => quote!(#name: __guen::Derived::Follows),
            Some(default) => {
                let value = tokens(&default_text(subject, default));
                quote!(#name: #value)
            }
        }
    });
    let marker = (fields.is_empty()).then(|| quote!(real: ::core::marker::PhantomData,));
    let docs = if required.is_empty() {
        "The system with its default constants.".to_owned()
    } else {
        let list: Vec<String> = required.iter().map(|name| format!("`{name}`")).collect();
        format!("The system with {}, and the defaults of all other constants.", list.join(", "))
    };
    if required.is_empty() {
        // For one real, so that a call without arguments has a type.
        return quote! {
            impl #system<::core::primitive::f64> {
                #[doc = #docs]
                pub fn new() -> Self {
                    Self::with_defaults()
                }

                /// [`new`](Self::new) over another real: `with_defaults::<f32>()`.
                pub fn with_defaults<R: __guen::Real>() -> #system<R> {
                    #system { #(#values,)* #marker }
                }
            }

            impl ::core::default::Default for #system<::core::primitive::f64> {
                fn default() -> Self {
                    Self::new()
                }
            }
        };
    }
    quote! {
        impl<R: __guen::Real> #system<R> {
            #[doc = #docs]
            #[allow(clippy::too_many_arguments, reason = "one for each constant without a default")]
            pub fn new(#(#required: R),*) -> Self {
                #system { #(#values,)* #marker }
            }
        }
    }
}
