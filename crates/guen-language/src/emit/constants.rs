//! The struct of physical constants, `prepare`, and the prepared system.

use guen_symbolic::ExprId;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::code::number;
use super::{Layout, Subject, documentation, recast, tokens, variable_ident};
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
}

/// The constants that a scene does not fix, then the variables that it holds.
fn fields(subject: &Subject<'_, '_>) -> Vec<Field> {
    let Subject { model, level } = subject;
    let constants = level.selection.constants.iter().map(|c| &model.constants[*c]).map(|c| Field {
        ident: c.name.ident.clone(),
        name: c.name.text.clone(),
        docs: documentation::entry(c.docs, &format!("The constant `{}`.", c.name)),
        bound: c.bound,
        default: c.default,
    });
    let held = level.selection.held.iter().map(|held| {
        let name = model.variable_name(held.place).to_owned();
        let text = format!("The value at which `{name}` stays.");
        let ident = variable_ident(model, held.place);
        Field { ident, name, docs: quote!(#[doc = #text]), bound: None, default: None }
    });
    constants.chain(held).collect()
}

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout, report: &Report) -> TokenStream {
    let system = &layout.system;
    let fields = fields(subject);
    let names: Vec<&Ident> = fields.iter().map(|field| &field.ident).collect();
    let docs = fields.iter().map(|field| &field.docs);
    let written = subject.scene().map_or(&subject.model.declaration.docs, |(scene, _)| &scene.docs);
    let head = documentation::system(report, written, layout.is_whole);
    let (count, hoisted) = (layout.constants, layout.hoisted);
    let checks = checks(subject, &fields);
    let constructors = constructors(subject, layout, &fields);
    // A system without constants still has a type parameter to carry.
    let marker = (count == 0).then(|| {
        quote! {
            #[doc(hidden)]
            pub __guen_real: ::core::marker::PhantomData<R>,
        }
    });
    let marker_value = (count == 0).then(|| quote!(__guen_real: ::core::marker::PhantomData,));
    let indices = 0..count;
    let recast = recast::items(layout, &names, marker_value.as_ref());
    let what = if layout.is_whole { "system" } else { "scene" };
    let prepared_docs = format!(
        "The {what} [`{system}`] with its constants checked and everything that depends on them alone computed once. Immutable; it alone runs."
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

        #recast
    }
}

/// Finite, and inside the bound, each constant.
fn checks(subject: &Subject<'_, '_>, fields: &[Field]) -> TokenStream {
    let given = fields.iter().enumerate().map(|(i, field)| {
        let name = &field.name;
        let finite = quote!(__guen::check_finite(constants[#i], #name)?;);
        let bound = field.bound.map(|bound| check_bound(name, bound, &quote!(constants[#i])));
        quote!(#finite #bound)
    });
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
    quote!(#(#given)* #locals #(#fixed)*)
}

fn check_bound(name: &str, bound: BoundKind, value: &TokenStream) -> TokenStream {
    let (relation, check) = match bound {
        BoundKind::Positive => ("> 0", quote!(check_positive)),
        BoundKind::Nonnegative => (">= 0", quote!(check_nonnegative)),
        BoundKind::Nonzero => ("!= 0", quote!(check_nonzero)),
    };
    let text = format!("{name} {relation}");
    quote!(__guen::#check(#value, #name, #text)?;)
}

/// `new` with the constants that have no default, and `Default` if all have one.
fn constructors(subject: &Subject<'_, '_>, layout: &Layout, fields: &[Field]) -> TokenStream {
    let system = &layout.system;
    let names: Vec<&Ident> = fields.iter().map(|field| &field.ident).collect();
    // A parameter named like a constant of the module, an operator or `None` would be a pattern.
    let parameter = |field: &Field| {
        if crate::names::is_pattern(&field.name) {
            format_ident!("{}_", field.name, span = field.ident.span())
        } else {
            field.ident.clone()
        }
    };
    let required: Vec<Ident> = fields.iter().filter(|field| field.default.is_none()).map(parameter).collect();
    // Defaults may use earlier constants: they are evaluated in order, as locals that no constant can shadow.
    let locals: Vec<Ident> = (0..fields.len()).map(|i| format_ident!("__guen_c{i}")).collect();
    let values = fields.iter().zip(&locals).map(|(field, local)| match field.default {
        None => {
            let name = parameter(field);
            quote!(let #local: R = #name;)
        }
        Some(default) => {
            let value = tokens(&default_text(subject, default));
            quote!(let #local: R = #value;)
        }
    });
    let marker = (fields.is_empty()).then(|| quote!(__guen_real: ::core::marker::PhantomData,));
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

/// An expression of constants as one of Rust over the locals `__guen_c0`, `__guen_c1`, .., one for each field; constants
/// that a scene fixes are at their values.
pub(super) fn default_text(subject: &Subject<'_, '_>, e: ExprId) -> String {
    use guen_symbolic::Node;
    let of = |e| default_text(subject, e);
    let graph = &subject.model.bench.graph;
    let constants = &subject.model.constants;
    match graph.node(e) {
        Node::Number(value) => number(value),
        Node::Pi => "R::pi()".to_owned(),
        Node::Symbol(symbol) => {
            let is_it = |c: &usize| graph.as_symbol(constants[*c].symbol) == Some(*symbol);
            let fixes = subject.scene().map_or(&[][..], |(_, facts)| &facts.fixes);
            match subject.level.selection.constants.iter().position(is_it) {
                Some(i) => format!("__guen_c{i}"),
                None => {
                    fixes.iter().find(|(c, _)| is_it(c)).map_or_else(String::new, |(_, value)| of(*value))
                }
            }
        }
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
                    e => format!("R::powi({}, {e}i32)", of(*base)),
                })
                .collect();
            format!("({})", parts.join(" * "))
        }
        Node::Function(guen_symbolic::Function::Root(q), x) => {
            format!("R::root({}, {q}u32)", of(*x))
        }
        Node::Function(function, x) => format!("R::{}({})", function.name(), of(*x)),
        Node::Atan2(y, x) => format!("R::atan2({}, {})", of(*y), of(*x)),
        Node::Kept(x) => of(*x),
        // Divisions by zero are refused before.
        Node::Undefined => "R::zero()".to_owned(),
    }
}
