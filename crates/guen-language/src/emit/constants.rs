//! The struct of physical constants, `prepare`, and the prepared system.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::code::number;
use super::{Layout, documentation, tokens};
use crate::derive::Derived;
use crate::report::Report;
use crate::syntax::BoundKind;

pub(super) fn items(derived: &Derived<'_>, layout: &Layout, report: &Report) -> TokenStream {
    let system = &layout.system;
    let model = &derived.model;
    let names: Vec<&Ident> = model.constants.iter().map(|c| &c.name.ident).collect();
    let docs =
        model.constants.iter().map(|c| documentation::entry(c.docs, &format!("The constant `{}`.", c.name)));
    let head = documentation::system(report, &model.declaration.docs);
    let (count, hoisted) = (layout.constants, layout.hoisted);
    let checks = checks(derived);
    let constructors = constructors(derived, layout);
    // A system without constants still has a type parameter to carry.
    let marker = (count == 0).then(|| {
        quote! {
            #[doc(hidden)]
            pub __guen_real: ::core::marker::PhantomData<R>,
        }
    });
    let marker_value = (count == 0).then(|| quote!(__guen_real: ::core::marker::PhantomData,));
    let indices = 0..count;
    let prepared_docs = format!(
        "The system [`{system}`] with its constants checked and everything that depends on them alone computed once. Immutable; it alone runs."
    );
    quote! {
        #head
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
        )]
        pub struct #system<R = f64> {
            #(#docs pub #names: R,)*
            #marker
        }

        #constructors

        impl<R: __guen::Real> #system<R> {
            /// Checks the constants and computes what depends on them alone.
            ///
            /// # Errors
            ///
            /// A constant that is not finite or outside of its bound, or constants that make something vanish
            /// which the equations divide by.
            pub fn prepare(self) -> ::core::result::Result<Prepared<R>, __guen::ConstantsError> {
                let constants: [R; #count] = [#(self.#names),*];
                #checks
                let hoisted = program::prepare(&constants);
                let prepared = Prepared { constants, hoisted };
                prepared.check_pivots()?;
                ::core::result::Result::Ok(prepared)
            }
        }

        #[doc = #prepared_docs]
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq
        )]
        pub struct Prepared<R = f64> {
            constants: [R; #count],
            hoisted: [R; #hoisted],
        }

        impl<R: __guen::Real> Prepared<R> {
            /// The constants that the system was prepared from.
            pub fn constants(&self) -> #system<R> {
                #system { #(#names: self.constants[#indices],)* #marker_value }
            }

            /// The same system over a real that contains `R`, such as duals over it: every prepared value becomes
            /// a constant there.
            pub fn lift<S: __guen::Lift<R>>(&self) -> Prepared<S> {
                Prepared {
                    constants: self.constants.map(<S as __guen::Lift<R>>::lift),
                    hoisted: self.hoisted.map(<S as __guen::Lift<R>>::lift),
                }
            }
        }
    }
}

