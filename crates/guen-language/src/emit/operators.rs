//! The operators of displacement and their brackets.

use guen_symbolic::{ExprId, Graph, Role, Roles};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::{Layout, Subject};

pub(super) fn items(subject: &Subject<'_, '_>, layout: &Layout) -> TokenStream {
    if !subject.level.selection.operators {
        return TokenStream::new();
    }
    let n = layout.all;
    let operators = (0..=n).map(|j| {
        let name = format_ident!("X{j}");
        let places = (j * n)..((j + 1) * n);
        let docs = match j {
            0 => "The operator `X_0 = d/dt + sum_i xi_0^i d/dx_i`: what happens by itself, (1.7).".to_owned(),
            _ => format!("The operator `X_{j}` of the form `{}`, (1.4).", subject.model.forms[j - 1].name),
        };
        let is_time = j == 0;
        quote! {
            #[doc = #docs]
            #[::core::prelude::v1::derive(
                ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default,
                ::core::cmp::PartialEq, ::core::cmp::Eq
            )]
            pub struct #name;

            impl<B: __guen::Real> __guen::Operator<B, #n> for #name {
                type Prepared = Prepared<B>;
                const TIME: bool = #is_time;
                fn coefficients<R: __guen::Real + __guen::Lift<B>>(
                    prepared: &Prepared<B>,
                    t: R,
                    x: &[R; #n],
                ) -> [R; #n] {
                    let lifted: Prepared<R> = prepared.lift();
                    let all = program::operators(&lifted.constants, &lifted.hoisted, t, x);
                    [#(all[#places]),*]
                }
            }
        }
    });
    let operators: Vec<_> = operators.collect();
    let brackets = brackets(subject, layout);
    let last = subject.model.last_operator();
    let docs =
        format!("The commutator `(X_I, X_J) = sum_t C_IJt X_t`, (1.14), for `I` and `J` from 0 to {last}.");
    quote! {
        #(#operators)*

        #[doc = #docs]
        ///
        /// What the derivation knows of each coefficient is in `COEFFICIENTS`, their values come from
        /// `coefficients`.
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::default::Default,
            ::core::cmp::PartialEq, ::core::cmp::Eq
        )]
        pub struct Bracket<const I: usize, const J: usize>;
        #(#brackets)*
    }
}

fn brackets(subject: &Subject<'_, '_>, layout: &Layout) -> Vec<TokenStream> {
    let n = layout.all;
    let last = subject.model.last_operator();
    let graph = &subject.model.bench.graph;
    let mut items = Vec::new();
    for s in 0..=last {
        for r in 0..=last {
            let found = subject.level.brackets.iter().enumerate();
            let pair = (r.min(s), r.max(s));
            let Some((place, bracket)) = found.into_iter().find(|(_, known)| (known.r, known.s) == pair)
            else {
                items.push(quote!(__guen::zero_bracket!(#r, #s, #n);));
                continue;
            };
            let known = bracket.coefficients.iter().map(|c| knowledge(graph, *c, r > s));
            let places = (place * n)..((place + 1) * n);
            let sign = (r > s).then(|| quote!(-));
            items.push(quote! {
                impl<B: __guen::Real> __guen::BracketCoefficients<B, #n> for Bracket<#r, #s> {
                    type Prepared = Prepared<B>;
                    const I: usize = #r;
                    const J: usize = #s;
                    const COEFFICIENTS: [__guen::Coefficient; #n] = [#(#known),*];
                    fn coefficients<R: __guen::Real + __guen::Lift<B>>(
                        prepared: &Prepared<B>,
                        t: R,
                        x: &[R; #n],
                    ) -> [R; #n] {
                        let lifted: Prepared<R> = prepared.lift();
                        let all = program::brackets(&lifted.constants, &lifted.hoisted, t, x);
                        [#(#sign all[#places]),*]
                    }
                }
            });
        }
    }
    items
}

/// What is known of a coefficient, or of its negative, at compile time.
fn knowledge(graph: &Graph, c: ExprId, negative: bool) -> TokenStream {
    if let Some(value) = graph.as_number(c) {
        if value.is_zero() {
            return quote!(__guen::Coefficient::Zero);
        }
        let value = if negative { -value.clone() } else { value.clone() };
        if let Some((numerator, denominator)) = value.to_i64_pair() {
            return quote!(__guen::Coefficient::Number { numerator: #numerator, denominator: #denominator });
        }
    }
    let moving = Roles::of(Role::Coordinate).or(Roles::of(Role::Time));
    if graph.roles(c).meets(moving) {
        quote!(__guen::Coefficient::Variable)
    } else {
        quote!(__guen::Coefficient::Constant)
    }
}
