//! Structs with a named field for everything: state, positions, inputs, momenta, reactions, residuals, outputs.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::{Layout, documentation, form_ident};
use crate::derive::Derived;
use crate::syntax::Docs;

/// A field of a record.
struct Field {
    ident: Ident,
    docs: TokenStream,
    name: String,
}

pub(super) fn items(derived: &Derived<'_>, layout: &Layout) -> TokenStream {
    let model = &derived.model;
    let field = |ident: &Ident, docs: &Docs, fallback: String| Field {
        ident: ident.clone(),
        docs: documentation::entry(docs, &fallback),
        name: ident.to_string().trim_start_matches("r#").to_owned(),
    };
    let coordinates: Vec<Field> = model
        .coordinates
        .iter()
        .map(|c| field(&c.name.ident, c.docs, format!("The coordinate `{}`.", c.name)))
        .collect();
    let form = |form: &crate::model::FormEntry<'_>, what: &str| {
        field(&form_ident(form), form.docs, format!("{what} `{}`.", form.name))
    };
    let parameters: Vec<Field> =
        model.forms[..layout.l].iter().map(|f| form(f, "The quasi-velocity")).collect();
    let state_docs = format!(
        "A state of the system: {} coordinates, then {} quasi-velocities, in the order of the declaration.",
        layout.n, layout.l
    );
    let mut items = Vec::new();
    items.push(record("State", &state_docs, coordinates.iter().chain(&parameters)));
    let size = layout.size;
    items.push(quote!(__guen::nalgebra_conversions!(State, #size);));
    items.push(record(
        "Coordinates",
        "A value for each coordinate: a position, or the velocities `x'`.",
        coordinates.iter(),
    ));
    let known = &derived.derivation.known_momentum;
    let momenta: Vec<Field> = model
        .forms
        .iter()
        .zip(known)
        .filter(|(_, known)| **known)
        .map(|(f, _)| form(f, "The momentum that goes with"))
        .collect();
    items.push(record(
        "Momenta",
        "The momenta `dT/d eta_s`, and `(dT°/d eta_v)` for the constraints, (2.8), as far as the kinetic energy speaks of them.",
        momenta.iter(),
    ));
    let constraints = &model.forms[layout.l..];
    if !constraints.is_empty() {
        let residuals: Vec<Field> = constraints.iter().map(|f| form(f, "What is left of")).collect();
        items.push(record(
            "Residuals",
            "What is left of each constraint: `eta_v` of a velocity constraint, `f(t, x)` of a holonomic one; zero where it holds.",
            residuals.iter(),
        ));
    }
    let known: Vec<Field> = constraints
        .iter()
        .zip(&derived.derivation.reactions)
        .filter(|(_, reaction)| reaction.is_some())
        .map(|(f, _)| form(f, "The multiplier of"))
        .collect();
    if !known.is_empty() {
        items.push(record(
            "Reactions",
            "The reactions `lambda_v`: the generalised force of each constraint along its own form. As a covector on `x'` they are `R_i = sum_v lambda_v a_vi`.",
            known.iter(),
        ));
    }
    if !model.inputs.is_empty() {
        let inputs: Vec<Field> = model
            .inputs
            .iter()
            .map(|c| field(&c.name.ident, c.docs, format!("The input `{}`.", c.name)))
            .collect();
        items.push(record("Inputs", "The control inputs, constant during a step.", inputs.iter()));
    }
    if !model.outputs.is_empty() {
        items.push(outputs(derived));
    }
    quote!(#(#items)*)
}

/// A record of reals with conversions from and to an array.
fn record<'a>(name: &str, docs: &str, fields: impl Iterator<Item = &'a Field>) -> TokenStream {
    let record = format_ident!("{name}");
    let (mut idents, mut doc, mut names) = (Vec::new(), Vec::new(), Vec::new());
    for field in fields {
        idents.push(&field.ident);
        doc.push(&field.docs);
        names.push(&field.name);
    }
    let count = idents.len();
    // A name in a pattern would mean a constant or an operator of that name, if there is one.
    let locals: Vec<Ident> = (0..count).map(|i| format_ident!("__guen_{i}")).collect();
    quote! {
        #[doc = #docs]
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq,
            ::core::default::Default
        )]
        pub struct #record<R = f64> {
            #(#doc pub #idents: R,)*
        }

        impl #record<f64> {
            /// The names of the fields, in order.
            pub const NAMES: [&'static str; #count] = [#(#names),*];
        }

        impl<R> ::core::convert::From<[R; #count]> for #record<R> {
            #[inline]
            fn from([#(#locals),*]: [R; #count]) -> Self {
                #record { #(#idents: #locals),* }
            }
        }

        impl<R> ::core::convert::From<#record<R>> for [R; #count] {
            #[inline]
            fn from(record: #record<R>) -> Self {
                [#(record.#idents),*]
            }
        }
    }
}

/// Outputs: scalars are reals, vectors arrays of three.
fn outputs(derived: &Derived<'_>) -> TokenStream {
    let outputs = &derived.model.outputs;
    let idents: Vec<&Ident> = outputs.iter().map(|o| &o.name.ident).collect();
    let docs = outputs.iter().map(|o| documentation::entry(o.docs, &format!("The output `{}`.", o.name)));
    let types = outputs.iter().map(|o| if o.components.len() == 1 { quote!(R) } else { quote!([R; 3]) });
    let values = outputs.iter().map(|o| {
        let parts = o.components.iter().map(|i| quote!(values[#i]));
        if o.components.len() == 1 { quote!(#(#parts)*) } else { quote!([#(#parts),*]) }
    });
    let count = derived.derivation.outputs.len();
    quote! {
        /// The declared outputs.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq,
            ::core::default::Default
        )]
        pub struct Outputs<R = f64> {
            #(#docs pub #idents: #types,)*
        }

        impl<R: ::core::marker::Copy> Outputs<R> {
            #[inline]
            fn from_values(values: &[R; #count]) -> Self {
                Outputs { #(#idents: #values),* }
            }
        }
    }
}