/// Finite, and inside the bound, each constant.
fn checks(derived: &Derived<'_>) -> TokenStream {
    let checks = derived.model.constants.iter().enumerate().map(|(i, constant)| {
        let name = &constant.name.text;
        let finite = quote! {
            if !<R as __guen::Real>::is_finite(constants[#i]) {
                return ::core::result::Result::Err(__guen::ConstantsError::NotFinite {
                    name: #name,
                    value: <R as __guen::Real>::to_f64(constants[#i]),
                });
            }
        };
        let bound = constant.bound.map(|bound| {
            let (relation, holds) = match bound {
                BoundKind::Positive => ("> 0", quote!(value > 0.0)),
                BoundKind::Nonnegative => (">= 0", quote!(value >= 0.0)),
                BoundKind::Nonzero => ("!= 0", quote!(value != 0.0)),
            };
            let text = format!("{name} {relation}");
            quote! {
                let value = <R as __guen::Real>::to_f64(constants[#i]);
                if !(#holds) {
                    return ::core::result::Result::Err(__guen::ConstantsError::OutOfBound {
                        name: #name,
                        bound: #text,
                        value,
                    });
                }
            }
        });
        quote!(#finite #bound)
    });
    quote!(#(#checks)*)
}

/// `new` with the constants that have no default, and `Default` if all have one.
fn constructors(derived: &Derived<'_>, layout: &Layout) -> TokenStream {
    let system = &layout.system;
    let constants = &derived.model.constants;
    let graph = &derived.model.bench.graph;
    let names: Vec<&Ident> = constants.iter().map(|c| &c.name.ident).collect();
    // A parameter named like a constant of the module, an operator or `None` would be a pattern.
    let parameter = |name: &crate::syntax::Name| {
        if crate::names::is_pattern(&name.text) {
            format_ident!("{}_", name.text, span = name.span())
        } else {
            name.ident.clone()
        }
    };
    let required: Vec<Ident> =
        constants.iter().filter(|c| c.default.is_none()).map(|c| parameter(c.name)).collect();
    // Defaults may use earlier constants: they are evaluated in order, as locals that no constant can shadow.
    let locals: Vec<Ident> = (0..constants.len()).map(|i| format_ident!("__guen_c{i}")).collect();
    let values = constants.iter().zip(&locals).map(|(constant, local)| match constant.default {
        None => {
            let name = parameter(constant.name);
            quote!(let #local: R = #name;)
        }
        Some(default) => {
            let text = default_text(derived, graph, default);
            let value = tokens(&text);
            quote!(let #local: R = #value;)
        }
    });
    let marker = (constants.is_empty()).then(|| quote!(__guen_real: ::core::marker::PhantomData,));
    let docs = if required.is_empty() {
        "The system with its default constants.".to_owned()
    } else {
        let list: Vec<String> = required.iter().map(|name| format!("`{name}`")).collect();
        format!("The system with {}, and the defaults of all other constants.", list.join(", "))
    };
    let default = required.is_empty().then(|| {
        quote! {
            impl<R: __guen::Real> ::core::default::Default for #system<R> {
                fn default() -> Self {
                    Self::new()
                }
            }
        }
    });
    quote! {
        impl<R: __guen::Real> #system<R> {
            #[doc = #docs]
            #[allow(clippy::too_many_arguments, reason = "one for each constant without a default")]
            #[allow(unused_variables, reason = "defaults need not use the constants before them")]
            pub fn new(#(#required: R),*) -> Self {
                #(#values)*
                #system { #(#names: #locals,)* #marker }
            }
        }
        #default
    }
}

/// An expression of constants as one of Rust over the locals `__guen_c0`, `__guen_c1`, ...
pub(super) fn default_text(
    derived: &Derived<'_>,
    graph: &guen_symbolic::Graph,
    e: guen_symbolic::ExprId,
) -> String {
    use guen_symbolic::Node;
    let of = |e| default_text(derived, graph, e);
    match graph.node(e) {
        Node::Number(value) => number(value),
        Node::Pi => "<R as __guen::Real>::pi()".to_owned(),
        Node::Symbol(symbol) => derived
            .model
            .constants
            .iter()
            .position(|c| graph.as_symbol(c.symbol) == Some(*symbol))
            .map_or_else(String::new, |i| format!("__guen_c{i}")),
        Node::Sum { constant, terms } => {
            let mut parts = Vec::new();
            if !constant.is_zero() {
                parts.push(number(constant));
            }
            for (term, c) in terms {
                parts.push(match c {
                    c if c.is_one() => of(*term),
                    c if c.is_minus_one() => format!("(-{})", of(*term)),
                    c => format!("{} * {}", number(c), of(*term)),
                });
            }
            format!("({})", parts.join(" + "))
        }
        Node::Product(factors) => {
            let parts: Vec<String> = factors
                .iter()
                .map(|(base, e)| match e {
                    1 => of(*base),
                    e => format!("<R as __guen::Real>::powi({}, {e}i32)", of(*base)),
                })
                .collect();
            format!("({})", parts.join(" * "))
        }
        Node::Function(guen_symbolic::Function::Root(q), x) => {
            format!("<R as __guen::Real>::root({}, {q}u32)", of(*x))
        }
        Node::Function(function, x) => format!("<R as __guen::Real>::{}({})", function.name(), of(*x)),
        Node::Atan2(y, x) => format!("<R as __guen::Real>::atan2({}, {})", of(*y), of(*x)),
        Node::Kept(x) => of(*x),
        // Divisions by zero are refused before.
        Node::Undefined => "<R as __guen::Real>::zero()".to_owned(),
    }
}
